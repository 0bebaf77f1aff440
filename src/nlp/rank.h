// SPDX-License-Identifier: MIT
//
// What a set of constraints can and cannot do to first order, from one sparse factorisation of
//     [I J'; J -r I]
// with the Jacobian J of some rows in some columns, and a regularisation r.
#ifndef SRC_NLP_RANK_H
#define SRC_NLP_RANK_H

#include "moray/nlp.h"

// The rows and columns that take part, and J in the order of the programme's pattern.
struct selection {
    const moray_nlp *nlp;
    const double *jac;
    const bool *rows, *cols; // [m], [n]
};

// The combination of rows, each normalised, that is nearest to nothing: weight[m] of norm 1, and the norm of what it
// comes to. Error: MORAY_MEMORY, MORAY_NUMERIC.
moray_status moray_nlp_dependent_rows(const struct selection *selection, double *weight, double *norm);

// violation[m] <- the part of it that no change of the columns would remove. Error: MORAY_MEMORY, MORAY_NUMERIC.
moray_status moray_nlp_unremovable(const struct selection *selection, double *violation);

#endif
