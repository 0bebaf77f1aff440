// SPDX-License-Identifier: MIT
//
// First-principles ("fp") model, for two number types from one text: name_d of double, and name_z of double
// complex for derivatives by complex step.
#ifndef SRC_SNAKE_MODEL_FP_MODEL_H
#define SRC_SNAKE_MODEL_FP_MODEL_H

#include <complex.h>

#include "snake/model/fp_robot.h"

#define REAL double
#define TYPED(name) name##_d
#include "snake/model/fp_core.h"
#undef REAL
#undef TYPED

#define REAL double complex
#define TYPED(name) name##_z
#include "snake/model/fp_core.h"
#undef REAL
#undef TYPED

#endif
