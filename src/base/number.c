// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // strtod_l
#include "base/number.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// glibc hands out its built-in C locale: nothing is allocated, nothing is to be freed.
static locale_t c_locale(void)
{
    return newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

bool moray_number_read(const char *text, double *number)
{
    static const char blanks[] = " \t\r\n";
    char *end;
    if (!text)
        return false;
    text += strspn(text, blanks);
    const size_t length = strspn(text, "+-.0123456789eE");
    if (length == 0 || text[length + strspn(text + length, blanks)])
        return false;
    *number = strtod_l(text, &end, c_locale());
    return end == text + length && isfinite(*number);
}

int moray_by_value(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

double moray_quantile(double *values, long n, double share)
{
    if (n < 1)
        return NAN;
    qsort(values, (size_t)n, sizeof *values, moray_by_value);
    const double at = share * (double)(n - 1);
    const long low = (long)at, high = low + 1 < n ? low + 1 : low;
    return values[low] + (at - (double)low) * (values[high] - values[low]);
}

int moray_count_up(double count)
{
    return (int)fmin(fmax(ceil(count), 0), INT_MAX);
}

bool moray_all_finite(const double *values, int n)
{
    for (int k = 0; k < n; k++)
        if (!isfinite(values[k]))
            return false;
    return true;
}

locale_t moray_c_locale_begin(void)
{
    return uselocale(c_locale());
}

void moray_c_locale_end(locale_t before)
{
    uselocale(before);
}
