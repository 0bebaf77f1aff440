// SPDX-License-Identifier: MIT
//
// A trial swims on both models, its numbers tuned on the first-principles one.
#include "trials.h"

#include <string.h>

#include "moray/parallel.h"

static const steer_accuracy careful = {.tolerance = 1e-8, .per_second = 20, .timed = true};
static const steer_accuracy drawn = {.tolerance = 1e-8, .per_second = 20};

// ---- Swimming ------------------------------------------------------------------------------------------------------

static moray_status set_controller(steer_steersman *h)
{
    const steer_trial *trial = h->trial;
    const moray_steering_plan *plan = &h->job->plan[trial->plan];
    h->plan = (moray_plan){plan->solution, steer_offset_ratio(h->job, trial->gait, trial->plan, h->model)};
    h->planned = &plan->straight;
    if (trial->law->set)
        return trial->law->set(h);
    h->controller = moray_plan_controller(&h->plan);
    return moray_ok();
}

// A program's own observer, and the clock.
typedef struct watch {
    moray_swim_observer *observe;
    void *observer;
    const steer_clock *clock;
    bool late;
} watch;

static bool look_on(const moray_swim_sample *sample, void *self)
{
    watch *w = self;
    w->late = steer_clock_up(w->clock);
    return !w->late && !moray_interrupted() && (!w->observe || w->observe(sample, w->observer));
}

// The steersman's receding horizon must be freed, after an error too. Error: MORAY_NOT_SOLVED where the clock ended it.
static moray_status swim(steer_steersman *h, steer_accuracy how, moray_swim_closed_loop *closed_loop)
{
    const steer_job *job = h->job;
    MORAY_TRY(set_controller(h));
    moray_swim_closed_loop_spec spec = {.robot = &job->snake.robot,
                                        .straight = &job->straight[h->trial->gait][h->model],
                                        .current = {job->snake.current[0], job->snake.current[1]},
                                        .water = job->water,
                                        .controller = &h->controller,
                                        .tolerance = how.tolerance,
                                        .on_gait = how.on_gait};
    job->program->start(h, &spec);
    spec.intervals = (int)ceil(how.per_second * spec.duration);
    watch w = {spec.observe, spec.observer, &job->clock, false};
    if (how.timed) {
        spec.observe = look_on;
        spec.observer = &w;
    }
    MORAY_TRY(moray_swim_closed_loop_run(closed_loop, &spec));
    if (!w.late)
        return moray_ok();
    moray_swim_closed_loop_free(closed_loop);
    return moray_error(MORAY_NOT_SOLVED, "%s: not swum in the time given", h->trial->name);
}

moray_status steer_swim(const steer_job *job, const steer_trial *trial, moray_swim_closed_loop *closed_loop)
{
    steer_steersman h = {.job = job, .trial = trial, .model = MORAY_FIRST_PRINCIPLES};
    const moray_status status = swim(&h, drawn, closed_loop);
    moray_swim_receding_horizon_free(h.receding);
    return status;
}

moray_status steer_try(const steer_job *job, steer_trial *trial, moray_model model, steer_accuracy how)
{
    steer_steersman h = {.job = job, .trial = trial, .model = model};
    moray_swim_closed_loop closed_loop = {0};
    const moray_status status = swim(&h, how, &closed_loop);
    if (!moray_failed(status))
        trial->cost[model] = job->program->judge(trial, &h, &closed_loop, trial->score[model]);
    if (h.receding)
        trial->record[model] = *moray_receding_horizon_record_of(moray_swim_receding_horizon_engine(h.receding));
    moray_swim_receding_horizon_free(h.receding);
    moray_swim_closed_loop_free(&closed_loop);
    return status;
}

// ---- All -----------------------------------------------------------------------------------------------------------

// For another process, or for another time.
static bool elsewhere(const steer_job *job, const steer_trial *trial)
{
    return trial->away || job->left_out >> (trial - job->trial) & 1;
}

bool steer_can_run(const steer_job *job, const steer_trial *trial)
{
    bool here = !elsewhere(job, trial);
    for (int i = 0; i < STEER_SUBSETS; i++)
        here = here && !(trial->subset[i] && trial->subset[i]->away);
    const bool gait_known = job->straight[trial->gait][0].speed > 0;
    const bool plan_known = trial->law->kind == STEER_UNPLANNED || job->plan[trial->plan].solution;
    return here && !trial->run && gait_known && plan_known;
}

// To be run by this process; those of plans that are still to come count three times, for the plans' sake.
static double still_to_run(const steer_job *job)
{
    double n = 0;
    for (int k = 0; k < job->n_trials; k++)
        n += job->trial[k].run || elsewhere(job, &job->trial[k]) ? 0 : steer_can_run(job, &job->trial[k]) ? 1 : 3;
    return n;
}

static moray_status try_both(const steer_job *job, steer_trial *trial)
{
    for (int model = 0; model < 2; model++) {
        const moray_status status = steer_try(job, trial, (moray_model)model, careful);
        MORAY_TRY(steer_interruption());
        MORAY_TRY(status);
    }
    return moray_ok();
}

static void note(steer_job *job, steer_trial *trial)
{
    const steer_score *first = job->program->scores;
    trial->run = true;
    moray_ticker_note(&job->ticker, "%s: %s %.4g on the control-oriented model, %.4g on the first-principles model",
                      trial->name, first->key, trial->score[0][0] / first->unit, trial->score[1][0] / first->unit);
}

static moray_status run_tuned(steer_job *job, steer_trial *trial)
{
    const double tuning_share = 0.7;
    moray_ticker_show(&job->ticker, "%s: tuning %s", job->name, trial->name);
    steer_clock_give(&job->clock, tuning_share / still_to_run(job));
    const steer_trial *same = steer_same_law(trial);
    if (same)
        steer_take_numbers(trial, same);
    else
        MORAY_TRY(steer_tune(job, trial));
    steer_clock_give(&job->clock, 1 / still_to_run(job));
    MORAY_TRY(try_both(job, trial));
    const steer_trial *better = steer_better_subset(trial);
    if (better) {
        steer_take_numbers(trial, better);
        MORAY_TRY(try_both(job, trial));
    }
    note(job, trial);
    return moray_ok();
}

// ---- Certificates, and trials of which none depends on another ------------------------------------------------------

// Certificates of plans, then what is not tuned, on each model a task.
typedef struct deal {
    steer_job *job;
    int plans, plan[2];
    int n, of[STEER_TRIALS];
    double runs; // still to come, of trials on one model
} deal;

typedef struct outcome {
    moray_status status;
    double score[STEER_SCORES], cost;
    moray_receding_horizon_record record;
    moray_certificate certificate;
} outcome;

static void certify(const steer_job *job, int plan, outcome *of)
{
    const moray_sim_settings sim = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&sim);
    moray_ticker_show(&job->ticker, "%s: certifying", job->name);
    of->status = moray_certify(job->plan[plan].solution, &integrator, &of->certificate);
}

static void swim_one(const deal *d, int run, outcome *of)
{
    const moray_model model = (moray_model)(run % 2);
    steer_trial trial = d->job->trial[d->of[run / 2]];
    moray_ticker_show(&d->job->ticker, "%s: %s", d->job->name, trial.name);
    steer_clock_give(&d->job->clock, 1 / (d->runs - run));
    of->status = steer_try(d->job, &trial, model, careful);
    memcpy(of->score, trial.score[model], sizeof of->score);
    of->cost = trial.cost[model];
    of->record = trial.record[model];
}

// A moray_task_fn; result: an outcome.
static void do_one(int task, void *result, void *self)
{
    const deal *d = self;
    if (task < d->plans)
        certify(d->job, d->plan[task], result);
    else
        swim_one(d, task - d->plans, result);
}

static moray_status take(steer_job *job, const outcome of[2], steer_trial *trial)
{
    for (int model = 0; model < 2; model++) {
        memcpy(trial->score[model], of[model].score, sizeof of->score);
        trial->cost[model] = of[model].cost;
        trial->record[model] = of[model].record;
        MORAY_TRY(of[model].status);
    }
    note(job, trial);
    return moray_ok();
}

// One that was left out for want of time is no error.
static moray_status unless_late(moray_status status)
{
    return status.code == MORAY_NOT_SOLVED ? moray_ok() : status;
}

static moray_status take_certificates(const deal *d, const outcome *of)
{
    for (int k = 0; k < d->plans; k++) {
        MORAY_TRY(of[k].status);
        d->job->certificate[d->plan[k]] = of[k].certificate;
        d->job->certified[d->plan[k]] = d->job->plan[d->plan[k]].solution;
    }
    return moray_ok();
}

static moray_status run_others(steer_job *job)
{
    deal d = {.job = job, .runs = 2 * still_to_run(job)};
    outcome of[2 + 2 * STEER_TRIALS] = {0};
    for (int plan = 0; plan < 2; plan++)
        if (job->plan[plan].solution && job->plan[plan].solution != job->certified[plan])
            d.plan[d.plans++] = plan;
    for (int k = 0; k < job->n_trials; k++)
        if (steer_can_run(job, &job->trial[k]) && !job->trial[k].law->tuned)
            d.of[d.n++] = k;
    MORAY_TRY(moray_parallel(d.plans + 2 * d.n, sizeof *of, of, do_one, &d, job->jobs));
    MORAY_TRY(steer_interruption());
    MORAY_TRY(take_certificates(&d, of));
    for (int k = 0; k < d.n; k++)
        MORAY_TRY(unless_late(take(job, &of[d.plans + 2 * k], &job->trial[d.of[k]])));
    return moray_ok();
}

moray_status steer_run_ready(steer_job *job)
{
    MORAY_TRY(run_others(job));
    for (int k = 0; k < job->n_trials; k++)
        if (steer_can_run(job, &job->trial[k]) && job->trial[k].law->tuned)
            MORAY_TRY(unless_late(run_tuned(job, &job->trial[k])));
    return moray_ok();
}

void steer_keep_trials(steer_job *job, const steer_trial *before, int n)
{
    for (int k = 0; k < job->n_trials; k++)
        for (int i = 0; i < n; i++) {
            steer_trial *trial = &job->trial[k];
            if (!before[i].run || before[i].law != trial->law || before[i].gait != trial->gait ||
                before[i].plan != trial->plan)
                continue;
            const steer_trial chosen = *trial;
            *trial = before[i];
            memcpy(trial->subset, chosen.subset, sizeof trial->subset);
        }
}

bool steer_go_on(void *observer, const moray_search_progress *progress)
{
    (void)progress;
    const steer_job *job = observer;
    return !moray_interrupted() && !steer_clock_up(&job->clock);
}

moray_status steer_interruption(void)
{
    return moray_interrupted() ? moray_error(MORAY_INTERRUPTED, "interrupted; nothing is written") : moray_ok();
}
