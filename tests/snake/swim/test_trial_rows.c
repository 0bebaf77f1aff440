// SPDX-License-Identifier: MIT
//
// Tables of trials, in the units that people read, from trials of given numbers.
#include "degree.h"
#include "tap.h"

#include <math.h>
#include <string.h>

#include "moray/snake/trial.h"

static const moray_table_row *row_of(const moray_table_row *rows, int n, const char *label)
{
    for (int k = 0; k < n; k++)
        if (strcmp(rows[k].label, label) == 0)
            return &rows[k];
    return NULL;
}

static void check_row(const moray_table_row *rows, int n, const char *label, double first, double second)
{
    const moray_table_row *row = row_of(rows, n, label);
    CHECK(row && fabs(row->value[0] - first) < 1e-9 && fabs(row->value[1] - second) < 1e-9,
          "%s: %g and %g, not %g and %g", label, row ? row->value[0] : NAN, row ? row->value[1] : NAN, first, second);
}

// Two gaits that steer to either side.
static void test_gaits(void)
{
    const moray_robot robot = moray_robot_paper();
    moray_gait_trial left = {0}, right = {0};
    left.gait[MORAY_CONTROL_ORIENTED] =
        (moray_gait){.amplitude = 0.05, .omega = 120 * DEG, .delta = 40 * DEG, .offset = 0.01};
    left.gait[MORAY_FIRST_PRINCIPLES] =
        (moray_gait){.amplitude = 12 * DEG, .omega = 120 * DEG, .delta = 40 * DEG, .offset = 3 * DEG};
    right = left;
    right.gait[MORAY_CONTROL_ORIENTED].offset = -0.01;
    right.gait[MORAY_FIRST_PRINCIPLES].offset = -3 * DEG;
    const moray_gait_trial *const trials[] = {&left, &right};
    moray_table_row rows[MORAY_TRIAL_ROWS];
    int n = moray_gait_rows(&robot, trials, 2, rows);
    check_row(rows, n, "phi_0, control-oriented", 1, -1);
    check_row(rows, n, "phi_0, first-principles", 3, -3);
    check_row(rows, n, "omega, frequency", 120, 120);
    check_row(rows, n, "delta, phase shift", 40, 40);
    check_row(rows, n, "a, by (33)", 5, 5);
    check_row(rows, n, "alpha, by (27)", 12, 12);
    CHECK(!row_of(rows, n, "taper of the amplitude"), "no taper, no row of it");
    left.gait[MORAY_CONTROL_ORIENTED].offset = -1e-12; // a zero of the solver
    right.gait[MORAY_CONTROL_ORIENTED].taper = right.gait[MORAY_FIRST_PRINCIPLES].taper = -0.3;
    n = moray_gait_rows(&robot, trials, 2, rows);
    check_row(rows, n, "phi_0, control-oriented", 0, -1);
    check_row(rows, n, "taper of the amplitude", 0, -0.3);
    const double head = row_of(rows, n, "theta_max of the head, by (27)")->value[1],
                 tail = row_of(rows, n, "theta_max of the tail, by (27)")->value[1];
    right.gait[MORAY_FIRST_PRINCIPLES].taper = 0.3;
    n = moray_gait_rows(&robot, trials, 2, rows);
    check_row(rows, n, "theta_max of the tail, by (27)", row_of(rows, n, "theta_max of the tail, by (27)")->value[0],
              head);
    CHECK(head < tail && fabs(row_of(rows, n, "theta_max of the head, by (27)")->value[1] - tail) < 1e-9,
          "a taper turned round is the robot turned round");
}

// In a current the speed along the course is another, and the work along it is told.
static void test_steady(void)
{
    const moray_robot robot = moray_robot_paper();
    moray_gait_trial still = {0}, drifting = {0};
    still.steady[MORAY_FIRST_PRINCIPLES] = (moray_steady){.speed = 0.2,
                                                          .v_x = 0.2,
                                                          .power = 1.5,
                                                          .cost_of_transport = 7.5,
                                                          .peak_effort = 0.4,
                                                          .peak_link_angle = 25 * DEG};
    still.held[MORAY_FIRST_PRINCIPLES] = true;
    drifting = still;
    const moray_gait_trial *const trials[] = {&still, &drifting};
    moray_table_row rows[MORAY_TRIAL_ROWS];
    int n = moray_steady_rows(&robot, MORAY_FIRST_PRINCIPLES, trials, 2, 0, rows);
    check_row(rows, n, "speed through the water", 0.2, 0.2);
    check_row(rows, n, "speed along the course", 0.2, 0.2);
    check_row(rows, n, "cost of transport", 7.5, 7.5);
    check_row(rows, n, "peak joint torque", 0.4, 0.4);
    check_row(rows, n, "largest link angle from heading", 25, 25);
    CHECK(!row_of(rows, n, "joint work along the course"),
          "without a current the work along the course is that through the water");
    drifting.steady[MORAY_FIRST_PRINCIPLES].v_x = 0.1;
    n = moray_steady_rows(&robot, MORAY_FIRST_PRINCIPLES, trials, 2, 0, rows);
    check_row(rows, n, "speed along the course", 0.2, 0.1);
    check_row(rows, n, "joint work along the course", 7.5, 15);
    drifting.held[MORAY_FIRST_PRINCIPLES] = false;
    moray_steady_rows(&robot, MORAY_FIRST_PRINCIPLES, trials, 2, 0, rows);
    CHECK(isnan(row_of(rows, n, "speed along the course")->value[1]),
          "a course that is not held has no speed along it");
}

// By links: 15 to 90 deg for those whose paper's gait has 40 deg, and what that is of a shorter or longer robot's.
static void test_usual_delta(void)
{
    static const double expected[][3] = {
        {10, 15, 90}, {5, 15, 150}, {8, 15, 2.25 * 360 / 7}, {31, 4.5, 90}, {401, 1, 90}};
    for (int k = 0; k < 5; k++) {
        moray_robot robot = moray_robot_paper();
        robot.links = (int)expected[k][0];
        const moray_bounds delta = moray_gait_usual_delta(&robot);
        CHECK_NEAR(delta.lower / DEG, expected[k][1], 1e-12, "least delta [deg]");
        CHECK_NEAR(delta.upper / DEG, expected[k][2], 1e-12, "most delta [deg]");
    }
}

int main(void)
{
    test_gaits();
    test_steady();
    test_usual_delta();
    return tap_done();
}
