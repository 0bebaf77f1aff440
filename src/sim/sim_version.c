// SPDX-License-Identifier: MIT
#include "sim/sim_version.h"

#include <sundials/sundials_version.h>

void moray_sundials_version(char *text, int size)
{
    if (SUNDIALSGetVersion(text, size) != 0)
        text[0] = 0;
}
