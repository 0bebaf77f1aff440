// SPDX-License-Identifier: MIT
//
// Gait and joint offset phi_0(t) that make the robot follow a heading in a current: found by optimisation, tried on
// both models, blindly, with feedback and in receding horizon, against heading feedback tuned for the same reference.
#include "steering/heading/heading.h"
#include "steering/options.h"

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
    STEER_GAIT_OPTIONS(heading_job),
    STEER_LIMIT(heading_job, max_error, "max_error_deg", "deg", "largest heading error allowed of the plan"),
    STEER_WEIGHT(heading_job, weight_power, "weight_power", 0,
                 "of the mean joint power in W, against 1 for the mean squared heading error in units of 10 deg"),
    STEER_WEIGHT(heading_job, steer.weight_steering, "weight_steering", 1e-9,
                 "of the mean square of phi_0'' in units of its limit per s^2, likewise"),
    STEER_MESH_OPTIONS(heading_job),
    STEER_INT(heading_job, gait_evaluations, "solver", "gait_evaluations", 0, 10000,
              "gaits tried for the first-principles plan; 0: the paper's"),
    STEER_RECEDING_OPTIONS(heading_job),
    STEER_TUNING_OPTION(heading_job, "simulations spent on tuning each gain, twice as many for a gain and a lead"),
};

// Who swims on the paper's gait where that takes more than the power allowed is no rival.
static void bar_trials(steer_job *job)
{
    const moray_model model = job->common.model;
    const bool beyond = job->straight[0][model].power > (1 + 1e-6) * steer_limits(job, model).power;
    for (int k = 0; k < job->n_trials; k++)
        job->trial[k].barred = job->trial[k].gait == 0 && beyond;
}

static moray_status work(steer_job *steer)
{
    heading_job *job = (heading_job *)steer;
    if (heading_is_fig8(job))
        MORAY_TRY(heading_fig8_prepare(job));
    else
        MORAY_TRY(moray_reference_read(&job->reference, job->reference_text));
    if (isnan(job->horizon))
        job->horizon = 100;
    heading_choose_trials(steer);
    MORAY_TRY(heading_plan_first(job));
    bar_trials(steer);
    MORAY_TRY(steer_run_trials(steer));
    if (steer->common.model == MORAY_CONTROL_ORIENTED)
        return moray_ok();
    MORAY_TRY(heading_plan_last(job));
    return steer_run_trials(steer);
}

static void release(steer_job *steer)
{
    heading_job *job = (heading_job *)steer;
    moray_heading_plan_free(&job->averaged);
    for (int model = 0; model < 2; model++)
        moray_heading_plan_free(&job->plan[model]);
    moray_reference_free(&job->reference);
}

static const steer_program program = {
    .app = {.name = "heading_tracking",
            .summary = "Optimises gait and joint offset of an underwater snake robot to follow a heading in a current, "
                       "and proves them on the first-principles model against tuned feedback.",
            .options = options,
            .n_options = sizeof options / sizeof *options},
    .work = work,
    .release = release,
    .laws = heading_laws,
    .numbers = heading_numbers,
    .n_numbers = HEADING_NUMBERS,
    .x_tolerance = 3e-3,
    .f_tolerance = 3e-4,
    .rough_per_second = 10,
    .start = heading_start,
    .judge = heading_judge,
    .scores = heading_scores,
    .n_scores = HEADING_SCORES,
    .score_title = "Heading error, without the undulation, deg; power, W",
    .columns = heading_columns,
    .tables = heading_tables,
    .headline = heading_headline,
    .conclude = heading_conclude,
    .explain = heading_explain,
    .notes = heading_notes,
    .swum = heading_swum,
    .tells_preview = true,
    .json_head = heading_json_head,
    .json_plan = heading_json_plan,
    .json_tail = heading_json_tail,
    .over_time = {.name = "heading",
                  .title = "Heading without its undulation, first-principles model",
                  .y_label = "heading [deg]"},
    .values = heading_values,
    .draw = heading_draw,
};

int main(int argc, char **argv)
{
    heading_job job = {.steer = steer_defaults(),
                       .reference_text = "steps:20=30,60=0",
                       .horizon = NAN,
                       .max_error = INFINITY,
                       .gait_evaluations = 12};
    job.steer.weight_steering = 0.003;
    job.steer.refinements = 8;
    job.steer.evaluations = 15;
    return steer_main(&program, argc, argv, &job.steer);
}
