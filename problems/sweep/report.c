// SPDX-License-Identifier: MIT
#include "sweep/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/options.h"
#include "moray/app/results.h"

enum { ROWS = 9, MOST_CURVES = 8 };

static int rows(const moray_sweep_result *r, moray_table_row row[ROWS])
{
    const double workers = r->ranks > 1 ? r->ranks : r->jobs, capacity = r->seconds * workers;
    const moray_table_row all[ROWS] = {{.label = "points", .value = {(double)r->points}},
                                       {.label = "solved", .value = {(double)r->solved}},
                                       {.label = "failed", .value = {(double)r->failed}},
                                       {.label = "attempts that an earlier run had made", .value = {(double)r->before}},
                                       {.label = "begun from a solved neighbour", .value = {(double)r->warm}},
                                       {.label = "of these, solved so", .value = {(double)r->held}},
                                       {.label = "bettered from a neighbour's branch", .value = {(double)r->improved}},
                                       {.label = "time", .value = {r->seconds}, .unit = "s"},
                                       {.label = "share of it that the processes spent on points",
                                        .value = {capacity > 0 ? 100 * r->busy / capacity : NAN},
                                        .unit = "%"}};
    memcpy(row, all, sizeof all);
    return ROWS;
}

static void summarise(const sweep_arguments *a, const moray_sweep_result *r, moray_json *json)
{
    moray_json_text(json, "problem", "sweep");
    moray_json_text(json, "version", moray_version());
    moray_json_text(json, "program", a->program->name);
    moray_json_text(json, "file", a->file);
    moray_json_members(json, MORAY_MEMBERS({"points", (double)r->points}, {"solved", (double)r->solved},
                                           {"failed", (double)r->failed}, {"made_before", (double)r->before},
                                           {"warm", (double)r->warm}, {"held", (double)r->held},
                                           {"improved", (double)r->improved}, {"ranks", r->ranks}, {"jobs", r->jobs},
                                           {"lost_ranks", r->lost}, {"time_s", r->seconds}, {"busy_s", r->busy},
                                           {"saving_s", r->saving}));
}

// Axes that are numbers: at most two, the others stay at their first values.
typedef struct slice {
    const moray_sweep_axis *across, *curves; // curves: NULL, one curve
    long step[2], n_curves;
} slice;

static bool slice_of(const sweep_arguments *a, slice *s)
{
    long step = 1;
    *s = (slice){.n_curves = 1};
    for (int k = a->axes - 1; k >= 0; k--) {
        const moray_sweep_axis *axis = &a->axis[k];
        if (axis->value && axis->n > 1) {
            s->curves = s->across;
            s->step[1] = s->step[0];
            s->across = axis;
            s->step[0] = step;
        }
        step *= axis->n;
    }
    if (s->curves)
        s->n_curves = s->curves->n < MOST_CURVES ? s->curves->n : MOST_CURVES;
    return s->across;
}

// Of the curves' axis, spread over its values.
static int place_of(const slice *s, long k)
{
    return s->n_curves > 1 ? (int)(k * (s->curves->n - 1) / (s->n_curves - 1)) : 0;
}

static moray_status draw(moray_output *output, const slice *s, const char *name, const double *value)
{
    moray_curve curve[MOST_CURVES];
    char label[MOST_CURVES][80], file[128];
    double *y = calloc((size_t)(s->n_curves * s->across->n), sizeof *y);
    if (!y)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    for (long k = 0; k < s->n_curves; k++) {
        const int place = place_of(s, k);
        double *of = y + k * s->across->n;
        for (int i = 0; i < s->across->n; i++)
            of[i] = value[i * s->step[0] + place * s->step[1]];
        label[k][0] = 0;
        if (s->curves)
            snprintf(label[k], sizeof label[k], "%s %.4g", s->curves->key, s->curves->value[place]);
        curve[k] = (moray_curve){.label = s->curves ? label[k] : name,
                                 .x = s->across->value,
                                 .y = of,
                                 .n = s->across->n,
                                 .style = MORAY_CURVE_MARKED};
    }
    snprintf(file, sizeof file, "%.100s", name);
    for (char *c = file; *c; c++)
        *c = *c == '.' ? '_' : *c;
    const moray_status status = moray_output_figure(output, &(moray_figure){.name = file,
                                                                            .title = name,
                                                                            .x_label = s->across->key,
                                                                            .y_label = name,
                                                                            .curves = curve,
                                                                            .n_curves = (int)s->n_curves});
    free(y);
    return status;
}

static moray_status draw_all(const sweep_arguments *a, moray_output *output)
{
    slice s;
    if (!slice_of(a, &s))
        return moray_ok();
    for (int k = 0; k < a->shown; k++) {
        double *value;
        long n;
        MORAY_TRY(moray_sweep_numbers(a->file, a->show[k], &value, &n));
        const moray_status status = draw(output, &s, a->show[k], value);
        free(value);
        MORAY_TRY(status);
    }
    return moray_ok();
}

static moray_status write_folder(const sweep_arguments *a, const moray_sweep_result *result, const moray_json *json,
                                 int argc, char **argv)
{
    moray_output *output;
    moray_table_row row[ROWS];
    const moray_table table = {.rows = row, .n_rows = rows(result, row), .n_columns = 1};
    const moray_report report = {.title = "sweep", .tables = &table, .n_tables = 1, .argc = argc, .argv = argv};
    FILE *file;
    MORAY_TRY(moray_output_open(&output, a->out));
    moray_status status = moray_output_file(output, "summary.json", &file);
    if (!moray_failed(status))
        status = moray_json_write(json, file);
    if (!moray_failed(status))
        status = draw_all(a, output);
    if (!moray_failed(status))
        status = moray_output_report(output, &report);
    if (!moray_failed(status))
        status = moray_output_commit(output);
    moray_output_free(output);
    return status;
}

// One character a point where two axes are numbers: the grid as a whole.
static void print_map(const sweep_arguments *a)
{
    static const char mark[] = ".#x"; // untried, solved, failed
    enum { widest = 120, tallest = 60 };
    double *state;
    long n;
    slice s;
    if (a->axes != 2 || a->draws > 0 || !slice_of(a, &s) || !s.curves || s.curves->n > widest ||
        s.across->n > tallest || moray_failed(moray_sweep_numbers(a->file, "sweep_state", &state, &n)))
        return;
    printf("%s down, %s across; # solved, x failed\n", s.across->key, s.curves->key);
    for (int i = 0; i < s.across->n; i++) {
        printf("%10.4g ", s.across->value[i]);
        for (int k = 0; k < s.curves->n; k++)
            putchar(mark[(int)state[i * s.step[0] + k * s.step[1]]]);
        putchar('\n');
    }
    free(state);
}

moray_status sweep_report(const sweep_arguments *a, const moray_sweep_result *result, int argc, char **argv)
{
    moray_table_row row[ROWS];
    const moray_table table = {.rows = row, .n_rows = rows(result, row), .n_columns = 1};
    moray_json *json = moray_json_new();
    summarise(a, result, json);
    moray_status status = a->out ? write_folder(a, result, json, argc, argv) : moray_ok();
    if (!moray_failed(status) && a->json) {
        status = moray_json_write(json, stdout);
    } else if (!moray_failed(status)) {
        moray_table_print(&table, stdout);
        print_map(a);
        printf("%s\n", a->file);
    }
    moray_json_free(json);
    return status;
}
