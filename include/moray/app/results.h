// SPDX-License-Identifier: MIT
//
// What a program leaves behind: JSON, CSV, tables, figures, a report, and the directory they appear in all together.
#ifndef MORAY_APP_RESULTS_H
#define MORAY_APP_RESULTS_H

#include <stdbool.h>
#include <stdio.h>

#include "moray/export.h"
#include "moray/status.h"

MORAY_BEGIN

// Shortest of %.15g, %.16g, %.17g that reads back as the same double, written into text; returns text. Non-finite
// values give "nan", "inf", "-inf".
MORAY_API const char *moray_number_text(double value, char text[32]);

// ---- Output directory ----------------------------------------------------------------------------------------------

// Files of one run. They are written under a temporary name inside the directory and appear at the commit, all or none.
typedef struct moray_output moray_output;

// Checks that the directory can be made and written to, and leaves nothing behind: a long solve should not start in
// vain. Error: MORAY_IO naming the directory; MORAY_MEMORY.
MORAY_API moray_status moray_output_open(moray_output **output, const char *directory);

// Starts the file `name` (no slash in it); write to *file with fprintf and the like and leave closing to the output.
// Error: MORAY_INPUT (name unusable or taken), MORAY_IO, MORAY_MEMORY.
MORAY_API moray_status moray_output_file(moray_output *output, const char *name, FILE **file);

// Closes the files and moves them to their names. After an error the directory is as it was before. Error: MORAY_IO
// naming the file.
MORAY_API moray_status moray_output_commit(moray_output *output);

// Frees the output; what is not committed is deleted, and so is the directory if the output made it. NULL is allowed.
MORAY_API void moray_output_free(moray_output *output);

// ---- JSON ----------------------------------------------------------------------------------------------------------

// One JSON object under construction, with a cursor on the innermost open object or list. Running out of memory is
// remembered and reported by moray_json_write, so that nothing else needs a check; a NULL builder takes every call.
// `key` is NULL inside a list.
typedef struct moray_json moray_json;

MORAY_API moray_json *moray_json_new(void);
MORAY_API void moray_json_open(moray_json *json, const char *key);      // an object inside the current one
MORAY_API void moray_json_open_list(moray_json *json, const char *key); // a list inside the current one
MORAY_API void moray_json_close(moray_json *json);                      // back to the enclosing one
MORAY_API int moray_json_depth(const moray_json *json);                 // how many are open inside the first
// A number round-trips; NaN and infinity become null.
MORAY_API void moray_json_number(moray_json *json, const char *key, double value);
MORAY_API void moray_json_numbers(moray_json *json, const char *key, const double *values, int n);
MORAY_API void moray_json_text(moray_json *json, const char *key, const char *text); // NULL becomes null
MORAY_API void moray_json_bool(moray_json *json, const char *key, bool value);

// Numbers as a table: into the current object, or as one of their own inside it. In C:
//   moray_json_object(json, "gait", MORAY_MEMBERS({"omega_deg_s", omega / DEG}, {"delta_deg", delta / DEG}));
typedef struct moray_json_member {
    const char *key;
    double value;
} moray_json_member;
#define MORAY_MEMBERS(...)                                                                                             \
    (const moray_json_member[]){__VA_ARGS__},                                                                          \
        (int)(sizeof((const moray_json_member[]){__VA_ARGS__}) / sizeof(moray_json_member))
MORAY_API void moray_json_members(moray_json *json, const moray_json_member *members, int n);
MORAY_API void moray_json_object(moray_json *json, const char *key, const moray_json_member *members, int n);

// Writes the whole object and a newline, and flushes. Error: MORAY_MEMORY (now or while building), MORAY_IO.
MORAY_API moray_status moray_json_write(const moray_json *json, FILE *file);
MORAY_API void moray_json_free(moray_json *json);

// A JSON file, such as a summary.json, to be read. A place in it is the keys that lead there, items of a list by their
// number from 0, joined by dots: "steering.2.gain_m_rad"; "" is the whole. Error: MORAY_IO, MORAY_INPUT naming the
// file, MORAY_MEMORY. Free with moray_json_file_free.
typedef struct moray_json_file moray_json_file;
MORAY_API moray_status moray_json_read(moray_json_file **json, const char *path);
MORAY_API void moray_json_file_free(moray_json_file *json); // NULL is allowed

// What stands there: the number, NaN where there is none; the text, which lives as long as the file, or NULL; how many
// items or members, -1 where there is no list and no object.
MORAY_API double moray_json_number_at(const moray_json_file *json, const char *place);
MORAY_API const char *moray_json_text_at(const moray_json_file *json, const char *place);
MORAY_API int moray_json_count_at(const moray_json_file *json, const char *place);

// ---- Tables --------------------------------------------------------------------------------------------------------

enum { MORAY_TABLE_COLUMNS = 8 };

// label, one number a column (NaN: left blank), unit. `text`, where not NULL, stands in the first column instead.
typedef struct moray_table_row {
    const char *label;
    double value[MORAY_TABLE_COLUMNS];
    const char *unit; // or NULL
    const char *text;
} moray_table_row;

// `columns` heads the n_columns columns of numbers; NULL entries head nothing.
typedef struct moray_table {
    const char *title; // or NULL
    const char *columns[MORAY_TABLE_COLUMNS];
    int n_columns;
    const moray_table_row *rows;
    int n_rows;
} moray_table;

// Plain text with aligned columns; widths count UTF-8 characters. Of several, each with a blank line behind it.
MORAY_API void moray_table_print(const moray_table *table, FILE *file);
MORAY_API void moray_tables_print(const moray_table *tables, int n, FILE *file);

// Adds to what stands in text[size]; what has no room is left out, from a whole word on.
MORAY_API void moray_text_add(char *text, size_t size, const char *format, ...) MORAY_PRINTF(3, 4);

// Comma-separated values: a line of names "name [unit]", then n_rows lines of full-precision numbers. Row i of a column
// is values[i * stride] (stride 0 stands for 1). Errors of the file stay in the file for the commit to find.
typedef struct moray_column {
    const char *name, *unit; // unit may be NULL
    const double *values;
    int stride;
} moray_column;
MORAY_API void moray_csv_write(FILE *file, const moray_column *columns, int n_columns, int n_rows);

// ---- Figures and report --------------------------------------------------------------------------------------------

typedef enum {
    MORAY_CURVE_LINE,
    MORAY_CURVE_MARKED,
    MORAY_CURVE_POINTS,
    MORAY_CURVE_BODY
} moray_curve_style; // body: a robot

// One thing has one colour in all figures and in the scene of a report. BY_NUMBER: that of the curve's or the body's
// place among the others.
typedef enum {
    MORAY_COLOUR_BY_NUMBER,
    MORAY_COLOUR_BEST,     // blue: what is recommended, or came of it all
    MORAY_COLOUR_BASELINE, // orange: what it is compared with
    MORAY_COLOUR_SECOND,   // green and
    MORAY_COLOUR_THIRD,    // purple: others
    MORAY_COLOUR_LIMIT,    // black, thin, dashed: limits, and what was asked for
    MORAY_COLOUR_WATER     // grey: the current
} moray_colour;

// Points (x[i * stride], y[i * stride]), i < n; a NaN interrupts the curve. stride 0 stands for 1. A curve without a
// label has no line in the key.
typedef struct moray_curve {
    const char *label;
    const double *x, *y;
    int n, stride;
    moray_curve_style style;
    moray_colour colour;
    bool dotted; // in the place of the dashes of its colour
} moray_curve;

// Numbers z[n_y][n_x] over a grid, shown by colour and by lines of equal height below the curves; NaN: left blank.
typedef struct moray_field {
    const char *label; // what z is, with its unit
    const double *x, *y, *z;
    int n_x, n_y;
} moray_field;

// Curves differ in colour (Okabe and Ito's palette) and in dashes or markers, so that they survive a grey print.
typedef struct moray_figure {
    const char *name; // of the file, without .svg
    const char *title, *x_label, *y_label;
    bool equal_axes;            // same scale on both axes, for paths in the plane
    bool log_x, log_y;          // logarithmic axes, for values above 0
    bool over_time;             // x is time as the scene of the report has it: its cursor is shown
    const char *const *y_names; // [n_y_names] in place of y = 0, 1, ..., from the top; NULL: numbers
    int n_y_names;
    const moray_curve *curves;
    int n_curves;
    const moray_field *field; // NULL: none
} moray_figure;

// Draws NAME.svg with gnuplot. Where gnuplot is missing or fails the output is as before the call and can be used on.
// Error: MORAY_IO saying what gnuplot said; MORAY_INPUT, MORAY_MEMORY as for moray_output_file.
MORAY_API moray_status moray_output_figure(moray_output *output, const moray_figure *figure);

// Bodies of rigid links moving in the plane, for the report to show: SI units, angles in rad. Everything is borrowed.
typedef struct moray_scene_body {
    const char *name;
    moray_colour colour; // not that of a limit or of water
    int links;
    double length, width;  // of a link
    const double *lengths; // [links], where these differ; NULL: they do not
    const double *at;      // [frames][links][3]: centre x, y and angle
    const double *effort;  // [frames][links - 1], in the joints; NULL: none
    const double *force;   // [frames][links][2], of the surroundings on the links; NULL: none
} moray_scene_body;

typedef struct moray_channel { // a number over time, told beside the picture
    const char *name, *unit;
    const double *values; // [frames]
} moray_channel;

typedef struct moray_scene {
    const char *title, *text; // text: paragraphs, or NULL
    int frames;
    const double *t; // [frames], ascending
    const moray_scene_body *bodies;
    int n_bodies;       // at most 4
    const char *effort; // what the efforts are, "Torque, at most 0.4 N m"
    double current[2];
    const double *asked_x, *asked_y; // [n_asked]: a path to be followed
    int n_asked;
    const moray_channel *channels;
    int n_channels;
} moray_scene;

// A part of a report under its own heading: paragraphs (one a line) or NULL, tables, figures whose names begin with
// `figures` (NULL: none).
typedef struct moray_section {
    const char *title, *text, *figures;
    const moray_table *tables;
    int n_tables;
} moray_section;

// What a name or an abbreviation on a page stands for.
typedef struct moray_meaning {
    const char *name, *meaning;
} moray_meaning;

typedef enum { MORAY_JUDGED_NOT, MORAY_JUDGED_PASS, MORAY_JUDGED_FAIL } moray_judgement;

typedef struct moray_report {
    const char *title, *text; // text: paragraphs (one a line), or NULL
    const char *judged;       // one line above all, "Certificate: pass (...)", or NULL, with its
    moray_judgement judgement;
    const char *asked;        // paragraphs on what was asked, or NULL
    const moray_scene *scene; // or NULL; not shown with fewer than two frames
    const moray_table *tables;
    int n_tables;
    const moray_section *sections;
    int n_sections;
    const moray_meaning *words; // up to one without a name; or NULL
    int argc;                   // the command line that made it
    char **argv;
    const char *configuration; // run.ini, or NULL
} moray_report;

// report.html: one self-contained page with the scene, the tables and every figure drawn so far; those of no section
// come first.
// Error: as moray_output_file.
MORAY_API moray_status moray_output_report(moray_output *output, const moray_report *report);

// ---- Progress ------------------------------------------------------------------------------------------------------

// One line rewritten in place on a terminal; elsewhere a plain line a minute; `quiet`: none. No colours.
typedef struct moray_ticker {
    FILE *stream;
    bool live, plain; // rewritten in place; a line a minute
    double started;   // [s]
} moray_ticker;

MORAY_API moray_ticker moray_ticker_start(FILE *stream, bool quiet);
MORAY_API void moray_ticker_show(const moray_ticker *ticker, const char *format, ...) MORAY_PRINTF(2, 3);
// The same with "3 of 12, some 4 min left" behind it, by what the `done` so far have taken since the start.
MORAY_API void moray_ticker_count(const moray_ticker *ticker, int done, int of, const char *format, ...)
    MORAY_PRINTF(4, 5);
// A line that stays, above the one rewritten.
MORAY_API void moray_ticker_note(const moray_ticker *ticker, const char *format, ...) MORAY_PRINTF(2, 3);
MORAY_API void moray_ticker_end(const moray_ticker *ticker); // erases the line

MORAY_END

#endif
