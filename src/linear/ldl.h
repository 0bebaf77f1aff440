// SPDX-License-Identifier: MIT
//
// Sparse symmetric indefinite matrices of one pattern: P S A S P' = L D L', D of 1x1 and 2x2 blocks, S diagonal.
// Ordered once, with the first values; factored for every set of values; solved with any number of right-hand sides.
// An object belongs to one thread at a time, different objects are independent.
#ifndef SRC_LINEAR_LDL_H
#define SRC_LINEAR_LDL_H

#include "moray/map.h"

typedef struct moray_ldl moray_ldl;

typedef struct moray_ldl_inertia {
    int positive, negative, zero; // eigenvalues; zero: columns in which nothing but rounding was left
} moray_ldl_inertia;

typedef struct moray_ldl_statistics {
    int fronts, largest;  // how many; rows of the largest
    int pairs;            // of an unknown and another that the order keeps together as a 2x2 pivot
    int delayed;          // pivots that the last factorisation passed up the tree, each counted as often
    int pivots_2x2;       // of the last factorisation
    int factors, solves;  // so far
    int orders;           // so far
    double planned, done; // multiplications and additions of a factorisation without delays; of the last one
    double entries;       // in the factors, without delays
    double filled;        // in the factors, with delays, at most so far
    double error; // backward error of the last solve: residual over matrix times solution, in the scale of the factors
} moray_ldl_statistics;

// Copies the pattern of an n x n matrix: each entry off the diagonal in one of the triangles, whichever; repeated
// entries are added up. Error: MORAY_INPUT for an entry outside the matrix, MORAY_MEMORY.
moray_status moray_ldl_new(moray_ldl **ldl, int n, const moray_pattern *pattern);
void moray_ldl_free(moray_ldl *ldl);

// Factors the matrix of values[nnz], in the pattern's order. A pivot smaller than threshold (0 to 1/2) times its column
// is passed on; 1e-8 is fast, 1e-2 is safe. A singular matrix is factored too: see the inertia. Error: MORAY_NUMERIC
// when the values are not finite, MORAY_NOT_SOLVED when delayed pivots fill the factors to more than 8 times what the
// pattern says even in an order made for these values, MORAY_MEMORY; then there is nothing to solve with.
moray_status moray_ldl_factor(moray_ldl *ldl, const double *values, double threshold);

// Solves A X = B for B[columns][n]; X takes its place. Where A is singular and B in its range, X is one of the
// solutions. Error: MORAY_NUMERIC without factors.
moray_status moray_ldl_solve(moray_ldl *ldl, int columns, double *B);

// Of the factored matrix; all 0 without factors.
moray_ldl_inertia moray_ldl_inertia_of(const moray_ldl *ldl);
moray_ldl_statistics moray_ldl_statistics_of(const moray_ldl *ldl);

// Whether the object's pattern is this one, entry by entry.
bool moray_ldl_has_pattern(const moray_ldl *ldl, int n, const moray_pattern *pattern);

#endif
