// SPDX-License-Identifier: MIT
//
// The studies of the paper: what a study is, and what it is given. To add one: parts/paper_NAME.c, its run function
// here, its row in paper.c, its file in problems/meson.build.
#ifndef PROBLEMS_PAPER_PAPER_H
#define PROBLEMS_PAPER_PAPER_H

#include <math.h>

#include "degree.h"
#include "moray/moray.h"
#include "moray/snake.h"
#include "reading.h"

enum { PAPER_STUDIES = 32, PAPER_TABLES = 12 };

typedef struct paper_settings {
    moray_common common;
    moray_snake_options snake;       // robot, current
    double theta_max, omega, delta;  // of the gait that studies take where they do not vary it
    paper_reading reading;           // of the control-oriented model
    bool as_printed;                 // reading = printed
    char write_ini[MORAY_PATH_SIZE]; // empty: none
    bool chosen[PAPER_STUDIES];
} paper_settings;

// What a study told: for report.html.
typedef struct paper_telling {
    const char *text; // paragraphs, one a line
    moray_table table[PAPER_TABLES];
    int n_tables;
} paper_telling;

// What a study is given. Nothing of it is to be freed or closed by the study, whatever it returns.
typedef struct paper {
    const paper_settings *settings;
    const moray_robot *robot;
    moray_test_rig rig;   // both swimmers of the robot in the current, course 0
    moray_gait gait[2];   // by moray_model: that of the settings, without offset
    moray_output *output; // of --out, or NULL
    moray_json *json;     // the study's own object is open
    moray_ticker ticker;
    const char *study;
    paper_telling *telling;
    struct paper_thing *things; // what paper_own keeps
} paper;

// Does the study and tells what it finds. An error ends this study only: its text says why.
typedef moray_status paper_run(paper *p);

paper_run paper_straight, paper_turning, paper_linearising, paper_ground, paper_eel, paper_fit;
paper_run paper_mapping, paper_forces, paper_links, paper_offset, paper_errata;

// ---- Keeping -------------------------------------------------------------------------------------------------------
// What these give is freed after the last study.

// Takes over a thing; frees it at once when out of memory. Error: MORAY_MEMORY.
moray_status paper_own(paper *p, void *thing, void (*release)(void *));

// n zeros; an empty track. Error: MORAY_MEMORY.
moray_status paper_numbers(paper *p, size_t n, double **numbers);
moray_status paper_track(paper *p, const moray_swimmer *swimmer, int capacity, moray_swim_track **track);

// A swimmer of the robot, or of another, in the settings' current, with its own reading. Error: those of
// moray_swimmer_new.
moray_status paper_swimmer(paper *p, const moray_robot *robot, moray_model model, paper_reading reading,
                           moray_swimmer **swimmer);

// A text as printf makes it, "" when out of memory.
const char *paper_label(paper *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

// ---- Swimming ------------------------------------------------------------------------------------------------------

// The gait of the settings with another link-angle amplitude, for a model.
moray_gait paper_gait(const paper *p, moray_model model, double theta_max);

// One period of steady swimming, started straight along x at rest: `points` samples, the last a period after the first
// (see moray_swim_steady). steady may be NULL. Error: those of moray_swim_steady.
moray_status paper_orbit(paper *p, moray_model model, const moray_gait *gait, int points, moray_steady *steady,
                         moray_swim_track **orbit);

// Half of largest less least of n values a stride apart: the amplitude of an oscillation.
double paper_half_range(const double *values, int stride, int n);

// The same for any swimmer, and for that of the settings in another current.
moray_status paper_orbit_of(paper *p, const moray_swim_setup *setup, const moray_gait *gait, int points,
                            moray_steady *steady, moray_swim_track **orbit);
moray_status paper_orbit_in(paper *p, const double current[2], moray_model model, const moray_gait *gait, int points,
                            moray_steady *steady, moray_swim_track **orbit);

// ---- Telling -------------------------------------------------------------------------------------------------------

// Replaces the line of progress.
void paper_progress(const paper *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

// A table, a paragraph: on standard output unless --json, and in the report, which keeps a copy.
moray_status paper_table(paper *p, const moray_table *table);
moray_status paper_rows(paper *p, const char *title, const char *const *heads, const moray_table_row *rows, int n);
#define PAPER_HEADS(...) ((const char *const[]){__VA_ARGS__, NULL}) // of the columns
moray_status paper_say(paper *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

// STUDY_name.csv and STUDY_figure->name.svg (STUDY.csv, STUDY.svg with name NULL); nothing without --out. Without
// gnuplot a figure is left out with a note on standard error. Error: those of moray_output_file.
moray_status paper_csv(paper *p, const char *name, const moray_column *columns, int n_columns, int n_rows);
moray_status paper_figure(paper *p, const moray_figure *figure);

// Columns of n rows, as both: the figure has those from the second on, or of them the ones shown, over the first.
typedef struct paper_graph {
    const char *name, *title, *x_label, *y_label; // of the figure
    const moray_column *columns;
    int n_columns, n;
    moray_curve_style style;
    const char *const *labels; // of the curves; NULL: the names of the columns
    const int *shown;          // [n_shown] columns; NULL: all
    int n_shown;
} paper_graph;
moray_status paper_draw(paper *p, const paper_graph *graph);

#endif
