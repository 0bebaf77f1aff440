// SPDX-License-Identifier: MIT
//
// Gains planned over all training draws at once.
#include "sea.h"

moray_status sea_robust(const sea_job *job, double number[SEA_NUMBERS])
{
    enum { GAIN, FORWARD, LEAD, INTEGRAL };
    const moray_sensors *sensors = &job->sensors;
    const double half_a_look = 0.05;
    moray_scenario scenario[MORAY_ROBUST_SCENARIOS];
    moray_heading_gains found;
    double objective;
    moray_robust_spec spec = {.robot = job->believed,
                              .gait = job->gait,
                              .offset = job->offset,
                              .offset_rate = job->offset_rate,
                              .lag = half_a_look + job->actuators.dead_time + sensors->delay + sensors->sampling / 2,
                              .noise = hypot(sensors->heading, 1.7 * sensors->joints), // of the mean of ten links
                              .sampling = sensors->sampling,
                              .scenario = scenario,
                              .n = job->training < MORAY_ROBUST_SCENARIOS ? job->training : MORAY_ROBUST_SCENARIOS,
                              .duration = job->duration,
                              .start = {.proportional = number[GAIN], .forward = number[FORWARD]},
                              .settings = moray_settings_default()};
    for (int k = 0; k < spec.n; k++) {
        const sea_draw *draw = &job->draw[job->seeds + k];
        scenario[k] = (moray_scenario){draw->truth, draw->straight.speed, draw->turn, &draw->reference};
    }
    spec.settings.scheme = "radau3";
    spec.settings.intervals = (int)ceil(3 * job->duration);
    spec.settings.tolerance = 1e-6;
    spec.settings.max_iterations = 300;
    const moray_status status = moray_robust_gains(&found, &objective, &spec);
    if (status.code == MORAY_NOT_SOLVED) {
        moray_ticker_note(&job->ticker, "sea_trials: gains by collocation: %.200s", status.text);
        return moray_ok();
    }
    MORAY_TRY(status);
    number[GAIN] = found.proportional;
    number[FORWARD] = found.forward;
    number[LEAD] = 0;
    number[INTEGRAL] = found.integral;
    return moray_ok();
}
