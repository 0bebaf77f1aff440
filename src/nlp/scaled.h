// SPDX-License-Identifier: MIT
//
// A programme in its own scales. They are applied here and not by the solver, whose absolute tolerances and relaxed
// bounds would otherwise be in the user's units.
#ifndef NLP_SCALED_H
#define NLP_SCALED_H

#include "moray/nlp.h"

struct scaled_nlp {
    moray_nlp nlp;       // what the solver sees
    const moray_nlp *of; // in the user's units, with the scales
    double *bounds;      // x_lower, x_upper, g_lower, g_upper
    double *jac, *hess;  // factors of the entries
    double *x, *lambda;  // in the user's units
    double violation;    // largest, in the user's units, where the constraints were last evaluated
};

// Error: MORAY_MEMORY. Free with scaled_nlp_free, whatever was returned.
moray_status scaled_nlp_new(struct scaled_nlp *s, const moray_nlp *of);
void scaled_nlp_free(struct scaled_nlp *s);

// An iterate in the user's units <-> one of s->nlp, in place.
void scale_iterate(const struct scaled_nlp *s, moray_iterate *iterate);
void unscale_iterate(const struct scaled_nlp *s, moray_iterate *iterate);

#endif
