// SPDX-License-Identifier: MIT
//
// Slopes that drive an output, and such as move no more than its last digits.
#include "tap.h"

#include "moray/ocp.h"

#include "ocp/certificate/witness.h"

// ---- What drives ----

enum { FALLS, NEGATIVE, POSITIVE, AT_END, DRIVEN, SMALL, ROWS };
static const double tiny = 1e-16, small = 1e-13;

static void cruise(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num x = at->x[0], u = at->u[0];
    (void)data;
    out->f[0] = -1 + 0 * u;
    out->c[FALLS] = x + tiny * u; // from 0 to -1
    out->c[NEGATIVE] = -1 + tiny * u;
    out->c[POSITIVE] = 1 + tiny * u;
    out->c[AT_END] = 1 + x + tiny * u; // from 1 to 0
    out->c[DRIVEN] = -1 - 3 * u;
    out->c[SMALL] = -1 + small * u;
    out->g[0] = (u - x) * (u - x);
}

static void cost(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static void test_driving(void)
{
    static const double told[] = {0, 0, 0, 0, 3, 1e-13};
    const moray_bounds wide = moray_between(-10, 10);
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nc = ROWS,
                                    .nq = 1,
                                    .continuous = cruise,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-1, 1)),
                                    .c = MORAY_BOUNDS(wide, wide, wide, wide, wide, wide)};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    struct witness w;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = cost}), "cruise");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    const int n_out = solution->transcription->phase[0].map->n_out, nx = 1, control = 1;
    for (int i = 0; i < ROWS; i++) {
        const double slope = w.phase[0].slope[control * n_out + nx + i];
        CHECK(fabs(slope - told[i]) <= 1e-10 * told[i], "the control drives row %d by %g", i, slope);
    }
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_driving();
    return tap_done();
}
