// SPDX-License-Identifier: MIT
//
// What the choices of hydrodynamics must have in common with one another, whatever their formulas: strips are shifted
// lambdas where drag is linear, and the limit of pieces; pieces are a chain of held joints; what is invariant is so;
// nothing but dissipation takes the joints' power.
#include <complex.h>
#include <stdlib.h>

#include "random_robot.h"

enum { MOST_PIECES = 3, FULL = 2 * MOST_PIECES * MAX_LINKS + 4 };

typedef struct {
    moray_robot robot;
    double V[2], x[MAX_STATES], ubar[MAX_LINKS];
} scene;

static scene random_scene(random_seed *seed, int N, moray_hydrodynamics hydro)
{
    scene s = {.robot = random_robot(seed, N)};
    s.robot.hydro = hydro;
    random_vector(seed, 1, 2, s.V);
    random_vector(seed, 2, 2 * N + 4, s.x);
    random_vector(seed, 5, N - 1, s.ubar);
    return s;
}

// State derivative and efforts, in one.
static void swim(const moray_robot *robot, moray_model model, const double V[2], const double *x, const double *ubar,
                 double *out)
{
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, robot, model), "swimmer");
    moray_swimmer_set_current(swimmer, V[0], V[1]);
    CHECK(moray_swimmer_rates(swimmer, x, ubar, out, out + 2 * robot->links + 4), "regular");
    moray_swimmer_free(swimmer);
}

static int outputs(int N)
{
    return 3 * N + 3;
}

// (theta'', p'', u)[2N+1] of the scene's state, with the robot's hydrodynamics replaced.
static void accelerations(const scene *s, moray_hydrodynamics hydro, double *out)
{
    const int N = s->robot.links;
    double all[3 * MAX_LINKS + 3];
    moray_robot robot = s->robot;
    robot.hydro = hydro;
    swim(&robot, MORAY_FIRST_PRINCIPLES, s->V, s->x, s->ubar, all);
    for (int i = 0; i < outputs(N) - N - 2; i++)
        out[i] = all[N + 2 + i];
}

// ---- Strips and pieces ---------------------------------------------------------------------------------------------

// The robot whose whole links feel (2)-(4) as others do with linear drag, spread by the share of c l^2/3.
static void check_shifted(random_seed *seed, int N, moray_hydrodynamics hydro, double share, double lambda_share)
{
    const scene s = random_scene(seed, N, hydro);
    scene shifted = s;
    moray_robot *r = &shifted.robot;
    double got[3 * MAX_LINKS], want[3 * MAX_LINKS];
    r->lambda_1 = lambda_share * r->lambda_1 + share * r->mu_n * r->l * r->l / 3;
    r->lambda_2 = lambda_share * r->lambda_2 + share * r->c_n * r->l * r->l / 3;
    r->lambda_3 *= pow(lambda_share, 1.5);
    accelerations(&s, hydro, got);
    accelerations(&shifted, (moray_hydrodynamics){.added_mass = hydro.added_mass}, want);
    CHECK_NEAR(relative_distance(2 * N + 1, got, want), 0, 1e-13,
               "linear drag along links shifts lambda_1 and lambda_2");
}

// Every link cut into k pieces of l/k, m/k, ... and the inertia that makes up J.
static moray_robot cut(const moray_robot *robot, int k)
{
    moray_robot cut = *robot;
    cut.links *= k;
    cut.l /= k;
    cut.J = (robot->J - robot->m * robot->l * robot->l / 3 * (1 - 1.0 / (k * k))) / k;
    cut.m /= k;
    cut.c_t /= k;
    cut.c_n /= k;
    cut.mu_n /= k;
    cut.lambda_1 /= k * k * k;
    cut.lambda_2 /= k * k * k;
    cut.lambda_3 /= k * k * k * k;
    cut.hydro.pieces = 1;
    return cut;
}

// The paper's robot of pieces is the chain of so many more links, the joints within a link held.
static void check_held_joints(random_seed *seed, int N, int k, moray_drag drag, moray_added_mass added_mass)
{
    scene s = random_scene(seed, N, (moray_hydrodynamics){.drag = drag, .added_mass = added_mass, .pieces = k});
    s.robot.J += s.robot.m * s.robot.l * s.robot.l / 3;
    const moray_robot pieces = cut(&s.robot, k);
    const int M = pieces.links;
    double x[FULL], ubar[MOST_PIECES * MAX_LINKS] = {0}, all[FULL + MOST_PIECES * MAX_LINKS], got[3 * MAX_LINKS];
    for (int half = 0; half < 2; half++) {
        for (int i = 0; i < M; i++)
            x[half * (M + 2) + i] = s.x[half * (N + 2) + i / k];
        for (int i = 0; i < 2; i++)
            x[half * (M + 2) + M + i] = s.x[half * (N + 2) + N + i];
    }
    for (int i = 0; i < N - 1; i++)
        ubar[k * (i + 1) - 1] = s.ubar[i];
    swim(&pieces, MORAY_FIRST_PRINCIPLES, s.V, x, ubar, all);
    accelerations(&s, s.robot.hydro, got);
    double want[3 * MAX_LINKS];
    for (int i = 0; i < N; i++)
        want[i] = all[M + 2 + k * i];
    for (int i = 0; i < 2; i++)
        want[N + i] = all[2 * M + 2 + i];
    for (int i = 0; i < N - 1; i++)
        want[N + 2 + i] = all[2 * M + 4 + k * (i + 1) - 1];
    CHECK_NEAR(relative_distance(N + 2, got, want), 0, 1e-10, "accelerations of a chain with held joints");
    CHECK_NEAR(relative_distance(N - 1, got + N + 2, want + N + 2), 0, 1e-10, "and its torques");
}

// The coefficients of a piece by the geometry of a link as long as it.
static void check_geometry(int k)
{
    moray_link_geometry geometry = moray_link_geometry_paper();
    const moray_robot whole = moray_robot_paper(), want = cut(&whole, k);
    moray_robot got = whole;
    geometry.length /= k;
    moray_robot_from_geometry(&got, &geometry);
    const double *of_got = &got.l, *of_want = &want.l; // l, m, J, c_t, c_n, mu_n, lambda_1..3
    double worst = 0;
    for (int i = 0; i < 9; i++)
        worst = tap_worse(worst, fabs(of_got[i] / of_want[i] - 1));
    CHECK_NEAR(worst, 0, 1e-13, "the coefficients of a piece are those of a link as long as it");
}

// Distance from the strips: of second order in 1/k.
static void check_convergence(random_seed *seed, int N, moray_drag drag)
{
    scene s = random_scene(seed, N, (moray_hydrodynamics){0});
    double limit[3 * MAX_LINKS], got[3 * MAX_LINKS], distance[2];
    accelerations(&s, (moray_hydrodynamics){.drag = drag, .rotation = MORAY_ROTATION_STRIP}, limit);
    for (int k = 0; k < 2; k++) {
        accelerations(&s, (moray_hydrodynamics){.drag = drag, .pieces = k ? 400 : 40}, got);
        distance[k] = relative_distance(2 * N + 1, got, limit);
    }
    const double order = log10(distance[0] / distance[1]);
    CHECK(order > 1.9 && order < 2.1 && distance[1] < 1e-4,
          "N = %d, drag %d: pieces come to strips by order %.3f, %.1e", N, (int)drag, order, distance[1]);
}

// ---- Observers -----------------------------------------------------------------------------------------------------

// Largest change of accelerations and efforts, relative, when water and robot move faster by as much; the accelerations
// of the control-oriented model are in the frame of the body, which turns.
static double change_by_observer(const scene *s, moray_model model, double dV_x, double dV_y)
{
    const int N = s->robot.links;
    const bool control = model == MORAY_CONTROL_ORIENTED;
    const double V[2] = {s->V[0] + dV_x, s->V[1] + dV_y}, w = s->x[2 * N + 1];
    const double c = control ? cos(s->x[N - 1]) : 1, sine = control ? sin(s->x[N - 1]) : 0;
    double x[MAX_STATES], one[3 * MAX_LINKS + 3], other[3 * MAX_LINKS + 3];
    for (int i = 0; i < 2 * N + 4; i++)
        x[i] = s->x[i];
    const double d_t = c * dV_x + sine * dV_y, d_n = c * dV_y - sine * dV_x;
    x[2 * N + 2] += d_t;
    x[2 * N + 3] += d_n;
    swim(&s->robot, model, s->V, s->x, s->ubar, one);
    swim(&s->robot, model, V, x, s->ubar, other);
    if (control) {
        other[2 * N + 2] -= w * d_n;
        other[2 * N + 3] += w * d_t;
    }
    return fmax(relative_distance(N + 2, other + N + 2, one + N + 2),
                relative_distance(N - 1, other + 2 * N + 4, one + 2 * N + 4));
}

static void check_observers(random_seed *seed, int N, moray_hydrodynamics hydro)
{
    const bool invariant = hydro.added_mass == MORAY_ADDED_MASS_INVARIANT;
    scene s = random_scene(seed, N, hydro);
    double change = change_by_observer(&s, MORAY_FIRST_PRINCIPLES, 0.7, -1.2);
    CHECK((change < 1e-12) == invariant, "added mass %s: changes by %.1e", invariant ? "invariant" : "as printed",
          change);
    random_vector(seed, 0.1, N - 1, s.x);
    change = change_by_observer(&s, MORAY_CONTROL_ORIENTED, 0.7, -1.2);
    CHECK((change < 1e-12) == (hydro.frame == MORAY_FRAME_INVARIANT), "frame: changes by %.1e", change);
}

// ---- Energy --------------------------------------------------------------------------------------------------------

// Velocities of the centres relative to the water, for complex arguments.
static void link_velocities(const scene *s, const double complex *x, double complex *v_x, double complex *v_y)
{
    const int N = s->robot.links;
    double complex tip_x = 0, tip_y = 0, mean_x = 0, mean_y = 0;
    for (int i = 0; i < N; i++) {
        const double complex half_x = -s->robot.l * csin(x[i]) * x[N + 2 + i];
        const double complex half_y = s->robot.l * ccos(x[i]) * x[N + 2 + i];
        v_x[i] = tip_x + half_x;
        v_y[i] = tip_y + half_y;
        tip_x += 2 * half_x;
        tip_y += 2 * half_y;
        mean_x += v_x[i] / N;
        mean_y += v_y[i] / N;
    }
    for (int i = 0; i < N; i++) {
        v_x[i] += x[2 * N + 2] - mean_x - s->V[0];
        v_y[i] += x[2 * N + 3] - mean_y - s->V[1];
    }
}

// Twice the kinetic energy in the water at rest, the added mass of strips by its integral over the link.
static double complex twice_energy(const scene *s, const double complex *x)
{
    const moray_robot *r = &s->robot;
    double complex v_x[MAX_LINKS], v_y[MAX_LINKS], twice = 0;
    link_velocities(s, x, v_x, v_y);
    for (int i = 0; i < r->links; i++) {
        const double complex u = ccos(x[i]) * v_y[i] - csin(x[i]) * v_x[i], w = x[r->links + 2 + i], b = w * r->l;
        const bool strip = r->hydro.rotation == MORAY_ROTATION_STRIP;
        twice += r->m * (v_x[i] * v_x[i] + v_y[i] * v_y[i]) + r->J * w * w + r->mu_n * u * u;
        twice += strip ? r->mu_n * b * b / 3 : r->lambda_1 * w * w;
    }
    return twice;
}

// Work of drag of either growth done by a velocity of v along the path of a point.
static double drag_power(moray_drag drag, double c, double v)
{
    return c * v * v * ((drag == MORAY_DRAG_QUADRATIC ? 0 : 1) + (drag == MORAY_DRAG_LINEAR ? 0 : fabs(v)));
}

static double dissipation(const scene *s, const double complex *x)
{
    enum { PARTS = 2000 };
    const moray_robot *r = &s->robot;
    double complex v_x[MAX_LINKS], v_y[MAX_LINKS];
    double power = 0;
    link_velocities(s, x, v_x, v_y);
    for (int i = 0; i < r->links; i++) {
        const double c = cos(creal(x[i])), sine = sin(creal(x[i])), w = creal(x[r->links + 2 + i]);
        const double u = c * creal(v_y[i]) - sine * creal(v_x[i]);
        power += drag_power(r->hydro.drag, r->c_t, c * creal(v_x[i]) + sine * creal(v_y[i]));
        for (int k = 0; k < PARTS && r->hydro.rotation == MORAY_ROTATION_STRIP; k++)
            power += drag_power(r->hydro.drag, r->c_n / PARTS, u + w * r->l * ((2 * k + 1.0) / PARTS - 1));
        if (r->hydro.rotation == MORAY_ROTATION_PAPER)
            power += drag_power(r->hydro.drag, r->c_n, u) + r->lambda_2 * w * w + r->lambda_3 * w * w * fabs(w);
    }
    return power;
}

// Joint power = d/dt kinetic energy + dissipation, in the invariant form: the paper's has a term left.
static void check_power(random_seed *seed, int N, moray_drag drag, moray_rotation rotation)
{
    const scene s = random_scene(seed, N, (moray_hydrodynamics){rotation, drag, MORAY_ADDED_MASS_INVARIANT, 0, 1});
    const double h = 1e-100;
    double out[3 * MAX_LINKS], joint_power = 0;
    double complex x[MAX_STATES];
    accelerations(&s, s.robot.hydro, out);
    for (int i = 0; i < N + 2; i++) {
        x[i] = s.x[i] + I * h * s.x[N + 2 + i];
        x[N + 2 + i] = s.x[N + 2 + i] + I * h * out[i];
    }
    for (int i = 0; i < N - 1; i++)
        joint_power += out[N + 2 + i] * (s.x[N + 2 + i] - s.x[N + 3 + i]);
    const double gain = cimag(twice_energy(&s, x)) / (2 * h), lost = dissipation(&s, x);
    CHECK_NEAR((joint_power - gain - lost) / (fabs(gain) + lost), 0, rotation == MORAY_ROTATION_STRIP ? 1e-6 : 1e-12,
               "joint power is gain of energy and dissipation");
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void check_refusals(void)
{
    moray_robot robot = moray_robot_paper();
    robot.hydro = moray_hydrodynamics_consistent();
    CHECK_OK(moray_robot_check(&robot), "consistent");
    robot.hydro.pieces = 2;
    CHECK(moray_robot_check(&robot).code == MORAY_INPUT, "a strip is not cut");
    robot.hydro = (moray_hydrodynamics){.pieces = -1};
    CHECK(moray_robot_check(&robot).code == MORAY_INPUT, "pieces below zero");
    robot.hydro = (moray_hydrodynamics){.drag = (moray_drag)3};
    CHECK(moray_robot_check(&robot).code == MORAY_INPUT, "no such drag");
}

int main(void)
{
    random_seed seed = 31;
    for (int N = 2; N <= MAX_LINKS; N++) {
        const moray_added_mass added_mass = N % 2 ? MORAY_ADDED_MASS_INVARIANT : MORAY_ADDED_MASS_PAPER;
        check_shifted(&seed, N, (moray_hydrodynamics){.rotation = MORAY_ROTATION_STRIP, .added_mass = added_mass}, 1,
                      0);
        check_shifted(&seed, N, (moray_hydrodynamics){.pieces = 3, .added_mass = added_mass}, 8. / 9, 1. / 9);
        check_held_joints(&seed, N, 2 + N % 2, (moray_drag)(N % 3), added_mass);
        check_convergence(&seed, N, (moray_drag)(N % 3));
        for (int k = 0; k < HYDRO_VARIANTS; k++)
            check_observers(&seed, N, hydro_variant(k));
        for (int k = 0; k < 6; k++)
            check_power(&seed, N, (moray_drag)(k / 2), (moray_rotation)(k % 2));
    }
    check_geometry(2);
    check_geometry(5);
    check_refusals();
    return tap_done();
}
