// SPDX-License-Identifier: MIT
#ifndef SRC_NLP_IPOPT_OPTIONS_H
#define SRC_NLP_IPOPT_OPTIONS_H

#include <IpStdCInterface.h> // the folder (coin or coin-or) is the package's business

#include "moray/nlp.h"

// Ipopt 3.11 declares as not constant what it only reads: texts, bounds, scales.
static inline void *moray_for_ipopt(const void *read)
{
    union {
        const void *read;
        void *declared;
    } pointer = {read};
    return pointer.declared;
}

// Everything that Ipopt is told but the callbacks. False where it refuses something. work[n].
bool moray_ipopt_set_options(IpoptProblem problem, const moray_nlp *nlp, const moray_nlp_settings *settings,
                             moray_linear_solver solver, double *work);

#endif
