// SPDX-License-Identifier: MIT
//
// Collocation schemes: Runge-Kutta methods as tables. x(t) is a polynomial on an interval whose slope agrees with the
// dynamics at the collocated points.
#ifndef MORAY_SCHEME_H
#define MORAY_SCHEME_H

#include "moray/export.h"
#include "moray/status.h"

MORAY_BEGIN

typedef enum { MORAY_LOBATTO, MORAY_RADAU, MORAY_GAUSS } moray_family;

enum { MORAY_MAX_STAGES = 64 };

// One interval of normalised length 1. The state lives at n points 0 = node[0] < ... < node[n-1] = 1, of which those
// from `first` to `last` are collocated: the s stages of Lobatto IIIA (both ends), Radau IIA (right end) or Gauss
// (neither end). Tables are row-major. The n-1 defects are
//     sum_j P[i][j] x_j - h sum_j Q[i][j] f_j = 0,
// a row transformation of x_i - x_0 - h sum_j A[i][j] f_j = 0 in which most of Q is zero (row i needs f_i, and f_0 for
// Lobatto), scaled so that a defect is an error in x.
typedef struct moray_scheme {
    moray_family family;
    int stages, points, first, last;
    int order;    // of the error at the ends of the intervals: 2s-2, 2s-1, 2s
    double *node; // [points]
    double *A; // [points][points]: integral of the j-th stage polynomial from 0 to node i; 0 for points not collocated
    double *b; // [points]: the last row of A
    double *P, *Q;          // [points-1][points]
    int exact;              // Gauss points that integrate the stage polynomials exactly
    double *gauss, *weight; // [exact]: those and their weights
} moray_scheme;

// Builds the table of a family with s stages (Lobatto 2..64, Radau and Gauss 1..64). Lobatto with 2 and 3 stages are
// the trapezoid and Hermite-Simpson. Error: MORAY_INPUT, MORAY_MEMORY. Free with moray_scheme_free.
MORAY_API moray_status moray_scheme_new(moray_scheme *scheme, moray_family family, int stages);
MORAY_API void moray_scheme_free(moray_scheme *scheme);

// Reads "trapezoid", "hermite-simpson", "lobatto4", "radau3", "gauss2", ... Error: MORAY_INPUT saying what is allowed.
MORAY_API moray_status moray_scheme_parse(const char *name, moray_family *family, int *stages);

// At tau in [0, 1]: ell[points] values of the stage polynomials (x~' and u~), integral[points] their integrals from 0.
MORAY_API void moray_scheme_basis(const moray_scheme *scheme, double tau, double *ell, double *integral);

MORAY_END

#endif
