// SPDX-License-Identifier: MIT
#include "moray/snake/model.h"
#include "snake/model/model.h"

#include <math.h>
#include <stddef.h>

#include "snake/model/series.h"
#include "snake/model/taper.h"

void moray_gait_reference(const moray_gait *gait, int n_joints, double t, double *phi, double *dphi, double *ddphi)
{
    const double omega = gait->omega, turn_c = cos(gait->delta), turn_s = sin(gait->delta);
    double sine = sin(omega * t), cosine = cos(omega * t);
    for (int i = 0; i < n_joints; i++) {
        const double a = gait->amplitude * (1 + gait->taper * taper_place(i, n_joints));
        phi[i] = a * sine + gait->offset; // (25)
        dphi[i] = a * omega * cosine + gait->offset_rate;
        ddphi[i] = -a * omega * omega * sine + gait->offset_acceleration;
        const double next = sine * turn_c + cosine * turn_s; // a turn by delta costs a tenth of sin and cos
        cosine = cosine * turn_c - sine * turn_s;
        sine = next;
    }
    if (gait->series)
        moray_series_add(gait->series, omega, t, phi, dphi, ddphi);
}

double moray_amplitude_from_theta_max(const moray_robot *robot, moray_model model, double theta_max, double delta)
{
    if (model == MORAY_FIRST_PRINCIPLES)
        return 2 * sin(delta / 2) * theta_max;             // (27)
    return 2 * robot->l * cos(delta / 2) * sin(theta_max); // (33)
}

double moray_theta_max_from_amplitude(const moray_robot *robot, moray_model model, double amplitude, double delta)
{
    if (model == MORAY_FIRST_PRINCIPLES)
        return amplitude / (2 * sin(delta / 2));
    return asin(amplitude / (2 * robot->l * cos(delta / 2)));
}

double moray_theta_max_of_link(const moray_robot *robot, moray_model model, const moray_gait *gait, int link)
{
    const int N = robot->links;
    const double middle = moray_theta_max_from_amplitude(robot, model, gait->amplitude, gait->delta);
    if (N == 2)
        return middle;
    const double tangent = tan(gait->delta / 2), across = model == MORAY_FIRST_PRINCIPLES ? 1 / tangent : tangent;
    const double s = (2.0 * link - N - 1) / (N - 2);
    const double factor = hypot(1 + gait->taper * s, gait->taper * across / (N - 2));
    return model == MORAY_FIRST_PRINCIPLES ? middle * factor : asin(sin(middle) * factor);
}

moray_status moray_gait_without_series(const moray_gait *gait, const char *what)
{
    if (!gait->series)
        return moray_ok();
    return moray_error(MORAY_INPUT,
                       "gait with a series of %d harmonics in %d joints: %s takes a gait (25) without a series",
                       gait->series->harmonics, gait->series->joints, what);
}

moray_gait moray_gait_map(const moray_robot *robot, const moray_gait *gait, moray_model from, moray_model to)
{
    if (from == to)
        return *gait;
    const double theta_max = moray_theta_max_from_amplitude(robot, from, gait->amplitude, gait->delta);
    moray_gait mapped = *gait;
    mapped.amplitude = moray_amplitude_from_theta_max(robot, to, theta_max, gait->delta);
    const double ratio = gait->amplitude == 0 ? 0 : -mapped.amplitude / gait->amplitude; // erratum E3
    mapped.offset *= ratio;
    mapped.offset_rate *= ratio;
    mapped.offset_acceleration *= ratio;
    mapped.series = NULL;
    return mapped;
}
