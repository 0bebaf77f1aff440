// SPDX-License-Identifier: MIT
#include <string.h>

#include "job.h"

static const double look_every = 0.1;             // of a feedback [s]
static const double rough = 1e-6, careful = 1e-8; // tolerances of simulations
static const int periods_after = 6;               // swum behind the last plan
enum { per_second = 20 };

// ---- Controllers
// ---------------------------------------------------------------------------------------------------------

// The offset ramps up to its limit, stays there, goes to the other limit if it brakes, and comes to rest.
typedef struct bang {
    double limit, ramp, hold, brake; // with its sign [m or rad], [s]
} bang;

static moray_offset bang_offset(double t, const void *self)
{
    const bang *b = self;
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

// All that a controller may need, for one trial on one model.
typedef struct steersman {
    bang bang;
    moray_plan plan;
    const moray_straight_motion *planned; // straight of the plan
    moray_feedback feedback;
    moray_controller controller;
} steersman;

static double planned_heading(const moray_swim_sample *sample, void *self)
{
    const steersman *h = self;
    double x[MORAY_STEERING_STATES], t0, tf;
    moray_solution_times(h->plan.solution, 0, &t0, &tf);
    const double t = fmin(sample->t, tf);
    moray_solution_at(h->plan.solution, 0, t, x, NULL);
    return moray_straight_motion_heading(h->planned, t, x[0]);
}

static double planned_offset(const moray_swim_sample *sample, double t, void *self)
{
    const steersman *h = self;
    (void)sample;
    return moray_plan_offset(&h->plan, t).value;
}

static void set_controller(const turn_job *job, const turn_trial *trial, moray_model model, steersman *h)
{
    const moray_steering_limits limits = turn_limits(job, model);
    const double side = job->angle * job->turn_rate[model] < 0 ? -1 : 1;
    *h = (steersman){.bang = {side * limits.offset, limits.offset / limits.offset_rate, trial->hold, trial->brake},
                     .plan = {job->plan[trial->plan].solution, steer_offset_ratio(job->straight, trial->plan, model)},
                     .planned = &job->plan[trial->plan].straight};
    h->feedback =
        (moray_feedback){.target = planned_heading,
                         .feed = planned_offset,
                         .self = h,
                         .gain = trial->gain * steer_offset_ratio(job->straight, MORAY_CONTROL_ORIENTED, model),
                         .straight = &job->straight[model],
                         .offset = limits.offset,
                         .offset_rate = limits.offset_rate,
                         .period = look_every};
    if (trial->law == TURN_PLAN)
        h->controller = moray_plan_controller(&h->plan);
    else if (trial->law == TURN_BOTH)
        h->controller = moray_feedback_controller(&h->feedback);
    else
        h->controller = (moray_controller){.offset = bang_offset, .self = &h->bang};
}

// ---- Swimming ------------------------------------------------------------------------------------------------------

static moray_status swim(const turn_job *job, const turn_trial *trial, moray_model model, double tolerance,
                         moray_closed_loop *closed_loop)
{
    steersman h;
    set_controller(job, trial, model, &h);
    const double period = 2 * M_PI / job->straight[model].gait.omega;
    const double duration = 1.5 * turn_duration(turn_last_plan(job)) + periods_after * period;
    const moray_closed_loop_spec plan = {.robot = &job->common.robot,
                                         .straight = &job->straight[model],
                                         .current = {job->common.current[0], job->common.current[1]},
                                         .controller = &h.controller,
                                         .duration = duration,
                                         .intervals = (int)ceil(per_second * duration),
                                         .tolerance = tolerance};
    return moray_closed_loop_run(closed_loop, &plan);
}

moray_status turn_swim(const turn_job *job, const turn_trial *trial, moray_model model, moray_closed_loop *closed_loop)
{
    return swim(job, trial, model, careful, closed_loop);
}

static turn_score score_of(const turn_job *job, const moray_straight_motion *straight, const moray_swim_track *track)
{
    const int last = track->n - 1;
    const double period = 2 * M_PI / straight->gait.omega, end = track->t[last], step = end / last;
    turn_score score = {.settled = 0, .miss = INFINITY, .power = track->energy[last] / end};
    int n = 0;
    for (int k = 0; k <= last; k++) {
        const moray_pose *pose = &track->pose[k];
        const double t = track->t[k], error = moray_straight_motion_heading(straight, t, pose->heading) - job->angle;
        if (fabs(error) > job->band)
            score.settled = t + step;
        score.unsettled += step * fmin(fabs(error) / job->band, 1);
        score.miss = fmin(score.miss, hypot(pose->p_x - job->end[0], pose->p_y - job->end[1]));
        if (t > end - period) {
            score.final += error;
            n++;
        }
    }
    score.final /= n;
    if (score.settled > end - period)
        score.settled = NAN;
    return score;
}

static moray_status score(const turn_job *job, turn_trial *trial, moray_model model, double tolerance)
{
    moray_closed_loop closed_loop;
    MORAY_TRY(swim(job, trial, model, tolerance, &closed_loop));
    trial->score[model] = score_of(job, &job->straight[model], &closed_loop.track);
    moray_closed_loop_free(&closed_loop);
    return moray_ok();
}

// ---- Tuning --------------------------------------------------------------------------------------------------------

typedef struct tuning {
    const turn_job *job;
    turn_trial *trial;
    moray_status status; // of the last simulation
} tuning;

static int read(turn_trial *trial, const double *x)
{
    if (trial->law == TURN_BOTH) {
        trial->gain = exp(x[0]);
        return 1;
    }
    trial->hold = x[0];
    trial->brake = trial->law == TURN_BRAKE ? x[1] : 0;
    return trial->law == TURN_BRAKE ? 2 : 1;
}

// The time that the heading is not yet where it is to be.
static bool judge(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    tuning *t = self;
    (void)c, (void)gradient, (void)jacobian;
    read(t->trial, x);
    t->status = score(t->job, t->trial, MORAY_FIRST_PRINCIPLES, rough);
    *f = t->trial->score[MORAY_FIRST_PRINCIPLES].unsettled;
    moray_ticker_show(&t->job->ticker, "min_time_turn: tuning %s: %.3f s not settled", t->trial->name, *f);
    return !moray_failed(t->status);
}

static moray_status tune(const turn_job *job, turn_trial *trial, const turn_trial *like)
{
    const double steady = fabs(job->angle / job->turn_rate[MORAY_FIRST_PRINCIPLES]);
    const moray_steering_limits limits = turn_limits(job, MORAY_FIRST_PRINCIPLES);
    const double ramp = limits.offset / limits.offset_rate;
    const bool both = trial->law == TURN_BOTH;
    const double lower[] = {both ? log(0.002) : 0, 0}, upper[] = {both ? log(2) : 2 * steady + 2 * ramp, 4 * ramp};
    double x[] = {both ? log(0.06) : fmax(steady - ramp, 0), 0};
    if (like)
        x[0] = like->hold;
    tuning t = {.job = job, .trial = trial};
    const moray_search_problem problem = {
        .n = read(trial, x), .lower = lower, .upper = upper, .self = &t, .evaluate = judge};
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    settings.method = MORAY_SEARCH_COBYLA;
    settings.x_tolerance = 1e-4;
    settings.f_tolerance = 1e-5;
    settings.max_evaluations = job->evaluations * problem.n;
    settings.progress = steer_go_on;
    const moray_status status = moray_search(&problem, &settings, x, &info);
    MORAY_TRY(steer_interruption());
    if (moray_failed(status))
        return status.code == MORAY_NUMERIC ? t.status : status;
    read(trial, x);
    trial->evaluations = info.evaluations;
    return moray_ok();
}

// ---- All -----------------------------------------------------------------------------------------------------------

static const char *const plan_names[] = {"control-oriented plan", "first-principles plan"};
static const char *const both_names[] = {"control-or. plan + feedback", "first-pr. plan + feedback"};

// Bang-bang steering knows of no position.
static void choose_trials(turn_job *job)
{
    job->trial[job->n_trials++] = (turn_trial){.name = "bang-bang", .law = TURN_BANG};
    job->trial[job->n_trials++] = (turn_trial){.name = "bang-bang, braking", .law = TURN_BRAKE};
    for (int model = 0; model <= (int)job->common.model; model++) {
        const turn_trial blind = {.name = plan_names[model], .law = TURN_PLAN, .plan = (moray_model)model};
        turn_trial both = blind;
        both.name = both_names[model];
        both.law = TURN_BOTH;
        job->trial[job->n_trials++] = blind;
        job->trial[job->n_trials++] = both;
    }
}

moray_status turn_run_trials(turn_job *job)
{
    choose_trials(job);
    for (int k = 0; k < job->n_trials; k++) {
        turn_trial *trial = &job->trial[k];
        if (trial->law != TURN_PLAN)
            MORAY_TRY(tune(job, trial, trial->law == TURN_BRAKE ? &job->trial[k - 1] : NULL));
        for (int model = 0; model < 2; model++) {
            MORAY_TRY(steer_interruption());
            MORAY_TRY(score(job, trial, (moray_model)model, careful));
        }
    }
    return moray_ok();
}
