// SPDX-License-Identifier: MIT
//
// Matrices [H A'; A 0] of few degrees of freedom, as gaits have: the constraints are solved for as many unknowns (the
// basis) by sparse LU factors, and what is left is a small dense matrix, H in the null space of A.
#ifndef SRC_LINEAR_NULL_SPACE_H
#define SRC_LINEAR_NULL_SPACE_H

#include "linear/ldl.h"

typedef struct null_space null_space;

// As moray_ldl_new, for a pattern whose last rows, the constraints, meet none of each other. *result <- NULL where
// there are no such rows or too many degrees of freedom. Error: MORAY_MEMORY.
moray_status moray_null_space_new(null_space **result, int n, const moray_pattern *pattern);
void moray_null_space_free(null_space *ns);

// Factors the matrix of values[nnz], by the basis of the one before where that will do, else by one chosen for it.
// *fits <- false where the constraints have something on the diagonal, or no basis is regular: there is nothing to
// solve with then. Error: MORAY_NUMERIC when the values are not finite, MORAY_MEMORY.
moray_status moray_null_space_factor(null_space *ns, const double *values, bool *fits);

// The basis is given up: the next matrix has its own chosen.
void moray_null_space_forget(null_space *ns);

// As moray_ldl_solve, for one right-hand side b[n]. *error <- the residual over matrix times solution, row by row.
moray_status moray_null_space_solve(null_space *ns, double *b, double *error);

moray_ldl_inertia moray_null_space_inertia(const null_space *ns);

#endif
