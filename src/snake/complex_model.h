// SPDX-License-Identifier: MIT
//
// First-principles ("complex") model, for two number types from one text: name_d of double, and name_z of double
// complex for derivatives by complex step.
#ifndef MORAY_SNAKE_COMPLEX_MODEL_H
#define MORAY_SNAKE_COMPLEX_MODEL_H

#include <complex.h>

#include "moray/snake.h"

#define REAL double
#define TYPED(name) name##_d
#include "complex_core.h"
#undef REAL
#undef TYPED

#define REAL double complex
#define TYPED(name) name##_z
#include "complex_core.h"
#undef REAL
#undef TYPED

#endif
