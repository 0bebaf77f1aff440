// SPDX-License-Identifier: MIT
//
// What a steady gait costs all told: the joints or their motors, and what the robot draws besides; how long and how far
// a battery lasts.
#ifndef MORAY_SNAKE_BUDGET_H
#define MORAY_SNAKE_BUDGET_H

#include "moray/app/results.h"
#include "moray/export.h"
#include "moray/snake/model.h"

MORAY_BEGIN

// Where the mean power of a model is counted: "mean power at the motors", or "mean joint power" without them.
MORAY_API const char *moray_power_label(const moray_robot *robot, moray_model model);

typedef struct moray_budget {
    double joints, constant, whole;    // mean power: of joints or motors, of all else, of both [W]
    double through_water, over_ground; // whole power over the speed [J/m]; infinite where it makes no way
    double endurance, range;           // of the battery [h], [m] over ground; NaN without
} moray_budget;

// Of a mean power [W], speed through the water and along the course [m/s]; where one of them is NAN, as of a course
// that is not held, what depends on it is.
MORAY_API moray_budget moray_budget_of(const moray_robot *robot, double power, double speed, double course_speed);

// Whether the robot has motors, a constant load or a battery, so that there is more to tell than its joint power.
MORAY_API bool moray_budget_tells(const moray_robot *robot);

// "whole"; nothing where there is no more to tell.
MORAY_API void moray_budget_to_json(moray_json *json, const moray_robot *robot, const moray_budget *budget);

MORAY_END

#endif
