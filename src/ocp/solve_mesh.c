// SPDX-License-Identifier: MIT
//
// The solve on one mesh: transcribed with patterns that hold, solved, and widened where a function shows more.
#include "ocp/refinement/campaign.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/observe/observed.h"
#include "ocp/observe/sight.h"
#include "ocp/solve_again.h"
#include "ocp/widen.h"

static const double worst_warm_error = 1e-2;
static const double least_seconds = 1e-3; // of a solve that is begun

moray_status moray_allocate_iterate(moray_solution *solution)
{
    const int n = solution->transcription->nlp.n, m = solution->transcription->nlp.m;
    double *block = calloc((size_t)(4 * n + 2 * m), sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for %d variables", n);
    solution->iterate = (moray_iterate){
        .x = block, .z_lower = block + n, .z_upper = block + 2 * n, .g = block + 4 * n, .lambda = block + 4 * n + m};
    solution->guess = block + 3 * n;
    return moray_ok();
}

bool moray_is_solved(const moray_solution *solution)
{
    return solution->info.outcome == MORAY_NLP_SOLVED || solution->info.outcome == MORAY_NLP_ACCEPTABLE;
}

static bool has_rows_of_its_own(const moray_ocp *ocp)
{
    for (int p = 0; p < ocp->phases; p++)
        if (ocp->phase[p].n_held > 0 || moray_data_move(&ocp->phase[p]))
            return true;
    return false;
}

// Whether the guess is what was found of the same problem.
static bool goes_on(const moray_solution *solution, const moray_guess *guess)
{
    const moray_solution *from = guess ? guess->from : NULL;
    return from && from->transcription->ocp == solution->transcription->ocp && moray_is_solved(from);
}

// Multipliers of holds, and of what moving data see, do not go from mesh to mesh. Multipliers of a solved mesh whose
// error is small halve the iterations or better; of a coarse one they mislead.
static bool can_start_warm(const moray_solution *solution, const moray_guess *guess)
{
    return goes_on(solution, guess) && !has_rows_of_its_own(solution->transcription->ocp) &&
           guess->from->history[guess->from->meshes - 1].error < worst_warm_error;
}

static moray_status run_solver(moray_solution *solution, const moray_guess *guess, bool warm)
{
    struct transcription *t = solution->transcription;
    moray_nlp_settings settings = moray_solver_settings(solution, warm);
    MORAY_TRY(moray_iterations_room(solution->iterations, settings.max_iterations));
    if (warm && guess->along_time) // the start has moved
        settings.barrier = solution->settings.barrier;
    const enum sized_by point = goes_on(solution, guess) && !guess->along_time ? by_other_mesh : by_guess;
    MORAY_TRY(moray_fill_guess(t, guess, solution->iterate.x));
    if (solution->settings.own_scaling)
        MORAY_TRY(moray_choose_scales(t, solution->iterate.x, point));
    memcpy(solution->guess, solution->iterate.x, (size_t)t->nlp.n * sizeof *solution->guess);
    if (warm)
        MORAY_TRY(moray_carry_multipliers(guess, solution));
    moray_fit_be_gauss_newton(t, solution->settings.gauss_newton);
    moray_status status = moray_ipopt_solve(&t->nlp, &settings, &solution->iterate, &solution->info);
    if (!moray_failed(status) && moray_is_solved(solution))
        status = moray_solve_again(solution);
    moray_fit_be_gauss_newton(t, false); // what comes after asks for the true curvature
    return status;
}

static moray_status run(moray_solution *solution, const moray_guess *guess)
{
    struct transcription *t = solution->transcription;
    const bool warm = can_start_warm(solution, guess);
    MORAY_TRY(run_solver(solution, guess, warm));
    if (warm && !moray_is_solved(solution) && solution->info.outcome != MORAY_NLP_INTERRUPTED)
        MORAY_TRY(run_solver(solution, guess, false));
    if (!moray_transcription_jacobians(t, solution->iterate.x)) // accessors read the caches
        return moray_error(MORAY_NUMERIC, "at the solver's last point, %s", t->failure.text);
    return moray_ok();
}

static moray_status transcribe(const struct campaign *c, moray_solution *solution)
{
    MORAY_TRY(moray_transcription_new(&solution->transcription, c->ocp, c->meshes));
    return moray_allocate_iterate(solution);
}

// Transcribed with patterns that hold at the guess, and data in the intervals into which they fall there.
static moray_status transcribe_at_guess(const struct campaign *c, const moray_guess *guess, moray_solution *solution)
{
    MORAY_TRY(transcribe(c, solution));
    for (int k = 0; k < most_widenings; k++) {
        int found = 0;
        MORAY_TRY(moray_fill_guess(solution->transcription, guess, solution->iterate.x));
        MORAY_TRY(moray_widen_patterns(solution->transcription, &found));
        if (!moray_sights_left(solution->transcription, c->meshes) && found == 0)
            break;
        moray_transcription_free(solution->transcription);
        free(solution->iterate.x);
        solution->transcription = NULL, solution->iterate.x = NULL;
        MORAY_TRY(transcribe(c, solution));
    }
    return moray_ok();
}

// A warm start lowers the barrier only where the interpolated point is nearly right: elsewhere it would start in a
// corner.
static moray_status solve_once(struct campaign *c, const moray_guess *guess, moray_solution **result)
{
    *result = NULL;
    moray_solution *solution = calloc(1, sizeof *solution);
    if (!solution)
        return moray_error(MORAY_MEMORY, "no memory for a solution");
    solution->settings = *c->settings;
    solution->iterations = c->iterations;
    if (c->settings->max_cpu_seconds > 0)
        solution->settings.max_cpu_seconds = fmax(c->settings->max_cpu_seconds - c->spent, least_seconds);
    moray_status status = transcribe_at_guess(c, guess, solution);
    if (!moray_failed(status))
        status = run(solution, guess);
    c->spent += solution->info.cpu_seconds;
    if (moray_failed(status))
        moray_campaign_drop(solution);
    else
        *result = solution;
    return status;
}

moray_mesh_record moray_record_of(const moray_solution *solution, double error)
{
    const struct layout *layout = &solution->transcription->layout;
    moray_mesh_record record = {.variables = layout->columns,
                                .outcome = solution->info.outcome,
                                .linear_solver = solution->info.linear_solver,
                                .iterations = solution->info.iterations,
                                .seconds = solution->info.seconds,
                                .error = error,
                                .objective = solution->iterate.objective};
    for (int p = 0; p < layout->phases; p++) {
        record.intervals += layout->phase[p].mesh.intervals;
        record.nodes += layout->phase[p].nodes;
    }
    return record;
}

void moray_campaign_record(struct campaign *c, moray_solution *solution, double error, int dependences)
{
    c->history[c->tried] = moray_record_of(solution, error);
    c->history[c->tried++].dependences = dependences;
    solution->history = c->history;
    solution->meshes = c->tried;
}

void moray_campaign_drop(moray_solution *solution)
{
    solution->history = NULL;
    solution->iterations = NULL;
    moray_solution_free(solution);
}

moray_status moray_campaign_solve_widened(struct campaign *c, const moray_guess *guess, moray_solution **result)
{
    MORAY_TRY(solve_once(c, guess, result));
    while ((*result)->info.outcome != MORAY_NLP_INTERRUPTED) {
        int found = 0;
        moray_solution *old = *result;
        moray_status status =
            c->widenings < most_widenings ? moray_widen_patterns(old->transcription, &found) : moray_ok();
        const bool left = moray_sights_left(old->transcription, c->meshes) && c->moves < most_moves;
        if (!moray_failed(status) && found == 0 && !left)
            return status;
        *result = NULL;
        if (!moray_failed(status)) {
            const moray_guess here = moray_guess_from_solution(old);
            c->widenings += found > 0;
            c->moves += found == 0;
            moray_campaign_record(c, old, NAN, found);
            status = solve_once(c, &here, result);
        }
        moray_campaign_drop(old);
        MORAY_TRY(status);
    }
    return moray_ok();
}

void moray_solution_free(moray_solution *solution)
{
    if (!solution)
        return;
    moray_transcription_free(solution->transcription);
    free(solution->iterate.x);
    free(solution->history);
    moray_iterations_free(solution->iterations);
    free(solution);
}
