// SPDX-License-Identifier: MIT
#include "snake/steer/guess.h"
#include "snake/steer/problems.h"

#include <math.h>
#include <stdlib.h>

enum { states = MORAY_STEERING_STATES };

moray_status moray_steering_guess_new(steering_guess *guess, int n, int nu)
{
    double *block = calloc((size_t)(n * (1 + states + nu)), sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for a guess of %d samples", n);
    *guess = (steering_guess){.time = block, .x = block + n, .u = block + n * (1 + states), .nu = nu};
    guess->samples = (moray_samples){.n = n, .time = guess->time, .x = guess->x, .u = guess->u};
    return moray_ok();
}

void moray_steering_guess_from_other(steering_guess *guess, const moray_robot *robot, const moray_solution *from,
                                     const moray_straight_motion *straight, moray_model to, double stretch)
{
    const moray_gait gait = moray_steering_gait(moray_solution_parameters(from));
    const moray_gait mapped = moray_gait_map(robot, &gait, straight->model, to);
    const double scale = straight->model == to ? 1 : -mapped.amplitude / gait.amplitude; // erratum E3
    const int n = guess->samples.n;
    double t0, t1;
    moray_solution_times(from, 0, &t0, &t1);
    for (int k = 0; k < n; k++) {
        double *x = guess->x + k * states, *u = guess->u + k * guess->nu;
        const double t = t0 + (t1 - t0) * k / (n - 1);
        guess->time[k] = t0 + (t - t0) * stretch;
        moray_solution_at(from, 0, t, x, u);
        if (straight->model != to) {
            const double turn = to == MORAY_FIRST_PRINCIPLES ? x[MORAY_STATE_THETA] : -x[0],
                         v[2] = {x[MORAY_STATE_V_1], x[MORAY_STATE_V_2]};
            x[MORAY_STATE_V_1] = v[0] * cos(turn) - v[1] * sin(turn);
            x[MORAY_STATE_V_2] = v[0] * sin(turn) + v[1] * cos(turn);
        }
        x[MORAY_STATE_PHI_0] *= scale;
        x[MORAY_STATE_V_PHI_0] *= scale;
        u[0] *= scale;
    }
    moray_steering_parameters(&mapped, guess->s);
}

void moray_steering_keep_gait(moray_steering_limits *limits, const moray_robot *robot, moray_model model,
                              const moray_gait *gait)
{
    limits->theta_max = moray_fixed(moray_theta_max_from_amplitude(robot, model, gait->amplitude, gait->delta));
    limits->omega = moray_fixed(gait->omega);
    limits->delta = moray_fixed(gait->delta);
    limits->power = MORAY_INFINITY;
}
