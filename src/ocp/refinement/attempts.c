// SPDX-License-Identifier: MIT
//
// What is tried on a mesh where one solve does not do: another scheme, another start, and a step away from a saddle.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "ocp/certificate/saddle.h"
#include "ocp/diagnosis/diagnosis.h"
#include "ocp/refinement/campaign.h"
#include "ocp/refinement/family.h"
#include "ocp/refinement/second_start.h"

static const double feasible = 1e-6; // scaled

// Solves again from beside a saddle. Where that fails the saddle is the result, as it was.
static moray_status solve_beside(struct campaign *c, const double *kept, moray_solution **result)
{
    moray_solution *saddle = *result, *next = NULL;
    const moray_guess beside = moray_guess_from_solution(saddle);
    moray_campaign_record(c, saddle, NAN, 0);
    c->escapes++;
    const moray_status status = moray_campaign_solve_widened(c, &beside, &next);
    if (!moray_failed(status) && moray_is_solved(next)) {
        *result = next;
        moray_campaign_drop(saddle);
        return status;
    }
    memcpy(saddle->iterate.x, kept, (size_t)saddle->transcription->nlp.n * sizeof *kept);
    moray_transcription_jacobians(saddle->transcription, saddle->iterate.x); // accessors read the caches
    if (next) {
        if (next->info.outcome == MORAY_NLP_INTERRUPTED)
            saddle->info.outcome = MORAY_NLP_INTERRUPTED;
        moray_campaign_drop(next);
    }
    return status;
}

// Where the last step needed no regularisation the Hessian was positive definite on the constraints.
static bool may_be_saddle(const moray_solution *solution)
{
    return moray_is_solved(solution) && solution->info.regularisation != 0;
}

static bool has_time(const struct campaign *c)
{
    return c->settings->max_iterations > 0 &&
           !(c->settings->max_cpu_seconds > 0 && c->spent >= c->settings->max_cpu_seconds);
}

// A solve that stalled where the constraints hold is near an optimum, and for its diagnosis.
static bool is_failed(const moray_solution *solution)
{
    const moray_nlp_outcome outcome = solution->info.outcome;
    double worst = 0;
    moray_assemble_constraints(solution->transcription, solution->iterate.g);
    for (int i = 0; i < solution->transcription->nlp.m; i++)
        worst = moray_worse(worst, fabs(moray_scaled_violation(solution, i)));
    return !moray_is_solved(solution) && outcome != MORAY_NLP_INTERRUPTED &&
           !(outcome == MORAY_NLP_STALLED && worst < feasible);
}

// Bounds alone say little of how things move: a guess by them that leads nowhere is worth another.
static bool is_unguessed(const struct campaign *c, const moray_guess *guess)
{
    for (int p = 0; p < c->ocp->phases && guess && guess->phase; p++)
        if (guess->phase[p].n > 0)
            return false;
    return true;
}

// Solves beside a failed solve. Where that fails too the first is the result, and last in the history.
static moray_status attempt(struct campaign *c, const moray_guess *guess, moray_solution **result)
{
    moray_solution *failed = *result, *next = NULL;
    const moray_status status = moray_campaign_solve_widened(c, guess, &next);
    if (!moray_failed(status) && moray_is_solved(next)) {
        *result = next;
        moray_campaign_drop(failed);
        return status;
    }
    if (next) {
        if (next->info.outcome == MORAY_NLP_INTERRUPTED)
            failed->info.outcome = MORAY_NLP_INTERRUPTED;
        c->history[c->tried - 1] = moray_record_of(next, NAN);
        moray_campaign_drop(next);
    } else {
        c->tried--;
    }
    return status.code == MORAY_NUMERIC ? moray_ok() : status;
}

// From what the dynamics do.
static moray_status start_again(struct campaign *c, moray_solution **result)
{
    moray_guess guess;
    MORAY_TRY(moray_second_start(*result, &guess));
    if (!guess.phase)
        return moray_ok();
    moray_campaign_record(c, *result, NAN, 0);
    c->restarts++;
    const moray_status status = attempt(c, &guess, result);
    moray_guess_free(&guess);
    return status;
}

// With scales of the solver's own: ours come from slopes at the guess, which may be nothing beside those elsewhere.
static moray_status start_unscaled(struct campaign *c, const moray_guess *guess, moray_solution **result)
{
    const moray_settings *settings = c->settings;
    moray_settings unscaled = *settings;
    unscaled.own_scaling = false;
    moray_campaign_record(c, *result, NAN, 0);
    c->restarts++;
    c->settings = &unscaled;
    const moray_status status = attempt(c, guess, result);
    c->settings = settings;
    (*result)->settings = *settings;
    return status;
}

// With a scheme that holds what the problem asks.
static moray_status change_scheme(struct campaign *c, const moray_guess *guess, moray_solution **result)
{
    bool changed;
    const struct method method = c->method;
    MORAY_TRY(moray_leave_higher_index(c, *result, &changed));
    if (!changed)
        return moray_ok();
    c->restarts++;
    MORAY_TRY(attempt(c, guess, result));
    c->before.nodes = 0;
    if (!moray_is_solved(*result)) {
        c->method = method;
        c->left[method.family] = false;
    }
    return moray_ok();
}

// What may be tried where a first mesh was not solved.
static moray_status try_otherwise(struct campaign *c, const moray_guess *guess, moray_solution **result)
{
    const bool unguessed = is_unguessed(c, guess) && (*result)->transcription->nlp.x_scale;
    if (is_failed(*result) && has_time(c))
        MORAY_TRY(change_scheme(c, guess, result));
    if (unguessed && is_failed(*result) && has_time(c))
        MORAY_TRY(start_again(c, result));
    if (unguessed && is_failed(*result) && has_time(c))
        MORAY_TRY(start_unscaled(c, guess, result));
    return moray_ok();
}

moray_status moray_campaign_solve(struct campaign *c, const moray_guess *guess, moray_solution **result)
{
    MORAY_TRY(moray_campaign_solve_widened(c, guess, result));
    if (!(guess && guess->from) && c->restarts == 0)
        MORAY_TRY(try_otherwise(c, guess, result));
    bool moved = !(guess && guess->from);
    while (moved && c->escapes < most_escapes && may_be_saddle(*result)) {
        const moray_solution *before = *result;
        double *kept = calloc((size_t)before->transcription->nlp.n, sizeof *kept);
        if (!kept)
            return moray_error(MORAY_MEMORY, "no memory to leave a saddle");
        moray_status status = moray_leave_saddle(*result, kept, &moved);
        if (!moray_failed(status) && moved)
            status = solve_beside(c, kept, result);
        free(kept);
        MORAY_TRY(status);
        moved = *result != before;
    }
    return moray_ok();
}
