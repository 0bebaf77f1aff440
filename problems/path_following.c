// SPDX-License-Identifier: MIT
//
// Gait and joint offset phi_0(t) that take the robot along a path of legs and arcs in a current: found by optimisation,
// tried on both models, blindly, with feedback and in receding horizon, against line-of-sight guidance tuned on the
// same path.
#include "steering/options.h"
#include "steering/path/path.h"

static const moray_option options[] = {
    MORAY_ROW(TEXT, path_job, path_text, "problem", "path", .flag = "path", .argument = "TEXT",
              .help = "waypoints X,Y X,Y ... in m, or a CSV file with the columns x_m,y_m"),
    STEER_NUMBER(REAL, path_job, radius, "problem", "radius_m", 1e-3, 1e4, "m", "of the arcs that join the legs"),
    MORAY_ROW(PAIR, path_job, start, "problem", "start_m", .unit = "m",
              .help = "position at the start, near the first leg"),
    STEER_NUMBER(REAL, path_job, heading, "problem", "start_heading_deg", -360, 360, "deg",
                 "mean heading there; by default the course of the first leg"),
    STEER_GAIT_OPTIONS(path_job),
    STEER_WEIGHT(
        path_job, weight_time, "weight_time", 0,
        "of the time in s, against 1 for the integral over s of the squared cross-track error in units of 10 cm"),
    STEER_WEIGHT(path_job, steer.weight_steering, "weight_steering", 1e-9,
                 "of the integral over s of the square of phi_0'' in units of its limit per s^2, likewise"),
    STEER_LIMIT(path_job, tube, "tube_m", "m", "largest cross-track error allowed of the plan"),
    STEER_NUMBER(REAL, path_job, reach, "problem", "reach_m", 1e-3, 1e4, "m",
                 "way made within which a start off the path is to come to it"),
    STEER_WATER_OPTION(path_job),
    STEER_MESH_OPTIONS(path_job),
    MORAY_ROW(BOOL, path_job, find_gait, "solver", "find_gait",
              .help =
                  "first-principles plan on the gait fastest straight ahead within the limits; no: on the first gait"),
    STEER_RECEDING_OPTIONS(path_job),
    STEER_TUNING_OPTIONS(path_job),
};

static const moray_idle idle[] = {
    STEER_IDLE_RECEDING, STEER_IDLE_MESH, STEER_IDLE_WATER, STEER_IDLE_GAIT("find_gait"), {NULL, NULL, NULL}};

static const moray_program program = {
    .name = "path_following",
    .summary = "Optimises gait and joint offset of an underwater snake robot to follow a path in a current, "
               "and proves them on the first-principles model against tuned line-of-sight guidance.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .idle = idle};

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
    return steer_main(&program, &path_steering, argc, argv, &job.steer);
}
