// SPDX-License-Identifier: MIT
//
// The swimmer as the plant of a closed loop: its gait jumps with the schedule, its control is the offset phi_0 with its
// derivatives, and who steers is shown the swimmer.
#include "moray/snake/swim.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/control/closed_loop.h"
#include "snake/swim/closed_loop_plant.h"

static moray_status check_plan(const moray_swim_plan *plan)
{
    if (plan->n_changes < 1 || !(plan->schedule[0].t <= plan->t0))
        return moray_error(MORAY_INPUT, "the schedule needs a gait that begins not after t0 = %g", plan->t0);
    for (int i = 1; i < plan->n_changes; i++) {
        if (!(plan->schedule[i].t > plan->schedule[i - 1].t))
            return moray_error(MORAY_INPUT, "schedule[%d].t = %g: must lie after that of the gait before, %g", i,
                               plan->schedule[i].t, plan->schedule[i - 1].t);
    }
    return moray_ok();
}

typedef struct swim_run {
    const moray_swim_plan *plan;
    swim_plant plant;
    moray_ode ode;
    double *change;    // [n_changes] times
    moray_status left; // the water's table
} swim_run;

static bool rates(double t, const double *x, const double *u, double *dx, void *self)
{
    swim_run *r = self;
    if (r->plan->controller)
        moray_swim_plant_steer(&r->plant, u);
    return r->ode.rhs(t, x, dx, r->ode.self);
}

static void change_gait(int k, void *self)
{
    swim_run *r = self;
    r->plant.gait = r->plan->schedule[k].gait;
}

static moray_swim_sample sample_of(swim_run *r, const moray_closed_loop_sample *sample)
{
    if (r->plan->controller)
        moray_swim_plant_steer(&r->plant, sample->u);
    return moray_swim_plant_sample(&r->plant, sample->t, sample->x);
}

static void steer(double t, double *u, const void *self)
{
    const moray_swim_controller *controller = ((const swim_run *)self)->plan->controller;
    const moray_offset offset = controller->offset(t, controller->self);
    u[0] = offset.value;
    u[1] = offset.rate;
    u[2] = offset.acceleration;
}

static moray_status measure(const moray_closed_loop_sample *sample, void *self)
{
    swim_run *r = self;
    const moray_swim_sample shown = sample_of(r, sample);
    MORAY_TRY(moray_swim_afloat(r->plan->water, &shown));
    return r->plan->controller->measure(&shown, r->plan->controller->self);
}

static bool observe(const moray_closed_loop_sample *sample, void *self)
{
    swim_run *r = self;
    const moray_swim_sample shown = sample_of(r, sample);
    r->left = moray_swim_afloat(r->plan->water, &shown);
    return !moray_failed(r->left) && r->plan->observe(&shown, r->plan->observer);
}

static moray_status run(swim_run *r, const moray_sim_settings *settings)
{
    const moray_swim_plan *plan = r->plan;
    const moray_swim_controller *steering = plan->controller;
    moray_controller controller = {.nu = SWIM_CONTROLS, .control = steer, .self = r};
    if (steering && steering->measure) {
        controller.measure = measure;
        controller.period = steering->period;
    }
    const moray_closed_loop_spec loop = {
        .plant = {.nx = r->ode.n, .nu = steering ? SWIM_CONTROLS : 0, .rates = rates, .self = r},
        .controller = steering ? &controller : NULL,
        .jumps = {.times = r->change, .n = plan->n_changes, .change = change_gait, .self = r},
        .t0 = plan->t0,
        .t1 = plan->t1,
        .times = plan->times,
        .n_times = plan->n_times,
        .observe = plan->observe ? observe : NULL,
        .observer = r,
        .settings = *settings,
        .statistics = plan->statistics};
    return moray_closed_loop_run(&loop, r->plant.x);
}

static moray_status prepare(swim_run *r, moray_swimmer *swimmer, const double *x)
{
    const moray_swim_plan *plan = r->plan;
    MORAY_TRY(moray_swim_plant_new(&r->plant, swimmer, &plan->schedule[0].gait));
    r->plant.water = plan->water;
    r->plant.current = moray_swim_current(swimmer, plan);
    r->ode = moray_swim_plant_ode(&r->plant);
    r->change = calloc((size_t)plan->n_changes, sizeof *r->change);
    if (!r->change)
        return moray_error(MORAY_MEMORY, "no memory for %d changes of gait", plan->n_changes);
    for (int k = 0; k < plan->n_changes; k++)
        r->change[k] = plan->schedule[k].t;
    memcpy(r->plant.x, x, (size_t)r->plant.n_states * sizeof *x);
    return moray_ok();
}

moray_status moray_swim_run(moray_swimmer *swimmer, const moray_sim_settings *settings, const moray_swim_plan *plan,
                            double *x, double *energy)
{
    double V[2];
    MORAY_TRY(check_plan(plan));
    swim_run r = {.plan = plan, .left = moray_ok()};
    moray_swimmer_current(swimmer, V);
    moray_status status = prepare(&r, swimmer, x);
    if (!moray_failed(status)) {
        status = run(&r, settings);
        if (!moray_failed(status))
            status = r.left;
        memcpy(x, r.plant.x, (size_t)r.plant.n_states * sizeof *x);
        if (energy)
            *energy = r.plant.x[r.plant.n_states];
    }
    moray_swimmer_set_current(swimmer, V[0], V[1]);
    free(r.change);
    moray_swim_plant_free(&r.plant);
    return status;
}
