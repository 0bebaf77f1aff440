// SPDX-License-Identifier: MIT
//
// When swimming is steady, from speeds and powers of given periods.
#include "tap.h"

#include "snake/swim/steady.h"

static void check_changes(const double before[2], const double now[2], const double earlier[2],
                          const double expected[3])
{
    const moray_steady one = {.speed = before[0], .power = before[1]}, other = {.speed = now[0], .power = now[1]};
    const steady_changes last = {.speed = earlier[0], .power = earlier[1]};
    const steady_changes found = moray_steady_changes(&one, &other, &last);
    CHECK_NEAR(found.speed, expected[0], 1e-12, "change of the speed");
    CHECK_NEAR(found.power, expected[1], 1e-12, "of the power");
    CHECK_NEAR(found.bend, expected[2], 1e-12, "the larger difference from the changes before");
}

// Of what is now, in magnitude, and of 1e-3 where that is less.
static void test_changes(void)
{
    check_changes((double[]){0.3, 2}, (double[]){0.2, 4}, (double[]){-0.4, 0.8}, (double[]){-0.5, 0.5, 0.3});
    check_changes((double[]){0.3, 2}, (double[]){0.2, 4}, (double[]){0.4, 0.8}, (double[]){-0.5, 0.5, 0.9});
    check_changes((double[]){0.1, 6}, (double[]){0.2, 4}, (double[]){0.3, 0.1}, (double[]){0.5, -0.5, 0.6});
    check_changes((double[]){0.1, 6}, (double[]){0.2, 4}, (double[]){0.4, -1.2}, (double[]){0.5, -0.5, 0.7});
    check_changes((double[]){0.1, 6}, (double[]){0.2, 4}, (double[]){-0.4, -0.4}, (double[]){0.5, -0.5, 0.9});
    check_changes((double[]){2e-4, -3}, (double[]){5e-4, -4}, (double[]){0.3, -0.25}, (double[]){0.3, -0.25, 0});
}

static void check_settled(double speed, double power, double bend, bool settled)
{
    const double agreement = 1e-7;
    const steady_changes now = {speed * agreement, power * agreement, bend * agreement};
    CHECK(moray_steady_settled(&now, agreement) == settled, "changes of %g and %g, bent by %g agreements: %d", speed,
          power, bend, settled);
}

// Both change by less than the agreement, or by less than 1e-5, a hundred times that here, at a rate that agrees.
static void test_settled(void)
{
    check_settled(0.9, -0.8, 50, true);
    check_settled(1, 0.5, 1, false);
    check_settled(0.5, -1, 1, false);
    check_settled(-1.1, 0.5, 1, false);
    check_settled(0.5, 1.1, 2, false);
    check_settled(-0.5, -1.1, 2, false);
    check_settled(90, -80, 0.9, true);
    check_settled(90, -80, 1, false);
    check_settled(-110, 2, 0.5, false);
    check_settled(2, -110, 0.5, false);
    check_settled(110, 110, 0.5, false);
}

int main(void)
{
    test_changes();
    test_settled();
    return tap_done();
}
