// SPDX-License-Identifier: MIT
//
// With N_k = f_k - (m I + F^a_k) a_k the net force on link k and Q_k = inertia theta_k'' - tau_k, both zero
// in sum by the balances, any F is
//     F = lambda . y + sum_k (N_k . xi_k - turn_k Q_k)
// where turn_k = mu_0 - W_k, xi_k = (mu_1, mu_2) + sum_m C_km l n_m turn_m moves the centres as the chain does, and
// W_k = sum_{j >= k} (rho_j + pi phi_j') brings in the torques. mu makes this stationary in the accelerations y, which
// then need no derivatives of their own.
#include "snake/model/fp_adjoint.h"

#include <tgmath.h>

typedef fp_vector_z vector;
typedef double complex num;

static num dot(vector a, vector b)
{
    return a.x * b.x + a.y * b.y;
}

static vector sum(num p, vector a, num q, vector b)
{
    return (vector){p * a.x + q * b.x, p * a.y + q * b.y};
}

static vector along(const fp_link_z *link)
{
    return (vector){link->c, link->s};
}

static vector across(const fp_link_z *link)
{
    return (vector){-link->s, link->c};
}

// (m I + F^a) a
static vector inertia(const fp_robot *robot, const fp_link_z *link, vector a)
{
    return sum(robot->m, a, robot->mu_n * dot(across(link), a), across(link));
}

// -W_k, the rotations that the weights of torques and power ask for.
static void own_turns(int N, const fp_motion_z *motion, const fp_weights *weight, fp_dual_link *dual)
{
    num W = 0;
    dual[N - 1].turn = 0;
    for (int k = N - 2; k >= 0; k--) {
        W += (weight->rho ? weight->rho[k] : 0) + weight->pi * (motion->dtheta[k] - motion->dtheta[k + 1]);
        dual[k].turn = -W;
    }
}

// xi_k = shift + sum_m C_km l n_m turn_m
static void follow_chain(int N, double l, const fp_link_z *links, vector shift, fp_dual_link *dual)
{
    vector tip = {0, 0}, mean = {0, 0};
    for (int k = 0; k < N; k++) {
        const num half = l * dual[k].turn;
        dual[k].xi = sum(1, tip, half, across(&links[k]));
        tip = sum(1, tip, 2 * half, across(&links[k]));
        mean = sum(1, mean, 1.0 / N, dual[k].xi);
    }
    for (int k = 0; k < N; k++)
        dual[k].xi = sum(1, sum(1, dual[k].xi, -1, mean), 1, shift);
}

// mu from S mu = lambda - what the own rotations weigh on the accelerations already.
static void balance(const fp_robot *robot, const fp_motion_z *motion, const fp_link_z *links, const fp_weights *weight,
                    fp_dual_link *dual)
{
    const int N = robot->links;
    num mu[3] = {weight->lambda[0], weight->lambda[1], weight->lambda[2]};
    own_turns(N, motion, weight, dual);
    follow_chain(N, robot->l, links, (vector){0, 0}, dual);
    for (int k = 0; k < N; k++) {
        const vector load = inertia(robot, &links[k], dual[k].xi);
        mu[0] -= links[k].r.x * load.y - links[k].r.y * load.x + robot->inertia * dual[k].turn;
        mu[1] -= load.x;
        mu[2] -= load.y;
    }
    moray_fp_balances_z(robot, links, mu);
    for (int k = 0; k < N; k++)
        dual[k].turn += mu[0];
    follow_chain(N, robot->l, links, (vector){mu[1], mu[2]}, dual);
}

// Derivatives of a link's f_t, f_n and tau by rel_t, rel_n and theta'.
typedef struct slopes {
    num t_t, n_t, n_n, n_w, tau_n, tau_w;
} slopes;

static num modulus(num x)
{
    return creal(x) < 0 ? -x : x;
}

static slopes fluid_slopes(const fp_robot *robot, num rel_t, num rel_n, num w, num turned)
{
    const double l = robot->l;
    slopes by = {.t_t = -robot->c_t - 2 * robot->q_t * modulus(rel_t),
                 .n_t = robot->invariant ? robot->mu_n * w : 0,
                 .n_n = -robot->c_n,
                 .n_w = robot->mu_n * turned,
                 .tau_w = -(robot->lambda_2 + 2 * robot->lambda_3 * modulus(w))};
    if (robot->q_n > 0) {
        const fp_drag_z drag = moray_fp_drag_slopes_z(robot, rel_n, w);
        by.n_n -= robot->q_n * drag.aa;
        by.n_w -= robot->q_n * l * drag.ab;
        by.tau_n = -robot->q_n * l * drag.ab;
        by.tau_w -= robot->q_n * l * l * drag.bb;
    }
    return by;
}

// What a link's own orientation, rate, velocity and acceleration do to N_k . xi_k - turn_k Q_k. As the link turns, its
// axes do: d rel_t = rel_n, d rel_n = -rel_t.
static void own_derivatives(const fp_robot *robot, const double V[2], const fp_link_z *link, num w, fp_dual_link *dual,
                            num *on_theta, num *on_w)
{
    const vector t = along(link), n = across(link), xi = dual->xi, water = {V[0], V[1]};
    const vector rel = sum(1, link->v, -1, water);
    const num rel_t = dot(t, rel), rel_n = dot(n, rel), xi_t = dot(t, xi), xi_n = dot(n, xi);
    const num turned = robot->invariant ? rel_t : -dot(t, water), turned_on = robot->invariant ? rel_n : -dot(n, water);
    const slopes by = fluid_slopes(robot, rel_t, rel_n, w, turned);
    const num by_theta_t = by.t_t * rel_n - link->f_n; // of d f / d theta
    const num by_theta_n = link->f_t - by.n_n * rel_t + robot->mu_n * w * turned_on;
    const num added = robot->mu_n * (dot(n, link->a) * xi_t + dot(t, link->a) * xi_n); // -d(xi F^a a) / d theta
    dual->net = sum(1, link->f, -1, inertia(robot, link, link->a));
    dual->on_v = sum(by.t_t * xi_t + by.n_t * xi_n, t, by.n_n * xi_n + by.tau_n * dual->turn, n);
    dual->on_a = sum(-1, inertia(robot, link, xi), 0, xi);
    *on_theta = by_theta_t * xi_t + by_theta_n * xi_n + added - by.tau_n * dual->turn * rel_t;
    *on_w = by.n_w * xi_n + dual->turn * by.tau_w;
}

// One more sum along the chain, from the head on: sum_k C_km z_k = z_m + 2 sum_{k > m} z_k of z less its mean.
typedef struct column {
    vector mean, behind;
} column;

static vector next_column(column *at, vector z)
{
    const vector own = sum(1, z, -1, at->mean), all = sum(1, own, 2, at->behind);
    at->behind = sum(1, at->behind, 1, own);
    return all;
}

static void chain_derivatives(const fp_robot *robot, const fp_motion_z *motion, const fp_link_z *links,
                              const num *ddtheta, const fp_dual_link *dual, fp_gradient *out)
{
    const int N = robot->links;
    const double l = robot->l, share = 1.0 / N;
    column net = {0}, on_v = {0}, on_a = {0};
    for (int k = 0; k < N; k++) {
        net.mean = sum(1, net.mean, share, dual[k].net);
        on_v.mean = sum(1, on_v.mean, share, dual[k].on_v);
        on_a.mean = sum(1, on_a.mean, share, dual[k].on_a);
    }
    out->v_x = N * on_v.mean.x;
    out->v_y = N * on_v.mean.y;
    for (int k = N - 1; k >= 0; k--) {
        const vector t = along(&links[k]), n = across(&links[k]);
        const vector by_xi = next_column(&net, dual[k].net), by_v = next_column(&on_v, dual[k].on_v);
        const vector by_a = next_column(&on_a, dual[k].on_a);
        const num w = motion->dtheta[k];
        out->theta[k] -=
            l * (dual[k].turn * dot(t, by_xi) + w * dot(t, by_v) + ddtheta[k] * dot(t, by_a) + w * w * dot(n, by_a));
        out->dtheta[k] += l * (dot(n, by_v) - 2 * w * dot(t, by_a));
        out->ddtheta[k] = l * dot(n, by_a) - dual[k].turn * robot->inertia;
    }
}

void moray_fp_adjoint(const fp_robot *robot, const double V[2], const fp_motion_z *motion, const fp_link_z *links,
                      const num *ddtheta, const num *u, const fp_weights *weight, fp_dual_link *dual, fp_gradient *out)
{
    const int N = robot->links;
    balance(robot, motion, links, weight, dual);
    for (int k = 0; k < N; k++)
        own_derivatives(robot, V, &links[k], motion->dtheta[k], &dual[k], &out->theta[k], &out->dtheta[k]);
    chain_derivatives(robot, motion, links, ddtheta, dual, out);
    for (int j = 0; j < N - 1; j++) { // phi_j' in the power
        out->dtheta[j] += weight->pi * u[j];
        out->dtheta[j + 1] -= weight->pi * u[j];
    }
}

num moray_fp_pull_angles(int N, const num *on_angles, num *on_joints)
{
    num mean = 0, behind = 0;
    for (int i = 0; i < N; i++)
        mean += on_angles[i] / N;
    for (int i = N - 1; i > 0; i--) {
        behind += on_angles[i] - mean;
        on_joints[i - 1] = -behind;
    }
    return N * mean;
}
