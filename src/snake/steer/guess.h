// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_STEER_GUESS_H
#define SRC_SNAKE_STEER_GUESS_H

#include "moray/snake/controllers.h"
#include "moray/snake/steering.h"

// Samples of a steering problem's phase in one block.
typedef struct steering_guess {
    moray_samples samples;
    double *time, *x, *u; // n, n x states, n x nu
    int nu;
    double s[MORAY_STEERING_PARAMETERS];
} steering_guess;

// Error: MORAY_MEMORY. free(guess->time).
moray_status moray_steering_guess_new(steering_guess *guess, int n, int nu);

// A solution of one model, of that straight, as the other sees it on times stretched by a factor from the start on:
// velocities in the other frame, offsets in the ratio of the amplitudes.
void moray_steering_guess_from_other(steering_guess *guess, const moray_robot *robot, const moray_solution *from,
                                     const moray_straight_motion *straight, moray_model to, double stretch);

// The limits with no choice of a gait left, and none of power.
void moray_steering_keep_gait(moray_steering_limits *limits, const moray_robot *robot, moray_model model,
                              const moray_gait *gait);

#endif
