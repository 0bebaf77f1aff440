// SPDX-License-Identifier: MIT
//
// Gait and joint offset phi_0(t) that make the robot follow a heading in a current: found by optimisation, tried on
// both models, blindly, with feedback and in receding horizon, against heading feedback tuned for the same reference.
#include <string.h>

#include "steering/heading/job.h"

static const moray_option options[] = {
    {.section = "problem",
     .key = "reference",
     .flag = "reference",
     .argument = "TEXT",
     .type = MORAY_OPTION_TEXT,
     MORAY_AT(heading_job, reference_text),
     .help = "steps:T=H,... or ramps:T=H,... (s, deg), sine:AMPLITUDE,PERIOD, a CSV file with the columns "
             "t_s,heading_deg, or fig8: the manoeuvre and gait of Sec. V-C"},
    {.section = "problem",
     .key = "horizon_s",
     .flag = "horizon",
     .type = MORAY_OPTION_REAL,
     MORAY_AT(heading_job, horizon),
     .min = 1,
     .max = 1e5,
     .unit = "s",
     .help = "how long the reference is followed; by default 100, fig8 190"},
    STEER_OPTIONS(heading_job, input),
    STEER_LIMIT(heading_job, max_error, "max_error_deg", "deg", "largest heading error allowed of the plan"),
    STEER_REAL(heading_job, weight_power, "problem", "weight_power", 0, 1e6, NULL,
               "of the mean joint power in W, against 1 for the mean squared heading error in units of 10 deg"),
    STEER_REAL(heading_job, weight_steering, "problem", "weight_steering", 1e-9, 1e6, NULL,
               "of the mean square of phi_0'' in units of its limit per s^2, likewise"),
    STEER_INT(heading_job, intervals_per_period, "solver", "intervals_per_period", 1, 100,
              "of the mesh, an undulation"),
    STEER_INT(heading_job, refinements, "solver", "refinements", 0, 20,
              "finer meshes tried where the first is too coarse"),
    STEER_INT(heading_job, gait_evaluations, "solver", "gait_evaluations", 0, 10000,
              "gaits tried for the first-principles plan; 0: the paper's"),
    {.section = "receding",
     .key = "receding",
     .type = MORAY_OPTION_BOOL,
     MORAY_AT(heading_job, receding),
     .help = "try receding horizon too"},
    STEER_REAL(heading_job, replan_periods, "receding", "replan_periods", 0.01, 1000, NULL,
               "undulations between two plans"),
    STEER_REAL(heading_job, look_ahead_periods, "receding", "look_ahead_periods", 0.1, 1000, NULL,
               "undulations that a plan looks ahead"),
    STEER_INT(heading_job, evaluations, "baseline", "evaluations", 1, 10000,
              "simulations spent on tuning each gain, twice as many for a gain and a lead"),
};

static const moray_program program = {
    .name = "heading_tracking",
    .summary = "Optimises gait and joint offset of an underwater snake robot to follow a heading in a current, and "
               "proves them on the first-principles model against tuned feedback.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
};

static const double usual_horizon = 100;

static heading_job defaults(void)
{
    heading_job job = {.common = moray_common_defaults(),
                       .reference_text = "steps:20=30,60=0",
                       .horizon = NAN,
                       .input = steer_input_default(),
                       .weight_steering = 0.003,
                       .max_error = INFINITY,
                       .intervals_per_period = 5,
                       .refinements = 8,
                       .replan_periods = 1,
                       .look_ahead_periods = 6,
                       .receding = true,
                       .gait_evaluations = 12,
                       .evaluations = 15};
    job.common.model = MORAY_FIRST_PRINCIPLES;
    strcpy(job.common.scheme, "radau5");
    job.common.intervals = 0; // by the period
    return job;
}

static moray_status work(heading_job *job)
{
    moray_family family;
    int stages;
    MORAY_TRY(moray_scheme_parse(job->common.scheme, &family, &stages));
    if (heading_is_fig8(job))
        MORAY_TRY(heading_fig8_prepare(job));
    else
        MORAY_TRY(moray_reference_read(&job->reference, job->reference_text));
    if (isnan(job->horizon))
        job->horizon = usual_horizon;
    heading_choose_trials(job);
    MORAY_TRY(heading_plan_first(job));
    MORAY_TRY(heading_run_trials(job));
    if (job->common.model == MORAY_CONTROL_ORIENTED)
        return moray_ok();
    MORAY_TRY(heading_plan_last(job));
    return heading_run_trials(job);
}

static bool certified(const heading_job *job)
{
    return job->certificate[MORAY_CONTROL_ORIENTED].pass && job->certificate[job->common.model].pass;
}

static void release(heading_job *job)
{
    moray_heading_plan_free(&job->averaged);
    for (int model = 0; model < 2; model++)
        moray_heading_plan_free(&job->plan[model]);
    moray_reference_free(&job->reference);
}

int main(int argc, char **argv)
{
    heading_job job = defaults();
    int exit_code;
    if (!moray_app_start(&program, argc, argv, &job, &exit_code))
        return exit_code;
    job.ticker = moray_ticker_start(stderr, job.common.quiet);
    moray_interrupt_begin();
    moray_status status = work(&job);
    moray_interrupt_end();
    moray_ticker_end(&job.ticker);
    if (!moray_failed(status))
        status = heading_report(&job);
    exit_code = moray_app_end(&program, &job, status);
    if (exit_code == MORAY_EXIT_SOLVED && !certified(&job))
        exit_code = MORAY_EXIT_CERTIFICATE;
    release(&job);
    return exit_code;
}
