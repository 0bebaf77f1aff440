// SPDX-License-Identifier: MIT
#include "tap.h"

#include "dense_plant.h"

typedef struct grid {
    double at[DENSE_OUTPUTS][DENSE_INPUTS];
} grid;

static const char *const form_names[] = {"on the gait", "closed loop", "free"};
static unsigned long long seed = 20240607;

static double draw(double low, double high)
{
    return tap_random(&seed, low, high);
}

static moray_plant_spec random_spec(int links, moray_joints joints, bool forces, bool angles)
{
    moray_plant_spec spec = {.robot = moray_robot_paper(),
                             .joints = joints,
                             .current = {draw(-0.2, 0.2), draw(-0.2, 0.2)},
                             .path_forces = forces,
                             .path_angles = angles};
    spec.robot.links = links;
    double *const coefficients[] = {&spec.robot.l,    &spec.robot.m,           &spec.robot.c_t,      &spec.robot.c_n,
                                    &spec.robot.mu_n, &spec.robot.rot_damping, &spec.robot.rot_gain, &spec.robot.k_p,
                                    &spec.robot.k_d};
    for (unsigned k = 0; k < sizeof coefficients / sizeof *coefficients; k++)
        *coefficients[k] *= draw(0.7, 1.4);
    return spec;
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
    const input_kind phi = {-0.06, 0.06, 5e-3}, angle = {-3, 3, 0.03}, position = {-1, 1, 0.1}, v_phi = {-0.1, 0.1, 0.1};
    const input_kind rate = {-0.5, 0.5, 0.1}, ubar = {-1, 1, 0.5};
    const input_kind gait[] = {{0.02, 0.06, 2e-3}, {1, 3, 5e-3}, {0.3, 1.2, 1e-3}, {-0.02, 0.02, 1e-3}};
    input_kind *next = kinds;
    const bool joints = spec->joints != MORAY_JOINTS_ON_GAIT;
    for (int i = 0; i < n && joints; i++)
        *next++ = phi;
    *next++ = angle, *next++ = position, *next++ = position;
    for (int i = 0; i < n && joints; i++)
        *next++ = v_phi;
    *next++ = rate, *next++ = rate, *next++ = rate;
    for (int i = 0; i < size.nu; i++)
        *next++ = ubar;
    for (int i = 0; i < size.ns; i++)
        *next++ = gait[i];
    *next = (input_kind){0, 3, 5e-3};
}

static void random_point(const moray_plant_spec *spec, int n_in, double *in)
{
    input_kind kinds[DENSE_INPUTS];
    input_kinds(spec, kinds);
    for (int k = 0; k < n_in; k++)
        in[k] = draw(kinds[k].low, kinds[k].high);
}

// ---- The reference's derivatives -------------------------------------------------------------------------------------

static void dense_jacobian(const dense_plant *dense, int n_in, int n_out, const double *in, grid *out)
{
    const double h = 1e-30; // complex step: no cancellation, exact to rounding
    num z[DENSE_INPUTS], f[DENSE_OUTPUTS];
    for (int k = 0; k < n_in; k++)
        z[k] = in[k];
    for (int k = 0; k < n_in; k++) {
        z[k] += h * I;
        dense_value(dense, z, f);
        z[k] = in[k];
        for (int i = 0; i < n_out; i++)
            out->at[i][k] = cimag(f[i]) / h;
    }
}

static void dense_gradient(const dense_plant *dense, int n_in, int n_out, const double *in, const double *weight,
                           double *out)
{
    static grid jacobian;
    dense_jacobian(dense, n_in, n_out, in, &jacobian);
    for (int k = 0; k < n_in; k++) {
        out[k] = 0;
        for (int i = 0; i < n_out; i++)
            out[k] += weight[i] * jacobian.at[i][k];
    }
}

// Central differences of order eight of complex-step gradients.
static void dense_hessian(const dense_plant *dense, int n_in, int n_out, const double *in, const double *weight,
                          grid *out)
{
    static const double coefficient[] = {0, 4. / 5, -1. / 5, 4. / 105, -1. / 280};
    input_kind kinds[DENSE_INPUTS];
    double z[DENSE_INPUTS], gradient[DENSE_INPUTS];
    input_kinds(&dense->spec, kinds);
    memcpy(z, in, (size_t)n_in * sizeof *in);
    memset(out, 0, sizeof *out);
    for (int k = 0; k < n_in; k++) {
        for (int step = -4; step <= 4; step++) {
            if (step == 0)
                continue;
            z[k] = in[k] + step * kinds[k].step;
            dense_gradient(dense, n_in, n_out, z, weight, gradient);
            const double c = (step > 0 ? coefficient[step] : -coefficient[-step]) / kinds[k].step;
            for (int i = 0; i < n_in; i++)
                out->at[i][k] += c * gradient[i];
        }
        z[k] = in[k];
    }
}

// ---- Comparison ------------------------------------------------------------------------------------------------------

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

// Largest difference, relative to the smaller of the largest entries of its row and column (1 at least if `floor`).
static double disagreement(int rows, int cols, const grid *got, const grid *want, double floor)
{
    double row_max[DENSE_OUTPUTS] = {0}, col_max[DENSE_INPUTS] = {0}, worst = 0;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < cols; j++) {
            row_max[i] = fmax(row_max[i], fabs(want->at[i][j]));
            col_max[j] = fmax(col_max[j], fabs(want->at[i][j]));
        }
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < cols; j++) {
            const double scale = fmax(fmin(row_max[i], col_max[j]), floor);
            const double error = fabs(got->at[i][j] - want->at[i][j]) / scale;
            if (!(error <= worst)) // a NaN counts
                worst = error;
        }
    return worst;
}

int main(void)
{
    const int links[] = {2, 3, 5, 10, 17};
    for (int c = 0; c < 5; c++)
        for (int form = 0; form < 3; form++)
            for (int path = 0; path < 2; path++) {
                moray_plant_spec spec = random_spec(links[c], (moray_joints)form, path, path);
                dense_plant dense;
                dense_plant_set(&dense, &spec);
                moray_map map;
                CHECK_OK(moray_control_plant(&map, &spec), "plant");
                double in[DENSE_INPUTS], out[DENSE_OUTPUTS], weight[DENSE_OUTPUTS], v[4000], worst = 0;
                num zin[DENSE_INPUTS], zout[DENSE_OUTPUTS];
                random_point(&spec, map.n_in, in);
                for (int k = 0; k < map.n_in; k++)
                    zin[k] = in[k];
                map.value(map.self, in, out);
                dense_value(&dense, zin, zout);
                for (int i = 0; i < map.n_out; i++)
                    worst = fmax(worst, fabs(out[i] - creal(zout[i])) / (1 + cabs(zout[i])));
                static grid got, want;
                dense_jacobian(&dense, map.n_in, map.n_out, in, &want);
                map.jacobian(map.self, in, v);
                bool ok = spread(&map.jac, v, false, &got);
                double ej = disagreement(map.n_out, map.n_in, &got, &want, 1e-300);
                for (int i = 0; i < map.n_out; i++)
                    weight[i] = draw(-1, 1);
                dense_hessian(&dense, map.n_in, map.n_out, in, weight, &want);
                map.hessian(map.self, in, weight, v);
                ok = ok && spread(&map.hess, v, true, &got);
                double eh = disagreement(map.n_in, map.n_in, &got, &want, 1e-2);
                printf("# N %d %s path %d: value %.1e jac %.1e hess %.1e ok %d nnz %d %d\n", links[c], form_names[form], path, worst, ej, eh, ok, map.jac.nnz, map.hess.nnz);
                moray_map_release(&map);
            }
    return tap_done();
}
