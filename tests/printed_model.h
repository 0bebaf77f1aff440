// SPDX-License-Identifier: MIT
//
// The control-oriented model by the formulas and matrices of the paper, in random states.
#ifndef TESTS_PRINTED_MODEL_H
#define TESTS_PRINTED_MODEL_H

#include "dense.h"
#include "random_robot.h"

typedef struct {
    moray_robot robot;
    double V[2], x[MAX_STATES], ubar[MAX_LINKS];
    shape_matrices shape;
} scene;

static inline scene random_scene(random_seed *seed, int N)
{
    scene s = {.robot = random_robot(seed, N), .shape = shape_matrices_new(N)};
    random_vector(seed, 1, 2, s.V);
    random_vector(seed, 2, 2 * N + 4, s.x);
    random_vector(seed, 0.2, N - 1, s.x);
    random_vector(seed, 5, N - 1, s.ubar);
    return s;
}

// Velocity relative to the current in the t-n frame: R^T of (7) minus V.
static inline void relative_velocity(const scene *s, double *v_tr, double *v_nr)
{
    const int N = s->robot.links;
    const double c = cos(s->x[N - 1]), sine = sin(s->x[N - 1]), v_t = s->x[2 * N + 2], v_n = s->x[2 * N + 3];
    const double rel_x = v_t * c - v_n * sine - s->V[0], rel_y = v_t * sine + v_n * c - s->V[1];
    *v_tr = c * rel_x + sine * rel_y;
    *v_nr = c * rel_y - sine * rel_x;
}

typedef struct {
    double c_p, mu_p, c_n_hat, m_tilde;
} coefficients;

// With L for the l of (13).
static inline coefficients by_hand(const moray_robot *r, double L)
{
    return (coefficients){(r->c_n - r->c_t) / (2 * L), r->mu_n / (2 * L), r->c_n / (4 * L * L), r->m + r->mu_n};
}

// The functions h_1..h_5 and the sums of (16)-(18), from dense products.
typedef struct {
    double h_1, h_2, h_3, h_4, h_5, s, q, w, z;
} printed;

static inline printed as_printed(const scene *scene_, double L)
{
    const moray_robot *r = &scene_->robot;
    const double N = r->links, m = r->m, *phi = scene_->x;
    const int n = r->links - 1;
    const coefficients k = by_hand(r, L);
    double a[MAX_LINKS], bend[MAX_LINKS];
    printed p = {0};
    dense_apply(scene_->shape.A, true, phi, a);
    p.q = dot(n + 1, a, a);
    for (int i = 0; i < n; i++)
        p.s += phi[i];
    dense_apply(scene_->shape.A_Dbar, false, phi + n + 3, bend);
    p.w = dot(n, phi, bend);
    dense_apply(scene_->shape.A_Dbar, false, scene_->ubar, bend);
    p.z = dot(n, phi, bend);
    p.h_1 = 1 / (N * N * m * k.m_tilde - 4 * k.mu_p * k.mu_p * p.s * p.s);
    p.h_2 = 2 * N * p.s * (k.c_p * k.m_tilde - r->c_n * k.mu_p);
    p.h_3 = 4 * k.c_p * k.mu_p * p.s * p.s - N * N * k.m_tilde * r->c_t - N * k.m_tilde * k.c_n_hat * p.q;
    p.h_4 = 2 * p.s * (N * k.c_p * m - N * r->c_t * k.mu_p - k.c_n_hat * k.mu_p * p.q);
    p.h_5 = 4 * k.c_p * k.mu_p * p.s * p.s - N * N * m * r->c_n;
    return p;
}

// (22) with M, D, K of (18) as matrices.
static inline void printed_forces(const scene *s, double L, printed p, double *u)
{
    const moray_robot *r = &s->robot;
    const int n = r->links - 1;
    const double N = r->links;
    const coefficients k = by_hand(r, L);
    double v_tr, v_nr, A_Dt_phi[MAX_LINKS], A_Dbar_phi[MAX_LINKS], total[MAX_LINKS];
    relative_velocity(s, &v_tr, &v_nr);
    dense_apply(s->shape.A_Dt, false, s->x, A_Dt_phi);
    dense_apply(s->shape.A_Dbar, true, s->x, A_Dbar_phi);
    const double K = 2 * N * k.mu_p * p.h_1 * p.s * (r->c_n * k.mu_p - k.m_tilde * k.c_p) * v_nr +
                     N * k.m_tilde * p.h_1 * (N * k.mu_p * r->c_t + k.c_n_hat * k.mu_p * p.q - N * r->m * k.c_p) * v_tr;
    for (int i = 0; i < n; i++) {
        total[i] = K * A_Dt_phi[i];
        for (int j = 0; j < n; j++) {
            const double outer = N * k.m_tilde * k.mu_p * p.h_1 * A_Dt_phi[i] * A_Dbar_phi[j];
            total[i] += ((i == j) * k.m_tilde + k.mu_p * outer) * s->ubar[j];
            total[i] += ((i == j) * r->c_n + k.c_p * outer) * s->x[n + 3 + j];
        }
    }
    dense_apply(s->shape.gram_inverse, false, total, u);
}

#endif
