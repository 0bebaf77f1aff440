// SPDX-License-Identifier: MIT
//
// Numbers over time as smooth functions: regression splines, and a gait (25) of all joints.
#ifndef SRC_SNAKE_IDENTIFY_MOTION_H
#define SRC_SNAKE_IDENTIFY_MOTION_H

#include "moray/snake/identify.h"

// A quintic spline of equal pieces by least squares.
struct smooth {
    double from, width; // of a piece
    int pieces;
    double *c;    // [pieces + 5]
    double noise; // standard deviation of the data about it
    int freedom;  // of that
};

// Of the values y[k * stride] that are not NAN, with as many pieces as generalised cross-validation takes. Error:
// MORAY_INPUT where there are too few values; MORAY_MEMORY, MORAY_NUMERIC. Free with moray_smooth_free in any case.
moray_status moray_smooth_fit(struct smooth *s, int n, const double *t, const double *y, int stride);
void moray_smooth_free(struct smooth *s);
void moray_smooth_at(const struct smooth *s, double t, double d[3]); // value, first and second derivative

// Joints of a run.
struct motion {
    int joints;
    bool on_gait;
    moray_gait gait;      // of the first-principles model, at t + shift
    double shift, rms;    // rms: of the log about it [rad]
    struct smooth *joint; // [joints] otherwise
    char text[160];
};

// Error: MORAY_INPUT where the log's joints are not as wanted, have gaps or are no gait; MORAY_MEMORY, MORAY_NUMERIC.
// Free with moray_motion_free in any case.
moray_status moray_motion_new(struct motion *motion, const moray_swim_log *log, moray_logged_joints wanted);
void moray_motion_free(struct motion *motion);

// The gait (25) nearest to the angles: gait, shift and rms. Error: MORAY_NUMERIC where there is none.
moray_status moray_motion_fit_gait(struct motion *motion, const moray_swim_log *log);

#endif
