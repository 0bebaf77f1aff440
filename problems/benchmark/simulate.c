// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "benchmark.h"
#include "moray/clock.h"
#include "moray/number.h"

static const double horizon = 45; // s, as in Sec. V-B

static moray_status simulate(moray_swimmer *swimmer, const moray_gait *gait, double *x, double *seconds)
{
    const moray_sim_settings settings = moray_sim_settings_default();
    const moray_gait_change only = {0, *gait};
    const moray_swim_plan plan = {.t1 = horizon, .schedule = &only, .n_changes = 1};
    moray_swimmer_rest(swimmer, 0, 0, 0, x);
    const double start = moray_processor_clock();
    moray_status status = moray_swim_run(swimmer, &settings, &plan, x, NULL);
    *seconds = moray_processor_clock() - start;
    return status;
}

moray_status simulation_rate(moray_model model, int links, int repeats, double *rate)
{
    moray_robot robot = moray_robot_paper();
    moray_swimmer *swimmer;
    robot.links = links;
    const moray_gait paper = moray_gait_paper(&robot),
                     gait = moray_gait_map(&robot, &paper, MORAY_CONTROL_ORIENTED, model);
    MORAY_TRY(moray_swimmer_new(&swimmer, &robot, model));
    double *seconds = calloc((size_t)(repeats + 2 * links + 4), sizeof *seconds),
           *x = seconds ? seconds + repeats : NULL;
    moray_status status = seconds ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d links", links);
    for (int k = 0; k < repeats && !moray_failed(status); k++)
        status = simulate(swimmer, &gait, x, &seconds[k]);
    if (!moray_failed(status))
        *rate = horizon / moray_quantile(seconds, repeats, 0.5);
    free(seconds);
    moray_swimmer_free(swimmer);
    return status;
}
