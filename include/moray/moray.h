// SPDX-License-Identifier: MIT
#ifndef MORAY_MORAY_H
#define MORAY_MORAY_H

#include "moray/map.h"
#include "moray/ode.h"
#include "moray/sim.h"
#include "moray/snake.h"
#include "moray/status.h"
#include "moray/swim.h"

#endif
