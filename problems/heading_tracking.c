// SPDX-License-Identifier: MIT
//
// Gait and joint offset phi_0(t) that make the robot follow a heading in a current: found by optimisation, tried on
// both models, blindly, with feedback and in receding horizon, against heading feedback tuned for the same reference.
#include "steering/heading/heading.h"
#include "steering/options.h"

static const moray_option options[] = {
    MORAY_ROW(TEXT, heading_job, reference_text, "problem", "reference", .flag = "reference", .argument = "TEXT",
              .help = "steps:T=H,... or ramps:T=H,... (s, deg), sine:AMPLITUDE,PERIOD, a CSV file with the columns "
                      "t_s,heading_deg, or fig8: the manoeuvre and gait of Sec. V-C"),
    MORAY_ROW(REAL, heading_job, horizon, "problem", "horizon_s", .flag = "horizon", .min = 1, .max = 1e5, .unit = "s",
              .help = "how long the reference is followed; by default 100, fig8 190"),
    STEER_GAIT_OPTIONS(heading_job),
    STEER_LIMIT(heading_job, max_error, "max_error_deg", "deg", "largest heading error allowed of the plan"),
    STEER_WEIGHT(
        heading_job, weight_power, "weight_power", 0,
        "of the mean power of joints or motors in W, against 1 for the mean squared heading error in units of 10 deg"),
    STEER_WEIGHT(heading_job, steer.weight_steering, "weight_steering", 1e-9,
                 "of the mean square of phi_0'' in units of its limit per s^2, likewise"),
    STEER_MESH_OPTIONS(heading_job),
    STEER_NUMBER(INT, heading_job, gait_evaluations, "solver", "gait_evaluations", 0, 10000, NULL,
                 "gaits tried for the first-principles plan; 0: the paper's"),
    STEER_RECEDING_OPTIONS(heading_job),
    STEER_TUNING_OPTIONS(heading_job),
};

static bool on_fig8(const void *settings)
{
    return heading_is_fig8(settings);
}

static const moray_idle idle[] = {STEER_IDLE_RECEDING,
                                  STEER_IDLE_MESH,
                                  STEER_IDLE_GAIT("gait_evaluations"),
                                  {"gait_evaluations", on_fig8, "on the gait of fig8"},
                                  {"theta_max_deg", on_fig8, "on the gait of fig8"},
                                  {"omega_deg_s", on_fig8, "on the gait of fig8"},
                                  {"delta_deg", on_fig8, "on the gait of fig8"},
                                  {NULL, NULL, NULL}};

static const moray_program program = {
    .name = "heading_tracking",
    .summary = "Optimises gait and joint offset of an underwater snake robot to follow a heading in a current, "
               "and proves them on the first-principles model against tuned feedback.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .idle = idle};

int main(int argc, char **argv)
{
    heading_job job = {.steer = steer_defaults(),
                       .reference_text = "steps:20=30,60=0",
                       .horizon = NAN,
                       .max_error = INFINITY,
                       .gait_evaluations = 12};
    job.steer.weight_steering = 3e-5; // the rivals pay for none
    return steer_main(&program, &heading_steering, argc, argv, &job.steer);
}
