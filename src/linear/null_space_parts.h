// SPDX-License-Identifier: MIT
#ifndef SRC_LINEAR_NULL_SPACE_PARTS_H
#define SRC_LINEAR_NULL_SPACE_PARTS_H

#include "linear/basis.h"
#include "linear/null_space.h"

struct null_space {
    int n, m, variables, freedom; // rows; constraints, which come last; n - m; variables - m
    moray_pattern pattern;        // as given
    int hessian, *source, *i, *j; // entries of H, in the pattern, and where they stand; [hessian] each
    int vain;                     // matrices for which there was no basis, after some of which none is sought
    bool solvable;                // the basis is factored, well conditioned or not
    bool planned, factored;       // it is well conditioned; and all is factored with the values at hand
    struct basis basis;
    moray_ldl *reduced;                // of Z' H Z, full lower triangle
    double *block;                     // holds the arrays below
    double *values;                    // [nnz] as factored
    double *H;                         // [hessian]
    double *Z, *HZ;                    // [variables x freedom], by rows
    double *columns;                   // [m x freedom], by columns
    double *R, *r;                     // [freedom x (freedom + 1) / 2]; [freedom]
    double *weight;                    // [variables]
    double *largest;                   // [n] entry of each row
    double *rhs, *x, *step, *residual; // [n]
};

// y[i][c] += sum over j of H[i][j] x[j][c], c < columns.
void moray_null_space_multiply(const null_space *ns, int columns, const double *x, double *y);

#endif
