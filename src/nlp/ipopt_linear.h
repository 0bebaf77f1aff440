// SPDX-License-Identifier: MIT
//
// Our factorisation behind Ipopt: Ipopt calls its MA57 through function pointers that a program may set.
#ifndef SRC_NLP_IPOPT_LINEAR_H
#define SRC_NLP_IPOPT_LINEAR_H

#include "linear/kkt_factors.h"

// What one solve of Ipopt asks for; Ipopt analyses the same pattern again at each restoration.
enum { ipopt_linear_patterns = 4 };
struct ipopt_linear {
    kkt_factors *kkt[ipopt_linear_patterns];
    int patterns;
    double (*clock)(void);      // that its calls are timed by
    double seconds;             // spent in them
    moray_status failure;       // MORAY_NOT_SOLVED: another linear solver may do better; MORAY_MEMORY
    double error;               // largest backward error of a solution
    struct ipopt_linear *outer; // of a solve within a callback of another one
};

// Whether Ipopt has such pointers (3.14 has none).
bool moray_ipopt_linear_available(void);

// Between the two, calls of Ipopt in this thread come to `linear`, timed by the clock. Close frees its factors, not
// what it has found out.
void moray_ipopt_linear_open(struct ipopt_linear *linear, double (*clock)(void));
void moray_ipopt_linear_close(struct ipopt_linear *linear);

// Whether what Ipopt found, or failed at, is worth being found out again with another linear solver: MORAY_NOT_SOLVED
// says why. Error: MORAY_MEMORY.
moray_status moray_ipopt_linear_verdict(const struct ipopt_linear *linear, bool failed);

// Lets Ipopt look for an MA57 of its own in libhsl.so.
void moray_ipopt_linear_stand_back(void);

#endif
