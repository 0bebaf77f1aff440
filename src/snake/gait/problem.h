// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_GAIT_PROBLEM_H
#define SRC_SNAKE_GAIT_PROBLEM_H

#include "snake/gait/endpoint.h"

struct moray_gait_problem {
    moray_gait_problem_spec spec;
    moray_plant_size size;
    moray_map plant;
    struct gait_endpoint endpoint;
    moray_bounds *block;    // x0, c, e, s in turn
    const char **names;     // of e, then of c
    gait_name *path_names;  // that they point into
    moray_phase_spec phase; // the period; refers to the above
    moray_bounds_list e, s;
    moray_ocp *ocp;
};

// The largest rate amplitude that a joint may have: the joints' own limit, or that of their motors; MORAY_INFINITY or
// more: any.
double moray_gait_most_rate(const moray_gait_problem_spec *spec);

// What a phase of a solution is for the problem, at its parameters s; power_price is left at 0.
moray_gait_prediction moray_gait_problem_read(const moray_gait_problem *problem, const moray_solution *solution,
                                              int phase, const double *s);

// States x[orbit->n][nx] of the plant from the swimmer's.
void moray_gait_problem_states(const moray_gait_problem *problem, const moray_swim_track *orbit, double *x);

#endif
