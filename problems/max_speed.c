// SPDX-License-Identifier: MIT
//
// The fastest gait along a course in a current: optimised on the control-oriented model, from there on the
// first-principles model, and proved by simulating both.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "parts/max_speed.h"

static const char *const joint_forms[] = {"on-gait", "closed-loop", NULL};

#define RANGE(name, field, low, high, in, text)                                                                        \
    {                                                                                                                  \
        .section = "problem", .key = name, .type = MORAY_OPTION_RANGE, MORAY_AT(max_speed, field), .min = low,         \
        .max = high, .unit = in, .help = text                                                                          \
    }
#define LIMIT(name, field, in, text)                                                                                   \
    {                                                                                                                  \
        .section = "problem", .key = name, .type = MORAY_OPTION_LIMIT, MORAY_AT(max_speed, field), .min = 0,           \
        .max = INFINITY, .open = true, .unit = in, .help = text                                                        \
    }

static const moray_option options[] = {
    RANGE("theta_max_deg", theta_max, 0, 89, "deg", "link-angle amplitude of (24)"),
    RANGE("omega_deg_s", omega, 1, 3600, "deg/s", "gait frequency"),
    RANGE("delta_deg", delta, 1, 179, "deg", "phase shift between joints"),
    RANGE("phi0_m", offset, -1, 1, "m", "joint offset of the control-oriented model"),
    RANGE("phi0_deg", offset_angle, -90, 90, "deg", "joint offset of the first-principles model"),
    LIMIT("power_W", power, "W",
          "mean joint power; by default what the paper's gait uses in the same model and current"),
    LIMIT("joint_rate", joint_rate, NULL, "rate amplitude of the joints (m/s; deg/s with the complex model)"),
    LIMIT("joint_effort", joint_effort, NULL,
          "peak joint force at the nodes of the mesh, which then has 60 intervals (N; torque in N m with the complex "
          "model)"),
    {.section = "problem",
     .key = "joints",
     .type = MORAY_OPTION_CHOICE,
     MORAY_AT(max_speed, joints),
     .choices = joint_forms,
     .help = "six states with the joints on the gait, or all states with the joint controller (34)"},
    {.section = "solver",
     .key = "random_starts",
     .type = MORAY_OPTION_INT,
     MORAY_AT(max_speed, random_starts),
     .min = 0,
     .max = 10000,
     .help = "random gaits to start from, besides the paper's gait and the control-oriented optimum"},
};

static const moray_program program = {
    .name = "max_speed",
    .summary = "Optimises the gait of an underwater snake robot for speed along a course, and proves it on the "
               "first-principles model.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
};

// A limit on the effort is kept at the nodes: between them it passes the certificate on the finer mesh.
enum { usual_intervals = 12, effort_intervals = 60 };

static max_speed defaults(void)
{
    max_speed run = {.common = moray_common_defaults(),
                     .theta_max = {1 * DEG, 20 * DEG},
                     .omega = {30 * DEG, 360 * DEG},
                     .delta = {15 * DEG, 90 * DEG},
                     .offset = {-0.02, 0.02},
                     .offset_angle = {-10 * DEG, 10 * DEG},
                     .power = NAN,
                     .joint_rate = INFINITY,
                     .joint_effort = INFINITY};
    run.common.model = MORAY_FIRST_PRINCIPLES;
    strcpy(run.common.scheme, "lobatto5");
    run.common.intervals = usual_intervals;
    return run;
}

static double limit(double value)
{
    return isfinite(value) ? value : MORAY_INFINITY;
}

// The joints' own limits and form are those of --model.
static moray_status make_problem(const max_speed *run, const stage *at, const double current[2],
                                 moray_gait_problem **problem)
{
    const bool revolute = at->model == MORAY_FIRST_PRINCIPLES, own = at->model == run->common.model;
    const double *offset = revolute ? run->offset_angle : run->offset;
    const moray_gait_problem_spec spec = {
        .robot = run->common.robot,
        .model = at->model,
        .joints = own ? run->joints : MORAY_JOINTS_ON_GAIT,
        .current = {current[0], current[1]},
        .course = run->common.course,
        .limits = {.theta_max = moray_between(run->theta_max[0], run->theta_max[1]),
                   .omega = moray_between(run->omega[0], run->omega[1]),
                   .delta = moray_between(run->delta[0], run->delta[1]),
                   .offset = moray_between(offset[0], offset[1]),
                   .power = limit(at->power),
                   .joint_rate = own ? limit(run->joint_rate * (revolute ? DEG : 1)) : MORAY_INFINITY,
                   .joint_effort = own ? limit(run->joint_effort) : MORAY_INFINITY}};
    return moray_gait_problem_new(problem, &spec);
}

// ---- Solving -------------------------------------------------------------------------------------------------------

static bool show_iteration(void *observer, const moray_progress *at)
{
    const max_speed *run = observer;
    moray_ticker_show(&run->ticker, "max_speed: iteration %d, %.5f m/s, violation %.1e%s", at->iteration,
                      -at->objective, at->infeasibility, at->restoring ? " (restoring feasibility)" : "");
    return true;
}

// From the steady orbit of the gait on the problem's model, swum straight along the course.
static moray_status solve_from(max_speed *run, const stage *at, const moray_gait_problem *problem,
                               const moray_gait *gait, moray_solution **solution)
{
    const moray_settings settings = {.scheme = run->common.scheme,
                                     .intervals = run->common.intervals,
                                     .tolerance = run->common.tol,
                                     .mesh_tolerance = 1e-6,
                                     .max_iterations = 1000,
                                     .barrier = 1e-4, // the guess is an orbit, feasible but for the limits
                                     .own_scaling = true,
                                     .progress = show_iteration,
                                     .observer = run};
    const moray_swim_setup setup = moray_basin_setup(&run->basin, at->model);
    moray_steady steady;
    moray_swim_track orbit = {0};
    moray_status status = moray_swim_hold_course(&setup, gait, run->common.course, &steady);
    const double heading = moray_failed(status) ? run->common.course : steady.start_heading;
    status = moray_swim_steady(&setup, gait, heading, &steady, &orbit, 101);
    if (!moray_failed(status))
        status = moray_gait_problem_solve(problem, &settings, gait, &orbit, solution);
    moray_swim_track_free(&orbit);
    return status;
}

static double uniform(double low, double high)
{
    return low + (high - low) * drand48();
}

static moray_gait random_gait(const max_speed *run, moray_model model)
{
    const double theta_max = uniform(run->theta_max[0], run->theta_max[1]);
    moray_gait gait = {.omega = uniform(run->omega[0], run->omega[1]), .delta = uniform(run->delta[0], run->delta[1])};
    gait.amplitude = moray_amplitude_from_theta_max(&run->common.robot, model, theta_max, gait.delta);
    return gait;
}

static bool solved(const moray_solution *solution)
{
    return moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED;
}

// Whether `one` is a better end than `other`: solved, then by objective.
static bool better(const moray_solution *one, const moray_solution *other)
{
    if (!other || solved(one) != solved(other))
        return !other || solved(one);
    return moray_solution_objective(one) < moray_solution_objective(other);
}

static void keep_best(stage *at, moray_solution *solution)
{
    const double same = 1e-6;
    const bool level = at->solution && solved(solution) && solved(at->solution) &&
                       fabs(moray_solution_objective(solution) - moray_solution_objective(at->solution)) < same;
    const bool takes_over = better(solution, at->solution);
    at->agreeing = level ? at->agreeing + 1 : takes_over ? 1 : at->agreeing;
    moray_solution_free(takes_over ? at->solution : solution);
    if (takes_over)
        at->solution = solution;
}

// Known gaits to start from.
struct starts {
    moray_gait gait[2];
    int n;
};

// From the known gaits, then, on the model asked for, from random ones.
static moray_status solve_all(max_speed *run, stage *at, const struct starts *known)
{
    const int random = at->model == run->common.model ? run->random_starts : 0;
    srand48(1);
    at->starts = known->n + random;
    for (int k = 0; k < at->starts; k++) {
        const moray_gait gait = k < known->n ? known->gait[k] : random_gait(run, at->model);
        moray_solution *solution = NULL;
        moray_status status = solve_from(run, at, at->problem, &gait, &solution);
        if (!moray_failed(status))
            keep_best(at, solution);
        else if (k == 0)
            return status;
    }
    return moray_ok();
}

// What the best gait swims in still water within the same limits; NaN when that cannot be found either.
static double still_water_speed(max_speed *run, const stage *at)
{
    const double still[2] = {0, 0};
    moray_gait_problem *problem = NULL;
    moray_solution *solution = NULL;
    double speed = NAN;
    if (!moray_failed(make_problem(run, at, still, &problem)) &&
        !moray_failed(solve_from(run, at, problem, &run->paper.gait[at->model], &solution)) && solved(solution))
        speed = moray_gait_problem_promise(problem, solution).speed;
    moray_solution_free(solution);
    moray_gait_problem_free(problem);
    return speed;
}

// Why there is no gait that makes way.
static moray_status explain_failure(max_speed *run, const stage *at)
{
    const double *V = run->common.current, c = cos(run->common.course), s = sin(run->common.course);
    const double along = V[0] * c + V[1] * s, across = fabs(V[1] * c - V[0] * s);
    const double U = V[0] != 0 || V[1] != 0 ? still_water_speed(run, at) : NAN;
    if (across >= U)
        return moray_error(MORAY_NOT_SOLVED,
                           "current = %g,%g: the robot cannot stem it: %.4f m/s of it run across the course, and "
                           "within the limits the robot swims %.4f m/s at most",
                           V[0], V[1], across, U);
    if (sqrt(U * U - across * across) + along <= 0)
        return moray_error(MORAY_NOT_SOLVED,
                           "current = %g,%g: the robot cannot stem it: %.4f m/s of it run against the course, and "
                           "within the limits the robot makes %.4f m/s along it at most",
                           V[0], V[1], -along, sqrt(U * U - across * across));
    return moray_error(MORAY_NOT_SOLVED, "%.280s", moray_solution_diagnosis(at->solution));
}

static moray_status optimise(max_speed *run, stage *at, const struct starts *known)
{
    MORAY_TRY(make_problem(run, at, run->common.current, &at->problem));
    MORAY_TRY(solve_all(run, at, known));
    const moray_nlp_info *info = moray_solution_info(at->solution);
    at->promise = moray_gait_problem_promise(at->problem, at->solution);
    if (info->outcome == MORAY_NLP_INTERRUPTED)
        return moray_error(MORAY_INTERRUPTED, "interrupted after %d iterations", info->iterations);
    if (!solved(at->solution) || at->promise.course_speed <= 0)
        return explain_failure(run, at);
    const moray_integrator integrator = moray_sim_integrator(&run->basin.settings.sim);
    return moray_certify(at->solution, &integrator, &at->certificate);
}

static moray_status optimise_and_prove(max_speed *run, moray_model model, const struct starts *known)
{
    stage *at = &run->stage[model];
    at->model = model;
    at->power = isnan(run->power) ? run->paper.steady[model].power : run->power;
    MORAY_TRY(optimise(run, at, known));
    moray_ticker_show(&run->ticker, "max_speed: the optimised gait on both models");
    MORAY_TRY(moray_gait_trial_run(&run->basin, &at->promise.gait, model, &at->trial));
    at->gain = moray_gait_gain_over(&run->basin, &at->trial, &run->paper);
    return moray_ok();
}

static moray_status work(max_speed *run)
{
    const moray_gait paper = moray_gait_paper(&run->common.robot);
    moray_family family;
    int stages;
    if (isfinite(run->joint_effort) && run->common.intervals == usual_intervals)
        run->common.intervals = effort_intervals;
    MORAY_TRY(moray_scheme_parse(run->common.scheme, &family, &stages));
    MORAY_TRY(moray_basin_new(&run->basin, &run->common.robot, run->common.current, run->common.course));
    moray_ticker_show(&run->ticker, "max_speed: the paper's gait on both models");
    MORAY_TRY(moray_gait_trial_run(&run->basin, &paper, MORAY_CONTROL_ORIENTED, &run->paper));
    const struct starts one = {{run->paper.gait[MORAY_CONTROL_ORIENTED]}, 1};
    MORAY_TRY(optimise_and_prove(run, MORAY_CONTROL_ORIENTED, &one));
    if (run->common.model == MORAY_CONTROL_ORIENTED)
        return moray_ok();
    const struct starts two = {{run->stage[MORAY_CONTROL_ORIENTED].trial.gait[MORAY_FIRST_PRINCIPLES],
                                run->paper.gait[MORAY_FIRST_PRINCIPLES]},
                               2};
    return optimise_and_prove(run, MORAY_FIRST_PRINCIPLES, &two);
}

static bool certified(const max_speed *run)
{
    bool pass = true;
    for (int model = 0; model <= (int)run->common.model; model++)
        pass = pass && run->stage[model].certificate.pass;
    return pass;
}

static void release(max_speed *run)
{
    for (int model = 0; model < 2; model++) {
        moray_solution_free(run->stage[model].solution);
        moray_gait_problem_free(run->stage[model].problem);
    }
    moray_basin_free(&run->basin);
}

int main(int argc, char **argv)
{
    max_speed run = defaults();
    int exit_code;
    if (!moray_app_start(&program, argc, argv, &run, &exit_code))
        return exit_code;
    run.ticker = moray_ticker_start(stderr, run.common.quiet);
    moray_status status = work(&run);
    moray_ticker_end(&run.ticker);
    if (!moray_failed(status))
        status = max_speed_report(&run);
    exit_code = moray_app_end(&program, &run, status);
    if (exit_code == MORAY_EXIT_SOLVED && !certified(&run))
        exit_code = MORAY_EXIT_CERTIFICATE;
    release(&run);
    return exit_code;
}
