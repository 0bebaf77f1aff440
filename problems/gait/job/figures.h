// SPDX-License-Identifier: MIT
//
// Inside the figures of a gait job: one period of steady swimming.
#ifndef PROBLEMS_GAIT_JOB_FIGURES_H
#define PROBLEMS_GAIT_JOB_FIGURES_H

#include "job.h"

enum { GAIT_POINTS = 121 }; // of the period, the last one after the first

typedef struct gait_period {
    const gait_job *job;
    moray_output *output;
    const char *what; // "The recommended gait"
    const moray_gait *gait;
    const moray_swim_track *track; // [GAIT_POINTS]
    moray_swimmer *swimmer;
    int joints;
    double *phi, *rate; // [GAIT_POINTS][joints]
    bool control;
} gait_period;

// Joints, their efforts, power and speed over the period, with their limits; the phase portrait. Error: MORAY_MEMORY,
// those of moray_output_figure.
moray_status gait_period_draw_time(const gait_period *period);

// The body: its shapes over the period, and what the water does along it. Error: the same.
moray_status gait_period_draw_body(const gait_period *period);

// Draws a figure with these curves, its title behind `what`.
moray_status gait_period_draw(const gait_period *period, moray_figure figure, const moray_curve *curves, int n);

#endif
