// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "job.h"

enum { START_SAMPLES = 101 }; // of the motion that a solve begins from
// Of the speed through still water: not all models of the water know nothing of who looks, but none gains so much by
// it.
static const double beyond_doubt = 1.25;

static double limit(double value)
{
    return isfinite(value) ? value : MORAY_INFINITY;
}

// The joints' own limits and form are those of --model.
moray_gait_problem_spec gait_job_spec(const gait_job *job, const stage *at, moray_gait_goal goal,
                                      const double current[2])
{
    const bool revolute = at->model == MORAY_FIRST_PRINCIPLES, own = at->model == job->snake.model;
    const double *offset = revolute ? job->offset_angle : job->offset;
    const double theta_max = at->link_angle > 0 ? at->link_angle : job->theta_max[1];
    return (moray_gait_problem_spec){
        .robot = job->snake.robot,
        .model = at->model,
        .goal = goal,
        .joints = own ? job->joints : MORAY_JOINTS_ON_GAIT,
        .current = {current[0], current[1]},
        .course = job->snake.course,
        .limits = {.theta_max = moray_between(job->theta_max[0], theta_max),
                   .link_angles = at->link_angle > 0,
                   .omega = moray_between(job->omega[0], job->omega[1]),
                   .delta = moray_between(job->delta[0], job->delta[1]),
                   .offset = moray_between(offset[0], offset[1]),
                   .taper = moray_between(at->taper[0], at->taper[1]),
                   .power = limit(at->power),
                   .joint_rate = own ? limit(job->joint_rate * (revolute ? DEG : 1)) : MORAY_INFINITY,
                   .joint_effort = own ? limit(job->joint_effort) : MORAY_INFINITY,
                   .course_speed = goal == MORAY_GAIT_THRIFTIEST ? at->speed : 0}};
}

moray_status gait_job_problem(const gait_job *job, const stage *at, moray_gait_goal goal, const double current[2],
                              moray_gait_problem **problem)
{
    const moray_gait_problem_spec spec = gait_job_spec(job, at, goal, current);
    MORAY_TRY(gait_job_turning(job, at->model));
    return moray_gait_problem_new(problem, &spec);
}

// ---- Solving -------------------------------------------------------------------------------------------------------

static bool show_iteration(void *observer, const moray_progress *at)
{
    const gait_job *job = observer;
    const bool fastest = job->goal == MORAY_GAIT_FASTEST;
    moray_ticker_show(&job->ticker, "%s: iteration %d, %.5f %s, violation %.1e%s", job->name, at->iteration,
                      fastest ? -at->objective : at->objective, fastest ? "m/s" : "J/m", at->infeasibility,
                      at->restoring ? " (restoring feasibility)" : "");
    return !moray_interrupted();
}

moray_settings gait_job_settings(gait_job *job)
{
    return (moray_settings){.scheme = job->common.scheme,
                            .intervals = job->common.intervals,
                            .tolerance = job->common.tol,
                            .linear_solver = job->common.linear_solver,
                            .ipopt = job->common.ipopt.at,
                            .n_ipopt = job->common.ipopt.n,
                            .mesh_tolerance = GAIT_MESH_TOLERANCE,
                            .max_refinements = job->refinements,
                            .max_iterations = 1000,
                            .barrier = 1e-6, // the guess is an orbit, feasible but for the limits
                            .own_scaling = true,
                            .progress = show_iteration,
                            .observer = job};
}

moray_status gait_job_solve_from(gait_job *job, const moray_gait_problem *problem, const moray_gait *gait,
                                 const moray_swim_track *orbit, moray_solution **solution)
{
    const moray_settings settings = gait_job_settings(job);
    return moray_gait_problem_solve(problem, &settings, gait, orbit, solution);
}

// Steady swimming by simulation from rest, straight along the course where the gait cannot hold it.
static moray_status swim_start(gait_job *job, const stage *at, const double current[2], const moray_gait *gait,
                               moray_swim_track *track)
{
    moray_swim_setup setup = moray_test_rig_setup(&job->rig, at->model);
    memcpy(setup.current, current, sizeof setup.current);
    moray_steady steady;
    const moray_status status = moray_swim_hold_course(&setup, gait, job->snake.course, &steady);
    const double heading = moray_failed(status) ? job->snake.course : steady.start_heading;
    return moray_swim_steady(&setup, gait, heading, &steady, track, START_SAMPLES);
}

// The same as the gait's periodic orbit, with the offset that holds the course; from a glide, so that it depends on
// nothing solved before.
static moray_status find_start(gait_job *job, const stage *at, const double current[2], moray_gait *gait,
                               moray_swim_track *track)
{
    moray_orbit_spec spec = moray_orbit_spec_default(&job->snake.robot, at->model);
    moray_orbit *orbit;
    moray_orbit_result found;
    memcpy(spec.current, current, sizeof spec.current);
    spec.course = job->snake.course;
    MORAY_TRY(moray_orbit_new(&orbit, &spec));
    moray_status status = moray_orbit_solve(orbit, gait, &found);
    if (!moray_failed(status))
        status = moray_orbit_track(orbit, START_SAMPLES, track);
    if (!moray_failed(status))
        *gait = found.gait;
    moray_orbit_free(orbit);
    return status;
}

static bool solved(const moray_solution *solution)
{
    return moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED;
}

static moray_status solve_from_motion(gait_job *job, const stage *at, const double current[2],
                                      const moray_gait_problem *problem, const moray_gait *gait,
                                      moray_solution **solution)
{
    moray_swim_track track = {0};
    moray_gait start = *gait;
    moray_status status = moray_ok();
    if (moray_failed(find_start(job, at, current, &start, &track)))
        status = swim_start(job, at, current, &start, &track);
    if (!moray_failed(status))
        status = gait_job_solve_from(job, problem, &start, &track, solution);
    moray_swim_track_free(&track);
    return status;
}

// The controller of the joints leaves the best gait nearly where six states have it, which are solved from anywhere;
// all states from far away may take hundreds of iterations. What fails leaves the gait as it is.
static void approach(gait_job *job, const stage *at, const double current[2], moray_gait *gait)
{
    moray_gait_problem_spec spec = gait_job_spec(job, at, job->goal, current);
    moray_gait_problem *six = NULL;
    moray_solution *solution = NULL;
    spec.joints = MORAY_JOINTS_ON_GAIT;
    if (!moray_failed(moray_gait_problem_new(&six, &spec)) &&
        !moray_failed(solve_from_motion(job, at, current, six, gait, &solution)) && solved(solution))
        *gait = moray_gait_problem_prediction(six, solution).gait;
    moray_solution_free(solution);
    moray_gait_problem_free(six);
}

static moray_status solve_in(gait_job *job, const stage *at, const double current[2], const moray_gait_problem *problem,
                             const moray_gait *gait, moray_solution **solution)
{
    moray_gait start = *gait;
    if (at->model == job->snake.model && job->joints == MORAY_JOINTS_CLOSED_LOOP)
        approach(job, at, current, &start);
    return solve_from_motion(job, at, current, problem, &start, solution);
}

moray_status gait_job_solve(gait_job *job, const stage *at, const moray_gait_problem *problem, const moray_gait *gait,
                            moray_solution **solution)
{
    return solve_in(job, at, job->snake.current, problem, gait, solution);
}

// The gait with a taper that is allowed, its largest joint amplitude as before.
static moray_gait tapered(const stage *at, moray_gait gait)
{
    const double before = 1 + fabs(gait.taper);
    gait.taper = fmin(fmax(gait.taper, at->taper[0]), at->taper[1]);
    gait.amplitude *= before / (1 + fabs(gait.taper));
    return gait;
}

// At constant shape the power grows with about the square of omega, a little faster.
moray_status gait_job_continue(gait_job *job, stage *at, const stage *from)
{
    const double exponent = 0.45, share = at->power / from->prediction.power;
    moray_gait gait = tapered(at, from->prediction.gait);
    moray_solution *solution = NULL;
    if (isfinite(share))
        gait.omega = fmin(fmax(gait.omega * pow(share, exponent), job->omega[0]), job->omega[1]);
    if (!at->problem)
        MORAY_TRY(gait_job_problem(job, at, job->goal, job->snake.current, &at->problem));
    MORAY_TRY(gait_job_solve(job, at, at->problem, &gait, &solution));
    gait_job_keep_best(at, solution);
    at->prediction = moray_gait_problem_prediction(at->problem, at->solution);
    return moray_ok();
}

// The solution of --continue, if it is of this stage; it must be of one of them.
static moray_status load(const gait_job *job, stage *at)
{
    if (!job->from_file[0] || job->stage[MORAY_CONTROL_ORIENTED].from)
        return moray_ok();
    const moray_status status =
        moray_solution_load(&at->from, moray_gait_problem_ocp(at->problem), NULL, job->from_file);
    return at->model < job->snake.model && status.code == MORAY_INPUT ? moray_ok() : status;
}

static moray_status solve_continued(gait_job *job, stage *at)
{
    const moray_settings settings = gait_job_settings(job);
    const moray_guess guess = moray_guess_from_solution(at->from);
    moray_solution *solution = NULL;
    MORAY_TRY(moray_solve(moray_gait_problem_ocp(at->problem), &settings, &guess, &solution));
    gait_job_keep_best(at, solution);
    return moray_ok();
}

static moray_status solve_tapered(gait_job *job, stage *at, void *self, const moray_gait *gait,
                                  moray_solution **solution)
{
    (void)self;
    const moray_gait allowed = tapered(at, *gait);
    return gait_job_solve(job, at, at->problem, &allowed, solution);
}

// From --continue or the known gaits, then, on the model asked for, from random ones.
static moray_status solve_all(gait_job *job, stage *at, const gait_starts *known)
{
    const gait_starts none = {0}, *from = at->from ? &none : known;
    const int most = job->random_starts > known->random ? job->random_starts : known->random;
    const int random = at->model == job->snake.model ? most : 0;
    MORAY_TRY(gait_job_begin_starts(at, (at->from ? 1 : known->n) + random));
    if (at->from)
        MORAY_TRY(solve_continued(job, at));
    return gait_job_try_starts(job, at, from, random, solve_tapered, NULL);
}

// ---- Explaining ----------------------------------------------------------------------------------------------------

// What the fastest gait within the same limits makes that is found from one; speeds are NaN where none is.
static moray_gait_prediction fastest_from(gait_job *job, const stage *at, const double current[2],
                                          const moray_gait *gait)
{
    moray_gait_problem *problem = NULL;
    moray_solution *solution = NULL;
    moray_gait_prediction prediction = {.speed = NAN, .course_speed = NAN};
    if (!moray_failed(gait_job_problem(job, at, MORAY_GAIT_FASTEST, current, &problem)) &&
        !moray_failed(solve_in(job, at, current, problem, gait, &solution)) && solved(solution))
        prediction = moray_gait_problem_prediction(problem, solution);
    moray_solution_free(solution);
    moray_gait_problem_free(problem);
    return prediction;
}

// Likewise from the paper's gait and, where that does not make `enough`, from others: one search may end beside all
// that swims.
static moray_gait_prediction fastest(gait_job *job, const stage *at, const double current[2], double enough)
{
    static const double delta[] = {1, 1.4, 0.7, 1.9};
    const moray_gait *paper = &job->paper.gait[at->model];
    const moray_robot *robot = &job->snake.robot;
    const double theta_max = moray_theta_max_from_amplitude(robot, at->model, paper->amplitude, paper->delta);
    moray_gait_prediction best = {.speed = NAN, .course_speed = NAN};
    for (int k = 0; k < 4 && !(best.course_speed > enough); k++) {
        moray_gait gait = *paper;
        gait.delta = fmin(fmax(delta[k] * paper->delta, job->delta[0]), job->delta[1]);
        gait.amplitude = moray_amplitude_from_theta_max(robot, at->model, theta_max, gait.delta);
        const moray_gait_prediction found = fastest_from(job, at, current, &gait);
        if (isnan(best.course_speed) || found.course_speed > best.course_speed)
            best = found;
    }
    return best;
}

// Whether the current could be stemmed at `reserve` times the best speed through still water.
static moray_status check_current(gait_job *job, const stage *at, double reserve)
{
    const double *V = job->snake.current, c = cos(job->snake.course), s = sin(job->snake.course);
    const double along = V[0] * c + V[1] * s, across = fabs(V[1] * c - V[0] * s), still[2] = {0, 0};
    if (along >= 0 && across == 0)
        return moray_ok();
    const double U = fastest(job, at, still, (along < 0 ? hypot(along, across) : across) / reserve).speed;
    const double most = reserve * U;
    if (across >= most)
        return moray_error(MORAY_NOT_SOLVED,
                           "current = %g,%g: the robot cannot stem it: %.4f m/s of it run across the course, and "
                           "within the limits the robot swims %.4f m/s at most",
                           V[0], V[1], across, U);
    if (sqrt(most * most - across * across) + along <= 0)
        return moray_error(MORAY_NOT_SOLVED,
                           "current = %g,%g: the robot cannot stem it: %.4f m/s of it run against the course, and "
                           "within the limits the robot makes %.4f m/s along it at most",
                           V[0], V[1], -along, sqrt(fmax(U * U - across * across, 0)));
    return moray_ok();
}

moray_status gait_job_stem(gait_job *job, const stage *at)
{
    return check_current(job, at, beyond_doubt);
}

// Why there is no gait that makes way.
static moray_status explain_no_way(gait_job *job, const stage *at)
{
    MORAY_TRY(check_current(job, at, 1));
    if (solved(at->solution))
        return moray_error(MORAY_NOT_SOLVED,
                           "within the limits no gait was found that makes way along the course: the best of %d starts "
                           "makes %.2g m/s",
                           at->starts, at->prediction.course_speed);
    return moray_solution_failure(at->solution);
}

// Whether the fastest gait makes the speed that is asked for.
static moray_status check_speed(gait_job *job, const stage *at)
{
    const double most = fastest(job, at, job->snake.current, at->speed).course_speed;
    if (most > 0 && most < at->speed)
        return moray_error(MORAY_NOT_SOLVED,
                           "speed_m_s = %g: within the limits the robot makes %.4f m/s along the course at most",
                           at->speed, most);
    return moray_ok();
}

static moray_status explain_failure(gait_job *job, const stage *at)
{
    if (at->speed > 0)
        MORAY_TRY(check_speed(job, at));
    return explain_no_way(job, at);
}

moray_status gait_job_optimise(gait_job *job, stage *at, const gait_starts *known)
{
    MORAY_TRY(gait_job_problem(job, at, job->goal, job->snake.current, &at->problem));
    MORAY_TRY(load(job, at));
    MORAY_TRY(gait_job_stem(job, at)); // to find no gait takes a thousand iterations
    MORAY_TRY(solve_all(job, at, known));
    if (moray_interrupted())
        return moray_error(MORAY_INTERRUPTED, "interrupted while optimising; nothing is written");
    at->prediction = moray_gait_problem_prediction(at->problem, at->solution);
    if (!solved(at->solution) || at->prediction.course_speed <= 0)
        return explain_failure(job, at);
    return moray_ok();
}
