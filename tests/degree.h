// SPDX-License-Identifier: MIT
#ifndef TESTS_DEGREE_H
#define TESTS_DEGREE_H

#include "moray/angle.h"

#define DEG MORAY_DEGREE

#endif
