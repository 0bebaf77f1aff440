// SPDX-License-Identifier: MIT
//
// The most memory that a piece of work holds, by Linux's account of the process.
#include <malloc.h>
#include <stdio.h>

#include "benchmark.h"

// A number of kB in /proc/self/status; NaN where there is none.
static double kilobytes(const char *format)
{
    FILE *file = fopen("/proc/self/status", "r");
    char line[200];
    double value = NAN;
    while (file && isnan(value) && fgets(line, sizeof line, file))
        if (sscanf(line, format, &value) != 1)
            value = NAN;
    if (file)
        fclose(file);
    return value;
}

double memory_begin(void)
{
    malloc_trim(0); // what was freed before is no part of this
    FILE *file = fopen("/proc/self/clear_refs", "w");
    if (!file)
        return NAN;
    const bool reset = fputs("5", file) >= 0; // sets the peak back to what is held now
    return fclose(file) == 0 && reset ? 1024 * kilobytes("VmRSS: %lf") : NAN;
}

double memory_peak(double before)
{
    return 1024 * kilobytes("VmHWM: %lf") - before;
}
