// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "identify.h"

enum { MOST_ROWS = 12 * LOGS, TEXT = 6000 };

struct shown {
    moray_table table[4];
    moray_table_row next[MORAY_MOST_UNKNOWNS];
    char next_title[200];
    moray_table_row coefficient[MORAY_MOST_UNKNOWNS], channel[MOST_ROWS], held[LOGS];
    char channel_name[MOST_ROWS][120], note[MORAY_MOST_UNKNOWNS][60], text[TEXT], judged[400];
    int tables;
};

// ---- Tables --------------------------------------------------------------------------------------------------------

static void fill_coefficients(const identify *run, struct shown *s)
{
    moray_unknowns start = identify_spec(run).start;
    for (int k = 0; k < run->n; k++) {
        double scale;
        const char *unit = identify_unit(run->unknown[k], &scale);
        const double value = run->at[0].value[k], half = identify_half_width(run, &run->info, k);
        const bool known = isfinite(half) && !run->info.held[k];
        snprintf(s->note[k], sizeof s->note[k], "%s%s", unit,
                 run->info.held[k] ? "  at its bound"
                 : isfinite(half)  ? ""
                                   : "  not determined");
        s->coefficient[k] =
            (moray_table_row){.label = moray_unknown_name(run->unknown[k]),
                              .value = {*moray_unknown_at(run->unknown[k], &start) / scale, value / scale,
                                        known ? (value - half) / scale : NAN, known ? (value + half) / scale : NAN,
                                        known ? half / scale : NAN},
                              .unit = s->note[k]};
    }
    s->table[s->tables++] = (moray_table){.title = "What was identified, with intervals of 95 %",
                                          .columns = {"start", "estimate", "from", "to", "+-"},
                                          .n_columns = 5,
                                          .rows = s->coefficient,
                                          .n_rows = run->n};
}

// Torques of all joints of a run in one row.
static int fill_channels(const identify *run, moray_table_row *row, char (*name)[120])
{
    int n = 0;
    for (int k = 0; k < run->fit.channels && n < MOST_ROWS; k++) {
        const moray_channel_fit *c = &run->fit.channel[k];
        const double unit = c->kind == MORAY_CHANNEL_HEADING ? DEG : 1;
        if (c->kind == MORAY_CHANNEL_TORQUE)
            snprintf(name[n], sizeof *name, "%.60s u_%d", run->log[c->run].name, c->joint + 1);
        else
            snprintf(name[n], sizeof *name, "%.60s %s", run->log[c->run].name, moray_channel_name(c->kind));
        row[n] =
            (moray_table_row){.label = name[n],
                              .value = {c->n, c->sigma / unit, c->rms * c->sigma / unit, c->rms, c->lag, c->outliers},
                              .unit = c->kind == MORAY_CHANNEL_TORQUE    ? "N m"
                                      : c->kind == MORAY_CHANNEL_HEADING ? "deg"
                                                                         : "m"};
        n++;
    }
    return n;
}

static void fill_held(const identify *run, struct shown *s)
{
    for (int k = 0; k < run->n_held; k++) {
        const held_out *h = &run->validation[k];
        s->held[k] = (moray_table_row){.label = run->held[k].name,
                                       .value = {hypot(h->rms[0], h->rms[1]), h->rms[MORAY_CHANNEL_HEADING] / DEG,
                                                 h->rms[MORAY_CHANNEL_TORQUE], h->measured, h->predicted,
                                                 100 * (h->predicted / h->measured - 1)}};
    }
    if (run->n_held > 0)
        s->table[s->tables++] =
            (moray_table){.title = "Held-out runs, predicted behind their first quarter",
                          .columns = {"position m", "heading deg", "torque N m", "speed m/s", "predicted", "off %"},
                          .n_columns = 6,
                          .rows = s->held,
                          .n_rows = run->n_held};
}

// Intervals as predicted: those of now, and with the experiment.
static void fill_next(const identify *run, struct shown *s)
{
    const moray_gait *gait = &run->next;
    if (!run->design)
        return;
    snprintf(s->next_title, sizeof s->next_title,
             "The experiment to swim next, %g s of alpha %.4g deg, omega %.4g deg/s, delta %.4g deg, phi_0 %.4g deg: "
             "intervals",
             run->duration, gait->amplitude / DEG, gait->omega / DEG, gait->delta / DEG, gait->offset / DEG);
    for (int k = 0; k < run->n; k++) {
        double scale;
        const char *unit = identify_unit(run->unknown[k], &scale);
        const double now = identify_half_width(run, &run->info, k) / scale,
                     then = identify_half_width(run, &run->after, k) / scale;
        s->next[k] = (moray_table_row){.label = moray_unknown_name(run->unknown[k]),
                                       .value = {isfinite(now) ? now : NAN, isfinite(then) ? then : NAN},
                                       .unit = unit};
    }
    s->table[s->tables++] = (moray_table){
        .title = s->next_title, .columns = {"+- now", "+- with it"}, .n_columns = 2, .rows = s->next, .n_rows = run->n};
}

// ---- In words ------------------------------------------------------------------------------------------------------

static void tell_logs(const identify *run, struct shown *s)
{
    for (int k = 0; k < run->n_logs; k++) {
        const moray_swim_log *log = &run->log[k];
        moray_text_add(s->text, TEXT, "\n%s: %d rows, %.4g s; joints: %s.", log->name, log->n,
                       log->t[log->n - 1] - log->t[0], moray_identify_joints(run->fitted, k));
        if (log->notes[0])
            moray_text_add(s->text, TEXT, "\nNote: %s.", log->notes);
    }
}

static void tell_starts(const identify *run, struct shown *s)
{
    moray_text_add(s->text, TEXT, "\n%d of %d starts came to the best, which took %d iterations.", run->best_starts,
                   run->starts, run->at[0].iterations);
    for (int k = 0; k < run->starts; k++)
        if (isfinite(run->at[k].cost) && run->at[k].cost > 1.001 * run->at[0].cost && run->at[k].converged) {
            moray_text_add(s->text, TEXT, " Another minimum is %.3g times as high.", run->at[k].cost / run->at[0].cost);
            break;
        }
}

static void tell_held(const identify *run, struct shown *s)
{
    char names[300] = "";
    int held = 0;
    for (int k = 0; k < run->n; k++)
        if (run->info.held[k])
            moray_text_add(names, sizeof names, "%s%s", held++ ? ", " : "", moray_unknown_name(run->unknown[k]));
    if (held)
        moray_text_add(
            s->text, TEXT,
            "\nAt a bound: %s. The intervals of the others hold only where that is right: widen it (--bounds), "
            "or let longer logs tell.",
            names);
}

static void tell_outliers(const identify *run, struct shown *s)
{
    for (int k = 0; k < run->fit.channels; k++) {
        const moray_channel_fit *c = &run->fit.channel[k];
        char what[24];
        if (c->outliers == 0)
            continue;
        snprintf(what, sizeof what, c->kind == MORAY_CHANNEL_TORQUE ? "%s %d" : "%s", moray_channel_name(c->kind),
                 c->joint + 1);
        moray_text_add(s->text, TEXT,
                       "\n%s: %d readings of %s are more than 5 standard deviations off, the worst in line %d.",
                       run->log[c->run].name, c->outliers, what, run->log[c->run].line[c->worst]);
    }
}

static void describe(const identify *run, struct shown *s)
{
    char open[900];
    char links[MORAY_LINKS_TEXT];
    moray_text_add(s->text, TEXT, "%s, %s model; %d measurements of %d logs.",
                   moray_snake_links_text(&run->snake.robot, links), moray_model_name(run->snake.model), run->fit.n,
                   run->n_logs);
    if (run->snake.robot.link)
        moray_text_add(s->text, TEXT, "\nCoefficients are means of the links, which keep their ratios to them.");
    tell_logs(run, s);
    tell_starts(run, s);
    moray_information_open(&run->info, run->unknown, open, sizeof open);
    if (open[0])
        moray_text_add(s->text, TEXT, "\nThe data do not determine:\n%s.", open);
    tell_held(run, s);
    tell_outliers(run, s);
    if (run->inflation > 1)
        moray_text_add(s->text, TEXT, "\nIntervals are %.3g times as wide as noise alone would make them.",
                       run->inflation);
    snprintf(s->judged, sizeof s->judged, "Residuals: %s (%s)", identify_certified(run) ? "pass" : "fail",
             run->fit.verdict);
}

// ---- The whole -----------------------------------------------------------------------------------------------------

static void print(const void *found, const moray_report *report)
{
    (void)found;
    printf("%s\n\n", report->text);
    moray_tables_print(report->tables, report->n_tables, stdout);
    printf("%s\n", report->judged);
}

moray_status identify_report(const identify *run)
{
    static struct shown shown;
    struct shown *s = &shown;
    *s = (struct shown){0};
    fill_coefficients(run, s);
    s->table[s->tables++] = (moray_table){.title = "What is left, observed less predicted",
                                          .columns = {"readings", "noise", "rms", "rms/noise", "lag 1", "outliers"},
                                          .n_columns = 6,
                                          .rows = s->channel,
                                          .n_rows = fill_channels(run, s->channel, s->channel_name)};
    fill_held(run, s);
    fill_next(run, s);
    describe(run, s);
    const moray_report report = {.title = "identify: a robot from logs of its swimming",
                                 .text = s->text,
                                 .judged = s->judged,
                                 .judgement = identify_certified(run) ? MORAY_JUDGED_PASS : MORAY_JUDGED_FAIL,
                                 .tables = s->table,
                                 .n_tables = s->tables};
    return moray_app_show(&run->common, &(moray_results){.name = "identify",
                                                         .found = run,
                                                         .summary = identify_summary,
                                                         .print = print,
                                                         .write = identify_write,
                                                         .draw = identify_draw,
                                                         .report = &report});
}
