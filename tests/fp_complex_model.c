// SPDX-License-Identifier: MIT
#include "fp_complex.h"

#include <stddef.h>
#include <tgmath.h>

#include "moray/num.h"

static inline void circle_z(double complex angle, double complex *c, double complex *s)
{
    *c = moray_cos(angle);
    *s = moray_sin(angle);
}

#define REAL double complex
#define TYPED(name) name##_z
#include "snake/model/fp_motor.inc"
#include "snake/model/fp_drag.inc"
#include "snake/model/fp_core.inc"
