// SPDX-License-Identifier: MIT
#ifndef LINEAR_H
#define LINEAR_H

#include "moray/ocp.h"

// b <- M^-1 b for a definite M, which is lost.
void linear_solve3(moray_num M[3][3], moray_num *b);

#endif
