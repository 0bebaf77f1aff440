// SPDX-License-Identifier: MIT
//
// What a log must be like, and what is odd about it.
#include <math.h>
#include <stdio.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "moray/number.h"
#include "snake/identify/log.h"

enum { LEAST_ROWS = 20 };
static const double most_angle = 2 * M_PI, most_speed = 5, most_step = 2, least_angle = 0.02, wide_gap = 5;

static void note(moray_swim_log *log, const char *format, ...) MORAY_PRINTF(2, 3);
static void note(moray_swim_log *log, const char *format, ...)
{
    const size_t used = strlen(log->notes), size = sizeof log->notes;
    va_list arguments;
    if (used + 2 >= size)
        return;
    if (used > 0)
        strcpy(log->notes + used, "\n");
    va_start(arguments, format);
    vsnprintf(log->notes + strlen(log->notes), size - strlen(log->notes), format, arguments);
    va_end(arguments);
}

// ---- Time ----------------------------------------------------------------------------------------------------------

static moray_status check_order(const struct log_reader *r, const moray_swim_log *log)
{
    for (int k = 1; k < log->n; k++)
        if (!(log->t[k] > log->t[k - 1]))
            return moray_csv_error(&r->csv, k,
                                   moray_error(MORAY_INPUT,
                                               "%.60s = %.10g s: not after %.10g s in line %d; rows must be in "
                                               "the order of time, no time twice",
                                               r->csv.name[r->column[LOG_TIME]], log->t[k], log->t[k - 1],
                                               log->line[k - 1]));
    return moray_ok();
}

// Rows further apart than any stroke is short.
static moray_status check_step(const struct log_reader *r, double usual)
{
    if (r->said[LOG_TIME] || usual <= most_step)
        return moray_ok();
    return moray_csv_error(&r->csv, -1,
                           moray_error(MORAY_INPUT,
                                       "%.60s: rows are %.4g s apart, more than %g: is it in ms? Say --units t=ms (or "
                                       "t=s if it is right)",
                                       r->csv.name[r->column[LOG_TIME]], usual, most_step));
}

static moray_status note_gaps(const struct log_reader *r, moray_swim_log *log)
{
    double *step = malloc((size_t)log->n * sizeof *step), widest = 0;
    int gaps = 0, at = 0;
    if (!step)
        return moray_error(MORAY_MEMORY, "no memory for a log of %d rows", log->n);
    for (int k = 1; k < log->n; k++)
        step[k - 1] = log->t[k] - log->t[k - 1];
    const double usual = moray_quantile(step, log->n - 1, 0.5);
    free(step);
    MORAY_TRY(check_step(r, usual));
    for (int k = 1; k < log->n; k++) {
        const double width = log->t[k] - log->t[k - 1];
        gaps += width > wide_gap * usual;
        if (width > widest)
            widest = width, at = k;
    }
    if (gaps > 0)
        note(log, "%s: %d gap%s in time, the widest of %.4g s before line %d (usual step %.4g s)", log->name, gaps,
             gaps > 1 ? "s" : "", widest, log->line[at], usual);
    return moray_ok();
}

// ---- Values --------------------------------------------------------------------------------------------------------

static void note_missing(moray_swim_log *log, const char *name, const double *value, int n)
{
    int missing = 0;
    for (int k = 0; value && k < n; k++)
        missing += isnan(value[k]);
    if (missing > 0)
        note(log, "%s: %s has no value in %d of %d places", log->name, name, missing, n);
}

// Angles that can be no rad, of [n][width].
static moray_status check_angles(const struct log_reader *r, const moray_swim_log *log, int which, const double *value,
                                 int width)
{
    const char *key = which == LOG_HEADING ? "heading" : which == LOG_REFERENCE ? "phi_ref" : "phi";
    for (int k = 0; value && !r->said[which] && k < log->n * width; k++)
        if (fabs(value[k]) > most_angle)
            return moray_csv_error(&r->csv, k / width,
                                   moray_error(MORAY_INPUT,
                                               "%s%s%.0d: %.6g rad is an angle beyond 2 pi: is it in deg? Say --units "
                                               "%s=deg (or %s=rad if it is right)",
                                               key, width > 1 ? ", number " : "", width > 1 ? k % width + 1 : 0,
                                               value[k], key, key));
    return moray_ok();
}

static void note_small_joints(moray_swim_log *log)
{
    double most = 0;
    for (int k = 0; k < log->n * log->joints; k++)
        most = fmax(most, fabs(log->phi[k]));
    if (most < least_angle)
        note(log, "%s: no joint angle is beyond %.3g deg: is the unit right?", log->name, most * 180 / M_PI);
}

static void note_still_joints(moray_swim_log *log)
{
    for (int i = 0; i < log->joints; i++) {
        double low = INFINITY, high = -INFINITY;
        for (int k = 0; k < log->n; k++) // which pass over NAN
            low = fmin(low, log->phi[k * log->joints + i]), high = fmax(high, log->phi[k * log->joints + i]);
        if (low == high)
            note(log, "%s: joint %d is at %.4g deg in every row: does it move?", log->name, i + 1, low * 180 / M_PI);
    }
}

// Half of the steps of the path are faster than any such robot swims.
static moray_status check_speed(const struct log_reader *r, const moray_swim_log *log)
{
    if (!log->p_x || r->said[LOG_X])
        return moray_ok();
    double *speed = malloc((size_t)log->n * sizeof *speed);
    int steps = 0;
    if (!speed)
        return moray_error(MORAY_MEMORY, "no memory for a log of %d rows", log->n);
    for (int k = 1, last = 0; k < log->n; k++) {
        const double way = hypot(log->p_x[k] - log->p_x[last], log->p_y[k] - log->p_y[last]);
        if (isnan(log->p_x[k] + log->p_y[k]))
            continue;
        if (!isnan(way) && way > 0)
            speed[steps++] = way / (log->t[k] - log->t[last]);
        last = k;
    }
    const double usual = steps > 0 ? moray_quantile(speed, steps, 0.5) : 0;
    free(speed);
    if (usual > most_speed)
        return moray_csv_error(&r->csv, -1,
                               moray_error(MORAY_INPUT,
                                           "%.60s: the robot moves at %.4g m/s from row to row, more than %g: is it in "
                                           "mm or cm? Say --units p_x=mm,p_y=mm (or p_x=m if it is right)",
                                           r->csv.name[r->column[LOG_X]], usual, most_speed));
    return moray_ok();
}

static void unwrap(double *angle, int n)
{
    double last = NAN;
    for (int k = 0; angle && k < n; k++) {
        if (isnan(angle[k]))
            continue;
        if (!isnan(last))
            angle[k] -= 2 * M_PI * round((angle[k] - last) / (2 * M_PI));
        last = angle[k];
    }
}

static moray_status check_channels(const struct log_reader *r, const moray_swim_log *log)
{
    if (!log->p_x != !log->p_y)
        return moray_csv_error(&r->csv, -1,
                               moray_error(MORAY_INPUT, "p_%c without p_%c: a position has both", log->p_x ? 'x' : 'y',
                                           log->p_x ? 'y' : 'x'));
    if (!log->p_x && !log->heading && !log->u)
        return moray_csv_error(&r->csv, -1,
                               moray_error(MORAY_INPUT,
                                           "nothing is measured: needs p_x and p_y, or heading, or "
                                           "u_1 ... u_%d beside t and the joints",
                                           log->joints));
    return moray_ok();
}

moray_status moray_swim_log_check(const struct log_reader *r, moray_swim_log *log)
{
    if (log->n < LEAST_ROWS)
        return moray_error(MORAY_INPUT, "log %s: %d rows; needs %d at least", log->name, log->n, LEAST_ROWS);
    const int joints = log->reference ? LOG_REFERENCE : LOG_JOINT;
    MORAY_TRY(check_order(r, log));
    MORAY_TRY(check_channels(r, log));
    MORAY_TRY(check_angles(r, log, joints, log->phi, log->joints));
    MORAY_TRY(check_angles(r, log, LOG_HEADING, log->heading, 1));
    MORAY_TRY(note_gaps(r, log));
    MORAY_TRY(check_speed(r, log));
    unwrap(log->heading, log->n);
    note_small_joints(log);
    note_still_joints(log);
    note_missing(log, "p_x", log->p_x, log->n);
    note_missing(log, "p_y", log->p_y, log->n);
    note_missing(log, "heading", log->heading, log->n);
    note_missing(log, "phi", log->phi, log->n * log->joints);
    note_missing(log, "u", log->u, log->n * log->joints);
    return moray_ok();
}
