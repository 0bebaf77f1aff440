// SPDX-License-Identifier: MIT
//
// The numbers of a law, tuned by rough simulations on the first-principles model.
#include "trials.h"

// Steps a period of the gait. Beyond some gain a law swings from limit to limit, and its error is another in any steps.
static const moray_swim_on_gait quick = {.steps = 24, .order = 3},
                                others[] = {{.steps = 24}, {.steps = 36, .order = 3}, {.steps = 64, .order = 3}};
enum { OTHERS = sizeof others / sizeof *others };

typedef struct tuning {
    const steer_job *job;
    const steer_trial *trial;
} tuning;

static bool tuned(const steer_trial *trial, int number)
{
    return trial->tuned & 1u << number;
}

static void set_numbers(steer_trial *trial, const double *x)
{
    for (int k = 0; k < STEER_NUMBERS; k++)
        if (tuned(trial, k))
            trial->number[k] = *x++;
}

static bool swim(const tuning *t, const moray_swim_on_gait *on_gait, const double *x, double *cost)
{
    const steer_accuracy how = {.on_gait = on_gait, .per_second = t->job->program->rough_per_second, .timed = true};
    steer_trial own = *t->trial;
    set_numbers(&own, x);
    const moray_status status = steer_try(t->job, &own, MORAY_FIRST_PRINCIPLES, how);
    *cost = own.cost[MORAY_FIRST_PRINCIPLES];
    return !moray_failed(status);
}

static bool evaluate(void *self, const double *x, double *cost)
{
    return swim(self, &quick, x, cost);
}

static bool evaluate_again(void *self, const double *x, int k, double *cost)
{
    return swim(self, &others[k], x, cost);
}

static bool go_on(void *observer)
{
    const steer_job *job = observer;
    return !moray_interrupted() && !steer_clock_up(&job->clock);
}

// Where the search starts besides: the law's own numbers, and those of the laws that leave some of them out.
static int starts_of(const steer_trial *trial, double *at)
{
    int rows = 0;
    for (int i = -1; i < STEER_SUBSETS; i++) {
        const steer_trial *of = i < 0 ? trial : trial->subset[i];
        if (!of)
            continue;
        for (int k = 0; k < STEER_NUMBERS; k++)
            if (tuned(trial, k))
                *at++ = isnan(of->number[k]) ? 0 : of->number[k];
        rows++;
    }
    return rows;
}

moray_status steer_tune(steer_job *job, steer_trial *trial)
{
    moray_tuned_number number[STEER_NUMBERS];
    double from[(STEER_SUBSETS + 1) * STEER_NUMBERS], x[STEER_NUMBERS];
    tuning t = {job, trial};
    moray_tuning_problem problem = {
        .number = number, .cost = evaluate, .self = &t, .confirmations = OTHERS, .confirm = evaluate_again};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    for (int k = 0; k < STEER_NUMBERS; k++)
        if (tuned(trial, k))
            number[problem.n++] = job->number[k].searched;
    settings.starts = job->starts;
    settings.evaluations = job->evaluations;
    settings.jobs = job->jobs;
    settings.go_on = go_on;
    settings.observer = job;
    const int rows = starts_of(trial, from);
    const moray_status status = moray_tune(&problem, &settings, from, rows, x, &info);
    MORAY_TRY(steer_interruption());
    trial->cut = status.code == MORAY_INTERRUPTED;
    if (trial->cut && !isfinite(info.cost))
        return moray_error(MORAY_NOT_SOLVED, "%s: not tuned in the time given", trial->name);
    if (!trial->cut)
        MORAY_TRY(status);
    set_numbers(trial, x);
    trial->tuned_cost = info.cost;
    trial->evaluations = info.evaluations;
    trial->searches = info.searches;
    trial->agree = info.agree;
    return moray_ok();
}

const steer_trial *steer_same_law(const steer_trial *trial)
{
    for (int i = 0; i < STEER_SUBSETS; i++) {
        const steer_trial *of = trial->subset[i];
        if (of && of->run && of->gait == trial->gait && of->law->set == trial->law->set && of->tuned == trial->tuned)
            return of;
    }
    return NULL;
}

const steer_trial *steer_better_subset(const steer_trial *trial)
{
    const steer_trial *best = NULL;
    double least = trial->cost[MORAY_FIRST_PRINCIPLES];
    for (int i = 0; i < STEER_SUBSETS && trial->law->tuned; i++) {
        const steer_trial *of = trial->subset[i];
        if (!of || !of->run || of->gait != trial->gait || !(of->cost[MORAY_FIRST_PRINCIPLES] < least))
            continue;
        least = of->cost[MORAY_FIRST_PRINCIPLES];
        best = of;
    }
    return best;
}

void steer_take_numbers(steer_trial *trial, const steer_trial *of)
{
    bool first = true;
    for (int k = 0; k < STEER_NUMBERS; k++) {
        if (!tuned(trial, k))
            continue;
        if (!isnan(of->number[k]))
            trial->number[k] = of->number[k];
        else if (first)
            trial->number[k] = 0;
        first = false;
    }
}
