// SPDX-License-Identifier: MIT
//
// Gradients of the first-principles model, all at once, by hand: of a weighted sum
//     F = lambda . (mean theta'', p_x'', p_y'') + rho . u + sigma . (supply of moray_fp_supply) + pi (power)
// of what the joints' motion brings about. A unit weight gives a row of the Jacobian; fp_tangent.h has the
// Hessian.
#ifndef SRC_SNAKE_MODEL_FP_ADJOINT_H
#define SRC_SNAKE_MODEL_FP_ADJOINT_H

#include "snake/model/fp_model.h"

typedef struct fp_weights {
    const double *lambda; // [3]
    const double *rho;    // [N-1]; NULL for zeros
    const double *sigma;  // [lines (N-1)]; NULL for zeros
    double pi;
} fp_weights;

#define REAL double
#define TYPED(name) name##_d
#include "snake/model/fp_dual.h"
#undef REAL
#undef TYPED

#endif
