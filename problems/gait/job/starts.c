// SPDX-License-Identifier: MIT
//
// Solving from many starts: the best end is kept, and what each start cost. Random starts are dealt to processes, which
// send numbers; a solution that is better than what there is is then found again here, so that all is as with one job.
#include <stdlib.h>

#include "job.h"

struct end {
    bool any, solved;
    double objective;
};

static struct end end_of(const moray_solution *solution)
{
    if (!solution)
        return (struct end){0};
    return (struct end){true, moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED,
                        moray_solution_objective(solution)};
}

// Whether `one` is a better end than `other`: solved, then by objective.
static bool is_better(const struct end *one, const struct end *other)
{
    if (!other->any || one->solved != other->solved)
        return !other->any || one->solved;
    return one->objective < other->objective;
}

// Counts the starts that agree with the best end, and says whether this one becomes that.
static bool takes_over(stage *at, const struct end *one, const struct end *best)
{
    const double same = 1e-6;
    const bool level = best->any && one->solved && best->solved && fabs(one->objective - best->objective) < same;
    const bool better = is_better(one, best);
    at->agreeing = level ? at->agreeing + 1 : better ? 1 : at->agreeing;
    return better;
}

moray_status gait_job_begin_starts(stage *at, int n)
{
    at->starts = n;
    at->tried = 0;
    at->iterations = calloc((size_t)n + 1, sizeof *at->iterations);
    return at->iterations ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d starts", n);
}

static void note_start(stage *at, double iterations)
{
    if (at->iterations && at->tried < at->starts)
        at->iterations[at->tried++] = iterations;
}

static void keep(stage *at, bool better, moray_solution *solution)
{
    moray_solution_free(better ? at->solution : solution);
    if (better)
        at->solution = solution;
}

void gait_job_keep_best(stage *at, moray_solution *solution)
{
    const struct end one = end_of(solution), best = end_of(at->solution);
    note_start(at, moray_solution_info(solution)->iterations);
    keep(at, takes_over(at, &one, &best), solution);
}

// ---- Random gaits --------------------------------------------------------------------------------------------------

static double uniform(double low, double high)
{
    return low + (high - low) * drand48();
}

moray_gait gait_job_random(const gait_job *job, const stage *at)
{
    const double theta_max = uniform(job->theta_max[0], job->theta_max[1]);
    moray_gait gait = {.omega = uniform(job->omega[0], job->omega[1]), .delta = uniform(job->delta[0], job->delta[1])};
    gait.amplitude = moray_amplitude_from_theta_max(&job->snake.robot, at->model, theta_max, gait.delta);
    if (at->taper[0] < at->taper[1])
        gait.taper = uniform(at->taper[0], at->taper[1]);
    return gait;
}

// ---- Trying --------------------------------------------------------------------------------------------------------

enum { HAND = 8 }; // gaits dealt to each process at a time

struct hand {
    gait_job *job;
    stage *at;
    gait_job_way *way;
    void *self;
};

struct outcome {
    struct end end;
    double iterations;
    moray_status status;
};

static void try_one(int task, void *result, void *self)
{
    const struct hand *hand = self;
    struct outcome *outcome = result;
    moray_solution *solution = NULL;
    *outcome = (struct outcome){.iterations = NAN};
    outcome->status = hand->way(hand->job, hand->at, hand->self, task, &solution);
    if (!moray_failed(outcome->status))
        *outcome = (struct outcome){end_of(solution), moray_solution_info(solution)->iterations, moray_ok()};
    moray_solution_free(solution);
}

static void note_failure(moray_status status, moray_status *first)
{
    if (moray_failed(status) && !moray_failed(*first))
        *first = status;
}

static void try_alone(const struct hand *hand, int task, moray_status *first_failure)
{
    moray_solution *solution = NULL;
    const moray_status status = hand->way(hand->job, hand->at, hand->self, task, &solution);
    if (moray_failed(status))
        note_start(hand->at, NAN);
    else
        gait_job_keep_best(hand->at, solution);
    note_failure(status, first_failure);
}

// As try_alone on each of the hand in turn.
static moray_status try_hand(struct hand *hand, int n, struct outcome *outcome, moray_status *first_failure)
{
    stage *at = hand->at;
    struct end best = end_of(at->solution);
    int winner = -1;
    MORAY_TRY(moray_parallel(n, sizeof *outcome, outcome, try_one, hand, hand->job->jobs));
    for (int k = 0; k < n && !moray_interrupted(); k++) {
        note_start(at, outcome[k].iterations);
        note_failure(outcome[k].status, first_failure);
        if (moray_failed(outcome[k].status) || !takes_over(at, &outcome[k].end, &best))
            continue;
        best = outcome[k].end;
        winner = k;
    }
    if (winner < 0)
        return moray_ok();
    moray_solution *solution = NULL;
    MORAY_TRY(hand->way(hand->job, at, hand->self, winner, &solution));
    keep(at, true, solution);
    return moray_ok();
}

static int jobs_of(const gait_job *job)
{
    return job->jobs < 1 ? moray_processors() : job->jobs;
}

moray_status gait_job_try_ways(gait_job *job, stage *at, int n, gait_job_way *way, void *self)
{
    enum { most = 16 };
    moray_status first_failure = moray_ok();
    struct hand hand = {job, at, way, self};
    struct outcome outcome[most];
    if (jobs_of(job) == 1 || n > most)
        for (int k = 0; k < n && !moray_interrupted(); k++)
            try_alone(&hand, k, &first_failure);
    else
        MORAY_TRY(try_hand(&hand, n, outcome, &first_failure));
    return at->solution ? moray_ok() : first_failure;
}

// ---- Gaits to start from -------------------------------------------------------------------------------------------

struct gaits {
    const moray_gait *gait;
    gait_job_attempt *attempt;
    void *self;
};

static moray_status try_gait(gait_job *job, stage *at, void *self, int k, moray_solution **solution)
{
    const struct gaits *gaits = self;
    return gaits->attempt(job, at, gaits->self, &gaits->gait[k], solution);
}

static void try_random_alone(const struct hand *hand, int n, moray_status *first_failure)
{
    struct gaits *gaits = hand->self;
    for (int k = 0; k < n && !moray_interrupted(); k++) {
        const moray_gait gait = gait_job_random(hand->job, hand->at);
        gaits->gait = &gait;
        try_alone(hand, 0, first_failure);
    }
}

static moray_status deal_random(struct hand *hand, int n, int jobs, moray_status *first_failure)
{
    const int most = jobs * HAND;
    struct outcome *outcome = calloc((size_t)most, sizeof *outcome);
    struct gaits *gaits = hand->self;
    moray_gait *gait = calloc((size_t)most, sizeof *gait);
    moray_status status = moray_ok();
    gaits->gait = gait;
    if (!outcome || !gait)
        status = moray_error(MORAY_MEMORY, "no memory for %d starts", n);
    for (int some; n > 0 && !moray_failed(status) && !moray_interrupted(); n -= some) {
        some = n < most ? n : most;
        for (int i = 0; i < some; i++)
            gait[i] = gait_job_random(hand->job, hand->at);
        status = try_hand(hand, some, outcome, first_failure);
    }
    free(gait);
    free(outcome);
    return status;
}

moray_status gait_job_try_starts(gait_job *job, stage *at, const gait_starts *known, int random,
                                 gait_job_attempt *attempt, void *self)
{
    const int jobs = jobs_of(job);
    moray_status first_failure = moray_ok();
    struct gaits gaits = {known->gait, attempt, self};
    struct hand hand = {job, at, try_gait, &gaits};
    srand48(1);
    for (int k = 0; k < known->n && !moray_interrupted(); k++)
        try_alone(&hand, k, &first_failure);
    if (jobs == 1)
        try_random_alone(&hand, random, &first_failure);
    else
        MORAY_TRY(deal_random(&hand, random, jobs, &first_failure));
    return at->solution ? moray_ok() : first_failure;
}
