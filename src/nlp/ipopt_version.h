// SPDX-License-Identifier: MIT
#ifndef SRC_NLP_IPOPT_VERSION_H
#define SRC_NLP_IPOPT_VERSION_H

extern const char *const moray_ipopt_version; // that it was built with, "3.11.9"

#endif
