// SPDX-License-Identifier: MIT
#include "snake/model/control_body.h"

#include <math.h>

#include "snake/model/control.h"
#include "snake/model/shape.h"

control_body moray_body_of(const moray_robot *robot, const double current[2])
{
    const control_coefficients k = moray_control_coefficients_of(robot);
    return (control_body){.N = robot->links,
                          .m = robot->m,
                          .mt = k.m_tilde,
                          .c_t = robot->c_t,
                          .c_n = robot->c_n,
                          .c_p = k.c_p,
                          .mu_p = k.mu_p,
                          .ch_n = k.c_n_hat,
                          .damping = robot->rot_damping,
                          .turning = robot->rot_gain / (robot->links - 1),
                          .frame = robot->hydro.frame == MORAY_FRAME_INVARIANT,
                          .V_x = current[0],
                          .V_y = current[1]};
}

void moray_body_features(int N, const double *phi, const double *v_phi, const double *ubar, double *bt_phi,
                         double y[FEATURES])
{
    double s = 0, q = phi[N - 2] * phi[N - 2], w = 0, z = 0;
    moray_shape_a_dbar_transposed(N, phi, bt_phi);
    for (int i = 0; i < N - 1; i++) {
        const double across = phi[i] + (i > 0 ? phi[i - 1] : 0);
        s += phi[i];
        q += across * across;
        w += bt_phi[i] * v_phi[i];
        z += bt_phi[i] * ubar[i];
    }
    y[FEATURE_S] = s;
    y[FEATURE_Q] = q;
    y[FEATURE_W] = w;
    y[FEATURE_Z] = z;
}

typedef struct pair {
    double t, n;
} pair;

// Solves the two equations in the accelerations, whose matrix is symmetric, for another right-hand side.
static pair accelerations(const control_body *body, const body_point *at, pair force)
{
    const double coupling = 2 * body->mu_p * at->y[FEATURE_S];
    return (pair){.t = at->h_1 * (body->N * body->mt * force.t + coupling * force.n),
                  .n = at->h_1 * (body->N * body->m * force.n + coupling * force.t)};
}

static void current_in_body_frame(const control_body *body, body_point *at)
{
    at->V_t = body->V_x * at->cosine + body->V_y * at->sine;
    at->V_n = -body->V_x * at->sine + body->V_y * at->cosine;
    at->v_tr = at->v_t - at->V_t;
    at->v_nr = at->v_n - at->V_n;
}

void moray_body_values(const control_body *body, const double y[FEATURES], const double in[BODY_INPUTS], body_point *at)
{
    for (int k = 0; k < FEATURES; k++)
        at->y[k] = y[k];
    const double theta = in[BODY_THETA];
    at->sine = sin(theta);
    at->cosine = cos(theta);
    at->v_t = in[BODY_V_T];
    at->v_n = in[BODY_V_N];
    current_in_body_frame(body, at);

    const double s = y[FEATURE_S], N = body->N, coupling = 2 * body->mu_p * s;
    const double determinant = N * N * body->m * body->mt - coupling * coupling; // (17)
    at->h_1 = determinant > 0 ? 1 / determinant : NAN;
    const pair force = {// sums over the links of (14a), (14b) without the accelerations of the body
                        .t = -body->mu_p * y[FEATURE_Z] - body->c_p * y[FEATURE_W] + 2 * body->c_p * s * at->v_nr -
                             (N * body->c_t + body->ch_n * y[FEATURE_Q]) * at->v_tr,
                        .n = 2 * body->c_p * s * at->v_tr - N * body->c_n * at->v_nr};
    const pair dv = accelerations(body, at, force); // (15b), (15c)
    at->dv_t = dv.t;
    at->dv_n = dv.n;
    at->kappa = body->mu_p * dv.t + body->c_p * at->v_tr;
}

void moray_body_rates(const control_body *body, const body_point *at, double v_theta, double dpose[3],
                      double dvelocity[3])
{
    dpose[0] = v_theta;
    dpose[1] = at->v_t * at->cosine - at->v_n * at->sine;
    dpose[2] = at->v_t * at->sine + at->v_n * at->cosine;
    dvelocity[0] = body->turning * at->v_tr * at->y[FEATURE_S] - body->damping * v_theta;
    dvelocity[1] = at->dv_t + body->frame * v_theta * at->v_n;
    dvelocity[2] = at->dv_n - body->frame * v_theta * at->v_t;
}

// (14b) in (15a): D D^T u = mt ubar + c_n v_phi - kappa A D^T phi, and G A D^T = -(A Dbar)^T.
void moray_body_joint_forces(const control_body *body, const body_point *at, const double *v_phi, const double *ubar,
                             const double *bt_phi, double *scratch, double *load, double *u)
{
    const int N = (int)body->N;
    for (int i = 0; i < N - 1; i++)
        scratch[i] = body->mt * ubar[i] + body->c_n * v_phi[i];
    moray_shape_gram_inverse(N, scratch, load);
    for (int i = 0; i < N - 1; i++)
        u[i] = load[i] + at->kappa * bt_phi[i];
}

// Derivative of the two equations by s, with the accelerations held.
static pair force_by_s(const control_body *body, const body_point *at)
{
    return (pair){2 * (body->mu_p * at->dv_n + body->c_p * at->v_nr), 2 * at->kappa};
}

static void gradient_by_features(const control_body *body, body_point *at)
{
    const pair force_y[FEATURES] = {[FEATURE_S] = force_by_s(body, at),
                                    [FEATURE_Q] = {-body->ch_n * at->v_tr, 0},
                                    [FEATURE_W] = {-body->c_p, 0},
                                    [FEATURE_Z] = {-body->mu_p, 0}};
    for (int k = 0; k < FEATURES; k++) {
        const pair dv = accelerations(body, at, force_y[k]);
        at->dv_t_y[k] = dv.t;
        at->dv_n_y[k] = dv.n;
        at->kappa_y[k] = body->mu_p * dv.t;
    }
}

static void gradient_by_body(const control_body *body, body_point *at)
{
    const double tr_b[BODY_INPUTS] = {-at->V_n, 1, 0}, nr_b[BODY_INPUTS] = {at->V_t, 0, 1};
    const double cross = 2 * body->c_p * at->y[FEATURE_S];
    const pair tr = accelerations(body, at, (pair){-(body->N * body->c_t + body->ch_n * at->y[FEATURE_Q]), cross});
    const pair nr = accelerations(body, at, (pair){cross, -body->N * body->c_n});
    for (int b = 0; b < BODY_INPUTS; b++) {
        at->tr_b[b] = tr_b[b];
        at->nr_b[b] = nr_b[b];
        at->dv_t_b[b] = tr.t * tr_b[b] + nr.t * nr_b[b];
        at->dv_n_b[b] = tr.n * tr_b[b] + nr.n * nr_b[b];
        at->kappa_b[b] = body->mu_p * at->dv_t_b[b] + body->c_p * tr_b[b];
    }
}

void moray_body_gradients(const control_body *body, body_point *at)
{
    gradient_by_features(body, at);
    gradient_by_body(body, at);
}

// With M dv = F: lambda . dv has the gradient eta . (F_x - M_x dv) where M eta = lambda, and the Hessian
// eta . (F_xy - M_x dv_y - M_y dv_x), for M is linear in s and free of the other inputs.
body_curvature moray_body_second(const control_body *body, const body_point *at, const body_weights *weight)
{
    const double mu_p = body->mu_p, c_p = body->c_p, bend = weight->bend, s = at->y[FEATURE_S];
    const pair eta = accelerations(body, at, (pair){weight->dv_t + mu_p * bend, weight->dv_n});
    const double turning = body->turning * weight->dv_theta;
    const pair by_s = force_by_s(body, at);
    body_curvature second = {
        .g = {[FEATURE_S] = eta.t * by_s.t + eta.n * by_s.n + turning * at->v_tr,
              [FEATURE_Q] = -eta.t * body->ch_n * at->v_tr,
              [FEATURE_W] = -eta.t * c_p,
              [FEATURE_Z] = -eta.t * mu_p},
        .a_dv_t = 2 * mu_p * eta.n,
        .a_dv_n = 2 * mu_p * eta.t,
    };
    for (int b = 0; b < BODY_INPUTS; b++) {
        second.a_b[b] = second.a_dv_t * at->dv_t_b[b] + second.a_dv_n * at->dv_n_b[b] + 2 * c_p * eta.t * at->nr_b[b] +
                        (2 * c_p * eta.n + turning) * at->tr_b[b];
        second.e_b[b] = -eta.t * body->ch_n * at->tr_b[b];
    }
    const double g_tr =
        2 * c_p * s * eta.n - (body->N * body->c_t + body->ch_n * at->y[FEATURE_Q]) * eta.t + turning * s + c_p * bend;
    const double g_nr = 2 * c_p * s * eta.t - body->N * body->c_n * eta.n;
    second.bb[BODY_THETA] = g_tr * at->V_t + g_nr * at->V_n -
                            weight->dp_x * (at->v_t * at->cosine - at->v_n * at->sine) -
                            weight->dp_y * (at->v_t * at->sine + at->v_n * at->cosine);
    second.bb[BODY_V_T] = -weight->dp_x * at->sine + weight->dp_y * at->cosine; // (7)
    second.bb[BODY_V_N] = -weight->dp_x * at->cosine - weight->dp_y * at->sine;
    return second;
}
