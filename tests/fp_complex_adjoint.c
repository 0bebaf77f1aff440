// SPDX-License-Identifier: MIT
#include "fp_complex.h"

#include <stddef.h>
#include <tgmath.h>

#define REAL double complex
#define TYPED(name) name##_z
#include "snake/model/fp_motor.inc"
#include "snake/model/fp_slopes.inc"
#include "snake/model/fp_adjoint.inc"
