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
    text += strspn(text, blanks);
    const size_t length = strspn(text, "+-.0123456789eE");
    if (length == 0 || text[length + strspn(text + length, blanks)])
        return false;
    *number = strtod_l(text, &end, c_locale());
    return end == text + length && isfinite(*number);
}

int moray_count_up(double count)
{
    return (int)fmin(fmax(ceil(count), 0), INT_MAX);
}

locale_t moray_c_locale_begin(void)
{
    return uselocale(c_locale());
}

void moray_c_locale_end(locale_t before)
{
    uselocale(before);
}
