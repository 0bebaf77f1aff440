// SPDX-License-Identifier: MIT
//
// Cosine and sine of one angle, real or complex.
#ifndef SRC_SNAKE_MODEL_CIRCLE_H
#define SRC_SNAKE_MODEL_CIRCLE_H

#include <complex.h>
#include <math.h>

#include "moray/num.h"

static inline void circle_d(double angle, double *c, double *s)
{
    *c = cos(angle);
    *s = sin(angle);
}

static inline void circle_z(double complex angle, double complex *c, double complex *s)
{
    *c = moray_cos(angle);
    *s = moray_sin(angle);
}

#endif
