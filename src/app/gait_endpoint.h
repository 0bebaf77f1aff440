// SPDX-License-Identifier: MIT
#ifndef APP_GAIT_ENDPOINT_H
#define APP_GAIT_ENDPOINT_H

#include "base/triplets.h"
#include "moray/gait_problem.h"

// The ends of the optimal-gait problem as a map with analytic derivatives. Events: periodicity of every state but the
// position, displacement across the course [m], omega T [rad], sine of theta_max by (33) [-], then mean power [W] and
// rate amplitude [m/s] where limited.
struct gait_endpoint {
    int nx, position;    // states; first of p_x, p_y
    double L, course[2]; // link length; unit vector of the course
    bool power, rate;
    triplets jac, hess;
    int events;
};

// The map uses `endpoint`, which must not move. Error: MORAY_MEMORY.
moray_status gait_endpoint_map(moray_map *map, struct gait_endpoint *endpoint);
void gait_endpoint_free(struct gait_endpoint *endpoint);

#endif
