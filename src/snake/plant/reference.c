// SPDX-License-Identifier: MIT
#include "snake/plant/reference.h"

#include <math.h>

#include "snake/model/taper.h"

enum { anew = 16 }; // joints after which a recurrence of sines begins again, before rounding adds up

// sin and cos of the next joint's angle are those of this one turned by delta.
void moray_reference_set(reference *at, const double p[GAIT_KINDS])
{
    at->a = p[GAIT_A];
    at->omega = p[GAIT_OMEGA];
    at->t = p[GAIT_T];
    at->offset[0] = p[GAIT_PHI_0];
    at->offset[1] = p[GAIT_DPHI_0];
    at->offset[2] = p[GAIT_DDPHI_0];
    const double sine = sin(p[GAIT_DELTA]), cosine = cos(p[GAIT_DELTA]);
    for (int i = 0; i < at->n; i++) {
        at->sine[i] = i % anew ? at->sine[i - 1] * cosine + at->cosine[i - 1] * sine
                               : sin(p[GAIT_OMEGA] * p[GAIT_T] + i * p[GAIT_DELTA]);
        at->cosine[i] = i % anew ? at->cosine[i - 1] * cosine - at->sine[i - 1] * sine
                                 : cos(p[GAIT_OMEGA] * p[GAIT_T] + i * p[GAIT_DELTA]);
        at->place[i] = taper_place(i, at->n);
        at->growth[i] = 1 + p[GAIT_TAPER] * at->place[i];
    }
}

void moray_reference_values(const reference *at, double *phi, double *v, double *acc)
{
    for (int i = 0; i < at->n; i++) {
        const double a = at->a * at->growth[i], a_omega = a * at->omega;
        phi[i] = a * at->sine[i] + at->offset[0];
        v[i] = a_omega * at->cosine[i] + at->offset[1];
        acc[i] = -a_omega * at->omega * at->sine[i] + at->offset[2];
    }
}

// Every input makes the wave grow, turns its phase (at a rate linear in i), shifts it or its derivatives or, omega
// alone, speeds it up.
void moray_reference_tangent(const reference *at, int input, double *phi, double *v, double *acc)
{
    const double a = at->a, omega = at->omega;
    const double *grows = input == GAIT_TAPER ? at->place : at->growth;
    const double grow = input == GAIT_A ? 1 : input == GAIT_TAPER ? a : 0, faster = input == GAIT_OMEGA ? a : 0;
    const double turn = input == GAIT_OMEGA ? a * at->t : input == GAIT_T ? a * omega : 0;
    const double turn_by_i = input == GAIT_DELTA ? a : 0;
    const double shift = input == GAIT_PHI_0, drift = input == GAIT_DPHI_0, push = input == GAIT_DDPHI_0;
    for (int i = 0; i < at->n; i++) {
        const double S = at->sine[i], C = at->cosine[i];
        const double grow_i = grow * grows[i], turn_i = (turn + turn_by_i * i) * at->growth[i];
        const double wave = grow_i * S + turn_i * C, faster_i = faster * at->growth[i];
        phi[i] = wave + shift;
        v[i] = omega * (grow_i * C - turn_i * S) + faster_i * C + drift;
        acc[i] = -omega * (omega * wave + 2 * faster_i * S) + push;
    }
}

static double sum_of(int n, const double *x)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += x[i];
    return sum;
}

void moray_reference_gradient(const reference *at, const double *on_phi, const double *on_v, const double *on_acc,
                              double gradient[GAIT_KINDS])
{
    const double a = at->a, omega = at->omega;
    double by_a = 0, by_omega = 0, by_delta = 0, by_taper = 0, by_phase = 0; // phase: omega t, in (25)
    for (int i = 0; i < at->n; i++) {
        const double S = at->sine[i], C = at->cosine[i], g = at->growth[i];
        const double x = on_phi[i] - omega * omega * on_acc[i], y = omega * on_v[i]; // scalar = a g (x S + y C) + ...
        const double wave = x * S + y * C, turn = g * (x * C - y * S);
        by_a += g * wave;
        by_omega += g * (on_v[i] * C - 2 * omega * on_acc[i] * S);
        by_delta += i * turn;
        by_taper += at->place[i] * wave;
        by_phase += turn;
    }
    gradient[GAIT_A] = by_a;
    gradient[GAIT_OMEGA] = a * (by_omega + at->t * by_phase);
    gradient[GAIT_DELTA] = a * by_delta;
    gradient[GAIT_PHI_0] = sum_of(at->n, on_phi);
    gradient[GAIT_TAPER] = a * by_taper;
    gradient[GAIT_T] = a * omega * by_phase;
    gradient[GAIT_DPHI_0] = sum_of(at->n, on_v);
    gradient[GAIT_DDPHI_0] = sum_of(at->n, on_acc);
}

// Sums over the joints of which every second derivative consists, per unit of a. Phase stands for omega t; where a
// name has two parts it is a second derivative, else a first. The last four are those of place_i, not growth_i.
typedef struct sums {
    double omega, phase, delta;
    double omega_omega, omega_phase, omega_delta, phase_phase, phase_delta, delta_delta;
    double taper, taper_omega, taper_phase, taper_delta;
} sums;

static sums sums_of(const reference *at, const double *on_phi, const double *on_v, const double *on_acc)
{
    const double omega = at->omega;
    sums sum = {0};
    for (int i = 0; i < at->n; i++) {
        const double S = at->sine[i], C = at->cosine[i], g = at->growth[i], s = at->place[i];
        const double x = on_phi[i] - omega * omega * on_acc[i], y = omega * on_v[i]; // scalar = a g (x S + y C) + ...
        const double x_omega = -2 * omega * on_acc[i], y_omega = on_v[i];
        const double wave = x * S + y * C, wave_omega = x_omega * S + y_omega * C;
        const double turn = x * C - y * S, turn_omega = x_omega * C - y_omega * S;
        sum.omega += g * wave_omega;
        sum.phase += g * turn;
        sum.delta += g * i * turn;
        sum.omega_omega += g * -2 * on_acc[i] * S;
        sum.omega_phase += g * turn_omega;
        sum.omega_delta += g * i * turn_omega;
        sum.phase_phase -= g * wave;
        sum.phase_delta -= g * i * wave;
        sum.delta_delta -= g * i * i * wave;
        sum.taper += s * wave;
        sum.taper_omega += s * wave_omega;
        sum.taper_phase += s * turn;
        sum.taper_delta += s * i * turn;
    }
    return sum;
}

void moray_reference_hessian(const reference *at, const double *on_phi, const double *on_v, const double *on_acc,
                             double hessian[GAIT_PAIRS])
{
    const double a = at->a, omega = at->omega, t = at->t;
    const sums sum = sums_of(at, on_phi, on_v, on_acc);
    const double table[GAIT_PAIRS] = {
        0,                                                                         // a
        sum.omega + t * sum.phase,                                                 // omega
        a * (sum.omega_omega + 2 * t * sum.omega_phase + t * t * sum.phase_phase), //
        sum.delta,                                                                 // delta
        a * (sum.omega_delta + t * sum.phase_delta),                               //
        a * sum.delta_delta,                                                       //
        0,                                                                         // phi_0
        0,
        0,
        0,
        sum.taper,                                                               // taper
        a * (sum.taper_omega + t * sum.taper_phase),                             //
        a * sum.taper_delta,                                                     //
        0,                                                                       //
        0,                                                                       //
        omega * sum.phase,                                                       // t
        a * (omega * sum.omega_phase + omega * t * sum.phase_phase + sum.phase), //
        a * omega * sum.phase_delta,                                             //
        0,                                                                       //
        a * omega * sum.taper_phase,                                             //
        a * omega * omega * sum.phase_phase,
    };
    for (int k = 0; k < GAIT_PAIRS; k++)
        hessian[k] = table[k];
}
