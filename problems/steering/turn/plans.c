// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "job.h"

double turn_duration(const moray_turn_plan *plan)
{
    double t0, tf;
    moray_solution_times(plan->solution, 0, &t0, &tf);
    return tf;
}

moray_steering_limits turn_limits(const turn_job *job, moray_model model)
{
    return steer_limits(&job->input, &job->common.robot, &job->straight[model]);
}

static moray_turn_spec spec_of(const turn_job *job, moray_model model, bool averaged)
{
    return (moray_turn_spec){.robot = job->common.robot,
                             .model = model,
                             .averaged = averaged,
                             .current = {job->common.current[0], job->common.current[1]},
                             .limits = turn_limits(job, model),
                             .heading = job->angle,
                             .to_position = job->to_position,
                             .position = {job->end[0], job->end[1]},
                             .steering = job->weight_steering};
}

// ---- What limits the robot -----------------------------------------------------------------------------------------

void turn_explain(const turn_job *job, char *text, size_t size)
{
    const moray_model model = job->common.model;
    const moray_steering_limits limits = turn_limits(job, model);
    const steer_saturation share = steer_saturation_of(turn_last_plan(job)->solution, &limits);
    const bool control = model == MORAY_CONTROL_ORIENTED;
    const double rate = fabs(job->turn_rate[model]), ramp = limits.offset / limits.offset_rate;
    const char *limited = share.offset > 2 * share.rate   ? "The limit of the offset decides"
                          : share.rate > 2 * share.offset ? "The rate of the offset decides"
                                                          : "Offset and rate decide together";
    snprintf(
        text, size,
        "With |phi_0| at its limit of %.3g %s the robot turns steadily at %.2f deg/s, %.4g deg in %.2f s; to bring "
        "the offset there and back takes %.3g s each. %s: the plan has the offset at its limit for %.0f %% of the "
        "time, and its rate for %.0f %%. The heading swings with every stroke: it counts without the undulation "
        "of straight swimming, and the turn may end in any part of a stroke.",
        control ? 100 * limits.offset : limits.offset / DEG, control ? "cm" : "deg", rate / DEG, job->angle / DEG,
        fabs(job->angle) / rate, ramp, limited, 100 * share.offset, 100 * share.rate);
}

static moray_status why_not(const turn_job *job, const moray_turn_plan *plan)
{
    const double *V = job->common.current, water = hypot(V[0], V[1]);
    char text[300];
    steer_diagnosis(plan->solution, text, sizeof text);
    if (job->to_position && water > plan->straight.speed)
        return moray_error(MORAY_NOT_SOLVED,
                           "end_m = %g,%g is not reached: the current of %.4g m/s is stronger than the robot, which "
                           "swims %.4g m/s",
                           job->end[0], job->end[1], water, plan->straight.speed);
    if (job->to_position)
        return moray_error(MORAY_NOT_SOLVED,
                           "end_m = %g,%g with angle_deg = %g is not reached: the robot turns on a circle of %.3g m at "
                           "the least (%.200s)",
                           job->end[0], job->end[1], job->angle / DEG,
                           plan->straight.speed / fabs(job->turn_rate[plan->straight.model]), text);
    return moray_error(MORAY_NOT_SOLVED, "%.280s", text);
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

static bool show_iteration(void *observer, const moray_progress *at)
{
    const turn_job *job = observer;
    moray_ticker_show(&job->ticker, "min_time_turn: iteration %d, objective %.6g, violation %.1e", at->iteration,
                      at->objective, at->infeasibility);
    return !moray_interrupted();
}

// With as many intervals as the plan before took periods.
static moray_settings settings_of(turn_job *job, const moray_turn_plan *from, double period)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = from ? job->common.scheme : "radau3";
    settings.intervals = from ? (int)ceil(turn_duration(from) / period * job->intervals_per_period) : 30;
    if (from && job->common.intervals > 0)
        settings.intervals = job->common.intervals;
    settings.tolerance = job->common.tol;
    settings.linear_solver = job->common.linear_solver;
    settings.mesh_tolerance = 1e-4; // steering at its limits has kinks
    settings.max_refinements = from ? job->refinements : 0;
    settings.barrier = from ? 1e-3 : 0.1;
    settings.progress = show_iteration;
    settings.observer = job;
    return settings;
}

static bool solved(const moray_turn_plan *plan)
{
    return moray_solution_info(plan->solution)->outcome == MORAY_NLP_SOLVED;
}

// From the plan `from` on times that end at several parts of a stroke; leaves the fastest turn.
static moray_status solve(turn_job *job, moray_model model, const moray_gait *gait, const moray_turn_plan *from,
                          moray_turn_plan *plan)
{
    enum { starts = 2 };
    const moray_turn_spec spec = spec_of(job, model, from == NULL);
    const double period = 2 * M_PI / gait->omega;
    const moray_settings settings = settings_of(job, from, period);
    moray_gait turning = *gait;
    turning.offset = spec.limits.offset;
    MORAY_TRY(moray_turn_rate(&spec.robot, model, &turning, &job->turn_rate[model]));
    for (int k = 0; k < (from ? starts : 1); k++) {
        const double seconds = from ? turn_duration(from) : 1, later = from ? period * (k - 0.5) / starts : 0;
        moray_turn_plan next;
        MORAY_TRY(
            moray_turn_plan_make(&next, &spec, &settings, gait, job->turn_rate[model], from, 1 + later / seconds));
        const bool better =
            !plan->solution || (solved(&next) && (!solved(plan) || moray_solution_objective(next.solution) <
                                                                       moray_solution_objective(plan->solution)));
        moray_turn_plan_free(better ? plan : &next);
        if (better)
            *plan = next;
        MORAY_TRY(steer_interruption());
    }
    return solved(plan) ? moray_ok() : why_not(job, plan);
}

moray_status turn_make_plans(turn_job *job)
{
    const moray_robot *robot = &job->common.robot;
    const moray_gait first = steer_first_gait(&job->input, robot);
    const moray_sim_settings sim = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&sim);
    MORAY_TRY(steer_straight_motions(job->straight, robot, &first, MORAY_CONTROL_ORIENTED));
    MORAY_TRY(solve(job, MORAY_CONTROL_ORIENTED, &first, NULL, &job->averaged));
    const moray_gait found = job->averaged.straight.gait;
    MORAY_TRY(steer_straight_motions(job->straight, robot, &found, MORAY_CONTROL_ORIENTED));
    const moray_turn_plan *from = &job->averaged;
    for (int model = 0; model <= (int)job->common.model; model++) {
        MORAY_TRY(solve(job, (moray_model)model, &job->straight[model].gait, from, &job->plan[model]));
        MORAY_TRY(moray_certify(job->plan[model].solution, &integrator, &job->certificate[model]));
        from = &job->plan[model];
    }
    return moray_ok();
}
