// SPDX-License-Identifier: MIT
#include "moray/gait_trial.h"

#include <math.h>

moray_status moray_basin_new(moray_basin *basin, const moray_robot *robot, const double current[2], double course)
{
    *basin = (moray_basin){
        .current = {current[0], current[1]}, .course = course, .settings = moray_swim_settings_default()};
    for (int model = 0; model < 2; model++) {
        moray_status status = moray_swimmer_new(&basin->swimmer[model], robot, (moray_model)model);
        if (moray_failed(status)) {
            moray_basin_free(basin);
            return status;
        }
        moray_swimmer_set_current(basin->swimmer[model], current[0], current[1]);
    }
    return moray_ok();
}

void moray_basin_free(moray_basin *basin)
{
    for (int model = 0; model < 2; model++) {
        moray_swimmer_free(basin->swimmer[model]);
        basin->swimmer[model] = NULL;
    }
}

moray_swim_setup moray_basin_setup(const moray_basin *basin, moray_model model)
{
    return (moray_swim_setup){.swimmer = basin->swimmer[model],
                              .current = {basin->current[0], basin->current[1]},
                              .settings = basin->settings};
}

moray_gait moray_gait_paper(const moray_robot *robot)
{
    const double degree = M_PI / 180, delta = 40 * degree;
    return (moray_gait){
        .amplitude = moray_amplitude_from_theta_max(robot, MORAY_CONTROL_ORIENTED, 20 * degree, delta),
        .omega = 120 * degree,
        .delta = delta};
}

moray_status moray_gait_trial_run(const moray_basin *basin, const moray_gait *gait, moray_model from,
                                  moray_gait_trial *trial)
{
    for (int model = 0; model < 2; model++) {
        const moray_swim_setup setup = moray_basin_setup(basin, (moray_model)model);
        trial->gait[model] = moray_gait_map(moray_swimmer_robot(setup.swimmer), gait, from, (moray_model)model);
        trial->why[model] =
            moray_swim_hold_course(&setup, &trial->gait[model], basin->course, &trial->steady[model]);
        trial->held[model] = !moray_failed(trial->why[model]);
        if (!trial->held[model])
            MORAY_TRY(moray_swim_steady(&setup, &trial->gait[model], basin->course, &trial->steady[model], NULL, 0));
    }
    return moray_ok();
}

moray_gait_gain moray_gait_gain_over(const moray_basin *basin, const moray_gait_trial *trial,
                                     const moray_gait_trial *baseline)
{
    enum { model = MORAY_FIRST_PRINCIPLES };
    const moray_swim_setup setup = moray_basin_setup(basin, model);
    const moray_steady *base = &baseline->steady[model];
    moray_gait faster = trial->gait[model], thriftier = trial->gait[model];
    moray_steady steady;
    moray_gait_gain gain = {NAN, NAN, NAN, {0}, {0}};
    gain.why_no_speed = moray_swim_match_power(&setup, &faster, basin->course, base->power, &steady);
    if (!moray_failed(gain.why_no_speed)) {
        gain.speed_percent_at_equal_power = 100 * (steady.speed / base->speed - 1);
        gain.omega_at_equal_power = faster.omega;
    }
    gain.why_no_power = moray_swim_match_speed(&setup, &thriftier, basin->course, base->speed, &steady);
    if (!moray_failed(gain.why_no_power))
        gain.power_percent_at_equal_speed = 100 * (steady.power / base->power - 1);
    return gain;
}
