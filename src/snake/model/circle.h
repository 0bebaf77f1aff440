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

// Of a complex step, whose imaginary part y is so small that cosh y rounds to 1 and sinh y to y, two real functions
// give what ccos and csin work out from eight.
static inline void circle_z(double complex angle, double complex *c, double complex *s)
{
    double cosine, sine;
    const double y = cimag(angle);
    if (!(fabs(y) < 1e-9)) {
        *c = ccos(angle);
        *s = csin(angle);
        return;
    }
    circle_d(creal(angle), &cosine, &sine);
    *c = moray_complex(cosine, -sine * y);
    *s = moray_complex(sine, cosine * y);
}

#endif
