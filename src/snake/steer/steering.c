// SPDX-License-Identifier: MIT
#include "moray/snake/steering.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "base/numeric_map.h"
#include "snake/swim/limits.h"
#include "snake/steer/problems.h"
#include "snake/steer/steering_parts.h"

moray_gait moray_steering_gait(const double s[parameters])
{
    return (moray_gait){
        .amplitude = s[MORAY_STEERING_AMPLITUDE], .omega = s[MORAY_STEERING_OMEGA], .delta = s[MORAY_STEERING_DELTA]};
}

void moray_steering_parameters(const moray_gait *gait, double s[parameters])
{
    s[MORAY_STEERING_AMPLITUDE] = gait->amplitude;
    s[MORAY_STEERING_OMEGA] = gait->omega;
    s[MORAY_STEERING_DELTA] = gait->delta;
}

moray_steering_limits moray_steering_limits_map(const moray_robot *robot, const moray_steering_limits *limits,
                                                const moray_gait *gait, moray_model from, moray_model to)
{
    const double scale = moray_gait_map(robot, gait, from, to).amplitude / gait->amplitude;
    moray_steering_limits mapped = *limits;
    double *const offsets[] = {&mapped.offset, &mapped.offset_rate, &mapped.offset_acceleration};
    for (int k = 0; k < 3; k++)
        if (*offsets[k] < MORAY_INFINITY)
            *offsets[k] *= scale;
    return mapped;
}

// ---- Motors --------------------------------------------------------------------------------------------------------

static const moray_motor *motor_of(const moray_steering_spec *spec)
{
    return spec->model == MORAY_FIRST_PRINCIPLES ? &spec->robot.motor : NULL;
}

int moray_steering_supply_rows(const moray_steering_spec *spec)
{
    const moray_motor *motor = motor_of(spec);
    return motor ? motor->lines * (spec->robot.links - 1) : 0;
}

int moray_steering_rate_rows(const moray_steering_spec *spec)
{
    const double rate = spec->robot.supply.rate;
    return motor_of(spec) && rate > 0 && rate < MORAY_INFINITY ? rates : 0;
}

static void fastest(const double complex *in, int first_parameter, double complex *out)
{
    const double complex stroke =
        in[first_parameter + MORAY_STEERING_AMPLITUDE] * in[first_parameter + MORAY_STEERING_OMEGA];
    out[0] = stroke + in[MORAY_STATE_V_PHI_0];
    out[1] = stroke - in[MORAY_STATE_V_PHI_0];
}

// Of moray_steering_spec: its rates, then the task's functions.
static void added_outputs(void *self, const double complex *in, double complex *out)
{
    const moray_steering_spec *spec = self;
    const moray_steering_task *task = &spec->task;
    if (moray_steering_rate_rows(spec))
        fastest(in, states + 1 + task->nu, out);
    if (task->extra)
        task->extra(task->self, in, out + moray_steering_rate_rows(spec));
}

// ---- Checks --------------------------------------------------------------------------------------------------------

static moray_status check_spec(const moray_steering_spec *spec)
{
    const moray_steering_limits *limits = &spec->limits;
    MORAY_TRY(moray_robot_check(&spec->robot));
    MORAY_TRY(moray_limits_check_gait(limits->theta_max, limits->omega, limits->delta));
    MORAY_TRY(moray_limits_check_above_zero("offset limit", limits->offset));
    MORAY_TRY(moray_limits_check_above_zero("offset rate limit", limits->offset_rate));
    MORAY_TRY(moray_limits_check_above_zero("offset acceleration limit", limits->offset_acceleration));
    MORAY_TRY(moray_limits_check_above_zero("power_W", limits->power));
    if (spec->task.nu < 0 || spec->task.nu >= MORAY_STEERING_CONTROLS)
        return moray_error(MORAY_INPUT, "further controls of %s = %d: must be from 0 to %d", spec->task.name,
                           spec->task.nu, MORAY_STEERING_CONTROLS - 1);
    if (spec->averaged && spec->model != MORAY_CONTROL_ORIENTED)
        return moray_error(MORAY_INPUT, "averaged: only the control-oriented model has an averaged plant");
    if (!isfinite(spec->current[0]) || !isfinite(spec->current[1]))
        return moray_error(MORAY_INPUT, "current = %g,%g: must be finite", spec->current[0], spec->current[1]);
    return moray_ok();
}

// ---- Building ------------------------------------------------------------------------------------------------------

enum { look_points = 64, most_inputs = states + MORAY_STEERING_CONTROLS + parameters + 1 };

// Where the task's functions are looked at: the first point typical, the others around it, and all over what its own
// controls and the time may be, because a reference or a path changes along these.
static void fill_points(const moray_steering_spec *spec, int n_in, double *points)
{
    const moray_steering_task *task = &spec->task;
    const double typical[states + 1] = {0.1, 0.2, 0.3, 0.1, 0.2, 0.02, 0.01, 0.002, 0.001};
    const double stroke[parameters] = {0.05, 2, 0.7};
    moray_bounds box[most_inputs] = {{0}};
    double first[most_inputs] = {0};
    memcpy(first, typical, sizeof typical);
    memcpy(first + n_in - 1 - parameters, stroke, sizeof stroke);
    first[n_in - 1] = 0.6 * spec->t0.lower + 0.4 * spec->tf.lower;
    for (int j = 0; j < n_in; j++)
        box[j] = moray_between(first[j] - 0.5 * (1 + fabs(first[j])), first[j] + 0.5 * (1 + fabs(first[j])));
    for (int k = 0; k < task->nu; k++) {
        first[states + 1 + k] = 0.45 * task->u[k].lower + 0.55 * task->u[k].upper;
        box[states + 1 + k] = task->u[k];
    }
    if (spec->tf.upper < MORAY_INFINITY)
        box[n_in - 1] = moray_between(spec->t0.lower, spec->tf.upper);
    for (int k = 0; k < look_points; k++)
        for (int j = 0; j < n_in; j++) {
            const double part = (k + fmod(0.618033988749895 * (j + 1) * k, 1)) / look_points;
            const double anywhere = fmod(part + 0.381966011250105 * j, 1);
            points[k * n_in + j] = k ? box[j].lower + anywhere * (box[j].upper - box[j].lower) : first[j];
        }
}

// The rates of the joints and the task's functions on the inputs of the phase.
static moray_status make_added(moray_steering_spec *spec, int n_in, moray_map *added)
{
    const moray_steering_task *task = &spec->task;
    double *points = calloc((size_t)(look_points * n_in), sizeof *points);
    *added = (moray_map){0};
    if (!points)
        return moray_error(MORAY_MEMORY, "no memory for the steering problem");
    fill_points(spec, n_in, points);
    const struct numeric_probe probe = {.points = points, .n = look_points};
    const moray_status status = moray_complex_map_new(added, n_in, moray_steering_rate_rows(spec) + task->nc + task->nq,
                                                      added_outputs, spec, NULL, &probe);
    free(points);
    return status;
}

// The task's functions joined to the plant's.
static moray_status make_plant(moray_steering *problem)
{
    moray_steering_spec *spec = &problem->spec;
    const moray_steering_task *task = &spec->task;
    const moray_plant_spec plant_spec = {.robot = spec->robot,
                                         .joints = MORAY_JOINTS_STEERED,
                                         .current = {spec->current[0], spec->current[1]},
                                         .water = spec->water,
                                         .path_supply = moray_steering_supply_rows(spec) > 0};
    int place[states + 1 + parameters + 1];
    moray_map plant, added;
    MORAY_TRY(spec->averaged                          ? moray_average_plant(&plant, &plant_spec)
              : spec->model == MORAY_CONTROL_ORIENTED ? moray_control_plant(&plant, &plant_spec)
                                                      : moray_fp_plant(&plant, &plant_spec));
    if (moray_steering_rate_rows(spec) + task->nc + task->nq == 0) {
        problem->plant = plant;
        return moray_ok();
    }
    const moray_status status = make_added(spec, states + 1 + task->nu + parameters + 1, &added);
    if (moray_failed(status)) {
        moray_map_release(&plant);
        return status;
    }
    for (int k = 0; k < states + 1 + parameters + 1; k++)
        place[k] = k <= states ? k : k + task->nu;
    return moray_map_join(&problem->plant, &plant, place, &added, states + moray_steering_supply_rows(spec));
}

moray_status moray_steering_new(moray_steering **result, const moray_steering_spec *spec)
{
    *result = NULL;
    MORAY_TRY(check_spec(spec));
    moray_steering *problem = calloc(1, sizeof *problem);
    if (!problem)
        return moray_error(MORAY_MEMORY, "no memory for the steering problem");
    problem->spec = *spec;
    moray_status status = make_plant(problem);
    if (!moray_failed(status))
        status = moray_steering_make_ocp(problem);
    if (moray_failed(status))
        moray_steering_free(problem);
    else
        *result = problem;
    return status;
}

void moray_steering_free(moray_steering *problem)
{
    if (!problem)
        return;
    moray_ocp_free(problem->ocp);
    moray_map_release(&problem->plant);
    free(problem->block);
    free(problem->names);
    free(problem->path_names);
    free(problem);
}

void moray_steering_problem_free(moray_steering_problem *problem)
{
    moray_steering_free(problem->steering);
    free(problem->task);
    *problem = (moray_steering_problem){0};
}

// ---- Reading -------------------------------------------------------------------------------------------------------

const moray_ocp *moray_steering_ocp(const moray_steering *problem)
{
    return problem->ocp;
}

double moray_steering_work(const moray_steering *problem, const moray_solution *solution)
{
    return moray_solution_integrals(solution, 0)[problem->spec.task.nq];
}

moray_offset moray_steering_offset(const moray_solution *solution, double t)
{
    double t0, tf, x[states], u[MORAY_STEERING_CONTROLS];
    moray_solution_times(solution, 0, &t0, &tf);
    moray_solution_at(solution, 0, t, x, u);
    if (t > tf)
        return (moray_offset){.value = x[MORAY_STATE_PHI_0]};
    return (moray_offset){x[MORAY_STATE_PHI_0], x[MORAY_STATE_V_PHI_0], u[0]};
}
