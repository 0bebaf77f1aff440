// SPDX-License-Identifier: MIT
//
// Identifies an underwater snake robot from logs of its swimming: coefficients, current, offsets and delays of sensors,
// with intervals, what the logs leave open, and whether the model is enough.
#include <math.h>

#include "identify/identify.h"

static const char *const joint_sources[] = {
    [MORAY_LOGGED_AUTO] = "auto", [MORAY_LOGGED_GAIT] = "gait", [MORAY_LOGGED_SPLINE] = "splines", NULL};
static const char *const losses[] = {[LOSS_SQUARES] = "squares", [LOSS_HUBER] = "huber", NULL};

static const char *const criteria[] = {[D_OPTIMAL] = "d", [E_OPTIMAL] = "e", NULL};

static const moray_option options[] = {
    MORAY_ROW(
        TEXT, identify, logs, "logs", "logs", .flag = "logs", .argument = "FILE,...",
        .help = "comma-separated values, one file a run: t, phi_1 ... phi_(N-1), and any of p_x and p_y, heading, u_1 "
                "...; units in brackets behind a name, else s, rad, m, N m; other columns are ignored"),
    MORAY_ROW(TEXT, identify, validate, "logs", "validate", .flag = "validate", .argument = "FILE,...",
              .help = "runs that nothing is estimated from, to be predicted"),
    MORAY_ROW(TEXT, identify, columns, "logs", "columns", .flag = "columns", .argument = "KEY=NAME,...",
              .help = "columns of other names, # for a joint's number: t=Time,phi=servo#,p_x=cam x"),
    MORAY_ROW(TEXT, identify, units, "logs", "units", .flag = "units", .argument = "KEY=UNIT,...",
              .help =
                  "units of t (s, ms, us), phi, phi_ref, heading (rad, deg), p_x, p_y (m, cm, mm), u (N m, mN m, A)"),
    MORAY_ROW(BOOL, identify, reference, "logs", "reference", .flag = "reference",
              .help = "joints from what was commanded, phi_ref_1 ..., not from phi_1 ..."),
    MORAY_ROW(REAL, identify, torque_constant, "logs", "torque_constant_N_m_A", .max = 1e6, .open = true,
              .unit = "N m/A", .help = "of motors whose u is logged in A"),
    MORAY_ROW(
        CHOICE, identify, joints, "logs", "joints", .flag = "joints", .choices = joint_sources,
        .help = "as the models are given them: a gait (25) fitted to the log, splines through it, or the gait where it "
                "is as near; the control-oriented model takes a gait"),
    MORAY_ROW(BOOL, identify, rest, "logs", "rest", .flag = "rest", .help = "every log begins at rest over ground"),
    MORAY_ROW(
        REAL, identify, position, "logs", "sigma_position_m", .max = INFINITY, .open = true, .unit = "m",
        .help = "standard deviation of either coordinate; unless given as the log scatters about a spline through it"),
    MORAY_ROW(REAL, identify, heading, "logs", "sigma_heading_deg", .max = 180, .open = true, .unit = "deg",
              .help = "likewise"),
    MORAY_ROW(REAL, identify, torque, "logs", "sigma_torque_N_m", .max = INFINITY, .open = true, .unit = "N m",
              .help = "likewise"),
    MORAY_ROW(
        TEXT, identify, estimate, "problem", "estimate", .flag = "estimate", .argument = "NAME,...",
        .help =
            "what is not known, of c_t, c_n, mu_n, lambda_1, lambda_2, lambda_3, m, J, rot_damping, rot_gain, "
            "current_x, current_y, heading_bias, camera_rotation, camera_x, camera_y, position_delay, heading_delay, "
            "joint_delay, or lambda, current, camera, delays for several; unless given c_t, c_n and current, with "
            "mu_n, or rot_damping and rot_gain of the control-oriented model"),
    MORAY_ROW(TEXT, identify, bounds, "problem", "bounds", .flag = "bounds", .argument = "NAME=LOW:HIGH,...",
              .help = "of what is estimated; a coefficient within 5 times of where it starts unless given"),
    MORAY_ROW(CHOICE, identify, loss, "solver", "loss", .flag = "loss", .choices = losses,
              .help = "of large residuals: squares, or as Huber has them, so that outliers count little"),
    MORAY_ROW(REAL, identify, huber, "solver", "huber", .max = 100, .open = true,
              .help = "standard deviations beyond which a residual is large"),
    MORAY_ROW(REAL, identify, step, "solver", "step_s", .max = 10, .unit = "s",
              .help = "of the integration at most; 0: a 120th of a period, or 0.02"),
    MORAY_ROW(INT, identify, starts, "solver", "starts", .flag = "starts", .argument = "N", .min = 1,
              .max = MOST_STARTS,
              .help = "of the search, the first from the robot of the options, the others drawn within the bounds"),
    MORAY_ROW(
        BOOL, identify, design, "design", "design", .flag = "design",
        .help = "tell which experiment to swim next: the gait within the limits below whose log, read as the first log "
                "was, would tell most about what is least known"),
    MORAY_ROW(CHOICE, identify, criterion, "design", "criterion", .flag = "criterion", .choices = criteria,
              .help = "the least volume of the intervals (D-optimal), or the least of the longest axis (E-optimal)"),
    MORAY_ROW(RANGE, identify, alpha, "design", "alpha_deg", .min = 1, .max = 90, .unit = "deg",
              .help = "joint amplitude of the experiment, first-principles model"),
    MORAY_ROW(RANGE, identify, omega, "design", "omega_deg_s", .min = 1, .max = 720, .unit = "deg/s",
              .help = "its frequency"),
    MORAY_ROW(RANGE, identify, delta, "design", "delta_deg", .min = 1, .max = 180, .unit = "deg",
              .help = "its phase shift"),
    MORAY_ROW(RANGE, identify, phi_0, "design", "phi0_deg", .min = -60, .max = 60, .unit = "deg",
              .help = "its joint offset"),
    MORAY_ROW(LIMIT, identify, rate, "design", "joint_rate_deg_s", .max = INFINITY, .unit = "deg/s",
              .help = "most of alpha omega; none: no limit"),
    MORAY_ROW(REAL, identify, duration, "design", "duration_s", .min = 2, .max = 3600, .unit = "s",
              .help = "its length"),
    MORAY_ROW(INT, identify, evaluations, "design", "evaluations", .min = 15, .max = 10000,
              .help = "gaits that are tried"),
    MORAY_ROW(INT, identify, axes, "design", "scenario_axes", .min = 1, .max = (MORAY_SCENARIOS - 1) / 2,
              .help =
                  "principal axes of what is not known, the longest first, whose two ends go to scenarios.csv, which "
                  "max_speed --over takes"),
    MORAY_JOBS_OPTION(identify, jobs, "processes"),
};

static const char *const without[] = {"scheme", "intervals", "tol", "course", NULL};
static const moray_option_group groups[] = {{&moray_snake_option_table, offsetof(identify, snake)}};
static const moray_program program = {
    .name = "identify",
    .summary =
        "Identifies an underwater snake robot from logs of its swimming: coefficients, current, offsets and delays of "
        "its sensors, with intervals, what the logs leave open, and whether the model is enough.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .groups = groups,
    .n_groups = 1,
    .without = without,
};

int main(int argc, char **argv)
{
    static identify run; // large
    int exit_code;
    run = (identify){.common = moray_common_default(),
                     .snake = moray_snake_options_default(),
                     .torque_constant = NAN,
                     .position = NAN,
                     .heading = NAN,
                     .torque = NAN,
                     .huber = 2,
                     .starts = 4,
                     .axes = 2,
                     .evaluations = 60,
                     .alpha = {5 * DEG, 30 * DEG},
                     .omega = {30 * DEG, 150 * DEG},
                     .delta = {20 * DEG, 90 * DEG},
                     .phi_0 = {-10 * DEG, 10 * DEG},
                     .rate = INFINITY,
                     .duration = 20};
    run.snake.model = MORAY_FIRST_PRINCIPLES;
    if (!moray_app_start(&program, argc, argv, &run, &exit_code))
        return exit_code;
    run.ticker = moray_ticker_start(stderr, run.common.quiet);
    moray_status status = identify_run(&run);
    moray_ticker_end(&run.ticker);
    if (!moray_failed(status))
        status = identify_report(&run);
    const moray_status certified = moray_failed(status) || identify_certified(&run)
                                       ? moray_ok()
                                       : moray_error(MORAY_NOT_SOLVED, "residuals fail: %.250s", run.fit.verdict);
    identify_release(&run);
    exit_code = moray_app_end(&program, &run, status);
    return exit_code == MORAY_EXIT_SOLVED ? moray_app_certified(&program, certified) : exit_code;
}
