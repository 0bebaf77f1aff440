// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_GAIT_OVER_H
#define SRC_SNAKE_GAIT_OVER_H

#include "moray/snake/gait_over.h"
#include "snake/gait/problem.h"

enum { OVER_NAME = 64 }; // of a parameter or an event
typedef char over_name[OVER_NAME];

struct moray_gait_over {
    int n, ns, ne;
    moray_over_goal goal;
    double speed[MORAY_SCENARIOS]; // the baseline's
    moray_gait_problem *problem[MORAY_SCENARIOS];
    moray_map plant[MORAY_SCENARIOS]; // theirs, with the parameters of all
    moray_phase_spec phase[MORAY_SCENARIOS];
    moray_bounds *bounds; // of s, then of e
    over_name *text;      // likewise
    const char **name;    // likewise
    moray_ocp *ocp;
};

#endif
