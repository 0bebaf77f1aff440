// SPDX-License-Identifier: MIT
//
// What observations (ocp.h) say: data from files, residuals, and how well they determine the parameters.
#ifndef MORAY_FIT_H
#define MORAY_FIT_H

#include "moray/ocp.h"

MORAY_BEGIN

// Data as moray_observations takes it; owns both arrays.
typedef struct moray_data {
    int n, ny;
    double *time, *value; // [n], [n][ny]; NAN where a value is missing
} moray_data;

// Reads comma-separated values: a line of names, "t" and names[ny] in any order, units in brackets after a name and
// other columns ignored; then lines of numbers, a value that is missing empty or "nan". Error: MORAY_IO; MORAY_INPUT
// naming the line where a time does not come after the one before or is not within [t0, tf], or text that is no number,
// or the column that is missing; MORAY_MEMORY. Free with moray_data_free in any case.
MORAY_API moray_status moray_data_read(moray_data *data, const char *const *names, int ny, double t0, double tf,
                                       const char *path);
MORAY_API void moray_data_free(moray_data *data);

// One observation of a solution. Where a control is observed, the one value of it at that time serves the prediction
// nearly for nothing, since it acts on the dynamics for a moment only: it can jump there to the datum (a spike as wide
// as an interval). Observe states, or penalise the control's square or its rate in an integral.
typedef struct moray_residual {
    int phase, row, channel; // value[row][channel] of the phase
    double time, observed, predicted, weight;
} moray_residual;

// Those that are not missing, phase by phase in the order they were given in; residual may be NULL. Returns how many.
MORAY_API int moray_solution_residuals(const moray_solution *solution, moray_residual *residual);

// Name of a channel of a phase: text[size].
MORAY_API void moray_observation_name(const moray_solution *solution, int phase, int channel, char *text, int size);

// Covariance of the static parameters at a solution, from the Jacobian of the predictions along what active
// constraints leave free (Gauss and Newton's; the curvature of the model is left out): variance (A' W A)^-1. Intervals
// are those of Student's distribution where the variance is estimated, of the normal one where it is known.
typedef struct moray_fit {
    int observations, freedom; // in the objective; free directions of the programme, controls and states included
    double sum;                // weighted sum of squares, before any robust loss
    double variance;           // of an observation of weight 1: sum / (observations - freedom), or 1 where known; NAN
                               // where there are no more observations than free directions
    int ns;
    double *value, *error; // [ns] parameters and their standard errors; INFINITY: not determined
    double *lower, *upper; // [ns] of the interval of 95 %
    double *covariance;    // [ns][ns]; NAN in rows of what is not determined
    int undetermined;      // parameters that the data do not determine, one of them or a combination
    char names[400];       // theirs, in one text; empty if none
} moray_fit;

// known: weights are 1 / variance of the observations. Error: MORAY_NOT_SOLVED where the solution is none, MORAY_INPUT
// where the objective has no observations, MORAY_NUMERIC, MORAY_MEMORY. Free with moray_fit_free in any case.
MORAY_API moray_status moray_fit_new(moray_fit *fit, const moray_solution *solution, bool known);
MORAY_API void moray_fit_free(moray_fit *fit);

// Half the width of the interval that holds 95 % of Student's distribution of so many degrees of freedom; 0: normal.
MORAY_API double moray_student_95(int degrees);

MORAY_END

#endif
