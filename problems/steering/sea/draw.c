// SPDX-License-Identifier: MIT
//
// What is true in every draw, and what the planner believes.
#include "sea.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double between(unsigned long *seed, double low, double high)
{
    return low + (high - low) * moray_random(seed);
}

static void scale_coefficients(moray_robot *robot, const double factor[SEA_COEFFICIENTS])
{
    robot->c_n *= factor[0];
    robot->c_t *= factor[1];
    robot->mu_n *= factor[2];
    robot->lambda_1 *= factor[3];
    robot->lambda_2 *= factor[3];
    robot->lambda_3 *= factor[3];
}

// Steps, a sine or ramps, all within what the robot can turn.
static moray_status draw_reference(sea_draw *draw, unsigned long *seed)
{
    char text[120];
    const double side = moray_random(seed) < 0.5 ? -1 : 1, a = side * between(seed, 15, 40);
    const double t = between(seed, 8, 15), later = between(seed, 38, 48);
    switch ((int)(3 * moray_random(seed))) {
    case 0:
        snprintf(text, sizeof text, "steps:%.3f=%.3f,%.3f=%.3f", t, a, later, -0.5 * a);
        break;
    case 1:
        snprintf(text, sizeof text, "sine:%.3f,%.3f", a, between(seed, 50, 90));
        break;
    default:
        snprintf(text, sizeof text, "ramps:%.3f=0,%.3f=%.3f,%.3f=0", t, t + 15, 1.5 * a, t + 45);
    }
    return moray_reference_read(&draw->reference, text);
}

// What the robot does straight ahead and turning, as the averaged plant has it.
static moray_status see_through(const sea_job *job, const moray_robot *robot, moray_straight_motion *straight,
                                moray_belief *belief, double *turn)
{
    const moray_model model = job->snake.model;
    moray_gait gait = moray_gait_map(&job->snake.robot, &job->gait, MORAY_CONTROL_ORIENTED, model);
    double rate;
    MORAY_TRY(moray_straight_motion_find(straight, robot, model, &gait));
    gait.offset = 0.5 * job->offset * job->scale;
    MORAY_TRY(moray_turn_rate(robot, model, &gait, &rate));
    *turn = rate / (0.5 * job->offset);
    return moray_belief_find(belief, &job->believed, &job->gait, straight->speed, 0.5 * job->offset, rate);
}

static moray_status make(sea_job *job, sea_draw *draw, unsigned long number)
{
    unsigned long seed = 0x5EA0 + 7919 * number;
    double factor[SEA_COEFFICIENTS];
    moray_random(&seed);
    const double speed = between(&seed, 0, job->current_most), direction = between(&seed, 0, 2 * M_PI);
    *draw = (sea_draw){.seed = number, .robot = job->snake.robot};
    draw->current[0] = speed * cos(direction);
    draw->current[1] = speed * sin(direction);
    draw->current_turning = between(&seed, -job->current_turning, job->current_turning);
    for (int k = 0; k < SEA_COEFFICIENTS; k++)
        factor[k] = 1 + between(&seed, -job->spread, job->spread);
    scale_coefficients(&draw->robot, factor);
    MORAY_TRY(draw_reference(draw, &seed));
    MORAY_TRY(see_through(job, &draw->robot, &draw->straight, &draw->truth, &draw->turn));
    memcpy(draw->truth.current, draw->current, sizeof draw->current);
    return job->task == SEA_HEADING ? sea_plan_heading(job, draw) : moray_ok();
}

// The plant's hydrodynamics by a rung's name.
static moray_status choose_rung(sea_job *job)
{
    moray_rung rungs[MORAY_RUNGS];
    if (strcmp(job->rung, "own") == 0)
        return moray_ok();
    const int k = moray_rung_named(job->rung);
    if (k < 0)
        return moray_error(MORAY_INPUT, "rung = %s: must be own or one of the ladder's, as split3 or consistent",
                           job->rung);
    moray_ladder(&job->snake.robot, rungs);
    job->snake.robot = rungs[k].robot;
    return moray_ok();
}

static moray_status believe(sea_job *job)
{
    const moray_hydrodynamics paper = {0}, consistent = moray_hydrodynamics_consistent();
    double current[2] = {0, 0}, turn;
    int used = 0;
    job->believed = job->snake.robot; // before the rung: the planner does not know the plant's
    job->believed.hydro = job->hydrodynamics == MORAY_CONSISTENT ? consistent : paper;
    scale_coefficients(&job->believed, job->factor);
    if (strcmp(job->believed_current, "unknown") != 0 &&
        (sscanf(job->believed_current, "%lf,%lf%n", &current[0], &current[1], &used) != 2 ||
         job->believed_current[used] || !isfinite(current[0]) || !isfinite(current[1])))
        return moray_error(MORAY_INPUT, "planner_current = %s: must be unknown or VX,VY, both finite",
                           job->believed_current);
    MORAY_TRY(see_through(job, &job->believed, &job->believed_straight, &job->belief, &turn));
    memcpy(job->belief.current, current, sizeof current);
    return moray_ok();
}

moray_status sea_prepare(sea_job *job)
{
    const int n = job->seeds + job->training;
    const moray_model model = job->snake.model;
    job->gait = moray_gait_paper(&job->snake.robot);
    const moray_gait mapped = moray_gait_map(&job->snake.robot, &job->gait, MORAY_CONTROL_ORIENTED, model);
    job->scale = model == MORAY_CONTROL_ORIENTED ? 1 : -mapped.amplitude / job->gait.amplitude; // erratum E3
    MORAY_TRY(moray_snake_turning(&job->snake));
    if (job->actuators.torque > 0 && model == MORAY_CONTROL_ORIENTED)
        return moray_error(MORAY_INPUT, "torque_N_m = %g: the control-oriented model has no torques",
                           job->actuators.torque);
    job->sensors.gyro = isfinite(job->gyro);
    job->sensors.rate = job->sensors.gyro ? job->gyro : 0;
    if (job->task == SEA_PATH)
        MORAY_TRY(moray_path_read(&job->path, job->path_text, job->radius));
    MORAY_TRY(believe(job));
    MORAY_TRY(choose_rung(job));
    job->draw = calloc((size_t)n, sizeof *job->draw);
    job->score = calloc((size_t)job->seeds * SEA_LAWS, sizeof *job->score);
    job->estimate = calloc((size_t)job->seeds, sizeof *job->estimate);
    if (!job->draw || !job->score || !job->estimate)
        return moray_error(MORAY_MEMORY, "no memory for %d draws", n);
    job->drawn = n;
    if (job->task == SEA_PATH)
        MORAY_TRY(sea_plan_path(job));
    for (int k = 0; k < n; k++) { // those to train on are none of those to be scored on
        const int number = k < job->seeds ? job->first_seed + k : -1 - (k - job->seeds);
        MORAY_TRY(make(job, &job->draw[k], (unsigned long)number));
        moray_ticker_show(&job->ticker, "sea_trials: draw %d of %d", k + 1, n);
        if (moray_interrupted())
            return moray_error(MORAY_INTERRUPTED, "interrupted; nothing is written");
    }
    return moray_ok();
}

void sea_release(sea_job *job)
{
    for (int k = 0; job->draw && k < job->drawn; k++) {
        moray_steering_plan_free(&job->draw[k].plan);
        moray_reference_free(&job->draw[k].reference);
    }
    moray_steering_plan_free(&job->plan);
    free(job->draw);
    free(job->score);
    free(job->estimate);
    moray_path_free(&job->path);
}
