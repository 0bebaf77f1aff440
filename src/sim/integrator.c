// SPDX-License-Identifier: MIT
#include "moray/sim.h"

#include <math.h>
#include <string.h>

#include "sim/times.h"

moray_status moray_sim_check_times(double t0, double t1, const double *times, int n_times)
{
    if (!(t1 >= t0 && isfinite(t0) && isfinite(t1)))
        return moray_error(MORAY_INPUT, "simulation from t0 = %g to t1 = %g: must be finite, t1 not before t0", t0, t1);
    for (int i = 0; i < n_times; i++) {
        const double earliest = i > 0 ? times[i - 1] : t0;
        if (!(times[i] >= earliest && times[i] <= t1))
            return moray_error(MORAY_INPUT, "times[%d] = %g: must lie between %g and %g", i, times[i], earliest, t1);
    }
    return moray_ok();
}

static moray_status visit(moray_sim *sim, double t1, const double *times, int n_times, moray_ode_observer *observe,
                          void *observer)
{
    for (int i = 0; i < n_times; i++) {
        MORAY_TRY(moray_sim_advance(sim, times[i]));
        if (!observe(times[i], moray_sim_state(sim), observer))
            return moray_ok();
    }
    return moray_sim_advance(sim, t1);
}

static moray_status run(const moray_integrator *self, const moray_ode *ode, double t0, double t1, double *x,
                        const double *times, int n_times, moray_ode_observer *observe, void *observer)
{
    MORAY_TRY(moray_sim_check_times(t0, t1, times, n_times));
    moray_sim *sim;
    MORAY_TRY(moray_sim_new(&sim, ode, self->self));
    moray_status status = moray_sim_start(sim, t0, x);
    if (!moray_failed(status))
        status = visit(sim, t1, times, n_times, observe, observer);
    memcpy(x, moray_sim_state(sim), (size_t)ode->n * sizeof *x);
    moray_sim_free(sim);
    return status;
}

moray_integrator moray_sim_integrator(const moray_sim_settings *settings)
{
    return (moray_integrator){.run = run, .self = settings};
}
