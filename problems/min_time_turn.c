// SPDX-License-Identifier: MIT
//
// The fastest change of heading, or from pose to pose, in a current: found by optimisation at the limits of the joint
// offset and its rate, tried on both models, against bang-bang steering tuned for the same turn.
#include <string.h>

#include "steering/turn/job.h"

static const moray_option options[] = {
    {.section = "problem",
     .key = "angle_deg",
     .flag = "angle",
     .type = MORAY_OPTION_REAL,
     MORAY_AT(turn_job, angle),
     .min = -720,
     .max = 720,
     .unit = "deg",
     .help = "by which the heading is to change, from 0; positive to the left"},
    {.section = "problem",
     .key = "end_m",
     .type = MORAY_OPTION_PAIR,
     MORAY_AT(turn_job, end),
     .unit = "m",
     .help = "where the turn is to end over ground, from 0,0; by default anywhere"},
    STEER_OPTIONS(turn_job, input),
    STEER_REAL(
        turn_job, weight_steering, "problem", "weight_steering", 1e-9, 1e6, NULL,
        "of the integral over s of the square of phi_0'' in units of its limit per s^2, against 1 for the time in "
        "s"),
    STEER_REAL(turn_job, band, "problem", "band_deg", 1e-3, 90, "deg",
               "around the heading wanted, within which the turn counts as done"),
    STEER_INT(turn_job, intervals_per_period, "solver", "intervals_per_period", 1, 100, "of the mesh, an undulation"),
    STEER_INT(turn_job, refinements, "solver", "refinements", 0, 20,
              "finer meshes tried where the first is too coarse"),
    STEER_INT(turn_job, evaluations, "baseline", "evaluations", 1, 10000,
              "simulations spent on tuning, for every number that is tuned"),
};

static const moray_program program = {
    .name = "min_time_turn",
    .summary =
        "Optimises the joint offset of an underwater snake robot for the fastest change of heading, or from pose "
        "to pose, and proves it on the first-principles model against tuned bang-bang steering.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
};

// The paper's gait.
static turn_job defaults(void)
{
    turn_job job = {.common = moray_common_defaults(),
                    .angle = 90 * DEG,
                    .end = {NAN, NAN},
                    .input = steer_input_default(),
                    .weight_steering = 0.001,
                    .band = 2 * DEG,
                    .intervals_per_period = 6,
                    .refinements = 4,
                    .evaluations = 30};
    job.common.model = MORAY_FIRST_PRINCIPLES;
    job.common.current[0] = job.common.current[1] = 0.1;
    strcpy(job.common.scheme, "radau5");
    job.common.intervals = 0; // by the period
    job.input.theta_max[0] = job.input.theta_max[1] = 20 * DEG;
    job.input.omega[0] = job.input.omega[1] = 120 * DEG;
    job.input.delta[0] = job.input.delta[1] = 40 * DEG;
    return job;
}

static moray_status work(turn_job *job)
{
    moray_family family;
    int stages;
    MORAY_TRY(moray_scheme_parse(job->common.scheme, &family, &stages));
    job->to_position = !isnan(job->end[0]);
    if (job->angle == 0 && !job->to_position)
        return moray_error(MORAY_INPUT, "angle_deg = 0: must not be, unless there is an end_m");
    MORAY_TRY(turn_make_plans(job));
    return turn_run_trials(job);
}

static bool certified(const turn_job *job)
{
    return job->certificate[MORAY_CONTROL_ORIENTED].pass && job->certificate[job->common.model].pass;
}

static void release(turn_job *job)
{
    moray_turn_plan_free(&job->averaged);
    for (int model = 0; model < 2; model++)
        moray_turn_plan_free(&job->plan[model]);
}

int main(int argc, char **argv)
{
    turn_job job = defaults();
    int exit_code;
    if (!moray_app_start(&program, argc, argv, &job, &exit_code))
        return exit_code;
    job.ticker = moray_ticker_start(stderr, job.common.quiet);
    moray_interrupt_begin();
    moray_status status = work(&job);
    moray_interrupt_end();
    moray_ticker_end(&job.ticker);
    if (!moray_failed(status))
        status = turn_report(&job);
    exit_code = moray_app_end(&program, &job, status);
    if (exit_code == MORAY_EXIT_SOLVED && !certified(&job))
        exit_code = MORAY_EXIT_CERTIFICATE;
    release(&job);
    return exit_code;
}
