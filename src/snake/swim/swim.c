// SPDX-License-Identifier: MIT
#include "moray/snake/swim.h"

#include <math.h>
#include <string.h>

#include "snake/swim/closed_loop_plant.h"
#include "sim/times.h"

static moray_status check_plan(const moray_swim_plan *plan)
{
    MORAY_TRY(moray_sim_check_times(plan->t0, plan->t1, plan->times, plan->n_times));
    if (plan->n_changes < 1 || !(plan->schedule[0].t <= plan->t0))
        return moray_error(MORAY_INPUT, "the schedule needs a gait that begins not after t0 = %g", plan->t0);
    for (int i = 1; i < plan->n_changes; i++) {
        if (!(plan->schedule[i].t > plan->schedule[i - 1].t))
            return moray_error(MORAY_INPUT, "schedule[%d].t = %g: must lie after that of the gait before, %g", i,
                               plan->schedule[i].t, plan->schedule[i - 1].t);
    }
    if (plan->controller && plan->controller->look && !(plan->controller->period > 0))
        return moray_error(MORAY_INPUT, "period of the controller = %g: must be above 0", plan->controller->period);
    return moray_ok();
}

// A simulation on its way: the first change of gait not yet made, the looks of the controller so far.
typedef struct {
    const moray_swim_plan *plan;
    swim_plant *plant;
    moray_sim *sim;
    int change, looks;
} closed_loop;

static double next_change(const closed_loop *v)
{
    return v->change < v->plan->n_changes ? v->plan->schedule[v->change].t : INFINITY;
}

static double next_look(const closed_loop *v)
{
    const moray_controller *controller = v->plan->controller;
    return controller && controller->look ? v->plan->t0 + v->looks * controller->period : INFINITY;
}

// Advances to t with every change and look up to and at t made on the way.
static moray_status advance(closed_loop *v, double t)
{
    const moray_controller *controller = v->plan->controller;
    for (double stop; (stop = fmin(next_change(v), next_look(v))) <= t;) {
        if (stop > moray_sim_time(v->sim))
            MORAY_TRY(moray_sim_advance(v->sim, stop));
        if (next_change(v) <= stop)
            v->plant->gait = v->plan->schedule[v->change++].gait;
        if (next_look(v) <= stop) {
            const moray_swim_sample sample = moray_swim_plant_sample(v->plant, stop, moray_sim_state(v->sim));
            controller->look(&sample, controller->self);
            v->looks++;
        }
        MORAY_TRY(moray_sim_start(v->sim, moray_sim_time(v->sim), moray_sim_state(v->sim)));
    }
    return moray_sim_advance(v->sim, t);
}

static moray_status follow(closed_loop *v)
{
    const moray_swim_plan *plan = v->plan;
    for (int i = 0; i < plan->n_times; i++) {
        MORAY_TRY(advance(v, plan->times[i]));
        const moray_swim_sample sample = moray_swim_plant_sample(v->plant, plan->times[i], moray_sim_state(v->sim));
        if (!plan->observe(&sample, plan->observer))
            return moray_ok();
    }
    return advance(v, plan->t1);
}

// From the plant's state x to the plant's state x.
static moray_status run_plant(swim_plant *plant, const moray_sim_settings *settings, const moray_swim_plan *plan)
{
    closed_loop v = {.plan = plan, .plant = plant};
    const moray_ode ode = moray_swim_plant_ode(plant);
    MORAY_TRY(moray_sim_new(&v.sim, &ode, settings));
    moray_status status = moray_sim_start(v.sim, plan->t0, plant->x);
    if (!moray_failed(status)) {
        status = follow(&v);
        memcpy(plant->x, moray_sim_state(v.sim), (size_t)ode.n * sizeof *plant->x);
        if (plan->statistics)
            *plan->statistics = moray_sim_get_statistics(v.sim);
    }
    moray_sim_free(v.sim);
    return status;
}

moray_status moray_swim_run(moray_swimmer *swimmer, const moray_sim_settings *settings, const moray_swim_plan *plan,
                            double *x, double *energy)
{
    MORAY_TRY(check_plan(plan));
    swim_plant plant;
    MORAY_TRY(moray_swim_plant_new(&plant, swimmer, &plan->schedule[0].gait));
    plant.controller = plan->controller;
    memcpy(plant.x, x, (size_t)plant.n_states * sizeof *x);
    const moray_status status = run_plant(&plant, settings, plan);
    memcpy(x, plant.x, (size_t)plant.n_states * sizeof *x);
    if (energy)
        *energy = plant.x[plant.n_states];
    moray_swim_plant_free(&plant);
    return status;
}
