// SPDX-License-Identifier: MIT
//
// Receding horizon on the averaged plant, from what the navigator estimates. A plan's offset is `turning` times that of
// the control-oriented model.
#include "moray/snake/navigator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "snake/steer/problems.h"

struct moray_adaptive {
    moray_adaptive_spec spec;
    moray_navigator *navigator;
    moray_receding_horizon *engine;
    const moray_reading *reading;
    double s[MORAY_STEERING_PARAMETERS]; // guess of the next plan
    double turning;                      // of the plan in force
    double value, slope, from;           // the swimmer's offset now: straight lines between two measurements
};

static moray_offset offset_at(double t, const void *self)
{
    const moray_adaptive *a = self;
    return (moray_offset){.value = a->value + a->slope * (t - a->from), .rate = a->slope};
}

// The newest reading, brought from when it was taken to when what is done now acts by what the estimate has moved
// since.
static moray_status navigate(moray_adaptive *a, const moray_swim_sample *sample)
{
    const moray_adaptive_spec *spec = &a->spec;
    double state[MORAY_BODY_STATES];
    MORAY_TRY(moray_navigator_advance(a->navigator, sample->t + spec->dead_time, a->value / spec->scale,
                                      a->slope / spec->scale));
    if (a->reading && !a->reading->fresh)
        return moray_ok();
    const double age = spec->dead_time + (a->reading ? sample->t - a->reading->t : 0);
    moray_navigator_state(a->navigator, state);
    if (a->reading && isfinite(a->reading->rate) && spec->navigator.rate_error > 0)
        MORAY_TRY(moray_navigator_read_rate(a->navigator, a->reading->rate));
    const double c = cos(state[0]), s = sin(state[0]), v_t = state[MORAY_STATE_V_1], v_n = state[MORAY_STATE_V_2];
    return moray_navigator_read(a->navigator,
                                moray_straight_motion_heading(spec->measured, sample->t, sample->pose.heading) +
                                    age * state[MORAY_STATE_V_THETA],
                                sample->pose.p_x + age * (v_t * c - v_n * s),
                                sample->pose.p_y + age * (v_t * s + v_n * c));
}

// The replanner's problem becomes that of the present belief.
static void believe(moray_adaptive *a, const moray_belief *belief)
{
    const moray_adaptive_spec *spec = &a->spec;
    moray_gait gait = spec->navigator.gait;
    moray_steering_limits limits = spec->limits;
    gait.amplitude *= belief->amplitude;
    limits.theta_max = moray_fixed(
        moray_theta_max_from_amplitude(&spec->navigator.robot, MORAY_CONTROL_ORIENTED, gait.amplitude, gait.delta));
    limits.omega = moray_fixed(gait.omega);
    limits.delta = moray_fixed(gait.delta);
    limits.power = limits.offset_acceleration = MORAY_INFINITY;
    limits.offset *= belief->turning;
    limits.offset_rate *= belief->turning;
    moray_steering_parameters(&gait, a->s);
    if (spec->heading) {
        spec->heading->spec.limits = limits;
        memcpy(spec->heading->spec.current, belief->current, sizeof belief->current);
    } else {
        spec->path->spec.limits = limits;
        memcpy(spec->path->spec.current, belief->current, sizeof belief->current);
    }
}

static double within(double value, double limit)
{
    return fmin(fmax(value, -limit), limit);
}

static moray_status plan(moray_adaptive *a, double t)
{
    const moray_belief belief = moray_navigator_belief(a->navigator);
    const moray_steering_limits *limits = a->spec.heading ? &a->spec.heading->spec.limits : &a->spec.path->spec.limits;
    double state[MORAY_STEERING_STATES];
    believe(a, &belief);
    moray_navigator_state(a->navigator, state);
    state[MORAY_STATE_PHI_0] = within(belief.turning * a->value / a->spec.scale, limits->offset);
    state[MORAY_STATE_V_PHI_0] = within(belief.turning * a->slope / a->spec.scale, limits->offset_rate);
    const int before = moray_receding_horizon_record_of(a->engine)->plans;
    MORAY_TRY(moray_receding_horizon_measure(a->engine, t + a->spec.dead_time, state));
    if (moray_receding_horizon_record_of(a->engine)->plans > before)
        a->turning = belief.turning;
    return moray_ok();
}

static moray_status measure(const moray_swim_sample *sample, void *self)
{
    moray_adaptive *a = self;
    const moray_adaptive_spec *spec = &a->spec;
    const double t = sample->t, now = offset_at(t, a).value;
    MORAY_TRY(navigate(a, sample));
    a->value = now;
    a->from = t;
    MORAY_TRY(plan(a, t));
    const moray_solution *in_force = moray_receding_horizon_plan(a->engine);
    const double next =
        in_force ? moray_steering_offset(in_force, t + spec->dead_time + spec->look).value / a->turning : 0;
    const double limit = spec->limits.offset * fabs(spec->scale), rate = spec->limits.offset_rate * fabs(spec->scale);
    a->slope = within((within(spec->scale * next, limit) - now) / spec->look, rate);
    return moray_ok();
}

moray_swim_controller moray_adaptive_controller(moray_adaptive *a)
{
    return (moray_swim_controller){.offset = offset_at, .measure = measure, .period = a->spec.look, .self = a};
}

static moray_status make_engine(moray_adaptive *a)
{
    const moray_adaptive_spec *spec = &a->spec;
    const moray_receding_horizon_spec engine = {.replanner = spec->heading ? moray_heading_replan(spec->heading)
                                                                           : moray_path_replan(spec->path),
                                                .settings = spec->settings,
                                                .horizon = spec->horizon,
                                                .interval = spec->interval,
                                                .watch = spec->look,
                                                .s = a->s};
    return moray_receding_horizon_new(&a->engine, &engine);
}

moray_status moray_adaptive_new(moray_adaptive **result, const moray_adaptive_spec *spec)
{
    *result = NULL;
    if (!spec->heading == !spec->path)
        return moray_error(MORAY_INPUT, "a receding horizon follows a heading or a path: one of the two");
    moray_adaptive *a = calloc(1, sizeof *a);
    if (!a)
        return moray_error(MORAY_MEMORY, "no memory for a receding horizon");
    a->spec = *spec;
    a->turning = spec->navigator.belief.turning;
    moray_steering_parameters(&spec->navigator.gait, a->s);
    moray_status status = moray_navigator_new(&a->navigator, &spec->navigator);
    if (!moray_failed(status))
        status = make_engine(a);
    if (moray_failed(status))
        moray_adaptive_free(a);
    else
        *result = a;
    return status;
}

void moray_adaptive_free(moray_adaptive *adaptive)
{
    if (!adaptive)
        return;
    moray_navigator_free(adaptive->navigator);
    moray_receding_horizon_free(adaptive->engine);
    free(adaptive);
}

void moray_adaptive_look_at(moray_adaptive *adaptive, const moray_reading *reading)
{
    adaptive->reading = reading;
}

const moray_navigator *moray_adaptive_navigator(const moray_adaptive *adaptive)
{
    return adaptive->navigator;
}

const moray_receding_horizon_record *moray_adaptive_record(const moray_adaptive *adaptive)
{
    return moray_receding_horizon_record_of(adaptive->engine);
}
