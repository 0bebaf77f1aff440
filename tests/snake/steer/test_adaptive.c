// SPDX-License-Identifier: MIT
//
// The receding horizon on the navigator's estimate, look by look, against its parts put together by hand: what is read
// when, what is planned from, and the offset that comes of it within its limits.
#include "degree.h"
#include "reference_text.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/navigator.h"
#include "moray/snake/trial.h"
#include "snake/steer/problems.h"

enum { states = MORAY_STEERING_STATES, LOOKS = 7 };

static const double scale = -1.7, dead_time = 0.2, look_every = 0.25, horizon = 5, limit = 0.015, rate_limit = 0.01;

typedef struct way {
    moray_reference reference;
    moray_path path;
    moray_heading_replanner heading;
    moray_path_replanner along;
} way;

static void way_new(way *w, const moray_robot *robot)
{
    CHECK_OK(moray_reference_read(&w->reference, "ramps:0=0,1=70"), "reference");
    CHECK_OK(moray_path_read(&w->path, "0,-0.5 9,-0.5", 1), "path");
    w->heading = (moray_heading_replanner){.spec = {.robot = *robot,
                                                    .averaged = true,
                                                    .weight = {30, 0, 0.003},
                                                    .reference = &w->reference,
                                                    .max_error = MORAY_INFINITY},
                                           .horizon = horizon,
                                           .preview = true};
    w->along = (moray_path_replanner){.spec = {.robot = *robot,
                                               .averaged = true,
                                               .weight = {1, 0.01, 0.003},
                                               .path = &w->path,
                                               .tube = MORAY_INFINITY,
                                               .reach = 2,
                                               .speed = 0.2},
                                      .horizon = horizon};
}

static void way_free(way *w)
{
    moray_reference_free(&w->reference);
    moray_path_free(&w->path);
}

static moray_settings settings_of(void)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = "radau3";
    settings.intervals = 4;
    settings.tolerance = 1e-6;
    return settings;
}

// ---- Its parts -----------------------------------------------------------------------------------------------------

typedef struct parts {
    way own;
    bool on_path;
    const moray_adaptive_spec *spec;
    moray_navigator *navigator;
    moray_receding_horizon *engine;
    double s[MORAY_STEERING_PARAMETERS];
    double turning, value, slope, from;
    int plans;
} parts;

static void parts_new(parts *p, const moray_adaptive_spec *spec, bool on_path)
{
    *p = (parts){.on_path = on_path, .spec = spec, .turning = spec->navigator.belief.turning};
    way_new(&p->own, &spec->navigator.robot);
    CHECK_OK(moray_navigator_new(&p->navigator, &spec->navigator), "navigator");
    const moray_receding_horizon_spec engine = {.replanner = on_path ? moray_path_replan(&p->own.along)
                                                                     : moray_heading_replan(&p->own.heading),
                                                .settings = spec->settings,
                                                .horizon = horizon,
                                                .interval = spec->interval,
                                                .watch = look_every,
                                                .s = p->s};
    CHECK_OK(moray_receding_horizon_new(&p->engine, &engine), "receding horizon");
}

static void parts_free(parts *p)
{
    moray_navigator_free(p->navigator);
    moray_receding_horizon_free(p->engine);
    way_free(&p->own);
}

static double within(double value, double most)
{
    return value > most ? most : value < -most ? -most : value;
}

// A reading is of its own time; what is done now acts a dead time later.
static void navigate(parts *p, double t, const moray_pose *pose, const moray_reading *reading)
{
    double state[MORAY_BODY_STATES];
    CHECK_OK(moray_navigator_advance(p->navigator, t + dead_time, p->value / scale, p->slope / scale), "advanced");
    if (reading && !reading->fresh)
        return;
    const double age = reading ? t + dead_time - reading->t : dead_time;
    const double *factor = p->spec->measured->undulation, phase = p->spec->measured->gait.omega * t;
    const double heading = pose->heading - factor[0] * cos(phase) - factor[1] * sin(phase);
    moray_navigator_state(p->navigator, state);
    if (reading && isfinite(reading->rate) && p->spec->navigator.rate_error > 0)
        CHECK_OK(moray_navigator_read_rate(p->navigator, reading->rate), "rate");
    const double c = cos(state[MORAY_STATE_THETA]), s = sin(state[MORAY_STATE_THETA]);
    CHECK_OK(moray_navigator_read(p->navigator, heading + age * state[MORAY_STATE_V_THETA],
                                  pose->p_x + age * (c * state[MORAY_STATE_V_1] - s * state[MORAY_STATE_V_2]),
                                  pose->p_y + age * (s * state[MORAY_STATE_V_1] + c * state[MORAY_STATE_V_2])),
             "read");
}

// The gait as it is believed to swim, in the current that there is believed to be.
static void believe(parts *p, const moray_belief *belief)
{
    const moray_navigator_spec *told = &p->spec->navigator;
    const double amplitude = told->gait.amplitude * belief->amplitude;
    const moray_steering_limits limits = {.theta_max = moray_fixed(moray_theta_max_from_amplitude(
                                              &told->robot, MORAY_CONTROL_ORIENTED, amplitude, told->gait.delta)),
                                          .omega = moray_fixed(told->gait.omega),
                                          .delta = moray_fixed(told->gait.delta),
                                          .offset = limit * belief->turning,
                                          .offset_rate = rate_limit * belief->turning,
                                          .offset_acceleration = MORAY_INFINITY,
                                          .power = MORAY_INFINITY};
    p->own.heading.spec.limits = p->own.along.spec.limits = limits;
    memcpy(p->own.heading.spec.current, belief->current, sizeof belief->current);
    memcpy(p->own.along.spec.current, belief->current, sizeof belief->current);
    p->s[MORAY_STEERING_AMPLITUDE] = amplitude;
    p->s[MORAY_STEERING_OMEGA] = told->gait.omega;
    p->s[MORAY_STEERING_DELTA] = told->gait.delta;
}

static void look(parts *p, double t, const moray_pose *pose, const moray_reading *reading)
{
    const double now = p->value + p->slope * (t - p->from);
    double state[states];
    navigate(p, t, pose, reading);
    const moray_belief belief = moray_navigator_belief(p->navigator);
    believe(p, &belief);
    moray_navigator_state(p->navigator, state);
    state[MORAY_STATE_PHI_0] = within(belief.turning * now / scale, limit * belief.turning);
    state[MORAY_STATE_V_PHI_0] = within(belief.turning * p->slope / scale, rate_limit * belief.turning);
    p->value = now;
    p->from = t;
    CHECK_OK(moray_receding_horizon_measure(p->engine, t + dead_time, state), "planned");
    const int plans = moray_receding_horizon_record_of(p->engine)->plans;
    if (plans > p->plans)
        p->turning = belief.turning;
    p->plans = plans;
    const moray_solution *plan = moray_receding_horizon_plan(p->engine);
    const double next = moray_steering_offset(plan, t + dead_time + look_every).value / p->turning;
    p->slope = within((within(scale * next, 1.7 * limit) - now) / look_every, 1.7 * rate_limit);
}

// ---- Together ------------------------------------------------------------------------------------------------------

static moray_adaptive_spec spec_of(const moray_straight_motion *measured, double rate_error)
{
    moray_adaptive_spec spec = {.navigator = {.robot = moray_robot_paper(),
                                              .speed = 0.2,
                                              .belief = {1.1, 0.8, {0.03, -0.02}},
                                              .current_doubt = 0.1,
                                              .factor_doubt = 0.2,
                                              .heading_error = 1 * DEG,
                                              .position_error = 0.03,
                                              .rate_error = rate_error},
                                .measured = measured,
                                .scale = scale,
                                .limits = {.offset = limit, .offset_rate = rate_limit},
                                .settings = settings_of(),
                                .dead_time = dead_time,
                                .horizon = horizon,
                                .interval = 2 * look_every,
                                .look = look_every};
    spec.navigator.gait = moray_gait_paper(&spec.navigator.robot);
    return spec;
}

static double difference(const moray_adaptive *adaptive, const parts *p)
{
    double a[MORAY_BODY_STATES], b[MORAY_BODY_STATES], worst = 0;
    moray_navigator_state(moray_adaptive_navigator(adaptive), a);
    moray_navigator_state(p->navigator, b);
    for (int i = 0; i < MORAY_BODY_STATES; i++)
        worst = tap_worse(worst, fabs(a[i] - b[i]));
    return worst;
}

// Without readings told of every sample is fresh; with them some are older, some seen before, some without a rate.
static void test_looks(bool on_path, bool readings, double rate_error)
{
    const moray_straight_motion measured = {.gait = {.omega = 2.1}, .undulation = {0.03, -0.02}};
    moray_adaptive_spec spec = spec_of(&measured, rate_error);
    way theirs;
    parts p;
    moray_adaptive *adaptive;
    moray_reading reading = {0};
    double off = 0, estimate = 0, largest = 0, fastest = 0;
    way_new(&theirs, &spec.navigator.robot);
    *(on_path ? (void **)&spec.path : (void **)&spec.heading) = on_path ? (void *)&theirs.along : &theirs.heading;
    parts_new(&p, &spec, on_path);
    CHECK_OK(moray_adaptive_new(&adaptive, &spec), "adaptive");
    moray_adaptive_look_at(adaptive, readings ? &reading : NULL);
    const moray_swim_controller controller = moray_adaptive_controller(adaptive);
    CHECK(controller.period == look_every, "looks every %g s", controller.period);
    for (int k = 0; k < LOOKS; k++) {
        const double t = k * look_every;
        const moray_swim_sample sample = {
            .t = t, .pose = {.heading = 0.2 * t * t + 0.04, .p_x = 0.23 * t - 0.01, .p_y = 0.02 - 0.05 * t}};
        reading = (moray_reading){.t = t - 0.1, .fresh = k % 3 != 1, .rate = k % 2 ? NAN : 0.3 * t};
        CHECK_OK(controller.measure(&sample, controller.self), "measured");
        look(&p, t, &sample.pose, readings ? &reading : NULL);
        for (int i = 0; i <= 2; i++) {
            const double at = t + 0.1 * i;
            const moray_offset offset = controller.offset(at, controller.self);
            off = tap_worse(off, fabs(offset.value - p.value - p.slope * (at - p.from)));
            off = tap_worse(off, fabs(offset.rate - p.slope));
            largest = fmax(largest, fabs(offset.value));
            fastest = fmax(fastest, fabs(offset.rate));
        }
        estimate = tap_worse(estimate, difference(adaptive, &p));
    }
    CHECK_NEAR(off, 0, 1e-12, "offsets");
    CHECK_NEAR(estimate, 0, 1e-12, "estimates");
    CHECK(largest > 1e-3, "an offset of up to %.3g", largest);
    CHECK_NEAR(fastest, 1.7 * rate_limit, 1e-12, "as fast as it can");
    CHECK(moray_adaptive_record(adaptive)->plans == p.plans && p.plans == (LOOKS + 1) / 2, "%d plans", p.plans);
    moray_adaptive_free(adaptive);
    parts_free(&p);
    way_free(&theirs);
}

static void test_refused(void)
{
    const moray_straight_motion measured = {.gait = {.omega = 2.1}};
    moray_adaptive_spec spec = spec_of(&measured, 0);
    way both;
    char taken;
    moray_adaptive *adaptive = (void *)&taken;
    way_new(&both, &spec.navigator.robot);
    spec.heading = &both.heading;
    spec.path = &both.along;
    moray_status status = moray_adaptive_new(&adaptive, &spec);
    CHECK(status.code == MORAY_INPUT && !adaptive &&
              strcmp(status.text, "a receding horizon follows a heading or a path: one of the two") == 0,
          "%s", status.text);
    spec.path = NULL;
    spec.navigator.heading_error = 0;
    CHECK(moray_adaptive_new(&adaptive, &spec).code == MORAY_INPUT && !adaptive, "what the navigator refuses");
    spec.navigator.heading_error = 1;
    spec.interval = -1;
    CHECK(moray_adaptive_new(&adaptive, &spec).code == MORAY_INPUT && !adaptive, "and the receding horizon");
    moray_adaptive_free(NULL);
    way_free(&both);
}

int main(void)
{
    test_looks(false, false, 0);
    test_looks(false, true, 0.5 * DEG);
    test_looks(false, true, 0);
    test_looks(true, true, 0.5 * DEG);
    test_refused();
    return tap_done();
}
