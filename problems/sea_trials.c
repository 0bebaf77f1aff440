// SPDX-License-Identifier: MIT
//
// Steering without foreknowledge: many draws of robot, current and sensor noise, swum under tuned feedback and in
// receding horizon by planners that are told the truth, that believe something else, and that estimate it on the way.
#include <string.h>

#include "steering/options.h"
#include "steering/sea/sea.h"

#define SEA_NUMBER(kind, field, ...) STEER_NUMBER(kind, sea_job, field, __VA_ARGS__)

static const char *const tasks[] = {"heading", "path", NULL};
static const char *const waters[] = {"paper", "consistent", NULL};

static const moray_option options[] = {
    MORAY_ROW(CHOICE, sea_job, task, "problem", "task", .flag = "task", .argument = "NAME", .choices = tasks,
              .help = "what is followed"),
    SEA_NUMBER(REAL, duration, "problem", "duration_s", 10, 1e4, "s", "how long; of a path at most"),
    MORAY_ROW(TEXT, sea_job, path_text, "problem", "path", .help = "waypoints X,Y X,Y ... in m"),
    SEA_NUMBER(REAL, radius, "problem", "radius_m", 1e-3, 1e4, "m", "of the arcs that join the legs"),
    STEER_OFFSET_OPTIONS(sea_job, offset, offset_rate),
    MORAY_ROW(TEXT, sea_job, rung, "plant", "rung", .flag = "rung", .argument = "NAME",
              .help = "hydrodynamics that are true: own, as of the robot, or a rung of the ladder"),
    SEA_NUMBER(REAL, spread, "plant", "spread", 0, 0.9, NULL,
               "the coefficients of drag, added mass and fluid torque are drawn within 1 plus and minus this"),
    SEA_NUMBER(REAL, current_most, "plant", "current_max_m_s", 0, 10, "m/s", "currents are drawn up to this, any way"),
    SEA_NUMBER(REAL, current_turning, "plant", "current_turning_deg_s", 0, 90, "deg/s", "and turn by up to this"),
    SEA_NUMBER(REAL, factor[0], "planner", "planner_c_n", 0.05, 20, NULL,
               "what the planner believes over what the robot has"),
    SEA_NUMBER(REAL, factor[1], "planner", "planner_c_t", 0.05, 20, NULL, "likewise"),
    SEA_NUMBER(REAL, factor[2], "planner", "planner_mu_n", 0.05, 20, NULL, "likewise"),
    SEA_NUMBER(REAL, factor[3], "planner", "planner_lambda", 0.05, 20, NULL, "likewise"),
    MORAY_ROW(CHOICE, sea_job, hydrodynamics, "planner", "planner_hydrodynamics", .choices = waters,
              .help = "as the planner believes them"),
    MORAY_ROW(TEXT, sea_job, believed_current, "planner", "planner_current",
              .help = "as the planner believes it: unknown (none, where it does not estimate) or VX,VY in m/s"),
    SEA_NUMBER(REAL, sensors.heading, "sensors", "heading_deg", 0, 90, "deg", "standard deviation of the compass"),
    SEA_NUMBER(REAL, sensors.joints, "sensors", "joints_deg", 0, 90, "deg", "of every joint angle"),
    SEA_NUMBER(REAL, sensors.position, "sensors", "position_m", 0, 100, "m", "of either coordinate"),
    MORAY_ROW(LIMIT, sea_job, gyro, "sensors", "gyro_deg_s", .max = INFINITY, .unit = "deg/s",
              .help = "of the rate of the mean heading, by a gyro and the joints; none: it is not measured"),
    SEA_NUMBER(REAL, sensors.sampling, "sensors", "sampling_s", 0, 100, "s", "between two readings"),
    SEA_NUMBER(REAL, sensors.delay, "sensors", "delay_s", 0, 20, "s", "of a reading"),
    SEA_NUMBER(REAL, sensors.drop_out, "sensors", "drop_outs", 0, 0.99, NULL, "share of the readings that is lost"),
    SEA_NUMBER(REAL, actuators.dead_time, "actuators", "dead_time_s", 0, 20, "s", "of the joint offset"),
    SEA_NUMBER(REAL, actuators.rate, "actuators", "rate", 0, 10, NULL, "of the offset at most, m/s or rad/s; 0: any"),
    SEA_NUMBER(REAL, actuators.torque, "actuators", "torque_N_m", 0, 1e6, "N m",
               "of every joint at most, first-principles model: joints that would need more do not follow; 0: any"),
    MORAY_ROW(INT, sea_job, seeds, "trials", "seeds", .flag = "seeds", .argument = "N", .min = 1, .max = SEA_MOST_SEEDS,
              .help = "draws that are scored"),
    SEA_NUMBER(INT, first_seed, "trials", "first_seed", 0, 1000000, NULL, "of them; the same seed is the same draw"),
    MORAY_ROW(TEXT, sea_job, results, "trials", "results",
              .help = "file to which every trial is added; a run that was ended goes on from it"),
    MORAY_ROW(TEXT, sea_job, tuned, "trials", "tuned",
              .help = "file of the numbers that the rivals are tuned to: read where it is there, else written"),
    MORAY_JOBS_OPTION(sea_job, jobs, "processes"),
    STEER_TIME_OPTION(sea_job, clock),
    SEA_NUMBER(INT, training, "baseline", "training", 1, 200, NULL, "further draws on which the rivals are tuned"),
    SEA_NUMBER(INT, starts, "baseline", "starts", 1, 1000, NULL, "searches for the numbers of each rival"),
    SEA_NUMBER(INT, evaluations, "baseline", "evaluations", 1, 10000, NULL, "settings tried in each, for every number"),
    SEA_NUMBER(REAL, replan_periods, "receding", "replan_periods", 0.01, 1000, NULL, "undulations between two plans"),
    SEA_NUMBER(REAL, look_ahead_periods, "receding", "look_ahead_periods", 0.1, 1000, NULL,
               "undulations that a plan looks ahead"),
    SEA_NUMBER(REAL, weight_steering, "receding", "weight_steering", 1e-9, 1e6, NULL,
               "of the mean square of phi_0'' in units of its limit per s^2"),
};

static const char *const without[] = {"current", "course",        "scheme",    "intervals",
                                      "tol",     "linear_solver", "ipopt.KEY", NULL};
static const moray_option_group groups[] = {{&moray_snake_option_table, offsetof(sea_job, snake)}};

static bool follows_heading(const void *settings)
{
    return ((const sea_job *)settings)->task == SEA_HEADING;
}

// The rung says all of them.
static bool rung_given(const void *settings)
{
    const char *rung = ((const sea_job *)settings)->rung;
    return strcmp(rung, "own") != 0 && !strpbrk(rung, "+-"); // those of coefficients keep the robot's own
}

static const char beside_rung[] = "beside this rung", for_heading[] = "with task = heading";
static const moray_idle idle[] = {{"path", follows_heading, for_heading},
                                  {"radius_m", follows_heading, for_heading},
                                  {"hydrodynamics", rung_given, beside_rung},
                                  {"rotation", rung_given, beside_rung},
                                  {"drag", rung_given, beside_rung},
                                  {"added_mass", rung_given, beside_rung},
                                  {"frame", rung_given, beside_rung},
                                  {"pieces", rung_given, beside_rung},
                                  {NULL, NULL, NULL}};

static const moray_program program = {
    .name = "sea_trials",
    .summary = "Swims many draws of an underwater snake robot, current and noise under tuned feedback and in receding "
               "horizon, by planners that know the truth, believe something else, or estimate it.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .groups = groups,
    .n_groups = 1,
    .without = without,
    .idle = idle};

static moray_status work(sea_job *job)
{
    MORAY_TRY(sea_prepare(job));
    MORAY_TRY(sea_tune(job));
    MORAY_TRY(sea_run(job));
    return sea_estimate_all(job);
}

int main(int argc, char **argv)
{
    static sea_job job;
    int exit_code;
    job = (sea_job){.common = moray_common_default(),
                    .snake = moray_snake_options_default(),
                    .rung = "own",
                    .duration = 80,
                    .path_text = "0,0 6,0 6,6",
                    .radius = 2,
                    .offset = 0.015,
                    .offset_rate = 0.01,
                    .factor = {1, 1, 1, 1},
                    .believed_current = "unknown",
                    .sensors = {.heading = 0.5 * DEG,
                                .joints = 0.2 * DEG,
                                .position = 0.03,
                                .sampling = 0.2,
                                .delay = 0.1,
                                .drop_out = 0.02},
                    .gyro = INFINITY,
                    .actuators = {.dead_time = 0.1},
                    .clock = {.limit = 3600},
                    .seeds = 20,
                    .first_seed = 1,
                    .current_most = 0.2,
                    .current_turning = 0.3 * DEG,
                    .spread = 0.2,
                    .training = 5,
                    .starts = 6,
                    .evaluations = 10,
                    .replan_periods = 0.5,
                    .look_ahead_periods = 6,
                    .weight_steering = 0.003};
    job.snake.model = MORAY_FIRST_PRINCIPLES;
    if (!moray_app_start(&program, argc, argv, &job, &exit_code))
        return exit_code;
    job.ticker = moray_ticker_start(stderr, job.common.quiet);
    steer_clock_start(&job.clock);
    moray_interrupt_begin();
    moray_status status = work(&job);
    moray_interrupt_end();
    moray_ticker_end(&job.ticker);
    if (!moray_failed(status))
        status = sea_report(&job);
    if (!moray_failed(status) && job.seeds < job.wanted)
        status = moray_error(MORAY_NOT_SOLVED, "%d of %d draws were swum in the time given (--time = %g s)", job.seeds,
                             job.wanted, job.clock.limit);
    sea_release(&job);
    return moray_app_end(&program, &job, status);
}
