// SPDX-License-Identifier: MIT
//
// Pieces of the sensitivities: which constraints are active, and the factors of the KKT matrix that they make.
#ifndef SRC_NLP_SENSITIVITY_H
#define SRC_NLP_SENSITIVITY_H

#include "moray/nlp.h"
#include "linear/klu.h"

enum activity { INACTIVE, AT_LOWER, AT_UPPER, EQUAL };

// Constraints are numbered rows first, then bounds of the columns.
struct moray_nlp_sensitivity {
    const moray_nlp *nlp;
    const moray_iterate *at;
    enum activity *activity; // [m + n]
    bool *weak;              // [m + n]
    double *jac, *hess, *gradient;
    double *values, *rhs, *residual, *solution; // [entries], [n + m] each
    moray_pattern pattern;
    sparse_lu *lu;
};

// Of the objective, as the solver sees it.
double moray_objective_scale(const moray_nlp *nlp);

// Fills activity and weak from multipliers and slacks.
void moray_find_activity(moray_nlp_sensitivity *sensitivity);

// d/dp of one bound of a constraint.
double moray_bound_slope(const moray_nlp *nlp, const moray_nlp_shift *shift, int constraint, bool upper);

#endif
