// SPDX-License-Identifier: MIT
//
// What was measured of a sweep, as tables, and what follows from it on paper.
#include <math.h>
#include <string.h>

#include "moray/app/options.h"
#include "moray/app/results.h"
#include "sweep/measure.h"
#include "sweep/report.h"

// What the process that hands out does for an answer of max_speed's length, on the processor.
static double handing(const measured *m)
{
    return m->answers.result.handing / ANSWERS;
}

// On the processor: all of the sweep over the loop.
static double overhead(const measured *m)
{
    return 100 * ((m->one.processor + m->one.points) / m->loop.processor - 1);
}

// Of two cores, by what one does; and of what two plain loops at once get out of them.
static double efficiency(const measured *m)
{
    return 50 * m->one.result.seconds / m->two.result.seconds;
}

static double of_loops(const measured *m)
{
    return 100 * m->two_loops.seconds / m->two.result.seconds;
}

// Memory by the line through the first and the last size.
static double memory_of(const measured *m, double points)
{
    const int last = SIZES - 1;
    const double more = fmax(0, m->made[last].megabytes - m->made[0].megabytes),
                 slope = more / (double)(m->size[last] - m->size[0]);
    return m->made[0].megabytes + slope * points;
}

enum { WORK = 14, PAPER = 8 };

static void tell_work(const measured *m, moray_table_row row[WORK])
{
    const double n = REAL_POINTS;
    const moray_table_row all[WORK] = {
        {.label = "points", .value = {n}},
        {.label = "plain loop, one core", .value = {m->loop.seconds / n}, .unit = "s a point"},
        {.label = "sweep, one core", .value = {m->one.result.seconds / n}, .unit = "s a point"},
        {.label = "overhead, on the clock",
         .value = {100 * (m->one.result.seconds / m->loop.seconds - 1)},
         .unit = "%"},
        {.label = "overhead, on the processor", .value = {overhead(m)}, .unit = "%"},
        {.label = "two plain loops at once", .value = {m->two_loops.seconds / n}, .unit = "s a point"},
        {.label = "sweep, two cores", .value = {m->two.result.seconds / n}, .unit = "s a point"},
        {.label = "efficiency", .value = {efficiency(m)}, .unit = "%"},
        {.label = "of what two plain loops reach", .value = {of_loops(m)}, .unit = "%"},
        {.label = "an answer of that length, in the process that hands out",
         .value = {1e3 * handing(m)},
         .unit = "ms a point"},
        {.label = "the same from neighbours", .value = {m->warm.result.seconds / n}, .unit = "s a point"},
        {.label = "begun from a neighbour", .value = {(double)m->warm.result.warm}},
        {.label = "of these, solved so", .value = {(double)m->warm.result.held}},
        {.label = "bettered from a neighbour's branch", .value = {(double)m->warm.result.improved}}};
    memcpy(row, all, sizeof all);
}

enum { GROWTH = 9 };

static void tell_growth(const measured *m, moray_table_row row[GROWTH])
{
    static const char *const labels[GROWTH] = {"points",
                                               "clock, both cores",
                                               "processor, the process that hands out",
                                               "of it, on answers: plan, store and journal",
                                               "journal and file, on the clock",
                                               "results file",
                                               "journal",
                                               "memory of the process that hands out",
                                               "writing the file once"};
    static const char *const units[GROWTH] = {
        NULL, "ms a point", "ms a point", "ms a point", "ms a point", "bytes a point", "bytes a point", "MB", "s"};
    for (int i = 0; i < GROWTH; i++)
        row[i] = (moray_table_row){.label = labels[i], .unit = units[i]};
    for (int k = 0; k < SIZES; k++) {
        const double n = (double)m->size[k], values[GROWTH] = {n,
                                                               1e3 * m->made[k].result.seconds / n,
                                                               1e3 * m->made[k].processor / n,
                                                               1e3 * m->made[k].result.handing / n,
                                                               1e3 * m->made[k].result.saving / n,
                                                               m->made[k].file / n,
                                                               m->made[k].journal / n,
                                                               m->made[k].megabytes,
                                                               m->read[k].result.saving / 2};
        for (int i = 0; i < GROWTH; i++)
            row[i].value[k] = values[i];
    }
}

static void tell_paper(const measured *m, moray_table_row row[PAPER])
{
    const double points = 1e6, cores = 1000, largest = (double)m->size[SIZES - 1];
    const double one = m->loop.seconds / REAL_POINTS, grown = points / largest, answer = handing(m);
    const double hours = points * one / cores / 3600;
    const moray_table_row all[PAPER] = {
        {.label = "the points' own time, on 1,000 cores", .value = {hours}, .unit = "h"},
        {.label = "first rank, busy with answers of it",
         .value = {100 * points * answer / (3600 * hours)},
         .unit = "%"},
        {.label = "cores at which it has no time left", .value = {one / answer}},
        {.label = "time a point below which 1,000 cores wait", .value = {answer * cores}, .unit = "s"},
        {.label = "its memory", .value = {memory_of(m, points)}, .unit = "MB"},
        {.label = "results file", .value = {m->made[SIZES - 1].file * grown / 1e6}, .unit = "MB"},
        {.label = "journal, as long as max_speed's summaries",
         .value = {m->answers.journal / ANSWERS * points / 1e9},
         .unit = "GB"},
        {.label = "writing the file once", .value = {m->read[SIZES - 1].result.saving / 2 * grown}, .unit = "s"}};
    memcpy(row, all, sizeof all);
}

static void summarise(const measured *m, moray_json *json)
{
    const int last = SIZES - 1;
    moray_json_text(json, "problem", "sweep measure");
    moray_json_text(json, "version", moray_version());
    moray_json_members(json,
                       MORAY_MEMBERS({"loop_s", m->loop.seconds}, {"two_loops_s", m->two_loops.seconds},
                                     {"one_core_s", m->one.result.seconds}, {"two_cores_s", m->two.result.seconds},
                                     {"overhead_percent", overhead(m)}, {"efficiency_percent", efficiency(m)},
                                     {"of_two_loops_percent", of_loops(m)}, {"points", (double)m->size[last]},
                                     {"file_bytes", m->made[last].file}, {"journal_bytes", m->made[last].journal},
                                     {"handing_s", handing(m)},
                                     {"growth", m->made[last].result.handing / (double)m->size[last] *
                                                    (double)m->size[last - 1] / m->made[last - 1].result.handing}));
}

moray_status measured_tell(const measured *m, const sweep_arguments *a, int argc, char **argv)
{
    moray_table_row work[WORK], growth[GROWTH], paper[PAPER];
    tell_work(m, work);
    tell_growth(m, growth);
    tell_paper(m, paper);
    const moray_table tables[] = {
        {.title = "max_speed on the consistent model", .rows = work, .n_rows = WORK, .n_columns = 1},
        {.title = "Points of no cost, of 20 numbers each", .rows = growth, .n_rows = GROWTH, .n_columns = SIZES},
        {.title = "On paper: a million points of that problem, 20 numbers kept of each, on 1,000 cores",
         .rows = paper,
         .n_rows = PAPER,
         .n_columns = 1}};
    moray_json *json = moray_json_new();
    summarise(m, json);
    const moray_report report = {.title = "sweep measure", .tables = tables, .n_tables = 3, .argc = argc, .argv = argv};
    moray_status status = a->out ? sweep_write_folder(a->out, &report, json, NULL) : moray_ok();
    if (!moray_failed(status) && a->json)
        status = moray_json_write(json, stdout);
    else if (!moray_failed(status))
        moray_tables_print(tables, 3, stdout);
    moray_json_free(json);
    return status;
}
