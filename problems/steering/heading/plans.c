// SPDX-License-Identifier: MIT
#include "heading.h"

static const double error_unit = 10 * DEG; // of the heading, in the objective

moray_heading_spec heading_spec(const heading_job *job, moray_model model, bool averaged)
{
    const moray_snake_options *snake = &job->steer.snake;
    return (moray_heading_spec){.robot = snake->robot,
                                .model = model,
                                .averaged = averaged,
                                .current = {snake->current[0], snake->current[1]},
                                .limits = steer_limits(&job->steer, model),
                                .weight = {.heading = 1 / (error_unit * error_unit),
                                           .power = job->weight_power,
                                           .steering = job->steer.weight_steering},
                                .reference = &job->reference,
                                .max_error = averaged ? MORAY_INFINITY : fmin(job->max_error, MORAY_INFINITY),
                                .t1 = job->horizon};
}

// ---- What limits the robot -----------------------------------------------------------------------------------------

static double largest_jump(const heading_job *job)
{
    const moray_reference *r = &job->reference;
    double largest = 0;
    for (int k = 1; k < r->n; k++)
        if (r->time[k] == r->time[k - 1] && r->time[k] < job->horizon)
            largest = fmax(largest, fabs(r->heading[k] - r->heading[k - 1]));
    return largest;
}

void heading_explain(const steer_job *steer, char *text, size_t size)
{
    const heading_job *job = (const heading_job *)steer;
    const moray_model model = steer->snake.model;
    const moray_steering_limits limits = steer_limits(steer, model);
    const double fastest = moray_reference_fastest(&job->reference, 0, job->horizon), jump = largest_jump(job);
    const double sustained = fabs(steer->turn_rate[model]), build_up = limits.offset / limits.offset_rate;
    const double water = hypot(steer->snake.current[0], steer->snake.current[1]);
    const double speed = steer_last_plan(steer)->straight.speed;
    steer_say_limit(steer, text, size);
    moray_text_add(text, size, " at %.2f deg/s, which takes %.3g s to build up.", sustained / DEG, build_up);
    if (fastest > sustained)
        moray_text_add(
            text, size,
            " The reference turns at up to %.2f deg/s, beyond that: there the error grows however the robot is "
            "steered.",
            fastest / DEG);
    if (jump > 0)
        moray_text_add(text, size, " A jump of %.4g deg takes %.3g s at least.", jump / DEG,
                       jump / sustained + build_up);
    moray_text_add(text, size, " T");
    steer_say_saturation(steer, text, size);
    if (water > speed)
        moray_text_add(
            text, size,
            " The current of %.3g m/s is stronger than the robot, which swims %.3g m/s: it holds its heading, but "
            "over ground it is carried away.",
            water, speed);
}

static moray_status why_not(const heading_job *job, const moray_steering_plan *plan)
{
    const double jump = largest_jump(job), fastest = moray_reference_fastest(&job->reference, 0, job->horizon);
    const double sustained = fabs(job->steer.turn_rate[plan->straight.model]);
    const moray_status told = steer_not_solved(plan->solution);
    if (told.code != MORAY_NOT_SOLVED || steer_cut_short(plan->solution) || !isfinite(job->max_error))
        return told;
    if (jump > 2 * job->max_error)
        return moray_error(
            MORAY_NOT_SOLVED,
            "max_error_deg = %g: the reference jumps by %.4g deg, and no heading is within %g deg of both "
            "sides of it",
            job->max_error / DEG, jump / DEG, job->max_error / DEG);
    if (fastest > sustained)
        return moray_error(MORAY_NOT_SOLVED,
                           "max_error_deg = %g cannot be kept: the reference turns at up to %.3g deg/s, the robot with "
                           "its offset at the limit at %.3g deg/s",
                           job->max_error / DEG, fastest / DEG, sustained / DEG);
    return told;
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

moray_settings heading_settings(heading_job *job, bool averaged, double period)
{
    const double per_period = averaged ? 1.2 : job->steer.intervals_per_period;
    const int least = (int)ceil(job->horizon / period * per_period);
    const int intervals = moray_reference_intervals(&job->reference, 0, job->horizon, least < 4 ? 4 : least);
    return steer_settings(&job->steer, averaged, intervals, 1e-5, 1e-4);
}

static moray_status make_plan(heading_job *job, moray_model model, const moray_gait *gait,
                              const moray_steering_plan *from)
{
    const moray_heading_spec spec = heading_spec(job, model, false);
    moray_settings settings = heading_settings(job, false, 2 * M_PI / gait->omega);
    if (from && from->straight.model == model && from != &job->steer.plan[STEER_AVERAGED])
        settings.barrier = 1e-6;
    moray_steering_plan *plan = &job->steer.plan[model];
    MORAY_TRY(steer_straight_motions(&job->steer, 1 + (int)model, gait, model));
    if (model == job->steer.snake.model) // the rest of the gait's trials
        MORAY_TRY(steer_begin_trials(&job->steer));
    MORAY_TRY(moray_heading_plan_make(plan, &spec, &settings, gait, from));
    const moray_gait kept = moray_steering_gait(moray_solution_parameters(plan->solution));
    MORAY_TRY(steer_find_turn_rate(&job->steer, model, &kept));
    return steer_solved(plan->solution) ? moray_ok() : why_not(job, plan);
}

moray_status heading_plan_first(heading_job *job)
{
    steer_job *steer = &job->steer;
    const moray_gait first = steer_first_gait(steer);
    steer_clock_give(&steer->clock, 0.4);
    moray_steering_plan *first_plan = &steer->plan[STEER_AVERAGED];
    const moray_heading_spec averaged = heading_spec(job, MORAY_CONTROL_ORIENTED, true);
    const moray_settings coarse = heading_settings(job, true, 2 * M_PI / first.omega);
    MORAY_TRY(moray_heading_plan_make(first_plan, &averaged, &coarse, &first, NULL));
    return make_plan(job, MORAY_CONTROL_ORIENTED, &first_plan->straight.gait, first_plan);
}

moray_status heading_plan_last(heading_job *job)
{
    const moray_gait first = steer_first_gait(&job->steer);
    const moray_gait gait =
        moray_gait_map(&job->steer.snake.robot, &first, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    const moray_steering_plan *control = &job->steer.plan[MORAY_CONTROL_ORIENTED];
    steer_clock_give(&job->steer.clock, 0.5);
    MORAY_TRY(steer_find_turn_rate(&job->steer, MORAY_FIRST_PRINCIPLES, &gait));
    const moray_steering_plan *from = steer_alike(&job->steer, MORAY_FIRST_PRINCIPLES, control) ? control : NULL;
    if (job->gait_evaluations == 0 || steer_gait_given(&job->steer))
        return make_plan(job, MORAY_FIRST_PRINCIPLES, &gait, from);
    moray_steering_plan best;
    steer_clock_give(&job->steer.clock, 0.3);
    moray_status status = heading_search_gait(job, &gait, &best);
    const bool found = best.solution != NULL; // else the time given, or no solve, was too short for one
    steer_clock_give(&job->steer.clock, 0.5);
    if (!moray_failed(status))
        status = make_plan(job, MORAY_FIRST_PRINCIPLES, found ? &best.straight.gait : &gait, found ? &best : from);
    moray_steering_plan_free(&best);
    return status;
}
