// SPDX-License-Identifier: MIT
#include "control.h"

#include <math.h>

#include "model.h"
#include "shape.h"

control_coefficients control_coefficients_of(const moray_robot *robot)
{
    const double L = 2 * robot->l;
    return (control_coefficients){.c_p = (robot->c_n - robot->c_t) / (2 * L),
                                  .mu_p = robot->mu_n / (2 * L),
                                  .c_n_hat = robot->c_n / (4 * L * L),
                                  .m_tilde = robot->m + robot->mu_n};
}

// The joint coordinates enter (16b), (16c) and (20) only through these sums.
typedef struct {
    double s, q, w, z; // ebar^T phi, |A^T phi|^2, phi^T A Dbar v_phi, phi^T A Dbar ubar
} shape_sums;

static shape_sums sums_of(int N, const double *phi, const double *v_phi, const double *ubar, double *scratch)
{
    shape_sums sums = {.q = phi[N - 2] * phi[N - 2]};
    shape_a_dbar_transposed(N, phi, scratch);
    for (int i = 0; i < N - 1; i++) {
        const double angle = phi[i] + (i > 0 ? phi[i - 1] : 0);
        sums.s += phi[i];
        sums.q += angle * angle;
        sums.w += scratch[i] * v_phi[i];
        sums.z += scratch[i] * ubar[i];
    }
    return sums;
}

// (16b), (16c): dv_t and dv_n in dv[2] from the velocities relative to the current. False where h_1 is not positive.
static bool accelerations(const moray_robot *robot, shape_sums sums, double v_tr, double v_nr, double dv[2])
{
    const control_coefficients k = control_coefficients_of(robot);
    const double N = robot->links, m = robot->m, c_t = robot->c_t, c_n = robot->c_n;
    const double c_p = k.c_p, mu_p = k.mu_p, m_tilde = k.m_tilde, s = sums.s;
    const double drag = k.c_n_hat * sums.q;
    const double determinant = N * N * m * m_tilde - 4 * mu_p * mu_p * s * s; // 1/h_1, (17)
    const double h_2 = 2 * N * s * (c_p * m_tilde - c_n * mu_p);
    const double h_3 = 4 * c_p * mu_p * s * s - N * m_tilde * (N * c_t + drag);
    const double h_4 = 2 * s * (N * c_p * m - mu_p * (N * c_t + drag));
    const double h_5 = 4 * c_p * mu_p * s * s - N * N * m * c_n;
    const double bending = c_p * sums.w + mu_p * sums.z;
    dv[0] = (h_2 * v_nr + h_3 * v_tr - N * m_tilde * bending) / determinant;
    dv[1] = (h_4 * v_tr + h_5 * v_nr - 2 * mu_p * s * bending) / determinant;
    return determinant > 0;
}

// (22) by way of (14b) and (15a): D D^T u = m~ ubar + c_n v_phi - (mu_p dv_t + c_p v_tr) A D^T phi.
static void joint_forces(const moray_robot *robot, const double *phi, const double *v_phi, const double *ubar,
                         double v_tr, double dv_t, double *u, double *scratch)
{
    const int N = robot->links;
    const control_coefficients k = control_coefficients_of(robot);
    const double slope = k.mu_p * dv_t + k.c_p * v_tr;
    shape_a_dt(N, phi, scratch);
    for (int i = 0; i < N - 1; i++)
        scratch[i] = k.m_tilde * ubar[i] + robot->c_n * v_phi[i] - slope * scratch[i];
    shape_gram_inverse(N, scratch, u);
}

bool control_rates(const moray_robot *robot, const double current[2], const double *x, const double *ubar, double *dx,
                   double *u, double *scratch)
{
    const int N = robot->links, half = N + 2;
    const double *phi = x, *v_phi = x + half;
    const double v_theta = x[2 * N + 1], v_t = x[2 * N + 2], v_n = x[2 * N + 3];
    const double cosine = cos(x[N - 1]), sine = sin(x[N - 1]);
    const double v_tr = v_t - (current[0] * cosine + current[1] * sine);
    const double v_nr = v_n - (current[1] * cosine - current[0] * sine);
    const shape_sums sums = sums_of(N, phi, v_phi, ubar, scratch);
    const bool regular = accelerations(robot, sums, v_tr, v_nr, dx + 2 * N + 2);
    for (int i = 0; i < N - 1; i++) {
        dx[i] = v_phi[i];       // (23a)
        dx[half + i] = ubar[i]; // (23e)
    }
    dx[N - 1] = v_theta;                                                                       // (23b)
    dx[N] = v_t * cosine - v_n * sine;                                                         // (23c)
    dx[N + 1] = v_t * sine + v_n * cosine;                                                     // (23d)
    dx[2 * N + 1] = -robot->rot_damping * v_theta + robot->rot_gain / (N - 1) * v_tr * sums.s; // (23f)
    if (u != NULL)
        joint_forces(robot, phi, v_phi, ubar, v_tr, dx[2 * N + 2], u, scratch);
    return regular;
}

static size_t scratch_bytes(int N)
{
    return (size_t)(N - 1) * sizeof(double);
}

static void rest(int N, double theta, double p_x, double p_y, double *x)
{
    for (int i = 0; i < 2 * N + 4; i++)
        x[i] = 0;
    x[N - 1] = theta;
    x[N] = p_x;
    x[N + 1] = p_y;
}

static void joints(int N, const double *x, double *phi, double *v_phi)
{
    for (int i = 0; i < N - 1; i++) {
        phi[i] = x[i];
        v_phi[i] = x[N + 2 + i];
    }
}

static bool rates(const moray_robot *robot, const double current[2], const double *x, const double *ubar, double *dx,
                  double *u, void *scratch)
{
    return control_rates(robot, current, x, ubar, dx, u, scratch);
}

// (12) for link i = 0..N-1, with L = 2l.
static double link_angle(const moray_robot *robot, const double *phi, int i)
{
    const double before = i > 0 ? phi[i - 1] : 0, after = i < robot->links - 1 ? phi[i] : 0;
    return (before + after) / (4 * robot->l);
}

static moray_pose pose(const moray_robot *robot, const double *x)
{
    const int N = robot->links;
    const double theta = x[N - 1], v_t = x[2 * N + 2], v_n = x[2 * N + 3];
    double largest = 0;
    for (int i = 0; i < N; i++)
        largest = fmax(largest, fabs(link_angle(robot, x, i)));
    return (moray_pose){.heading = theta,
                        .p_x = x[N],
                        .p_y = x[N + 1],
                        .v_x = v_t * cos(theta) - v_n * sin(theta), // (7)
                        .v_y = v_t * sin(theta) + v_n * cos(theta),
                        .link_angle = largest};
}

// (8), with L = 2l: t - p_t e = -L Dbar ebar, n - p_n e = -Dbar phi.
static void links(const moray_robot *robot, const double *x, double *x_i, double *y_i, double *angle_i)
{
    const int N = robot->links;
    const double theta = x[N - 1], cosine = cos(theta), sine = sin(theta);
    shape_dbar(N, x, y_i);
    for (int i = 0; i < N; i++) {
        const double t = 2 * robot->l * (i - 0.5 * (N - 1)), n = -y_i[i];
        x_i[i] = x[N] + t * cosine - n * sine;
        y_i[i] = x[N + 1] + t * sine + n * cosine;
        angle_i[i] = theta + link_angle(robot, x, i);
    }
}

const snake_model control_model = {scratch_bytes, rest, joints, rates, pose, links};
