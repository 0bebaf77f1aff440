// SPDX-License-Identifier: MIT
#include "turn.h"

static moray_turn_spec spec_of(const turn_job *job, moray_model model, bool averaged)
{
    const moray_snake_options *snake = &job->steer.snake;
    return (moray_turn_spec){.robot = snake->robot,
                             .model = model,
                             .averaged = averaged,
                             .current = {snake->current[0], snake->current[1]},
                             .water = job->steer.water,
                             .limits = steer_limits(&job->steer, model),
                             .heading = job->angle,
                             .to_position = turn_to_position(job),
                             .position = {job->end[0], job->end[1]},
                             .steering = job->steer.weight_steering};
}

static moray_status why_not(const turn_job *job, const moray_steering_plan *plan)
{
    const double speed = plan->straight.speed;
    const moray_status told = steer_not_solved(plan->solution);
    if (told.code != MORAY_NOT_SOLVED || steer_cut_short(plan->solution) || !turn_to_position(job))
        return told;
    return moray_error(MORAY_NOT_SOLVED,
                       "no way was found to end_m = %g,%g with angle_deg = %g by a robot that turns on a circle of "
                       "%.3g m at the least, from any outline tried; %s",
                       job->end[0], job->end[1], job->angle / DEG,
                       speed / fabs(job->steer.turn_rate[plan->straight.model]), told.text);
}

// The verdict before any plan: whether the robot can make way towards the end position.
static moray_status check_reach(const turn_job *job)
{
    const double *V = job->steer.snake.current, water = hypot(V[0], V[1]);
    const double speed = job->steer.straight[0][job->steer.snake.model].speed;
    const double course = atan2(job->end[1], job->end[0]);
    if (!turn_to_position(job) || water <= speed || moray_course_made_good(speed, V, course) > 0)
        return moray_ok();
    return moray_error(MORAY_NOT_SOLVED,
                       "end_m = %g,%g is not reached: the current of %.4g m/s is stronger than the robot, which swims "
                       "%.4g m/s, so only courses within %.3g deg of %.4g deg can be made good, and the end lies at "
                       "%.4g deg",
                       job->end[0], job->end[1], water, speed, asin(speed / water) / DEG, atan2(V[1], V[0]) / DEG,
                       course / DEG);
}

// With as many intervals as the plan before took periods; steering at its limits has kinks.
static moray_settings settings_of(turn_job *job, const moray_steering_plan *from, double period)
{
    const int intervals =
        from ? (int)ceil(steer_duration(from->solution) / period * job->steer.intervals_per_period) : 30;
    return steer_settings(&job->steer, !from, intervals, 1e-4, 1e-3);
}

static bool solved(const moray_steering_plan *plan)
{
    return steer_solved(plan->solution);
}

// On a mesh that is fine enough, or on which there was time enough.
static bool finished(const moray_steering_plan *plan)
{
    return moray_solution_info(plan->solution)->outcome == MORAY_NLP_SOLVED;
}

// Whether a turn is better than another: solved, on its last mesh too, and faster.
static bool is_better(const moray_steering_plan *next, const moray_steering_plan *plan)
{
    if (!plan->solution || solved(next) != solved(plan))
        return !plan->solution || solved(next);
    if (!solved(next) || finished(next) != finished(plan))
        return finished(next);
    return moray_solution_objective(next->solution) < moray_solution_objective(plan->solution);
}

// Takes the better turn of the two.
static void keep_better(moray_steering_plan *plan, moray_steering_plan *next)
{
    const bool better = is_better(next, plan);
    moray_steering_plan_free(better ? plan : next);
    if (better)
        *plan = *next;
}

// How much longer a turn takes than that of a plan, by the steady rates of turning of the two models.
static double stretch_of(const turn_job *job, moray_model model, const moray_steering_plan *from)
{
    const moray_steering_limits limits = steer_limits(&job->steer, model);
    const double *rate = job->steer.turn_rate, ratio = fabs(rate[from->straight.model] / rate[model]);
    const double seconds = steer_duration(from->solution), ramps = 2 * limits.offset / limits.offset_rate;
    return seconds > ramps ? (ramps + (seconds - ramps) * ratio) / seconds : 1;
}

// From the plan `from` on times that end at several parts of a stroke, on longer ones where that does not solve, and at
// last from nothing; leaves the fastest turn. A start that leads nowhere leaves time for the next.
static moray_status solve(turn_job *job, moray_model model, const moray_gait *gait, const moray_steering_plan *from,
                          moray_steering_plan *plan)
{
    enum { starts = 2, longer = 3 };
    const moray_turn_spec spec = spec_of(job, model, from == NULL);
    const double period = 2 * M_PI / gait->omega, turn_rate = job->steer.turn_rate[model];
    const double stretch = from ? stretch_of(job, model, from) : 1;
    const moray_settings settings = settings_of(job, from, period / stretch);
    steer_clock_give(&job->steer.clock, !from ? 0.2 : model < job->steer.snake.model ? 0.3 : 0.5);
    const double until = job->steer.clock.until;
    for (int k = 0; from && (k < starts || (k < starts + longer && !finished(plan))); k++) {
        const double later = k < starts ? period * (k - 0.5) / starts / steer_duration(from->solution)
                                        : stretch * 0.1 * (k - starts + 1);
        moray_steering_plan next;
        steer_clock_divide(&job->steer.clock, until);
        MORAY_TRY(moray_turn_plan_make(&next, &spec, &settings, gait, turn_rate, from, stretch + later));
        keep_better(plan, &next);
        MORAY_TRY(steer_interruption());
    }
    job->steer.clock.until = until;
    if (!plan->solution || !solved(plan)) {
        moray_steering_plan next;
        MORAY_TRY(moray_turn_plan_make(&next, &spec, &settings, gait, turn_rate, NULL, 1));
        keep_better(plan, &next);
        MORAY_TRY(steer_interruption());
    }
    return solved(plan) ? moray_ok() : why_not(job, plan);
}

moray_status turn_make_plans(turn_job *job)
{
    steer_job *steer = &job->steer;
    const moray_gait first = steer_first_gait(steer);
    moray_steering_plan *averaged = &steer->plan[STEER_AVERAGED];
    MORAY_TRY(steer_straight_motions(steer, 0, &first, MORAY_CONTROL_ORIENTED));
    for (int model = 0; model < 2; model++) // both are swum, whatever is planned on
        MORAY_TRY(steer_find_turn_rate(steer, (moray_model)model, &steer->straight[0][model].gait));
    MORAY_TRY(check_reach(job));
    MORAY_TRY(solve(job, MORAY_CONTROL_ORIENTED, &first, NULL, averaged));
    MORAY_TRY(steer_straight_motions(steer, 0, &averaged->straight.gait, MORAY_CONTROL_ORIENTED));
    const moray_steering_plan *from = averaged;
    for (int model = 0; model <= (int)steer->snake.model; model++) {
        MORAY_TRY(solve(job, (moray_model)model, &steer->straight[0][model].gait, from, &steer->plan[model]));
        from = &steer->plan[model];
    }
    return moray_ok();
}
