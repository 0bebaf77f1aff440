// SPDX-License-Identifier: MIT
//
// The first-principles robot in maximal coordinates: x_i, y_i, theta_i of every link, pin joints as constraints with
// multipliers, one dense linear system. Shares nothing with the reduced form but the force laws (2)-(4), written here
// as the matrices of (3) at places along the links.
#ifndef TESTS_MAXIMAL_H
#define TESTS_MAXIMAL_H

#include "dense.h"
#include "random_robot.h"

// theta, theta' and centre velocities of N links, and the current.
typedef struct {
    int N;
    double theta[MAX_LINKS], dtheta[MAX_LINKS], v_x[MAX_LINKS], v_y[MAX_LINKS], V[2];
} maximal_state;

// The state of moray/snake.h with velocities by differentiating x = p_x e - l Dbar A cos(theta), y = p_y e - l Dbar A
// sin(theta).
static inline maximal_state maximal_from_reduced(const moray_robot *robot, const double current[2], const double *x)
{
    const int N = robot->links;
    maximal_state state = {.N = N, .V = {current[0], current[1]}};
    shape_matrices s = shape_matrices_new(N);
    dense Dbar_A = dense_product(s.Dbar, false, s.A, false);
    for (int i = 0; i < N; i++) {
        state.theta[i] = x[i];
        state.dtheta[i] = x[N + 2 + i];
        state.v_x[i] = x[2 * N + 2];
        state.v_y[i] = x[2 * N + 3];
        for (int j = 0; j < N; j++) {
            state.v_x[i] += robot->l * DENSE(Dbar_A, i, j) * sin(x[j]) * x[N + 2 + j];
            state.v_y[i] -= robot->l * DENSE(Dbar_A, i, j) * cos(x[j]) * x[N + 2 + j];
        }
    }
    dense_free(&Dbar_A);
    shape_matrices_free(&s);
    return state;
}

// A place on a link at s from its centre, and the share of the link's drag and added mass that acts there.
typedef struct {
    double s, share;
} maximal_spot;

enum { MAXIMAL_SPOTS = 32 };

// Gauss's rule of three points, by which the strips' drag is exact where the velocity keeps its sign.
static inline int maximal_gauss(double l, double from, double to, maximal_spot *spots)
{
    const double node[] = {-sqrt(0.6), 0, sqrt(0.6)}, weight[] = {5. / 18, 8. / 18, 5. / 18};
    for (int j = 0; j < 3; j++)
        spots[j] = (maximal_spot){(from + to + (to - from) * node[j]) / 2, weight[j] * (to - from) / (2 * l)};
    return 3;
}

// The places of a link that moves at u across at its centre: its centre, those of its pieces, or quadrature along it.
static inline int maximal_spots(const moray_robot *robot, double u, double w, maximal_spot *spots)
{
    const double l = robot->l;
    if (robot->hydro.rotation == MORAY_ROTATION_STRIP) {
        const double still = w == 0 ? l : -u / w, cut = fmax(-l, fmin(l, still));
        const int n = maximal_gauss(l, -l, cut, spots);
        return n + maximal_gauss(l, cut, l, spots + n);
    }
    const int pieces = robot->hydro.pieces > 1 ? robot->hydro.pieces : 1;
    for (int j = 0; j < pieces; j++)
        spots[j] = (maximal_spot){-l + (2 * j + 1) * l / pieces, 1.0 / pieces};
    return pieces;
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
    const double arm[2] = {-s * at.s, c * at.s}, mu_n = at.share * robot->mu_n; // of theta'
    const double v[2] = {state->v_x[i] + arm[0] * w - state->V[0], state->v_y[i] + arm[1] * w - state->V[1]};
    const double along = c * v[0] + s * v[1], across = -s * v[0] + c * v[1];
    const double c_t = at.share * robot->c_t * maximal_growth(robot->hydro.drag, along);
    const double c_n = at.share * robot->c_n * maximal_growth(robot->hydro.drag, across);
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

// Rows of link i: m [x''; y''] and J theta'' and what the fluid does at every place; the torque (4) by lambda_1..3 of
// the pieces, of lengths l/k; none of strips, which have no length.
static inline void maximal_link(const moray_robot *robot, const maximal_state *state, int i, dense M, dense h)
{
    const double w = state->dtheta[i], k = robot->hydro.pieces > 1 ? robot->hydro.pieces : 1;
    const double torque = robot->hydro.rotation == MORAY_ROTATION_STRIP ? 0 : k;
    const double rel_n =
        -sin(state->theta[i]) * (state->v_x[i] - state->V[0]) + cos(state->theta[i]) * (state->v_y[i] - state->V[1]);
    maximal_spot spots[MAXIMAL_SPOTS];
    DENSE(M, 3 * i, 3 * i) = DENSE(M, 3 * i + 1, 3 * i + 1) = robot->m;
    DENSE(M, 3 * i + 2, 3 * i + 2) = robot->J + torque * robot->lambda_1 / pow(k, 3);
    h.at[3 * i + 2] = -torque * (robot->lambda_2 / pow(k, 3) + robot->lambda_3 / pow(k, 4) * fabs(w)) * w;
    const int n = maximal_spots(robot, rel_n, w, spots);
    for (int j = 0; j < n; j++)
        maximal_place(robot, state, i, spots[j], M, h);
}

static inline void maximal_couple(dense M, int row, int col, double value)
{
    DENSE(M, row, col) = value;
    DENSE(M, col, row) = -value; // the multiplier acts on both links
}

// Rows of the pin between links j and j+1: x_{j+1} - x_j = l (cos theta_j + cos theta_{j+1}), y likewise, twice
// differentiated.
static inline void maximal_pin(const moray_robot *robot, const maximal_state *state, int j, dense M, dense h)
{
    const int row = 3 * state->N + 2 * j;
    for (int i = j; i <= j + 1; i++) {
        const double c = cos(state->theta[i]), s = sin(state->theta[i]), w = state->dtheta[i];
        const double side = i == j ? -1 : 1;
        maximal_couple(M, row, 3 * i, side);
        maximal_couple(M, row, 3 * i + 2, robot->l * s);
        maximal_couple(M, row + 1, 3 * i + 1, side);
        maximal_couple(M, row + 1, 3 * i + 2, -robot->l * c);
        h.at[row] -= robot->l * c * w * w;
        h.at[row + 1] -= robot->l * s * w * w;
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

// theta'' (N) and p_x'', p_y'' from the 3N accelerations of the links.
static inline void maximal_reduce(int N, const double *links, double *out)
{
    out[N] = out[N + 1] = 0;
    for (int i = 0; i < N; i++) {
        out[i] = links[3 * i + 2];
        out[N] += links[3 * i] / N;
        out[N + 1] += links[3 * i + 1] / N;
    }
}

// Accelerations (theta'', p_x'', p_y'')[N+2] and torques u[N-1] that give the joints the accelerations ubar[N-1].
static inline void maximal_with_accelerations(const moray_robot *robot, const maximal_state *state, const double *ubar,
                                              double *accelerations, double *u)
{
    const int N = state->N;
    dense solution = maximal_solve(robot, state, ubar, NULL);
    maximal_reduce(N, solution.at, accelerations);
    for (int j = 0; j < N - 1; j++)
        u[j] = solution.at[3 * N + 2 * (N - 1) + j];
    dense_free(&solution);
}

// Accelerations (theta'', p_x'', p_y'')[N+2] that the torques u[N-1] cause.
static inline void maximal_with_torques(const moray_robot *robot, const maximal_state *state, const double *u,
                                        double *accelerations)
{
    dense solution = maximal_solve(robot, state, NULL, u);
    maximal_reduce(state->N, solution.at, accelerations);
    dense_free(&solution);
}

#endif
