// SPDX-License-Identifier: MIT
//
// The first-principles plant with its joints on the gait, its offset at rest or moving: against the swimmer's
// equations, and its derivatives against differences.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/snake/plant.h"
#include "random_robot.h"

enum { MOST_INPUTS = 13 };

static const char *const form_names[] = {[MORAY_JOINTS_ON_GAIT] = "on the gait", [MORAY_JOINTS_STEERED] = "steered"};

static void random_input(unsigned long long *seed, bool steered, double *in)
{
    const double low[] = {-3, 0, 0, -0.5, -0.3, -0.3, 0.05, 1, 0.3, -0.1, -0.8, 0};
    const double high[] = {3, 0, 0, 0.5, 0.3, 0.3, 0.4, 4, 1.5, 0.1, 0.8, 3};
    const double steered_low[] = {-3, 0, 0, -0.5, -0.3, -0.3, -0.1, -0.2, -0.5, 0.05, 1, 0.3, 0};
    const double steered_high[] = {3, 0, 0, 0.5, 0.3, 0.3, 0.1, 0.2, 0.5, 0.4, 4, 1.5, 3};
    for (int i = 0; i < (steered ? 13 : 12); i++)
        in[i] = steered ? tap_random(seed, steered_low[i], steered_high[i]) : tap_random(seed, low[i], high[i]);
}

static moray_gait gait_of(bool steered, const double *in, double *t)
{
    *t = in[steered ? 12 : 11];
    if (steered)
        return (moray_gait){.amplitude = in[9],
                            .omega = in[10],
                            .delta = in[11],
                            .offset = in[6],
                            .offset_rate = in[7],
                            .offset_acceleration = in[8]};
    return (moray_gait){.amplitude = in[6], .omega = in[7], .delta = in[8], .offset = in[9], .taper = in[10]};
}

// The state of the swimmer that stands for the state of the plant: link angles of the given mean.
static void full_state(int N, bool steered, const double *in, double *x, double *ubar)
{
    double *phi = calloc(2 * (size_t)N, sizeof *phi), *dphi = phi + N, t;
    const moray_gait gait = gait_of(steered, in, &t);
    moray_gait_reference(&gait, N - 1, t, phi, dphi, ubar);
    for (int rate = 0; rate < 2; rate++) {
        double *angle = x + rate * (N + 2), *joint = rate ? dphi : phi, sum = 0;
        angle[0] = 0;
        for (int i = 1; i < N; i++)
            sum += angle[i] = angle[i - 1] - joint[i - 1]; // (1)
        for (int i = 0; i < N; i++)
            angle[i] += in[3 * rate] - sum / N;
        memcpy(angle + N, in + 3 * rate + 1, 2 * sizeof *angle);
    }
    free(phi);
}

static void test_against_swimmer(const moray_plant_spec *spec, const moray_map *map, unsigned long long *seed)
{
    const int N = spec->robot.links, nx = moray_plant_sizes(spec).nx;
    const bool steered = spec->joints == MORAY_JOINTS_STEERED;
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, &spec->robot, MORAY_FIRST_PRINCIPLES), "swimmer");
    moray_swimmer_set_current(swimmer, spec->current[0], spec->current[1]);
    double *x = calloc(8 * (size_t)N + 16, sizeof *x), *dx = x + 2 * N + 4, *ubar = dx + 2 * N + 4, *u = ubar + N;
    double *out = calloc((size_t)map->n_out, sizeof *out), *phi = u + N, *v_phi = phi + N, in[MOST_INPUTS], worst = 0;
    random_input(seed, steered, in);
    full_state(N, steered, in, x, ubar);
    map->value(map->self, in, out);
    CHECK(moray_swimmer_rates(swimmer, x, ubar, dx, u), "N = %d: swimmer's rates", N);
    double mean = 0, power = 0, mean_rate = 0;
    moray_swimmer_joints(swimmer, x, phi, v_phi);
    for (int i = 0; i < N; i++) {
        mean += dx[N + 2 + i] / N;
        mean_rate += dx[i] / N;
        worst = tap_worse(worst, fabs(out[nx + N - 1 + i] - (x[i] - in[0])));
    }
    for (int i = 0; i < N - 1; i++) {
        power += u[i] * v_phi[i];
        worst = tap_worse(worst, fabs(out[nx + i] - u[i]) / (1 + fabs(u[i])));
    }
    const double expected[] = {mean_rate, dx[N], dx[N + 1], mean, dx[2 * N + 2], dx[2 * N + 3], in[7], in[8]};
    for (int r = 0; r < nx; r++)
        worst = tap_worse(worst, fabs(out[r] - expected[r]) / (1 + fabs(expected[r])));
    worst = tap_worse(worst, fabs(out[map->n_out - 1] - power) / (1 + fabs(power)));
    CHECK(worst < 1e-12, "N = %d, %s: rates, torques, link angles and power as the swimmer has them: %.1e", N,
          form_names[spec->joints], worst);
    free(out);
    free(x);
    moray_swimmer_free(swimmer);
}

static void test_derivatives(const moray_plant_spec *spec, const moray_map *map, unsigned long long *seed)
{
    double in[MOST_INPUTS], *weight = calloc((size_t)map->n_out, sizeof *weight);
    random_input(seed, spec->joints == MORAY_JOINTS_STEERED, in);
    for (int i = 0; i < map->n_out; i++)
        weight[i] = tap_random(seed, -1, 1);
    moray_derivative_report report;
    CHECK_OK(moray_check_derivatives(map, in, weight, &report), "checked");
    CHECK(report.jacobian_error < 1e-9 && report.hessian_error < 1e-9,
          "N = %d, %s: Jacobian %.1e, Hessian %.1e (row %d, column %d) from differences", spec->robot.links,
          form_names[spec->joints], report.jacobian_error, report.hessian_error, report.hessian_row,
          report.hessian_col);
    free(weight);
}

static void test_plant(moray_plant_spec *spec, int trials, unsigned long long *seed)
{
    moray_map map;
    CHECK_OK(moray_fp_plant(&map, spec), "plant");
    for (int trial = 0; trial < trials; trial++) {
        test_against_swimmer(spec, &map, seed);
        test_derivatives(spec, &map, seed);
    }
    moray_map_release(&map);
}

int main(void)
{
    const int links[] = {2, 3, 5, 10, 17};
    unsigned long long seed = 5;
    moray_map map;
    moray_plant_spec spec = {
        .robot = moray_robot_paper(), .current = {0.1, -0.05}, .path_forces = true, .path_angles = true};
    for (unsigned k = 0; k < 2 * sizeof links / sizeof *links; k++) {
        spec.robot.links = links[k / 2];
        spec.joints = k % 2 ? MORAY_JOINTS_STEERED : MORAY_JOINTS_ON_GAIT;
        test_plant(&spec, 3, &seed);
    }
    for (int variant = 1; variant < 2 * HYDRO_VARIANTS; variant++) {
        spec.robot.links = 2 + variant % 9;
        spec.robot.hydro = hydro_variant(variant % HYDRO_VARIANTS);
        spec.joints = variant < HYDRO_VARIANTS ? MORAY_JOINTS_STEERED : MORAY_JOINTS_ON_GAIT;
        test_plant(&spec, 1, &seed);
    }
    spec.robot = moray_robot_paper();
    spec.joints = MORAY_JOINTS_CLOSED_LOOP;
    CHECK(moray_fp_plant(&map, &spec).code == MORAY_INPUT, "joints in closed loop are refused");
    spec.joints = MORAY_JOINTS_ON_GAIT;
    spec.robot.links = 1;
    CHECK(moray_fp_plant(&map, &spec).code == MORAY_INPUT, "one link is refused");
    return tap_done();
}
