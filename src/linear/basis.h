// SPDX-License-Identifier: MIT
//
// As many variables as there are constraints, which these determine when the others are given.
#ifndef SRC_LINEAR_BASIS_H
#define SRC_LINEAR_BASIS_H

#include "linear/klu.h"

struct basis {
    int m, variables;
    int *place;  // [variables] number of a basic one; -1 - k of the k-th other
    int *source; // entries of the pattern that are constraints', [entries]
    int *slot;   // [entries] of the square matrix that each is added to; -1 - k: of column k of the others, in row
    int *row;    // [entries] constraint
    int entries, slots;
    double *values; // [slots]; those factored last in [slots] behind them
    bool factored;
    sparse_lu *lu;
};

enum { MORAY_BASIS_VIEWS = 3 };

// Matches each constraint, which are the rows behind `variables`, with a variable whose entry there is not small, of
// few constraints rather than of many. *found <- false where there is no such matching. Error: MORAY_MEMORY.
moray_status moray_basis_choose(struct basis *basis, int variables, int m, const moray_pattern *pattern,
                                const double *values, int view, bool *found);
void moray_basis_free(struct basis *basis);

// The basis that place[] tells after it was changed. Error: as moray_basis_choose, MORAY_INPUT where it is singular
// whatever its values.
moray_status moray_basis_remake(struct basis *basis, const moray_pattern *pattern);

// Factors the columns of the basis; nothing is done where the values are those of the time before. values: as of the
// whole pattern. Error: MORAY_NUMERIC where they are singular, MORAY_MEMORY.
moray_status moray_basis_factor(struct basis *basis, const double *values);

// The same of values that are wrong by a share of 1e-14: what is singular to the last digit then shows the direction
// that it lacks. Never of use for a solution.
moray_status moray_basis_factor_nearly(struct basis *basis, const double *values);

// columns[others][m] <- the columns that are not in the basis.
void moray_basis_others(const struct basis *basis, const double *values, double *columns);

#endif
