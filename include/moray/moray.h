// SPDX-License-Identifier: MIT
#ifndef MORAY_MORAY_H
#define MORAY_MORAY_H

#include "moray/app.h"
#include "moray/dense.h"
#include "moray/gait_input.h"
#include "moray/gait_problem.h"
#include "moray/gait_search.h"
#include "moray/gait_trial.h"
#include "moray/heading.h"
#include "moray/helm.h"
#include "moray/map.h"
#include "moray/nlp.h"
#include "moray/num.h"
#include "moray/ocp.h"
#include "moray/ode.h"
#include "moray/orbit.h"
#include "moray/path.h"
#include "moray/recede.h"
#include "moray/results.h"
#include "moray/run.h"
#include "moray/scheme.h"
#include "moray/search.h"
#include "moray/sensitivity.h"
#include "moray/sim.h"
#include "moray/snake.h"
#include "moray/status.h"
#include "moray/steering.h"
#include "moray/swim.h"
#include "moray/turn.h"
#include "moray/voyage.h"

#endif
