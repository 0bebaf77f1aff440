// SPDX-License-Identifier: MIT
#include "snake/model/series.h"

#include <complex.h>
#include <math.h>
#include <string.h>

#include "snake/model/taper.h"

void moray_series_add(const moray_series *series, double omega, double t, double *phi, double *dphi, double *ddphi)
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
void moray_series_basis(int harmonic, double omega, double t, series_pair basis[SERIES_RANKS][SERIES_DERIVATIVES])
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

// Phase shift from joint to joint, over both neighbours where there are two.
static double shift_at(const moray_series *series, int harmonic, int joint)
{
    const int last = series->joints - 1, from = joint > 0 ? joint - 1 : 0, to = joint < last ? joint + 1 : last;
    double shift = 0;
    for (int i = from; i < to; i++)
        shift += carg(amplitude_of(series, harmonic, i + 1) * conj(amplitude_of(series, harmonic, i)));
    return to > from ? shift / (to - from) : 0;
}

// What turns an amplitude of the control-oriented model into that of the other where the wave of link angles has an
// amplitude of `angle` and the phase shift delta; of either sign, as delta is.
static double ratio(const moray_robot *robot, double delta, double angle)
{
    const double stretch = angle > 0 ? sin(angle) / angle : 1; // of (33) over (27)
    return tan(delta / 2) / (robot->l * stretch);
}

void moray_series_to_first_principles(const moray_robot *robot, const moray_series *series, double *at)
{
    // The wave of (1) is a quarter of a period behind that of (29), at each harmonic of its own; as with the gait (25),
    // time starts where the first harmonics agree.
    static const double complex quarter[4] = {-I, 1, I, -1};
    const int n = series->joints;
    double middle = 0; // amplitude of link angles, of the joints' mean
    for (int i = 0; i < n; i++)
        middle += moray_theta_max_from_amplitude(robot, MORAY_CONTROL_ORIENTED, cabs(amplitude_of(series, 1, i)),
                                                 shift_at(series, 1, i)) /
                  n;
    for (int i = 0; i < n; i++)
        at[i] = -series->at[i] * ratio(robot, fabs(shift_at(series, 1, i)), middle); // erratum E3
    for (int k = 1; k <= series->harmonics; k++)
        for (int i = 0; i < n; i++) {
            const double complex z = amplitude_of(series, k, i) * quarter[k % 4];
            const double factor = ratio(robot, shift_at(series, k, i), middle);
            at[series_place(n, k, i)] = creal(z) * factor;
            at[series_place(n, k, i) + n] = cimag(z) * factor;
        }
}
