// SPDX-License-Identifier: MIT
//
// The fastest gait along a course in a current: optimised on the control-oriented model, from there on the
// first-principles model, and from there for several models at once; each compared on the ladder of models.
#include <string.h>

#include "gait/job/job.h"

static const char *const over_goals[] = {[MORAY_OVER_WORST] = "worst", [MORAY_OVER_MEAN] = "mean", NULL};

static const moray_option options[] = {
    GAIT_LIMIT("power_W", power, "W",
               "mean power of the joints, or at the terminals of their motors; by default what the paper's gait uses "
               "in the same model and current"),
    MORAY_ROW(TEXT, gait_job, over, "problem", "over", .flag = "over", .argument = "MODELS",
              .help =
                  "rungs of the ladder for which one more gait is optimised, the recommended one, at the power of "
                  "the paper's gait on each; with @VX,VY behind a name in that current [m/s]: "
                  "paper,consistent@0.1,0.1; or NAME.csv, scenarios of coefficients and currents as identify leaves "
                  "them; none: the first-principles optimum is recommended"),
    MORAY_ROW(CHOICE, gait_job, over_goal, "problem", "over_goal", .choices = over_goals,
              .help = "what of the gains over these is maximised"),
};

static const gait_program program = {
    .name = "max_speed",
    .summary = "Optimises the gait of an underwater snake robot for speed along a course, and "
               "tells what it gains on models that it was not found on.",
    .goal = MORAY_GAIT_FASTEST,
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .power = NAN,
    .speed = INFINITY};

int main(int argc, char **argv)
{
    gait_job job = gait_job_defaults(&program);
    strcpy(job.over, "paper,strip,consistent");
    return gait_job_main(&program, &job, argc, argv);
}
