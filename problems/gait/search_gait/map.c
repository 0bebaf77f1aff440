// SPDX-License-Identifier: MIT
//
// The map on which the optima lie: speed at equal power over the shape of the gait.
#include <stdlib.h>

#include "moray/parallel.h"
#include "search_gait.h"

static double power_of(const search_gait *run)
{
    return isfinite(run->demand.power) ? run->demand.power : run->job.paper.steady[run->spec.model].power;
}

// A moray_task_fn: the speeds at one phase shift; NaN where no omega within its limits gives that power.
static void map_task(int k, void *result, void *self)
{
    const search_gait *run = self;
    const search_gait_map *map = &run->map;
    double *speed = result;
    const double slack = 1 + 1e-6;
    moray_orbit_spec spec = moray_orbit_spec_default(&run->spec.robot, run->spec.model);
    moray_orbit *orbit;
    spec.current[0] = run->spec.current[0];
    spec.current[1] = run->spec.current[1];
    spec.course = run->spec.course;
    for (int i = 0; i < SEARCH_GAIT_ROWS; i++)
        speed[i] = NAN;
    if (moray_failed(moray_orbit_new(&orbit, &spec)))
        return;
    for (int i = 0; i < SEARCH_GAIT_ROWS && !moray_interrupted(); i++) {
        moray_orbit_result found;
        moray_gait gait = run->job.paper.gait[run->spec.model];
        gait.delta = map->delta[k] * DEG;
        gait.amplitude =
            moray_amplitude_from_theta_max(&run->spec.robot, run->spec.model, map->theta_max[i] * DEG, gait.delta);
        if (!moray_failed(moray_orbit_match_power(orbit, &gait, power_of(run), &found)) &&
            gait.omega <= run->spec.limits.omega.upper * slack && gait.omega * slack >= run->spec.limits.omega.lower)
            speed[i] = moray_course_speed(&found.steady, run->spec.course);
    }
    moray_orbit_free(orbit);
}

static void even(moray_bounds range, double *values, int n)
{
    for (int k = 0; k < n; k++)
        values[k] = (range.lower + (range.upper - range.lower) * k / (n - 1)) / DEG;
}

moray_status search_gait_map_new(search_gait *run)
{
    double speed[SEARCH_GAIT_COLUMNS][SEARCH_GAIT_ROWS];
    run->activity = "the map";
    even(run->spec.limits.delta, run->map.delta, SEARCH_GAIT_COLUMNS);
    even(run->spec.limits.theta_max, run->map.theta_max, SEARCH_GAIT_ROWS);
    MORAY_TRY(moray_parallel(SEARCH_GAIT_COLUMNS, sizeof *speed, speed, map_task, run, run->job.jobs));
    if (moray_interrupted())
        return moray_error(MORAY_INTERRUPTED, "interrupted while searching; nothing is written");
    for (int k = 0; k < SEARCH_GAIT_COLUMNS; k++)
        for (int i = 0; i < SEARCH_GAIT_ROWS; i++)
            run->map.speed[i][k] = speed[k][i];
    return moray_ok();
}

moray_status search_gait_draw_map(const search_gait *run, moray_output *output)
{
    const search_gait_map *map = &run->map;
    double at[2][SEARCH_GAIT_SHOWN];
    char title[120];
    const moray_gait *paper = &run->job.paper.gait[run->spec.model];
    const double delta = paper->delta / DEG, theta_max = search_gait_theta_max(run, paper) / DEG;
    const moray_field field = {.label = "speed [m/s]",
                               .x = map->delta,
                               .y = map->theta_max,
                               .z = map->speed[0],
                               .n_x = SEARCH_GAIT_COLUMNS,
                               .n_y = SEARCH_GAIT_ROWS};
    for (int k = 0; k < run->shown; k++) {
        at[0][k] = run->optimum[k].gait.delta / DEG;
        at[1][k] = search_gait_theta_max(run, &run->optimum[k].gait) / DEG;
    }
    const moray_curve curves[] = {{.label = "optima",
                                   .x = at[0],
                                   .y = at[1],
                                   .n = run->shown,
                                   .style = MORAY_CURVE_POINTS,
                                   .colour = MORAY_COLOUR_BEST},
                                  {.label = "the paper's gait",
                                   .x = &delta,
                                   .y = &theta_max,
                                   .n = 1,
                                   .style = MORAY_CURVE_POINTS,
                                   .colour = MORAY_COLOUR_BASELINE}};
    snprintf(title, sizeof title, "Speed at a mean joint power of %.4g W; blank: omega beyond its limits",
             power_of(run));
    return moray_output_figure(output, &(moray_figure){.name = "map",
                                                       .title = title,
                                                       .x_label = "phase shift delta [deg]",
                                                       .y_label = "link-angle amplitude theta_max [deg]",
                                                       .curves = curves,
                                                       .n_curves = 2,
                                                       .field = &field});
}
