// SPDX-License-Identifier: MIT
#include "snake/model/fp_robot.h"

// Share of c l^2 / 3 in the second moment of what acts evenly along a link of c in all: at its centre nothing, at those
// of k pieces (1/k) sum s^2 = (1 - 1/k^2) l^2/3, along it all.
static double spread(const moray_hydrodynamics *hydro)
{
    const double k = hydro->pieces;
    if (hydro->rotation == MORAY_ROTATION_STRIP)
        return 1;
    return k > 1 ? 1 - 1 / (k * k) : 0;
}

fp_robot moray_fp_robot_of(const moray_robot *robot)
{
    const moray_hydrodynamics *hydro = &robot->hydro;
    const bool linear = hydro->drag != MORAY_DRAG_QUADRATIC, quadratic = hydro->drag != MORAY_DRAG_LINEAR;
    const bool strip = hydro->rotation == MORAY_ROTATION_STRIP;
    const double second = spread(hydro) * robot->l * robot->l / 3, k = hydro->pieces > 1 ? hydro->pieces : 1;
    const double piece = strip ? 0 : 1 / k; // of a link: strips are the limit of many
    fp_robot made = {.links = robot->links,
                     .l = robot->l,
                     .m = robot->m,
                     .mu_n = robot->mu_n,
                     .inertia = robot->J + (robot->lambda_1 * piece * piece + robot->mu_n * second),
                     .lambda_2 = robot->lambda_2 * piece * piece, // k of (l/k)^3
                     .lambda_3 = robot->lambda_3 * piece * piece * piece,
                     .c_t = linear ? robot->c_t : 0,
                     .c_n = linear ? robot->c_n : 0,
                     .q_t = quadratic ? robot->c_t : 0,
                     .q_n = quadratic ? robot->c_n : 0,
                     .strip = strip,
                     .invariant = hydro->added_mass == MORAY_ADDED_MASS_INVARIANT,
                     .pieces = (int)k};
    made.lambda_2 += made.c_n * second;
    return made;
}
