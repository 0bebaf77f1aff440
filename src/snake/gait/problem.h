// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_GAIT_PROBLEM_H
#define SRC_SNAKE_GAIT_PROBLEM_H

#include "snake/gait/endpoint.h"

struct moray_gait_problem {
    moray_gait_problem_spec spec;
    moray_plant_size size;
    moray_map plant;
    struct gait_endpoint endpoint;
    moray_bounds *block;   // x0, c, e, s in turn
    const char **names;    // of e, then of c
    gait_name *path_names; // that they point into
    moray_ocp *ocp;
};

#endif
