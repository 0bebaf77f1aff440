// SPDX-License-Identifier: MIT
//
// Fronts of speed against power: the fastest gaits within ever less mean power, of the joints or at the terminals of
// their motors.
#ifndef PROBLEMS_GAIT_PARETO_PARETO_H
#define PROBLEMS_GAIT_PARETO_PARETO_H

#include "gait/job/job.h"

enum { PARETO_KINDS = 3, PARETO_FRONTS = 2 * PARETO_KINDS, PARETO_POINTS = 60 };

// The fastest gaits of one model and one kind of motion, by falling power; the first has no limit of it. Plain data:
// once it is found, the stages hold no solutions.
typedef struct pareto_front {
    moray_model model;
    int kind;                // lateral, eel-like, free
    int n;                   // solved, within a limit that makes a difference (or the first), certified and swum
    stage at[PARETO_POINTS]; // of them
    moray_status why;        // it is left out, n = 0
} pareto_front;

typedef struct pareto {
    gait_job job; // its taper: that of the free kind
    int points;
    double eel_taper, least_share; // of the power that the fastest lateral gait uses
    pareto_front *front;           // [fronts], by model and kind; owned
    int fronts, kinds;
} pareto;

extern const char *const pareto_kinds[PARETO_KINDS]; // "lateral", "eel-like", "free taper"

// What a table, a figure or a file shows of a gait.
enum {
    PARETO_POWER,      // [W] in its own model
    PARETO_SPEED,      // along the course [m/s]
    PARETO_THETA_MAX,  // of the middle [deg]
    PARETO_OMEGA,      // [deg/s]
    PARETO_DELTA,      // [deg]
    PARETO_TAPER,      //
    PARETO_PRICE,      // d speed / d power [m/s per W]
    PARETO_TRUE_SPEED, // as simulated on the first-principles model; NaN where the course is not held
    PARETO_TRUE_POWER, //
    PARETO_VALUES
};
void pareto_values(const pareto *run, const stage *at, double value[PARETO_VALUES]);

// Fastest speed of a front within a mean power [W] of its own model, between its points; NaN below the last.
double pareto_speed_at(const pareto_front *front, double power);

// Whether a front with free taper never uses it.
bool pareto_is_lateral(const pareto_front *front);

// What moray_results wants of a pareto.
void pareto_summary(const void *run, moray_json *json);
moray_status pareto_write(const void *run, moray_output *output);
moray_status pareto_draw(const void *run, moray_output *output);

moray_status pareto_report(gait_job *job);

#endif
