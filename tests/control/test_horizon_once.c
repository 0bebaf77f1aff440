// SPDX-License-Identifier: MIT
//
// Plans of a receding horizon are solved once, to the tolerance given: none is certified.
#include "moray/control/receding_horizon.h"
#include "tap.h"

// A mass is braked by a control whose limits it is at for most of the time: x'' = u, integral of x^2 + u^2.
static void mass(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->g[0] = at->x[0] * at->x[0] + at->u[0] * at->u[0];
}

static void cost(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase->q[0];
}

static moray_status make(void *self, double t, const double *x, void **problem, const moray_ocp **ocp)
{
    moray_ocp *made;
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = mass,
                                    .t0 = moray_fixed(t),
                                    .tf = moray_fixed(t + 2),
                                    .u = MORAY_BOUNDS(moray_between(-0.3, 0.3)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(x[0]), moray_fixed(x[1]))};
    MORAY_TRY(moray_ocp_new(&made, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = cost}));
    ++*(int *)self;
    *problem = made;
    *ocp = made;
    return moray_ok();
}

static void free_ocp(void *problem)
{
    moray_ocp_free(problem);
}

static bool count(void *observer, const moray_progress *at)
{
    *(int *)observer += at->iteration == 0;
    return true;
}

static bool coasts(double t, const double *x, const double *u, double *dx, void *self)
{
    (void)t, (void)self;
    dx[0] = x[1];
    dx[1] = u[0];
    return true;
}

int main(void)
{
    int plans = 0, solves = 0;
    moray_settings settings = moray_settings_default();
    settings.scheme = "radau3";
    settings.intervals = 12;
    settings.tolerance = 1e-5;
    settings.progress = count;
    settings.observer = &solves;

    void *problem;
    const moray_ocp *ocp;
    moray_solution *solution;
    double x[2] = {1, 0.3};
    CHECK_OK(make(&plans, 0, x, &problem, &ocp), "a problem");
    for (int rough = 0; rough < 2; rough++) {
        settings.rough = rough;
        solves = 0;
        CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
        CHECK(solves == (rough ? 1 : 2), "%s: %d solves", rough ? "roughly" : "for a certificate", solves);
        moray_solution_free(solution);
    }
    free_ocp(problem);

    moray_receding_horizon *receding;
    settings.rough = false;
    plans = solves = 0;
    const moray_receding_horizon_spec spec = {
        .replanner = {.nx = 2, .nu = 1, .make = make, .free = free_ocp, .self = &plans},
        .settings = settings,
        .horizon = 2,
        .interval = 0.25};
    CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
    const moray_controller controller = moray_receding_horizon_controller(receding);
    const moray_closed_loop_spec loop = {.plant = {.nx = 2, .nu = 1, .rates = coasts},
                                         .controller = &controller,
                                         .t1 = 2,
                                         .settings = moray_sim_settings_default()};
    CHECK_OK(moray_closed_loop_run(&loop, x), "sailed");
    CHECK(plans >= 8 && solves == plans, "%d plans, %d solves", plans, solves);
    moray_receding_horizon_free(receding);
    return tap_done();
}
