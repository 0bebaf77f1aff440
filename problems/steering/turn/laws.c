// SPDX-License-Identifier: MIT
#include "turn.h"

static const int periods_after = 6; // swum behind the last plan

// ---- Laws ----------------------------------------------------------------------------------------------------------

const steer_number turn_numbers[TURN_NUMBERS] = {
    [TURN_HOLD] = {"hold_s"}, // their ranges: by the turn
    [TURN_BRAKING] = {"brake_s"},
    [TURN_GAIN] = {"gain_m_rad", .logarithmic = true, .lower = 0.002, .upper = 2},
};

// The offset ramps up to its limit, stays there, goes to the other limit if it brakes, and comes to rest.
static moray_offset bang_offset(double t, const void *self)
{
    const struct steer_bang *b = self;
    const double rate = b->limit / b->ramp, low = b->brake > 0 ? -fmin(b->brake / b->ramp, 1) : 0;
    const double down = b->ramp + b->hold, rest = down + (1 - low) * b->ramp;
    const double up = rest + fmax(b->brake - b->ramp, 0), end = up - low * b->ramp;
    if (t < b->ramp)
        return (moray_offset){.value = rate * t, .rate = rate};
    if (t < down)
        return (moray_offset){.value = b->limit};
    if (t < rest)
        return (moray_offset){.value = b->limit - rate * (t - down), .rate = -rate};
    if (t < up)
        return (moray_offset){.value = low * b->limit};
    if (t < end)
        return (moray_offset){.value = low * b->limit + rate * (t - up), .rate = rate};
    return (moray_offset){0};
}

static moray_status set_bang(steer_steersman *h)
{
    const turn_job *job = (const turn_job *)h->job;
    const moray_steering_limits limits = steer_limits(h->job, h->model);
    const double side = job->angle * h->job->turn_rate[h->model] < 0 ? -1 : 1, *number = h->trial->number;
    h->own.bang = (struct steer_bang){side * limits.offset, limits.offset / limits.offset_rate, number[TURN_HOLD],
                                      number[TURN_BRAKING]};
    h->controller = (moray_controller){.offset = bang_offset, .self = &h->own.bang};
    return moray_ok();
}

const steer_law turn_laws[TURN_LAWS] = {
    [TURN_BANG] = {"bang-bang", .set = set_bang, .tuned = 1 << TURN_HOLD, .start = {0, 0, NAN}, .curve = 1},
    [TURN_BRAKE] = {"bang-bang, braking", .set = set_bang, .tuned = 1 << TURN_HOLD | 1 << TURN_BRAKING,
                    .start = {0, 0, NAN}, .curve = 2},
    [TURN_PLAN] = {"plan", STEER_PLANNED, .start = {NAN, NAN, NAN}, .curve = 3},
    [TURN_BOTH] = {"plan and feedback", STEER_PLANNED, .set = steer_set_both, .tuned = 1 << TURN_GAIN,
                   .start = {NAN, NAN, 0.06}},
};

// Bang-bang steering knows of no position.
void turn_choose_trials(turn_job *job)
{
    steer_job *steer = &job->steer;
    const double steady = fabs(job->angle / steer->turn_rate[MORAY_FIRST_PRINCIPLES]);
    const moray_steering_limits limits = steer_limits(steer, MORAY_FIRST_PRINCIPLES);
    const double ramp = limits.offset / limits.offset_rate;
    steer->number[TURN_HOLD].upper = 2 * steady + 2 * ramp;
    steer->number[TURN_BRAKING].upper = 4 * ramp;
    steer_trial *bang = steer_add(steer, "bang-bang", &turn_laws[TURN_BANG], 0, MORAY_CONTROL_ORIENTED);
    bang->number[TURN_HOLD] = fmax(steady - ramp, 0);
    steer_add(steer, "bang-bang, braking", &turn_laws[TURN_BRAKE], 0, MORAY_CONTROL_ORIENTED)->like = bang;
    steer_add_plans(steer, &turn_laws[TURN_PLAN], &turn_laws[TURN_BOTH]);
}

// ---- Swimming ------------------------------------------------------------------------------------------------------

void turn_start(steer_steersman *h, moray_closed_loop_spec *spec)
{
    const double period = 2 * M_PI / h->job->straight[0][h->model].gait.omega;
    spec->duration = 1.5 * steer_duration(steer_last_plan(h->job)->solution) + periods_after * period;
}

double turn_judge(const steer_trial *trial, const steer_steersman *h, const moray_closed_loop *closed_loop,
                  double *score)
{
    const turn_job *job = (const turn_job *)h->job;
    const moray_straight_motion *straight = &h->job->straight[trial->gait][h->model];
    const moray_swim_track *track = &closed_loop->track;
    const int last = track->n - 1;
    const double period = 2 * M_PI / straight->gait.omega, end = track->t[last], step = end / last;
    double settled = 0, weighted = 0, final = 0, miss = INFINITY;
    int n = 0;
    for (int k = 0; k <= last; k++) {
        const moray_pose *pose = &track->pose[k];
        const double t = track->t[k], error = moray_straight_motion_heading(straight, t, pose->heading) - job->angle;
        if (fabs(error) > job->band)
            settled = t + step;
        weighted += step * fmin(fabs(error) / job->band, 1);
        miss = fmin(miss, hypot(pose->p_x - job->end[0], pose->p_y - job->end[1]));
        if (t > end - period) {
            final += error;
            n++;
        }
    }
    score[TURN_SETTLED] = settled > end - period ? NAN : settled;
    score[TURN_WEIGHTED] = weighted;
    score[TURN_FINAL] = final / n;
    score[TURN_MISS] = turn_to_position(job) ? miss : NAN;
    score[TURN_POWER] = track->energy[last] / end;
    return weighted;
}
