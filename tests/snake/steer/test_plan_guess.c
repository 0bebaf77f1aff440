// SPDX-License-Identifier: MIT
//
// Plans of no iteration are their guesses: against the same way worked out step by step, and where they start.
#include "degree.h"
#include "reference_text.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/trial.h"
#include "ocp/problem.h"
#include "snake/steer/guess.h"
#include "snake/steer/problems.h"

enum { states = MORAY_STEERING_STATES, INTERVALS = 4, SAMPLES = 16 * INTERVALS + 1 };

static const double current[2] = {0.05, -0.08};
static const double just = 1e-9; // behind where an interval begins, where a solution is what the guess is there [s]

static moray_settings guess_alone(void)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = "radau3";
    settings.intervals = INTERVALS;
    settings.max_iterations = 0;
    return settings;
}

static moray_gait gait_of(const moray_robot *robot, moray_model model)
{
    const moray_gait paper = moray_gait_paper(robot);
    return moray_gait_map(robot, &paper, MORAY_CONTROL_ORIENTED, model);
}

static moray_steering_limits limits_of(moray_model model)
{
    const bool control = model == MORAY_CONTROL_ORIENTED;
    return (moray_steering_limits){.theta_max = moray_between(1 * DEG, 40 * DEG),
                                   .omega = moray_between(100 * DEG, 200 * DEG),
                                   .delta = moray_between(10 * DEG, 150 * DEG),
                                   .offset = control ? 0.015 : 5 * DEG,
                                   .offset_rate = control ? 0.01 : 3 * DEG,
                                   .offset_acceleration = MORAY_INFINITY,
                                   .power = MORAY_INFINITY};
}

// The velocity over ground of a state of either model.
static void over_ground(moray_model model, const double *x, double v[2])
{
    const bool body = model == MORAY_CONTROL_ORIENTED;
    const double c = body ? cos(x[MORAY_STATE_THETA]) : 1, s = body ? sin(x[MORAY_STATE_THETA]) : 0;
    v[0] = c * x[MORAY_STATE_V_1] - s * x[MORAY_STATE_V_2];
    v[1] = s * x[MORAY_STATE_V_1] + c * x[MORAY_STATE_V_2];
}

// ---- Headings ------------------------------------------------------------------------------------------------------

static moray_heading_spec heading_spec(moray_model model, bool averaged, const moray_reference *reference)
{
    return (moray_heading_spec){.robot = moray_robot_paper(),
                                .model = model,
                                .averaged = averaged,
                                .current = {current[0], current[1]},
                                .limits = limits_of(model),
                                .weight = {.heading = 3, .power = 0, .steering = 0.01},
                                .reference = reference,
                                .max_error = MORAY_INFINITY,
                                .t0 = 7, // plans begin at 0 all the same
                                .t1 = 12};
}

// A problem starts in the straight swimming of its gait, the averaged one without its undulation.
static void check_start(const moray_steering_plan *plan, bool averaged, double heading, const double p[2])
{
    const struct phase *phase = &moray_steering_ocp(plan->problem.steering)->phase[0];
    const moray_straight_motion *straight = &plan->straight;
    double start[states], v[2], swim[2] = {0, 0}, body[2];
    for (int r = 0; r < states; r++) {
        start[r] = phase->x0[r].lower;
        if (phase->x0[r].upper != start[r])
            CHECK(false, "state %d is fixed at the start", r);
    }
    const double swing = averaged ? 0 : straight->body[MORAY_STATE_THETA];
    CHECK_NEAR(start[MORAY_STATE_THETA], heading + swing, 1e-12, "heading at the start");
    CHECK_NEAR(start[MORAY_STATE_V_THETA], averaged ? 0 : straight->body[MORAY_STATE_V_THETA], 1e-12, "turning");
    CHECK_NEAR(start[MORAY_STATE_P_X], p[0], 1e-12, "place at the start along x");
    CHECK_NEAR(start[MORAY_STATE_P_Y], p[1], 1e-12, "and along y");
    CHECK(start[MORAY_STATE_PHI_0] == 0 && start[MORAY_STATE_V_PHI_0] == 0, "without offset");
    if (averaged)
        return; // its velocities are those of a heading that swings
    over_ground(straight->model, start, v);
    over_ground(straight->model, straight->body, body);
    swim[0] = cos(heading) * body[0] - sin(heading) * body[1] + current[0];
    swim[1] = sin(heading) * body[0] + cos(heading) * body[1] + current[1];
    CHECK_NEAR(v[0], swim[0], 1e-12, "velocity at the start along x");
    CHECK_NEAR(v[1], swim[1], 1e-12, "and along y");
}

static void check_time(const moray_solution *solution, double end)
{
    double t0, t1;
    moray_solution_times(solution, 0, &t0, &t1);
    CHECK(t0 == 0, "begins at 0: %g s", t0);
    CHECK_NEAR(t1, end, 1e-12 * end, "ends [s]");
}

// Follows the reference, at the straight's speed in the current.
static void test_heading(moray_model model, bool averaged)
{
    moray_reference reference = read_ok("ramps:0=20,5=80,12=-40");
    const moray_heading_spec spec = heading_spec(model, averaged, &reference);
    const moray_settings settings = guess_alone();
    const moray_gait gait = gait_of(&spec.robot, model);
    moray_steering_plan plan;
    double p[2] = {0, 0}, worst = 0, speed = 0; // through the water
    CHECK_OK(moray_heading_plan_make(&plan, &spec, &settings, &gait, NULL), "a guess");
    check_start(&plan, averaged, 20 * DEG, p);
    check_time(plan.solution, 12);
    for (int k = 0; k < SAMPLES; k++) {
        const double t = 12.0 * k / (SAMPLES - 1), swing = plan.straight.body[MORAY_STATE_THETA];
        const double heading = (t < 5 ? 20 + 12 * t : 80 - 120 * (t - 5) / 7) * DEG + swing;
        double x[states], v[2], body[2];
        moray_solution_at(plan.solution, 0, t + just, x, NULL);
        if (k > 0 && k % 16 == 0 && k + 1 < SAMPLES) { // where an interval begins
            worst = tap_worse(worst, fabs(x[MORAY_STATE_THETA] - heading));
            worst = tap_worse(worst, hypot(x[MORAY_STATE_P_X] - p[0], x[MORAY_STATE_P_Y] - p[1]));
            over_ground(model, x, v);
            over_ground(model, plan.straight.body, body);
            speed = tap_worse(speed, fabs(hypot(v[0] - current[0], v[1] - current[1]) - hypot(body[0], body[1])));
        }
        p[0] += 12.0 / (SAMPLES - 1) * (plan.straight.speed * cos(heading) + current[0]);
        p[1] += 12.0 / (SAMPLES - 1) * (plan.straight.speed * sin(heading) + current[1]);
    }
    CHECK_NEAR(worst, 0, 1e-8, "heading and place of the guess");
    CHECK_NEAR(speed, 0, 1e-8, "its speed through the water");
    const double *s = moray_solution_parameters(plan.solution);
    CHECK_NEAR(s[MORAY_STEERING_AMPLITUDE], gait.amplitude, 1e-9, "amplitude");
    CHECK_NEAR(s[MORAY_STEERING_OMEGA], gait.omega, 1e-9, "omega");
    CHECK_NEAR(s[MORAY_STEERING_DELTA], gait.delta, 1e-9, "delta");
    moray_steering_plan_free(&plan);
    moray_reference_free(&reference);
}

// What is off is off the heading without the undulation; the averaged plant has none.
static void test_undulation(bool averaged)
{
    enum { first = states + 1, inputs = first + MORAY_STEERING_PARAMETERS + 1, most = 16 };
    moray_reference reference = read_ok("ramps:0=20");
    const moray_model model = averaged ? MORAY_CONTROL_ORIENTED : MORAY_FIRST_PRINCIPLES;
    moray_heading_spec spec = heading_spec(model, averaged, &reference);
    const moray_settings settings = guess_alone();
    const moray_gait gait = gait_of(&spec.robot, model);
    moray_steering_plan plan;
    double in[inputs] = {0}, out[most];
    CHECK_OK(moray_heading_plan_make(&plan, &spec, &settings, &gait, NULL), "a guess");
    const moray_map *map = moray_steering_ocp(plan.problem.steering)->phase[0].map;
    const double t = 0.37, omega = gait.omega, *factor = plan.straight.undulation;
    in[MORAY_STATE_THETA] = 0.9;
    in[first + MORAY_STEERING_AMPLITUDE] = gait.amplitude;
    in[first + MORAY_STEERING_OMEGA] = omega;
    in[first + MORAY_STEERING_DELTA] = gait.delta;
    in[inputs - 1] = t;
    if (CHECK(map->n_in == inputs && map->n_out <= most, "%d numbers in, %d out", map->n_in, map->n_out)) {
        map->value(map->self, in, out);
        const double swing = averaged ? 0 : factor[0] * cos(omega * t) + factor[1] * sin(omega * t);
        const double error = 0.9 - 20 * DEG - swing;
        CHECK_NEAR(out[states], 3 * error * error, 1e-9, "squared error");
    }
    CHECK(averaged || fabs(factor[0]) + fabs(factor[1]) > 1 * DEG, "an undulation");
    moray_steering_plan_free(&plan);
    moray_reference_free(&reference);
}

// ---- Paths ---------------------------------------------------------------------------------------------------------

static const double place[2] = {0.3, 0.9};

typedef struct swimmer {
    double x, y, heading, rate, along;
} swimmer;

// A lookahead of 1.5 m and 2 s to turn, no faster than the robot.
static void go_on(swimmer *s, const moray_path *path, double speed, double fastest, double seconds)
{
    double across;
    moray_path_project(path, s->x, s->y, &s->along, &across);
    const double course = creal(moray_path_at(path, s->along + 0.75).course);
    const double crab = -asin((current[1] * cos(course) - current[0] * sin(course)) / speed);
    const double rate = remainder(course + crab - atan(across / 1.5) - s->heading, 2 * M_PI) / 2;
    s->rate = rate > fastest ? fastest : rate < -fastest ? -fastest : rate;
    s->x += seconds * (speed * cos(s->heading) + current[0]);
    s->y += seconds * (speed * sin(s->heading) + current[1]);
    s->heading += seconds * s->rate;
}

static moray_path_spec path_spec(moray_model model, bool averaged, const moray_path *path)
{
    return (moray_path_spec){.robot = moray_robot_paper(),
                             .model = model,
                             .averaged = averaged,
                             .current = {current[0], current[1]},
                             .limits = limits_of(model),
                             .weight = {1, 0.01, 0.01},
                             .path = path,
                             .tube = MORAY_INFINITY,
                             .reach = 2};
}

// The time that a point as fast takes to the end of the path, counted in shares of what the path takes.
static double arrival(swimmer s, const moray_path *path, double speed, double fastest)
{
    double across;
    moray_path_project(path, place[0], place[1], &s.along, &across);
    const double share = moray_path_duration(path, s.along, speed, current) / SAMPLES;
    int n = 0;
    for (; s.along < path->length && n * share < 3 * SAMPLES * share; n++)
        go_on(&s, path, speed, fastest, share);
    return n * share;
}

// A way to the path from its left, first turning one way as fast as it can, then the other.
static void test_path(moray_model model, bool averaged, double heading)
{
    moray_path path;
    moray_steering_plan plan;
    CHECK_OK(moray_path_read(&path, "0,0 4,1 5,6", 0.8), "a path");
    const moray_path_spec spec = path_spec(model, averaged, &path);
    const moray_settings settings = guess_alone();
    const moray_gait gait = gait_of(&spec.robot, model);
    moray_gait turning = gait;
    double rate, worst[4] = {0};
    turning.offset = spec.limits.offset;
    CHECK_OK(moray_turn_rate(&spec.robot, model, &turning, &rate), "turn rate");
    CHECK_OK(moray_path_plan_make(&plan, &spec, &settings, &gait, place, heading, NULL), "a guess");
    check_start(&plan, averaged, heading, place);
    const double speed = plan.straight.speed;
    swimmer at = {.x = place[0], .y = place[1], .heading = heading};
    double across;
    moray_path_project(&path, place[0], place[1], &at.along, &across);
    const double end = arrival(at, &path, speed, fabs(rate));
    int limited = 0;
    check_time(plan.solution, end);
    for (int k = 0; k < SAMPLES; k++) {
        double x[states], u[2], v[2];
        go_on(&at, &path, speed, fabs(rate), k ? end / (SAMPLES - 1) : 0);
        limited += fabs(at.rate) == fabs(rate);
        moray_solution_at(plan.solution, 0, end * k / (SAMPLES - 1) + just, x, u);
        if (k == 0 || k % 16 != 0 || k + 1 == SAMPLES)
            continue;
        worst[0] = tap_worse(worst[0], fabs(x[MORAY_STATE_THETA] - at.heading));
        worst[0] = tap_worse(worst[0], fabs(x[MORAY_STATE_V_THETA] - at.rate));
        worst[0] = tap_worse(worst[0], hypot(x[MORAY_STATE_P_X] - at.x, x[MORAY_STATE_P_Y] - at.y));
        over_ground(model, x, v);
        worst[1] = tap_worse(worst[1], fabs(v[0] - speed * cos(at.heading) - current[0]));
        worst[1] = tap_worse(worst[1], fabs(v[1] - speed * sin(at.heading) - current[1]));
        worst[2] = tap_worse(worst[2], fabs(x[MORAY_STATE_PHI_0] / spec.limits.offset - at.rate / rate));
        moray_solution_at(plan.solution, 0, end * k / (SAMPLES - 1) - just, x, u); // a point of collocation
        worst[3] = tap_worse(worst[3], fabs(u[1] - at.along));
    }
    CHECK_NEAR(worst[0], 0, 1e-7, "headings, turning and places of the guess");
    CHECK_NEAR(worst[1], 0, 1e-7, "velocities of the guess");
    CHECK_NEAR(worst[2], 0, 0.03, "offsets of the guess, which the solver keeps off their limits");
    CHECK_NEAR(worst[3], 0, 1e-7, "distances along the path of the guess");
    CHECK(limited > 0 && limited < SAMPLES, "%d of %d turn as fast as can be", limited, SAMPLES);
    moray_steering_plan_free(&plan);
    moray_path_free(&path);
}

// ---- Plans from plans ----------------------------------------------------------------------------------------------

// A plan of one model as the guess of the other's: the same way in another time, offsets in the ratio of the
// amplitudes and, by erratum E3, to the other side.
static void test_other(moray_model from, moray_model to)
{
    const double stretch = 1.3;
    moray_path path;
    moray_steering_plan plan;
    steering_guess guess;
    moray_settings settings = guess_alone();
    double t0, t1, worst[4] = {0}, bent = 0, pushed = 0;
    settings.max_iterations = 3; // so that the control is not 0
    CHECK_OK(moray_path_read(&path, "0,0 4,1", 0.8), "a path");
    const moray_path_spec spec = path_spec(from, from == MORAY_CONTROL_ORIENTED, &path);
    const moray_gait gait = gait_of(&spec.robot, from);
    CHECK_OK(moray_path_plan_make(&plan, &spec, &settings, &gait, place, 0.4, NULL), "a plan");
    CHECK_OK(moray_steering_guess_new(&guess, 9, 2), "samples");
    moray_steering_guess_from_other(&guess, &spec.robot, plan.solution, &plan.straight, to, stretch);
    const moray_gait found = moray_steering_gait(moray_solution_parameters(plan.solution));
    const moray_gait mapped = moray_gait_map(&spec.robot, &found, plan.straight.model, to);
    const double scale = from == to ? 1 : -mapped.amplitude / found.amplitude;
    moray_solution_times(plan.solution, 0, &t0, &t1);
    for (int k = 0; k < 9; k++) {
        const double t = t0 + (t1 - t0) * k / 8, *x = guess.x + k * states, *u = guess.u + 2 * k;
        double y[states], w[2], v[2], V[2];
        moray_solution_at(plan.solution, 0, t, y, w);
        over_ground(from, y, V);
        over_ground(to, x, v);
        worst[0] = tap_worse(worst[0], fabs(guess.time[k] - stretch * t));
        for (int r = 0; r <= MORAY_STATE_V_THETA; r++)
            worst[1] = tap_worse(worst[1], fabs(x[r] - y[r]));
        worst[1] = tap_worse(worst[1], hypot(v[0] - V[0], v[1] - V[1]));
        worst[2] = tap_worse(worst[2], fabs(x[MORAY_STATE_PHI_0] - scale * y[MORAY_STATE_PHI_0]));
        worst[2] = tap_worse(worst[2], fabs(x[MORAY_STATE_V_PHI_0] - scale * y[MORAY_STATE_V_PHI_0]));
        worst[3] = tap_worse(worst[3], fabs(u[0] - scale * w[0]) + fabs(u[1] - w[1]));
        bent = fmax(bent, fabs(y[MORAY_STATE_PHI_0]));
        pushed = fmax(pushed, fabs(w[0]));
    }
    CHECK(bent > 1e-4 && pushed > 1e-5, "a plan that steers: %.2g, %.2g", bent, pushed);
    CHECK_NEAR(worst[0], 0, 1e-12, "times, stretched");
    CHECK_NEAR(worst[1], 0, 1e-12, "the same way, as fast");
    CHECK_NEAR(worst[2], 0, 1e-12, "offsets and their rates");
    CHECK_NEAR(worst[3], 0, 1e-12, "controls, of which the first is an offset's");
    CHECK_NEAR(guess.s[MORAY_STEERING_AMPLITUDE], mapped.amplitude, 1e-14, "amplitude");
    free(guess.time);
    moray_steering_plan_free(&plan);
    moray_path_free(&path);
}

// Which is what a plan from a plan of another model begins with; one of the same model with its own way.
static void test_from(moray_model model)
{
    moray_path path;
    moray_reference reference = read_ok("ramps:0=20,5=80,12=-40");
    moray_steering_plan plan, next;
    const moray_settings settings = guess_alone();
    CHECK_OK(moray_path_read(&path, "0,0 4,1", 0.8), "a path");
    moray_path_spec spec = path_spec(MORAY_CONTROL_ORIENTED, true, &path);
    moray_heading_spec heading = heading_spec(MORAY_CONTROL_ORIENTED, true, &reference);
    for (int on_path = 0; on_path < 2; on_path++) {
        moray_gait gait = gait_of(&spec.robot, MORAY_CONTROL_ORIENTED);
        CHECK_OK(on_path ? moray_path_plan_make(&plan, &spec, &settings, &gait, place, 0.4, NULL)
                         : moray_heading_plan_make(&plan, &heading, &settings, &gait, NULL),
                 "a plan");
        spec.model = heading.model = model;
        spec.averaged = heading.averaged = false;
        spec.limits = heading.limits = limits_of(model);
        gait = gait_of(&spec.robot, model);
        CHECK_OK(on_path ? moray_path_plan_make(&next, &spec, &settings, &gait, place, 0.4, &plan)
                         : moray_heading_plan_make(&next, &heading, &settings, &gait, &plan),
                 "from it");
        double t0, end[2], a[states], b[states], u[2], along = 0, across, worst = 0;
        moray_path_project(&path, place[0], place[1], &along, &across);
        moray_solution_times(plan.solution, 0, &t0, &end[0]);
        moray_solution_times(next.solution, 0, &t0, &end[1]);
        const double stretch = on_path && model != MORAY_CONTROL_ORIENTED
                                   ? moray_path_duration(&path, along, next.straight.speed, current) /
                                         moray_path_duration(&path, along, plan.straight.speed, current)
                                   : 1;
        CHECK_NEAR(end[1], stretch * end[0], 1e-6 * end[0], "end of the plan [s]");
        for (int k = 1; k < INTERVALS; k++) { // of another model from samples, those of where an interval ends
            moray_solution_at(plan.solution, 0, end[0] * k / INTERVALS + (model ? -just : just), a, u);
            moray_solution_at(next.solution, 0, end[1] * k / INTERVALS + just, b, u);
            for (int r = 0; r <= MORAY_STATE_P_Y; r++)
                worst = tap_worse(worst, fabs(a[r] - b[r]));
        }
        CHECK_NEAR(worst, 0, 1e-6, "the same way");
        moray_steering_plan_free(&plan);
        moray_steering_plan_free(&next);
        spec.model = heading.model = MORAY_CONTROL_ORIENTED;
        spec.averaged = heading.averaged = true;
        spec.limits = heading.limits = limits_of(MORAY_CONTROL_ORIENTED);
    }
    moray_path_free(&path);
    moray_reference_free(&reference);
}

int main(void)
{
    test_heading(MORAY_CONTROL_ORIENTED, true);
    test_heading(MORAY_CONTROL_ORIENTED, false);
    test_heading(MORAY_FIRST_PRINCIPLES, false);
    test_undulation(false);
    test_undulation(true);
    test_path(MORAY_CONTROL_ORIENTED, true, 2.5);
    test_path(MORAY_FIRST_PRINCIPLES, false, -2);
    test_other(MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    test_other(MORAY_FIRST_PRINCIPLES, MORAY_CONTROL_ORIENTED);
    test_other(MORAY_CONTROL_ORIENTED, MORAY_CONTROL_ORIENTED);
    test_from(MORAY_CONTROL_ORIENTED);
    test_from(MORAY_FIRST_PRINCIPLES);
    return tap_done();
}
