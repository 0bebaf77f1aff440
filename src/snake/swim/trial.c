// SPDX-License-Identifier: MIT
#include "moray/snake/trial.h"
#include "snake/model/model.h"
#include "snake/swim/orbit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/angle.h"

moray_status moray_test_rig_new(moray_test_rig *rig, const moray_robot *robot, const double current[2], double course)
{
    *rig = (moray_test_rig){
        .current = {current[0], current[1]}, .course = course, .settings = moray_swim_settings_default()};
    for (int model = 0; model < 2; model++) {
        moray_status status = moray_swimmer_new(&rig->swimmer[model], robot, (moray_model)model);
        if (moray_failed(status)) {
            moray_test_rig_free(rig);
            return status;
        }
        moray_swimmer_set_current(rig->swimmer[model], current[0], current[1]);
    }
    return moray_ok();
}

void moray_test_rig_free(moray_test_rig *rig)
{
    for (int model = 0; model < 2; model++) {
        moray_swimmer_free(rig->swimmer[model]);
        rig->swimmer[model] = NULL;
    }
}

moray_swim_setup moray_test_rig_setup(const moray_test_rig *rig, moray_model model)
{
    return (moray_swim_setup){
        .swimmer = rig->swimmer[model], .current = {rig->current[0], rig->current[1]}, .settings = rig->settings};
}

moray_gait moray_gait_paper(const moray_robot *robot)
{
    const double delta = 2 * M_PI / (robot->links - 1);
    return (moray_gait){.amplitude =
                            moray_amplitude_from_theta_max(robot, MORAY_CONTROL_ORIENTED, 20 * MORAY_DEGREE, delta),
                        .omega = 120 * MORAY_DEGREE,
                        .delta = delta};
}

moray_bounds moray_gait_usual_delta(const moray_robot *robot)
{
    const double paper = moray_gait_paper(robot).delta, least = 0.375, most = 2.25; // of it
    return moray_between(fmax(fmin(15 * MORAY_DEGREE, least * paper), 1 * MORAY_DEGREE),
                         fmin(fmax(90 * MORAY_DEGREE, most * paper), 150 * MORAY_DEGREE));
}

moray_status moray_gait_trial_swim(const moray_test_rig *rig, moray_model model, moray_gait_trial *trial)
{
    const moray_swim_setup setup = moray_test_rig_setup(rig, model);
    trial->why[model] = moray_swim_hold_course(&setup, &trial->gait[model], rig->course, &trial->steady[model]);
    trial->held[model] = !moray_failed(trial->why[model]);
    return trial->held[model]
               ? moray_ok()
               : moray_swim_steady(&setup, &trial->gait[model], rig->course, &trial->steady[model], NULL, 0);
}

moray_status moray_gait_trial_run(const moray_test_rig *rig, const moray_gait *gait, moray_model from,
                                  moray_gait_trial *trial)
{
    MORAY_TRY(moray_gait_without_series(gait, "a trial on both models"));
    for (int model = 0; model < 2; model++) {
        const moray_robot *robot = moray_swimmer_robot(rig->swimmer[model]);
        trial->gait[model] = moray_gait_map(robot, gait, from, (moray_model)model);
        MORAY_TRY(moray_gait_trial_swim(rig, (moray_model)model, trial));
    }
    return moray_ok();
}

// ---- Gain ----------------------------------------------------------------------------------------------------------

// The orbit of the trial's gait, where it may stand for simulations at other omegas: it does not lose deviations, and
// the simulation of the gait itself, from rest, came to it. NULL where it may not.
static moray_orbit *proved_orbit(const moray_test_rig *rig, const moray_gait_trial *trial, moray_model model)
{
    const double alike = 1e-5; // of speed and power
    const moray_steady *swum = &trial->steady[model];
    moray_orbit_spec spec = moray_orbit_spec_default(moray_swimmer_robot(rig->swimmer[model]), model);
    moray_orbit *orbit = NULL;
    moray_orbit_result found;
    memcpy(spec.current, rig->current, sizeof spec.current);
    spec.course = rig->course;
    if (trial->gait[model].series || moray_failed(moray_orbit_new(&orbit, &spec)))
        return NULL;
    if (!moray_failed(moray_orbit_find(orbit, &trial->gait[model], &found)) &&
        fabs(found.steady.speed - swum->speed) <= alike * swum->speed &&
        fabs(found.steady.power - swum->power) <= alike * swum->power && !moray_failed(moray_orbit_stays(orbit)))
        return orbit;
    moray_orbit_free(orbit);
    return NULL;
}

// On the orbit, and simulated from rest where there is none.
static moray_status match(const moray_test_rig *rig, moray_orbit *orbit, moray_model model, bool power, double target,
                          moray_gait *gait, moray_steady *steady)
{
    const moray_swim_setup setup = moray_test_rig_setup(rig, model);
    if (orbit && !moray_failed(moray_orbit_match(orbit, gait, power, target, steady)) &&
        !moray_failed(moray_orbit_stays(orbit)))
        return moray_ok();
    return power ? moray_swim_match_power(&setup, gait, rig->course, target, steady)
                 : moray_swim_match_speed(&setup, gait, rig->course, target, steady);
}

moray_gait_gain moray_gait_gain_over(const moray_test_rig *rig, const moray_gait_trial *trial,
                                     const moray_gait_trial *baseline)
{
    const moray_model model = MORAY_FIRST_PRINCIPLES;
    const moray_steady *base = &baseline->steady[model];
    moray_gait faster = trial->gait[model], thriftier = trial->gait[model];
    moray_orbit *orbit = proved_orbit(rig, trial, model);
    moray_steady steady;
    moray_gait_gain gain = {NAN, NAN, NAN, NAN, {0}, {0}};
    gain.why_no_speed = match(rig, orbit, model, true, base->power, &faster, &steady);
    if (!moray_failed(gain.why_no_speed)) {
        gain.speed_percent_at_equal_power = 100 * (steady.speed / base->speed - 1);
        gain.omega_at_equal_power = faster.omega;
    }
    gain.why_no_power = match(rig, orbit, model, false, base->speed, &thriftier, &steady);
    if (!moray_failed(gain.why_no_power)) {
        gain.omega_at_equal_speed = thriftier.omega;
        gain.power_percent_at_equal_speed = 100 * (steady.power / base->power - 1);
    }
    moray_orbit_free(orbit);
    return gain;
}

// ---- From rest -----------------------------------------------------------------------------------------------------

// Positions along the course at 2n times: of the samples, and one period before each (or the start).
struct progress_along {
    double course_x, course_y;
    double *along;
    int next;
};

static bool note_position(const moray_swim_sample *sample, void *self)
{
    struct progress_along *at = self;
    at->along[at->next++] = sample->pose.p_x * at->course_x + sample->pose.p_y * at->course_y;
    return true;
}

static int by_time(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

static double position_at(const double *times, const double *along, int n, double t)
{
    const double *found = bsearch(&t, times, (size_t)n, sizeof *times, by_time);
    return along[found - times];
}

moray_status moray_gait_trial_speeds(const moray_test_rig *rig, const moray_gait_trial *trial, moray_model model,
                                     double horizon, int n, double *time, double *speed)
{
    const moray_gait_change change = {0, trial->gait[model]};
    const double period = 2 * M_PI / change.gait.omega;
    const int states = moray_swimmer_states(rig->swimmer[model]);
    double *times = calloc((size_t)(4 * n + states), sizeof *times);
    if (!times)
        return moray_error(MORAY_MEMORY, "no memory for %d samples", n);
    double *along = times + 2 * n, *x = along + 2 * n;
    for (int k = 0; k < n; k++) {
        time[k] = times[2 * k] = horizon * k / (n - 1);
        times[2 * k + 1] = fmax(time[k] - period, 0);
    }
    qsort(times, 2 * (size_t)n, sizeof *times, by_time);
    struct progress_along progress = {cos(rig->course), sin(rig->course), along, 0};
    const moray_swim_plan plan = {.t1 = horizon,
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .times = times,
                                  .n_times = 2 * n,
                                  .observe = note_position,
                                  .observer = &progress};
    moray_swimmer_rest(rig->swimmer[model], trial->steady[model].start_heading, 0, 0, x);
    moray_status status = moray_swim_run(rig->swimmer[model], &rig->settings.sim, &plan, x, NULL);
    for (int k = 0; k < n && !moray_failed(status); k++) {
        const double before = fmax(time[k] - period, 0), span = time[k] - before;
        const double moved = position_at(times, along, 2 * n, time[k]) - position_at(times, along, 2 * n, before);
        speed[k] = span > 0 ? moved / span : 0;
    }
    free(times);
    return status;
}
