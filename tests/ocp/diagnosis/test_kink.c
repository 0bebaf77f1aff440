// SPDX-License-Identifier: MIT
//
// Least fuel, the integral of |u|, over 1 m from rest to rest in 4 s: a solver that believes in derivatives goes to and
// fro about u = 0. The kink is named; where the integrand is smooth, and the iterations are too few, none is.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

static void fuel(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->g[0] = moray_abs(at->u[0]);
}

static void effort(const moray_node *at, moray_rates *out, const void *data)
{
    fuel(at, out, data);
    out->g[0] = at->u[0] * at->u[0] * at->u[0] * at->u[0];
}

// Not at the start, where x is 0.
static void fuel_on_the_way(const moray_node *at, moray_rates *out, const void *data)
{
    fuel(at, out, data);
    out->g[0] = moray_abs(at->u[0]) * at->x[0] * at->x[0];
}

// At a place, beside what is far steeper, then far less steep.
static void gate(const moray_node *at, moray_rates *out, const void *data)
{
    fuel(at, out, data);
    out->g[0] = at->u[0] * at->u[0] + moray_abs(at->x[0] - 0.375);
}

// The other way round.
static void arch(const moray_node *at, moray_rates *out, const void *data)
{
    fuel(at, out, data);
    out->g[0] = at->u[0] * at->u[0] - moray_abs(at->x[0] - 0.375);
}

static void faint_gate(const moray_node *at, moray_rates *out, const void *data)
{
    fuel(at, out, data);
    out->g[0] = at->u[0] * at->u[0] - 50 * at->x[0] + moray_abs(at->x[0] - 0.375);
}

static void burnt(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static void check(moray_continuous_fn *continuous, int iterations, const char *kink)
{
    const moray_phase_spec phase = {.name = "dash",
                                    .nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = continuous,
                                    .tf = moray_fixed(4),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-1, 1))};
    const moray_ocp_spec spec = {.name = "dash", .phases = 1, .phase = &phase, .endpoint = burnt};
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = iterations;
    CHECK_OK(moray_ocp_new(&ocp, &spec), "dash");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "dash");
    const char *said = moray_solution_diagnosis(solution);
    char named[200] = "kink";
    if (kink)
        snprintf(named, sizeof named, "Try: a smooth form of the integrand g[0] of phase dash, which has a kink in %s",
                 kink);
    CHECK(moray_solution_info(solution)->outcome != MORAY_NLP_SOLVED, "not solved");
    CHECK((strstr(said, named) != NULL) == (kink != NULL), "%s: %s", kink ? "a kink" : "none", said);
    CHECK(strstr(moray_solution_failure(solution).text, "Try: ") != NULL, "in one line: %s",
          moray_solution_failure(solution).text);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    check(fuel, 200, "control u[0]");
    check(effort, 3, NULL);
    check(fuel_on_the_way, 12, "control u[0]");
    check(gate, 3, "state x[0] at 0.38");
    check(arch, 3, "state x[0] at 0.38");
    check(faint_gate, 3, NULL);
    return tap_done();
}
