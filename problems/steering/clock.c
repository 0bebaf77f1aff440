// SPDX-License-Identifier: MIT
#include "clock.h"

#include <math.h>
#include <time.h>

static double now(void)
{
    struct timespec at;
    clock_gettime(CLOCK_MONOTONIC, &at);
    return (double)at.tv_sec + 1e-9 * (double)at.tv_nsec;
}

void steer_clock_start(steer_clock *clock)
{
    clock->start = now();
    clock->until = clock->start + clock->limit;
}

void steer_clock_give(steer_clock *clock, double share)
{
    const double at = now();
    clock->until = at + share * fmax(clock->start + clock->limit - at, 0);
}

bool steer_clock_up(const steer_clock *clock)
{
    return now() >= clock->until;
}
