// SPDX-License-Identifier: MIT
//
// Robots of unequal links: the first-principles model against maximal coordinates, its derivatives against differences,
// the balance of energy along a simulation; links that are equal give the digits of the equal robot.
#include <string.h>

#include "maximal.h"
#include "moray/snake/plant.h"

enum { INPUTS = 200 };

// Accelerations [N+2] and torques [N-1] of a state.
static void swim(const moray_robot *robot, const double V[2], const double *x, const double *ubar, double *a, double *u)
{
    const int N = robot->links;
    double dx[MAX_STATES];
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, robot, MORAY_FIRST_PRINCIPLES), "swimmer");
    moray_swimmer_set_current(swimmer, V[0], V[1]);
    CHECK(moray_swimmer_rates(swimmer, x, ubar, dx, u), "regular");
    memcpy(a, dx + N + 2, (size_t)(N + 2) * sizeof *a);
    moray_swimmer_free(swimmer);
}

static void check_maximal(random_seed *seed, int N)
{
    double V[2], x[MAX_STATES], ubar[MAX_LINKS], a[MAX_STATES], want[MAX_STATES], u[MAX_LINKS], u_want[MAX_LINKS];
    double worst[3] = {0};
    moray_link link[MAX_LINKS];
    for (int k = 0; k < HYDRO_VARIANTS; k++) {
        moray_robot robot = random_unequal_robot(seed, N, link);
        robot.hydro = hydro_variant(k);
        random_vector(seed, 1, 2, V);
        random_vector(seed, 2, 2 * N + 4, x);
        random_vector(seed, 5, N - 1, ubar);
        swim(&robot, V, x, ubar, a, u);
        const maximal_state state = maximal_from_reduced(&robot, V, x);
        maximal_with_accelerations(&robot, &state, ubar, want, u_want);
        worst[0] = fmax(worst[0], relative_distance(N + 2, a, want));
        worst[1] = fmax(worst[1], relative_distance(N - 1, u, u_want));
        maximal_with_torques(&robot, &state, u, want);
        worst[2] = fmax(worst[2], relative_distance(N + 2, a, want));
    }
    CHECK_NEAR(worst[0], 0, 1e-10, "accelerations against maximal coordinates");
    CHECK_NEAR(worst[1], 0, 1e-10, "torques against maximal coordinates");
    CHECK_NEAR(worst[2], 0, 1e-10, "the torques cause the accelerations");
}

// The robot of links that are all alike, and the same ones taken as unequal.
static void check_equal(random_seed *seed, int N)
{
    moray_link link[MAX_LINKS], ones[MAX_LINKS];
    double V[2], x[MAX_STATES], ubar[MAX_LINKS], a[2][MAX_STATES], u[2][MAX_LINKS];
    for (int k = 0; k < HYDRO_VARIANTS; k++) {
        const moray_robot robot = random_robot(seed, N);
        moray_robot listed = robot;
        for (int i = 0; i < N; i++)
            link[i] = moray_robot_link(&robot, i);
        moray_robot_from_links(&listed, link);
        CHECK(listed.link == NULL && memcmp(&listed, &robot, sizeof robot) == 0, "equal links are the equal robot");
        for (int i = 0; i < N; i++)
            ones[i] = (moray_link){1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0};
        listed.link = ones;
        listed.hydro = hydro_variant(k);
        random_vector(seed, 1, 2, V);
        random_vector(seed, 2, 2 * N + 4, x);
        random_vector(seed, 5, N - 1, ubar);
        swim(&listed, V, x, ubar, a[0], u[0]);
        listed.link = NULL;
        swim(&listed, V, x, ubar, a[1], u[1]);
        CHECK(memcmp(a[0], a[1], (size_t)(N + 2) * sizeof **a) == 0 &&
                  memcmp(u[0], u[1], (size_t)(N - 1) * sizeof **u) == 0,
              "N = %d, variant %d: the digits of the equal robot", N, k);
    }
}

// What changes a coefficient of the robot changes it in every link.
static void check_shares(random_seed *seed, int N)
{
    moray_link link[MAX_LINKS];
    moray_robot robot = random_unequal_robot(seed, N, link);
    double length = 0, drag = 0;
    const moray_link before = moray_robot_link(&robot, N - 1);
    for (int i = 0; i < N; i++) {
        const moray_link it = moray_robot_link(&robot, i);
        length += 2 * it.l;
        drag += it.c_n + it.fin_c_n;
    }
    CHECK_NEAR(length / (2 * robot.l * N), 1, 1e-14, "the equal robot is as long");
    CHECK_NEAR(drag / (robot.c_n * N), 1, 1e-14, "and has the drag, with that of fins");
    robot.c_n *= 1.2;
    const moray_link after = moray_robot_link(&robot, N - 1);
    CHECK_NEAR(after.c_n / before.c_n, 1.2, 1e-14, "a link's share of a larger coefficient");
    CHECK_NEAR(after.fin_c_n / before.fin_c_n, 1.2, 1e-14, "and a fin's");
}

// ---- Derivatives ---------------------------------------------------------------------------------------------------

static void random_input(random_seed *seed, const moray_plant_spec *spec, int n_in, double *in)
{
    const int nx = moray_plant_sizes(spec).nx;
    for (int i = 0; i < n_in; i++)
        in[i] = i < nx ? tap_random(seed, -0.7, 0.7) : tap_random(seed, 0.1, 1.2);
}

// At the better of two points: where a drag changes its sign within the step, differences tell nothing.
static void check_derivatives(random_seed *seed, int N, moray_joints joints, moray_hydrodynamics hydro)
{
    moray_link link[MAX_LINKS];
    moray_plant_spec spec = {.robot = random_unequal_robot(seed, N, link),
                             .joints = joints,
                             .current = {0.3, -0.2},
                             .path_forces = true,
                             .path_angles = true,
                             .harmonics = 2};
    moray_map map;
    moray_derivative_report report;
    double in[INPUTS], weight[INPUTS], jacobian = INFINITY, hessian = INFINITY;
    spec.robot.hydro = hydro;
    CHECK_OK(moray_fp_plant(&map, &spec), "plant");
    CHECK(map.n_in <= INPUTS && map.n_out <= INPUTS, "room");
    random_vector(seed, 1, map.n_out, weight);
    for (int point = 0; point < 2; point++) {
        random_input(seed, &spec, map.n_in, in);
        CHECK_OK(moray_check_derivatives(&map, in, weight, &report), "checked");
        jacobian = fmin(jacobian, report.jacobian_error);
        hessian = fmin(hessian, report.hessian_error);
    }
    CHECK(jacobian < 2e-8 && hessian < 2e-8, "N = %d, joints %d: Jacobian %.1e, Hessian %.1e from differences", N,
          (int)joints, jacobian, hessian);
    moray_map_release(&map);
}

// ---- Energy --------------------------------------------------------------------------------------------------------

typedef struct {
    const moray_robot *robot;
    moray_swimmer *swimmer;
    moray_gait gait;
    double V[2];
    bool regular;
} voyage;

static double drag_power(moray_drag drag, double c, double v)
{
    return c * v * v * ((drag == MORAY_DRAG_QUADRATIC ? 0 : 1) + (drag == MORAY_DRAG_LINEAR ? 0 : fabs(v)));
}

// Kinetic energy in the water at rest, added mass included, and the power that drag takes.
static void energy(const voyage *of, const double *x, double *kinetic, double *lost)
{
    const moray_robot *robot = of->robot;
    const maximal_state state = maximal_from_reduced(robot, of->V, x);
    *kinetic = *lost = 0;
    for (int i = 0; i < robot->links; i++) {
        const moray_link link = moray_robot_link(robot, i);
        const double c = cos(x[i]), s = sin(x[i]), w = state.dtheta[i];
        const double t = c * (state.v_x[i] - of->V[0]) + s * (state.v_y[i] - of->V[1]);
        const double n = c * (state.v_y[i] - of->V[1]) - s * (state.v_x[i] - of->V[0]), mass = n + link.cm * w;
        const double torque = robot->hydro.rotation == MORAY_ROTATION_STRIP ? 0 : 1;
        maximal_spot spots[MAXIMAL_SPOTS];
        *kinetic += (link.m * (t * t + mass * mass) + (link.J + torque * link.lambda_1) * w * w) / 2;
        *lost += torque * (link.lambda_2 + link.lambda_3 * fabs(w)) * w * w;
        const int places = maximal_spots(robot, &link, n + link.cb * w, w, spots);
        for (int k = 0; k < places; k++) {
            const double u = n + spots[k].s * w;
            *kinetic += spots[k].mu_n * u * u / 2;
            *lost += drag_power(robot->hydro.drag, spots[k].c_t, t) + drag_power(robot->hydro.drag, spots[k].c_n, u);
        }
    }
}

// State, work of the joints, work of the drag.
static void sail(double t, const double *x, double *dx, voyage *of)
{
    const int N = of->robot->links;
    double ubar[MAX_LINKS], u[MAX_LINKS], kinetic;
    double *work = dx + 2 * N + 4;
    moray_swimmer_control(of->swimmer, &of->gait, t, x, ubar);
    of->regular = moray_swimmer_rates(of->swimmer, x, ubar, dx, u) && of->regular;
    *work = 0;
    for (int j = 0; j < N - 1; j++)
        *work += u[j] * (x[N + 2 + j] - x[N + 3 + j]);
    energy(of, x, &kinetic, work + 1);
}

static double imbalance(voyage *of, int steps)
{
    const int n = 2 * of->robot->links + 6;
    const double h = 2.0 / steps, c[] = {0, 0.5, 0.5, 1};
    double x[MAX_STATES + 2] = {0}, y[MAX_STATES + 2], k[4][MAX_STATES + 2], before, after, lost;
    moray_swimmer_rest(of->swimmer, 0.3, 0, 0, x);
    energy(of, x, &before, &lost);
    for (int step = 0; step < steps; step++) {
        for (int stage = 0; stage < 4; stage++) {
            for (int i = 0; i < n; i++)
                y[i] = x[i] + (stage ? c[stage] * h * k[stage - 1][i] : 0);
            sail((step + c[stage]) * h, y, k[stage], of);
        }
        for (int i = 0; i < n; i++)
            x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
    energy(of, x, &after, &lost);
    return (x[n - 2] - x[n - 1] - (after - before)) / x[n - 2];
}

// A robot as one is built: links of elliptic cylinders of all sizes, weights off their middles, a tail fin.
static moray_robot built_robot(random_seed *seed, int N, moray_link *link)
{
    moray_robot robot = moray_robot_paper();
    for (int i = 0; i < N; i++) {
        moray_link_geometry geometry = moray_link_geometry_paper();
        geometry.length = tap_random(seed, 0.08, 0.25);
        geometry.a_e = tap_random(seed, 0.03, 0.06);
        geometry.b_e = tap_random(seed, 0.02, 0.06);
        moray_robot_from_geometry(&robot, &geometry);
        link[i] = moray_robot_link(&robot, i);
        link[i].m *= tap_random(seed, 0.8, 1.3);
        link[i].cm = link[i].l * tap_random(seed, -0.4, 0.4);
        link[i].cb = link[i].l * tap_random(seed, -0.2, 0.2);
    }
    link[0].fin_c_t = 0.1;
    link[0].fin_c_n = tap_random(seed, 0, 10);
    link[0].fin_mu_n = tap_random(seed, 0, 0.3);
    link[0].fin_at = -1.5 * link[0].l;
    robot.links = N;
    moray_robot_from_links(&robot, link);
    return robot;
}

// Work of the joints = gain of kinetic energy + work of the drag, in the invariant form.
static void check_energy(random_seed *seed, int N, bool built, moray_drag drag, moray_rotation rotation)
{
    moray_link link[MAX_LINKS];
    moray_robot robot = built ? built_robot(seed, N, link) : random_unequal_robot(seed, N, link);
    robot.hydro = (moray_hydrodynamics){rotation, drag, MORAY_ADDED_MASS_INVARIANT, 0, 1};
    voyage of = {.robot = &robot,
                 .gait = {.amplitude = tap_random(seed, 0.1, 0.4), .omega = 3, .delta = 0.7},
                 .V = {0.2, -0.1},
                 .regular = true};
    CHECK_OK(moray_swimmer_new(&of.swimmer, &robot, MORAY_FIRST_PRINCIPLES), "swimmer");
    moray_swimmer_set_current(of.swimmer, of.V[0], of.V[1]);
    const double off = imbalance(&of, 2400);
    CHECK(of.regular && fabs(off) < 1e-6, "N = %d, drag %d, rotation %d: energy balances to %.1e of the work", N,
          (int)drag, (int)rotation, off);
    moray_swimmer_free(of.swimmer);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void check_refusal(double *field, double value, const moray_robot *robot, const char *says)
{
    const double was = *field;
    *field = value;
    const moray_status status = moray_robot_check(robot);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says), "refused: %s", status.text);
    *field = was;
}

static void check_refusals(random_seed *seed)
{
    moray_link link[3];
    const moray_robot robot = random_unequal_robot(seed, 3, link);
    CHECK_OK(moray_robot_check(&robot), "as it is");
    check_refusal(&link[1].l, 0, &robot, "link 2: l = 0: must be finite and above 0");
    check_refusal(&link[0].m, -1, &robot, "link 1: m = -");
    check_refusal(&link[2].J, NAN, &robot, "link 3: J = ");
    check_refusal(&link[2].c_n, -1, &robot, "link 3: c_n = -");
    check_refusal(&link[2].fin_mu_n, -1, &robot, "link 3: fin_mu_n = -");
    check_refusal(&link[0].cm, 1.01, &robot, "must be within its ends");
    check_refusal(&link[0].cb, -1.01, &robot, "link 1: cb = -");
    check_refusal(&link[0].fin_at, 4.1, &robot, "within two lengths of its middle");
}

int main(void)
{
    random_seed seed = 17;
    for (int k = 0; k < ROBOT_SIZES; k++) {
        check_maximal(&seed, robot_links[k]);
        check_equal(&seed, robot_links[k]);
        check_shares(&seed, robot_links[k]);
    }
    for (int k = 0; k < HYDRO_VARIANTS; k++) {
        check_derivatives(&seed, 2 + k % 9, MORAY_JOINTS_ON_GAIT, hydro_variant(k));
        check_derivatives(&seed, 2 + k % 8, MORAY_JOINTS_STEERED, hydro_variant(k));
        check_derivatives(&seed, 2 + k % 5, MORAY_JOINTS_FREE, hydro_variant(k));
        check_derivatives(&seed, 2 + k % 4, MORAY_JOINTS_SERIES, hydro_variant(k));
    }
    for (int k = 0; k < (tap_thorough() ? 36 : 12); k++)
        check_energy(&seed, 2 + k % 9, k % 2, (moray_drag)(k % 3), (moray_rotation)(k / 2 % 2));
    check_refusals(&seed);
    return tap_done();
}
