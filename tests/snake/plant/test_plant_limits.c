// SPDX-License-Identifier: MIT
//
// The maps of the control-oriented model where the answer is known by hand, and their forms against one another.
#include "tap.h"

#include <string.h>

#include "moray/angle.h"
#include "moray/snake/plant.h"
#include "rk4.h"

enum { INPUTS = 60, OUTPUTS = 60, LINKS = 10, JOINTS = LINKS - 1 };

// Places in the state of a plant whose joints are states.
enum { PHI = 0, THETA = JOINTS, V_PHI = JOINTS + 3, V_THETA = 2 * JOINTS + 3, V_T, V_N, STATES };

static void evaluate(const moray_plant_spec *spec, const double *in, double *out)
{
    moray_map map;
    CHECK_OK(moray_control_plant(&map, spec), "plant");
    map.value(map.self, in, out);
    moray_map_release(&map);
}

static moray_plant_spec paper_plant(moray_joints joints)
{
    return (moray_plant_spec){.robot = moray_robot_paper(), .joints = joints, .current = {0.1, -0.07}};
}

// On the gait itself the joints need no correction: both forms say the same of the body, the forces and the power.
static void test_closed_loop_on_gait(void)
{
    const moray_gait gait = {.amplitude = 0.045, .omega = 2.1, .delta = 0.7, .offset = 0.011, .taper = 0.3};
    const double t = 1.3, body[6] = {0.4, 2, -3, 0.2, 0.3, -0.05};
    moray_plant_spec spec = paper_plant(MORAY_JOINTS_ON_GAIT);
    spec.path_forces = spec.path_angles = true;
    double short_in[12], in[STATES + 6], ddphi[JOINTS], short_out[OUTPUTS], out[OUTPUTS];
    memcpy(short_in, body, sizeof body);
    memcpy(short_in + 6, (double[]){gait.amplitude, gait.omega, gait.delta, gait.offset, gait.taper, t},
           6 * sizeof(double));
    evaluate(&spec, short_in, short_out);

    moray_gait_reference(&gait, JOINTS, t, in + PHI, in + V_PHI, ddphi);
    memcpy(in + THETA, body, 3 * sizeof *body);
    memcpy(in + V_THETA, body + 3, 3 * sizeof *body);
    memcpy(in + STATES, short_in + 6, 6 * sizeof *in);
    spec.joints = MORAY_JOINTS_CLOSED_LOOP;
    evaluate(&spec, in, out);
    for (int i = 0; i < JOINTS; i++)
        CHECK_NEAR(out[V_PHI + i], ddphi[i], 1e-13, "on the gait ubar = phi_ref''");
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(out[THETA + i], short_out[i], 1e-15, "rates of theta, p_x, p_y");
        CHECK_NEAR(out[V_THETA + i], short_out[3 + i], 1e-13, "accelerations of the body");
    }
    for (int i = 0; i < JOINTS + LINKS + 1; i++)
        CHECK_RELATIVE(out[STATES + i], short_out[6 + i], 1e-13, "forces, link angles, power");
}

// The free form with the ubar of (34) is the closed loop.
static void test_free_follows_control(void)
{
    const moray_gait gait = {.amplitude = 0.04, .omega = 1.9, .delta = 0.6, .offset = -0.01, .taper = -0.4};
    const double t = 0.8;
    unsigned long long seed = 3;
    double closed[STATES + 6], free_in[STATES + JOINTS + 1] = {0}, phi[JOINTS], dphi[JOINTS], ddphi[JOINTS];
    double closed_out[OUTPUTS], out[OUTPUTS];
    moray_plant_spec spec = paper_plant(MORAY_JOINTS_CLOSED_LOOP);
    for (int k = 0; k < STATES; k++)
        closed[k] = free_in[k] = tap_random(&seed, -0.05, 0.05);
    memcpy(closed + STATES, (double[]){gait.amplitude, gait.omega, gait.delta, gait.offset, gait.taper, t},
           6 * sizeof(double));
    moray_gait_reference(&gait, JOINTS, t, phi, dphi, ddphi);
    for (int i = 0; i < JOINTS; i++)
        free_in[STATES + i] = ddphi[i] + 50 * (dphi[i] - closed[V_PHI + i]) + 200 * (phi[i] - closed[PHI + i]); // (34)
    evaluate(&spec, closed, closed_out);
    spec.joints = MORAY_JOINTS_FREE;
    evaluate(&spec, free_in, out);
    for (int i = 0; i <= STATES; i++)
        CHECK_RELATIVE(out[i], closed_out[i], 1e-13, "free with (34) and closed loop");
}

static void test_straight_body(void)
{
    moray_plant_spec spec = paper_plant(MORAY_JOINTS_FREE);
    const moray_robot *r = &spec.robot;
    double in[INPUTS] = {0}, out[OUTPUTS];
    const double theta = 0.8, v_theta = 0.3, v_t = 0.25, v_n = -0.1;
    in[THETA] = theta;
    in[V_THETA] = v_theta;
    in[V_T] = v_t;
    in[V_N] = v_n;
    evaluate(&spec, in, out);
    const double v_tr = v_t - (0.1 * cos(theta) - 0.07 * sin(theta));
    const double v_nr = v_n - (-0.1 * sin(theta) - 0.07 * cos(theta));
    CHECK_NEAR(out[V_T], -r->c_t / r->m * v_tr, 1e-15, "straight body: tangential drag on the mass");
    CHECK_NEAR(out[V_N], -r->c_n / (r->m + r->mu_n) * v_nr, 1e-15, "normal drag on mass and added mass");
    CHECK_NEAR(out[V_THETA], -1.15 * v_theta, 1e-15, "heading only damped");
    CHECK_NEAR(out[THETA + 1], v_t * cos(theta) - v_n * sin(theta), 1e-15, "(23c)");
    CHECK_NEAR(out[THETA + 2], v_t * sin(theta) + v_n * cos(theta), 1e-15, "(23d)");
    CHECK_NEAR(out[STATES], 0, 0, "no joint moves, no power");
}

// Two links, no added mass, no current: A Dbar = 0, and every equation is a line.
static void test_two_links(void)
{
    moray_plant_spec spec = {
        .robot = moray_robot_paper(), .joints = MORAY_JOINTS_FREE, .path_forces = true, .path_angles = true};
    spec.robot.links = 2;
    spec.robot.mu_n = 0;
    const moray_robot *r = &spec.robot;
    const double phi = 0.05, v_phi = 0.11, v_t = 0.2, v_n = 0.03, ubar = 0.7, L = 2 * r->l;
    const double in[] = {phi, 0.4, 1, 2, v_phi, -0.2, v_t, v_n, ubar, 5};
    const double theta = phi / (2 * L); // (12)
    const double u = (r->m * ubar + r->c_n * v_phi) / 2;
    double out[OUTPUTS];
    evaluate(&spec, in, out);
    CHECK_NEAR(out[5], -1.15 * -0.2 + 40 * v_t * phi, 1e-14, "two links: dv_theta");
    CHECK_NEAR(out[6], ((r->c_n - r->c_t) * theta * v_n - (r->c_t + r->c_n * theta * theta) * v_t) / r->m, 1e-14,
               "dv_t");
    CHECK_NEAR(out[7], ((r->c_n - r->c_t) * theta * v_t - r->c_n * v_n) / r->m, 1e-14, "dv_n");
    CHECK_NEAR(out[8], u, 1e-14, "joint force");
    CHECK_NEAR(out[9], theta, 1e-15, "angle of the first link");
    CHECK_NEAR(out[10], theta, 1e-15, "angle of the second link");
    CHECK_NEAR(out[11], u * v_phi, 1e-15, "power");
}

// The model as an ordinary differential equation says the same, forces included.
static void test_against_swimmer(void)
{
    unsigned long long seed = 5;
    moray_plant_spec spec = paper_plant(MORAY_JOINTS_FREE);
    spec.path_forces = true;
    moray_swimmer *swimmer = NULL;
    double in[STATES + JOINTS + 1], out[OUTPUTS], dx[STATES], u[JOINTS];
    for (int k = 0; k < STATES + JOINTS + 1; k++)
        in[k] = tap_random(&seed, -0.05, 0.05);
    CHECK_OK(moray_swimmer_new(&swimmer, &spec.robot, MORAY_CONTROL_ORIENTED), "swimmer");
    moray_swimmer_set_current(swimmer, spec.current[0], spec.current[1]);
    CHECK(moray_swimmer_rates(swimmer, in, in + STATES, dx, u), "the swimmer's dynamics are regular");
    evaluate(&spec, in, out);
    for (int k = 0; k < STATES; k++)
        CHECK_NEAR(out[k], dx[k], 1e-14, "rates of plant and swimmer");
    for (int i = 0; i < JOINTS; i++)
        CHECK_NEAR(out[STATES + i], u[i], 1e-14, "joint forces of plant and swimmer");
    moray_swimmer_free(swimmer);
}

// Turning robot and current together changes nothing the body feels; drifting with the current neither.
static void test_frames(void)
{
    unsigned long long seed = 11;
    moray_plant_spec spec = paper_plant(MORAY_JOINTS_FREE);
    const double V_x = spec.current[0], V_y = spec.current[1], turn = 0.9;
    double in[STATES + JOINTS + 1], out[OUTPUTS], turned[OUTPUTS], drifting[OUTPUTS];
    for (int k = 0; k < STATES + JOINTS + 1; k++)
        in[k] = tap_random(&seed, -0.05, 0.05);
    evaluate(&spec, in, out);
    const double theta = in[THETA];
    in[THETA] += turn;
    spec.current[0] = V_x * cos(turn) - V_y * sin(turn);
    spec.current[1] = V_x * sin(turn) + V_y * cos(turn);
    evaluate(&spec, in, turned);
    in[V_T] -= V_x * cos(theta) + V_y * sin(theta);
    in[V_N] -= -V_x * sin(theta) + V_y * cos(theta);
    spec.current[0] = spec.current[1] = 0;
    evaluate(&spec, in, drifting);
    for (int k = V_THETA; k <= STATES; k++) {
        CHECK_NEAR(turned[k], out[k], 1e-14, "robot and current turned");
        CHECK_NEAR(drifting[k], out[k], 1e-14, "seen from the water");
    }
}

typedef struct swim {
    const moray_map *map;
    double gait[5];
} swim;

static void swim_out(const swim *self, double t, const double *x, double *out)
{
    double in[12];
    memcpy(in, x, 6 * sizeof *x);
    memcpy(in + 6, self->gait, sizeof self->gait);
    in[11] = t;
    self->map->value(self->map->self, in, out);
}

static bool swim_rhs(double t, const double *x, double *dx, void *self)
{
    double out[7];
    swim_out(self, t, x, out);
    memcpy(dx, out, 6 * sizeof *dx);
    return true;
}

// From rest at the origin for 45 s; displacement [m] and joint work [J] of the last five periods of 3 s.
static void swim_five_periods(swim *self, double moved[2], double *work)
{
    enum { per_second = 100, before = 30 * per_second, total = 45 * per_second };
    int steps = 1;
    const double h = 1.0 / per_second;
    const moray_integrator rk4 = {.run = rk4_run, .self = &steps};
    const moray_ode ode = {.n = 6, .rhs = swim_rhs, .self = self};
    double x[6] = {0}, out[7], start[2] = {0};
    *work = 0;
    for (int k = 0; k < total; k++) {
        if (k == before)
            memcpy(start, x + 1, sizeof start);
        swim_out(self, k * h, x, out);
        *work += k < before ? 0 : h * out[6];
        rk4_run(&rk4, &ode, k * h, (k + 1) * h, x, NULL, 0, NULL, NULL);
    }
    moved[0] = x[1] - start[0];
    moved[1] = x[2] - start[1];
}

// Straight motion of the paper's robot; figures of an independent implementation.
static void test_paper_gaits(void)
{
    static const double theta_max_deg[] = {10, 15, 20, 30}, v_x[] = {0.2127, 0.2931, 0.3573, 0.4373};
    const double delta = 40 * MORAY_DEGREE;
    moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_ON_GAIT, .current = {0.1, 0.1}};
    moray_map map;
    CHECK_OK(moray_control_plant(&map, &spec), "plant of the paper");
    for (int k = 0; k < 4; k++) {
        const double a =
            moray_amplitude_from_theta_max(&spec.robot, MORAY_CONTROL_ORIENTED, theta_max_deg[k] * MORAY_DEGREE, delta);
        swim self = {.map = &map, .gait = {a, 120 * MORAY_DEGREE, delta, 0}};
        double moved[2], work;
        swim_five_periods(&self, moved, &work);
        CHECK_NEAR(moved[0] / 15, v_x[k], 5e-5, "mean v_x of the paper's gaits");
        CHECK_NEAR(moved[1] / 15, 0.1, 1e-10, "across the course it drifts with the current");
        if (theta_max_deg[k] == 20)
            CHECK_NEAR(work / 15, 0.397, 5e-4, "mean joint power at 20 deg");
    }
    moray_map_release(&map);
}

// Beyond the shape where (17) is singular the inertia is not positive definite.
static void test_outside_domain(void)
{
    moray_plant_spec spec = paper_plant(MORAY_JOINTS_FREE);
    double in[STATES + JOINTS + 1] = {0}, out[OUTPUTS];
    for (int i = 0; i < JOINTS; i++)
        in[PHI + i] = 0.8;
    evaluate(&spec, in, out);
    CHECK(isnan(out[V_T]) && isnan(out[V_N]) && isnan(out[STATES]), "outside the domain: %g %g %g", out[V_T], out[V_N],
          out[STATES]);
}

int main(void)
{
    test_closed_loop_on_gait();
    test_free_follows_control();
    test_straight_body();
    test_two_links();
    test_against_swimmer();
    test_frames();
    test_outside_domain();
    test_paper_gaits();
    return tap_done();
}
