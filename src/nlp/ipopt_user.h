// SPDX-License-Identifier: MIT
//
// Options of Ipopt that the user gives by name.
#ifndef SRC_NLP_IPOPT_USER_H
#define SRC_NLP_IPOPT_USER_H

#include <IpStdCInterface.h>

#include "moray/nlp.h"

// Sets them on a problem, after all others; print_level is left out for moray_ipopt_print_level. Nothing is printed.
// Error: MORAY_INPUT naming the option, MORAY_MEMORY.
moray_status moray_ipopt_set_user(IpoptProblem problem, const moray_nlp_settings *settings);

// The level of the log: that of the user's options, or of the settings. Error: MORAY_INPUT.
moray_status moray_ipopt_print_level(const moray_nlp_settings *settings, int *level);

#endif
