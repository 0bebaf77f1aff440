// SPDX-License-Identifier: MIT
//
// The stroboscopic map of a swimmer with feedback around it: how heading and offset from a line come back from one
// period of the gait to the next.
#ifndef MORAY_SNAKE_POINCARE_H
#define MORAY_SNAKE_POINCARE_H

#include "moray/export.h"
#include "moray/num.h"
#include "moray/snake/controllers.h"

MORAY_BEGIN

// Feedback of the heading towards 0, or with a lookahead towards the line y = 0: target - atan(p_y / lookahead).
typedef struct moray_poincare_spec {
    const moray_robot *robot;
    const moray_straight_motion *straight; // swims along x, in still water
    double gain;                           // of the swimmer's offset [m/rad or rad/rad]; 0: nobody steers
    double lookahead;                      // [m]; 0: the heading alone
    int looks;                             // of the feedback a period, at least 8
} moray_poincare_spec;

enum { MORAY_POINCARE_STATES = 6 }; // heading, p_y, their rates and that of p_x, phi_0; without feedback phi_0 stays 0

// Multipliers of the map, the largest in modulus first, around the motion that it has come to. Where it steers no
// place, one of them is 1, for the shift of p_y; where nobody steers at all, two are, and phi_0's is 0. The joints
// follow what is commanded by (34), taken to be at rest behind it at the beginning of each period. Error: MORAY_INPUT,
// MORAY_NOT_SOLVED where the motion does not come back, those of moray_swim_run_on_gait.
#ifndef __cplusplus // which has complex numbers of its own
MORAY_API moray_status moray_poincare_multipliers(const moray_poincare_spec *spec,
                                                  moray_num multiplier[MORAY_POINCARE_STATES]);
#endif

MORAY_END

#endif
