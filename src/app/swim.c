// SPDX-License-Identifier: MIT
#include "moray/swim.h"

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
    return moray_ok();
}

// Advances to t with every change of gait up to and at t made on the way; *next is the first change not yet made.
static moray_status advance(moray_sim *sim, swim_plant *plant, const moray_swim_plan *plan, int *next, double t)
{
    for (; *next < plan->n_changes && plan->schedule[*next].t <= t; ++*next) {
        const moray_gait_change *change = &plan->schedule[*next];
        if (change->t > moray_sim_time(sim))
            MORAY_TRY(moray_sim_advance(sim, change->t));
        plant->gait = change->gait;
        MORAY_TRY(moray_sim_start(sim, moray_sim_time(sim), moray_sim_state(sim)));
    }
    return moray_sim_advance(sim, t);
}

static moray_status follow(moray_sim *sim, swim_plant *plant, const moray_swim_plan *plan)
{
    int next = 0;
    for (int i = 0; i < plan->n_times; i++) {
        MORAY_TRY(advance(sim, plant, plan, &next, plan->times[i]));
        const moray_swim_sample sample = swim_plant_sample(plant, plan->times[i], moray_sim_state(sim));
        if (!plan->observe(&sample, plan->observer))
            return moray_ok();
    }
    return advance(sim, plant, plan, &next, plan->t1);
}

// From the plant's state x to the plant's state x.
static moray_status run_plant(swim_plant *plant, const moray_sim_settings *settings, const moray_swim_plan *plan)
{
    moray_sim *sim;
    const moray_ode ode = swim_plant_ode(plant);
    MORAY_TRY(moray_sim_new(&sim, &ode, settings));
    moray_status status = moray_sim_start(sim, plan->t0, plant->x);
    if (!moray_failed(status)) {
        status = follow(sim, plant, plan);
        memcpy(plant->x, moray_sim_state(sim), (size_t)ode.n * sizeof *plant->x);
        if (plan->statistics)
            *plan->statistics = moray_sim_get_statistics(sim);
    }
    moray_sim_free(sim);
    return status;
}

moray_status moray_swim_run(moray_swimmer *swimmer, const moray_sim_settings *settings, const moray_swim_plan *plan,
                            double *x, double *energy)
{
    MORAY_TRY(check_plan(plan));
    swim_plant plant;
    MORAY_TRY(swim_plant_new(&plant, swimmer, &plan->schedule[0].gait));
    memcpy(plant.x, x, (size_t)plant.n_states * sizeof *x);
    const moray_status status = run_plant(&plant, settings, plan);
    memcpy(x, plant.x, (size_t)plant.n_states * sizeof *x);
    if (energy)
        *energy = plant.x[plant.n_states];
    swim_plant_free(&plant);
    return status;
}
