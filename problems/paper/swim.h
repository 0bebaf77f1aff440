// SPDX-License-Identifier: MIT
//
// Swimming over time, for studies that show it.
#ifndef PROBLEMS_PAPER_SWIM_H
#define PROBLEMS_PAPER_SWIM_H

#include "paper.h"

// What is swum: from rest at (0, p_y), straight along x, with the gaits of a schedule.
typedef struct paper_swim_plan {
    moray_model model;
    moray_swimmer *swimmer; // of that model; NULL: the rig's
    const moray_gait_change *schedule;
    int n_changes;
    double p_y;
} paper_swim_plan;

// Simulates to the last of n ascending times, with a sample at each. Error: those of moray_swim_run.
moray_status paper_swim_at(paper *p, const paper_swim_plan *plan, const double *times, int n, moray_swim_track **track);

// Simulates for a duration, with samples every `step` [s] from 0 on.
moray_status paper_swim(paper *p, const paper_swim_plan *plan, double duration, double step, moray_swim_track **track);

// Mean velocity over ground along x [m/s] in the last n_periods whole periods of a single gait, swum for a duration.
moray_status paper_mean_velocity(paper *p, const paper_swim_plan *plan, double duration, int n_periods, double *v_x);

// The heading [rad] at t on average over a period that ends there, from a finely sampled track.
double paper_mean_heading(const moray_swim_track *track, double t, double period);

// A quantity of a track's pose, as curves and files take it: n values beside track->t, p's own.
typedef enum { PAPER_P_X, PAPER_P_Y, PAPER_V_X, PAPER_V_Y, PAPER_HEADING_DEG, PAPER_QUANTITIES } paper_quantity;
moray_status paper_series(paper *p, const moray_swim_track *track, paper_quantity quantity, double **values);

// Figures of both models: the first-principles model first, as a solid line, and over it, dashed, the control-oriented
// one, which oscillates less; few points are marked. paper_compare: y[model][n] over x[n]; name and texts as in
// moray_figure.
extern const moray_model paper_model_order[2];
moray_curve paper_model_curve(moray_model model, const double *x, const double *y, int n);
moray_status paper_compare(paper *p, const char *name, const char *title, const char *x_label, const char *y_label,
                           const double *x, const double *const y[2], int n);

// Both models over the same times, by moray_model.
typedef struct paper_pair {
    const double *t;
    double *of[PAPER_QUANTITIES][2];
    int n;
} paper_pair;
moray_status paper_pair_of(paper *p, moray_swim_track *const track[2], paper_pair *pair);

// The first quantities as STUDY.csv; one over time; the positions, with points beside them unless NULL.
moray_status paper_pair_csv(paper *p, const paper_pair *pair, int n_quantities);
moray_status paper_pair_over_time(paper *p, const paper_pair *pair, paper_quantity quantity, const char *name,
                                  const char *title, const char *y_label);
moray_status paper_pair_position(paper *p, const paper_pair *pair, const char *title, const moray_curve *points);

#endif
