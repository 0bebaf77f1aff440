// SPDX-License-Identifier: MIT
//
// Gait and joint offset phi_0(t) that take the robot along a path of legs and arcs in a current: found by optimisation,
// tried on both models, blindly, with feedback and in receding horizon, against line-of-sight guidance tuned on the
// same path.
#include "steering/options.h"
#include "steering/path/path.h"

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
    STEER_GAIT_OPTIONS(path_job),
    STEER_WEIGHT(
        path_job, weight_time, "weight_time", 0,
        "of the time in s, against 1 for the integral over s of the squared cross-track error in units of 10 cm"),
    STEER_WEIGHT(path_job, steer.weight_steering, "weight_steering", 1e-9,
                 "of the integral over s of the square of phi_0'' in units of its limit per s^2, likewise"),
    STEER_LIMIT(path_job, tube, "tube_m", "m", "largest cross-track error allowed of the plan"),
    STEER_REAL(path_job, reach, "problem", "reach_m", 1e-3, 1e4, "m",
               "way made within which a start off the path is to come to it"),
    STEER_MESH_OPTIONS(path_job),
    {.section = "solver",
     .key = "find_gait",
     .type = MORAY_OPTION_BOOL,
     MORAY_AT(path_job, find_gait),
     .help = "first-principles plan on the gait fastest straight ahead within the limits; no: on the first gait"},
    STEER_RECEDING_OPTIONS(path_job),
    STEER_TUNING_OPTION(path_job, "simulations spent on tuning, for every number that is tuned"),
};

static moray_status work(steer_job *steer)
{
    path_job *job = (path_job *)steer;
    MORAY_TRY(moray_path_read(&job->path, job->path_text, job->radius));
    MORAY_TRY(path_make_plans(job));
    path_choose_trials(steer);
    return steer_run_trials(steer);
}

static void release(steer_job *steer)
{
    path_job *job = (path_job *)steer;
    moray_path_plan_free(&job->averaged);
    for (int model = 0; model < 2; model++)
        moray_path_plan_free(&job->plan[model]);
    moray_path_free(&job->path);
}

static const steer_program program = {
    .app = {.name = "path_following",
            .summary = "Optimises gait and joint offset of an underwater snake robot to follow a path in a current, "
                       "and proves them on the first-principles model against tuned line-of-sight guidance.",
            .options = options,
            .n_options = sizeof options / sizeof *options},
    .work = work,
    .release = release,
    .laws = path_laws,
    .numbers = path_numbers,
    .n_numbers = PATH_NUMBERS,
    .x_tolerance = 1e-3,
    .f_tolerance = 1e-4,
    .rough_per_second = 20,
    .start = path_start,
    .judge = path_judge,
    .scores = path_scores,
    .n_scores = PATH_SCORES,
    .score_title = "Cross-track error, cm (settled: without the first way to the path); time to the end, s; cost as in "
                   "the objective; power, W",
    .columns = path_columns,
    .tables = path_tables,
    .headline = path_headline,
    .conclude = path_conclude,
    .explain = path_explain,
    .swum = path_swum,
    .tells_name = true,
    .json_head = path_json_head,
    .json_plan = path_json_plan,
    .json_tail = path_json_tail,
    .over_time = {.name = "across",
                  .title = "Cross-track error, first-principles model",
                  .y_label = "to the left of the path [cm]"},
    .values = path_values,
    .path = path_points,
};

int main(int argc, char **argv)
{
    path_job job = {.steer = steer_defaults(),
                    .path_text = "0,0 8,0 8,8 16,8",
                    .radius = 3,
                    .start = {0, 0.5},
                    .heading = NAN,
                    .weight_time = 1,
                    .tube = INFINITY,
                    .reach = 3,
                    .find_gait = true};
    job.steer.weight_steering = 0.3;
    job.steer.evaluations = 10;
    job.steer.common.current[0] = -0.05;
    job.steer.common.current[1] = 0.1;
    return steer_main(&program, argc, argv, &job.steer);
}
