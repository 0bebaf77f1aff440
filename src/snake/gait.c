// SPDX-License-Identifier: MIT
#include "moray/snake.h"

#include <math.h>

void moray_gait_reference(const moray_gait *gait, int n_joints, double t, double *phi, double *dphi, double *ddphi)
{
    const double omega = gait->omega;
    for (int i = 0; i < n_joints; i++) {
        const double s = n_joints > 1 ? 2.0 * i / (n_joints - 1) - 1 : 0, a = gait->amplitude * (1 + gait->taper * s);
        const double argument = omega * t + i * gait->delta;
        const double sine = sin(argument), cosine = cos(argument);
        phi[i] = a * sine + gait->offset; // (25)
        dphi[i] = a * omega * cosine + gait->offset_rate;
        ddphi[i] = -a * omega * omega * sine + gait->offset_acceleration;
    }
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
    return mapped;
}
