// SPDX-License-Identifier: MIT
//
// The first-principles model and its gradient in double complex, from the texts that src takes in double: one complex
// step through them is a derivative to the last digits, by another route than src's own.
#ifndef TESTS_FP_COMPLEX_H
#define TESTS_FP_COMPLEX_H

#include <complex.h>

#include "snake/model/fp_adjoint.h"

#define REAL double complex
#define TYPED(name) name##_z
#include "snake/model/fp_core.h"
#include "snake/model/fp_dual.h"
#undef REAL
#undef TYPED

#endif
