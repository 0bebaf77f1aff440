// SPDX-License-Identifier: MIT
#include "series.h"

#include <complex.h>
#include <math.h>
#include <string.h>

#include "taper.h"

void series_add(const moray_series *series, double omega, double t, double *phi, double *dphi, double *ddphi)
{
    const int n = series->joints;
    for (int i = 0; i < n; i++)
        phi[i] += series->at[i];
    for (int k = 1; k <= series->harmonics; k++) {
        const double rate = k * omega, sine = sin(rate * t), cosine = cos(rate * t);
        const double *p = series->at + series_place(n, k, 0), *q = p + n;
        for (int i = 0; i < n; i++) {
            phi[i] += p[i] * sine + q[i] * cosine;
            dphi[i] += rate * (p[i] * cosine - q[i] * sine);
            ddphi[i] -= rate * rate * (p[i] * sine + q[i] * cosine);
        }
    }
}

// With r = rank the share is (k omega)^r w, where w = p sin + q cos after r derivatives by the phase k omega t.
void series_basis(int harmonic, double omega, double t, series_pair basis[SERIES_RANKS][SERIES_DERIVATIVES])
{
    const double k = harmonic, kt = k * t, s = sin(k * omega * t), c = cos(k * omega * t);
    const series_pair turned[] = {{s, c}, {c, -s}, {-s, -c}, {-c, s}, {s, c}};
    double rate = 1; // (k omega)^r
    for (int r = 0; r < SERIES_RANKS; r++, rate *= k * omega) {
        const double slope = r * rate / omega, curve = (r - 1) * slope / omega;
        const series_pair w = turned[r], w1 = turned[r + 1], w2 = turned[r + 2];
        const double on[SERIES_DERIVATIVES][3] = {{rate, 0, 0},
                                                  {slope, rate * kt, 0},
                                                  {0, rate * k * omega, 0},
                                                  {curve, 2 * slope * kt, rate * kt * kt},
                                                  {0, (r + 1) * rate * k, rate * k * omega * kt},
                                                  {0, 0, rate * k * omega * k * omega}};
        for (int d = 0; d < SERIES_DERIVATIVES; d++)
            basis[r][d] = (series_pair){on[d][0] * w.p + on[d][1] * w1.p + on[d][2] * w2.p,
                                        on[d][0] * w.q + on[d][1] * w1.q + on[d][2] * w2.q};
    }
}

void moray_series_of_gait(const moray_gait *gait, int joints, int harmonics, double *at)
{
    const moray_series *series = gait->series;
    const int shared = !series ? -1 : series->harmonics < harmonics ? series->harmonics : harmonics;
    memset(at, 0, (size_t)(joints * (1 + 2 * harmonics)) * sizeof *at);
    if (series)
        memcpy(at, series->at, (size_t)(joints * (1 + 2 * shared)) * sizeof *at);
    for (int i = 0; i < joints; i++) {
        const double a = gait->amplitude * (1 + gait->taper * taper_place(i, joints));
        at[i] += gait->offset;
        at[series_place(joints, 1, i)] += a * cos(i * gait->delta);
        at[series_place(joints, 1, i) + joints] += a * sin(i * gait->delta);
    }
}

// ---- The other model -----------------------------------------------------------------------------------------------

// p sin(psi) + q cos(psi) as the imaginary part of z exp(i psi)
static double complex amplitude_of(const moray_series *series, int harmonic, int joint)
{
    const double *p = series->at + series_place(series->joints, harmonic, joint);
    return p[0] + I * p[series->joints];
}

// Phase shift from joint to joint, where the wave is.
static double shift_of(const moray_series *series, int harmonic)
{
    double complex sum = 0;
    for (int i = 0; i + 1 < series->joints; i++)
        sum += amplitude_of(series, harmonic, i + 1) * conj(amplitude_of(series, harmonic, i));
    return carg(sum);
}

static int sign_of(int link)
{
    return link % 2 ? -1 : 1;
}

// Sine of a link's angle in one harmonic of (29), from that of the link before; all of them up to an alternation along
// the body, to which (29) is blind.
static double complex next_link(const moray_robot *robot, const moray_series *series, int harmonic, int link,
                                double complex before)
{
    return link == 0 ? 0 : amplitude_of(series, harmonic, link - 1) / robot->l - before;
}

// The c of the alternation +-c that belongs to links 0, 1, ..: it leaves least of
// theta_{i-1} - 2 cos(delta) theta_i + theta_{i+1}, which is 0 for a wave of phase shift delta.
static double complex alternation(const moray_robot *robot, const moray_series *series, int harmonic)
{
    const int n = series->joints;
    const double twice = 2 * cos(shift_of(series, harmonic));
    double complex before = 0, here = next_link(robot, series, harmonic, 1, 0), sum = 0;
    for (int i = 1; i < n; i++) {
        const double complex next = next_link(robot, series, harmonic, i + 1, here);
        sum += sign_of(i) * (before - twice * here + next);
        before = here;
        here = next;
    }
    return n > 1 ? sum / ((n - 1) * (2 + twice)) : here / 2;
}

// Mean amplitude of the links' angles over that of their sines, by the first harmonic.
static double stretch_of(const moray_robot *robot, const moray_series *series)
{
    const double complex c = alternation(robot, series, 1);
    double complex here = 0;
    double mean = 0;
    for (int i = 0; i <= series->joints; i++) {
        here = next_link(robot, series, 1, i, here);
        mean += cabs(here + sign_of(i) * c) / (series->joints + 1);
    }
    return mean > 0 && mean < 1 ? asin(mean) / mean : 1;
}

void moray_series_to_first_principles(const moray_robot *robot, const moray_series *series, double *at)
{
    // As with the gait (25), time starts where the first harmonics agree: a quarter of a period later.
    static const double complex later[4] = {1, I, -1, -I};
    const int n = series->joints;
    const double stretch = stretch_of(robot, series);
    for (int i = 0; i < n; i++) // erratum E3
        at[i] = -series->at[i] * stretch * fabs(tan(shift_of(series, 1) / 2)) / robot->l;
    for (int k = 1; k <= series->harmonics; k++) {
        const double complex c = alternation(robot, series, k);
        double complex here = 0;
        for (int i = 0; i < n; i++) {
            const double complex next = next_link(robot, series, k, i + 1, here);
            const double complex bend = (here - next + 2 * sign_of(i) * c) * later[k % 4] * stretch; // (1)
            at[series_place(n, k, i)] = creal(bend);
            at[series_place(n, k, i) + n] = cimag(bend);
            here = next;
        }
    }
}
