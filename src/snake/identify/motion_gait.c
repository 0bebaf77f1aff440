// SPDX-License-Identifier: MIT
//
// A gait (25) through logged angles: omega where the first harmonics of all joints leave least, the others from those,
// then all six by Gauss and Newton.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/dense.h"
#include "snake/identify/motion.h"

enum { PARAMETERS = 6, POLISH = 8, FINE = 60 };
static const double golden = 0.6180339887498949;

struct wave { // of one joint: c + p sin(omega t) + q cos(omega t)
    double c, p, q;
};

// By least squares; adds what is left to *left.
static bool fit_wave(const moray_swim_log *log, int joint, double omega, struct wave *wave, double *left)
{
    double A[9] = {0}, b[3] = {0}, square = 0;
    for (int k = 0; k < log->n; k++) {
        const double y = log->phi[k * log->joints + joint], t = log->t[k] - log->t[0];
        const double f[3] = {1, sin(omega * t), cos(omega * t)};
        if (isnan(y))
            continue;
        square += y * y;
        for (int i = 0; i < 3; i++) {
            b[i] += f[i] * y;
            for (int j = 0; j < 3; j++)
                A[i * 3 + j] += f[i] * f[j];
        }
    }
    const double right[3] = {b[0], b[1], b[2]};
    if (!moray_dense_solve(3, A, 1, b))
        return false;
    *wave = (struct wave){b[0], b[1], b[2]};
    *left += square - b[0] * right[0] - b[1] * right[1] - b[2] * right[2];
    return true;
}

static double left_at(const moray_swim_log *log, double omega, struct wave *wave)
{
    double left = 0;
    for (int i = 0; i < log->joints; i++)
        if (!fit_wave(log, i, omega, &wave[i], &left))
            return INFINITY;
    return left;
}

// A scan in steps that no minimum hides between, and golden section.
static double find_omega(const moray_swim_log *log, struct wave *wave)
{
    const double length = log->t[log->n - 1] - log->t[0], step = 1 / length, most = M_PI * (log->n - 1) / length / 3;
    const moray_swim_log middle = {.n = log->n, .joints = log->joints, .t = log->t, .phi = log->phi};
    double best = INFINITY, omega = NAN, left;
    for (double at = 4 * step; at < most; at += step) {
        struct wave one;
        left = 0;
        if (fit_wave(&middle, log->joints / 2, at, &one, &left) && left < best)
            best = left, omega = at;
    }
    double low = omega - step, high = omega + step;
    for (int k = 0; k < FINE; k++) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        if (left_at(log, a, wave) < left_at(log, b, wave))
            high = b;
        else
            low = a;
    }
    return (low + high) / 2;
}

static double taper_at(int i, int joints)
{
    return joints > 1 ? 2.0 * i / (joints - 1) - 1 : 0;
}

// amplitude, omega, delta, offset, taper, phase of the first joint at the first row
static void first_guess(const struct wave *wave, int joints, double omega, double at[PARAMETERS])
{
    double turn_c = 0, turn_s = 0, along = 0, squares = 0;
    memset(at, 0, PARAMETERS * sizeof *at);
    at[1] = omega;
    for (int i = 0; i < joints; i++) {
        const double a = hypot(wave[i].p, wave[i].q), s = taper_at(i, joints);
        at[0] += a / joints;
        at[3] += wave[i].c / joints;
        along += a * s;
        squares += s * s;
        if (i + 1 < joints) { // the turn from joint to joint, summed as complex numbers
            turn_c += wave[i].p * wave[i + 1].p + wave[i].q * wave[i + 1].q;
            turn_s += wave[i].p * wave[i + 1].q - wave[i].q * wave[i + 1].p;
        }
    }
    at[2] = joints > 1 ? atan2(turn_s, turn_c) : 0;
    at[4] = squares > 0 && at[0] > 0 ? along / squares / at[0] : 0;
    double c = 0, s = 0;
    for (int i = 0; i < joints; i++) {
        c += wave[i].p * cos(i * at[2]) + wave[i].q * sin(i * at[2]);
        s += wave[i].q * cos(i * at[2]) - wave[i].p * sin(i * at[2]);
    }
    at[5] = atan2(s, c);
}

// Normal equations at a point; returns the sum of squares and how many were summed.
static double equations(const moray_swim_log *log, const double at[PARAMETERS], double A[PARAMETERS * PARAMETERS],
                        double b[PARAMETERS], int *used)
{
    double sum = 0;
    memset(A, 0, PARAMETERS * PARAMETERS * sizeof *A);
    memset(b, 0, PARAMETERS * sizeof *b);
    *used = 0;
    for (int k = 0; k < log->n * log->joints; k++) {
        const int i = k % log->joints;
        const double t = log->t[k / log->joints] - log->t[0], place = taper_at(i, log->joints);
        const double sine = sin(at[1] * t + i * at[2] + at[5]), cosine = cos(at[1] * t + i * at[2] + at[5]);
        const double size = 1 + at[4] * place, a = at[0] * size;
        const double f[PARAMETERS] = {size * sine, a * t * cosine, a * i * cosine, 1, at[0] * place * sine, a * cosine};
        const double r = log->phi[k] - a * sine - at[3];
        if (isnan(r))
            continue;
        sum += r * r;
        ++*used;
        for (int p = 0; p < PARAMETERS; p++) {
            b[p] += f[p] * r;
            for (int q = 0; q < PARAMETERS; q++)
                A[p * PARAMETERS + q] += f[p] * f[q];
        }
    }
    if (log->joints == 1) // neither delta nor taper
        A[2 * PARAMETERS + 2] = A[4 * PARAMETERS + 4] = 1;
    return sum;
}

moray_status moray_motion_fit_gait(struct motion *m, const moray_swim_log *log)
{
    double at[PARAMETERS], A[PARAMETERS * PARAMETERS], b[PARAMETERS];
    int used;
    struct wave *wave = calloc((size_t)log->joints, sizeof *wave);
    if (!wave)
        return moray_error(MORAY_MEMORY, "no memory for %d joints", log->joints);
    const double omega = find_omega(log, wave), left = left_at(log, omega, wave);
    first_guess(wave, log->joints, omega, at);
    free(wave);
    for (int k = 0; k < POLISH && isfinite(left); k++) {
        equations(log, at, A, b, &used);
        if (!moray_dense_solve(PARAMETERS, A, 1, b))
            return moray_error(MORAY_NUMERIC, "log %s: the joints follow no gait (25)", log->name);
        for (int p = 0; p < PARAMETERS; p++)
            at[p] += b[p];
    }
    const double sum = equations(log, at, A, b, &used);
    if (!isfinite(sum) || used <= PARAMETERS || !(at[0] > 0) || !(at[1] > 0))
        return moray_error(MORAY_NUMERIC, "log %s: the joints follow no gait (25)", log->name);
    m->gait = (moray_gait){.amplitude = at[0], .omega = at[1], .delta = at[2], .offset = at[3], .taper = at[4]};
    m->shift = at[5] / at[1] - log->t[0];
    m->rms = sqrt(sum / (used - PARAMETERS));
    return moray_ok();
}
