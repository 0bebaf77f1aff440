// SPDX-License-Identifier: MIT
#include "moray/app/results.h"

#include <math.h>
#include <stdlib.h>

#include "base/number.h"

// Any decimal of up to 15 digits survives the way through a double, so %.15g prints it if there is one.
const char *moray_number_text(double value, char text[32])
{
    const locale_t before = moray_c_locale_begin();
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, 32, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    moray_c_locale_end(before);
    if (isnan(value))
        snprintf(text, 32, "nan"); // without the sign that printf gives some
    return text;
}
