// SPDX-License-Identifier: MIT
//
// Ipopt tells how long its linear solver took only in a log file.
#ifndef SRC_NLP_IPOPT_TIMING_H
#define SRC_NLP_IPOPT_TIMING_H

#include <stdbool.h>

enum { ipopt_timing_level = 3 }; // of the log; lower ones leave the timing out

struct ipopt_timing {
    char path[32]; // empty: none
};

// Makes an empty temporary file for the log. False where that fails.
bool moray_ipopt_timing_open(struct ipopt_timing *timing);

// Removes it, and returns the processor seconds of the linear solver; NaN where there is no such file or line.
double moray_ipopt_timing_close(struct ipopt_timing *timing);

#endif
