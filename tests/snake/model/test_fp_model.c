// SPDX-License-Identifier: MIT
//
// First-principles model: against maximal coordinates, the energy balance, cases worked by hand, and its two number
// types against each other.
#include "fp_complex.h"
#include "maximal.h"
#include "random_robot.h"

typedef struct {
    moray_robot robot;
    double V[2], x[MAX_STATES], ubar[MAX_LINKS];
} scene;

static scene random_scene(random_seed *seed, int N)
{
    scene s = {.robot = random_robot(seed, N)};
    random_vector(seed, 1, 2, s.V);
    random_vector(seed, 2, 2 * N + 4, s.x);
    random_vector(seed, 5, N - 1, s.ubar);
    return s;
}

// (theta'', p_x'', p_y'')[N+2] and u[N-1] by the code under test.
static bool swim(const scene *s, double *accelerations, double *u)
{
    const int N = s->robot.links;
    double dx[MAX_STATES];
    moray_swimmer *swimmer;
    if (moray_failed(moray_swimmer_new(&swimmer, &s->robot, MORAY_FIRST_PRINCIPLES)))
        return false;
    moray_swimmer_set_current(swimmer, s->V[0], s->V[1]);
    const bool regular = moray_swimmer_rates(swimmer, s->x, s->ubar, dx, u);
    moray_swimmer_free(swimmer);
    for (int i = 0; i < N + 2; i++)
        accelerations[i] = dx[N + 2 + i];
    return regular && relative_distance(N + 2, dx, s->x + N + 2) == 0;
}

static void check_maximal_coordinates(random_seed *seed, int N)
{
    double accelerations_error = 0, torques_error = 0, forward_error = 0;
    for (int trial = 0; trial < HYDRO_VARIANTS; trial++) {
        scene s = random_scene(seed, N);
        s.robot.hydro = hydro_variant(trial);
        const maximal_state state = maximal_from_reduced(&s.robot, s.V, s.x);
        double a[MAX_STATES], a_want[MAX_STATES], u[MAX_LINKS], u_want[MAX_LINKS];
        CHECK(swim(&s, a, u), "state %d of %d links is regular", trial, N);
        maximal_with_accelerations(&s.robot, &state, s.ubar, a_want, u_want);
        accelerations_error = tap_worse(accelerations_error, relative_distance(N + 2, a, a_want));
        torques_error = tap_worse(torques_error, relative_distance(N - 1, u, u_want));
        maximal_with_torques(&s.robot, &state, u, a_want);
        forward_error = tap_worse(forward_error, relative_distance(N + 2, a, a_want));
    }
    CHECK_NEAR(accelerations_error, 0, 1e-10, "accelerations against maximal coordinates");
    CHECK_NEAR(torques_error, 0, 1e-10, "torques against maximal coordinates");
    CHECK_NEAR(forward_error, 0, 1e-10, "the torques cause the accelerations");
}

// Centre velocities of the links for complex arguments: steps along the chain, then the mean set to p'.
static void link_velocities(int N, double l, const double complex *x, double complex *v_x, double complex *v_y)
{
    const double complex *theta = x, *dtheta = x + N + 2;
    double complex mean_x = 0, mean_y = 0;
    v_x[0] = v_y[0] = 0;
    for (int i = 0; i < N; i++) {
        if (i > 0) {
            v_x[i] = v_x[i - 1] - l * (csin(theta[i - 1]) * dtheta[i - 1] + csin(theta[i]) * dtheta[i]);
            v_y[i] = v_y[i - 1] + l * (ccos(theta[i - 1]) * dtheta[i - 1] + ccos(theta[i]) * dtheta[i]);
        }
        mean_x += v_x[i] / N;
        mean_y += v_y[i] / N;
    }
    for (int i = 0; i < N; i++) {
        v_x[i] += x[2 * N + 2] - mean_x;
        v_y[i] += x[2 * N + 3] - mean_y;
    }
}

// Kinetic energy, added mass and added inertia included.
static double complex energy(const moray_robot *robot, const double complex *x)
{
    const int N = robot->links;
    double complex v_x[MAX_LINKS], v_y[MAX_LINKS], twice = 0;
    link_velocities(N, robot->l, x, v_x, v_y);
    for (int i = 0; i < N; i++) {
        const double complex v_n = ccos(x[i]) * v_y[i] - csin(x[i]) * v_x[i], w = x[N + 2 + i];
        twice += robot->m * (v_x[i] * v_x[i] + v_y[i] * v_y[i]) + robot->mu_n * v_n * v_n +
                 (robot->J + robot->lambda_1) * w * w;
    }
    return twice / 2;
}

// Power of drag and fluid torque on the robot, and what the form of (2) leaves: d/dt (mu_n v_n^2 / 2) holds
// mu_n v_n (a_n - theta' v_t), while the added-mass force works at the rate -mu_n v_n (a_n + theta' V_t).
static double fluid_power(const moray_robot *robot, const double V[2], const double complex *x)
{
    const int N = robot->links;
    double complex v_x[MAX_LINKS], v_y[MAX_LINKS];
    double power = 0;
    link_velocities(N, robot->l, x, v_x, v_y);
    for (int i = 0; i < N; i++) {
        const double c = cos(creal(x[i])), s = sin(creal(x[i])), w = creal(x[N + 2 + i]);
        const double v_t = c * creal(v_x[i]) + s * creal(v_y[i]), v_n = c * creal(v_y[i]) - s * creal(v_x[i]);
        const double V_t = c * V[0] + s * V[1], V_n = c * V[1] - s * V[0];
        power -= robot->c_t * v_t * (v_t - V_t) + robot->c_n * v_n * (v_n - V_n);
        power -= robot->lambda_2 * w * w + robot->lambda_3 * w * w * fabs(w);
        power -= robot->mu_n * w * v_n * (v_t + V_t);
    }
    return power;
}

static void check_energy_balance(random_seed *seed, int N, bool added_mass)
{
    const double h = 1e-100;
    double error = 0;
    for (int trial = 0; trial < 5; trial++) {
        scene s = random_scene(seed, N);
        double a[MAX_STATES], u[MAX_LINKS], v_phi[MAX_LINKS];
        double complex x[MAX_STATES];
        if (!added_mass)
            s.robot.mu_n = 0;
        CHECK(swim(&s, a, u), "state %d of %d links is regular", trial, N);
        for (int i = 0; i < N + 2; i++) {
            x[i] = s.x[i] + I * h * s.x[N + 2 + i];
            x[N + 2 + i] = s.x[N + 2 + i] + I * h * a[i];
        }
        for (int i = 0; i < N - 1; i++)
            v_phi[i] = s.x[N + 2 + i] - s.x[N + 3 + i];
        const double rate = cimag(energy(&s.robot, x)) / h;
        const double balance = dot(N - 1, u, v_phi) + fluid_power(&s.robot, s.V, x);
        error = tap_worse(error, fabs(rate - balance) / fabs(creal(energy(&s.robot, x))));
    }
    CHECK_NEAR(error, 0, 1e-11, added_mass ? "energy balance" : "energy balance without added mass");
}

// A straight body at any heading moving at v_t, v_n relative to the current: nothing turns it or loads a joint.
static void check_straight(random_seed *seed, int N, double v_t, double v_n)
{
    scene s = random_scene(seed, N);
    const double heading = s.x[0], c = cos(heading), sine = sin(heading);
    double a[MAX_STATES], u[MAX_LINKS];
    for (int i = 0; i < 2 * N + 4; i++)
        s.x[i] = i < N ? heading : 0;
    s.x[2 * N + 2] = s.V[0] + c * v_t - sine * v_n;
    s.x[2 * N + 3] = s.V[1] + sine * v_t + c * v_n;
    random_vector(seed, 0, N - 1, s.ubar);
    CHECK(swim(&s, a, u), "a straight body is regular");
    CHECK_NEAR(c * a[N] + sine * a[N + 1], -s.robot.c_t / s.robot.m * v_t, 1e-13, "slows along at c_t / m");
    CHECK_NEAR(c * a[N + 1] - sine * a[N], -s.robot.c_n / (s.robot.m + s.robot.mu_n) * v_n, 1e-13,
               "slows across at c_n / (m + mu_n)");
    double turning = 0, torque = 0;
    for (int i = 0; i < N; i++)
        turning = tap_worse(turning, fabs(a[i]));
    CHECK_NEAR(turning, 0, 1e-13, "a straight body does not turn");
    for (int i = 0; i < N - 1; i++)
        torque = tap_worse(torque, fabs(u[i]));
    CHECK_NEAR(torque, 0, 1e-13, "nor load its joints");
}

// A straight body spinning at rate w in still water, by hand: theta'' times the moment of inertia about the middle is
// the moment of drag, with link k at r_k = 2l (k - (N-1)/2).
static void check_spin(random_seed *seed, int N, double w)
{
    scene s = random_scene(seed, N);
    const moray_robot *r = &s.robot;
    double a[MAX_STATES], u[MAX_LINKS], r_squared = 0;
    for (int i = 0; i < 2 * N + 4; i++)
        s.x[i] = i < N ? 0.7 : i < N + 2 || i >= 2 * N + 2 ? 0 : w;
    random_vector(seed, 0, 2, s.V);
    random_vector(seed, 0, N - 1, s.ubar);
    for (int k = 0; k < N; k++)
        r_squared += pow(2 * r->l * (k - 0.5 * (N - 1)), 2);
    CHECK(swim(&s, a, u), "a spinning body is regular");
    const double inertia = N * (r->J + r->lambda_1) + (r->m + r->mu_n) * r_squared;
    const double moment = -N * (r->lambda_2 * w + r->lambda_3 * w * fabs(w)) - r->c_n * w * r_squared;
    CHECK_RELATIVE(a[0], moment / inertia, 1e-12, "a spinning body slows by lambda_2, lambda_3 and c_n");
    CHECK_NEAR(hypot(a[N], a[N + 1]), 0, 1e-12, "and stays where it is");
}

// Without added mass only the velocity relative to the current counts; with it, not so in the paper's form.
static void check_moving_frame(random_seed *seed, int N, bool added_mass)
{
    scene s = random_scene(seed, N);
    double a[MAX_STATES], u[MAX_LINKS], a_moved[MAX_STATES], u_moved[MAX_LINKS];
    if (!added_mass)
        s.robot.mu_n = 0;
    const bool regular = swim(&s, a, u);
    s.x[2 * N + 2] -= s.V[0];
    s.x[2 * N + 3] -= s.V[1];
    random_vector(seed, 0, 2, s.V);
    CHECK(regular && swim(&s, a_moved, u_moved), "both frames are regular");
    const double distance = relative_distance(N + 2, a_moved, a) + relative_distance(N - 1, u_moved, u);
    CHECK((distance < 1e-12) == !added_mass, "frame of the current %s added mass: differs by %g",
          added_mass ? "with" : "without", distance);
}

// The whole scene turned by beta: torques and angular accelerations stay, p'' turns with it.
static void check_turned(random_seed *seed, int N)
{
    scene s = random_scene(seed, N);
    const double beta = 2.1, c = cos(beta), sine = sin(beta);
    double a[MAX_STATES], u[MAX_LINKS], a_turned[MAX_STATES], u_turned[MAX_LINKS];
    const bool regular = swim(&s, a, u);
    double *pairs[] = {s.V, s.x + 2 * N + 2, a + N};
    for (int k = 0; k < 3; k++) {
        const double kept = pairs[k][0];
        pairs[k][0] = c * kept - sine * pairs[k][1];
        pairs[k][1] = sine * kept + c * pairs[k][1];
    }
    for (int i = 0; i < N; i++)
        s.x[i] += beta;
    CHECK(regular && swim(&s, a_turned, u_turned), "both headings are regular");
    CHECK_NEAR(relative_distance(N + 2, a_turned, a), 0, 1e-11, "accelerations turn with the scene");
    CHECK_NEAR(relative_distance(N - 1, u_turned, u), 0, 1e-11, "torques do not change");
}

enum { MAX_OUT = 2 * MAX_LINKS + 2 };

// theta''(N), p''(2), u (N-1), power for double arguments.
static void outputs_d(const scene *s, const double *x, const double *ubar, double *out)
{
    const int N = s->robot.links;
    fp_part part[MAX_LINKS];
    const fp_robot robot = moray_fp_robot_of(&s->robot, part);
    fp_link_d links[MAX_LINKS];
    const fp_motion_d motion = {x, x + N + 2, x[2 * N + 2], x[2 * N + 3], ubar};
    fp_balance_d balance;
    moray_fp_accelerations_d(&robot, s->V, &motion, links, &balance, out, out + N);
    out[2 * N + 1] = moray_fp_torques_d(&robot, &motion, links, out, out + N + 2);
}

static void outputs_z(const scene *s, const double complex *x, const double complex *ubar, double complex *out)
{
    const int N = s->robot.links;
    fp_part part[MAX_LINKS];
    const fp_robot robot = moray_fp_robot_of(&s->robot, part);
    fp_link_z links[MAX_LINKS];
    const fp_motion_z motion = {x, x + N + 2, x[2 * N + 2], x[2 * N + 3], ubar};
    fp_balance_z balance;
    moray_fp_accelerations_z(&robot, s->V, &motion, links, &balance, out, out + N);
    out[2 * N + 1] = moray_fp_torques_z(&robot, &motion, links, out, out + N + 2);
}

// (f(h) - f(-h)) / 2h along a direction.
static void difference(const scene *s, const scene *direction, double h, double *out)
{
    const int N = s->robot.links, n_out = 2 * N + 2;
    double x[2][MAX_STATES], ubar[2][MAX_LINKS], ends[2][MAX_OUT];
    for (int side = 0; side < 2; side++) {
        const double step = side == 0 ? -h : h;
        for (int i = 0; i < 2 * N + 4; i++)
            x[side][i] = s->x[i] + step * direction->x[i];
        for (int i = 0; i < N - 1; i++)
            ubar[side][i] = s->ubar[i] + step * direction->ubar[i];
        outputs_d(s, x[side], ubar[side], ends[side]);
    }
    for (int k = 0; k < n_out; k++)
        out[k] = (ends[1][k] - ends[0][k]) / (2 * h);
}

static void check_number_types(random_seed *seed, int N, moray_hydrodynamics hydro)
{
    scene s = random_scene(seed, N);
    const scene direction = random_scene(seed, N);
    s.robot.hydro = hydro;
    const int n_out = 2 * N + 2;
    const double tiny = 1e-100, h = 1e-3;
    double complex x[MAX_STATES], ubar[MAX_LINKS], out_z[MAX_OUT];
    double out[MAX_OUT], real[MAX_OUT], slope[MAX_OUT], fine[MAX_OUT], finer[MAX_OUT];
    for (int i = 0; i < 2 * N + 4; i++)
        x[i] = s.x[i] + I * tiny * direction.x[i];
    for (int i = 0; i < N - 1; i++)
        ubar[i] = s.ubar[i] + I * tiny * direction.ubar[i];
    outputs_d(&s, s.x, s.ubar, out);
    outputs_z(&s, x, ubar, out_z);
    difference(&s, &direction, h, fine);
    difference(&s, &direction, h / 2, finer);
    for (int k = 0; k < n_out; k++) {
        real[k] = creal(out_z[k]);
        slope[k] = cimag(out_z[k]) / tiny;
        finer[k] += (finer[k] - fine[k]) / 3; // Richardson: the error is O(h^4)
    }
    CHECK_NEAR(relative_distance(n_out, real, out), 0, 1e-14 * N, "double complex has the values of double");
    CHECK_NEAR(relative_distance(n_out, slope, finer), 0, 1e-8, "complex step against differences of double");
    double v_phi[MAX_LINKS];
    for (int i = 0; i < N - 1; i++)
        v_phi[i] = s.x[N + 2 + i] - s.x[N + 3 + i];
    CHECK_RELATIVE(out[n_out - 1], dot(N - 1, out + N + 2, v_phi), 1e-12, "power is sum u_i phi_i'");
}

int main(void)
{
    random_seed seed = 20;
    for (int N = 2; N <= MAX_LINKS; N++)
        check_maximal_coordinates(&seed, N);
    for (int k = 0; k < ROBOT_SIZES; k++) {
        const int N = robot_links[k];
        check_energy_balance(&seed, N, false);
        check_energy_balance(&seed, N, true);
        check_straight(&seed, N, 0, 0);
        check_straight(&seed, N, -0.3, 0);
        check_straight(&seed, N, 0.2, -0.3);
        check_spin(&seed, N, 0.8);
        check_spin(&seed, N, -0.8);
        check_moving_frame(&seed, N, false);
        check_moving_frame(&seed, N, true);
        check_turned(&seed, N);
        check_number_types(&seed, N, hydro_variant(0));
        check_number_types(&seed, N, moray_hydrodynamics_consistent());
    }
    return tap_done();
}
