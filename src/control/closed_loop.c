// SPDX-License-Identifier: MIT
#include "moray/control/closed_loop.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/times.h"

// A simulation on its way: the first jump not yet made, the measurements so far.
typedef struct closed_loop {
    const moray_closed_loop_spec *spec;
    moray_sim *sim;
    double *u; // [nu] scratch
    int jump, measurements;
} closed_loop;

// A period that is lost in the rounding of t, or nearly so, would never end.
static moray_status check_period(const moray_closed_loop_spec *spec)
{
    const double period = spec->controller->period, shortest = 1e-9 * fmax(fabs(spec->t0), fabs(spec->t1));
    if (!(period > 0))
        return moray_error(MORAY_INPUT, "period of the controller = %g: must be above 0", period);
    if (period < shortest)
        return moray_error(MORAY_INPUT, "period of the controller = %g: must be at least %g between t = %g and %g",
                           period, shortest, spec->t0, spec->t1);
    return moray_ok();
}

static moray_status check(const moray_closed_loop_spec *spec)
{
    const moray_controller *controller = spec->controller;
    if (spec->plant.nx < 1 || spec->plant.nu < 0)
        return moray_error(MORAY_INPUT, "plant of %d states and %d controls: must be at least 1 and 0", spec->plant.nx,
                           spec->plant.nu);
    if (controller && controller->nu != spec->plant.nu)
        return moray_error(MORAY_INPUT, "a controller of %d controls for a plant of %d", controller->nu,
                           spec->plant.nu);
    if (controller && controller->measure)
        MORAY_TRY(check_period(spec));
    for (int k = 1; k < spec->jumps.n; k++)
        if (!(spec->jumps.times[k] >= spec->jumps.times[k - 1]))
            return moray_error(MORAY_INPUT, "jump %d at t = %g: must not lie before the one before, %g", k + 1,
                               spec->jumps.times[k], spec->jumps.times[k - 1]);
    MORAY_TRY(moray_sim_check_times(spec->t0, spec->t1, spec->times, spec->n_times));
    if (spec->n_times > 0 && !spec->observe)
        return moray_error(MORAY_INPUT, "%d times to be observed, and no observer", spec->n_times);
    return moray_ok();
}

static void control_at(const closed_loop *loop, double t)
{
    const moray_controller *controller = loop->spec->controller;
    if (controller)
        controller->control(t, loop->u, controller->self);
}

static bool rhs(double t, const double *x, double *dx, void *self)
{
    const closed_loop *loop = self;
    const moray_controlled_ode *plant = &loop->spec->plant;
    control_at(loop, t);
    return plant->rates(t, x, loop->u, dx, plant->self);
}

static moray_closed_loop_sample sample_at(const closed_loop *loop, double t)
{
    control_at(loop, t);
    return (moray_closed_loop_sample){.t = t, .x = moray_sim_state(loop->sim), .u = loop->u};
}

static double next_jump(const closed_loop *loop)
{
    return loop->jump < loop->spec->jumps.n ? loop->spec->jumps.times[loop->jump] : INFINITY;
}

// Counted from t0, so that rounding does not add up.
static double next_measurement(const closed_loop *loop)
{
    const moray_controller *controller = loop->spec->controller;
    return controller && controller->measure ? loop->spec->t0 + loop->measurements * controller->period : INFINITY;
}

static moray_status stop_at(closed_loop *loop, double stop)
{
    const moray_controller *controller = loop->spec->controller;
    if (stop > moray_sim_time(loop->sim))
        MORAY_TRY(moray_sim_advance(loop->sim, stop));
    if (next_jump(loop) <= stop)
        loop->spec->jumps.change(loop->jump++, loop->spec->jumps.self);
    if (next_measurement(loop) <= stop) {
        const moray_closed_loop_sample sample = sample_at(loop, stop);
        loop->measurements++;
        MORAY_TRY(controller->measure(&sample, controller->self));
    }
    return moray_sim_start(loop->sim, moray_sim_time(loop->sim), moray_sim_state(loop->sim));
}

// Advances to t with every jump and measurement up to and at t made on the way.
static moray_status advance(closed_loop *loop, double t)
{
    for (double stop; (stop = fmin(next_jump(loop), next_measurement(loop))) <= t;)
        MORAY_TRY(stop_at(loop, stop));
    return moray_sim_advance(loop->sim, t);
}

static moray_status follow(closed_loop *loop)
{
    const moray_closed_loop_spec *spec = loop->spec;
    for (int i = 0; i < spec->n_times; i++) {
        MORAY_TRY(advance(loop, spec->times[i]));
        const moray_closed_loop_sample sample = sample_at(loop, spec->times[i]);
        if (!spec->observe(&sample, spec->observer))
            return moray_ok();
    }
    return advance(loop, spec->t1);
}

static moray_status run(closed_loop *loop, double *x)
{
    const moray_closed_loop_spec *spec = loop->spec;
    const moray_ode ode = {.n = spec->plant.nx, .rhs = rhs, .self = loop};
    MORAY_TRY(moray_sim_new(&loop->sim, &ode, &spec->settings));
    moray_status status = moray_sim_start(loop->sim, spec->t0, x);
    if (!moray_failed(status)) {
        status = follow(loop);
        memcpy(x, moray_sim_state(loop->sim), (size_t)ode.n * sizeof *x);
        if (spec->statistics)
            *spec->statistics = moray_sim_get_statistics(loop->sim);
    }
    moray_sim_free(loop->sim);
    return status;
}

moray_status moray_closed_loop_run(const moray_closed_loop_spec *spec, double *x)
{
    MORAY_TRY(check(spec));
    closed_loop loop = {.spec = spec, .u = calloc((size_t)spec->plant.nu + 1, sizeof *loop.u)};
    if (!loop.u)
        return moray_error(MORAY_MEMORY, "no memory for %d controls", spec->plant.nu);
    const moray_status status = run(&loop, x);
    free(loop.u);
    return status;
}
