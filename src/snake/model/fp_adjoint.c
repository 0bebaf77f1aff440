// SPDX-License-Identifier: MIT
#include "snake/model/fp_adjoint.h"

#include <stddef.h>
#include <tgmath.h>

#define REAL double
#define TYPED(name) name##_d
#include "snake/model/fp_motor.inc"
#include "snake/model/fp_slopes.inc"
#include "snake/model/fp_adjoint.inc"
#undef REAL
#undef TYPED
