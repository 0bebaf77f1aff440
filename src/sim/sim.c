// SPDX-License-Identifier: MIT
#include "sim/sim.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const sim_method *const methods[] = {[MORAY_SIM_EXPLICIT] = &moray_sim_explicit,
                                            [MORAY_SIM_ARKODE] = &moray_sim_arkode,
                                            [MORAY_SIM_TR_BDF2] = &moray_sim_tr_bdf2};

moray_status moray_sim_new(moray_sim **out, const moray_ode *ode, const moray_sim_settings *settings)
{
    *out = NULL;
    if (ode->n < 1)
        return moray_error(MORAY_INPUT, "n = %d: an equation to simulate has at least 1 state", ode->n);
    MORAY_TRY(moray_sim_settings_check(settings));
    moray_sim *sim = calloc(1, sizeof *sim);
    if (!sim)
        return moray_error(MORAY_MEMORY, "cannot make a simulator of %d states: out of memory", ode->n);
    *sim = (moray_sim){.ode = *ode, .settings = *settings, .method = methods[settings->method], .why = "out of memory"};
    sim->x = calloc((size_t)ode->n, sizeof *sim->x);
    if (sim->x && sim->method->build(sim)) {
        *out = sim;
        return moray_ok();
    }
    const moray_status status = moray_error(MORAY_MEMORY, "cannot make a simulator of %d states: %s", ode->n, sim->why);
    moray_sim_free(sim);
    return status;
}

void moray_sim_free(moray_sim *sim)
{
    if (!sim)
        return;
    sim->method->release(sim);
    free(sim->x);
    free(sim);
}

bool moray_sim_rhs(moray_sim *sim, double t, const double *x, double *dx)
{
    sim->statistics.rhs_evaluations++;
    bool inside = sim->ode.rhs(t, x, dx, sim->ode.self);
    for (int i = 0; inside && i < sim->ode.n; i++)
        inside = isfinite(dx[i]);
    if (!inside) {
        sim->outside = true;
        sim->outside_t = t;
    }
    return inside;
}

void moray_sim_accept(moray_sim *sim, double t, const double *x)
{
    sim->t = t;
    memcpy(sim->x, x, (size_t)sim->ode.n * sizeof *sim->x);
    sim->outside = false;
    sim->statistics.steps++;
}

moray_status moray_sim_stuck(const moray_sim *sim, double stop, const char *why)
{
    if (sim->outside)
        return moray_error(
            MORAY_NUMERIC,
            "simulation stopped at t = %.10g on its way to %g: the right-hand side is outside its domain "
            "or not finite at t = %.10g",
            sim->t, stop, sim->outside_t);
    return moray_error(MORAY_NUMERIC, "simulation stopped at t = %.10g on its way to %g: %s", sim->t, stop, why);
}

moray_status moray_sim_start(moray_sim *sim, double t, const double *x)
{
    for (int i = 0; i < sim->ode.n; i++) {
        if (!isfinite(x[i]))
            return moray_error(MORAY_NUMERIC, "simulation cannot start at t = %g: x[%d] = %g", t, i, x[i]);
    }
    memmove(sim->x, x, (size_t)sim->ode.n * sizeof *sim->x);
    sim->t = t;
    return sim->method->restart(sim);
}

moray_status moray_sim_advance(moray_sim *sim, double t)
{
    if (!(t >= sim->t && isfinite(t)))
        return moray_error(MORAY_INPUT, "simulation to t = %.10g: must be finite and not before the present t = %.10g",
                           t, sim->t);
    if (t - sim->t <= 100 * DBL_EPSILON * fmax(t, -sim->t)) { // too short a way for a step
        sim->t = t;
        return moray_ok();
    }
    sim->outside = false;
    for (long steps = 0; sim->t < t; steps++) {
        if (steps >= sim->settings.max_steps)
            return moray_error(MORAY_NUMERIC, "simulation stopped at t = %.10g on its way to %g: %ld steps (max_steps)",
                               sim->t, t, steps);
        MORAY_TRY(sim->method->step(sim, t));
    }
    return moray_ok();
}

double moray_sim_time(const moray_sim *sim)
{
    return sim->t;
}

const double *moray_sim_state(const moray_sim *sim)
{
    return sim->x;
}

moray_sim_statistics moray_sim_get_statistics(const moray_sim *sim)
{
    return sim->statistics;
}
