// SPDX-License-Identifier: MIT
//
// Ranges of gaits, on and beyond either end; what a robot with a constant load and a battery needs.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/budget.h"
#include "snake/swim/limits.h"

static void refused(moray_status status, const char *text)
{
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, text) == 0, "refused: %s, not %s", status.text, text);
}

static void test_ranges(void)
{
    const double unit = 0.5;
    CHECK_OK(moray_limits_check_range("x", moray_between(-2, 6), -2, 6, unit), "all of it");
    CHECK_OK(moray_limits_check_range("x", moray_between(3, 3), -2, 6, unit), "a point");
    refused(moray_limits_check_range("x", moray_between(-2.5, 3), -2, 6, unit),
            "x = -5:6: must be a range lo:hi within -4:12");
    refused(moray_limits_check_range("x", moray_between(-1, 6.5), -2, 6, unit),
            "x = -2:13: must be a range lo:hi within -4:12");
    refused(moray_limits_check_range("x", moray_between(2, 1), -2, 6, unit),
            "x = 4:2: must be a range lo:hi within -4:12");
    CHECK(moray_failed(moray_limits_check_range("x", moray_between(NAN, 1), -2, 6, unit)), "a NaN is no range");
    CHECK_OK(moray_limits_check_above_zero("power", 1e-300), "above 0");
    refused(moray_limits_check_above_zero("power", 0), "power = 0: must be above 0, or none");
    refused(moray_limits_check_above_zero("power", -2.5), "power = -2.5: must be above 0, or none");
    CHECK(moray_failed(moray_limits_check_above_zero("power", NAN)), "a NaN is not above 0");
}

static void test_gait(void)
{
    const moray_bounds theta = moray_between(0, 89 * DEG), omega = moray_between(1e-3 * DEG, 1e5 * DEG),
                       delta = moray_between(1 * DEG, 179 * DEG);
    CHECK_OK(moray_limits_check_gait(theta, omega, delta), "as wide as may be");
    refused(moray_limits_check_gait(moray_between(-1 * DEG, 20 * DEG), omega, delta),
            "theta_max_deg = -1:20: must be a range lo:hi within 0:89");
    refused(moray_limits_check_gait(moray_between(1 * DEG, 90 * DEG), omega, delta),
            "theta_max_deg = 1:90: must be a range lo:hi within 0:89");
    refused(moray_limits_check_gait(theta, moray_between(1e-4 * DEG, 5 * DEG), delta),
            "omega_deg_s = 0.0001:5: must be a range lo:hi within 0.001:100000");
    refused(moray_limits_check_gait(theta, omega, moray_between(0.5 * DEG, 40 * DEG)),
            "delta_deg = 0.5:40: must be a range lo:hi within 1:179");
    refused(moray_limits_check_gait(theta, omega, moray_between(5 * DEG, 180 * DEG)),
            "delta_deg = 5:180: must be a range lo:hi within 1:179");
}

static void test_budget(void)
{
    moray_robot robot = moray_robot_paper();
    robot.motor.fitted = false;
    robot.supply.constant = robot.supply.battery = 0;
    CHECK(!moray_budget_tells(&robot), "nothing to tell");
    const moray_budget bare = moray_budget_of(&robot, 2, 0.25, 0.2);
    CHECK(bare.whole == 2 && isnan(bare.endurance) && isnan(bare.range), "without a battery no endurance");
    CHECK_NEAR(bare.through_water, 8, 1e-15, "work along the way");
    robot.supply.constant = 3;
    CHECK(moray_budget_tells(&robot), "a load");
    robot.supply.battery = 20;
    const moray_budget full = moray_budget_of(&robot, 2, 0.25, 0.2);
    CHECK(full.joints == 2 && full.constant == 3 && full.whole == 5, "joints and load");
    CHECK_NEAR(full.through_water, 20, 1e-13, "work through the water");
    CHECK_NEAR(full.over_ground, 25, 1e-13, "over ground");
    CHECK_NEAR(full.endurance, 4, 1e-14, "hours");
    CHECK_NEAR(full.range, 4 * 3600 * 0.2, 1e-11, "range [m]");
    robot.supply.constant = 0;
    CHECK(moray_budget_tells(&robot), "a battery");
    robot.supply.battery = 0;
    robot.motor.fitted = true;
    CHECK(moray_budget_tells(&robot), "motors");
    CHECK(strcmp(moray_power_label(&robot, MORAY_FIRST_PRINCIPLES), "mean power at the motors") == 0, "at the motors");
    CHECK(strcmp(moray_power_label(&robot, MORAY_CONTROL_ORIENTED), "mean joint power") == 0, "of the joints");
    robot.motor.fitted = false;
    CHECK(strcmp(moray_power_label(&robot, MORAY_FIRST_PRINCIPLES), "mean joint power") == 0, "without motors");
    const moray_budget none = moray_budget_of(&robot, 2, 0, NAN);
    CHECK(none.through_water == INFINITY && isnan(none.over_ground), "no way, and none that is known");
}

int main(void)
{
    test_ranges();
    test_gait();
    test_budget();
    return tap_done();
}
