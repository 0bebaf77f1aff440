// SPDX-License-Identifier: MIT
//
// Numbers in texts, and quantiles of many of them.
#ifndef MORAY_NUMBER_H
#define MORAY_NUMBER_H

#include <stdbool.h>

#include "moray/export.h"

MORAY_BEGIN

// A finite decimal number with nothing but blanks around it, as the C locale has them whatever locale the process has
// set; false for all other texts, hexadecimal ones among them, and NULL.
MORAY_API bool moray_number_read(const char *text, double *number);

// The quantile of values[n] at a share within 0:1, on the line between the two nearest (0.5: the median); NaN where
// there are none. Sorts them; none may be NaN.
MORAY_API double moray_quantile(double *values, long n, double share);

MORAY_END

#endif
