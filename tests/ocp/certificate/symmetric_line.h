// SPDX-License-Identifier: MIT
//
// Minimise -x(1)^2, x' = u, |u| <= 1, x(0) = 0: the optimum is -1, and the symmetric start u = 0 is stationary, a
// maximum.
#ifndef TESTS_OCP_SYMMETRIC_LINE_H
#define TESTS_OCP_SYMMETRIC_LINE_H

#include "moray/ocp.h"

static void symmetric_drift(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
}

static void symmetric_ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = -at->phase[0].xf[0] * at->phase[0].xf[0];
}

// Error: that of moray_ocp_new.
static inline moray_status symmetric_line_new(moray_ocp **ocp)
{
    const moray_phase_spec line = {.name = "line",
                                   .nx = 1,
                                   .nu = 1,
                                   .continuous = symmetric_drift,
                                   .t0 = moray_fixed(0),
                                   .tf = moray_fixed(1),
                                   .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                   .u = MORAY_BOUNDS(moray_between(-1, 1))};
    return moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 1, .phase = &line, .endpoint = symmetric_ends});
}

#endif
