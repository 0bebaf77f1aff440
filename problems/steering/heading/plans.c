// SPDX-License-Identifier: MIT
#include <stdarg.h>
#include <string.h>

#include "job.h"

static const double error_unit = 10 * DEG; // of the heading, in the objective

moray_heading_spec heading_spec(const heading_job *job, moray_model model, bool averaged)
{
    const moray_robot *robot = &job->common.robot;
    return (moray_heading_spec){.robot = *robot,
                                .model = model,
                                .averaged = averaged,
                                .current = {job->common.current[0], job->common.current[1]},
                                .limits = steer_limits(&job->input, robot, &job->straight[0][model]),
                                .weight = {.heading = 1 / (error_unit * error_unit),
                                           .power = job->weight_power,
                                           .steering = job->weight_steering},
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

static void say(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void say(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

void heading_explain(const heading_job *job, char *text, size_t size)
{
    const moray_heading_plan *plan = heading_last_plan(job);
    const moray_heading_spec spec = heading_spec(job, job->common.model, false);
    const double fastest = moray_reference_fastest(&job->reference, 0, job->horizon), sustained = job->turn_rate;
    const double jump = largest_jump(job), water = hypot(job->common.current[0], job->common.current[1]);
    const steer_saturation share = steer_saturation_of(plan->solution, &spec.limits);
    const bool control = job->common.model == MORAY_CONTROL_ORIENTED;
    *text = 0;
    say(text, size,
        "With |phi_0| at its limit of %.3g %s the robot turns at %.2f deg/s, which takes %.3g s to build up.",
        control ? 100 * spec.limits.offset : spec.limits.offset / DEG, control ? "cm" : "deg", sustained / DEG,
        spec.limits.offset / spec.limits.offset_rate);
    if (fastest > sustained)
        say(text, size,
            " The reference turns at up to %.2f deg/s, beyond that: there the error grows however the robot is "
            "steered.",
            fastest / DEG);
    if (jump > 0)
        say(text, size, " A jump of %.4g deg takes %.3g s at least.", jump / DEG,
            jump / sustained + spec.limits.offset / spec.limits.offset_rate);
    say(text, size, " The plan has the offset at its limit for %.0f %% of the time, and its rate for %.0f %%.",
        100 * share.offset, 100 * share.rate);
    if (water > plan->straight.speed)
        say(text, size,
            " The current of %.3g m/s is stronger than the robot, which swims %.3g m/s: it holds its heading, but over "
            "ground it is carried away.",
            water, plan->straight.speed);
}

static moray_status why_not(const heading_job *job, const moray_heading_plan *plan)
{
    char text[700];
    const moray_nlp_info *info = moray_solution_info(plan->solution);
    if (info->outcome == MORAY_NLP_INTERRUPTED)
        return moray_error(MORAY_INTERRUPTED, "interrupted while planning; nothing is written");
    const double jump = largest_jump(job), fastest = moray_reference_fastest(&job->reference, 0, job->horizon);
    if (isfinite(job->max_error) && jump > 2 * job->max_error)
        return moray_error(
            MORAY_NOT_SOLVED,
            "max_error_deg = %g: the reference jumps by %.4g deg, and no heading is within %g deg of both "
            "sides of it",
            job->max_error / DEG, jump / DEG, job->max_error / DEG);
    if (isfinite(job->max_error) && fastest > job->turn_rate)
        return moray_error(MORAY_NOT_SOLVED,
                           "max_error_deg = %g cannot be kept: the reference turns at up to %.3g deg/s, the robot with "
                           "its offset at the limit at %.3g deg/s",
                           job->max_error / DEG, fastest / DEG, job->turn_rate / DEG);
    snprintf(text, sizeof text, "%s", moray_solution_diagnosis(plan->solution));
    return moray_error(MORAY_NOT_SOLVED, "%.280s", text);
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

static bool show_iteration(void *observer, const moray_progress *at)
{
    const heading_job *job = observer;
    moray_ticker_show(&job->ticker, "heading_tracking: iteration %d, objective %.6g, violation %.1e", at->iteration,
                      at->objective, at->infeasibility);
    return !moray_interrupted();
}

moray_settings heading_settings(heading_job *job, bool averaged, double period)
{
    const double per_period = averaged ? 1.2 : job->intervals_per_period;
    const int least = (int)ceil(job->horizon / period * per_period);
    moray_settings settings = moray_settings_default();
    settings.scheme = averaged ? HEADING_AVERAGED_SCHEME : job->common.scheme;
    settings.intervals = moray_reference_intervals(&job->reference, 0, job->horizon, least < 4 ? 4 : least);
    if (!averaged && job->common.intervals > 0)
        settings.intervals = job->common.intervals;
    settings.tolerance = job->common.tol;
    settings.linear_solver = job->common.linear_solver;
    settings.mesh_tolerance = 1e-5;
    settings.max_refinements = averaged ? 0 : job->refinements;
    settings.barrier = averaged ? 0.1 : 1e-4;
    settings.progress = show_iteration;
    settings.observer = job;
    return settings;
}

static moray_status find_turn_rate(heading_job *job, const moray_heading_plan *plan)
{
    const moray_heading_spec spec = heading_spec(job, plan->straight.model, false);
    moray_gait gait = moray_steering_gait(moray_solution_parameters(plan->solution));
    gait.offset = spec.limits.offset;
    MORAY_TRY(moray_turn_rate(&job->common.robot, plan->straight.model, &gait, &job->turn_rate));
    job->turn_rate = fabs(job->turn_rate);
    return moray_ok();
}

static moray_status find_straight_motions(heading_job *job, int index, const moray_gait *gait, moray_model from)
{
    for (int model = 0; model < 2; model++) {
        const moray_gait mapped = moray_gait_map(&job->common.robot, gait, from, (moray_model)model);
        MORAY_TRY(
            moray_straight_motion_find(&job->straight[index][model], &job->common.robot, (moray_model)model, &mapped));
    }
    return moray_ok();
}

static moray_status make_plan(heading_job *job, moray_model model, const moray_gait *gait,
                              const moray_heading_plan *from)
{
    const moray_heading_spec spec = heading_spec(job, model, false);
    moray_settings settings = heading_settings(job, false, 2 * M_PI / gait->omega);
    if (from->straight.model == model && from != &job->averaged)
        settings.barrier = 1e-6;
    moray_heading_plan *plan = &job->plan[model];
    MORAY_TRY(moray_heading_plan_make(plan, &spec, &settings, gait, from));
    MORAY_TRY(find_turn_rate(job, plan));
    if (moray_solution_info(plan->solution)->outcome != MORAY_NLP_SOLVED)
        return why_not(job, plan);
    const moray_sim_settings sim = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&sim);
    MORAY_TRY(moray_certify(plan->solution, &integrator, &job->certificate[model]));
    return find_straight_motions(job, 1 + (int)model, &plan->straight.gait, model);
}

moray_status heading_plan_first(heading_job *job)
{
    const moray_robot *robot = &job->common.robot;
    const moray_gait paper = moray_gait_paper(robot);
    MORAY_TRY(find_straight_motions(job, 0, &paper, MORAY_CONTROL_ORIENTED));
    const moray_gait first = steer_first_gait(&job->input, robot);
    const moray_heading_spec averaged = heading_spec(job, MORAY_CONTROL_ORIENTED, true);
    const moray_settings coarse = heading_settings(job, true, 2 * M_PI / first.omega);
    MORAY_TRY(moray_heading_plan_make(&job->averaged, &averaged, &coarse, &first, NULL));
    return make_plan(job, MORAY_CONTROL_ORIENTED, &job->averaged.straight.gait, &job->averaged);
}

moray_status heading_plan_last(heading_job *job)
{
    const moray_robot *robot = &job->common.robot;
    const moray_gait first = steer_first_gait(&job->input, robot);
    const moray_gait gait = moray_gait_map(robot, &first, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    if (job->gait_evaluations == 0 || steer_gait_given(&job->input))
        return make_plan(job, MORAY_FIRST_PRINCIPLES, &gait, &job->plan[MORAY_CONTROL_ORIENTED]);
    moray_heading_plan best;
    moray_status status = heading_search_gait(job, &gait, &best);
    if (!moray_failed(status))
        status = make_plan(job, MORAY_FIRST_PRINCIPLES, &best.straight.gait, &best);
    moray_heading_plan_free(&best);
    return status;
}
