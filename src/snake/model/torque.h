// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_MODEL_TORQUE_H
#define SRC_SNAKE_MODEL_TORQUE_H

#include <stdbool.h>

typedef struct torque_limit {
    int n;        // joints
    double most;  // of every effort; 0: no limit
    double *room; // [TORQUE_ROOM(n)], owned
} torque_limit;
#define TORQUE_ROOM(n) ((size_t)(n) * ((size_t)(n) + 3))

// Efforts u[n] of the accelerations ubar[n], affine in them. False where there are none.
typedef bool moray_efforts_fn(void *self, const double *ubar, double *u);

// Makes the accelerations wanted those of the efforts that they would take, each cut off at the limit. False where the
// dynamics are singular.
bool moray_torque_limited(const torque_limit *limit, moray_efforts_fn *efforts, void *self, double *ubar);

#endif
