// SPDX-License-Identifier: MIT
//
// The swimmer's handling: making, state at rest, joints, controller, pose, links. The dynamics are in test_fp_model.c
// and test_control.c.
#include <string.h>

#include "random_robot.h"

static moray_swimmer *make(const moray_robot *robot, moray_model model)
{
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, robot, model), "moray_swimmer_new");
    return swimmer;
}

static void check_making(random_seed *seed, moray_model model)
{
    moray_robot robot = random_robot(seed, 4);
    const double m = robot.m;
    moray_swimmer *swimmer = make(&robot, model);
    robot.m = -1;
    CHECK(moray_swimmer_robot(swimmer)->m == m, "the swimmer has its own copy of the robot");
    CHECK(moray_swimmer_model(swimmer) == model, "the model is kept");
    CHECK(moray_swimmer_states(swimmer) == 12, "2N+4 states");
    moray_swimmer_free(swimmer);
    const moray_status status = moray_swimmer_new(&swimmer, &robot, model);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "m = -1") != NULL, "a bad robot is named: %s", status.text);
    CHECK(swimmer == NULL, "and no swimmer is made");
    moray_swimmer_free(NULL);
}

static void check_rest(random_seed *seed, moray_model model, int N)
{
    const moray_robot robot = random_robot(seed, N);
    moray_swimmer *swimmer = make(&robot, model);
    double x[MAX_STATES], dx[MAX_STATES], phi[MAX_LINKS], v_phi[MAX_LINKS], ubar[MAX_LINKS] = {0}, u[MAX_LINKS];
    random_vector(seed, 1, 2 * N + 4, x);
    moray_swimmer_rest(swimmer, 0.4, 2, -3, x);
    const moray_pose pose = moray_swimmer_pose(swimmer, x);
    CHECK_NEAR(pose.heading, 0.4, 1e-15, "heading at rest");
    CHECK(pose.p_x == 2 && pose.p_y == -3 && pose.v_x == 0 && pose.v_y == 0, "position and velocity at rest");
    CHECK_NEAR(pose.link_angle, 0, 1e-15, "straight at rest");
    moray_swimmer_joints(swimmer, x, phi, v_phi);
    CHECK(dot(N - 1, phi, phi) == 0 && dot(N - 1, v_phi, v_phi) == 0, "joints at rest");
    CHECK(moray_swimmer_rates(swimmer, x, ubar, dx, u), "rest is regular");
    CHECK(dot(2 * N + 4, dx, dx) == 0 && dot(N - 1, u, u) == 0, "still water leaves it at rest");
    moray_swimmer_set_current(swimmer, 0.3, 0.1);
    CHECK(moray_swimmer_rates(swimmer, x, ubar, dx, NULL) && dot(2 * N + 4, dx, dx) > 0, "a current moves it");
    for (int i = 0; i < 2 * N + 4; i += 2 * N + 2) { // shape, velocity
        const double kept = x[i];
        x[i] = NAN;
        CHECK(!moray_swimmer_rates(swimmer, x, ubar, dx, NULL), "a NaN in state %d is refused", i);
        x[i] = kept;
    }
    ubar[0] = INFINITY;
    CHECK(!moray_swimmer_rates(swimmer, x, ubar, dx, u), "an infinite joint acceleration is refused");
    moray_swimmer_free(swimmer);
}

// A swimmer that becomes another robot moves as one that was made as it.
static void check_becoming(random_seed *seed, moray_model model, int N)
{
    const moray_robot first = random_robot(seed, N), other = random_robot(seed, N);
    moray_swimmer *swimmer = make(&first, model), *made = make(&other, model);
    double x[MAX_STATES], ubar[MAX_LINKS], dx[2][MAX_STATES], u[2][MAX_LINKS];
    random_vector(seed, 1, 2 * N + 4, x);
    random_vector(seed, 1, N - 1, ubar);
    CHECK_OK(moray_swimmer_set_robot(swimmer, &other), "moray_swimmer_set_robot");
    CHECK(moray_swimmer_rates(swimmer, x, ubar, dx[0], u[0]) && moray_swimmer_rates(made, x, ubar, dx[1], u[1]),
          "both have rates");
    CHECK(memcmp(dx[0], dx[1], (size_t)(2 * N + 4) * sizeof(double)) == 0 &&
              memcmp(u[0], u[1], (size_t)(N - 1) * sizeof(double)) == 0,
          "and the same");
    moray_swimmer_free(made);
    moray_swimmer_free(swimmer);
}

// A state with joints on the gait at time t plus the given errors.
static void set_joints(moray_model model, int N, const double *phi, const double *v_phi, double *x)
{
    for (int i = 0; i < N - 1; i++)
        if (model == MORAY_CONTROL_ORIENTED) {
            x[i] = phi[i];
            x[N + 2 + i] = v_phi[i];
        } else {
            x[i + 1] = x[i] - phi[i]; // (1)
            x[N + 3 + i] = x[N + 2 + i] - v_phi[i];
        }
}

// (34): on the gait ubar = phi_ref''; off it the error decays as e'' = -k_d e' - k_p e.
static void check_control(random_seed *seed, moray_model model, int N)
{
    const moray_robot robot = random_robot(seed, N);
    const moray_gait gait = {.amplitude = 0.3, .omega = 2, .delta = 0.7, .offset = 0.1};
    const double t = 1.3;
    moray_swimmer *swimmer = make(&robot, model);
    double x[MAX_STATES], phi[MAX_LINKS], v_phi[MAX_LINKS], got[MAX_LINKS], got_v[MAX_LINKS], ubar[MAX_LINKS];
    double on_gait = 0, off_gait = 0, joints = 0;
    for (int side = 0; side < 2; side++) {
        const double e = side * 0.02, de = side * -0.05;
        random_vector(seed, 1, 2 * N + 4, x);
        for (int i = 0; i < N - 1; i++) {
            phi[i] = 0.3 * sin(2 * t + 0.7 * i) + 0.1 + e * (i + 1);
            v_phi[i] = 0.6 * cos(2 * t + 0.7 * i) + de * (i + 1);
        }
        set_joints(model, N, phi, v_phi, x);
        moray_swimmer_joints(swimmer, x, got, got_v);
        joints = tap_worse(joints, relative_distance(N - 1, got, phi) + relative_distance(N - 1, got_v, v_phi));
        moray_swimmer_control(swimmer, &gait, t, x, ubar);
        for (int i = 0; i < N - 1; i++) {
            const double want = -1.2 * sin(2 * t + 0.7 * i) - (robot.k_d * de + robot.k_p * e) * (i + 1);
            double *worst = side == 0 ? &on_gait : &off_gait;
            *worst = fmax(*worst, fabs(ubar[i] - want));
        }
    }
    CHECK_NEAR(joints, 0, 1e-13, "joint coordinates and rates");
    CHECK_NEAR(on_gait, 0, 1e-13, "(34) on the gait");
    CHECK_NEAR(off_gait, 0, 1e-13, "(34) off the gait");
    moray_swimmer_free(swimmer);
}

// The pose's velocity is the rate of its position and, for the mean link angle, heading moves with its rate.
static void check_pose(random_seed *seed, moray_model model, int N)
{
    const moray_robot robot = random_robot(seed, N);
    moray_swimmer *swimmer = make(&robot, model);
    double x[MAX_STATES], dx[MAX_STATES], ubar[MAX_LINKS] = {0}, mean = 0, largest = 0;
    random_vector(seed, 0.3, 2 * N + 4, x);
    CHECK(moray_swimmer_rates(swimmer, x, ubar, dx, NULL), "a random state is regular");
    const moray_pose pose = moray_swimmer_pose(swimmer, x);
    CHECK(pose.p_x == x[N] && pose.p_y == x[N + 1], "position");
    CHECK_NEAR(hypot(pose.v_x - dx[N], pose.v_y - dx[N + 1]), 0, 1e-15, "ground velocity");
    for (int i = 0; i < N; i++)
        mean += x[i] / N;
    for (int i = 0; i < N; i++) {
        const double estimate = ((i > 0 ? x[i - 1] : 0) + (i < N - 1 ? x[i] : 0)) / (2 * (2 * robot.l)); // (12)
        largest = fmax(largest, fabs(model == MORAY_CONTROL_ORIENTED ? estimate : x[i] - mean));
    }
    CHECK_NEAR(pose.heading, model == MORAY_CONTROL_ORIENTED ? x[N - 1] : mean, 1e-15, "heading");
    CHECK_NEAR(pose.link_angle, largest, 1e-15, "largest link angle");
    moray_swimmer_free(swimmer);
}

static void check_links_fp(random_seed *seed, int N)
{
    const moray_robot robot = random_robot(seed, N);
    moray_swimmer *swimmer = make(&robot, MORAY_FIRST_PRINCIPLES);
    double x[MAX_STATES], x_i[MAX_LINKS], y_i[MAX_LINKS], angle[MAX_LINKS], gap = 0;
    random_vector(seed, 3, 2 * N + 4, x);
    moray_swimmer_links(swimmer, x, x_i, y_i, angle);
    double off_x = -x[N], off_y = -x[N + 1];
    for (int i = 0; i < N; i++) {
        off_x += x_i[i] / N;
        off_y += y_i[i] / N;
    }
    for (int i = 0; i < N - 1; i++) {
        const double end_x = x_i[i] + robot.l * cos(angle[i]), start_x = x_i[i + 1] - robot.l * cos(angle[i + 1]);
        const double end_y = y_i[i] + robot.l * sin(angle[i]), start_y = y_i[i + 1] - robot.l * sin(angle[i + 1]);
        gap = tap_worse(gap, hypot(end_x - start_x, end_y - start_y));
    }
    CHECK_NEAR(gap, 0, 1e-13, "links meet at the joints");
    CHECK_NEAR(hypot(off_x, off_y), 0, 1e-13, "their mean is (p_x, p_y)");
    CHECK(relative_distance(N, angle, x) == 0, "angles are theta_i");
    moray_swimmer_free(swimmer);
}

// In the t-n frame: neighbours 2l apart along t and phi_i apart along n, by (8).
static void check_links_control(random_seed *seed, int N)
{
    const moray_robot robot = random_robot(seed, N);
    moray_swimmer *swimmer = make(&robot, MORAY_CONTROL_ORIENTED);
    double x[MAX_STATES], x_i[MAX_LINKS], y_i[MAX_LINKS], angle[MAX_LINKS], error = 0, largest = 0;
    random_vector(seed, 0.3, 2 * N + 4, x);
    moray_swimmer_links(swimmer, x, x_i, y_i, angle);
    const double theta = x[N - 1];
    double off_x = -x[N], off_y = -x[N + 1];
    for (int i = 0; i < N; i++) {
        off_x += x_i[i] / N;
        off_y += y_i[i] / N;
        largest = fmax(largest, fabs(angle[i] - theta));
    }
    for (int i = 0; i < N - 1; i++) {
        const double d_x = x_i[i + 1] - x_i[i], d_y = y_i[i + 1] - y_i[i];
        const double d_t = d_x * cos(theta) + d_y * sin(theta), d_n = d_y * cos(theta) - d_x * sin(theta);
        error = tap_worse(error, hypot(d_t - 2 * robot.l, d_n - x[i]));
    }
    CHECK_NEAR(error, 0, 1e-13, "neighbours are 2l and phi_i apart");
    CHECK_NEAR(hypot(off_x, off_y), 0, 1e-13, "their mean is (p_x, p_y)");
    CHECK_NEAR(largest, moray_swimmer_pose(swimmer, x).link_angle, 1e-14, "angles are theta + (12)");
    moray_swimmer_free(swimmer);
}

// Angular acceleration of a body bent by phi_0 in every joint that moves ahead at 0.2 m/s.
static double turning(moray_model model, double phi_0)
{
    const moray_robot robot = moray_robot_paper();
    const int N = robot.links;
    moray_swimmer *swimmer = make(&robot, model);
    double x[MAX_STATES], dx[MAX_STATES], phi[MAX_LINKS], v_phi[MAX_LINKS] = {0}, ubar[MAX_LINKS] = {0};
    for (int i = 0; i < N - 1; i++)
        phi[i] = phi_0;
    moray_swimmer_rest(swimmer, 0, 0, 0, x);
    if (model == MORAY_FIRST_PRINCIPLES)
        x[0] = phi_0 * (N - 1) / 2; // mean link angle zero
    set_joints(model, N, phi, v_phi, x);
    x[2 * N + 2] = 0.2;
    CHECK(moray_swimmer_rates(swimmer, x, ubar, dx, NULL), "a bent body is regular");
    moray_swimmer_free(swimmer);
    return model == MORAY_FIRST_PRINCIPLES ? dx[N + 2] : dx[2 * N + 1];
}

// The state on the gait has the joints of (25) and the body asked for.
static void check_on_gait(random_seed *seed, moray_model model, int N)
{
    const moray_robot robot = random_robot(seed, N);
    const moray_gait gait = {
        .amplitude = 0.2, .omega = 1.7, .delta = 0.6, .offset = 0.05, .offset_rate = 0.03, .offset_acceleration = 0.1};
    moray_swimmer *swimmer = make(&robot, model);
    double x[MAX_STATES], body[6], back[6], phi[MAX_LINKS], v_phi[MAX_LINKS], want[3][MAX_LINKS];
    random_vector(seed, 1, 6, body);
    moray_swimmer_on_gait(swimmer, &gait, 0.8, body, x);
    moray_state_body(model, N, x, back);
    CHECK(relative_distance(6, back, body) < 1e-14, "N = %d: the body's six states there and back", N);
    moray_swimmer_joints(swimmer, x, phi, v_phi);
    moray_gait_reference(&gait, N - 1, 0.8, want[0], want[1], want[2]);
    CHECK(relative_distance(N - 1, phi, want[0]) < 1e-13 && relative_distance(N - 1, v_phi, want[1]) < 1e-13,
          "N = %d: joints and their rates on the gait", N);
    CHECK_NEAR(moray_swimmer_pose(swimmer, x).heading, body[0], 1e-14, "heading");
    moray_swimmer_free(swimmer);
}

// The water is all that moves the whole: its forces over the links are mass times acceleration. At rest a current
// pushes each link by its drag alone.
static void check_water(random_seed *seed, int N)
{
    const moray_robot robot = random_robot(seed, N);
    moray_swimmer *swimmer = make(&robot, MORAY_FIRST_PRINCIPLES), *other = make(&robot, MORAY_CONTROL_ORIENTED);
    double x[MAX_STATES], dx[MAX_STATES], ubar[MAX_LINKS], along[MAX_LINKS], across[MAX_LINKS], sum[2] = {0}, mass = 0;
    random_vector(seed, 1, 2 * N + 4, x);
    random_vector(seed, 1, N - 1, ubar);
    moray_swimmer_set_current(swimmer, 0.3, -0.2);
    CHECK(moray_swimmer_rates(swimmer, x, ubar, dx, NULL), "regular");
    CHECK(moray_swimmer_water_forces(swimmer, x, ubar, along, across), "the water's forces on %d links", N);
    for (int i = 0; i < N; i++) {
        sum[0] += along[i] * cos(x[i]) - across[i] * sin(x[i]);
        sum[1] += along[i] * sin(x[i]) + across[i] * cos(x[i]);
        mass += moray_robot_link(&robot, i).m;
    }
    CHECK_NEAR(sum[0], mass * dx[2 * N + 2], 1e-11 * (1 + fabs(sum[0])), "along x");
    CHECK_NEAR(sum[1], mass * dx[2 * N + 3], 1e-11 * (1 + fabs(sum[1])), "along y");
    moray_swimmer_rest(swimmer, 0.5, 0, 0, x);
    CHECK(moray_swimmer_water_forces(swimmer, x, NULL, along, across), "at rest");
    CHECK_NEAR(along[N - 1], robot.c_t * (0.3 * cos(0.5) - 0.2 * sin(0.5)), 1e-13, "drag along");
    CHECK_NEAR(across[0], robot.c_n * (-0.2 * cos(0.5) - 0.3 * sin(0.5)), 1e-13, "and across");
    CHECK(!moray_swimmer_water_forces(other, x, NULL, along, across), "the control-oriented model knows none");
    moray_swimmer_free(swimmer);
    moray_swimmer_free(other);
}

int main(void)
{
    random_seed seed = 34;
    const moray_model models[] = {MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES};
    for (int m = 0; m < 2; m++) {
        check_making(&seed, models[m]);
        for (int k = 0; k < ROBOT_SIZES; k++) {
            check_rest(&seed, models[m], robot_links[k]);
            check_control(&seed, models[m], robot_links[k]);
            check_pose(&seed, models[m], robot_links[k]);
            check_becoming(&seed, models[m], robot_links[k]);
            check_on_gait(&seed, models[m], robot_links[k]);
        }
    }
    for (int k = 0; k < ROBOT_SIZES; k++) {
        check_links_fp(&seed, robot_links[k]);
        check_water(&seed, robot_links[k]);
        check_links_control(&seed, robot_links[k]);
    }
    CHECK(turning(MORAY_FIRST_PRINCIPLES, 0.02) < 0, "Property 3: a positive offset turns clockwise");
    CHECK(turning(MORAY_CONTROL_ORIENTED, 0.002) > 0, "erratum E3: in (20) it turns counter-clockwise");
    return tap_done();
}
