// SPDX-License-Identifier: MIT
//
// Gains planned over all training draws at once, and a manoeuvre planned over their robots.
#include "sea.h"

enum { GAIN, FORWARD, LEAD, INTEGRAL };

double sea_lag(const sea_job *job)
{
    const double half_a_look = 0.05;
    return half_a_look + job->actuators.dead_time + job->sensors.delay + job->sensors.sampling / 2;
}

// Every scenario follows the reference of its draw, or this one.
static moray_robust_spec spec_of(const sea_job *job, const double *number, const moray_reference *reference,
                                 moray_scenario scenario[MORAY_ROBUST_SCENARIOS])
{
    const moray_sensors *sensors = &job->sensors;
    const double weight_steering = 1e-3;
    moray_robust_spec spec = {.robot = job->believed,
                              .gait = job->gait,
                              .offset = job->offset,
                              .offset_rate = job->offset_rate,
                              .lag = sea_lag(job),
                              .noise = hypot(sensors->heading, 1.7 * sensors->joints), // of the mean of ten links
                              .sampling = sensors->sampling,
                              .scenario = scenario,
                              .n = job->training < MORAY_ROBUST_SCENARIOS ? job->training : MORAY_ROBUST_SCENARIOS,
                              .duration = job->duration,
                              .start = {.proportional = number[GAIN], .forward = number[FORWARD]},
                              .weight_steering = weight_steering,
                              .settings = moray_settings_default()};
    for (int k = 0; k < spec.n; k++) {
        const sea_draw *draw = &job->draw[job->seeds + k];
        scenario[k] =
            (moray_scenario){draw->truth, draw->straight.speed, draw->turn, reference ? reference : &draw->reference};
    }
    spec.settings.scheme = "radau3";
    spec.settings.tolerance = 1e-6;
    spec.settings.max_iterations = 300;
    return spec;
}

moray_status sea_robust(const sea_job *job, double number[SEA_NUMBERS])
{
    moray_scenario scenario[MORAY_ROBUST_SCENARIOS];
    moray_heading_gains found;
    double objective;
    moray_robust_spec spec = spec_of(job, number, NULL, scenario);
    spec.settings.intervals = (int)ceil(3 * job->duration);
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

moray_status sea_robust_plan(const sea_job *job, const sea_draw *draw, const double *number, moray_robust_plan *plan)
{
    moray_scenario scenario[MORAY_ROBUST_SCENARIOS];
    double objective;
    moray_robust_spec spec = spec_of(job, number, &draw->reference, scenario);
    spec.settings.intervals = moray_reference_intervals(&draw->reference, 0, job->duration, (int)ceil(job->duration));
    return moray_robust_plan_make(plan, &objective, &spec, false);
}
