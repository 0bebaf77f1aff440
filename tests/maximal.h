// SPDX-License-Identifier: MIT
//
// The first-principles robot in maximal coordinates: x_i, y_i of every link's middle, theta_i, pin joints as
// constraints with multipliers, one dense linear system. Shares nothing with the reduced form but the force laws
// (2)-(4), written here as the matrices of (3) at places along the links.
#ifndef TESTS_MAXIMAL_H
#define TESTS_MAXIMAL_H

#include "dense.h"
#include "random_robot.h"

// theta, theta' and velocities of the middles of N links, and the current.
typedef struct {
    int N;
    double theta[MAX_LINKS], dtheta[MAX_LINKS], v_x[MAX_LINKS], v_y[MAX_LINKS], V[2];
} maximal_state;

// Velocities along one axis of the middles: those of neighbours differ by l_i d_i + l_{i+1} d_{i+1}, and those of the
// centres of mass, cm_i d_i further, have the mean v by mass; d the derivative of cos theta or sin theta.
static inline void maximal_middles(const moray_robot *robot, const double *d, double v, double *out)
{
    const int N = robot->links;
    dense M = dense_zero(N, N), h = dense_zero(N, 1);
    double mass = 0;
    for (int i = 0; i < N; i++)
        mass += moray_robot_link(robot, i).m;
    h.at[N - 1] = v;
    for (int i = 0; i < N; i++) {
        const moray_link link = moray_robot_link(robot, i);
        DENSE(M, N - 1, i) = link.m / mass;
        h.at[N - 1] -= link.m / mass * link.cm * d[i];
        if (i < N - 1) {
            DENSE(M, i, i) = -1;
            DENSE(M, i, i + 1) = 1;
            h.at[i] = link.l * d[i] + moray_robot_link(robot, i + 1).l * d[i + 1];
        }
    }
    dense_solve(M, h);
    for (int i = 0; i < N; i++)
        out[i] = h.at[i];
    dense_free(&M);
    dense_free(&h);
}

static inline maximal_state maximal_from_reduced(const moray_robot *robot, const double current[2], const double *x)
{
    const int N = robot->links;
    maximal_state state = {.N = N, .V = {current[0], current[1]}};
    double d_c[MAX_LINKS], d_s[MAX_LINKS];
    for (int i = 0; i < N; i++) {
        state.theta[i] = x[i];
        state.dtheta[i] = x[N + 2 + i];
        d_c[i] = -sin(x[i]) * x[N + 2 + i];
        d_s[i] = cos(x[i]) * x[N + 2 + i];
    }
    maximal_middles(robot, d_c, x[2 * N + 2], state.v_x);
    maximal_middles(robot, d_s, x[2 * N + 3], state.v_y);
    return state;
}

// A place on a link at s from its middle, and the drag and added mass that act there.
typedef struct {
    double s, c_t, c_n, mu_n;
} maximal_spot;

enum { MAXIMAL_SPOTS = 32 };

static inline maximal_spot maximal_share(const moray_link *link, double s, double share)
{
    return (maximal_spot){link->cb + s, share * link->c_t, share * link->c_n, share * link->mu_n};
}

// Gauss's rule of three points, by which the strips' drag is exact where the velocity keeps its sign.
static inline int maximal_gauss(const moray_link *link, double half, double from, double to, maximal_spot *spots)
{
    const double node[] = {-sqrt(0.6), 0, sqrt(0.6)}, weight[] = {5. / 18, 8. / 18, 5. / 18};
    for (int j = 0; j < 3; j++)
        spots[j] = maximal_share(link, (from + to + (to - from) * node[j]) / 2, weight[j] * (to - from) / (2 * half));
    return 3;
}

// The places of a link whose centre of buoyancy moves at u across, about which they lie: that itself, the middles of
// pieces, or quadrature along the length that it halves; and its fin.
static inline int maximal_spots(const moray_robot *robot, const moray_link *link, double u, double w,
                                maximal_spot *spots)
{
    const double half = link->l - fabs(link->cb);
    const int pieces = robot->hydro.pieces > 1 ? robot->hydro.pieces : 1;
    int n = 0;
    if (robot->hydro.rotation == MORAY_ROTATION_STRIP) {
        const double still = w == 0 ? half : -u / w, cut = fmax(-half, fmin(half, still));
        n = maximal_gauss(link, half, -half, cut, spots);
        n += maximal_gauss(link, half, cut, half, spots + n);
    } else
        for (; n < pieces; n++)
            spots[n] = maximal_share(link, -half + (2 * n + 1) * half / pieces, 1.0 / pieces);
    if (robot->link)
        spots[n++] = (maximal_spot){link->fin_at, link->fin_c_t, link->fin_c_n, link->fin_mu_n};
    return n;
}

// Share of velocity and of its square in the drag, for a velocity of u.
static inline double maximal_growth(moray_drag drag, double u)
{
    return (drag == MORAY_DRAG_QUADRATIC ? 0 : 1) + (drag == MORAY_DRAG_LINEAR ? 0 : fabs(u));
}

// Adds to the rows of link i what acts on it at a place: the matrices of (2), (3) at the velocity there, relative to
// the water v = [x' - V_x; y' - V_y], with drag of either growth; in the invariant form -mu_n d/dt(n.v) across.
static inline void maximal_place(const moray_robot *robot, const maximal_state *state, int i, maximal_spot at, dense M,
                                 dense h)
{
    const double c = cos(state->theta[i]), s = sin(state->theta[i]), w = state->dtheta[i];
    const double arm[2] = {-s * at.s, c * at.s}, mu_n = at.mu_n; // of theta'
    const double v[2] = {state->v_x[i] + arm[0] * w - state->V[0], state->v_y[i] + arm[1] * w - state->V[1]};
    const double along = c * v[0] + s * v[1], across = -s * v[0] + c * v[1];
    const double c_t = at.c_t * maximal_growth(robot->hydro.drag, along);
    const double c_n = at.c_n * maximal_growth(robot->hydro.drag, across);
    const double F_a[2][2] = {{mu_n * s * s, -mu_n * s * c}, {-mu_n * s * c, mu_n * c * c}};
    const double F_ar[2][2] = {{mu_n * s * c * w, mu_n * s * s * w}, {-mu_n * c * c * w, -mu_n * s * c * w}};
    const double F_d[2][2] = {{c_t * c * c + c_n * s * s, (c_t - c_n) * s * c},
                              {(c_t - c_n) * s * c, c_t * s * s + c_n * c * c}};
    const bool invariant = robot->hydro.added_mass == MORAY_ADDED_MASS_INVARIANT;
    for (int a = 0; a < 2; a++) {
        double force = 0, turn = 0;
        for (int b = 0; b < 2; b++) {
            DENSE(M, 3 * i + a, 3 * i + b) += F_a[a][b];
            turn += F_a[a][b] * arm[b];
            force += F_ar[a][b] * (invariant ? -v[b] : state->V[b]) - F_d[a][b] * v[b];
        }
        DENSE(M, 3 * i + a, 3 * i + 2) += turn;
        DENSE(M, 3 * i + 2, 3 * i + a) += turn;
        DENSE(M, 3 * i + 2, 3 * i + 2) += turn * arm[a];
        h.at[3 * i + a] += force;
        h.at[3 * i + 2] += arm[a] * force;
    }
}

// Rows of link i: m [x''; y''] of the centre of mass at cm from the middle and J theta'' about it, and what the fluid
// does at every place; the torque (4) by lambda_1..3 of the pieces, of lengths l/k; none of strips, which have no
// length.
static inline void maximal_link(const moray_robot *robot, const maximal_state *state, int i, dense M, dense h)
{
    const moray_link link = moray_robot_link(robot, i);
    const double c = cos(state->theta[i]), s = sin(state->theta[i]), w = state->dtheta[i];
    const double k = robot->hydro.pieces > 1 ? robot->hydro.pieces : 1, first = link.m * link.cm;
    const double torque = robot->hydro.rotation == MORAY_ROTATION_STRIP ? 0 : k;
    const double u = -s * (state->v_x[i] - state->V[0]) + c * (state->v_y[i] - state->V[1]) + link.cb * w;
    maximal_spot spots[MAXIMAL_SPOTS];
    DENSE(M, 3 * i, 3 * i) = DENSE(M, 3 * i + 1, 3 * i + 1) = link.m;
    DENSE(M, 3 * i, 3 * i + 2) = DENSE(M, 3 * i + 2, 3 * i) = -first * s;
    DENSE(M, 3 * i + 1, 3 * i + 2) = DENSE(M, 3 * i + 2, 3 * i + 1) = first * c;
    DENSE(M, 3 * i + 2, 3 * i + 2) = link.J + first * link.cm + torque * link.lambda_1 / pow(k, 3);
    h.at[3 * i] += first * c * w * w;
    h.at[3 * i + 1] += first * s * w * w;
    h.at[3 * i + 2] = -torque * (link.lambda_2 / pow(k, 3) + link.lambda_3 / pow(k, 4) * fabs(w)) * w;
    const int n = maximal_spots(robot, &link, u, w, spots);
    for (int j = 0; j < n; j++)
        maximal_place(robot, state, i, spots[j], M, h);
}

static inline void maximal_couple(dense M, int row, int col, double value)
{
    DENSE(M, row, col) = value;
    DENSE(M, col, row) = -value; // the multiplier acts on both links
}

// Rows of the pin between links j and j+1: x_{j+1} - x_j = l_j cos theta_j + l_{j+1} cos theta_{j+1}, y likewise, twice
// differentiated.
static inline void maximal_pin(const moray_robot *robot, const maximal_state *state, int j, dense M, dense h)
{
    const int row = 3 * state->N + 2 * j;
    for (int i = j; i <= j + 1; i++) {
        const double c = cos(state->theta[i]), s = sin(state->theta[i]), w = state->dtheta[i];
        const double side = i == j ? -1 : 1, l = moray_robot_link(robot, i).l;
        maximal_couple(M, row, 3 * i, side);
        maximal_couple(M, row, 3 * i + 2, l * s);
        maximal_couple(M, row + 1, 3 * i + 1, side);
        maximal_couple(M, row + 1, 3 * i + 2, -l * c);
        h.at[row] -= l * c * w * w;
        h.at[row + 1] -= l * s * w * w;
    }
}

static inline dense maximal_solve(const moray_robot *robot, const maximal_state *state, const double *ubar,
                                  const double *u)
{
    const int N = state->N, pins = 3 * N, motors = pins + 2 * (N - 1), size = motors + (ubar != NULL ? N - 1 : 0);
    dense M = dense_zero(size, size), h = dense_zero(size, 1);
    for (int i = 0; i < N; i++)
        maximal_link(robot, state, i, M, h);
    for (int j = 0; j < N - 1; j++) {
        maximal_pin(robot, state, j, M, h);
        if (ubar != NULL) {
            maximal_couple(M, motors + j, 3 * j + 2, 1);
            maximal_couple(M, motors + j, 3 * j + 5, -1);
            h.at[motors + j] = ubar[j];
        } else {
            h.at[3 * j + 2] += u[j];
            h.at[3 * j + 5] -= u[j];
        }
    }
    dense_solve(M, h);
    dense_free(&M);
    return h;
}

// theta'' (N) and p_x'', p_y'' of the centre of mass from the 3N accelerations of the links.
static inline void maximal_reduce(const moray_robot *robot, const maximal_state *state, const double *links,
                                  double *out)
{
    const int N = robot->links;
    double mass = 0, x = 0, y = 0;
    for (int i = 0; i < N; i++) {
        const moray_link link = moray_robot_link(robot, i);
        const double c = cos(state->theta[i]), s = sin(state->theta[i]), w = state->dtheta[i], dw = links[3 * i + 2];
        out[i] = dw;
        mass += link.m;
        x += link.m * (links[3 * i] - link.cm * (s * dw + c * w * w));
        y += link.m * (links[3 * i + 1] + link.cm * (c * dw - s * w * w));
    }
    out[N] = x / mass;
    out[N + 1] = y / mass;
}

// Accelerations (theta'', p_x'', p_y'')[N+2] and torques u[N-1] that give the joints the accelerations ubar[N-1].
static inline void maximal_with_accelerations(const moray_robot *robot, const maximal_state *state, const double *ubar,
                                              double *accelerations, double *u)
{
    const int N = state->N;
    dense solution = maximal_solve(robot, state, ubar, NULL);
    maximal_reduce(robot, state, solution.at, accelerations);
    for (int j = 0; j < N - 1; j++)
        u[j] = solution.at[3 * N + 2 * (N - 1) + j];
    dense_free(&solution);
}

// Accelerations (theta'', p_x'', p_y'')[N+2] that the torques u[N-1] cause.
static inline void maximal_with_torques(const moray_robot *robot, const maximal_state *state, const double *u,
                                        double *accelerations)
{
    dense solution = maximal_solve(robot, state, NULL, u);
    maximal_reduce(robot, state, solution.at, accelerations);
    dense_free(&solution);
}

#endif
