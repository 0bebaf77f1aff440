// SPDX-License-Identifier: MIT
//
// The period-averaged plant against means over periods of the model it is derived from, simulated by a Runge-Kutta
// integration of its own.
#include "degree.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/snake/plant.h"
#include "rk4.h"

typedef struct closed_loop {
    const moray_map *map;
    double gait[3], push; // a, omega, delta; phi_0''
} closed_loop;

static void evaluate(const closed_loop *v, double t, const double *x, double *out)
{
    double in[13];
    memcpy(in, x, 8 * sizeof *x);
    in[8] = v->push;
    memcpy(in + 9, v->gait, sizeof v->gait);
    in[12] = t;
    v->map->value(v->map->self, in, out);
}

// The eight states and the energy.
static bool rates(double t, const double *x, double *dx, void *self)
{
    evaluate(self, t, x, dx);
    return true;
}

typedef struct mean_motion {
    double speed, turning, power, heading, x, y;
} mean_motion;

// From rest for `periods`; means over the last.
static mean_motion swim(const moray_map *map, const double gait[3], const double offset[3], int periods)
{
    const double T = 2 * M_PI / gait[1];
    closed_loop v = {map, {gait[0], gait[1], gait[2]}, offset[2]};
    const moray_ode ode = {.n = 9, .rhs = rates, .self = &v};
    int steps = 300;
    const moray_integrator rk4 = {.run = rk4_run, .self = &steps};
    double x[9] = {[6] = offset[0], [7] = offset[1]}, before[9] = {0};
    for (int k = 0; k < periods; k++) {
        memcpy(before, x, sizeof x);
        rk4_run(&rk4, &ode, k * T, (k + 1) * T, x, NULL, 0, NULL, NULL);
    }
    return (mean_motion){.speed = hypot(x[1] - before[1], x[2] - before[2]) / T,
                         .turning = (x[0] - before[0]) / T,
                         .power = (x[8] - before[8]) / T,
                         .heading = x[0],
                         .x = x[1],
                         .y = x[2]};
}

static void plants(const moray_plant_spec *spec, moray_map *full, moray_map *mean)
{
    CHECK_OK(moray_control_plant(full, spec), "full plant");
    CHECK_OK(moray_average_plant(mean, spec), "averaged plant");
}

// Straight and turning, over the paper's gaits; within what the neglected fourth order in a can do.
static void test_steady(const moray_robot *robot, double theta_max_deg, double delta_deg, double offset,
                        double tolerance)
{
    const moray_plant_spec spec = {.robot = *robot, .joints = MORAY_JOINTS_STEERED};
    const double delta = delta_deg * DEG, constant[3] = {offset, 0, 0};
    const double a = moray_amplitude_from_theta_max(&spec.robot, MORAY_CONTROL_ORIENTED, theta_max_deg * DEG, delta);
    const double gait[3] = {a, 120 * DEG, delta};
    moray_map full, mean;
    plants(&spec, &full, &mean);
    const mean_motion want = swim(&full, gait, constant, 20), got = swim(&mean, gait, constant, 20);
    char name[80];
    snprintf(name, sizeof name, "theta_max %g deg, delta %g deg, phi_0 %g m", theta_max_deg, delta_deg, offset);
    CHECK(fabs(got.speed / want.speed - 1) < tolerance, "%s: speed %.5f against %.5f", name, got.speed, want.speed);
    CHECK(fabs(got.power / want.power - 1) < 2 * tolerance, "%s: power %.5f against %.5f", name, got.power, want.power);
    CHECK(fabs(got.turning - want.turning) < 2 * tolerance * fabs(want.turning) + 1e-6,
          "%s: turning at %.5f against %.5f", name, got.turning, want.turning);
    moray_map_release(&full);
    moray_map_release(&mean);
}

// A transient in a current: from rest with an offset that swings out and back over 18 s.
static void test_transient(void)
{
    const moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_STEERED, .current = {0.1, 0.1}};
    const double delta = 40 * DEG, swing[3] = {-0.015, 0.0033333, -0.00018518};
    const double a = moray_amplitude_from_theta_max(&spec.robot, MORAY_CONTROL_ORIENTED, 20 * DEG, delta);
    const double gait[3] = {a, 120 * DEG, delta};
    moray_map full, mean;
    plants(&spec, &full, &mean);
    const mean_motion want = swim(&full, gait, swing, 6), got = swim(&mean, gait, swing, 6);
    CHECK(fabs(want.heading) > 5 * DEG, "the manoeuvre turns: %.2f deg", want.heading / DEG);
    CHECK_NEAR(got.heading / DEG, want.heading / DEG, 0.4, "heading after six periods [deg]");
    CHECK_NEAR(got.x, want.x, 0.02, "position there, x [m]");
    CHECK_NEAR(got.y, want.y, 0.02, "y [m]");
    moray_map_release(&full);
    moray_map_release(&mean);
}

static void test_derivatives(int links, moray_frame frame)
{
    moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_STEERED, .current = {0.1, -0.05}};
    const double low[13] = {-3, 0, 0, -0.3, -0.3, -0.1, -0.02, -0.01, -0.02, 0.02, 1, 0.3, 0};
    const double high[13] = {3, 0, 0, 0.3, 0.3, 0.1, 0.02, 0.01, 0.02, 0.06, 3, 1.4, 3};
    unsigned long long seed = 9;
    double in[13], weight[9];
    moray_map map;
    moray_derivative_report report;
    spec.robot.links = links;
    spec.robot.hydro.frame = frame;
    CHECK_OK(moray_average_plant(&map, &spec), "plant");
    for (int i = 0; i < 13; i++)
        in[i] = tap_random(&seed, low[i], high[i]);
    for (int i = 0; i < 9; i++)
        weight[i] = tap_random(&seed, -1, 1);
    CHECK_OK(moray_check_derivatives(&map, in, weight, &report), "check");
    CHECK(report.jacobian_error < 1e-9 && report.hessian_error < 1e-7, "N = %d: Jacobian %.1e, Hessian %.1e", links,
          report.jacobian_error, report.hessian_error);
    moray_map_release(&map);
}

// Nothing of the undulation's phase is left: the averaged plant does not know the time.
static void test_no_phase(void)
{
    const moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_STEERED};
    moray_map full, mean;
    plants(&spec, &full, &mean);
    closed_loop v = {&mean, {0.045, 2, 0.7}, 0};
    const double x[8] = {0.1, 0, 0, 0.02, 0.2, 0.01, 0.01, 0};
    double out[2][9];
    for (int k = 0; k < 2; k++)
        evaluate(&v, 0.7 * k, x, out[k]);
    CHECK(memcmp(out[0], out[1], sizeof *out) == 0, "averaged: the same at any time");
    v.map = &full;
    for (int k = 0; k < 2; k++)
        evaluate(&v, 0.7 * k, x, out[k]);
    CHECK(fabs(out[0][4] - out[1][4]) > 1e-3, "full: not");
    moray_map_release(&full);
    moray_map_release(&mean);
}

// In the paper's frame the robot feels its velocity through the water alone, on whichever heading.
static void test_current(void)
{
    const double V[2] = {0.3, -0.2}, x[8] = {0.7, 1, 2, 0.1, 0.25, -0.08, 0.012, 0.004};
    moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_STEERED};
    moray_map still, moving;
    double through[8], out[2][9];
    CHECK_OK(moray_average_plant(&still, &spec), "in still water");
    memcpy(spec.current, V, sizeof V);
    CHECK_OK(moray_average_plant(&moving, &spec), "in a current");
    memcpy(through, x, sizeof x);
    through[4] -= V[0] * cos(x[0]) + V[1] * sin(x[0]);
    through[5] -= V[1] * cos(x[0]) - V[0] * sin(x[0]);
    evaluate(&(closed_loop){&moving, {0.045, 2, 0.7}, 0.01}, 0, x, out[0]);
    evaluate(&(closed_loop){&still, {0.045, 2, 0.7}, 0.01}, 0, through, out[1]);
    for (int i = 0; i < 9; i++)
        if (i != 1 && i != 2)
            CHECK_RELATIVE(out[0][i], out[1][i], 1e-13, "the same through the water");
    CHECK_RELATIVE(out[0][1], x[4] * cos(x[0]) - x[5] * sin(x[0]), 1e-14, "over ground along x");
    CHECK_RELATIVE(out[0][2], x[4] * sin(x[0]) + x[5] * cos(x[0]), 1e-14, "and along y");
    moray_map_release(&still);
    moray_map_release(&moving);
}

static void test_refusals(void)
{
    moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_ON_GAIT};
    moray_map map;
    CHECK(moray_average_plant(&map, &spec).code == MORAY_INPUT, "a form that is not steered is refused");
    spec.joints = MORAY_JOINTS_STEERED;
    spec.path_forces = true;
    CHECK(moray_average_plant(&map, &spec).code == MORAY_INPUT, "path outputs are refused");
    spec.path_forces = false;
    spec.robot.links = 1;
    CHECK(moray_average_plant(&map, &spec).code == MORAY_INPUT, "one link is refused");
}

int main(void)
{
    const double delta[] = {30, 40, 50, 60, 80};
    moray_robot robot = moray_robot_paper();
    for (int k = 0; k < 5; k++)
        for (int turn = 0; turn < 2; turn++) {
            test_steady(&robot, 10, delta[k], turn * 0.0075, 1e-3);
            test_steady(&robot, 20, delta[k], turn * 0.0075, 2e-3);
        }
    test_steady(&robot, 20, 40, 0.015, 2e-4);
    test_steady(&robot, 30, 30, 0.015, 5e-3);
    robot.links = 5; // the joints' waves do not cancel: the ripple counts for 0.5 % in the invariant frame
    robot.hydro.frame = MORAY_FRAME_INVARIANT;
    test_steady(&robot, 10, 40, 0, 5e-4);
    test_steady(&robot, 20, 40, 0, 2e-3);
    test_steady(&robot, 20, 60, 0, 2e-3);
    test_transient();
    for (int links = 2; links < 12; links += 3)
        for (int frame = 0; frame < 2; frame++)
            test_derivatives(links, (moray_frame)frame);
    test_no_phase();
    test_current();
    test_refusals();
    return tap_done();
}
