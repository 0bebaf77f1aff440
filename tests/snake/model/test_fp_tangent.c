// SPDX-License-Identifier: MIT
//
// How the first-principles gradient moves along many directions at once, against a complex step along each: robots of
// equal and unequal links, all hydrodynamics, motors, forces and supply weighed or not; no more or fewer directions
// than registers hold.
#include <stdlib.h>
#include <string.h>

#include "fp_complex.h"
#include "random_robot.h"
#include "snake/model/fp_tangent.h"

enum { MOST = 19, STRIDE = 24, LINES = 2, OUT = 3 * MAX_LINKS + 2 };

typedef struct scene {
    moray_robot robot;
    moray_link link[MAX_LINKS];
    fp_part part[MAX_LINKS];
    fp_robot fp;
    double V[2], theta[MAX_LINKS], dtheta[MAX_LINKS], ubar[MAX_LINKS], v[2]; // the motion
    double lambda[3], rho[MAX_LINKS], sigma[LINES * MAX_LINKS], pi;
    bool forces, supply;
} scene;

static fp_weights weights_of(const scene *s)
{
    return (fp_weights){s->lambda, s->forces ? s->rho : NULL, s->supply ? s->sigma : NULL, s->pi};
}

static void set_scene(scene *s, random_seed *seed, int N, int variant, bool unequal, bool motors)
{
    s->robot = unequal ? random_unequal_robot(seed, N, s->link) : random_robot(seed, N);
    s->robot.hydro = hydro_variant(variant);
    if (motors)
        s->robot.motor = random_motor(seed);
    s->fp = moray_fp_robot_of(&s->robot, s->part);
    double *const part[] = {s->V, s->theta, s->dtheta, s->ubar, s->v, s->lambda, s->rho, s->sigma, &s->pi};
    const int size[] = {2, N, N, N - 1, 2, 3, N - 1, LINES * (N - 1), 1};
    for (int k = 0; k < 9; k++)
        random_vector(seed, 1, size[k], part[k]);
    s->forces = variant % 2;
    s->supply = motors;
}

// The gradient, [theta, theta', theta''] by links and then the velocity, at the motion moved by a complex step along
// direction j, over that step.
static void by_complex_step(const scene *s, const fp_directions *along, int j, double *out)
{
    const int N = s->robot.links;
    const double tiny = 1e-200; // of which the square is 0, whatever the sign
    const fp_weights weights = weights_of(s);
    double complex theta[MAX_LINKS], dtheta[MAX_LINKS], ubar[MAX_LINKS], ddtheta[MAX_LINKS], ddp[2], u[MAX_LINKS];
    double complex by_theta[MAX_LINKS], by_dtheta[MAX_LINKS], by_ddtheta[MAX_LINKS];
    fp_link_z links[MAX_LINKS];
    fp_balance_z balance;
    fp_dual_link_z dual[MAX_LINKS];
    for (int i = 0; i < N; i++) {
        theta[i] = s->theta[i] + I * tiny * along->theta[i * STRIDE + j];
        dtheta[i] = s->dtheta[i] + I * tiny * along->dtheta[i * STRIDE + j];
        if (i < N - 1)
            ubar[i] = s->ubar[i] + I * tiny * along->ubar[i * STRIDE + j];
    }
    const fp_motion_z motion = {theta, dtheta, s->v[0] + I * tiny * along->v[j],
                                s->v[1] + I * tiny * along->v[STRIDE + j], ubar};
    fp_gradient_z by = {by_theta, by_dtheta, by_ddtheta, 0, 0};
    moray_fp_accelerations_z(&s->fp, s->V, &motion, links, &balance, ddtheta, ddp);
    moray_fp_torques_z(&s->fp, &motion, links, ddtheta, u);
    moray_fp_adjoint_z(&s->fp, s->V, &motion, links, &balance, ddtheta, u, &weights, dual, &by);
    for (int i = 0; i < N; i++) {
        out[i] = cimag(by_theta[i]) / tiny;
        out[N + i] = cimag(by_dtheta[i]) / tiny;
        out[2 * N + i] = cimag(by_ddtheta[i]) / tiny;
    }
    out[3 * N] = cimag(by.v_x) / tiny;
    out[3 * N + 1] = cimag(by.v_y) / tiny;
}

// The same by the code under test: out[3 N + 2 rows x STRIDE].
static void by_tangents(const scene *s, int wide, const fp_directions *along, double *out)
{
    const int N = s->robot.links;
    const fp_weights weights = weights_of(s);
    const fp_motion_d motion = {s->theta, s->dtheta, s->v[0], s->v[1], s->ubar};
    double ddtheta[MAX_LINKS], ddp[2], u[MAX_LINKS], by[3][MAX_LINKS];
    fp_link_d links[MAX_LINKS];
    fp_balance_d balance;
    fp_dual_link_d dual[MAX_LINKS];
    fp_gradient_d gradient = {by[0], by[1], by[2], 0, 0};
    moray_fp_accelerations_d(&s->fp, s->V, &motion, links, &balance, ddtheta, ddp);
    moray_fp_torques_d(&s->fp, &motion, links, ddtheta, u);
    moray_fp_adjoint_d(&s->fp, s->V, &motion, links, &balance, ddtheta, u, &weights, dual, &gradient);
    const fp_point point = {&s->fp, s->V, &motion, links, &balance, ddtheta, u, &weights, dual};
    const fp_tangents to = {out, out + N * STRIDE, out + 2 * N * STRIDE, out + 3 * N * STRIDE};
    void *memory = malloc(moray_fp_tangents_bytes(N));
    moray_fp_tangents(wide, &point, along, memory, &to);
    free(memory);
}

static double theta[MAX_LINKS * STRIDE], dtheta[MAX_LINKS * STRIDE], ubar[MAX_LINKS * STRIDE], v[2 * STRIDE];

static double worst_of(const scene *s, int wide, int n)
{
    static double got[OUT * STRIDE];
    const int rows = 3 * s->robot.links + 2;
    const fp_directions along = {n, STRIDE, theta, dtheta, ubar, v};
    double want[OUT], column[OUT], worst = 0;
    for (int e = 0; e < rows * STRIDE; e++)
        got[e] = NAN;
    by_tangents(s, wide, &along, got);
    for (int j = 0; j < n; j++) {
        by_complex_step(s, &along, j, want);
        for (int i = 0; i < rows; i++)
            column[i] = got[i * STRIDE + j];
        worst = tap_worse(worst, relative_distance(rows, column, want));
    }
    return worst;
}

static void test_directions(random_seed *seed, int N, bool unequal, bool motors)
{
    static scene s;
    double worst = 0;
    for (int variant = 0; variant < HYDRO_VARIANTS; variant++) {
        const int n = 1 + (variant * 7 + N) % MOST;
        set_scene(&s, seed, N, variant, unequal, motors);
        random_vector(seed, 1, N * STRIDE, theta);
        random_vector(seed, 1, N * STRIDE, dtheta);
        random_vector(seed, 1, N * STRIDE, ubar);
        random_vector(seed, 1, 2 * STRIDE, v);
        for (int wide = 2; wide <= moray_fp_widest(); wide *= 2)
            worst = tap_worse(worst, worst_of(&s, wide, n));
    }
    CHECK(worst < 1e-11, "%d %s links%s, all hydrodynamics: %.1e from complex steps", N, unequal ? "unequal" : "equal",
          motors ? " with motors" : "", worst);
}

// At rest in water at rest nothing moves the drag one way rather than the other: as complex steps take it.
static void test_at_rest(random_seed *seed)
{
    static scene s;
    for (int variant = 0; variant < HYDRO_VARIANTS; variant++) {
        set_scene(&s, seed, 4, variant, variant % 2, false);
        memset(s.theta, 0, sizeof s.theta);
        memset(s.dtheta, 0, sizeof s.dtheta);
        memset(s.ubar, 0, sizeof s.ubar);
        s.v[0] = s.v[1] = s.V[0] = s.V[1] = 0;
        CHECK(worst_of(&s, moray_fp_widest(), 8) < 1e-11, "at rest, hydrodynamics %d", variant);
    }
}

int main(void)
{
    random_seed seed = 41;
    for (int N = 2; N <= MAX_LINKS; N += N < 6 ? 1 : 3)
        for (int kind = 0; kind < 4; kind++)
            test_directions(&seed, N, kind % 2, kind / 2);
    test_at_rest(&seed);
    return tap_done();
}
