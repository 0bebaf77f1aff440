// SPDX-License-Identifier: MIT
#include "moray/clock.h"

#include <time.h>

static double seconds(clockid_t clock)
{
    struct timespec at;
    clock_gettime(clock, &at);
    return (double)at.tv_sec + 1e-9 * (double)at.tv_nsec;
}

double moray_clock(void)
{
    return seconds(CLOCK_MONOTONIC);
}

double moray_processor_clock(void)
{
    return seconds(CLOCK_PROCESS_CPUTIME_ID);
}
