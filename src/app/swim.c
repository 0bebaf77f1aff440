// SPDX-License-Identifier: MIT
#include "moray/swim.h"

#include <math.h>
#include <string.h>

#include "app/swim_plant.h"
#include "sim/times.h"

static moray_status check_plan(const moray_swim_plan *plan)
{
    MORAY_TRY(sim_check_times(plan->t0, plan->t1, plan->times, plan->n_times));
    if (plan->n_changes < 1 || !(plan->schedule[0].t <= plan->t0))
        return moray_error(MORAY_INPUT, "the schedule needs a gait that begins not after t0 = %g", plan->t0);
    for (int i = 1; i < plan->n_changes; i++) {
        if (!(plan->schedule[i].t > plan->schedule[i - 1].t))
            return moray_error(MORAY_INPUT, "schedule[%d].t = %g: must lie after that of the gait before, %g", i,
                               plan->schedule[i].t, plan->schedule[i - 1].t);
    }
    if (plan->helm && plan->helm->look && !(plan->helm->period > 0))
        return moray_error(MORAY_INPUT, "period of the helm = %g: must be above 0", plan->helm->period);
    return moray_ok();
}

// A simulation on its way: the first change of gait not yet made, the looks of the helm so far.
typedef struct {
    const moray_swim_plan *plan;
    swim_plant *plant;
    moray_sim *sim;
    int change, looks;
} voyage;

static double next_change(const voyage *v)
{
    return v->change < v->plan->n_changes ? v->plan->schedule[v->change].t : INFINITY;
}

static double next_look(const voyage *v)
{
    const moray_helm *helm = v->plan->helm;
    return helm && helm->look ? v->plan->t0 + v->looks * helm->period : INFINITY;
}

// Advances to t with every change and look up to and at t made on the way.
static moray_status advance(voyage *v, double t)
{
    const moray_helm *helm = v->plan->helm;
    for (double stop; (stop = fmin(next_change(v), next_look(v))) <= t;) {
        if (stop > moray_sim_time(v->sim))
            MORAY_TRY(moray_sim_advance(v->sim, stop));
        if (next_change(v) <= stop)
            v->plant->gait = v->plan->schedule[v->change++].gait;
        if (next_look(v) <= stop) {
            const moray_swim_sample sample = swim_plant_sample(v->plant, stop, moray_sim_state(v->sim));
            helm->look(&sample, helm->self);
            v->looks++;
        }
        MORAY_TRY(moray_sim_start(v->sim, moray_sim_time(v->sim), moray_sim_state(v->sim)));
    }
    return moray_sim_advance(v->sim, t);
}

static moray_status follow(voyage *v)
{
    const moray_swim_plan *plan = v->plan;
    for (int i = 0; i < plan->n_times; i++) {
        MORAY_TRY(advance(v, plan->times[i]));
        const moray_swim_sample sample = swim_plant_sample(v->plant, plan->times[i], moray_sim_state(v->sim));
        if (!plan->observe(&sample, plan->observer))
            return moray_ok();
    }
    return advance(v, plan->t1);
}

// From the plant's state x to the plant's state x.
static moray_status run_plant(swim_plant *plant, const moray_sim_settings *settings, const moray_swim_plan *plan)
{
    voyage v = {.plan = plan, .plant = plant};
    const moray_ode ode = swim_plant_ode(plant);
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
    MORAY_TRY(swim_plant_new(&plant, swimmer, &plan->schedule[0].gait));
    plant.helm = plan->helm;
    memcpy(plant.x, x, (size_t)plant.n_states * sizeof *x);
    const moray_status status = run_plant(&plant, settings, plan);
    memcpy(x, plant.x, (size_t)plant.n_states * sizeof *x);
    if (energy)
        *energy = plant.x[plant.n_states];
    swim_plant_free(&plant);
    return status;
}
