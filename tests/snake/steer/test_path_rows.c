// SPDX-License-Identifier: MIT
//
// What the problem of following a path asks for, by hand on a straight path that points along (0.6, 0.8).
#include "degree.h"
#include "tap.h"

#include "ocp/problem.h"
#include "snake/steer/problems.h"

enum { states = MORAY_STEERING_STATES, inputs = states + 2 + MORAY_STEERING_PARAMETERS + 1, most = 16 };

static const double along = 2, length = 10, tube = 0.3;

static void place(double forward, double left, double p[2])
{
    p[0] = 0.6 * forward - 0.8 * left;
    p[1] = 0.8 * forward + 0.6 * left;
}

// Begins to the left of the path at `along`.
static moray_path_spec spec_of(const moray_path *path, double left, double duration)
{
    moray_path_spec spec = {.robot = moray_robot_paper(),
                            .averaged = true,
                            .limits = {.theta_max = moray_between(1 * DEG, 20 * DEG),
                                       .omega = moray_fixed(120 * DEG),
                                       .delta = moray_fixed(40 * DEG),
                                       .offset = 0.015,
                                       .offset_rate = 0.01,
                                       .offset_acceleration = MORAY_INFINITY,
                                       .power = MORAY_INFINITY},
                            .weight = {.across = 3, .time = 0.5, .steering = 0.7},
                            .path = path,
                            .tube = tube,
                            .reach = 2,
                            .along = along,
                            .t0 = 4,
                            .duration = duration,
                            .speed = 0.25};
    place(along, left, spec.start + MORAY_STATE_P_X);
    return spec;
}

static moray_steering_problem problem_of(const moray_path_spec *spec)
{
    moray_steering_problem problem;
    CHECK_OK(moray_path_problem_new(&problem, spec), "problem");
    return problem;
}

// Of the place 0.1 m before the point of the path, 0.4 m left of it.
static void rows_at(const moray_path_spec *spec, double point, double rows[3])
{
    moray_steering_problem problem = problem_of(spec);
    const moray_map *map = moray_steering_ocp(problem.steering)->phase[0].map;
    double in[inputs] = {0}, out[most];
    place(point + 0.1, 0.4, in + MORAY_STATE_P_X);
    in[states] = 0.003;
    in[states + 1] = point;
    in[states + 2 + MORAY_STEERING_AMPLITUDE] = 0.05;
    in[states + 2 + MORAY_STEERING_OMEGA] = 2;
    if (CHECK(map->n_in == inputs && map->n_out <= most, "%d numbers in, %d out", map->n_in, map->n_out)) {
        map->value(map->self, in, out);
        for (int k = 0; k < 3; k++)
            rows[k] = out[states + k];
    }
    moray_steering_problem_free(&problem);
}

// Begins `left` of the path; how wide the tube is where a share of its reach is behind.
static void check_tube(const moray_path *path, double left, double share, double width)
{
    double rows[3] = {0};
    const moray_path_spec spec = spec_of(path, left, 0);
    rows_at(&spec, along + share * spec.reach, rows);
    CHECK_NEAR(rows[0], 0.1, 1e-12, "before the point of the path [m]");
    CHECK_NEAR(rows[1], 0.4 / width, 1e-12, "distance, of the tube");
    CHECK_NEAR(rows[2], 3 * 0.4 * 0.4 + 0.7 * 0.2 * 0.2, 1e-12, "what is summed up");
}

// Of 0.84 m, as a start 0.8 m beside the path has it with a twentieth more, to the 0.3 m that are asked for.
static void test_rows(const moray_path *path)
{
    for (int side = -1; side <= 1; side += 2) {
        check_tube(path, 0.8 * side, 0, 0.84);
        check_tube(path, 0.8 * side, 0.5, 0.57);
        check_tube(path, 0.8 * side, 0.75, 0.3 + 0.25 * 0.54);
        check_tube(path, 0.8 * side, 1, tube);
        check_tube(path, 0.8 * side, 1.5, tube);
        check_tube(path, 0.25 * side, 0, tube);
    }
}

// The objective where the integrals are 0.2 and, of the work, 5.
static double objective_at(const moray_ocp *ocp, double forward, double left, double tf)
{
    enum { TIMES = 2, q = 2 * states + TIMES, ends = q + 2 + MORAY_STEERING_PARAMETERS };
    const moray_map *map = ocp->endpoint->map;
    double in[ends] = {[states] = 4, [q - 1] = tf, [q] = 0.2, [q + 1] = 5}, out[most];
    in[q + 2 + MORAY_STEERING_AMPLITUDE] = 0.05;
    in[q + 2 + MORAY_STEERING_OMEGA] = 2;
    in[q + 2 + MORAY_STEERING_DELTA] = 40 * DEG;
    place(forward, left, in + states + 1 + MORAY_STATE_P_X);
    if (!CHECK(map->n_in == ends && map->n_out <= most, "%d numbers in, %d out", map->n_in, map->n_out))
        return NAN;
    map->value(map->self, in, out);
    return out[0];
}

static void check_bounds(moray_bounds got, double lower, double upper, const char *what)
{
    CHECK_NEAR(got.lower, lower, 1e-12, what);
    CHECK_NEAR(got.upper, upper, 1e-12, what);
}

// To the end of the path in between 0.3 and 3 times what the speed takes for the 8 m, which counts in the objective.
static void test_to_the_end(const moray_path *path)
{
    const moray_path_spec spec = spec_of(path, 0.8, 0);
    moray_steering_problem problem = problem_of(&spec);
    const moray_ocp *ocp = moray_steering_ocp(problem.steering);
    const struct phase *phase = &ocp->phase[0];
    check_bounds(phase->t0, 4, 4, "starts");
    check_bounds(phase->tf, 4 + 0.3 * 32, 4 + 3 * 32, "ends");
    check_bounds(phase->xf[MORAY_STATE_P_X], 6, 6, "at the end of the path");
    check_bounds(phase->xf[MORAY_STATE_P_Y], 8, 8, "and along y");
    check_bounds(phase->xf[MORAY_STATE_PHI_0], 0, 0, "without an offset");
    check_bounds(phase->xf[MORAY_STATE_V_PHI_0], 0, 0, "that does not move");
    check_bounds(phase->u[1], along - 2, length + 2, "points of the path");
    check_bounds(phase->c[0], 0, 0, "the nearest of which is taken");
    check_bounds(phase->c[1], -1, 1, "within the tube");
    for (int r = 0; r < states; r++)
        check_bounds(phase->x0[r], spec.start[r], spec.start[r], "where it starts");
    CHECK_NEAR(objective_at(ocp, 7, 0.3, 24), 0.2 + 0.5 * 20, 1e-12, "objective: the time counts");
    moray_steering_problem_free(&problem);
}

// For 12 s, at whose end the speed would be 3 m on: what is made good beyond that counts as the time it saves.
static void test_of_given_length(const moray_path *path)
{
    moray_path_spec spec = spec_of(path, 0.8, 12);
    spec.tube = MORAY_INFINITY;
    moray_steering_problem problem = problem_of(&spec);
    const moray_ocp *ocp = moray_steering_ocp(problem.steering);
    const struct phase *phase = &ocp->phase[0];
    check_bounds(phase->t0, 4, 4, "starts");
    check_bounds(phase->tf, 16, 16, "ends");
    CHECK(phase->xf[MORAY_STATE_P_X].upper >= MORAY_INFINITY, "wherever it is then");
    check_bounds(phase->u[1], along - 2, length + 3 * 3, "points of the path");
    CHECK(phase->nc == 1, "without a tube none of its rows: %d", phase->nc);
    CHECK_NEAR(objective_at(ocp, 7, 0.3, 16), 0.2 - 0.5 * (7 - 5) / 0.25, 1e-12, "objective: two metres beyond");
    CHECK_NEAR(objective_at(ocp, 4, -0.3, 16), 0.2 + 0.5 * (5 - 4) / 0.25, 1e-12, "one metre short of it");
    moray_steering_problem_free(&problem);
}

int main(void)
{
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 6,8", 0.5), "a straight path");
    test_rows(&path);
    test_to_the_end(&path);
    test_of_given_length(&path);
    moray_path_free(&path);
    return tap_done();
}
