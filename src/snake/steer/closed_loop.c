// SPDX-License-Identifier: MIT
#include "moray/snake/closed_loop.h"
#include "snake/steer/problems.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct recorder {
    moray_swim_closed_loop *closed_loop;
    const moray_swim_closed_loop_spec *plan;
};

static bool record(const moray_swim_sample *sample, void *self)
{
    const struct recorder *recorder = self;
    const moray_swim_closed_loop_spec *plan = recorder->plan;
    const moray_swim_controller *controller = plan->controller;
    moray_swim_closed_loop *closed_loop = recorder->closed_loop;
    closed_loop->offset[closed_loop->track.n] = controller ? controller->offset(sample->t, controller->self).value : 0;
    return moray_swim_track_add(sample, &closed_loop->track) &&
           (!plan->observe || plan->observe(sample, plan->observer));
}

// The joints begin on the gait, with the offset that the controller begins with.
static void start(const moray_swim_closed_loop_spec *plan, const moray_swimmer *swimmer, double *x)
{
    double state[MORAY_STEERING_STATES];
    moray_gait gait = plan->straight->gait;
    double V[2];
    moray_steering_current(plan->water, plan->current, plan->position[0], plan->position[1], 0, V);
    moray_straight_motion_start(plan->straight, plan->heading, V, state);
    memcpy(state + MORAY_STATE_P_X, plan->position, sizeof plan->position);
    if (plan->controller) {
        const moray_offset offset = plan->controller->offset(0, plan->controller->self);
        gait.offset = offset.value;
        gait.offset_rate = offset.rate;
    }
    moray_swimmer_on_gait(swimmer, &gait, 0, state, x);
}

static moray_status sail(moray_swim_closed_loop *closed_loop, const moray_swim_closed_loop_spec *plan, double *times,
                         double *x)
{
    const int n = plan->intervals + 1;
    struct recorder recorder = {closed_loop, plan};
    const moray_gait_change change = {0, plan->straight->gait};
    moray_sim_settings settings = moray_sim_settings_default();
    const moray_swim_plan swim = {.t1 = plan->duration,
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .controller = plan->controller,
                                  .times = times,
                                  .n_times = n,
                                  .current_turning = plan->current_turning,
                                  .water = plan->water,
                                  .observe = record,
                                  .observer = &recorder};
    settings.rtol = settings.atol = plan->tolerance;
    for (int k = 0; k < n; k++)
        times[k] = fmin(plan->duration * k / plan->intervals, plan->duration); // not beyond by rounding
    start(plan, closed_loop->swimmer, x);
    if (plan->on_gait)
        return moray_swim_run_on_gait(closed_loop->swimmer, &swim, plan->on_gait, x, NULL);
    return moray_swim_run(closed_loop->swimmer, &settings, &swim, x, NULL);
}

moray_status moray_swim_closed_loop_run(moray_swim_closed_loop *closed_loop, const moray_swim_closed_loop_spec *plan)
{
    const int n = plan->intervals + 1, states = 2 * plan->robot->links + 4;
    double *scratch = calloc((size_t)(n + states), sizeof *scratch);
    *closed_loop = (moray_swim_closed_loop){.offset = calloc((size_t)n, sizeof *closed_loop->offset)};
    moray_status status =
        scratch && closed_loop->offset ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for a closed_loop");
    if (!moray_failed(status))
        status = moray_swimmer_new(&closed_loop->swimmer, plan->robot, plan->straight->model);
    if (!moray_failed(status))
        status = moray_swimmer_set_torque(closed_loop->swimmer, plan->torque);
    if (!moray_failed(status))
        status = moray_swim_track_new(&closed_loop->track, closed_loop->swimmer, n);
    if (!moray_failed(status)) {
        moray_swimmer_set_current(closed_loop->swimmer, plan->current[0], plan->current[1]);
        status = sail(closed_loop, plan, scratch, scratch + n);
    }
    free(scratch);
    if (moray_failed(status))
        moray_swim_closed_loop_free(closed_loop);
    return status;
}

void moray_swim_closed_loop_free(moray_swim_closed_loop *closed_loop)
{
    moray_swimmer_free(closed_loop->swimmer);
    moray_swim_track_free(&closed_loop->track);
    free(closed_loop->offset);
    *closed_loop = (moray_swim_closed_loop){0};
}

moray_heading_score moray_swim_closed_loop_heading_score(const moray_swim_closed_loop *closed_loop,
                                                         const moray_straight_motion *straight,
                                                         const moray_reference *reference)
{
    const moray_swim_track *track = &closed_loop->track;
    const int last = track->n - 1;
    moray_heading_score score = {.power = track->energy[last] / track->t[last]};
    double rate, before = 0; // error just after the sample before
    for (int k = 0; k <= last; k++) {
        const double t = track->t[k], heading = moray_straight_motion_heading(straight, t, track->pose[k].heading);
        const double error = heading - moray_reference_at(reference, t, &rate);
        if (k > 0) // of a straight line from the one to the other
            score.rms += (before * before + before * error + error * error) / (3 * last);
        before = heading - moray_reference_at(reference, nextafter(t, INFINITY), &rate);
        score.largest = fmax(score.largest, fmax(fabs(error), k < last ? fabs(before) : 0));
        score.final = error;
    }
    score.rms = sqrt(score.rms);
    return score;
}

moray_path_score moray_swim_closed_loop_path_score(const moray_swim_closed_loop *closed_loop, const moray_path *path,
                                                   double reach)
{
    const moray_swim_track *track = &closed_loop->track;
    moray_path_score score = {.time = NAN};
    double along = 0, across, first = NAN, before = NAN;
    int k = 0, settled = 0;
    for (; k < track->n && isnan(score.time); k++) {
        moray_path_project(path, track->pose[k].p_x, track->pose[k].p_y, &along, &across);
        if (k == 0)
            first = along;
        score.rms += across * across;
        if (along > first + reach) {
            score.settled_rms += across * across;
            score.settled_largest = fmax(score.settled_largest, fabs(across));
            settled++;
        }
        if (along >= path->length && k > 0)
            score.time = track->t[k] - (track->t[k] - track->t[k - 1]) * (along - path->length) / (along - before);
        before = along;
    }
    score.rms = sqrt(score.rms / k);
    score.settled_rms = sqrt(score.settled_rms / settled);
    score.power = track->energy[k - 1] / track->t[k - 1];
    return score;
}
