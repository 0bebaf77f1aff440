// SPDX-License-Identifier: MIT
//
// All that a problem of optimal control needs; underwater snake robots are in moray/snake.h.
#ifndef MORAY_MORAY_H
#define MORAY_MORAY_H

#include "moray/angle.h"
#include "moray/app/options.h"
#include "moray/app/program.h"
#include "moray/app/results.h"
#include "moray/app/run.h"
#include "moray/casadi.h"
#include "moray/clock.h"
#include "moray/control/closed_loop.h"
#include "moray/control/kalman.h"
#include "moray/control/path.h"
#include "moray/control/periodic_orbit.h"
#include "moray/control/receding_horizon.h"
#include "moray/control/tuning.h"
#include "moray/delay.h"
#include "moray/dense.h"
#include "moray/export.h"
#include "moray/fit.h"
#include "moray/key_value.h"
#include "moray/map.h"
#include "moray/nlp.h"
#include "moray/num.h"
#include "moray/number.h"
#include "moray/ocp.h"
#include "moray/ode.h"
#include "moray/parallel.h"
#include "moray/scheme.h"
#include "moray/search.h"
#include "moray/sensitivity.h"
#include "moray/sim.h"
#include "moray/status.h"
#include "moray/table.h"
#include "moray/water.h"

#endif
