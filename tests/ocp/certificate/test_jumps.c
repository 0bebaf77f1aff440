// SPDX-License-Identifier: MIT
//
// Jumps of functions with a state, which only controls show that a solution does not use.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"
#include "rk4.h"

static const int rk4_steps = 40;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

// Least integral of u^2 (2 + s), x' = 1 from 0 to 1: u = 0. For u > 0, s jumps by 3 where x = edge, or is 0; for u < 0
// it rises steeply by 2 soon behind the edge.
static const double edge = 0.4321, behind = 1e-3, rise = 1e-4;

static void beside(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num u = at->u[0];
    const bool jumps = *(const bool *)data;
    const double x = creal(at->x[0]);
    const moray_num up = jumps && x > edge ? 3 : 0;
    const double slope = 1 / pow(cosh((x - edge - behind) / rise), 2) / rise;
    const moray_num down = moray_complex(tanh((x - edge - behind) / rise), slope * cimag(at->x[0]));
    out->f[0] = 1 + 0 * u;
    out->g[0] = u * u * (2 + (creal(u) > 0 ? up : down));
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = 1 + at->phase[0].q[0];
}

static void test_beside(bool jumps)
{
    const moray_phase_spec phase = {.name = "line",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = beside,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-1, 1))};
    const moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    moray_certificate certificate;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = total, .data = &jumps}),
             "a line");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    if (jumps)
        CHECK(certificate.unseen > 0.5, "a jump is found beside a steep rise that is none: %.2g", certificate.unseen);
    else
        CHECK(certificate.unseen < 0.05, "the rise alone is no jump: %.2g", certificate.unseen);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_beside(true);
    test_beside(false);
    return tap_done();
}
