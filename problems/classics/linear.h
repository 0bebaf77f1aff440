// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_CLASSICS_LINEAR_H
#define PROBLEMS_CLASSICS_LINEAR_H

#include "moray/ocp.h"

// b <- M^-1 b for a definite M, which is lost.
void linear_solve3(moray_num M[3][3], moray_num *b);

#endif
