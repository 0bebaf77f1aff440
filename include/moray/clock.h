// SPDX-License-Identifier: MIT
//
// What time things take.
#ifndef MORAY_CLOCK_H
#define MORAY_CLOCK_H

#include "moray/export.h"

MORAY_BEGIN

// Seconds since some moment, of a clock that nobody sets: differences are times on the wall.
MORAY_API double moray_clock(void);

// Seconds that this process has been on the processor, all its threads together.
MORAY_API double moray_processor_clock(void);

MORAY_END

#endif
