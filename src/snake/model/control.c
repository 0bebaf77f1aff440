// SPDX-License-Identifier: MIT
#include "snake/model/control.h"

#include <math.h>

#include "snake/model/control_body.h"
#include "snake/model/model.h"
#include "snake/model/shape.h"

control_coefficients moray_control_coefficients_of(const moray_robot *robot)
{
    const double L = 2 * robot->l;
    return (control_coefficients){.c_p = (robot->c_n - robot->c_t) / (2 * L),
                                  .mu_p = robot->mu_n / (2 * L),
                                  .c_n_hat = robot->c_n / (4 * L * L),
                                  .m_tilde = robot->m + robot->mu_n};
}

bool moray_control_rates(const moray_robot *robot, const double current[2], const double *x, const double *ubar,
                         double *dx, double *u, double *scratch)
{
    const int N = robot->links, half = N + 2;
    const double *phi = x, *v_phi = x + half, v_theta = x[2 * N + 1];
    const control_body body = moray_body_of(robot, current);
    double y[FEATURES], *bt_phi = scratch, *load = scratch + N - 1;
    body_point at;
    moray_body_features(N, phi, v_phi, ubar, bt_phi, y);
    moray_body_values(&body, y, (const double[BODY_INPUTS]){x[N - 1], x[2 * N + 2], x[2 * N + 3]}, &at);
    for (int i = 0; i < N - 1; i++) {
        dx[i] = v_phi[i];       // (23a)
        dx[half + i] = ubar[i]; // (23e)
    }
    moray_body_rates(&body, &at, v_theta, dx + N - 1, dx + 2 * N + 1);
    if (u != NULL)
        moray_body_joint_forces(&body, &at, v_phi, ubar, bt_phi, load, u, u);
    return !isnan(at.h_1);
}

static size_t scratch_bytes(int N)
{
    return 2 * (size_t)(N - 1) * sizeof(double);
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
    return moray_control_rates(robot, current, x, ubar, dx, u, scratch);
}

// theta, p_x, p_y, and v_theta, v_t, v_n
static void body(int N, const double *x, double out[MORAY_BODY_STATES])
{
    for (int i = 0; i < 3; i++) {
        out[i] = x[N - 1 + i];
        out[3 + i] = x[2 * N + 1 + i];
    }
}

static void assemble(int N, const double *phi, const double *v_phi, const double in[MORAY_BODY_STATES], double *x)
{
    for (int i = 0; i < N - 1; i++) {
        x[i] = phi[i];
        x[N + 2 + i] = v_phi[i];
    }
    for (int i = 0; i < 3; i++) {
        x[N - 1 + i] = in[i];
        x[2 * N + 1 + i] = in[3 + i];
    }
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
    moray_shape_dbar(N, x, y_i);
    for (int i = 0; i < N; i++) {
        const double t = 2 * robot->l * (i - 0.5 * (N - 1)), n = -y_i[i];
        x_i[i] = x[N] + t * cosine - n * sine;
        y_i[i] = x[N + 1] + t * sine + n * cosine;
        angle_i[i] = theta + link_angle(robot, x, i);
    }
}

const snake_model moray_control_model = {scratch_bytes, NULL, rest, joints, body, assemble, rates, NULL, pose, links};
