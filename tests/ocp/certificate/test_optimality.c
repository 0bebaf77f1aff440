// SPDX-License-Identifier: MIT
//
// How far outside is outside, and what a violated equation is worth, at an iterate set by hand.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/certificate/optimality.h"

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->x[0];
}

static void weigh(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->s[0] - 3 * at->s[1];
    out->e[0] = 0 * at->s[0] - 7.25; // where 7 below 0 is asked for
}

static struct optimality measured(const moray_solution *solution, double first, double second, double lambda)
{
    const struct transcription *t = solution->transcription;
    struct witness w;
    struct optimality found;
    memset(solution->iterate.x, 0, (size_t)(4 * t->nlp.n + 2 * t->nlp.m) * sizeof(double));
    solution->iterate.x[t->layout.s] = first;
    solution->iterate.x[t->layout.s + 1] = second;
    solution->iterate.lambda[t->layout.events] = lambda;
    moray_transcription_jacobians(solution->transcription, solution->iterate.x);
    CHECK_OK(moray_witness_new(&w, solution), "witness");
    CHECK_OK(moray_measure_optimality(&w, &found), "optimality");
    found.improvement *= moray_witness_objective(&w);
    moray_witness_free(&w);
    return found;
}

// Bounds below and above 0, each with its part that solvers let it give way by.
static void test_bounds(const moray_solution *solution)
{
    static const double part = 2e-8, bounds[2][2] = {{-400, -300}, {500, 800}};
    const int first = solution->transcription->nlp.m + solution->transcription->layout.s;
    for (int j = 0; j < 2; j++)
        for (int upper = 0; upper < 2; upper++) {
            const double bound = bounds[j][upper], step = (upper ? 1 : -1) * part * fabs(bound);
            for (int times = 0; times < 3; times++) { // within, almost as far as it gives way, beyond
                const double at = bound + step * (times == 0 ? -1 : times == 1 ? 0.9 : 30);
                const struct optimality o = measured(solution, j == 0 ? at : -350, j == 1 ? at : 600, 0);
                const bool outside = o.row == first + j;
                CHECK(outside == (times == 2), "%.9g beside %g: %d", at, bound, o.row);
            }
        }
}

static void test_equation(const moray_solution *solution)
{
    const double none = measured(solution, -350, 600, 0).improvement;
    for (int sign = -1; sign <= 1; sign += 2) {
        const double gain = measured(solution, -350, 600, 4000 * sign).improvement - none;
        CHECK_RELATIVE(gain, 1000, 1e-9, "a multiplier times a violation, whatever the sign");
    }
}

int main(void)
{
    const moray_phase_spec phase = {
        .nx = 1, .continuous = still, .tf = moray_fixed(1), .x0 = MORAY_BOUNDS(moray_fixed(0))};
    const moray_bounds low = moray_between(-400, -300), high = moray_between(500, 800);
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    settings.max_iterations = 0;
    for (int event = 0; event < 2; event++) { // free, so that bounds alone are outside; fixed
        const moray_bounds asked = event ? moray_fixed(-7) : moray_free();
        CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1,
                                                       .phase = &phase,
                                                       .ns = 2,
                                                       .s = MORAY_BOUNDS(low, high),
                                                       .ne = 1,
                                                       .e = MORAY_BOUNDS(asked),
                                                       .endpoint = weigh}),
                 "problem");
        CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
        if (event)
            test_equation(solution);
        else
            test_bounds(solution);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    return tap_done();
}
