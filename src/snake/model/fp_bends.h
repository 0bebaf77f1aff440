// SPDX-License-Identifier: MIT
//
// Third derivatives of the potential of the drag across a link, and second ones of the power at a joint's terminals.
#ifndef SRC_SNAKE_MODEL_FP_BENDS_H
#define SRC_SNAKE_MODEL_FP_BENDS_H

#include <math.h>

#include "snake/model/fp_robot.h"

// Of a potential in two variables, by the first of them three times, twice, once and not at all.
typedef struct fp_bends {
    double aaa, aab, abb, bbb;
} fp_bends;

// At 0 what fp_drag.inc and fp_slopes.inc differentiate there.
static inline double fp_sign(double x)
{
    return x < 0 ? -1 : 1;
}

// See strip_slopes in fp_drag.inc.
static inline fp_bends fp_strip_bends(double a, double b)
{
    if (fabs(a) >= fabs(b))
        return (fp_bends){2 * fp_sign(a), 0, fp_sign(a) * (2.0 / 3), 0};
    const double x = a / b, xx = x * x, sign = fp_sign(b);
    return (fp_bends){2 * x * sign, (1 - xx) * sign, xx * x * (2.0 / 3) * sign, (0.5 - xx * xx / 2) * sign};
}

static inline fp_bends fp_piece_bends(int pieces, double a, double b)
{
    fp_bends sum = {0};
    for (int j = 0; j < pieces; j++) {
        const double place = (2 * j + 1 - pieces) / (double)pieces, share = fp_sign(a + b * place) * (2.0 / pieces);
        sum.aaa += share;
        sum.aab += share * place;
        sum.abb += share * place * place;
        sum.bbb += share * place * place * place;
    }
    return sum;
}

// By rel_n (a) and theta' (b), of the potential whose slopes are f_n and tau: evenly along, or at pieces of, the length
// about the lever, at a fin, and of the drag torque.
static inline fp_bends fp_drag_bends(const fp_robot *robot, const fp_part *part, double rel_n, double w)
{
    const double lever = part->lever, half = part->half, fin = part->fin, a = rel_n + lever * w, b = half * w;
    const fp_bends by = robot->strip ? fp_strip_bends(a, b) : fp_piece_bends(robot->pieces, a, b);
    const double of_fin = 2 * part->q_fin * fp_sign(rel_n + fin * w);
    return (fp_bends){
        .aaa = -part->q_n * by.aaa - of_fin,
        .aab = -part->q_n * (lever * by.aaa + half * by.aab) - fin * of_fin,
        .abb = -part->q_n * (lever * lever * by.aaa + 2 * lever * half * by.aab + half * half * by.abb) -
               fin * fin * of_fin,
        .bbb = -part->q_n * (lever * lever * (lever * by.aaa + 3 * half * by.aab) +
                             half * half * (3 * lever * by.abb + half * by.bbb)) -
               fin * fin * fin * of_fin - 2 * part->lambda_3 * fp_sign(w),
    };
}

// Second derivatives of a joint's power at the terminals (fp_motor.inc) by torque and rate, and the slope's own.
typedef struct fp_terminal_bends {
    double uu, uv, vv, slope;
} fp_terminal_bends;

static inline fp_terminal_bends fp_terminals_bend(const moray_motor *motor, double u, double v)
{
    if (!motor->fitted)
        return (fp_terminal_bends){.uv = 1};
    const double smooth = motor->smooth_rate, size = sqrt(v * v + smooth * smooth), sign = v / size;
    const double steep = (1 - sign * sign) / size, slope = motor->friction * steep + motor->viscous;
    const double bend = -3 * motor->friction * steep * sign / size;
    const double u_m = u + motor->friction * sign + motor->viscous * v, p = u_m * v, p_v = u_m + slope * v;
    const double half = (1 / motor->forward + motor->backward) / 2, other = (1 / motor->forward - motor->backward) / 2;
    const double size_p = sqrt(p * p + motor->smooth_power * motor->smooth_power), share = p / size_p;
    const double by_p = half + other * share, by_pp = other * (1 - share * share) / size_p;
    const double by_motor = by_p * v + 2 * motor->copper * u_m;
    const double by_motor_v = by_pp * p_v * v + by_p + 2 * motor->copper * slope;
    return (fp_terminal_bends){.uu = by_pp * v * v + 2 * motor->copper,
                               .uv = by_motor_v,
                               .vv = by_motor_v * slope + by_motor * bend + by_pp * p_v * u_m + by_p * slope,
                               .slope = bend};
}

#endif
