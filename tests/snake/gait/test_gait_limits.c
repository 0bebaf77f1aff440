// SPDX-License-Identifier: MIT
//
// The limits of a gait that follow from what is asked for and from what the motors give.
#include "tap.h"

#include "snake/gait/problem.h"

// The supply limits the rate of the revolute joints, whose motors it drives, where that is known.
static void check_rate(moray_model model, double limit, double supply, double expected)
{
    moray_gait_problem_spec spec = {.model = model};
    spec.limits.joint_rate = limit;
    spec.robot.supply.rate = supply;
    CHECK(moray_gait_most_rate(&spec) == expected, "model %d, limits %g and %g: %g, not %g", model, limit, supply,
          moray_gait_most_rate(&spec), expected);
}

int main(void)
{
    check_rate(MORAY_FIRST_PRINCIPLES, 3, 2, 2);
    check_rate(MORAY_FIRST_PRINCIPLES, 2, 3, 2);
    check_rate(MORAY_FIRST_PRINCIPLES, 3, 0, 3);
    check_rate(MORAY_FIRST_PRINCIPLES, MORAY_INFINITY, 0, MORAY_INFINITY);
    check_rate(MORAY_FIRST_PRINCIPLES, MORAY_INFINITY, 4, 4);
    check_rate(MORAY_CONTROL_ORIENTED, 3, 2, 3);
    return tap_done();
}
