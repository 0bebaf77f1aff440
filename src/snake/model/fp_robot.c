// SPDX-License-Identifier: MIT
#include "snake/model/fp_robot.h"

#include <math.h>

// Share of c h^2 / 3 in the second moment of what acts evenly on a length 2h, c in all: at its centre nothing, at those
// of k pieces (1/k) sum s^2 = (1 - 1/k^2) h^2/3, along it all.
static double spread(const moray_hydrodynamics *hydro)
{
    const double k = hydro->pieces;
    if (hydro->rotation == MORAY_ROTATION_STRIP)
        return 1;
    return k > 1 ? 1 - 1 / (k * k) : 0;
}

int moray_fp_parts(const moray_robot *robot)
{
    return robot->link ? robot->links : 1;
}

// README.md, "Unequal links": moments about the centre of mass.
static fp_part part_of(const moray_hydrodynamics *hydro, const moray_link *link)
{
    const bool linear = hydro->drag != MORAY_DRAG_QUADRATIC, quadratic = hydro->drag != MORAY_DRAG_LINEAR;
    const double k = hydro->pieces > 1 ? hydro->pieces : 1;
    const double piece = hydro->rotation == MORAY_ROTATION_STRIP ? 0 : 1 / k; // of a link: strips are the limit of many
    const double half = link->l - fabs(link->cb), lever = link->cb - link->cm, fin = link->fin_at - link->cm;
    const double second = spread(hydro) * half * half / 3;
    fp_part part = {.l = link->l,
                    .rear = 1 + link->cm / link->l,
                    .front = 1 - link->cm / link->l,
                    .m = link->m,
                    .mu_n = link->mu_n + link->fin_mu_n,
                    .mu_1 = link->mu_n * lever + link->fin_mu_n * fin,
                    .inertia = link->J + (link->lambda_1 * piece * piece + link->mu_n * second),
                    .c_t = linear ? link->c_t + link->fin_c_t : 0,
                    .c_n = linear ? link->c_n + link->fin_c_n : 0,
                    .c_1 = linear ? link->c_n * lever + link->fin_c_n * fin : 0,
                    .lambda_2 = link->lambda_2 * piece * piece, // k of (l/k)^3
                    .lambda_3 = link->lambda_3 * piece * piece * piece,
                    .q_t = quadratic ? link->c_t + link->fin_c_t : 0,
                    .q_n = quadratic ? link->c_n : 0,
                    .half = half,
                    .lever = lever,
                    .q_fin = quadratic ? link->fin_c_n : 0,
                    .fin = fin};
    part.inertia += link->mu_n * lever * lever + link->fin_mu_n * fin * fin;
    if (linear)
        part.lambda_2 += link->c_n * second + (link->c_n * lever * lever + link->fin_c_n * fin * fin);
    return part;
}

fp_robot moray_fp_robot_of(const moray_robot *robot, fp_part *part)
{
    const moray_hydrodynamics *hydro = &robot->hydro;
    const int n = moray_fp_parts(robot);
    double inertia = 0;
    for (int i = 0; i < n; i++) {
        const moray_link link = moray_robot_link(robot, i);
        part[i] = part_of(hydro, &link);
        inertia += (part[i].inertia - part[0].inertia) / n; // of equal ones, theirs to the last bit
    }
    inertia += part[0].inertia;
    for (int i = 0; i < n; i++) {
        part[i].weight = part[i].m / robot->m;
        part[i].uneven = part[i].inertia - inertia;
        part[i].plain = n == 1;
    }
    return (fp_robot){.links = robot->links,
                      .alike = n == 1,
                      .part = part,
                      .motor = robot->motor,
                      .strip = hydro->rotation == MORAY_ROTATION_STRIP,
                      .invariant = hydro->added_mass == MORAY_ADDED_MASS_INVARIANT,
                      .pieces = hydro->pieces > 1 ? hydro->pieces : 1};
}
