// SPDX-License-Identifier: MIT
//
// Swims any gait or schedule of gaits, on either model, in any current.
#include <math.h>

#include "simulate/simulate.h"

const char *const simulate_integrators[] = {
    [SIMULATE_EXPLICIT] = "explicit", [SIMULATE_TR_BDF2] = "tr-bdf2", [SIMULATE_PAPER] = "paper", NULL};
_Static_assert(sizeof(simulate_integrator) == sizeof(int), "choices are stored as int");

#define LOG(field, name, high, in, text)                                                                               \
    MORAY_ROW(REAL, simulate, field, "log", name, .max = high, .unit = in, .help = text)

static const moray_option options[] = {
    MORAY_ROW(
        TEXT, simulate, schedule_file, "simulation", "schedule", .flag = "schedule", .argument = "FILE",
        .help =
            "comma-separated values: a line of names, t_s and any keys of [gait], then a line for each gait, which "
            "keeps from the one before what its line leaves out; omega t of (25) counts from t = 0 in all of them, so "
            "that a change of omega jumps in phase"),
    MORAY_ROW(TEXT, simulate, water_file, "problem", "water", .flag = "water", .argument = "FILE",
              .help = "CSV file of a current over place and time in place of the uniform one: a grid of x_m, y_m, "
                      "v_x_m_s, v_y_m_s and, where it changes, t_s"),
    MORAY_ROW(REAL, simulate, duration, "simulation", "duration_s", .flag = "duration", .max = 1e6, .open = true,
              .unit = "s", .help = "length of the simulation; 60 after the last change of gait unless given"),
    MORAY_ROW(REAL, simulate, output_step, "simulation", "output_step_s", .flag = "output-step", .max = 1e6,
              .open = true, .unit = "s", .help = "time between two lines of trajectory.csv"),
    MORAY_ROW(REAL, simulate, heading, "simulation", "start_heading_deg", .min = -360, .max = 360, .unit = "deg",
              .help = "heading of the straight body at rest over ground, from which it starts"),
    MORAY_ROW(PAIR, simulate, position, "simulation", "start_position_m", .unit = "m", .help = "position at the start"),
    MORAY_ROW(
        INT, simulate, periods, "simulation", "periods", .min = 1, .max = 100000,
        .help =
            "whole periods of the last gait at the end of the simulation that means and peaks are taken over; fewer "
            "where it has fewer"),
    MORAY_ROW(CHOICE, simulate, integrator, "simulation", "integrator", .flag = "integrator",
              .choices = simulate_integrators,
              .help = "Runge-Kutta of order 8 to 1e-10, TR-BDF2 to 1e-9, or as in the paper TR-BDF2 to 1e-4"),
    MORAY_ROW(REAL, simulate, rtol, "simulation", "rtol", .min = 1e-14, .max = 0.1,
              .help = "relative tolerance, instead of the integrator's own"),
    MORAY_ROW(REAL, simulate, atol, "simulation", "atol", .max = INFINITY, .open = true,
              .help = "absolute tolerance, instead of the integrator's own"),
    MORAY_GAIT_OPTIONS(simulate, gait),
    MORAY_ROW(TEXT, simulate, log_file, "log", "log", .flag = "log", .argument = "FILE",
              .help =
                  "leave a log of the first gait there, as instruments would have taken it, for the program identify"),
    LOG(log_from, "log_from_s", 1e6, "s", "when it begins; 5 unless given"),
    LOG(log_step, "log_step_s", 1e3, "s", "between two rows"),
    LOG(noise.position, "noise_position_m", 10, "m", "standard deviation of either coordinate"),
    LOG(noise.heading, "noise_heading_deg", 90, "deg", "of the heading"),
    LOG(noise.joints, "noise_joints_deg", 90, "deg", "of every joint angle"),
    LOG(noise.torque, "noise_torque_N_m", 1e3, "N m", "of every joint torque, first-principles model"),
    LOG(noise.position_delay, "position_delay_s", 10, "s", "by which positions are late"),
    LOG(noise.heading_delay, "heading_delay_s", 10, "s", "by which headings are late"),
    LOG(noise.outliers, "outliers", 1, NULL, "share of positions and headings that are off by 20 standard deviations"),
    LOG(noise.missing, "missing", 1, NULL, "share of positions and headings that are left out"),
    MORAY_ROW(REAL, simulate, noise.heading_bias, "log", "heading_bias_deg", .min = -180, .max = 180, .unit = "deg",
              .help = "of the compass"),
    MORAY_ROW(REAL, simulate, noise.camera_rotation, "log", "camera_rotation_deg", .min = -180, .max = 180,
              .unit = "deg", .help = "by which the camera sees the world turned"),
    MORAY_ROW(PAIR, simulate, noise.camera, "log", "camera_m", .unit = "m",
              .help = "origin of the camera's coordinates"),
    MORAY_ROW(INT, simulate, log_seed, "log", "log_seed", .max = 1e9,
              .help = "of the noise: the same seed, the same log"),
};

static const char *const without[] = {"scheme", "intervals", "tol", "linear_solver", "ipopt.KEY", NULL};
static const moray_option_group groups[] = {{&moray_snake_option_table, offsetof(simulate, snake)}};
static const moray_program program = {
    .name = "simulate",
    .summary = "Swims an underwater snake robot: any gait or schedule of gaits, on either model, in any current.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .groups = groups,
    .n_groups = 1,
    .without = without,
};

int main(int argc, char **argv)
{
    simulate run = {.common = moray_common_default(),
                    .snake = moray_snake_options_default(),
                    .gait = moray_gait_input_default(),
                    .duration = NAN,
                    .output_step = 0.05,
                    .periods = 5,
                    .log_from = 5,
                    .log_step = 0.05,
                    .log_seed = 1,
                    .rtol = NAN,
                    .atol = NAN};
    simulate_results results = {0};
    int exit_code;
    if (!moray_app_start(&program, argc, argv, &run, &exit_code))
        return exit_code;
    moray_status status = simulate_run(&run, &results);
    if (!moray_failed(status) && run.log_file[0])
        status = simulate_log(&run, &results);
    if (!moray_failed(status))
        status = simulate_report(&results);
    simulate_release(&results);
    return moray_app_end(&program, &run, status);
}
