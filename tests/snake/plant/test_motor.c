// SPDX-License-Identifier: MIT
//
// Motors behind the joints: power at the terminals against what each term says, a motor of no size against none, the
// plants' derivatives, what tables are refused.
#include <stdlib.h>
#include <string.h>

#include "moray/snake/plant.h"
#include "random_robot.h"

// No smoothing to speak of.
static void test_power(random_seed *seed)
{
    double worst = 0, back = 0;
    for (int trial = 0; trial < 400; trial++) {
        moray_motor motor = random_motor(seed);
        motor.smooth_rate = motor.smooth_power = 1e-9;
        const double u = tap_random(seed, -3, 3), v = tap_random(seed, -3, 3);
        const double u_m = u + (v < 0 ? -motor.friction : motor.friction) + motor.viscous * v, p = u_m * v;
        const double want = (p > 0 ? p / motor.forward : p * motor.backward) + motor.copper * u_m * u_m;
        worst = tap_worse(worst, fabs(moray_motor_power(&motor, u, v) - want) / (1 + fabs(want)));
        motor.backward = 0;
        back = fmin(back, moray_motor_power(&motor, u, v));
    }
    CHECK(worst < 1e-8, "power at the terminals, %.1e", worst);
    CHECK(back > -1e-8, "nothing comes back through a gear that gives nothing back: %.1e", back);
}

static void test_table(void)
{
    moray_motor motor = {0};
    const double speed[] = {0, 2}, torque[] = {4, 0};
    CHECK_OK(moray_motor_set_table(&motor, speed, torque, 2), "a line");
    CHECK_NEAR(moray_motor_load(&motor, 2, 1), 1, 1e-15, "on the line");
    CHECK_NEAR(moray_motor_load(&motor, -2, -1), 1, 1e-15, "the other way round");
    CHECK(moray_motor_load(&motor, 3.9, -1) < 1, "braking");
    const struct {
        double speed[3], torque[3];
        const char *says;
    } bad[] = {{{1, 2, 3}, {3, 2, 1}, "must begin at rest"},
               {{0, 2, 2}, {3, 2, 1}, "point 3: speeds must rise"},
               {{0, 1, 2}, {3, 2, 2.5}, "point 3: speeds must rise and torques fall"},
               {{0, 1, 2}, {0, 0, 0}, "point 2: speeds must rise"},
               {{0, 1, 2}, {3, 1, 0}, "point 3: torque falls less steeply"}};
    for (unsigned k = 0; k < sizeof bad / sizeof *bad; k++) {
        const moray_status status = moray_motor_set_table(&motor, bad[k].speed, bad[k].torque, 3);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, bad[k].says), "%s", status.text);
    }
    CHECK(moray_motor_set_table(&motor, speed, torque, 1).code == MORAY_INPUT, "one point");
    moray_robot robot = moray_robot_paper();
    robot.motor = (moray_motor){.fitted = true, .forward = 1.1, .backward = 0, .smooth_rate = 1, .smooth_power = 1};
    const moray_status status = moray_robot_check(&robot);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "motor: forward efficiency = 1.1: must be above 0"), "%s",
          status.text);
}

static void refused(const moray_robot *robot, const char *says)
{
    const moray_status status = moray_robot_check(robot);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says), "%s", status.text);
}

// What tables and options would not make.
static void test_checks(random_seed *seed)
{
    moray_robot good = moray_robot_paper(), robot;
    good.motor = random_motor(seed);
    good.supply = (moray_supply){.constant = 1, .battery = 10, .rate = INFINITY};
    CHECK_OK(moray_robot_check(&good), "motors and a battery");
    robot = good, robot.motor.lines = MORAY_MOTOR_LINES + 1;
    refused(&robot, "lines of torque over speed: must be 0 to 8");
    robot = good, robot.motor.lines = -1;
    refused(&robot, "-1 lines");
    robot = good, robot.motor.torque[1] = 0;
    refused(&robot, "line 2: torque = 0 N m");
    robot = good, robot.motor.torque[0] = NAN;
    refused(&robot, "line 1: torque = nan N m");
    robot = good, robot.motor.slope[1] = -0.1;
    refused(&robot, "slope = -0.1 N m s/rad");
    robot = good, robot.motor.slope[0] = INFINITY;
    refused(&robot, "slope = inf N m s/rad");
    robot = good, robot.motor.fitted = false;
    refused(&robot, "2 lines of torque over speed, but none is fitted");
    robot.motor = (moray_motor){0};
    CHECK_OK(moray_robot_check(&robot), "no motors");
    robot = good, robot.supply.constant = -1;
    refused(&robot, "supply: constant power = -1 W: must be finite and at least 0");
    robot = good, robot.supply.constant = INFINITY;
    refused(&robot, "supply: constant power = inf W");
    robot = good, robot.supply.battery = -2;
    refused(&robot, "supply: battery = -2 Wh");
    robot = good, robot.supply.battery = NAN;
    refused(&robot, "supply: battery = nan Wh");
    robot = good, robot.supply.rate = -1;
    refused(&robot, "supply: joint rate = -1 rad/s: must be at least 0");
}

// The control-oriented model has no rotary joints; rates of joints are path outputs of a series alone.
static void test_places(random_seed *seed)
{
    moray_plant_spec spec = {.robot = random_robot(seed, 4), .path_supply = true};
    moray_map map;
    spec.robot.motor = random_motor(seed);
    moray_status status = moray_control_plant(&map, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "path_supply"), "%s", status.text);
    spec.joints = MORAY_JOINTS_STEERED;
    status = moray_average_plant(&map, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "path_supply"), "%s", status.text);
    spec.path_supply = false;
    spec.path_rates = true;
    status = moray_fp_plant(&map, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "path_rates"), "%s", status.text);
}

// Values, Jacobian and Hessian at a point, in one.
static double *all_of(const moray_map *map, const double *in, const double *weight)
{
    double *all = calloc((size_t)(map->n_out + map->jac.nnz + map->hess.nnz), sizeof *all);
    map->value(map->self, in, all);
    map->jacobian(map->self, in, all + map->n_out);
    map->hessian(map->self, in, weight, all + map->n_out + map->jac.nnz);
    return all;
}

enum { MOST = 300 };

static void random_point(random_seed *seed, const moray_plant_spec *spec, const moray_map *map, double *in,
                         double *weight)
{
    const int nx = moray_plant_sizes(spec).nx;
    CHECK(map->n_in <= MOST && map->n_out <= MOST, "room");
    for (int i = 0; i < map->n_in; i++)
        in[i] = i < nx ? tap_random(seed, -0.7, 0.7) : tap_random(seed, 0.1, 1.2);
    random_vector(seed, 1, map->n_out, weight);
}

static void test_plant(random_seed *seed, int N, moray_joints joints)
{
    moray_plant_spec spec = {.robot = random_robot(seed, N),
                             .joints = joints,
                             .current = {0.3, -0.2},
                             .path_forces = N % 2,
                             .path_angles = true,
                             .harmonics = 2};
    moray_map map, none;
    moray_derivative_report report;
    double in[MOST], weight[MOST];
    CHECK_OK(moray_fp_plant(&none, &spec), "plant without motors");
    spec.robot.motor = (moray_motor){.fitted = true, .forward = 1, .backward = 1, .smooth_rate = 1, .smooth_power = 1};
    CHECK_OK(moray_fp_plant(&map, &spec), "plant with motors of no size");
    random_point(seed, &spec, &map, in, weight);
    double *one = all_of(&none, in, weight), *other = all_of(&map, in, weight);
    CHECK(map.jac.nnz == none.jac.nnz && memcmp(one, other, (size_t)map.n_out * sizeof *one) == 0,
          "N = %d, joints %d: the same digits", N, (int)joints);
    CHECK(relative_distance(map.jac.nnz, other + map.n_out, one + map.n_out) < 1e-14, "and slopes");
    free(one);
    free(other);
    moray_map_release(&map);
    moray_map_release(&none);
    spec.robot.motor = random_motor(seed);
    spec.path_supply = true;
    CHECK_OK(moray_fp_plant(&map, &spec), "plant with motors");
    random_point(seed, &spec, &map, in, weight);
    CHECK_OK(moray_check_derivatives(&map, in, weight, &report), "checked");
    CHECK(report.jacobian_error < 1e-8 && report.hessian_error < 1e-8,
          "N = %d, joints %d: Jacobian %.1e (%d, %d), Hessian %.1e (%d, %d) from differences", N, (int)joints,
          report.jacobian_error, report.jacobian_row, report.jacobian_col, report.hessian_error, report.hessian_row,
          report.hessian_col);
    moray_map_release(&map);
}

int main(void)
{
    random_seed seed = 23;
    test_power(&seed);
    test_table();
    test_checks(&seed);
    test_places(&seed);
    for (int N = 2; N <= 7; N++) {
        test_plant(&seed, N, MORAY_JOINTS_ON_GAIT);
        test_plant(&seed, N, MORAY_JOINTS_STEERED);
        test_plant(&seed, N, MORAY_JOINTS_FREE);
        test_plant(&seed, N, MORAY_JOINTS_SERIES);
    }
    return tap_done();
}
