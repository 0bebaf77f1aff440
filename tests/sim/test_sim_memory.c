// SPDX-License-Identifier: MIT
//
// Every allocation of simulations fails once, each by itself.
#include "allocations.h"

#include "moray/sim.h"

static bool decay(double t, const double *x, double *dx, void *self)
{
    (void)t, (void)self;
    for (int i = 0; i < 3; i++)
        dx[i] = -(i + 1) * x[i];
    return true;
}

static moray_status simulate_by(moray_sim_method method)
{
    const double start[] = {1, 2, 3};
    moray_sim_settings settings = moray_sim_settings_default();
    moray_sim *sim;
    settings.method = method;
    settings.rtol = settings.atol = 1e-4;
    MORAY_TRY(moray_sim_new(&sim, &(moray_ode){.n = 3, .rhs = decay}, &settings));
    moray_status status = moray_sim_start(sim, 0, start);
    if (!moray_failed(status))
        status = moray_sim_advance(sim, 0.1);
    moray_sim_free(sim);
    return status;
}

static moray_status by_each(void)
{
    for (int method = MORAY_SIM_EXPLICIT; method <= MORAY_SIM_TR_BDF2; method++)
        MORAY_TRY(simulate_by((moray_sim_method)method));
    return moray_ok();
}

static moray_status integrate(void)
{
    double x[] = {1, 2, 3};
    const moray_sim_settings settings = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&settings);
    return integrator.run(&integrator, &(moray_ode){.n = 3, .rhs = decay}, 0, 0.1, x, NULL, 0, NULL, NULL);
}

int main(void)
{
    fail_each("simulators of each method", false, by_each);
    fail_each("an integrator", false, integrate);
    CHECK(uneven == 0, "what a run takes it frees, but for %ld", uneven);
    return tap_done();
}
