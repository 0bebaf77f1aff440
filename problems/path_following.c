// SPDX-License-Identifier: MIT
//
// Gait and joint offset phi_0(t) that take the robot along a path of legs and arcs in a current: found by optimisation,
// tried on both models, blindly, with feedback and in receding horizon, against line-of-sight guidance tuned on the
// same path.
#include <string.h>

#include "steering/path/job.h"

static const moray_option options[] = {
    {.section = "problem",
     .key = "path",
     .flag = "path",
     .argument = "TEXT",
     .type = MORAY_OPTION_TEXT,
     MORAY_AT(path_job, path_text),
     .help = "waypoints X,Y X,Y ... in m, or a CSV file with the columns x_m,y_m"},
    STEER_REAL(path_job, radius, "problem", "radius_m", 1e-3, 1e4, "m", "of the arcs that join the legs"),
    {.section = "problem",
     .key = "start_m",
     .type = MORAY_OPTION_PAIR,
     MORAY_AT(path_job, start),
     .unit = "m",
     .help = "position at the start, near the first leg"},
    STEER_REAL(path_job, heading, "problem", "start_heading_deg", -360, 360, "deg",
               "mean heading there; by default the course of the first leg"),
    STEER_OPTIONS(path_job, input),
    STEER_REAL(
        path_job, weight_time, "problem", "weight_time", 0, 1e6, NULL,
        "of the time in s, against 1 for the integral over s of the squared cross-track error in units of 10 cm"),
    STEER_REAL(path_job, weight_steering, "problem", "weight_steering", 1e-9, 1e6, NULL,
               "of the integral over s of the square of phi_0'' in units of its limit per s^2, likewise"),
    STEER_LIMIT(path_job, tube, "tube_m", "m", "largest cross-track error allowed of the plan"),
    STEER_REAL(path_job, reach, "problem", "reach_m", 1e-3, 1e4, "m",
               "way made within which a start off the path is to come to it"),
    STEER_INT(path_job, intervals_per_period, "solver", "intervals_per_period", 1, 100, "of the mesh, an undulation"),
    STEER_INT(path_job, refinements, "solver", "refinements", 0, 20,
              "finer meshes tried where the first is too coarse"),
    {.section = "solver",
     .key = "find_gait",
     .type = MORAY_OPTION_BOOL,
     MORAY_AT(path_job, find_gait),
     .help = "first-principles plan on the gait fastest straight ahead within the limits; no: on the first gait"},
    {.section = "receding",
     .key = "receding",
     .type = MORAY_OPTION_BOOL,
     MORAY_AT(path_job, receding),
     .help = "try receding horizon too"},
    STEER_REAL(path_job, replan_periods, "receding", "replan_periods", 0.01, 1000, NULL,
               "undulations between two plans"),
    STEER_REAL(path_job, look_ahead_periods, "receding", "look_ahead_periods", 0.1, 1000, NULL,
               "undulations that a plan looks ahead"),
    STEER_INT(path_job, evaluations, "baseline", "evaluations", 1, 10000,
              "simulations spent on tuning, for every number that is tuned"),
};

static const moray_program program = {
    .name = "path_following",
    .summary = "Optimises gait and joint offset of an underwater snake robot to follow a path in a current, and proves "
               "them on the first-principles model against tuned line-of-sight guidance.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
};

static path_job defaults(void)
{
    path_job job = {.common = moray_common_defaults(),
                    .path_text = "0,0 8,0 8,8 16,8",
                    .radius = 3,
                    .start = {0, 0.5},
                    .heading = NAN,
                    .input = steer_input_default(),
                    .weight_time = 1,
                    .weight_steering = 0.3,
                    .tube = INFINITY,
                    .reach = 3,
                    .intervals_per_period = 5,
                    .refinements = 4,
                    .replan_periods = 1,
                    .look_ahead_periods = 6,
                    .receding = true,
                    .find_gait = true,
                    .evaluations = 10};
    job.common.model = MORAY_FIRST_PRINCIPLES;
    memcpy(job.common.current, (const double[]){-0.05, 0.1}, sizeof job.common.current);
    strcpy(job.common.scheme, "radau5");
    job.common.intervals = 0; // by the period
    return job;
}

static moray_status work(path_job *job)
{
    moray_family family;
    int stages;
    MORAY_TRY(moray_scheme_parse(job->common.scheme, &family, &stages));
    MORAY_TRY(moray_path_read(&job->path, job->path_text, job->radius));
    MORAY_TRY(path_make_plans(job));
    return path_run_trials(job);
}

static bool certified(const path_job *job)
{
    return job->certificate[MORAY_CONTROL_ORIENTED].pass && job->certificate[job->common.model].pass;
}

static void release(path_job *job)
{
    moray_path_plan_free(&job->averaged);
    for (int model = 0; model < 2; model++)
        moray_path_plan_free(&job->plan[model]);
    moray_path_free(&job->path);
}

int main(int argc, char **argv)
{
    path_job job = defaults();
    int exit_code;
    if (!moray_app_start(&program, argc, argv, &job, &exit_code))
        return exit_code;
    job.ticker = moray_ticker_start(stderr, job.common.quiet);
    moray_interrupt_begin();
    moray_status status = work(&job);
    moray_interrupt_end();
    moray_ticker_end(&job.ticker);
    if (!moray_failed(status))
        status = path_report(&job);
    exit_code = moray_app_end(&program, &job, status);
    if (exit_code == MORAY_EXIT_SOLVED && !certified(&job))
        exit_code = MORAY_EXIT_CERTIFICATE;
    release(&job);
    return exit_code;
}
