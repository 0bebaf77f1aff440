// SPDX-License-Identifier: MIT
#include <stdarg.h>
#include <string.h>

#include "job.h"

static const double across_unit = 0.1; // m of cross-track error, in the objective

moray_path_spec path_spec(const path_job *job, moray_model model, bool averaged)
{
    const moray_robot *robot = &job->common.robot;
    // The objective as a tenth of a mean over time: multipliers of the order of one.
    const double seconds = 10 * job->path.length / job->straight[0][model].speed;
    return (moray_path_spec){.robot = *robot,
                             .model = model,
                             .averaged = averaged,
                             .current = {job->common.current[0], job->common.current[1]},
                             .limits = steer_limits(&job->input, robot, &job->straight[0][model]),
                             .weight = {.across = 1 / (across_unit * across_unit * seconds),
                                        .time = job->weight_time / seconds,
                                        .steering = job->weight_steering / seconds},
                             .path = &job->path,
                             .tube = fmin(job->tube, MORAY_INFINITY),
                             .reach = job->reach};
}

// ---- What limits the robot -----------------------------------------------------------------------------------------

// Speed over ground along a course, crabbing.
static double way(const path_job *job, double speed, double course)
{
    const double *V = job->common.current, c = cos(course), s = sin(course);
    const double side = V[1] * c - V[0] * s;
    return sqrt(fmax(speed * speed - side * side, 0)) + V[0] * c + V[1] * s;
}

double path_turning(const path_job *job, const moray_path_piece *piece)
{
    const double speed = job->speed, turned = piece->curvature * piece->length;
    return fabs(piece->curvature) * fmax(way(job, speed, piece->course), way(job, speed, piece->course + turned));
}

// The corner that asks for the fastest turning; NULL without corners.
static const moray_path_piece *tightest(const path_job *job)
{
    const moray_path_piece *worst = NULL;
    for (int k = 0; k < job->path.n; k++)
        if (job->path.piece[k].curvature != 0 &&
            (!worst || path_turning(job, &job->path.piece[k]) > path_turning(job, worst)))
            worst = &job->path.piece[k];
    return worst;
}

void path_crab(const path_job *job, const moray_path_piece *leg, double *asked, double *planned)
{
    enum { points = 4000 };
    const moray_path_plan *plan = path_last_plan(job);
    const double *V = job->common.current, speed = plan->straight.speed, course = leg->course;
    double t0, tf, x[MORAY_STEERING_STATES], u[2], sum = 0;
    int n = 0;
    *asked = -asin((V[1] * cos(course) - V[0] * sin(course)) / speed);
    moray_solution_times(plan->solution, 0, &t0, &tf);
    for (int k = 0; k <= points; k++) {
        const double t = t0 + (tf - t0) * k / points;
        moray_solution_at(plan->solution, 0, t, x, u);
        const double part = (u[1] - leg->start) / leg->length;
        if (part < 0.4 || part > 0.8)
            continue;
        sum += remainder(moray_straight_motion_heading(&plan->straight, t, x[0]) - course, 2 * M_PI);
        n++;
    }
    *planned = n ? sum / n : NAN;
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

static void say_corner(const path_job *job, const moray_path_piece *corner, char *text, size_t size)
{
    say(text, size,
        "the corner behind leg %d turns by %.4g deg on a radius of %.4g m: at the robot's speed over ground that is "
        "%.3g deg/s, and with its offset at the limit it turns at %.3g deg/s",
        corner->leg, fabs(corner->curvature) * corner->length / DEG, fabs(1 / corner->curvature),
        path_turning(job, corner) / DEG, job->turn_rate / DEG);
}

void path_explain(const path_job *job, char *text, size_t size)
{
    const moray_path_plan *plan = path_last_plan(job);
    const moray_path_spec spec = path_spec(job, job->common.model, false);
    const steer_saturation share = steer_saturation_of(plan->solution, &spec.limits);
    const moray_path_piece *corner = tightest(job);
    const bool control = job->common.model == MORAY_CONTROL_ORIENTED;
    *text = 0;
    say(text, size,
        "With |phi_0| at its limit of %.3g %s the robot turns at %.2f deg/s, in still water on a circle of %.3g m, "
        "which takes %.3g s to build up.",
        control ? 100 * spec.limits.offset : spec.limits.offset / DEG, control ? "cm" : "deg", job->turn_rate / DEG,
        plan->straight.speed / job->turn_rate, spec.limits.offset / spec.limits.offset_rate);
    if (corner && path_turning(job, corner) > job->turn_rate) {
        say(text, size, " That is too slow: ");
        say_corner(job, corner, text, size);
        say(text, size, ".");
    } else if (corner)
        say(text, size, " The corners ask for up to %.2f deg/s.", path_turning(job, corner) / DEG);
    say(text, size, " Swimming straight along the path, crabbing, would take %.1f s by the triangle of velocities.",
        moray_path_duration(&job->path, 0, plan->straight.speed, job->common.current));
    say(text, size, " The plan has the offset at its limit for %.0f %% of the time, and its rate for %.0f %%.",
        100 * share.offset, 100 * share.rate);
}

static moray_status why_not(const path_job *job, const moray_path_plan *plan)
{
    char text[400] = "";
    const moray_nlp_info *info = moray_solution_info(plan->solution);
    const moray_path_piece *corner = tightest(job);
    if (info->outcome == MORAY_NLP_INTERRUPTED)
        return moray_error(MORAY_INTERRUPTED, "interrupted after %d iterations", info->iterations);
    if (isfinite(job->tube) && corner && path_turning(job, corner) > job->turn_rate) {
        say_corner(job, corner, text, sizeof text);
        return moray_error(MORAY_NOT_SOLVED, "tube_m = %g cannot be kept: %.300s", job->tube, text);
    }
    steer_diagnosis(plan->solution, text, sizeof text);
    return moray_error(MORAY_NOT_SOLVED, "%.280s", text);
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

static bool show_iteration(void *observer, const moray_progress *at)
{
    const path_job *job = observer;
    moray_ticker_show(&job->ticker, "path_following: iteration %d, objective %.6g, violation %.1e", at->iteration,
                      at->objective, at->infeasibility);
    return !moray_interrupted();
}

static moray_settings settings_of(path_job *job, bool averaged, const moray_straight_motion *straight)
{
    const double per_period = averaged ? 1.2 : job->intervals_per_period, period = 2 * M_PI / straight->gait.omega;
    const double seconds = moray_path_duration(&job->path, 0, straight->speed, job->common.current);
    moray_settings settings = moray_settings_default();
    settings.scheme = averaged ? "radau3" : job->common.scheme;
    settings.intervals = (int)ceil(seconds / period * per_period) + 4;
    if (!averaged && job->common.intervals > 0)
        settings.intervals = job->common.intervals;
    settings.tolerance = job->common.tol;
    settings.linear_solver = job->common.linear_solver;
    settings.mesh_tolerance = 1e-4; // a corner begins and ends with a kink
    settings.max_refinements = averaged ? 0 : job->refinements;
    settings.barrier = averaged ? 0.1 : 1e-4;
    settings.progress = show_iteration;
    settings.observer = job;
    return settings;
}

static moray_status find_turn_rate(path_job *job, const moray_straight_motion *straight)
{
    const moray_path_spec spec = path_spec(job, straight->model, false);
    moray_gait gait = straight->gait;
    gait.offset = spec.limits.offset;
    MORAY_TRY(moray_turn_rate(&job->common.robot, straight->model, &gait, &job->turn_rate));
    job->turn_rate = fabs(job->turn_rate);
    job->speed = straight->speed;
    return moray_ok();
}

static moray_status solve(path_job *job, const moray_path_spec *spec, const moray_gait *gait,
                          const moray_path_plan *from, moray_path_plan *plan)
{
    moray_straight_motion straight;
    MORAY_TRY(moray_straight_motion_find(&straight, &spec->robot, spec->model, gait));
    MORAY_TRY(moray_path_passable(spec->path, straight.speed, spec->current));
    MORAY_TRY(find_turn_rate(job, &straight));
    const moray_settings settings = settings_of(job, spec->averaged, &straight);
    MORAY_TRY(moray_path_plan_make(plan, spec, &settings, gait, job->start, job->heading, from));
    MORAY_TRY(steer_interruption());
    return moray_solution_info(plan->solution)->outcome == MORAY_NLP_SOLVED ? moray_ok() : why_not(job, plan);
}

static moray_status make_plan(path_job *job, moray_model model, const moray_gait *gait, const moray_path_plan *from)
{
    const moray_path_spec spec = path_spec(job, model, false);
    const moray_sim_settings sim = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&sim);
    moray_path_plan *plan = &job->plan[model];
    MORAY_TRY(solve(job, &spec, gait, from, plan));
    MORAY_TRY(moray_certify(plan->solution, &integrator, &job->certificate[model]));
    return steer_straight_motions(job->straight[1 + model], &spec.robot, &plan->straight.gait, model);
}

moray_status path_make_plans(path_job *job)
{
    const moray_robot *robot = &job->common.robot;
    const moray_gait paper = moray_gait_paper(robot);
    if (isnan(job->heading))
        job->heading = job->path.piece->course;
    MORAY_TRY(steer_straight_motions(job->straight[0], robot, &paper, MORAY_CONTROL_ORIENTED));
    const moray_gait first = steer_first_gait(&job->input, robot);
    const moray_path_spec averaged = path_spec(job, MORAY_CONTROL_ORIENTED, true);
    MORAY_TRY(solve(job, &averaged, &first, NULL, &job->averaged));
    MORAY_TRY(make_plan(job, MORAY_CONTROL_ORIENTED, &job->averaged.straight.gait, &job->averaged));
    if (job->common.model == MORAY_CONTROL_ORIENTED)
        return moray_ok();
    moray_gait gait = moray_gait_map(robot, &first, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    const moray_path_spec last = path_spec(job, MORAY_FIRST_PRINCIPLES, false);
    if (job->find_gait && !steer_gait_given(&job->input))
        MORAY_TRY(steer_fastest_gait(&job->input, robot, last.limits.power, &gait));
    return make_plan(job, MORAY_FIRST_PRINCIPLES, &gait, &job->plan[MORAY_CONTROL_ORIENTED]);
}
