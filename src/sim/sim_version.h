// SPDX-License-Identifier: MIT
#ifndef SRC_SIM_SIM_VERSION_H
#define SRC_SIM_SIM_VERSION_H

// That of SUNDIALS as it is linked, "6.4.1", into text[size].
void moray_sundials_version(char *text, int size);

#endif
