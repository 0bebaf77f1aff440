// SPDX-License-Identifier: MIT
//
// What proves a gait apart from the solver: its certificate, and simulations from rest on both models; done side by
// side.
#include <stdlib.h>

#include "job.h"
#include "moray/parallel.h"

// What is done of every stage, each a task.
enum { CERTIFY = 2, TASKS }; // before it: swim on the model of that number

typedef struct {
    const gait_job *job;
    stage *const *at;
    int parts;              // TASKS, or CERTIFY: all before that
    const moray_gait *gait; // instead of a stage's
    moray_model from;
} proofs;

// What a task finds.
typedef struct {
    moray_status status; // of the certificate
    moray_certificate certificate;
    moray_gait_trial trial; // on one model
    moray_gait_gain gain;
} proof;

moray_status gait_job_certify(const gait_job *job, stage *at)
{
    const moray_integrator integrator = moray_sim_integrator(&job->rig.settings.sim);
    const moray_status status = moray_certify(at->solution, &integrator, &at->certificate);
    if (status.code != MORAY_NUMERIC)
        return status;
    at->certificate.resimulation = INFINITY;
    at->certificate.pass = false;
    snprintf(at->certificate.why, sizeof at->certificate.why, "%.*s", (int)sizeof at->certificate.why - 1, status.text);
    return moray_ok();
}

void gait_job_swim(const gait_job *job, moray_model model, moray_gait_trial *trial)
{
    const moray_steady none = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, false, NAN, 0};
    moray_status status = gait_job_turning(job, model);
    if (!moray_failed(status))
        status = moray_gait_trial_swim(&job->rig, model, trial);
    if (!moray_failed(status))
        return;
    trial->steady[model] = none;
    trial->held[model] = false;
    trial->why[model] = status;
}

static void swim(const gait_job *job, const moray_gait *gait, moray_model from, moray_model model,
                 moray_gait_trial *trial)
{
    trial->gait[model] = moray_gait_map(&job->snake.robot, gait, from, model);
    gait_job_swim(job, model, trial);
}

static void compare(const gait_job *job, proof *of)
{
    const moray_status no_paper = job->no_paper[MORAY_FIRST_PRINCIPLES];
    if (moray_failed(no_paper))
        of->gain = (moray_gait_gain){NAN, NAN, NAN, NAN, no_paper, no_paper};
    else
        of->gain = moray_gait_gain_over(&job->rig, &of->trial, &job->paper);
}

// A moray_task_fn; result: a proof.
static void prove(int task, void *result, void *self)
{
    const proofs *all = self;
    proof *of = result;
    const int part = task % all->parts;
    stage *at = all->at[task / all->parts];
    of->status = moray_ok();
    if (part == CERTIFY) {
        of->status = gait_job_certify(all->job, at);
        of->certificate = at->certificate;
        return;
    }
    swim(all->job, &at->prediction.gait, at->model, (moray_model)part, &of->trial);
    if (part == MORAY_FIRST_PRINCIPLES)
        compare(all->job, of);
}

// A moray_task_fn; result: a proof.
static void try_on(int model, void *result, void *self)
{
    const proofs *all = self;
    swim(all->job, all->gait, all->from, (moray_model)model, &((proof *)result)->trial);
}

static void take_trial(const proof *of, moray_model model, moray_gait_trial *trial)
{
    trial->gait[model] = of->trial.gait[model];
    trial->steady[model] = of->trial.steady[model];
    trial->held[model] = of->trial.held[model];
    trial->why[model] = of->trial.why[model];
}

moray_status gait_job_try(const gait_job *job, const moray_gait *gait, moray_model from, moray_gait_trial *trial)
{
    proofs all = {.job = job, .gait = gait, .from = from};
    proof of[2] = {0};
    MORAY_TRY(moray_parallel(2, sizeof *of, of, try_on, &all, job->jobs));
    for (int model = 0; model < 2; model++)
        take_trial(&of[model], (moray_model)model, trial);
    return moray_ok();
}

static moray_status take(const proof *of, int parts, stage *at)
{
    if (parts > CERTIFY) {
        MORAY_TRY(of[CERTIFY].status);
        at->certificate = of[CERTIFY].certificate;
    }
    for (int model = 0; model < 2; model++)
        take_trial(&of[model], (moray_model)model, &at->trial);
    at->gain = of[MORAY_FIRST_PRINCIPLES].gain;
    return moray_ok();
}

static moray_status do_parts(gait_job *job, stage *const *at, int n, int parts)
{
    proofs all = {.job = job, .at = at, .parts = parts};
    proof *of = calloc((size_t)(n * parts) + 1, sizeof *of);
    if (!of)
        return moray_error(MORAY_MEMORY, "no memory to prove %d gaits", n);
    moray_status status = moray_parallel(n * parts, sizeof *of, of, prove, &all, job->jobs);
    for (int k = 0; k < n && !moray_failed(status); k++)
        status = take(of + k * parts, parts, at[k]);
    free(of);
    return status;
}

moray_status gait_job_prove(gait_job *job, stage *const *at, int n)
{
    moray_ticker_show(&job->ticker, "%s: %s on both models", job->name, n > 1 ? "the gaits" : "the optimised gait");
    return do_parts(job, at, n, TASKS);
}

moray_status gait_job_try_all(gait_job *job, stage *const *at, int n)
{
    return do_parts(job, at, n, CERTIFY);
}
