// SPDX-License-Identifier: MIT
#include "snake/swim/closed_loop_plant.h"

#include <math.h>
#include <stdlib.h>

moray_status moray_swim_plant_new(swim_plant *plant, moray_swimmer *swimmer, const moray_gait *gait)
{
    const int n_states = moray_swimmer_states(swimmer), n_joints = moray_swimmer_robot(swimmer)->links - 1;
    double *memory = calloc((size_t)(2 * n_states + 1 + 4 * n_joints), sizeof *memory);
    if (!memory)
        return moray_error(MORAY_MEMORY, "no memory to simulate a swimmer of %d states", n_states);
    *plant = (swim_plant){.swimmer = swimmer,
                          .gait = *gait,
                          .n_states = n_states,
                          .n_joints = n_joints,
                          .x = memory,
                          .dx = memory + n_states + 1,
                          .ubar = memory + 2 * n_states + 1,
                          .u = memory + 2 * n_states + 1 + n_joints,
                          .phi = memory + 2 * n_states + 1 + 2 * n_joints,
                          .v_phi = memory + 2 * n_states + 1 + 3 * n_joints};
    return moray_ok();
}

void moray_swim_plant_free(swim_plant *plant)
{
    free(plant->x);
    *plant = (swim_plant){0};
}

void moray_swim_plant_steer(swim_plant *plant, const double u[SWIM_CONTROLS])
{
    plant->gait.offset = u[0];
    plant->gait.offset_rate = u[1];
    plant->gait.offset_acceleration = u[2];
}

void moray_swim_stir(moray_swimmer *swimmer, const moray_water *water, double t, const double *x)
{
    double body[MORAY_BODY_STATES], V[2];
    moray_state_body(moray_swimmer_model(swimmer), moray_swimmer_robot(swimmer)->links, x, body);
    moray_water_at(water, body[MORAY_STATE_P_X], body[MORAY_STATE_P_Y], t, V);
    moray_swimmer_set_current(swimmer, V[0], V[1]);
}

swim_current moray_swim_current(const moray_swimmer *swimmer, const moray_swim_plan *plan)
{
    swim_current current = {.start = plan->t0, .turning = plan->current_turning};
    moray_swimmer_current(swimmer, current.V);
    return current;
}

void moray_swim_turn(moray_swimmer *swimmer, const swim_current *current, double t)
{
    const double angle = current->turning * (t - current->start), c = cos(angle), s = sin(angle);
    if (current->turning != 0)
        moray_swimmer_set_current(swimmer, c * current->V[0] - s * current->V[1],
                                  s * current->V[0] + c * current->V[1]);
}

moray_status moray_swim_afloat(const moray_water *water, const moray_swim_sample *sample)
{
    double low[3], high[3];
    if (!water || moray_water_covers(water, sample->pose.p_x, sample->pose.p_y, sample->t))
        return moray_ok();
    moray_water_range(water, low, high);
    return moray_error(MORAY_INPUT,
                       "water: at t = %.4g s the robot is at (%.4g, %.4g) m, outside of the table: x %g to %g, y %g to "
                       "%g m, t %g to %g s",
                       sample->t, sample->pose.p_x, sample->pose.p_y, low[0], high[0], low[1], high[1], low[2],
                       high[2]);
}

static bool rates(swim_plant *plant, double t, const double *x, double *dx)
{
    moray_swim_turn(plant->swimmer, &plant->current, t);
    if (plant->water)
        moray_swim_stir(plant->swimmer, plant->water, t, x);
    moray_swimmer_control(plant->swimmer, &plant->gait, t, x, plant->ubar);
    return moray_swimmer_rates(plant->swimmer, x, plant->ubar, dx, plant->u);
}

static bool rhs(double t, const double *x, double *dx, void *self)
{
    swim_plant *plant = self;
    if (!rates(plant, t, x, dx))
        return false;
    moray_swimmer_joints(plant->swimmer, x, plant->phi, plant->v_phi);
    dx[plant->n_states] = moray_swimmer_power(plant->swimmer, plant->u, plant->v_phi);
    return true;
}

moray_ode moray_swim_plant_ode(swim_plant *plant)
{
    return (moray_ode){.n = plant->n_states + 1, .rhs = rhs, .self = plant};
}

moray_swim_sample moray_swim_plant_sample(swim_plant *plant, double t, const double *x)
{
    rates(plant, t, x, plant->dx); // of an accepted state, where the simulator has asked before
    moray_swim_sample sample = {
        .t = t, .x = x, .u = plant->u, .pose = moray_swimmer_pose(plant->swimmer, x), .energy = x[plant->n_states]};
    moray_swimmer_current(plant->swimmer, sample.current);
    return sample;
}
