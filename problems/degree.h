// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_DEGREE_H
#define PROBLEMS_DEGREE_H

#include "moray/angle.h"

#define DEG MORAY_DEGREE

#endif
