// SPDX-License-Identifier: MIT
#ifndef SRC_NLP_IPOPT_OPTIONS_H
#define SRC_NLP_IPOPT_OPTIONS_H

#include <IpStdCInterface.h> // the folder (coin or coin-or) is the package's business

#include "moray/nlp.h"

// Everything that Ipopt is told but the callbacks. False where it refuses something. work[n].
bool moray_ipopt_set_options(IpoptProblem problem, const moray_nlp *nlp, const moray_nlp_settings *settings,
                             moray_linear_solver solver, double *work);

#endif
