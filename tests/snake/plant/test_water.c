// SPDX-License-Identifier: MIT
//
// Plants in currents over place and time, against uniform water and against differences.
#include "water_table.h"

#include <string.h>
#include <unistd.h>

#include "moray/snake/model.h"
#include "moray/snake/plant.h"

static char path[] = "/tmp/moray_water_XXXXXX";

// ---- Plants --------------------------------------------------------------------------------------------------------

typedef moray_status maker(moray_map *map, const moray_plant_spec *spec);
typedef struct kind {
    const char *name;
    maker *make;
    moray_joints joints;
    bool forces, consistent, motors;
} kind;
static const kind kinds[] = {
    {"control, steered", moray_control_plant, MORAY_JOINTS_STEERED, true, false, false},
    {"control, on the gait", moray_control_plant, MORAY_JOINTS_ON_GAIT, false, false, false},
    {"control, invariant frame", moray_control_plant, MORAY_JOINTS_STEERED, true, true, false},
    {"first-principles, steered", moray_fp_plant, MORAY_JOINTS_STEERED, true, false, false},
    {"first-principles, consistent", moray_fp_plant, MORAY_JOINTS_STEERED, true, true, false},
    {"first-principles, with motors", moray_fp_plant, MORAY_JOINTS_STEERED, true, true, true},
    {"first-principles, on a series", moray_fp_plant, MORAY_JOINTS_SERIES, false, false, false},
    {"averaged", moray_average_plant, MORAY_JOINTS_STEERED, false, false, false},
    {"averaged, invariant frame", moray_average_plant, MORAY_JOINTS_STEERED, false, true, false},
};
enum { KINDS = sizeof kinds / sizeof *kinds, MOST = 64 };

static moray_map make(const kind *k, int links, const moray_water *water, const double V[2])
{
    moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = k->joints, .harmonics = 1};
    moray_map map;
    spec.robot.links = links;
    spec.path_forces = k->forces;
    spec.path_angles = k->forces;
    if (k->consistent)
        spec.robot.hydro = moray_hydrodynamics_consistent();
    if (k->motors) {
        const double speed[] = {0, 2, 4}, torque[] = {2, 1.5, 0};
        spec.robot.motor = (moray_motor){.fitted = true, .forward = 0.8, .smooth_rate = 0.5, .smooth_power = 0.5};
        CHECK_OK(moray_motor_set_table(&spec.robot.motor, speed, torque, 3), "a motor's table");
        spec.path_supply = true;
    }
    spec.water = water;
    memcpy(spec.current, V, sizeof spec.current);
    CHECK_OK(k->make(&map, &spec), k->name);
    return map;
}

static void point(const kind *k, const moray_map *map, int seed, double *in)
{
    const bool control = k->make != moray_fp_plant, steered = k->joints == MORAY_JOINTS_STEERED;
    const double state[] = {0.3, 0.4, -0.6, 0.1, 0.25, control ? 0.05 : 0.1};
    memcpy(in, state, sizeof state);
    for (int i = 6; i < map->n_in; i++)
        in[i] = 0.02 + 0.01 * i;
    if (steered)
        in[10] = 2.1, in[11] = 0.7, in[9] = control ? 0.04 : 0.24;
    else
        in[7] = 2.1, in[8] = 0.7, in[6] = k->joints == MORAY_JOINTS_SERIES ? 2.1 : 0.04;
    in[map->n_in - 1] = 1.3;
    for (int i = 0; i < map->n_in; i++)
        in[i] += 0.1 * (fmod(0.618 * (i + 1) * (seed + 1), 1) - 0.5) * (0.2 + fabs(in[i]));
}

// The table of a uniform current does what the uniform current does; the water is that of the place and time.
static void test_values(const kind *k)
{
    moray_water *same = water_table(path, water_uniform, 1), *water = water_table(path, water_cubic, 6);
    double in[MOST], one[MOST], other[MOST], V[2], worst = 0;
    water_uniform(0, 0, 0, V);
    moray_map still = make(k, 5, NULL, V), table = make(k, 5, same, (double[]){0, 0}),
              moving = make(k, 5, water, (double[]){0, 0});
    for (int seed = 0; seed < 5; seed++) {
        point(k, &still, seed, in);
        still.value(still.self, in, one);
        table.value(table.self, in, other);
        for (int i = 0; i < still.n_out; i++)
            worst = tap_worse(worst, fabs(one[i] - other[i]) / (1 + fabs(one[i])));
        water_cubic(in[1], in[2], in[still.n_in - 1], V);
        moray_map here = make(k, 5, NULL, V);
        here.value(here.self, in, one);
        moving.value(moving.self, in, other);
        for (int i = 0; i < still.n_out; i++)
            worst = tap_worse(worst, fabs(one[i] - other[i]) / (1 + fabs(one[i])));
        moray_map_release(&here);
    }
    CHECK(worst < 1e-11, "%s: values differ by %.1e", k->name, worst);
    moray_map_release(&still);
    moray_map_release(&table);
    moray_map_release(&moving);
    moray_water_free(same);
    moray_water_free(water);
}

static void test_derivatives(const kind *k, int links)
{
    moray_water *water = water_table(path, water_cubic, 6);
    moray_map map = make(k, links, water, (double[]){0, 0});
    double in[MOST], weight[MOST], jacobian = 0, hessian = 0;
    for (int seed = 0; seed < 4; seed++) {
        moray_derivative_report report;
        point(k, &map, seed, in);
        for (int i = 0; i < map.n_out; i++)
            weight[i] = fmod(0.414 * (i + 1) * (seed + 2), 1) - 0.4;
        CHECK_OK(moray_check_derivatives(&map, in, weight, &report), "check");
        jacobian = tap_worse(jacobian, report.jacobian_error);
        hessian = tap_worse(hessian, report.hessian_error);
    }
    CHECK(jacobian < 1e-8 && hessian < 1e-6, "%s, %d links: Jacobian %.1e, Hessian %.1e", k->name, links, jacobian,
          hessian);
    moray_map_release(&map);
    moray_water_free(water);
}

// No entry of the Jacobian is always zero: what the water does not move has none in its place and time.
static void test_pattern(const kind *k)
{
    moray_water *water = water_table(path, water_cubic, 6);
    moray_map map = make(k, 5, water, (double[]){0, 0});
    double in[MOST], *values = calloc((size_t)map.jac.nnz, sizeof *values);
    bool *seen = calloc((size_t)map.jac.nnz, sizeof *seen);
    int empty = 0;
    for (int seed = 0; seed < 4; seed++) {
        point(k, &map, seed, in);
        map.jacobian(map.self, in, values);
        for (int e = 0; e < map.jac.nnz; e++)
            seen[e] = seen[e] || values[e] != 0;
    }
    for (int e = 0; e < map.jac.nnz; e++)
        empty += !seen[e];
    CHECK(empty == 0, "%s: %d of %d entries are always zero", k->name, empty, map.jac.nnz);
    free(values);
    free(seen);
    moray_map_release(&map);
    moray_water_free(water);
}

static void test_kinds_refused(void)
{
    moray_water *water = water_table(path, water_uniform, 1);
    moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_FREE, .water = water};
    moray_map map;
    CHECK(moray_failed(moray_fp_plant(&map, &spec)), "joints that are free");
    spec.joints = MORAY_JOINTS_STEERED;
    spec.robot.hydro.drag = MORAY_DRAG_BOTH;
    CHECK(moray_failed(moray_fp_plant(&map, &spec)), "quadratic drag with the paper's added mass");
    moray_water_free(water);
}

int main(void)
{
    close(mkstemp(path));
    for (int k = 0; k < KINDS; k++) {
        test_values(&kinds[k]);
        test_derivatives(&kinds[k], 3);
        test_derivatives(&kinds[k], 4);
        test_pattern(&kinds[k]);
    }
    test_kinds_refused();
    unlink(path);
    return tap_done();
}
