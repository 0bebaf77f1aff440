// SPDX-License-Identifier: MIT
#ifndef SRC_BASE_CLOCK_H
#define SRC_BASE_CLOCK_H

#include "moray/clock.h"

// Seconds that this thread has been on the processor.
double moray_thread_clock(void);

#endif
