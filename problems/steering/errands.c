// SPDX-License-Identifier: MIT
//
// Trials run by another process while this one makes the next plan.
#include "trials.h"

#include <string.h>

typedef struct brought {
    moray_status status;
    steer_trial trial[STEER_TRIALS];
    moray_certificate certificate[2];
} brought;

static int processes(const steer_job *job)
{
    return job->jobs < 1 ? moray_processors() : job->jobs;
}

// Receding horizons stay: they are many tasks, and fill the processors while the last of a few others is done.
static unsigned trials_ready(const steer_job *job)
{
    unsigned ready = 0;
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].law->kind != STEER_RECEDING)
            ready |= (unsigned)steer_can_run(job, &job->trial[k]) << k;
    return ready;
}

// A moray_task_fn; result: what is brought.
static void run_apart(int task, void *result, void *self)
{
    steer_job *job = self;
    brought *found = result;
    const int jobs = job->jobs;
    (void)task;
    job->left_out = ~trials_ready(job);
    job->jobs = processes(job) / 2;
    found->status = steer_run_ready(job);
    job->jobs = jobs;
    job->left_out = 0;
    memcpy(found->trial, job->trial, sizeof found->trial);
    memcpy(found->certificate, job->certificate, sizeof found->certificate);
}

static unsigned plans_ready(const steer_job *job)
{
    unsigned ready = 0;
    for (int k = 0; k < 2; k++)
        ready |= (unsigned)(job->plan[k].solution && job->plan[k].solution != job->certified[k]) << k;
    return ready;
}

static void leave_to(steer_job *job, const steer_errand *errand)
{
    for (int k = 0; k < job->n_trials; k++)
        job->trial[k].away |= errand->trials >> k & 1;
    for (int k = 0; k < 2; k++)
        if (errand->plans >> k & 1)
            job->certified[k] = job->plan[k].solution;
}

moray_status steer_begin_trials(steer_job *job)
{
    const brought none = {0};
    steer_errand *errand = &job->errand[job->n_errands];
    if (processes(job) < 2 || job->n_errands == STEER_ERRANDS)
        return steer_run_ready(job);
    *errand = (steer_errand){.trials = trials_ready(job), .plans = plans_ready(job)};
    if (!errand->trials && !errand->plans)
        return moray_ok();
    MORAY_TRY(moray_background_begin(&errand->background, sizeof none, &none, run_apart, job));
    leave_to(job, errand);
    job->n_errands++;
    return moray_ok();
}

static void take_over(steer_job *job, const steer_errand *errand, const brought *found)
{
    for (int k = 0; k < job->n_trials; k++)
        if (errand->trials >> k & 1)
            job->trial[k] = found->trial[k];
    for (int k = 0; k < 2; k++)
        if (errand->plans >> k & 1)
            job->certificate[k] = found->certificate[k];
}

moray_status steer_end_errands(steer_job *job)
{
    moray_status first = moray_ok();
    for (int k = 0; k < job->n_errands; k++) {
        brought found;
        moray_status status = moray_background_end(job->errand[k].background, &found);
        if (!moray_failed(status))
            take_over(job, &job->errand[k], &found);
        if (!moray_failed(status))
            status = found.status;
        if (moray_failed(status) && !moray_failed(first))
            first = status;
    }
    job->n_errands = 0;
    return first;
}

// While errands are not done there are more processes than processors for a while, and none of these is idle.
moray_status steer_run_trials(steer_job *job)
{
    MORAY_TRY(steer_run_ready(job));
    if (job->n_errands == 0)
        return moray_ok();
    MORAY_TRY(steer_end_errands(job));
    return steer_run_ready(job);
}
