// SPDX-License-Identifier: MIT
//
// Receding horizon: when plans are made and from what, told by a replanner that listens in; and steering problems: what
// they refuse, and limits in the other model against (27) and (33).
#include "degree.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/snake/trial.h"
#include "moray/snake/receding_horizon.h"
#include "moray/snake/closed_loop.h"
#include "snake/steer/problems.h"

// ---- Steering problems ---------------------------------------------------------------------------------------------

static moray_steering_limits usual_limits(void)
{
    return (moray_steering_limits){.theta_max = moray_fixed(20 * DEG),
                                   .omega = moray_fixed(120 * DEG),
                                   .delta = moray_fixed(40 * DEG),
                                   .offset = 0.015,
                                   .offset_rate = 0.01,
                                   .offset_acceleration = MORAY_INFINITY,
                                   .power = MORAY_INFINITY};
}

// alpha = 2 theta_max sin(delta/2), a = 2 l cos(delta/2) sin theta_max.
static void test_limits_map(void)
{
    const moray_robot robot = moray_robot_paper();
    const moray_steering_limits limits = usual_limits();
    const moray_gait gait = moray_gait_paper(&robot);
    const double ratio = 2 * 20 * DEG * sin(20 * DEG) / (2 * robot.l * cos(20 * DEG) * sin(20 * DEG));
    const moray_steering_limits to =
        moray_steering_limits_map(&robot, &limits, &gait, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    CHECK_NEAR(to.offset, 0.015 * ratio, 1e-12, "range [rad]");
    CHECK_NEAR(to.offset_rate, 0.01 * ratio, 1e-12, "rate [rad/s]");
    CHECK(to.offset_acceleration == MORAY_INFINITY, "what has no limit gets none");
    CHECK(to.omega.lower == limits.omega.lower && to.power == limits.power, "the rest stays");
}

static void refuse(const moray_steering_spec *spec, const char *says)
{
    moray_steering *problem;
    const moray_status status = moray_steering_new(&problem, spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says) && !problem, "%s", status.text);
}

static void test_refused(void)
{
    const moray_steering_spec good = {.robot = moray_robot_paper(),
                                      .limits = usual_limits(),
                                      .t0 = moray_fixed(0),
                                      .tf = moray_fixed(1),
                                      .task = {.name = "none"}};
    moray_steering_spec bad = good;
    bad.limits.theta_max = moray_between(30 * DEG, 10 * DEG);
    refuse(&bad, "theta_max_deg = 30:10");
    bad = good;
    bad.limits.delta = moray_fixed(0);
    refuse(&bad, "delta_deg = 0:0");
    bad = good;
    bad.limits.offset_rate = 0;
    refuse(&bad, "offset rate limit = 0");
    bad = good;
    bad.task.nu = 60;
    refuse(&bad, "further controls of none = 60: must be from 0 to 15");
    bad = good;
    bad.limits.power = NAN;
    refuse(&bad, "power_W = nan");
    bad = good;
    bad.averaged = true;
    bad.model = MORAY_FIRST_PRINCIPLES;
    refuse(&bad, "averaged");
    bad = good;
    bad.current[1] = INFINITY;
    refuse(&bad, "current");
}

// ---- Receding horizon ----------------------------------------------------------------------------------------------

enum { MOST_PLANS = 40 };

typedef struct listener {
    moray_replanner inner;
    int n;
    double t[MOST_PLANS], state[MOST_PLANS][MORAY_STEERING_STATES];
    bool fail;
} listener;

static moray_status listen(void *self, double t, const double *state, void **problem, const moray_ocp **ocp)
{
    listener *l = self;
    l->t[l->n] = t;
    memcpy(l->state[l->n++], state, sizeof l->state[0]);
    return l->fail ? moray_error(MORAY_NUMERIC, "it rains") : l->inner.make(l->inner.self, t, state, problem, ocp);
}

static bool pass_on(const void *self, double t)
{
    const listener *l = self;
    return l->inner.changed && l->inner.changed(l->inner.self, t);
}

typedef struct scene {
    moray_reference reference;
    moray_straight_motion straight[2];
    moray_heading_replanner replanner;
    listener listener;
    moray_swim_receding_horizon *receding;
    double scale;
} scene;

static moray_straight_motion straight_motion_of(moray_model model)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&robot);
    const moray_gait gait = moray_gait_map(&robot, &paper, MORAY_CONTROL_ORIENTED, model);
    moray_straight_motion straight;
    CHECK_OK(moray_straight_motion_find(&straight, &robot, model, &gait), "straight");
    return straight;
}

// Plans of the control-oriented model, 6 s long, every 3 s, for a step of 20 deg at 4.05 s.
static void set(scene *s, bool preview, moray_model swum, double watch)
{
    const moray_straight_motion *planned = &s->straight[0];
    const double unit = 10 * DEG;
    s->scale = swum == MORAY_CONTROL_ORIENTED ? 1 : -s->straight[1].gait.amplitude / planned->gait.amplitude;
    s->replanner = (moray_heading_replanner){.spec = {.robot = moray_robot_paper(),
                                                      .limits = usual_limits(),
                                                      .weight = {.heading = 1 / (unit * unit), .steering = 0.003},
                                                      .reference = &s->reference,
                                                      .max_error = MORAY_INFINITY},
                                             .horizon = 6,
                                             .preview = preview,
                                             .tolerance = 1 * DEG};
    s->listener = (listener){.inner = moray_heading_replan(&s->replanner)};
    moray_swim_receding_horizon_spec spec = {.links = 10,
                                             .replanner = {.nx = MORAY_STEERING_STATES,
                                                           .nu = 1,
                                                           .ns = MORAY_STEERING_PARAMETERS,
                                                           .make = listen,
                                                           .free = s->listener.inner.free,
                                                           .changed = pass_on,
                                                           .self = &s->listener},
                                             .settings = moray_settings_default(),
                                             .limits = &s->replanner.spec.limits,
                                             .planned = planned,
                                             .measured = &s->straight[swum],
                                             .scale = s->scale,
                                             .horizon = 6,
                                             .interval = 3,
                                             .watch = watch};
    spec.settings.scheme = "radau3";
    spec.settings.intervals = 8;
    spec.settings.tolerance = 1e-6;
    CHECK_OK(moray_swim_receding_horizon_new(&s->receding, &spec), "receding horizon");
}

static moray_swim_closed_loop sail(scene *s, moray_model swum, double seconds)
{
    const moray_robot robot = moray_robot_paper();
    const moray_swim_controller controller = moray_swim_receding_horizon_controller(s->receding);
    const moray_swim_closed_loop_spec plan = {.robot = &robot,
                                              .straight = &s->straight[swum],
                                              .controller = &controller,
                                              .duration = seconds,
                                              .intervals = (int)(20 * seconds),
                                              .tolerance = 1e-8};
    moray_swim_closed_loop closed_loop;
    CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &plan), "closed_loop");
    return closed_loop;
}

// At 0, 3, 6, 9 s with the reference known; else at once when it steps, to either side, and 3 s after that.
static void test_times(scene *s, double step)
{
    static const double regular[] = {0, 3, 6, 9}, at_once[] = {0, 3, 4.1, 7.1};
    for (int preview = 0; preview < 2; preview++) {
        const double *expected = preview ? regular : at_once;
        set(s, preview, MORAY_CONTROL_ORIENTED, preview ? 0 : 0.1);
        moray_swim_closed_loop closed_loop = sail(s, MORAY_CONTROL_ORIENTED, 9.5);
        const moray_receding_horizon_record *record =
            moray_receding_horizon_record_of(moray_swim_receding_horizon_engine(s->receding));
        CHECK(s->listener.n == 4 && record->plans == 4 && record->failures == 0, "%d plans", s->listener.n);
        for (int k = 0; k < 4; k++)
            CHECK_NEAR(s->listener.t[k], expected[k], 1e-9, "time of a plan [s]");
        CHECK(record->iterations >= 4 && record->seconds > record->longest && record->longest > 0,
              "%d iterations, %g s, at most %g s", record->iterations, record->seconds, record->longest);
        CHECK(fabs(closed_loop.offset[closed_loop.track.n - 1]) <= 0.015 * (1 + 1e-6), "within its limits");
        const double end = moray_straight_motion_heading(&s->straight[0], 9.5,
                                                         closed_loop.track.pose[closed_loop.track.n - 1].heading);
        CHECK_NEAR(end / DEG, step, 3, "heading in the end [deg]");
        CHECK(preview == (closed_loop.offset[20 * 4 - 2] != 0 && fabs(closed_loop.offset[20 * 4 - 2]) > 1e-4),
              "steers before the step only if it knows: %g m", closed_loop.offset[20 * 4 - 2]);
        moray_swim_closed_loop_free(&closed_loop);
        moray_swim_receding_horizon_free(s->receding);
    }
}

// Of the heading without the undulation of one model and with that of the other, as differences have it at a sample.
static double turning(const scene *s, const moray_swim_track *track, moray_model swum, int sample)
{
    double heading[2];
    for (int k = 0; k < 2; k++) {
        const int at = sample + 2 * k - 1;
        heading[k] = moray_straight_motion_heading(&s->straight[swum], track->t[at], track->pose[at].heading) -
                     moray_straight_motion_heading(&s->straight[0], track->t[at], 0);
    }
    return (heading[1] - heading[0]) / (track->t[sample + 1] - track->t[sample - 1]);
}

// Plans start from the swimmer: heading without undulation, its rate, place, ground velocity without its swing,
// offset.
static void test_measured(scene *s, moray_model swum)
{
    set(s, true, swum, 0);
    moray_swim_closed_loop closed_loop = sail(s, swum, 6.5);
    for (int k = 1; k < s->listener.n; k++) {
        const int sample = (int)lround(20 * s->listener.t[k]);
        const double t = closed_loop.track.t[sample], *state = s->listener.state[k];
        const moray_pose *pose = &closed_loop.track.pose[sample];
        const double turn = state[0];
        CHECK_NEAR(moray_straight_motion_heading(&s->straight[0], t, state[0]),
                   moray_straight_motion_heading(&s->straight[swum], t, pose->heading), 1e-9, "heading [rad]");
        CHECK_NEAR(state[MORAY_STATE_V_THETA], turning(s, &closed_loop.track, swum, sample), 1e-3, "its rate [rad/s]");
        CHECK_NEAR(state[1], pose->p_x, 1e-9, "p_x [m]");
        CHECK_NEAR(state[2], pose->p_y, 1e-9, "p_y [m]");
        CHECK_NEAR(state[4] * cos(turn) - state[5] * sin(turn), pose->v_x, 1e-9, "velocity over ground [m/s]");
        CHECK_NEAR(state[4] * sin(turn) + state[5] * cos(turn), pose->v_y, 1e-9, "and along y");
        CHECK_NEAR(state[MORAY_STATE_PHI_0], closed_loop.offset[sample] / s->scale, 1e-6,
                   "offset of the planning model [m]");
    }
    CHECK(s->listener.n == 3, "%d plans", s->listener.n);
    moray_swim_closed_loop_free(&closed_loop);
    moray_swim_receding_horizon_free(s->receding);
}

// Where no plan comes about the swimmer goes straight on, and the first reason is kept.
static void test_failures(scene *s)
{
    set(s, true, MORAY_CONTROL_ORIENTED, 0);
    s->listener.fail = true;
    moray_swim_closed_loop closed_loop = sail(s, MORAY_CONTROL_ORIENTED, 7);
    const moray_receding_horizon_record *record =
        moray_receding_horizon_record_of(moray_swim_receding_horizon_engine(s->receding));
    CHECK(record->plans == 3 && record->failures == 3, "%d plans, %d failures", record->plans, record->failures);
    CHECK(strstr(record->first_failure, "t = 0: ") && strstr(record->first_failure, "it rains"), "%s",
          record->first_failure);
    CHECK(closed_loop.offset[100] == 0, "goes straight on");
    moray_swim_closed_loop_free(&closed_loop);
    moray_swim_receding_horizon_free(s->receding);
    moray_swim_receding_horizon_free(NULL);
    const moray_swim_receding_horizon_spec bad = {
        .replanner = {.nx = 4, .nu = 1, .ns = MORAY_STEERING_PARAMETERS}, .horizon = 2, .interval = 1};
    const moray_status status = moray_swim_receding_horizon_new(&s->receding, &bad);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "plans of 4 states") && !s->receding, "%s", status.text);
}

int main(void)
{
    static scene s;
    test_limits_map();
    test_refused();
    for (int model = 0; model < 2; model++)
        s.straight[model] = straight_motion_of((moray_model)model);
    CHECK_OK(moray_reference_read(&s.reference, "steps:4.05=-20"), "reference");
    test_times(&s, -20);
    moray_reference_free(&s.reference);
    CHECK_OK(moray_reference_read(&s.reference, "steps:4.05=20"), "reference");
    test_times(&s, 20);
    test_measured(&s, MORAY_CONTROL_ORIENTED);
    test_measured(&s, MORAY_FIRST_PRINCIPLES);
    test_failures(&s);
    moray_reference_free(&s.reference);
    return tap_done();
}
