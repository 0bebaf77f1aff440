// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <string.h>

#include "sensitivity.h"

enum kind { CURRENT, ROBOT, GEOMETRY, LIMIT, LOWER, UPPER }; // LOWER, UPPER: end of a range

struct sensitivity_parameter {
    enum kind kind;
    const char *name, *unit;
    size_t place;  // in a variant, of the value or of the range
    double factor; // from the unit to that of the job
    bool model[2]; // that have it
};

#define PLACE(field) offsetof(variant, field)
#define BOTH                                                                                                           \
    {                                                                                                                  \
        true, true                                                                                                     \
    }
#define CONTROL                                                                                                        \
    {                                                                                                                  \
        true, false                                                                                                    \
    }
#define COMPLEX                                                                                                        \
    {                                                                                                                  \
        false, true                                                                                                    \
    }
#define RANGE(name, unit, field, factor, models)                                                                       \
    {LOWER, name, unit, PLACE(field), factor, models},                                                                 \
    {                                                                                                                  \
        UPPER, name, unit, PLACE(field), factor, models                                                                \
    }

static const sensitivity_parameter parameters[] = {
    {CURRENT, "current V_x", "m/s", PLACE(job.snake.current[0]), 1, BOTH},
    {CURRENT, "current V_y", "m/s", PLACE(job.snake.current[1]), 1, BOTH},
    {ROBOT, "c_t", "kg/s", PLACE(job.snake.robot.c_t), 1, BOTH},
    {ROBOT, "c_n", "kg/s", PLACE(job.snake.robot.c_n), 1, BOTH},
    {ROBOT, "mu_n", "kg", PLACE(job.snake.robot.mu_n), 1, BOTH},
    {ROBOT, "lambda_1", "kg m^2", PLACE(job.snake.robot.lambda_1), 1, COMPLEX},
    {ROBOT, "lambda_2", "kg m^2/s", PLACE(job.snake.robot.lambda_2), 1, COMPLEX},
    {ROBOT, "lambda_3", "kg m^2", PLACE(job.snake.robot.lambda_3), 1, COMPLEX},
    {ROBOT, "rot_damping", "1/s", PLACE(job.snake.robot.rot_damping), 1, CONTROL},
    {ROBOT, "rot_gain", "1/(m^2 s)", PLACE(job.snake.robot.rot_gain), 1, CONTROL},
    {ROBOT, "m_kg", "kg", PLACE(job.snake.robot.m), 1, BOTH},
    {GEOMETRY, "length_m", "m", PLACE(job.snake.geometry.length), 1, BOTH},
    {LIMIT, "power_W", "W", PLACE(at.power), 1, BOTH},
    RANGE("theta_max_deg", "deg", job.theta_max, DEG, BOTH),
    RANGE("omega_deg_s", "deg/s", job.omega, DEG, BOTH),
    RANGE("delta_deg", "deg", job.delta, DEG, BOTH),
    RANGE("phi0_m", "m", job.offset, 1, CONTROL),
    RANGE("phi0_deg", "deg", job.offset_angle, DEG, COMPLEX),
    RANGE("taper", "1", at.taper, 1, BOTH),
    {LIMIT, "joint_rate", "m/s", PLACE(job.joint_rate), 1, CONTROL},
    {LIMIT, "joint_rate", "deg/s", PLACE(job.joint_rate), 1, COMPLEX},
    {LIMIT, "joint_effort", "N", PLACE(job.joint_effort), 1, CONTROL},
    {LIMIT, "joint_effort", "N m", PLACE(job.joint_effort), 1, COMPLEX},
};

const sensitivity_parameter *sensitivity_parameter_at(int k)
{
    return k < (int)(sizeof parameters / sizeof *parameters) ? &parameters[k] : NULL;
}

bool sensitivity_parameter_is_limit(const sensitivity_parameter *parameter)
{
    return parameter->kind >= LIMIT;
}

static variant as_it_is(const gait_job *job)
{
    return (variant){.job = *job, .at = *last_stage(job)};
}

static double *place_in(const sensitivity_parameter *parameter, variant *of)
{
    return (double *)((char *)of + parameter->place) + (parameter->kind == UPPER);
}

// A range of one number is one parameter, that of its upper end.
static bool is_fixed(const sensitivity_parameter *parameter, variant *of)
{
    if (parameter->kind < LOWER)
        return false;
    const double *range = (double *)((char *)of + parameter->place);
    return range[0] == range[1];
}

bool sensitivity_parameter_of_each(const sensitivity_parameter *parameter, const gait_job *job)
{
    return parameter->kind == GEOMETRY && job->snake.robot.link;
}

bool sensitivity_parameter_applies(const sensitivity_parameter *parameter, const gait_job *job)
{
    variant now = as_it_is(job);
    const double value = *place_in(parameter, &now);
    if (!parameter->model[job->snake.model] || !isfinite(value) || sensitivity_parameter_of_each(parameter, job))
        return false;
    return parameter->kind == CURRENT || (value != 0 && !(parameter->kind == LOWER && is_fixed(parameter, &now)));
}

void sensitivity_parameter_describe(const sensitivity_parameter *parameter, const gait_job *job, double speed,
                                    sensitivity_row *row)
{
    variant now = as_it_is(job);
    const bool fixed = is_fixed(parameter, &now);
    const char *which = fixed ? "" : parameter->kind == LOWER ? ", lower" : parameter->kind == UPPER ? ", upper" : "";
    snprintf(row->name, sizeof row->name, "%s%s", parameter->name, which);
    row->unit = parameter->unit;
    row->value = *place_in(parameter, &now) / parameter->factor;
    row->current = parameter->kind == CURRENT;
    row->scale = row->current ? speed : fabs(row->value);
}

// The fields that follow from the geometry follow it; those that were given stay.
static void remake_robot(const gait_job *job, moray_snake_options *moved)
{
    moray_robot old = job->snake.robot, made = old;
    moray_robot_from_geometry(&old, &job->snake.geometry);
    moray_robot_from_geometry(&made, &moved->geometry);
    const double *const was[] = {&old.l,    &old.m,        &old.J,        &old.c_t,     &old.c_n,
                                 &old.mu_n, &old.lambda_1, &old.lambda_2, &old.lambda_3};
    const double *const is[] = {&made.l,    &made.m,        &made.J,        &made.c_t,     &made.c_n,
                                &made.mu_n, &made.lambda_1, &made.lambda_2, &made.lambda_3};
    moray_robot *robot = &moved->robot;
    double *const field[] = {&robot->l,    &robot->m,        &robot->J,        &robot->c_t,     &robot->c_n,
                             &robot->mu_n, &robot->lambda_1, &robot->lambda_2, &robot->lambda_3};
    for (unsigned i = 0; i < sizeof field / sizeof *field; i++)
        if (*field[i] == *was[i])
            *field[i] = *is[i];
}

void sensitivity_displace(const sensitivity_parameter *parameter, const gait_job *job, double step, variant *moved)
{
    *moved = as_it_is(job);
    double *place = place_in(parameter, moved);
    const bool fixed = is_fixed(parameter, moved);
    *place += step * parameter->factor;
    if (fixed)
        place[-1] = *place;
    if (parameter->kind == GEOMETRY)
        remake_robot(job, &moved->job.snake);
}
