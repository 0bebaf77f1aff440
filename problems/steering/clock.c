// SPDX-License-Identifier: MIT
#include "clock.h"

#include <math.h>

#include "moray/clock.h"

void steer_clock_start(steer_clock *clock)
{
    clock->start = moray_clock();
    clock->until = clock->start + clock->limit;
}

void steer_clock_give(steer_clock *clock, double share)
{
    const double at = moray_clock();
    clock->until = at + share * fmax(clock->start + clock->limit - at, 0);
}

void steer_clock_divide(steer_clock *clock, double until)
{
    const double most = 0.75, at = moray_clock();
    clock->until = at + most * fmax(until - at, 0);
}

bool steer_clock_up(const steer_clock *clock)
{
    return moray_clock() >= clock->until;
}
