// SPDX-License-Identifier: MIT
#include "sweep/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/options.h"
#include "moray/app/results.h"
#include "sweep/figures.h"

enum { ROWS = 11 };

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
                                       {.label = "ranks lost", .value = {r->lost}},
                                       {.label = "cores", .value = {workers}},
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

moray_status sweep_write_folder(const char *out, const moray_report *report, const moray_json *json, const shown *s)
{
    moray_output *output;
    FILE *file;
    MORAY_TRY(moray_output_open(&output, out));
    moray_status status = moray_output_file(output, "summary.json", &file);
    if (!moray_failed(status))
        status = moray_json_write(json, file);
    if (s && !moray_failed(status))
        status = moray_output_file(output, "points.csv", &file);
    if (s && !moray_failed(status))
        shown_csv(s, file);
    if (s && !moray_failed(status))
        status = sweep_draw(s, output);
    if (!moray_failed(status))
        status = moray_output_report(output, report);
    if (!moray_failed(status))
        status = moray_output_commit(output);
    moray_output_free(output);
    return status;
}

moray_status sweep_report(const sweep_arguments *a, const moray_sweep_result *result, int argc, char **argv)
{
    moray_table_row row[ROWS], quantile_row[2 * SWEEP_MOST_SHOWN];
    moray_table tables[2] = {{.rows = row, .n_rows = rows(result, row), .n_columns = 1}};
    const int n_tables = a->quantiles ? 2 : 1;
    char title[100];
    snprintf(title, sizeof title, "sweep: %s at %ld points", a->program->name, result->points);
    const moray_report report = {.title = title, .tables = tables, .n_tables = n_tables, .argc = argc, .argv = argv};
    moray_json *json = moray_json_new();
    shown s = {0};
    summarise(a, result, json);
    moray_status status =
        result->solved > 0
            ? shown_read(a, &s)
            : moray_error(MORAY_NOT_SOLVED, "no point is solved; sweep_reason in %.200s tells why", a->file);
    if (!moray_failed(status) && a->quantiles)
        status = shown_quantiles(&s, quantile_row, &tables[1]);
    if (!moray_failed(status) && a->out)
        status = sweep_write_folder(a->out, &report, json, &s);
    if (!moray_failed(status) && a->json) {
        status = moray_json_write(json, stdout);
    } else if (!moray_failed(status)) {
        moray_tables_print(tables, n_tables, stdout);
        if (!a->quantiles)
            shown_table(&s, stdout);
        shown_mirror(&s, stdout);
        if (!a->quiet)
            printf("%s\n", a->file);
    }
    shown_free(&s);
    moray_json_free(json);
    return status;
}
