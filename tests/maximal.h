// SPDX-License-Identifier: MIT
//
// The first-principles robot in maximal coordinates: x_i, y_i, theta_i of every link, pin joints as constraints with
// multipliers, one dense linear system. Shares nothing with the reduced form but the force laws (2)-(4), written here
// as the matrices of (3).
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

// Rows of link i: (m I + F^a) [x''; y''] = F^{a,r} V - F^d [x' - V_x; y' - V_y] and (J + lambda_1) theta'' = ...
static inline void maximal_link(const moray_robot *robot, const maximal_state *state, int i, dense M, dense h)
{
    const double c = cos(state->theta[i]), s = sin(state->theta[i]), w = state->dtheta[i], mu_n = robot->mu_n;
    const double c_t = robot->c_t, c_n = robot->c_n;
    const double F_a[2][2] = {{mu_n * s * s, -mu_n * s * c}, {-mu_n * s * c, mu_n * c * c}};
    const double F_ar[2][2] = {{mu_n * s * c * w, mu_n * s * s * w}, {-mu_n * c * c * w, -mu_n * s * c * w}};
    const double F_d[2][2] = {{c_t * c * c + c_n * s * s, (c_t - c_n) * s * c},
                              {(c_t - c_n) * s * c, c_t * s * s + c_n * c * c}};
    const double rel[2] = {state->v_x[i] - state->V[0], state->v_y[i] - state->V[1]};
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) {
            DENSE(M, 3 * i + a, 3 * i + b) = (a == b) * robot->m + F_a[a][b];
            h.at[3 * i + a] += F_ar[a][b] * state->V[b] - F_d[a][b] * rel[b];
        }
    DENSE(M, 3 * i + 2, 3 * i + 2) = robot->J + robot->lambda_1;
    h.at[3 * i + 2] = -robot->lambda_2 * w - robot->lambda_3 * w * fabs(w);
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
