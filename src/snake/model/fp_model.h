// SPDX-License-Identifier: MIT
//
// First-principles ("fp") model, of double (name_d). Tests take the same text in double complex, for derivatives by
// complex step.
#ifndef SRC_SNAKE_MODEL_FP_MODEL_H
#define SRC_SNAKE_MODEL_FP_MODEL_H

#include "snake/model/fp_robot.h"

#define REAL double
#define TYPED(name) name##_d
#include "snake/model/fp_core.h"
#undef REAL
#undef TYPED

#endif
