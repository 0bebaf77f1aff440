// SPDX-License-Identifier: MIT
//
// What the navigator finds of a current and a robot that it was told wrongly, swimming the first-principles model; and
// the receding horizon on it.
#include "degree.h"
#include "tap.h"

#include <stdlib.h>

#include "moray/snake/closed_loop.h"
#include "moray/snake/moving_horizon.h"
#include "moray/snake/navigator.h"
#include "moray/snake/trial.h"

typedef struct sea {
    moray_robot robot;
    moray_gait gait;                // of the control-oriented model
    moray_straight_motion straight; // first-principles
    double scale, current[2];
    moray_belief truth;
} sea;

static void sea_new(sea *at)
{
    double rate;
    *at = (sea){.robot = moray_robot_paper(), .current = {0.06, -0.08}};
    at->robot.hydro = moray_hydrodynamics_consistent();
    at->gait = moray_gait_paper(&at->robot);
    moray_gait mapped = moray_gait_map(&at->robot, &at->gait, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    at->scale = -mapped.amplitude / at->gait.amplitude;
    CHECK_OK(moray_straight_motion_find(&at->straight, &at->robot, MORAY_FIRST_PRINCIPLES, &mapped), "straight");
    mapped.offset = 0.007 * at->scale;
    CHECK_OK(moray_turn_rate(&at->robot, MORAY_FIRST_PRINCIPLES, &mapped, &rate), "turning");
    CHECK_OK(moray_belief_find(&at->truth, &at->robot, &at->gait, at->straight.speed, 0.007, rate), "belief");
    CHECK(fabs(at->truth.amplitude - 1) > 0.01 && fabs(at->truth.turning - 1) > 0.01,
          "the averaged plant needs factors of %.3f and %.3f", at->truth.amplitude, at->truth.turning);
    CHECK(moray_belief_find(&at->truth, &at->robot, &at->gait, 5, 0.007, rate).code == MORAY_NOT_SOLVED,
          "and has none for 5 m/s");
    CHECK_OK(moray_belief_find(&at->truth, &at->robot, &at->gait, at->straight.speed, 0.007, rate), "belief");
}

static moray_navigator_spec told_wrongly(const sea *at)
{
    return (moray_navigator_spec){.robot = at->robot,
                                  .gait = at->gait,
                                  .speed = at->straight.speed,
                                  .belief = {1.2 * at->truth.amplitude, 0.8 * at->truth.turning, {0, 0}},
                                  .current_doubt = 0.1,
                                  .factor_doubt = 0.2,
                                  .heading_error = 0.5 * DEG,
                                  .position_error = 0.02};
}

static moray_swim_closed_loop sail(const sea *at, const moray_swim_controller *controller, double duration)
{
    const moray_swim_on_gait how = {.steps = 24};
    const moray_swim_closed_loop_spec spec = {.robot = &at->robot,
                                              .straight = &at->straight,
                                              .current = {at->current[0], at->current[1]},
                                              .controller = controller,
                                              .duration = duration,
                                              .intervals = (int)(10 * duration),
                                              .on_gait = &how};
    moray_swim_closed_loop closed_loop;
    CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &spec), "swum");
    return closed_loop;
}

// Swims a bend; the navigator only watches.
static double bend(const moray_swim_sample *sample, void *self)
{
    (void)self;
    return sample->t < 10 ? 0 : sample->t < 35 ? 60 * DEG : -20 * DEG;
}

static void test_estimate(const sea *at)
{
    moray_feedback feedback = {.target = bend,
                               .gain = 0.08 * at->scale,
                               .straight = &at->straight,
                               .offset = 0.015 * fabs(at->scale),
                               .offset_rate = 0.01 * fabs(at->scale),
                               .period = 0.1};
    const moray_swim_controller controller = moray_feedback_controller(&feedback);
    const moray_navigator_spec spec = told_wrongly(at);
    moray_navigator *navigator;
    CHECK_OK(moray_navigator_new(&navigator, &spec), "navigator");
    moray_swim_closed_loop closed_loop = sail(at, &controller, 60);
    const double doubt = moray_navigator_doubt(navigator);
    for (int k = 5; k < closed_loop.track.n; k += 5) {
        const double *offset = closed_loop.offset + k - 5, t = closed_loop.track.t[k];
        const moray_pose *pose = &closed_loop.track.pose[k];
        moray_status status =
            moray_navigator_advance(navigator, t, offset[0] / at->scale, (offset[5] - offset[0]) / 0.5 / at->scale);
        if (!moray_failed(status))
            status = moray_navigator_read(navigator, moray_straight_motion_heading(&at->straight, t, pose->heading),
                                          pose->p_x, pose->p_y);
        if (moray_failed(status))
            CHECK_OK(status, "estimated");
    }
    const moray_belief found = moray_navigator_belief(navigator);
    CHECK_NEAR(found.current[0], at->current[0], 0.006, "current [m/s]");
    CHECK_NEAR(found.current[1], at->current[1], 0.006, "current [m/s]");
    CHECK_NEAR(found.amplitude / at->truth.amplitude, 1, 0.04, "factor of the thrust");
    CHECK_NEAR(found.turning / at->truth.turning, 1, 0.04, "factor of the turning");
    CHECK(moray_navigator_doubt(navigator) < doubt / 4, "and it knows that it knows");
    moray_swim_closed_loop_free(&closed_loop);
    moray_navigator_free(navigator);
}

// The same swim, its readings all at once, with errors of their size: in a window as long as the swim, and in one of a
// third, which has to know the heading's own errors better.
static void test_moving_horizon(const sea *at)
{
    enum { n = 120 };
    moray_feedback feedback = {.target = bend,
                               .gain = 0.08 * at->scale,
                               .straight = &at->straight,
                               .offset = 0.015 * fabs(at->scale),
                               .offset_rate = 0.01 * fabs(at->scale),
                               .period = 0.1};
    const moray_swim_controller controller = moray_feedback_controller(&feedback);
    const moray_navigator_spec spec = told_wrongly(at);
    moray_swim_closed_loop closed_loop = sail(at, &controller, 60);
    double t[n], offset[n], heading[n], p_x[n], p_y[n], error[4];
    unsigned long seed = 3;
    for (int k = 0; k < n; k++) {
        const int row = 5 * (k + 1);
        const moray_pose *pose = &closed_loop.track.pose[row];
        t[k] = closed_loop.track.t[row];
        offset[k] = closed_loop.offset[row] / at->scale;
        heading[k] = k % 7 == 3 ? NAN
                                : moray_straight_motion_heading(&at->straight, t[k], pose->heading) +
                                      0.5 * spec.heading_error * moray_random_normal(&seed);
        p_x[k] = pose->p_x + 0.5 * spec.position_error * moray_random_normal(&seed);
        p_y[k] = pose->p_y + 0.5 * spec.position_error * moray_random_normal(&seed);
    }
    const moray_log log = {n, t, offset, heading, p_x, p_y};
    moray_settings settings = moray_settings_default();
    moray_belief found;
    settings.scheme = "radau3";
    settings.max_iterations = 60;
    settings.tolerance = 1e-6;
    CHECK_OK(moray_moving_horizon(&spec, &log, 60, &settings, &found, error), "estimated");
    CHECK_NEAR(found.current[0], at->current[0], 0.006, "current [m/s]");
    CHECK_NEAR(found.current[1], at->current[1], 0.006, "current [m/s]");
    CHECK_NEAR(found.amplitude / at->truth.amplitude, 1, 0.04, "factor of the thrust");
    CHECK_NEAR(found.turning / at->truth.turning, 1, 0.04, "factor of the turning");
    CHECK(error[0] > 0 && error[0] < 0.01 && error[3] > 0 && error[3] < 0.1, "and how well: %.1e m/s, %.1e", error[0],
          error[3]);
    CHECK(moray_moving_horizon(&spec, &log, 0.2, &settings, &found, NULL).code == MORAY_INPUT,
          "one reading is too few");
    moray_swim_closed_loop_free(&closed_loop);
}

// A step in heading, planned with wrong beliefs and estimated ones.
static void test_adaptive(const sea *at)
{
    moray_reference reference;
    CHECK_OK(moray_reference_read(&reference, "steps:6=25"), "reference");
    const double duration = 30, period = 2 * M_PI / at->gait.omega;
    moray_heading_replanner replanner = {.spec = {.robot = at->robot,
                                                  .averaged = true,
                                                  .weight = {1 / (100 * DEG * DEG), 0, 0.003},
                                                  .reference = &reference,
                                                  .max_error = MORAY_INFINITY},
                                         .horizon = 4 * period,
                                         .preview = true};
    moray_adaptive_spec spec = {.navigator = told_wrongly(at),
                                .measured = &at->straight,
                                .scale = at->scale,
                                .limits = {.offset = 0.015, .offset_rate = 0.01},
                                .heading = &replanner,
                                .settings = moray_settings_default(),
                                .horizon = 4 * period,
                                .interval = period,
                                .look = 0.1};
    moray_adaptive *adaptive;
    spec.settings.scheme = "radau3";
    spec.settings.intervals = 10;
    spec.settings.tolerance = 1e-6;
    CHECK_OK(moray_adaptive_new(&adaptive, &spec), "adaptive");
    const moray_swim_controller controller = moray_adaptive_controller(adaptive);
    moray_swim_closed_loop closed_loop = sail(at, &controller, duration);
    const moray_heading_score score = moray_swim_closed_loop_heading_score(&closed_loop, &at->straight, &reference);
    const moray_receding_horizon_record *record = moray_adaptive_record(adaptive);
    CHECK(record->plans >= 10 && record->failures == 0, "%d plans, %d failed", record->plans, record->failures);
    CHECK_NEAR(score.final, 0, 1.5 * DEG, "heading behind the step [rad]");
    CHECK(score.largest < 22 * DEG, "which was begun before its time: %.1f deg at most", score.largest / DEG);
    moray_swim_closed_loop_free(&closed_loop);
    moray_adaptive_free(adaptive);
    moray_reference_free(&reference);
    spec.heading = NULL;
    CHECK(moray_adaptive_new(&adaptive, &spec).code == MORAY_INPUT && !adaptive, "neither heading nor path");
}

int main(void)
{
    sea at;
    sea_new(&at);
    test_estimate(&at);
    test_moving_horizon(&at);
    test_adaptive(&at);
    return tap_done();
}
