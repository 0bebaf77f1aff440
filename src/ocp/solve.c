// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/refine.h"
#include "ocp/ringing.h"
#include "ocp/certificate/saddle.h"
#include "ocp/widen.h"

static const double worst_warm_error = 1e-3;
static const double least_seconds = 1e-3; // of a solve that is begun
static const double falls = 0.9;          // of the least error before: what counts as less
enum { patience = 8 };                    // meshes in a row whose error is no less
enum { most_escapes = 2 };                // from saddles
enum { smooth_stages = 3 };               // of Radau, where Lobatto rings
enum { most_widenings = 8 }; // in all: each needs a place where a function depends on what it did not elsewhere

moray_settings moray_settings_default(void)
{
    return (moray_settings){.scheme = "hermite-simpson",
                            .intervals = 20,
                            .tolerance = 1e-8,
                            .mesh_tolerance = 1e-6,
                            .max_iterations = 1000,
                            .barrier = 0.1,
                            .own_scaling = true};
}

static moray_status check_settings(const moray_settings *settings, const moray_guess *guess)
{
    if (settings->intervals < (guess && guess->from ? 0 : 1))
        return moray_error(MORAY_INPUT, "intervals = %d: must be at least 1 (0 with a guess from a solution)",
                           settings->intervals);
    if (!(settings->tolerance > 0 && settings->tolerance < 1))
        return moray_error(MORAY_INPUT, "tolerance = %g: must lie between 0 and 1", settings->tolerance);
    if (!(settings->mesh_tolerance > 0))
        return moray_error(MORAY_INPUT, "mesh_tolerance = %g: must be positive", settings->mesh_tolerance);
    if (settings->max_iterations < 0)
        return moray_error(MORAY_INPUT, "max_iterations = %d: must not be negative", settings->max_iterations);
    if (!(settings->max_cpu_seconds >= 0))
        return moray_error(MORAY_INPUT, "max_cpu_seconds = %g: must not be negative", settings->max_cpu_seconds);
    if (settings->max_variables < 0)
        return moray_error(MORAY_INPUT, "max_variables = %d: must not be negative", settings->max_variables);
    if (settings->max_refinements < 0)
        return moray_error(MORAY_INPUT, "max_refinements = %d: must not be negative", settings->max_refinements);
    return moray_ok();
}

// What stays from mesh to mesh.
struct campaign {
    const moray_ocp *ocp;
    const moray_settings *settings;
    moray_family family;
    int stages; // of new intervals
    struct mesh *meshes;
    moray_mesh_record *history; // becomes the solution's
    int tried, widenings, escapes;
    double spent;         // of the processor, in the solver
    moray_solution *best; // of the solved ones that of the least error; often the last
    double best_error;
    int vain; // meshes since
};

static void free_meshes(struct campaign *c)
{
    for (int p = 0; c->meshes && p < c->ocp->phases; p++)
        moray_mesh_free(&c->meshes[p]);
}

// Meshes of the settings, or those of the solution that the guess comes from.
static moray_status first_meshes(struct campaign *c, const moray_guess *guess)
{
    const struct layout *other = guess && guess->from ? &guess->from->transcription->layout : NULL;
    MORAY_TRY(moray_scheme_parse(c->settings->scheme, &c->family, &c->stages));
    c->meshes = calloc((size_t)c->ocp->phases, sizeof *c->meshes);
    if (!c->meshes)
        return moray_error(MORAY_MEMORY, "no memory for %d meshes", c->ocp->phases);
    if (c->settings->intervals == 0)
        c->family = other->family;
    for (int p = 0; p < c->ocp->phases; p++)
        if (c->settings->intervals > 0)
            MORAY_TRY(moray_mesh_uniform(&c->meshes[p], c->settings->intervals, c->stages));
        else if (p < other->phases)
            MORAY_TRY(moray_mesh_copy(&c->meshes[p], &other->phase[p].mesh));
        else
            return moray_error(MORAY_INPUT, "guess: the solution has %d phases, the problem %d", other->phases,
                               c->ocp->phases);
    return moray_ok();
}

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

static moray_nlp_settings solver_settings(const moray_settings *settings, bool warm)
{
    return (moray_nlp_settings){.tolerance = settings->tolerance,
                                .max_iterations = settings->max_iterations,
                                .max_cpu_seconds = settings->max_cpu_seconds,
                                .barrier = warm ? settings->tolerance : settings->barrier,
                                .warm = warm,
                                .print_level = settings->print_level,
                                .linear_solver = settings->linear_solver,
                                .timing = settings->timing,
                                .ipopt = settings->ipopt,
                                .n_ipopt = settings->n_ipopt,
                                .progress = settings->progress,
                                .observer = settings->observer};
}

bool moray_is_solved(const moray_solution *solution)
{
    return solution->info.outcome == MORAY_NLP_SOLVED || solution->info.outcome == MORAY_NLP_ACCEPTABLE;
}

// Multipliers of a solved mesh whose error is small halve the iterations or better; of a coarse one they mislead.
static bool can_start_warm(const moray_solution *solution, const moray_guess *guess)
{
    const moray_solution *from = guess ? guess->from : NULL;
    return from && from->transcription->ocp == solution->transcription->ocp && moray_is_solved(from) &&
           from->history[from->meshes - 1].error < worst_warm_error;
}

static moray_status run_solver(moray_solution *solution, const moray_guess *guess, bool warm)
{
    struct transcription *t = solution->transcription;
    const moray_nlp_settings settings = solver_settings(&solution->settings, warm);
    MORAY_TRY(moray_fill_guess(t, guess, solution->iterate.x));
    if (solution->settings.own_scaling)
        MORAY_TRY(moray_choose_scales(t, solution->iterate.x));
    memcpy(solution->guess, solution->iterate.x, (size_t)t->nlp.n * sizeof *solution->guess);
    if (warm)
        MORAY_TRY(moray_carry_multipliers(guess->from, solution));
    return moray_ipopt_solve(&t->nlp, &settings, &solution->iterate, &solution->info);
}

static moray_status run(moray_solution *solution, const moray_guess *guess)
{
    struct transcription *t = solution->transcription;
    const bool warm = can_start_warm(solution, guess);
    MORAY_TRY(run_solver(solution, guess, warm));
    if (warm && !moray_is_solved(solution) && solution->info.outcome != MORAY_NLP_INTERRUPTED)
        MORAY_TRY(run_solver(solution, guess, false));
    if (!moray_transcription_jacobians(t, solution->iterate.x)) // accessors read the caches
        return moray_error(MORAY_NUMERIC, "at the solver's last point, %.200s", t->failure.text);
    return moray_ok();
}

static moray_status transcribe(const struct campaign *c, moray_solution *solution)
{
    MORAY_TRY(moray_transcription_new(&solution->transcription, c->ocp, c->family, c->meshes));
    return moray_allocate_iterate(solution);
}

// Transcribed with patterns that hold at the guess.
static moray_status transcribe_at_guess(const struct campaign *c, const moray_guess *guess, moray_solution *solution)
{
    int found = 1;
    MORAY_TRY(transcribe(c, solution));
    for (int k = 0; k < most_widenings && found > 0; k++) {
        MORAY_TRY(moray_fill_guess(solution->transcription, guess, solution->iterate.x));
        MORAY_TRY(moray_widen_patterns(solution->transcription, &found));
        if (found == 0)
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
    if (c->settings->max_cpu_seconds > 0)
        solution->settings.max_cpu_seconds = fmax(c->settings->max_cpu_seconds - c->spent, least_seconds);
    moray_status status = transcribe_at_guess(c, guess, solution);
    if (!moray_failed(status))
        status = run(solution, guess);
    c->spent += solution->info.cpu_seconds;
    if (moray_failed(status))
        moray_solution_free(solution);
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

static void record(struct campaign *c, moray_solution *solution, double error, int dependences)
{
    c->history[c->tried] = moray_record_of(solution, error);
    c->history[c->tried++].dependences = dependences;
    solution->history = c->history;
    solution->meshes = c->tried;
}

static void drop(moray_solution *solution)
{
    solution->history = NULL;
    moray_solution_free(solution);
}

// Solves on the meshes in c, and again from there where a function turns out to depend on more than its patterns know.
static moray_status solve_widened(struct campaign *c, const moray_guess *guess, moray_solution **result)
{
    MORAY_TRY(solve_once(c, guess, result));
    while (c->widenings < most_widenings && (*result)->info.outcome != MORAY_NLP_INTERRUPTED) {
        int found = 0;
        moray_solution *old = *result;
        moray_status status = moray_widen_patterns(old->transcription, &found);
        if (!moray_failed(status) && found == 0)
            return status;
        *result = NULL;
        if (!moray_failed(status)) {
            const moray_guess here = moray_guess_from_solution(old);
            c->widenings++;
            record(c, old, NAN, found);
            status = solve_once(c, &here, result);
        }
        drop(old);
        MORAY_TRY(status);
    }
    return moray_ok();
}

// Solves again from beside a saddle. Where that fails the saddle is the result, as it was.
static moray_status solve_beside(struct campaign *c, const double *kept, moray_solution **result)
{
    moray_solution *saddle = *result, *next = NULL;
    const moray_guess beside = moray_guess_from_solution(saddle);
    record(c, saddle, NAN, 0);
    c->escapes++;
    const moray_status status = solve_widened(c, &beside, &next);
    if (!moray_failed(status) && moray_is_solved(next)) {
        *result = next;
        drop(saddle);
        return status;
    }
    memcpy(saddle->iterate.x, kept, (size_t)saddle->transcription->nlp.n * sizeof *kept);
    moray_transcription_jacobians(saddle->transcription, saddle->iterate.x); // accessors read the caches
    if (next) {
        if (next->info.outcome == MORAY_NLP_INTERRUPTED)
            saddle->info.outcome = MORAY_NLP_INTERRUPTED;
        drop(next);
    }
    return status;
}

// Where the last step needed no regularisation the Hessian was positive definite on the constraints.
static bool may_be_saddle(const moray_solution *solution)
{
    return moray_is_solved(solution) && solution->info.regularisation != 0;
}

// Solves on the meshes in c. A start that was not a solution may have led to a saddle, as one of symmetry does.
static moray_status solve_mesh(struct campaign *c, const moray_guess *guess, moray_solution **result)
{
    MORAY_TRY(solve_widened(c, guess, result));
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

// Whether the finer meshes in c may be solved: the variables of a mesh are those of its points.
static bool within_limits(const struct campaign *c)
{
    const moray_settings *settings = c->settings;
    double variables = c->ocp->ns;
    for (int p = 0; p < c->ocp->phases; p++)
        for (int k = 0; k < c->meshes[p].intervals; k++)
            variables += c->meshes[p].stages[k] * (double)(c->ocp->phase[p].nx + c->ocp->phase[p].nu);
    return (settings->max_variables == 0 || variables <= settings->max_variables) &&
           (settings->max_cpu_seconds <= 0 || c->spent < settings->max_cpu_seconds);
}

static int intervals_at_first(const struct campaign *c)
{
    const int intervals =
        c->settings->intervals > 0 ? c->settings->intervals : c->history[0].intervals / c->ocp->phases;
    return intervals > 1 ? intervals : 1;
}

// Where a control rings on this mesh as on the one before, the meshes in c become those of the start, with Radau.
static moray_status leave_ringing(struct campaign *c, const moray_solution *solution)
{
    const int ringing = moray_is_solved(solution) ? moray_find_ringing(solution) : 0;
    const bool again = c->family == MORAY_LOBATTO && ringing > 0 && c->tried > 1 && c->history[c->tried - 2].seen > 0;
    c->history[c->tried - 1].seen = ringing;
    if (!again)
        return moray_ok();
    c->history[c->tried - 1].ringing = ringing;
    c->family = MORAY_RADAU;
    c->stages = smooth_stages;
    c->vain = 0;
    free_meshes(c);
    for (int p = 0; p < c->ocp->phases; p++)
        MORAY_TRY(moray_mesh_uniform(&c->meshes[p], intervals_at_first(c), c->stages));
    return moray_ok();
}

// Measures the mesh error and, unless it suffices or no more meshes may be tried, leaves finer meshes in c.
static moray_status record_and_refine(struct campaign *c, moray_solution *solution, bool *again)
{
    double error = NAN;
    const bool more = c->tried - c->widenings - c->escapes < c->settings->max_refinements;
    free_meshes(c);
    if (moray_is_solved(solution))
        MORAY_TRY(moray_refine(solution, c->settings->mesh_tolerance, c->stages, more ? c->meshes : NULL, &error));
    record(c, solution, error, 0);
    *again = more && error > c->settings->mesh_tolerance;
    if (*again)
        MORAY_TRY(leave_ringing(c, solution));
    *again = *again && within_limits(c);
    return moray_ok();
}

// Takes the last solution over. Of what came before, what is not the best goes.
static void take(struct campaign *c, moray_solution *last, moray_solution *old)
{
    const double error = c->history[c->tried - 1].error;
    c->vain = !c->best || error < falls * c->best_error ? 0 : c->vain + 1;
    if (!c->best || error < c->best_error) {
        if (c->best && c->best != old)
            drop(c->best);
        if (old)
            drop(old);
        c->best = last;
        c->best_error = error;
    } else if (old != c->best) {
        drop(old);
    }
}

// Solves on the finer meshes in c. Keeps the old solution where the new one is not solved.
static moray_status solve_finer(struct campaign *c, moray_solution **solution, bool *again)
{
    moray_solution *old = *solution, *finer;
    const moray_guess guess = moray_guess_from_solution(old);
    MORAY_TRY(solve_mesh(c, &guess, &finer));
    moray_status status = record_and_refine(c, finer, again);
    if (finer->info.outcome == MORAY_NLP_INTERRUPTED)
        c->best->info.outcome = MORAY_NLP_INTERRUPTED;
    if (moray_is_solved(finer) && !moray_failed(status)) {
        take(c, finer, old);
        *solution = finer;
    } else {
        drop(finer);
    }
    *again = *again && c->vain < patience;
    return status;
}

static moray_status refine_until_good(struct campaign *c, moray_solution **solution)
{
    bool again;
    MORAY_TRY(record_and_refine(c, *solution, &again));
    take(c, *solution, NULL);
    while (again)
        MORAY_TRY(solve_finer(c, solution, &again));
    return moray_ok();
}

// Of the last and the best solution, leaves the best.
static void keep_best(struct campaign *c, moray_solution **solution)
{
    if (c->best && c->best != *solution) {
        drop(*solution);
        *solution = c->best;
    }
    (*solution)->history = c->history;
    (*solution)->meshes = c->tried;
}

static moray_status run_campaign(struct campaign *c, const moray_guess *guess, moray_solution **solution)
{
    const int room = c->settings->max_refinements + 1 + most_widenings + most_escapes;
    c->history = calloc((size_t)room, sizeof *c->history);
    if (!c->history)
        return moray_error(MORAY_MEMORY, "no memory for a history of %d meshes", room);
    MORAY_TRY(solve_mesh(c, guess, solution));
    const moray_status status = refine_until_good(c, solution);
    keep_best(c, solution);
    MORAY_TRY(status);
    moray_diagnose(*solution);
    return moray_ok();
}

// Mesh after mesh until the certificate would accept what lies between the nodes, or until a limit; the best stays.
moray_status moray_solve(const moray_ocp *ocp, const moray_settings *settings, const moray_guess *guess,
                         moray_solution **solution)
{
    struct campaign c = {.ocp = ocp, .settings = settings};
    *solution = NULL;
    MORAY_TRY(check_settings(settings, guess));
    moray_status status = first_meshes(&c, guess);
    if (!moray_failed(status))
        status = run_campaign(&c, guess, solution);
    free_meshes(&c);
    free(c.meshes);
    if (moray_failed(status)) {
        if (*solution)
            drop(*solution);
        free(c.history);
        *solution = NULL;
    }
    return status;
}

void moray_solution_free(moray_solution *solution)
{
    if (!solution)
        return;
    moray_transcription_free(solution->transcription);
    free(solution->iterate.x);
    free(solution->history);
    free(solution);
}
