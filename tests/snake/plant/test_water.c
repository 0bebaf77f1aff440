// SPDX-License-Identifier: MIT
//
// Currents over place and time: the table against the field it was made of, the plants against uniform water and
// against differences, a swimmer against its plant.
#include "moray/water.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "moray/snake/model.h"
#include "moray/snake/plant.h"
#include "tap.h"

static char path[] = "/tmp/moray_water_XXXXXX";

// A polynomial of degree 3 in each argument, which splines of not-a-knot ends repeat.
static void field(double x, double y, double t, double V[2])
{
    V[0] = 0.1 + 0.02 * y - 0.003 * y * y * x + 0.001 * t * x;
    V[1] = -0.05 + 0.004 * x * x - 0.002 * t * t * y + 0.0005 * x * x * x;
}

static void uniform(double x, double y, double t, double V[2])
{
    (void)x, (void)y, (void)t;
    V[0] = 0.1;
    V[1] = -0.07;
}

static void write_table(void (*of)(double, double, double, double[2]), int times)
{
    FILE *file = fopen(path, "w");
    fprintf(file, times > 1 ? "t_s,x_m,y_m,v_x_m_s,v_y_m_s\n" : "x_m,y_m,v_x_m_s,v_y_m_s\n");
    for (int k = times - 1; k >= 0; k--)
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 5; j++) {
                const double x = -3 + i * (1 + 0.1 * i), y = -2 + j, t = 0.7 * k;
                double V[2];
                of(x, y, t, V);
                if (times > 1)
                    fprintf(file, "%.17g,", t);
                fprintf(file, "%.17g,%.17g,%.17g,%.17g\n", x, y, V[0], V[1]);
            }
    fclose(file);
}

static moray_water *read_table(void (*of)(double, double, double, double[2]), int times)
{
    moray_water *water;
    write_table(of, times);
    CHECK_OK(moray_water_read(&water, path), "table");
    return water;
}

// ---- The table -----------------------------------------------------------------------------------------------------

static void test_table(void)
{
    moray_water *water = read_table(field, 6);
    double worst = 0, slopes = 0;
    for (int k = 0; k < 50; k++) {
        const double x = -3 + 5 * fmod(0.618 * k, 1), y = -2 + 4 * fmod(0.414 * k, 1), t = 3.5 * fmod(0.732 * k, 1);
        double V[2], W[2], d[2][MORAY_WATER_SLOPES];
        moray_num Z[2];
        field(x, y, t, W);
        moray_water_slopes(water, x, y, t, V, d);
        worst = tap_worse(worst, fmax(fabs(V[0] - W[0]), fabs(V[1] - W[1])));
        moray_water_at(water, x, y, t, V);
        worst = tap_worse(worst, fmax(fabs(V[0] - W[0]), fabs(V[1] - W[1])));
        const double of[2][MORAY_WATER_SLOPES] = {
            {-0.003 * y * y + 0.001 * t, 0.02 - 0.006 * y * x, 0.001 * x, 0, -0.006 * y, -0.006 * x, 0.001, 0, 0},
            {0.008 * x + 0.0015 * x * x, -0.002 * t * t, -0.004 * t * y, 0.008 + 0.003 * x, 0, 0, 0, -0.004 * t,
             -0.004 * y}};
        for (int c = 0; c < 2; c++)
            for (int i = 0; i < MORAY_WATER_SLOPES; i++)
                slopes = tap_worse(slopes, fabs(d[c][i] - of[c][i]));
        moray_water_at_complex(water, moray_complex(x, 1e-30), y, t, Z);
        slopes = tap_worse(slopes, fabs(cimag(Z[1]) * 1e30 - of[1][0]));
    }
    CHECK(worst < 1e-13, "values differ by %.1e", worst);
    CHECK(slopes < 1e-11, "derivatives differ by %.1e", slopes);
    CHECK(moray_water_covers(water, 0, 0, 1) && !moray_water_covers(water, 0, 0, 4) &&
              !moray_water_covers(water, -3.1, 0, 1),
          "its range");
    double low[3], high[3], middle[3];
    moray_water_range(water, low, high);
    moray_water_middle(water, middle);
    CHECK(low[0] == -3 && high[0] == 4.5 && low[1] == -2 && high[1] == 2 && low[2] == 0 && high[2] == 3.5,
          "x from %g to %g, y from %g to %g, t from %g to %g", low[0], high[0], low[1], high[1], low[2], high[2]);
    CHECK(moray_water_covers(water, middle[0], middle[1], middle[2]) && middle[0] != 0 && middle[1] != 0,
          "in its middle: %g, %g, %g", middle[0], middle[1], middle[2]);
    moray_water_free(water);
}

// What does not change along an axis does not change in its last digits either, which a certificate would take for a
// slope.
static void test_still(void)
{
    moray_water *water = read_table(uniform, 3);
    double V[2], W[2], d[2][MORAY_WATER_SLOPES], most = 0;
    moray_water_at(water, 0.1, 0.2, 0.3, V);
    moray_water_slopes(water, 1.7, -0.9, 1.1, W, d);
    for (int i = 0; i < 2 * MORAY_WATER_SLOPES; i++)
        most = fmax(most, fabs(d[i / MORAY_WATER_SLOPES][i % MORAY_WATER_SLOPES]));
    CHECK(V[0] == W[0] && V[1] == W[1] && most == 0, "a uniform table to the last digit: slopes %g", most);
    moray_water_free(water);
}

static void refuse(const char *text, const char *said)
{
    moray_water *water;
    FILE *file = fopen(path, "w");
    fputs(text, file);
    fclose(file);
    const moray_status status = moray_water_read(&water, path);
    CHECK(moray_failed(status) && !water && strstr(status.text, said), "%s: %s", said, status.text);
}

static void test_refusals(void)
{
    refuse("x_m,y_m,v_x_m_s,v_y_m_s\n0,0,0,0\n0,1,0,0\n1,0,0,0\n", "has more");
    refuse("x_m,y_m,v_x_m_s,v_y_m_s\n0,0,0,0\n0,1,0,0\n1,0,0,0\n1,0,0,0\n", "stands twice");
    refuse("x_m,y_m,v_x_m_s,v_y_m_s\n0,0,0,0\n0,1,0,0\n", "two places");
    refuse("x_m,y_m,v_x_m_s\n0,0,0\n", "v_y_m_s");
    refuse("x_m,y_m,v_x_m_s,v_y_m_s\n0,0,fast,0\n", "fast");
}

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
    moray_water *same = read_table(uniform, 1), *water = read_table(field, 6);
    double in[MOST], one[MOST], other[MOST], V[2], worst = 0;
    uniform(0, 0, 0, V);
    moray_map still = make(k, 5, NULL, V), table = make(k, 5, same, (double[]){0, 0}),
              moving = make(k, 5, water, (double[]){0, 0});
    for (int seed = 0; seed < 5; seed++) {
        point(k, &still, seed, in);
        still.value(still.self, in, one);
        table.value(table.self, in, other);
        for (int i = 0; i < still.n_out; i++)
            worst = tap_worse(worst, fabs(one[i] - other[i]) / (1 + fabs(one[i])));
        field(in[1], in[2], in[still.n_in - 1], V);
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
    moray_water *water = read_table(field, 6);
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

static void test_kinds_refused(void)
{
    moray_water *water = read_table(uniform, 1);
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
    test_table();
    test_still();
    test_refusals();
    for (int k = 0; k < KINDS; k++) {
        test_values(&kinds[k]);
        test_derivatives(&kinds[k], 3);
        test_derivatives(&kinds[k], 4);
    }
    test_kinds_refused();
    unlink(path);
    return tap_done();
}
