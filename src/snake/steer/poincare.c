// SPDX-License-Identifier: MIT
#include "moray/snake/poincare.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "moray/dense.h"
#include "snake/steer/problems.h"

enum { n = MORAY_POINCARE_STATES, OFFSET = n - 1 };
static const int place[OFFSET] = {MORAY_STATE_THETA, MORAY_STATE_P_Y, MORAY_STATE_V_THETA, MORAY_STATE_V_1,
                                  MORAY_STATE_V_2}; // of the body's states

typedef struct strobe {
    const moray_poincare_spec *spec;
    moray_swimmer *swimmer;
    moray_feedback feedback;
    double *x;
} strobe;

static double target(const moray_swim_sample *sample, void *self)
{
    const moray_poincare_spec *spec = self;
    return spec->lookahead > 0 ? -atan(sample->pose.p_y / spec->lookahead) : 0;
}

// One period of the gait from y[n].
static moray_status turn_round(strobe *s, double y[n])
{
    const moray_poincare_spec *spec = s->spec;
    const moray_straight_motion *straight = spec->straight;
    const double period = 2 * M_PI / straight->gait.omega, far = 1e6;
    const moray_gait_change change = {0, straight->gait};
    const moray_swim_on_gait how = {.steps = 64};
    double body[MORAY_BODY_STATES] = {0};
    moray_gait gait = straight->gait;
    for (int i = 0; i < OFFSET; i++)
        body[place[i]] = y[i];
    gait.offset = y[OFFSET];
    s->feedback = (moray_feedback){.target = target,
                                   .self = (void *)(uintptr_t)spec,
                                   .gain = spec->gain,
                                   .straight = straight,
                                   .offset = far,
                                   .offset_rate = far,
                                   .period = period / spec->looks,
                                   .value = y[OFFSET]};
    const moray_swim_controller controller = moray_feedback_controller(&s->feedback);
    const moray_swim_plan plan = {.t1 = period * (1 - 1e-9), // before the first look of the next
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .controller = spec->gain != 0 ? &controller : NULL};
    moray_swimmer_on_gait(s->swimmer, &gait, 0, body, s->x);
    MORAY_TRY(moray_swim_run_on_gait(s->swimmer, &plan, &how, s->x, NULL));
    moray_state_body(straight->model, spec->robot->links, s->x, body);
    for (int i = 0; i < OFFSET; i++)
        y[i] = body[place[i]];
    y[OFFSET] = spec->gain != 0 ? controller.offset(period, controller.self).value : 0;
    return moray_ok();
}

// The motion that the map comes to.
static moray_status settle(strobe *s, double y[n])
{
    const int most = 400;
    const double close = 1e-9, still[2] = {0, 0};
    double state[MORAY_STEERING_STATES], change = INFINITY;
    moray_straight_motion_start(s->spec->straight, 0, still, state);
    for (int i = 0; i < OFFSET; i++)
        y[i] = state[place[i]];
    y[OFFSET] = 0;
    for (int k = 0; k < most && change > close; k++) {
        double before[n];
        memcpy(before, y, sizeof before);
        MORAY_TRY(turn_round(s, y));
        change = 0;
        for (int i = 0; i < n; i++)
            change = fmax(change, i == 1 && s->spec->lookahead == 0 ? 0 : fabs(y[i] - before[i]));
        if (s->spec->gain == 0)
            return moray_ok(); // swims straight on
    }
    if (!(change <= close))
        return moray_error(MORAY_NOT_SOLVED, "with a gain of %g the motion does not come back to itself: %.2g a period",
                           s->spec->gain, change);
    return moray_ok();
}

static moray_status find(strobe *s, moray_num multiplier[n])
{
    const double step = 1e-6;
    double middle[n], A[n * n];
    MORAY_TRY(settle(s, middle));
    for (int j = 0; j < n; j++) {
        double up[n], down[n];
        memcpy(up, middle, sizeof up);
        memcpy(down, middle, sizeof down);
        up[j] += step;
        down[j] -= step;
        MORAY_TRY(turn_round(s, up));
        MORAY_TRY(turn_round(s, down));
        for (int i = 0; i < n; i++)
            A[i * n + j] = (up[i] - down[i]) / (2 * step);
    }
    if (s->spec->gain == 0)
        for (int i = 0; i < n; i++)
            A[i * n + OFFSET] = 0; // which is no state then
    return moray_eigenvalues(n, A, multiplier);
}

moray_status moray_poincare_multipliers(const moray_poincare_spec *spec, moray_num multiplier[n])
{
    strobe s = {.spec = spec};
    if (spec->looks < 8 || !(spec->lookahead >= 0))
        return moray_error(MORAY_INPUT, "looks = %d, lookahead = %g m: must be at least 8, and 0", spec->looks,
                           spec->lookahead);
    MORAY_TRY(moray_swimmer_new(&s.swimmer, spec->robot, spec->straight->model));
    s.x = calloc((size_t)moray_swimmer_states(s.swimmer), sizeof *s.x);
    const moray_status status =
        s.x ? find(&s, multiplier) : moray_error(MORAY_MEMORY, "no memory for a stroboscopic map");
    free(s.x);
    moray_swimmer_free(s.swimmer);
    return status;
}
