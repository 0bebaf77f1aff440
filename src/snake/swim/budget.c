// SPDX-License-Identifier: MIT
#include "moray/snake/budget.h"

#include <math.h>

// A speed that is not known makes no cost.
static double per_metre(double power, double speed)
{
    return speed > 0 ? power / speed : isnan(speed) ? NAN : INFINITY;
}

static bool at_motors(const moray_robot *robot, moray_model model)
{
    return robot->motor.fitted && model == MORAY_FIRST_PRINCIPLES;
}

const char *moray_power_label(const moray_robot *robot, moray_model model)
{
    return at_motors(robot, model) ? "mean power at the motors" : "mean joint power";
}

moray_budget moray_budget_of(const moray_robot *robot, double power, double speed, double course_speed)
{
    const double whole = power + robot->supply.constant, hour = 3600;
    const double endurance = robot->supply.battery > 0 ? robot->supply.battery / whole : NAN;
    return (moray_budget){.joints = power,
                          .constant = robot->supply.constant,
                          .whole = whole,
                          .through_water = per_metre(whole, speed),
                          .over_ground = per_metre(whole, course_speed),
                          .endurance = endurance,
                          .range = endurance * hour * course_speed};
}

bool moray_budget_tells(const moray_robot *robot)
{
    return robot->motor.fitted || robot->supply.constant > 0 || robot->supply.battery > 0;
}

void moray_budget_to_json(moray_json *json, const moray_robot *robot, const moray_budget *budget)
{
    if (!moray_budget_tells(robot))
        return;
    moray_json_object(json, "whole",
                      MORAY_MEMBERS({"joints_or_motors_W", budget->joints}, {"constant_W", budget->constant},
                                    {"power_W", budget->whole}, {"cost_of_transport_J_m", budget->through_water},
                                    {"course_cost_J_m", budget->over_ground}, {"endurance_h", budget->endurance},
                                    {"range_m", budget->range}));
}
