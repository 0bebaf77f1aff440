// SPDX-License-Identifier: MIT
//
// Random robots and points, exact derivatives of the dense model, and their comparison with those of a map.
#ifndef TESTS_DENSE_DERIVATIVES_H
#define TESTS_DENSE_DERIVATIVES_H

#include "dense_plant.h"

typedef struct grid {
    double at[DENSE_OUTPUTS][DENSE_INPUTS];
} grid;

static random_seed derivatives_seed = 20240607;

static double draw(double low, double high)
{
    return tap_random(&derivatives_seed, low, high);
}

static moray_plant_spec random_spec(int links, moray_joints joints, bool forces, bool angles)
{
    moray_robot robot = random_robot(&derivatives_seed, links);
    robot.hydro.frame = draw(0, 1) < 0.5 ? MORAY_FRAME_PAPER : MORAY_FRAME_INVARIANT;
    return (moray_plant_spec){.robot = robot,
                              .joints = joints,
                              .current = {draw(-1, 1), draw(-1, 1)},
                              .path_forces = forces,
                              .path_angles = angles,
                              .path_rates = joints == MORAY_JOINTS_SERIES && angles,
                              .harmonics = joints == MORAY_JOINTS_SERIES ? DENSE_HARMONICS : 0};
}

// For every input a range to draw from and the step of a difference quotient of order eight along it; the step in
// delta is small because (N-2) delta stands in a sine.
typedef struct input_kind {
    double low, high, step;
} input_kind;

static void input_kinds(const moray_plant_spec *spec, input_kind *kinds)
{
    const moray_plant_size size = moray_plant_sizes(spec);
    const int n = spec->robot.links - 1;
    const input_kind phi = {-0.2, 0.2, 5e-3}, angle = {-3, 3, 0.03}, position = {-1, 1, 0.1}, v_phi = {-1, 1, 0.1};
    const input_kind rate = {-1, 1, 0.1}, ubar = {-1, 1, 0.1};
    const input_kind gait[] = {
        {0.05, 0.2, 2e-3}, {1, 3, 5e-3}, {0.3, 1.2, 1e-3}, {-0.05, 0.05, 2e-3}, {-0.8, 0.8, 1e-2}};
    input_kind *next = kinds;
    const bool steered = spec->joints == MORAY_JOINTS_STEERED;
    const bool series = spec->joints == MORAY_JOINTS_SERIES;
    const bool joints = spec->joints == MORAY_JOINTS_FREE || spec->joints == MORAY_JOINTS_CLOSED_LOOP;
    for (int i = 0; i < n && joints; i++)
        *next++ = phi;
    *next++ = angle, *next++ = position, *next++ = position;
    for (int i = 0; i < n && joints; i++)
        *next++ = v_phi;
    *next++ = rate, *next++ = rate, *next++ = rate;
    if (steered)
        *next++ = (input_kind){-0.05, 0.05, 2e-3}, *next++ = v_phi;
    for (int i = 0; i < size.nu; i++)
        *next++ = ubar;
    for (int i = 0; i < size.ns; i++)
        *next++ = !series ? gait[i] : i == 0 ? gait[1] : phi;
    *next = (input_kind){0, 3, 5e-3};
}

static void random_point(const moray_plant_spec *spec, int n_in, double *in)
{
    input_kind kinds[DENSE_INPUTS];
    input_kinds(spec, kinds);
    for (int k = 0; k < n_in; k++)
        in[k] = draw(kinds[k].low, kinds[k].high);
}

// ---- The reference's derivatives -----------------------------------------------------------------------------------

static void dense_jacobian(const dense_plant *plant, int n_in, int n_out, const double *in, grid *out)
{
    const double h = 1e-30; // complex step: no cancellation, exact to rounding
    num z[DENSE_INPUTS], f[DENSE_OUTPUTS];
    for (int k = 0; k < n_in; k++)
        z[k] = in[k];
    for (int k = 0; k < n_in; k++) {
        z[k] += h * I;
        dense_value(plant, z, f);
        z[k] = in[k];
        for (int i = 0; i < n_out; i++)
            out->at[i][k] = cimag(f[i]) / h;
    }
}

static void dense_gradient(const dense_plant *plant, int n_in, int n_out, const double *in, const double *weight,
                           double *out)
{
    static grid jacobian;
    dense_jacobian(plant, n_in, n_out, in, &jacobian);
    for (int k = 0; k < n_in; k++) {
        out[k] = 0;
        for (int i = 0; i < n_out; i++)
            out[k] += weight[i] * jacobian.at[i][k];
    }
}

// Central differences of order eight of complex-step gradients.
static void dense_hessian(const dense_plant *plant, int n_in, int n_out, const double *in, const double *weight,
                          grid *out)
{
    static const double coefficient[] = {0, 4. / 5, -1. / 5, 4. / 105, -1. / 280};
    input_kind kinds[DENSE_INPUTS];
    double z[DENSE_INPUTS], gradient[DENSE_INPUTS];
    input_kinds(&plant->spec, kinds);
    memcpy(z, in, (size_t)n_in * sizeof *in);
    memset(out, 0, sizeof *out);
    for (int k = 0; k < n_in; k++) {
        for (int step = -4; step <= 4; step++) {
            if (step == 0)
                continue;
            z[k] = in[k] + step * kinds[k].step;
            dense_gradient(plant, n_in, n_out, z, weight, gradient);
            const double c = (step > 0 ? coefficient[step] : -coefficient[-step]) / kinds[k].step;
            for (int i = 0; i < n_in; i++)
                out->at[i][k] += c * gradient[i];
        }
        z[k] = in[k];
    }
}

// ---- Comparison ----------------------------------------------------------------------------------------------------

// Spreads values over a matrix; false when an entry stands twice or (lower) above the diagonal.
static bool spread(const moray_pattern *pattern, const double *values, bool lower, grid *out)
{
    static grid seen;
    bool good = true;
    memset(out, 0, sizeof *out);
    memset(&seen, 0, sizeof seen);
    for (int k = 0; k < pattern->nnz; k++) {
        const int row = pattern->row[k], col = pattern->col[k];
        good = good && seen.at[row][col]++ == 0 && !(lower && col > row);
        out->at[row][col] = values[k];
        if (lower)
            out->at[col][row] = values[k];
    }
    return good;
}

// Largest difference of two matrices, relative to the largest entry of `want`, with inputs in units of their ranges.
static double disagreement(const moray_plant_spec *spec, int rows, int cols, bool rows_are_inputs, const grid *got,
                           const grid *want)
{
    input_kind kinds[DENSE_INPUTS];
    double largest = 0, worst = 0;
    input_kinds(spec, kinds);
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < cols; j++) {
            const double unit = (kinds[j].high - kinds[j].low) * (rows_are_inputs ? kinds[i].high - kinds[i].low : 1);
            const double error = unit * fabs(got->at[i][j] - want->at[i][j]);
            if (!(error <= worst)) // a NaN counts
                worst = error;
            largest = fmax(largest, unit * fabs(want->at[i][j]));
        }
    return worst / largest;
}

#endif
