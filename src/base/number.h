// SPDX-License-Identifier: MIT
//
// Numbers beside those of moray/number.h.
#ifndef SRC_BASE_NUMBER_H
#define SRC_BASE_NUMBER_H

#include <locale.h>
#include <math.h>
#include <stdbool.h>

#include "moray/number.h"

// A count as an int, rounded up: 0 where it is negative or NaN, INT_MAX where no int is as large.
int moray_count_up(double count);

bool moray_all_finite(const double *values, int n);

// The larger of two errors; a NaN, which fmax passes over, is the worst.
static inline double moray_worse(double worst, double error)
{
    return isnan(error) || error > worst ? error : worst;
}

// Ascending numbers, for qsort and bsearch.
int moray_by_value(const void *one, const void *other);

// Between these two the calling thread prints and scans numbers as the C locale has them.
locale_t moray_c_locale_begin(void);
void moray_c_locale_end(locale_t before);

#endif
