// SPDX-License-Identifier: MIT
//
// Control-oriented model: against (14), (15) solved as one linear system, against the matrices of (16)-(18) as
// printed, the errata E1 and E2, and cases worked by hand. L = 2l throughout.
#include "printed_model.h"
#include "snake/model/control.h"

// dv_t, dv_n in dv[2] and u[N-1] by the code under test.
static bool swim(const scene *s, double dv[2], double *u)
{
    const int N = s->robot.links;
    double dx[MAX_STATES], scratch[2 * MAX_LINKS];
    const bool regular = moray_control_rates(&s->robot, s->V, s->x, s->ubar, dx, u, scratch);
    dv[0] = dx[2 * N + 2];
    dv[1] = dx[2 * N + 3];
    return regular;
}

// (14) for accelerations (phi'', dv_t, dv_n)[N+1].
static void fluid_forces(const scene *s, const double *accelerations, double *f_t, double *f_n)
{
    const moray_robot *r = &s->robot;
    const int N = r->links;
    const coefficients k = by_hand(r, 2 * r->l);
    double a[MAX_LINKS], bend[MAX_LINKS], bend_rate[MAX_LINKS], v_tr, v_nr;
    relative_velocity(s, &v_tr, &v_nr);
    dense_apply(s->shape.A, true, s->x, a);
    dense_apply(s->shape.Dbar, false, accelerations, bend);
    dense_apply(s->shape.Dbar, false, s->x + N + 2, bend_rate);
    for (int i = 0; i < N; i++) {
        const double dv_n = accelerations[N] - bend[i], v_n = v_nr - bend_rate[i], dv_t = accelerations[N - 1];
        f_t[i] = k.mu_p * a[i] * dv_n + k.c_p * a[i] * v_n - (r->c_t + k.c_n_hat * a[i] * a[i]) * v_tr;
        f_n[i] = k.mu_p * a[i] * dv_t - r->mu_n * dv_n + k.c_p * a[i] * v_tr - r->c_n * v_n;
    }
}

// What (15) lacks of holding for accelerations (phi'', dv_t, dv_n)[N+1] and joint forces u.
static void residual(const scene *s, const double *accelerations, const double *u, double *out)
{
    const int N = s->robot.links;
    const double m = s->robot.m;
    double f_t[MAX_LINKS], f_n[MAX_LINKS], D_f[MAX_LINKS], gram_u[MAX_LINKS];
    fluid_forces(s, accelerations, f_t, f_n);
    dense_apply(s->shape.D, false, f_n, D_f);
    dense_apply(s->shape.gram, false, u, gram_u);
    for (int i = 0; i < N - 1; i++)
        out[i] = accelerations[i] + (D_f[i] - gram_u[i]) / m;
    out[N - 1] = accelerations[N - 1];
    out[N] = accelerations[N];
    for (int i = 0; i < N; i++) {
        out[N - 1] -= f_t[i] / (N * m);
        out[N] -= f_n[i] / (N * m);
    }
}

// (phi'', dv_t, dv_n)[N+1] that (14), (15) give for the forces u: the residual is affine in them.
static void solve_motion(const scene *s, const double *u, double *accelerations)
{
    const int n = s->robot.links + 1;
    dense matrix = dense_zero(n, n), rhs = dense_zero(n, 1);
    double unit[MAX_LINKS + 1] = {0}, at_zero[MAX_LINKS + 1], at_unit[MAX_LINKS + 1];
    residual(s, unit, u, at_zero);
    for (int j = 0; j < n; j++) {
        unit[j] = 1;
        residual(s, unit, u, at_unit);
        unit[j] = 0;
        for (int i = 0; i < n; i++)
            DENSE(matrix, i, j) = at_unit[i] - at_zero[i];
        rhs.at[j] = -at_zero[j];
    }
    dense_solve(matrix, rhs);
    for (int i = 0; i < n; i++)
        accelerations[i] = rhs.at[i];
    dense_free(&matrix);
    dense_free(&rhs);
}

static void check_equations_of_motion(random_seed *seed, int N)
{
    double error = 0;
    for (int trial = 0; trial < 5; trial++) {
        scene s = random_scene(seed, N);
        double got[MAX_LINKS + 1], want[MAX_LINKS + 1], u[MAX_LINKS];
        for (int i = 0; i < N - 1; i++)
            got[i] = s.ubar[i];
        CHECK(swim(&s, got + N - 1, u), "state %d of %d links is regular", trial, N);
        solve_motion(&s, u, want);
        error = tap_worse(error, relative_distance(N + 1, got, want));
        shape_matrices_free(&s.shape);
    }
    CHECK_NEAR(error, 0, 1e-10, "the forces u of (22) cause ubar, dv_t, dv_n by (14), (15)");
}

static void check_printed_matrices(random_seed *seed, int N)
{
    double dv_error = 0, u_error = 0, swapped_error = INFINITY;
    for (int trial = 0; trial < 5; trial++) {
        scene s = random_scene(seed, N);
        const coefficients k = by_hand(&s.robot, 2 * s.robot.l);
        const printed p = as_printed(&s, 2 * s.robot.l);
        double dv[2], u[MAX_LINKS], u_want[MAX_LINKS], v_tr, v_nr;
        CHECK(swim(&s, dv, u), "state %d of %d links is regular", trial, N);
        relative_velocity(&s, &v_tr, &v_nr);
        const double bending = k.c_p * p.w + k.mu_p * p.z;
        const double want[2] = {p.h_1 * (p.h_2 * v_nr + p.h_3 * v_tr - N * k.m_tilde * bending),
                                p.h_1 * (p.h_4 * v_tr + p.h_5 * v_nr - 2 * k.mu_p * p.s * bending)};
        const double swapped = p.h_1 * (p.h_4 * v_nr + p.h_5 * v_tr - 2 * k.mu_p * p.s * bending); // (23h)
        printed_forces(&s, 2 * s.robot.l, p, u_want);
        dv_error = tap_worse(dv_error, relative_distance(2, dv, want));
        u_error = tap_worse(u_error, relative_distance(N - 1, u, u_want));
        swapped_error = fmin(swapped_error, fabs(swapped - dv[1]) / fabs(dv[1]));
        shape_matrices_free(&s.shape);
    }
    CHECK_NEAR(dv_error, 0, 1e-10, "dv_t, dv_n against (16b), (16c)");
    CHECK_NEAR(u_error, 0, 1e-10, "u against (22) with the matrices of (18)");
    CHECK(swapped_error > 0.01, "erratum E1: (23h) as printed is off by at least %g", swapped_error);
}

// E2: with L = 2l, the coefficients of (14) are (11) at the link angle (12); in (14) off the diagonal stands +c_p, not
// the -c_p of (13) as printed.
static void check_force_law(random_seed *seed)
{
    const moray_robot r = random_robot(seed, 2);
    const control_coefficients k = moray_control_coefficients_of(&r);
    const double sum = 0.2, theta = sum / (2 * (2 * r.l)), v_t = 0.7, v_n = -0.4, dv_n = 0.9;
    const double f_11 = r.mu_n * theta * dv_n - (r.c_t + r.c_n * theta * theta) * v_t - (r.c_t - r.c_n) * theta * v_n;
    const double f_14 = k.mu_p * sum * dv_n + k.c_p * sum * v_n - (r.c_t + k.c_n_hat * sum * sum) * v_t;
    CHECK_RELATIVE(f_14, f_11, 1e-14, "erratum E2: (14a) is (11) at the angle (12) with L = 2l");
    CHECK_RELATIVE(k.m_tilde, r.m + r.mu_n, 1e-15, "m~ = m + mu_n");
}

// d/dt of the kinetic energy of the links in the t-n frame is the power of the joints plus that of the fluid: this
// fixes the sign of u.
static void check_energy_balance(random_seed *seed, int N)
{
    scene s = random_scene(seed, N);
    const double *v_phi = s.x + N + 2, v_t = s.x[2 * N + 2], v_n = s.x[2 * N + 3];
    double accelerations[MAX_LINKS + 1], u[MAX_LINKS], f_t[MAX_LINKS], f_n[MAX_LINKS];
    double bend[MAX_LINKS], bend_rate[MAX_LINKS], rate = 0, fluid = 0;
    for (int i = 0; i < N - 1; i++)
        accelerations[i] = s.ubar[i];
    CHECK(swim(&s, accelerations + N - 1, u), "a state of %d links is regular", N);
    fluid_forces(&s, accelerations, f_t, f_n);
    dense_apply(s.shape.Dbar, false, accelerations, bend);
    dense_apply(s.shape.Dbar, false, v_phi, bend_rate);
    for (int i = 0; i < N; i++) {
        rate += s.robot.m * (v_t * accelerations[N - 1] + (v_n - bend_rate[i]) * (accelerations[N] - bend[i]));
        fluid += f_t[i] * v_t + f_n[i] * (v_n - bend_rate[i]);
    }
    CHECK_RELATIVE(rate, fluid + dot(N - 1, u, v_phi), 1e-11, "energy balance");
    shape_matrices_free(&s.shape);
}

// (23a)-(23f), term by term, and u left out.
static void check_kinematics(random_seed *seed, int N)
{
    scene s = random_scene(seed, N);
    double dx[MAX_STATES], scratch[2 * MAX_LINKS], v_tr, v_nr, sum = 0;
    const double theta = s.x[N - 1], v_theta = s.x[2 * N + 1], v_t = s.x[2 * N + 2], v_n = s.x[2 * N + 3];
    CHECK(moray_control_rates(&s.robot, s.V, s.x, s.ubar, dx, NULL, scratch), "forces are optional");
    relative_velocity(&s, &v_tr, &v_nr);
    for (int i = 0; i < N - 1; i++)
        sum += s.x[i];
    CHECK(relative_distance(N, dx, s.x + N + 2) == 0, "(23a), (23b)");
    CHECK_NEAR(dx[N], v_t * cos(theta) - v_n * sin(theta), 1e-14, "(23c)");
    CHECK_NEAR(dx[N + 1], v_t * sin(theta) + v_n * cos(theta), 1e-14, "(23d)");
    CHECK(relative_distance(N - 1, dx + N + 2, s.ubar) == 0, "(23e)");
    CHECK_NEAR(dx[2 * N + 1], -s.robot.rot_damping * v_theta + s.robot.rot_gain / (N - 1) * v_tr * sum, 1e-13, "(23f)");
    shape_matrices_free(&s.shape);
}

// A straight body: slows at c_t / m along and c_n / (m + mu_n) across, without joint forces.
static void check_straight(random_seed *seed, int N)
{
    scene s = random_scene(seed, N);
    double dv[2], u[MAX_LINKS], v_tr, v_nr, largest = 0;
    random_vector(seed, 0, N - 1, s.x);
    random_vector(seed, 0, N - 1, s.x + N + 2);
    random_vector(seed, 0, N - 1, s.ubar);
    CHECK(swim(&s, dv, u), "a straight body is regular");
    relative_velocity(&s, &v_tr, &v_nr);
    CHECK_NEAR(dv[0], -s.robot.c_t / s.robot.m * v_tr, 1e-13, "slows along at c_t / m");
    CHECK_NEAR(dv[1], -s.robot.c_n / (s.robot.m + s.robot.mu_n) * v_nr, 1e-13, "slows across at c_n / (m + mu_n)");
    for (int i = 0; i < N - 1; i++)
        largest = fmax(largest, fabs(u[i]));
    CHECK(largest == 0, "a straight body does not load its joints");
    shape_matrices_free(&s.shape);
}

// Past s = N sqrt(m m~) / (2 mu_p) the added-mass matrix is no longer positive.
static void check_singular(random_seed *seed, int N)
{
    scene s = random_scene(seed, N);
    const coefficients k = by_hand(&s.robot, 2 * s.robot.l);
    const double limit = N * sqrt(s.robot.m * k.m_tilde) / (2 * k.mu_p);
    double dv[2], u[MAX_LINKS];
    for (int i = 0; i < N - 1; i++)
        s.x[i] = 0.999 * limit / (N - 1);
    CHECK(swim(&s, dv, u), "just below the limit of h_1 the motion is regular");
    for (int i = 0; i < N - 1; i++)
        s.x[i] = 1.001 * limit / (N - 1);
    CHECK(!swim(&s, dv, u), "beyond the limit of h_1 it is refused");
    s.x[0] = NAN;
    CHECK(!swim(&s, dv, u), "a NaN is refused");
    shape_matrices_free(&s.shape);
}

int main(void)
{
    random_seed seed = 23;
    check_force_law(&seed);
    for (int k = 0; k < ROBOT_SIZES; k++) {
        const int N = robot_links[k];
        check_equations_of_motion(&seed, N);
        check_printed_matrices(&seed, N);
        check_energy_balance(&seed, N);
        check_kinematics(&seed, N);
        check_straight(&seed, N);
        check_singular(&seed, N);
    }
    return tap_done();
}
