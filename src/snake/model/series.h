// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_MODEL_SERIES_H
#define SRC_SNAKE_MODEL_SERIES_H

#include "moray/snake/model.h"

// Places in moray_series.at: of p_ik for k = 1..harmonics and joint i from 0; q_ik follows `joints` places behind.
static inline int series_place(int joints, int harmonic, int joint)
{
    return joints * (2 * harmonic - 1) + joint;
}

// Adds the series and its first and second time derivative at t to phi, dphi, ddphi.
void moray_series_add(const moray_series *series, double omega, double t, double *phi, double *dphi, double *ddphi);

// What a harmonic of a series is to its coefficients: p times the one and q times the other is the harmonic's share in
// phi, phi' or phi'' (the rank), or a derivative of that by omega and t.
typedef struct series_pair {
    double p, q;
} series_pair;
enum { SERIES_RANKS = 3 };
enum { SERIES_WAVE, SERIES_OMEGA, SERIES_T, SERIES_OMEGA_OMEGA, SERIES_OMEGA_T, SERIES_T_T, SERIES_DERIVATIVES };
void moray_series_basis(int harmonic, double omega, double t, series_pair basis[SERIES_RANKS][SERIES_DERIVATIVES]);

#endif
