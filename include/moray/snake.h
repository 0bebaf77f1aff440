// SPDX-License-Identifier: MIT
//
// Underwater snake robots: models, plants, steady swimming, gaits, steering.
#ifndef MORAY_SNAKE_H
#define MORAY_SNAKE_H

#include "moray/snake/budget.h"
#include "moray/snake/closed_loop.h"
#include "moray/snake/controllers.h"
#include "moray/snake/gait_input.h"
#include "moray/snake/gait_over.h"
#include "moray/snake/gait_problem.h"
#include "moray/snake/gait_search.h"
#include "moray/snake/heading.h"
#include "moray/snake/heading_law.h"
#include "moray/snake/identify.h"
#include "moray/snake/instruments.h"
#include "moray/snake/ladder.h"
#include "moray/snake/model.h"
#include "moray/snake/motor.h"
#include "moray/snake/moving_horizon.h"
#include "moray/snake/navigator.h"
#include "moray/snake/options.h"
#include "moray/snake/orbit.h"
#include "moray/snake/path.h"
#include "moray/snake/plant.h"
#include "moray/snake/poincare.h"
#include "moray/snake/receding_horizon.h"
#include "moray/snake/robust.h"
#include "moray/snake/scene.h"
#include "moray/snake/steering.h"
#include "moray/snake/swim.h"
#include "moray/snake/trial.h"
#include "moray/snake/turn.h"

#endif
