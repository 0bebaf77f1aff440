// SPDX-License-Identifier: MIT
//
// The orbit as a motion: the swimmer on it, means and peaks.
#include <math.h>
#include <string.h>

#include "snake/swim/orbit.h"
#include "snake/swim/steady.h"
#include "snake/model/fp_model.h"

static double period_of(const moray_orbit *orbit)
{
    return moray_periodic_orbit_parameters(orbit->engine)[ORBIT_PERIOD];
}

// The swimmer's state from the plant's, with the joints on the gait (phi, then v_phi).
static void swimmer_state(moray_orbit *orbit, const double plant[ORBIT_STATES])
{
    const int N = orbit->spec.robot.links, joints = N - 1;
    const bool control = orbit->spec.model == MORAY_CONTROL_ORIENTED;
    for (int half = 0; half < 2; half++) {
        double *x = orbit->x + half * (N + 2);
        const double *phi = orbit->phi + half * joints, *rigid = plant + 3 * half;
        if (control) {
            memcpy(x, phi, (size_t)joints * sizeof *x);
            memcpy(x + joints, rigid, 3 * sizeof *x);
        } else {
            moray_fp_angles_d(N, rigid[0], phi, x);
            memcpy(x + N, rigid + 1, 2 * sizeof *x);
        }
    }
}

moray_status moray_orbit_sample(moray_orbit *orbit, double t, moray_swim_sample *sample)
{
    const int joints = orbit->spec.robot.links - 1, power = orbit->plant.n_out - 1;
    double x[ORBIT_STATES], *phi = orbit->phi;
    moray_periodic_orbit_state(orbit->engine, t, x);
    moray_gait_reference(&orbit->gait, joints, t, phi, phi + joints, phi + 2 * joints);
    swimmer_state(orbit, x);
    if (!moray_swimmer_rates(orbit->swimmer, orbit->x, phi + 2 * joints, orbit->dx, orbit->u))
        return moray_error(MORAY_NUMERIC, "the model is not finite on the orbit at t = %g", t);
    *sample = (moray_swim_sample){.t = t,
                                  .x = orbit->x,
                                  .u = orbit->u,
                                  .pose = moray_swimmer_pose(orbit->swimmer, orbit->x),
                                  .energy = moray_periodic_orbit_integral(orbit->engine, power, t)};
    moray_swimmer_current(orbit->swimmer, sample->current);
    return moray_ok();
}

static void keep_peak(orbit_peak *peak, const moray_swim_sample *sample, int joints)
{
    for (int i = 0; i < joints; i++)
        if (fabs(sample->u[i]) > peak->size)
            *peak =
                (orbit_peak){.time = sample->t, .size = fabs(sample->u[i]), .joint = i, .negative = sample->u[i] < 0};
}

static void keep_load(orbit_peak *load, const moray_motor *motor, const moray_swim_sample *sample, const double *v,
                      int joints)
{
    for (int i = 0; i < joints; i++)
        for (int k = 0; k < motor->lines; k++) {
            const double share =
                (moray_motor_torque(motor, sample->u[i], v[i]) + motor->slope[k] * v[i]) / motor->torque[k];
            if (fabs(share) > load->size)
                *load = (orbit_peak){sample->t, fabs(share), i, k, share < 0};
        }
}

// Both ends are one sample.
static moray_status measure_samples(moray_orbit *orbit, moray_steady *steady)
{
    const double T = period_of(orbit);
    const int joints = orbit->spec.robot.links - 1;
    moray_swim_sample sample;
    orbit->peak = orbit->load = (orbit_peak){0};
    for (int k = 0; k <= FINEST; k++) {
        MORAY_TRY(moray_orbit_sample(orbit, T * k / FINEST, &sample));
        keep_peak(&orbit->peak, &sample, joints);
        if (orbit->spec.model == MORAY_FIRST_PRINCIPLES)
            keep_load(&orbit->load, &orbit->spec.robot.motor, &sample, orbit->phi + joints, joints);
        steady->peak_link_angle = fmax(steady->peak_link_angle, sample.pose.link_angle);
        steady->heading += (k == 0 || k == FINEST ? 0.5 : 1) * sample.pose.heading / FINEST;
    }
    steady->peak_effort = orbit->peak.size;
    return moray_ok();
}

moray_status moray_orbit_measure(moray_orbit *orbit, moray_steady *steady)
{
    const moray_status status = measure_samples(orbit, steady);
    orbit->found = orbit->found && !moray_failed(status);
    return status;
}

moray_steady moray_orbit_means(moray_orbit *orbit)
{
    const double T = period_of(orbit), *V = orbit->spec.current;
    double first[ORBIT_STATES], last[ORBIT_STATES];
    moray_periodic_orbit_state(orbit->engine, 0, first);
    moray_periodic_orbit_state(orbit->engine, T, last);
    moray_steady steady = {.v_x = (last[1] - first[1]) / T,
                           .v_y = (last[2] - first[2]) / T,
                           .power = moray_periodic_orbit_integral(orbit->engine, orbit->plant.n_out - 1, T) / T,
                           .heading_drift = (last[0] - first[0]) / T,
                           .start_heading = first[0]};
    steady.speed = hypot(steady.v_x - V[0], steady.v_y - V[1]);
    steady.cost_of_transport = steady.speed > 0 ? steady.power / steady.speed : INFINITY;
    steady.turning = fabs(last[0] - first[0]) > TURNING;
    return steady;
}

static moray_status fill_track(moray_orbit *orbit, int points, moray_swim_track *track)
{
    const double T = period_of(orbit);
    moray_swim_sample sample;
    for (int k = 0; k < points; k++) {
        MORAY_TRY(moray_orbit_sample(orbit, T * k / (points - 1), &sample));
        moray_swim_track_add(&sample, track);
    }
    return moray_ok();
}

moray_status moray_orbit_track(moray_orbit *orbit, int points, moray_swim_track *track)
{
    *track = (moray_swim_track){0};
    if (points < 2)
        return moray_error(MORAY_INPUT, "points = %d: an orbit has at least 2", points);
    MORAY_TRY(moray_orbit_check_found(orbit));
    MORAY_TRY(moray_swim_track_new(track, orbit->swimmer, points));
    const moray_status status = fill_track(orbit, points, track);
    if (moray_failed(status))
        moray_swim_track_free(track);
    return status;
}
