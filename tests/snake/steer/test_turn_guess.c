// SPDX-License-Identifier: MIT
//
// Turns of no iteration: a steady turn to either side whatever the sign of the turn rate, and the fastest way of arcs
// and legs where there is an end to come to.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/trial.h"
#include "moray/snake/turn.h"
#include "ocp/problem.h"
#include "snake/steer/dubins.h"
#include "snake/steer/problems.h"

enum { states = MORAY_STEERING_STATES, INTERVALS = 16 };
static const double just = 1e-9; // behind where an interval begins, where a solution is what the guess is there [s]
static const double V[2] = {0.04, -0.07};

static moray_turn_spec spec_of(moray_model model, double heading)
{
    const bool control = model == MORAY_CONTROL_ORIENTED;
    moray_turn_spec spec = {.robot = moray_robot_paper(),
                            .model = model,
                            .current = {V[0], V[1]},
                            .limits = {.theta_max = moray_between(1 * DEG, 40 * DEG),
                                       .omega = moray_fixed(120 * DEG),
                                       .delta = moray_fixed(40 * DEG),
                                       .offset = control ? 0.015 : 5 * DEG,
                                       .offset_rate = control ? 0.01 : 3 * DEG,
                                       .offset_acceleration = MORAY_INFINITY,
                                       .power = MORAY_INFINITY},
                            .heading = heading,
                            .steering = 0.01};
    return spec;
}

static moray_steering_plan guess_of(const moray_turn_spec *spec, double turn_rate)
{
    const moray_gait paper = moray_gait_paper(&spec->robot);
    const moray_gait gait = moray_gait_map(&spec->robot, &paper, MORAY_CONTROL_ORIENTED, spec->model);
    moray_settings settings = moray_settings_default();
    moray_steering_plan plan;
    settings.scheme = "radau3";
    settings.intervals = INTERVALS;
    settings.max_iterations = 0;
    CHECK_OK(moray_turn_plan_make(&plan, spec, &settings, &gait, turn_rate, NULL, 1), "a guess");
    return plan;
}

static void check_start(const moray_steering_plan *plan, bool averaged)
{
    const struct phase *phase = &moray_steering_ocp(plan->problem.steering)->phase[0];
    const double *body = plan->straight.body;
    CHECK_NEAR(phase->x0[MORAY_STATE_THETA].lower, averaged ? 0 : body[MORAY_STATE_THETA], 1e-12, "heading at first");
    CHECK_NEAR(phase->x0[MORAY_STATE_V_THETA].upper, averaged ? 0 : body[MORAY_STATE_V_THETA], 1e-12, "turning then");
    CHECK(phase->x0[MORAY_STATE_P_X].lower == 0 && phase->x0[MORAY_STATE_P_Y].upper == 0, "place then");
}

static void check_times(const moray_steering_plan *plan, double seconds, double shortest, double longest)
{
    const struct phase *phase = &moray_steering_ocp(plan->problem.steering)->phase[0];
    double t0, t1;
    moray_solution_times(plan->solution, 0, &t0, &t1);
    CHECK_NEAR(t0, 0, 0, "begins at 0");
    CHECK_NEAR(t1, seconds, 1e-9 * seconds, "in the time that it takes [s]");
    CHECK_NEAR(phase->tf.lower, shortest, 1e-9, "at least [s]");
    CHECK_NEAR(phase->tf.upper, longest, 1e-9 * longest, "at most [s]");
}

// The undulation of a heading at the start of a stroke, which samples carry where the plant has one.
static double swing_of(const moray_steering_plan *plan, bool averaged)
{
    return averaged ? 0 : plan->straight.body[MORAY_STATE_THETA];
}

static void test_steady(moray_model model, bool averaged, double heading, double turn_rate)
{
    moray_turn_spec spec = spec_of(model, heading);
    spec.averaged = averaged;
    moray_steering_plan plan = guess_of(&spec, turn_rate);
    const double ramp = spec.limits.offset / spec.limits.offset_rate, speed = plan.straight.speed;
    const double seconds = fabs(heading / turn_rate) + 2 * ramp + 1, step = seconds / (16 * INTERVALS);
    const double rate = heading / seconds;
    double p[2] = {0, 0}, worst = 0, offset = 0;
    check_start(&plan, averaged);
    check_times(&plan, seconds, 0.1, 6 * seconds);
    for (int k = 0; k < 16 * INTERVALS; k++) {
        double x[states], share = rate / turn_rate;
        share = share > 0.9 ? 0.9 : share < -0.9 ? -0.9 : share;
        moray_solution_at(plan.solution, 0, k * step + just, x, NULL);
        if (k % 16 == 0 && k > 0) {
            worst = tap_worse(worst, fabs(x[MORAY_STATE_THETA] - k * step * rate - swing_of(&plan, averaged)));
            worst = tap_worse(worst, fabs(x[MORAY_STATE_V_THETA] - rate));
            worst = tap_worse(worst, hypot(x[MORAY_STATE_P_X] - p[0], x[MORAY_STATE_P_Y] - p[1]));
            offset = tap_worse(offset, fabs(x[MORAY_STATE_PHI_0] / spec.limits.offset - share));
        }
        p[0] += step * (speed * cos(k * step * rate) + V[0]);
        p[1] += step * (speed * sin(k * step * rate) + V[1]);
    }
    CHECK_NEAR(worst, 0, 1e-7, "turns steadily, at the straight's speed");
    CHECK_NEAR(offset, 0, 1e-7, "with the offset that this takes");
    moray_steering_plan_free(&plan);
}

// ---- To an end -----------------------------------------------------------------------------------------------------

typedef struct way {
    moray_dubins path;
    double radius, seconds;
} way;

// Ways on circles 1.15 and 1.6 times as wide as steady turning, the four fastest in the order of their times.
static int ways_of(const moray_turn_spec *spec, double speed, double turn_rate, way found[4])
{
    way all[2 * MORAY_DUBINS_KINDS];
    int n = 0;
    for (int w = 0; w < 2; w++)
        for (int kind = 0; kind < MORAY_DUBINS_KINDS; kind++) {
            way *next = &all[n];
            next->radius = (w ? 1.6 : 1.15) * speed / fabs(turn_rate);
            const double steady =
                fabs(spec->heading / turn_rate) + 2 * spec->limits.offset / spec->limits.offset_rate + 1;
            const double longest =
                10 * (steady + (hypot(spec->position[0], spec->position[1]) + 8 * next->radius) / speed);
            n += moray_dubins_in_current(kind, spec->position, spec->heading, V, speed, next->radius, longest,
                                         &next->path, &next->seconds);
        }
    int kept = 0;
    for (; kept < 4 && kept < n; kept++) {
        int least = kept;
        for (int k = kept; k < n; k++)
            least = all[k].seconds < all[least].seconds ? k : least;
        const way first = all[least];
        for (int k = least; k > kept; k--)
            all[k] = all[k - 1];
        all[kept] = found[kept] = first;
    }
    return kept;
}

// The side to which a way turns where a share of it is swum.
static double turn_at(const way *w, double share)
{
    const double *length = w->path.length, at = share * (length[0] + length[1] + length[2]);
    return w->path.turn[at <= length[0] ? 0 : at <= length[0] + length[1] ? 1 : 2];
}

// Along the fastest way, as it turns in the middle of each step, at the speed that brings it round in its time.
static void test_way(const double end[2], double heading, double turn_rate)
{
    enum { n = 16 * INTERVALS + 1 };
    moray_turn_spec spec = spec_of(MORAY_CONTROL_ORIENTED, heading);
    spec.to_position = true;
    memcpy(spec.position, end, sizeof spec.position);
    moray_steering_plan plan = guess_of(&spec, turn_rate);
    way ways[4];
    const int kept = ways_of(&spec, plan.straight.speed, turn_rate, ways);
    const double *length = ways[0].path.length, seconds = ways[0].seconds, step = seconds / (n - 1);
    const double speed = ways[0].radius * (length[0] + length[1] + length[2]) / seconds;
    double pose[3] = {0}, worst = 0;
    check_start(&plan, false);
    check_times(&plan, seconds, 0.1, 6 * ways[kept - 1].seconds);
    for (int k = 0; k < n; k++) {
        double x[states];
        moray_solution_at(plan.solution, 0, k * step + just, x, NULL);
        const double rate = speed / ways[0].radius * turn_at(&ways[0], (k + 0.5) / n);
        if (k % 16 == 0 && k > 0 && k + 1 < n) {
            worst = tap_worse(worst, fabs(x[MORAY_STATE_THETA] - swing_of(&plan, false) - pose[0]));
            worst = tap_worse(worst, fabs(x[MORAY_STATE_V_THETA] - rate));
            worst = tap_worse(worst, hypot(x[MORAY_STATE_P_X] - pose[1], x[MORAY_STATE_P_Y] - pose[2]));
        }
        pose[1] += step * (speed * cos(pose[0]) + V[0]);
        pose[2] += step * (speed * sin(pose[0]) + V[1]);
        pose[0] += step * rate;
    }
    CHECK(worst < 1e-6, "(%g, %g) m: along the fastest of %d ways, to %.2g", end[0], end[1], kept, worst);
    CHECK(hypot(pose[1] - end[0], pose[2] - end[1]) < 0.5, "to its end but for the steps' length: (%.3g, %.3g) m",
          pose[1], pose[2]);
    moray_steering_plan_free(&plan);
}

static void test_none(void)
{
    const moray_turn_spec spec = spec_of(MORAY_CONTROL_ORIENTED, NAN);
    const moray_gait gait = moray_gait_paper(&spec.robot);
    const moray_settings settings = moray_settings_default();
    moray_steering_plan plan;
    CHECK(moray_turn_plan_make(&plan, &spec, &settings, &gait, 0.1, NULL, 1).code == MORAY_INPUT, "no end to turn to");
    CHECK(!plan.problem.task && plan.straight.speed == 0, "and nothing is left");
}

int main(void)
{
    test_none();
    for (int k = 0; k < 4; k++) {
        const double side = k % 2 ? -1 : 1, rate = k / 2 ? -0.1 : 0.1;
        test_steady(MORAY_CONTROL_ORIENTED, true, side * 100 * DEG, rate);
        if (k == 0)
            test_steady(MORAY_CONTROL_ORIENTED, false, side * 70 * DEG, 1.5 * rate);
        test_way((double[]){4, side * 2}, side * 60 * DEG, rate);
        test_way((double[]){-3, side * 1}, side * 100 * DEG, rate);
        if (k == 1 || k == 2)
            test_way((double[]){0.5, side * 0.5}, side * -170 * DEG, 1.5 * rate);
    }
    test_steady(MORAY_FIRST_PRINCIPLES, false, -80 * DEG, -0.12);
    return tap_done();
}
