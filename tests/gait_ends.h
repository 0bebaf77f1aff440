// SPDX-License-Identifier: MIT
#ifndef TESTS_GAIT_ENDS_H
#define TESTS_GAIT_ENDS_H

#include "snake/gait/endpoint.h"

// Objective and events of six states, from [x0, t0, xf, tf, q, s].
static inline void gait_ends(const struct gait_endpoint *ends, const double *in, int n_s, double *out)
{
    moray_num input[64], events[32];
    for (int i = 0; i < 15 + n_s; i++)
        input[i] = in[i];
    const moray_phase_ends period = {.x0 = input, .t0 = input[6], .xf = input + 7, .tf = input[13], .q = input + 14};
    moray_end_values values = {.e = events};
    moray_gait_ends(&(moray_ends){.phase = &period, .s = input + 15}, &values, ends);
    out[0] = creal(values.objective);
    for (int i = 0; i < moray_gait_events(ends); i++)
        out[1 + i] = creal(events[i]);
}

#endif
