// SPDX-License-Identifier: MIT
//
// The fastest change of heading, or from pose to pose, in a current: found by optimisation at the limits of the joint
// offset and its rate, tried on both models, against bang-bang steering tuned for the same turn.
#include "steering/options.h"
#include "steering/turn/turn.h"

static const moray_option options[] = {
    MORAY_ROW(REAL, turn_job, angle, "problem", "angle_deg", .flag = "angle", .min = -720, .max = 720, .unit = "deg",
              .help = "by which the heading is to change, from 0; positive to the left"),
    MORAY_ROW(PAIR, turn_job, end, "problem", "end_m", .unit = "m",
              .help = "where the turn is to end over ground, from 0,0; by default anywhere"),
    STEER_GAIT_OPTIONS(turn_job),
    STEER_WEIGHT(
        turn_job, steer.weight_steering, "weight_steering", 1e-9,
        "of the integral over s of the square of phi_0'' in units of its limit per s^2, against 1 for the time in s"),
    STEER_NUMBER(REAL, turn_job, band, "problem", "band_deg", 1e-3, 90, "deg",
                 "around the heading wanted, within which the turn counts as done"),
    STEER_WATER_OPTION(turn_job),
    STEER_MESH_OPTIONS(turn_job),
    STEER_TUNING_OPTIONS(turn_job),
};

static const moray_idle idle[] = {STEER_IDLE_MESH, STEER_IDLE_WATER, {NULL, NULL, NULL}};

static const moray_program program = {
    .name = "min_time_turn",
    .summary = "Optimises the joint offset of an underwater snake robot for the fastest change of heading, or "
               "from pose to pose, and proves it on the first-principles model against tuned bang-bang "
               "steering.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .idle = idle};

// The paper's gait.
int main(int argc, char **argv)
{
    turn_job job = {.steer = steer_defaults(), .angle = 90 * DEG, .end = {NAN, NAN}, .band = 2 * DEG};
    const double theta_max = 20 * DEG, omega = 120 * DEG, delta = 40 * DEG;
    job.steer.weight_steering = 0.001;
    job.steer.intervals_per_period = 6;
    job.steer.input.theta_max[0] = job.steer.input.theta_max[1] = theta_max;
    job.steer.input.omega[0] = job.steer.input.omega[1] = omega;
    job.steer.input.delta[0] = job.steer.input.delta[1] = delta;
    return steer_main(&program, &turn_steering, argc, argv, &job.steer);
}
