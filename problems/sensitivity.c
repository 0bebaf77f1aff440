// SPDX-License-Identifier: MIT
//
// The fastest gait of max_speed, and how it moves with robot, current and limits: from the factors of its KKT matrix,
// beside solving again; and the gait for another current, predicted without solving.
#include "gait/sensitivity/sensitivity.h"

static const moray_option options[] = {
    GAIT_LIMIT("power_W", power, "W",
               "mean power of the joints, or at the terminals of their motors; by default what the paper's gait uses "
               "in the same model and current"),
    MORAY_ROW(PAIR, sensitivity, predicted, "problem", "predict_current", .unit = "m/s",
              .help = "current for which the gait is predicted; by default 0.1 m/s more on both axes"),
};

static moray_status work(gait_job *job)
{
    MORAY_TRY(gait_job_work(job));
    return sensitivity_run((sensitivity *)job);
}

// Sensitivities that solving again does not confirm are none, unless the active set is about to change.
static moray_status certified(const gait_job *job)
{
    const double most = 1e-4;
    const sensitivity *run = (const sensitivity *)job;
    MORAY_TRY(gait_job_certified(job, NULL, last_stage(job)));
    for (int k = 0; k < run->rows; k++)
        if (!run->row[k].unsteady && !(run->row[k].deviation < most))
            return moray_error(MORAY_NOT_SOLVED,
                               "solving again does not confirm the sensitivities to %s: they differ by %.1e",
                               run->row[k].name, run->row[k].deviation);
    return moray_ok();
}

static const gait_program program = {
    .name = "sensitivity",
    .summary = "Tells how the fastest gait of an underwater snake robot moves with its current, its parameters and its "
               "limits, and predicts the gait for another current.",
    .goal = MORAY_GAIT_FASTEST,
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .power = NAN,
    .speed = INFINITY,
    .work = work,
    .report = sensitivity_report,
    .certified = certified};

int main(int argc, char **argv)
{
    static sensitivity run; // large
    run = (sensitivity){.job = gait_job_defaults(&program), .predicted = {NAN, NAN}};
    run.job.refinements = 4;
    return gait_job_main(&program, &run.job, argc, argv);
}
