// SPDX-License-Identifier: MIT
//
// The problem of steering in the form of ocp: bounds, events and names.
#include "snake/steer/steering_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <tgmath.h>

// ---- Ends ----------------------------------------------------------------------------------------------------------

// a / (L cos(delta/2)) = sin theta_max of (33), or alpha / (2 sin(delta/2)) = theta_max of (27).
static moray_num amplitude_event(const moray_steering_spec *spec, const moray_num *s)
{
    const moray_num amplitude = s[MORAY_STEERING_AMPLITUDE], half = s[MORAY_STEERING_DELTA] / 2;
    return amplitude / (2 * (spec->model == MORAY_CONTROL_ORIENTED ? spec->robot.l * cos(half) : sin(half)));
}

static moray_bounds amplitude_bounds(const moray_steering_spec *spec)
{
    const moray_bounds theta_max = spec->limits.theta_max;
    return spec->model == MORAY_CONTROL_ORIENTED ? moray_between(sin(theta_max.lower), sin(theta_max.upper))
                                                 : theta_max;
}

// The objective, and as events the amplitude, the mean power and the task's own.
static void ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_steering_spec *spec = data;
    const moray_steering_task *task = &spec->task;
    const moray_num duration = at->phase->tf - at->phase->t0, work = at->phase->q[task->nq];
    moray_end_values own = {.objective = 0, .e = out->e + own_events};
    if (task->events)
        task->events(at, &own, task->self);
    out->objective = own.objective + task->weight_time * duration + task->weight_power * work;
    for (int m = 0; m < task->nq; m++)
        out->objective += task->weight[m] * at->phase->q[m];
    out->e[0] = amplitude_event(spec, at->s);
    out->e[1] = work / duration;
}

// ---- Bounds --------------------------------------------------------------------------------------------------------

static moray_bounds narrower(moray_bounds one, moray_bounds other)
{
    return moray_between(fmax(one.lower, other.lower), fmin(one.upper, other.upper));
}

static moray_bounds within(double limit)
{
    return moray_between(-limit, limit);
}

static const char *const s_names[][parameters] = {{"a", "omega", "delta"}, {"alpha", "omega", "delta"}};
static const char *const x_names[][states] = {{"theta", "p_x", "p_y", "v_theta", "v_t", "v_n", "phi_0", "phi_0'"},
                                              {"theta", "p_x", "p_y", "v_theta", "v_x", "v_y", "phi_0", "phi_0'"}};

// What is allocated for the problem, and how many there are of it.
struct parts {
    int nu, ne, supply, motors, nc; // rows of the supply, and up to those of the motors' rates
    moray_bounds *x, *x0, *xf, *u, *e, *c;
    const char **u_names, **e_names, **c_names;
};

static moray_status allocate(moray_steering *problem, struct parts *of)
{
    const moray_steering_task *task = &problem->spec.task;
    of->nu = 1 + task->nu;
    of->ne = own_events + task->ne;
    of->supply = moray_steering_supply_rows(&problem->spec);
    of->motors = of->supply + moray_steering_rate_rows(&problem->spec);
    of->nc = of->motors + task->nc;
    problem->block = calloc((size_t)(3 * states + of->nu + of->ne + of->nc), sizeof *problem->block);
    problem->names = calloc((size_t)(of->nu + of->ne + of->nc), sizeof *problem->names);
    problem->path_names = calloc((size_t)of->supply + 1, sizeof *problem->path_names);
    if (!problem->block || !problem->names || !problem->path_names)
        return moray_error(MORAY_MEMORY, "no memory for the steering problem");
    of->x = problem->block;
    of->x0 = of->x + states;
    of->xf = of->x0 + states;
    of->u = of->xf + states;
    of->e = of->u + of->nu;
    of->c = of->e + of->ne;
    of->u_names = problem->names;
    of->e_names = of->u_names + of->nu;
    of->c_names = of->e_names + of->ne;
    return moray_ok();
}

static void bound_states(const moray_steering_spec *spec, const struct parts *of)
{
    const moray_steering_limits *limits = &spec->limits;
    for (int r = 0; r < states; r++) {
        of->x[r] = r == MORAY_STATE_PHI_0     ? within(limits->offset)
                   : r == MORAY_STATE_V_PHI_0 ? within(limits->offset_rate)
                                              : moray_free();
        of->x0[r] = narrower(of->x[r], spec->x0[r]);
        of->xf[r] = narrower(of->x[r], spec->xf[r]);
    }
}

// Controls and events: of every steering, then of the task.
static void bound_ends(const moray_steering_spec *spec, const struct parts *of)
{
    const moray_steering_task *task = &spec->task;
    of->u[0] = within(spec->limits.offset_acceleration), of->u_names[0] = "phi_0''";
    of->e[0] = amplitude_bounds(spec), of->e_names[0] = "theta_max";
    of->e[1] = moray_at_most(spec->limits.power), of->e_names[1] = "mean power";
    for (int k = 0; k < task->nu; k++)
        of->u[1 + k] = task->u[k], of->u_names[1 + k] = task->u_names[k];
    for (int k = 0; k < task->ne; k++)
        of->e[own_events + k] = task->e[k], of->e_names[own_events + k] = task->e_names[k];
}

// Path constraints: what motors give, how fast they turn, those of the task.
static void bound_path(moray_steering *problem, const struct parts *of)
{
    const moray_steering_spec *spec = &problem->spec;
    for (int k = 0; k < of->supply; k++) {
        snprintf(problem->path_names[k], NAME_SIZE, "supply %d", k + 1);
        of->c[k] = within(spec->robot.motor.torque[k / (spec->robot.links - 1)]);
        of->c_names[k] = problem->path_names[k];
    }
    for (int k = of->supply; k < of->motors; k++) {
        of->c[k] = moray_at_most(spec->robot.supply.rate);
        of->c_names[k] = k > of->supply ? "joint rate down" : "joint rate up";
    }
    for (int k = 0; k < spec->task.nc; k++)
        of->c[of->motors + k] = spec->task.c[k], of->c_names[of->motors + k] = spec->task.c_names[k];
}

moray_status moray_steering_make_ocp(moray_steering *problem)
{
    const moray_steering_spec *spec = &problem->spec;
    const moray_steering_limits *limits = &spec->limits;
    struct parts of = {0};
    MORAY_TRY(allocate(problem, &of));
    bound_states(spec, &of);
    bound_ends(spec, &of);
    bound_path(problem, &of);
    const bool control = spec->model == MORAY_CONTROL_ORIENTED;
    const double largest = control ? 2 * spec->robot.l * sin(limits->theta_max.upper) // of a, by (33)
                                   : 2 * limits->theta_max.upper;                     // of alpha, by (27)
    const moray_bounds s[] = {moray_between(0, largest), limits->omega, limits->delta};
    const moray_phase_spec phase = {.name = spec->task.name,
                                    .nx = states,
                                    .nu = of.nu,
                                    .nc = of.nc,
                                    .nq = spec->task.nq + 1,
                                    .map = &problem->plant,
                                    .t0 = spec->t0,
                                    .tf = spec->tf,
                                    .x = {of.x, states},
                                    .x0 = {of.x0, states},
                                    .xf = {of.xf, states},
                                    .u = {of.u, of.nu},
                                    .c = {of.c, of.nc},
                                    .x_names = x_names[spec->model],
                                    .u_names = of.u_names,
                                    .c_names = of.c_names};
    return moray_ocp_new(&problem->ocp, &(moray_ocp_spec){.name = spec->task.name,
                                                          .phases = 1,
                                                          .phase = &phase,
                                                          .ns = parameters,
                                                          .s = {s, parameters},
                                                          .s_names = s_names[spec->model],
                                                          .ne = of.ne,
                                                          .e = {of.e, of.ne},
                                                          .e_names = of.e_names,
                                                          .endpoint = ends,
                                                          .data = &problem->spec});
}
