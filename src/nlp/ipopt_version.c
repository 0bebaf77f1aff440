// SPDX-License-Identifier: MIT
#include "nlp/ipopt_version.h"

#include <IpoptConfig.h>

const char *const moray_ipopt_version = IPOPT_VERSION;
