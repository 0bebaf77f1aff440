// SPDX-License-Identifier: MIT
#include "moray/snake/receding_horizon.h"
#include "snake/steer/problems.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { states = MORAY_STEERING_STATES };

struct moray_swim_receding_horizon {
    moray_swim_receding_horizon_spec spec;
    double s[MORAY_STEERING_PARAMETERS]; // the gait's
    moray_receding_horizon *engine;
};

// ---- From the swimmer to the plan ----------------------------------------------------------------------------------

static moray_offset offset_at(double t, const void *self)
{
    const moray_swim_receding_horizon *r = self;
    const moray_solution *plan = moray_receding_horizon_plan(r->engine);
    return plan ? moray_plan_offset(&(moray_plan){plan, r->spec.scale}, t) : (moray_offset){0};
}

// Undulation of the heading and its rate at t.
static void undulation(const moray_straight_motion *straight, double t, double *angle, double *rate)
{
    const double omega = straight->gait.omega, c = cos(omega * t), s = sin(omega * t), *factor = straight->undulation;
    *angle = factor[0] * c + factor[1] * s;
    *rate = omega * (factor[1] * c - factor[0] * s);
}

// The state that a plan starts from: the measured one, with the undulation that the plan's model has in place of that
// of the swimmer's, and the offset as it is.
static void state_of(const moray_swim_receding_horizon *r, const moray_swim_sample *sample, double state[states])
{
    const moray_straight_motion *from = r->spec.measured, *to = r->spec.planned;
    const moray_offset offset = offset_at(sample->t, r);
    moray_state_body(from->model, r->spec.links, sample->x, state);
    if (from->model != to->model) {
        double angle[2], rate[2];
        undulation(from, sample->t, &angle[0], &rate[0]);
        undulation(to, sample->t, &angle[1], &rate[1]);
        state[MORAY_STATE_THETA] += angle[1] - angle[0];
        state[MORAY_STATE_V_THETA] += rate[1] - rate[0];
        const double turn = to->model == MORAY_FIRST_PRINCIPLES ? state[MORAY_STATE_THETA] : -state[0],
                     v[2] = {state[MORAY_STATE_V_1], state[MORAY_STATE_V_2]};
        state[MORAY_STATE_V_1] = v[0] * cos(turn) - v[1] * sin(turn);
        state[MORAY_STATE_V_2] = v[0] * sin(turn) + v[1] * cos(turn);
    }
    state[MORAY_STATE_PHI_0] = offset.value / r->spec.scale;
    state[MORAY_STATE_V_PHI_0] = offset.rate / r->spec.scale;
    const moray_steering_limits *limits = r->spec.limits; // kept to rounding only
    state[MORAY_STATE_PHI_0] = fmin(fmax(state[MORAY_STATE_PHI_0], -limits->offset), limits->offset);
    state[MORAY_STATE_V_PHI_0] = fmin(fmax(state[MORAY_STATE_V_PHI_0], -limits->offset_rate), limits->offset_rate);
}

static moray_status measure(const moray_swim_sample *sample, void *self)
{
    moray_swim_receding_horizon *r = self;
    double state[states];
    state_of(r, sample, state);
    return moray_receding_horizon_measure(r->engine, sample->t, state);
}

moray_swim_controller moray_swim_receding_horizon_controller(moray_swim_receding_horizon *receding)
{
    const double period = moray_receding_horizon_controller(receding->engine).period;
    return (moray_swim_controller){.offset = offset_at, .measure = measure, .period = period, .self = receding};
}

// ---- Handling ------------------------------------------------------------------------------------------------------

static moray_status make_engine(moray_swim_receding_horizon *r)
{
    const moray_swim_receding_horizon_spec *spec = &r->spec;
    const moray_replanner *replanner = &spec->replanner;
    if (replanner->nx != states || replanner->nu < 1 || replanner->ns != MORAY_STEERING_PARAMETERS)
        return moray_error(MORAY_INPUT,
                           "plans of %d states, %d controls, %d parameters: steering has %d, at least 1, and %d",
                           replanner->nx, replanner->nu, replanner->ns, states, MORAY_STEERING_PARAMETERS);
    moray_steering_parameters(&spec->planned->gait, r->s);
    const moray_receding_horizon_spec engine = {.replanner = *replanner,
                                                .settings = spec->settings,
                                                .horizon = spec->horizon,
                                                .interval = spec->interval,
                                                .watch = spec->watch,
                                                .s = r->s,
                                                .first = spec->first};
    return moray_receding_horizon_new(&r->engine, &engine);
}

moray_status moray_swim_receding_horizon_new(moray_swim_receding_horizon **result,
                                             const moray_swim_receding_horizon_spec *spec)
{
    *result = NULL;
    moray_swim_receding_horizon *r = calloc(1, sizeof *r);
    if (!r)
        return moray_error(MORAY_MEMORY, "no memory for a receding horizon");
    r->spec = *spec;
    const moray_status status = make_engine(r);
    if (moray_failed(status))
        moray_swim_receding_horizon_free(r);
    else
        *result = r;
    return status;
}

void moray_swim_receding_horizon_free(moray_swim_receding_horizon *receding)
{
    if (!receding)
        return;
    moray_receding_horizon_free(receding->engine);
    free(receding);
}

const moray_receding_horizon *moray_swim_receding_horizon_engine(const moray_swim_receding_horizon *receding)
{
    return receding->engine;
}

// ---- Heading tracking ----------------------------------------------------------------------------------------------

static moray_status make_heading(void *self, double t, const double *state, void **problem, const moray_ocp **ocp)
{
    moray_heading_replanner *r = self;
    moray_heading_spec spec = r->spec;
    double rate;
    moray_steering_problem *heading = calloc(1, sizeof *heading);
    if (!heading)
        return moray_error(MORAY_MEMORY, "no memory for a plan");
    memcpy(spec.start, state, sizeof spec.start);
    spec.t0 = t;
    spec.t1 = t + r->horizon;
    if (!r->preview) {
        r->held = (moray_reference){.n = 1, .time = &r->held_time, .heading = &r->held_heading};
        r->held_time = t;
        r->held_heading = moray_reference_at(r->spec.reference, nextafter(t, INFINITY), &rate);
        spec.reference = &r->held;
    }
    const moray_status status = moray_heading_new(heading, &spec);
    if (moray_failed(status)) {
        free(heading);
        return status;
    }
    *problem = heading;
    *ocp = moray_steering_ocp(heading->steering);
    return status;
}

static bool heading_changed(const void *self, double t)
{
    const moray_heading_replanner *r = self;
    double rate;
    const double heading = moray_reference_at(r->spec.reference, nextafter(t, INFINITY), &rate);
    return fabs(heading - r->held_heading) > r->tolerance;
}

static void free_heading(void *problem)
{
    moray_steering_problem_free(problem);
    free(problem);
}

moray_replanner moray_heading_replan(moray_heading_replanner *replanner)
{
    return (moray_replanner){.nx = states,
                             .nu = 1,
                             .ns = MORAY_STEERING_PARAMETERS,
                             .make = make_heading,
                             .free = free_heading,
                             .changed = replanner->preview ? NULL : heading_changed,
                             .self = replanner};
}
