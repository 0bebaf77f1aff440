// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/refinement/campaign.h"
#include "ocp/refinement/family.h"
#include "ocp/refinement/refine.h"

static const double falls = 0.9;   // of the least error before: what counts as less
static const double margin = 0.98; // of the mesh tolerance: the sizes of the certificate are a little different
static const double nonsense = 1;  // error of a mesh whose solution is no start for the next
enum { patience = 8 };             // meshes in a row whose error is no less

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

void moray_campaign_free_meshes(struct campaign *c)
{
    for (int p = 0; c->meshes && p < c->ocp->phases; p++)
        moray_mesh_free(&c->meshes[p]);
}

moray_status moray_campaign_first_mesh(const struct campaign *c, int p, int intervals)
{
    const struct phase *phase = &c->ocp->phase[p];
    return moray_mesh_of(&c->meshes[p], phase->mesh, phase->intervals > 0 ? phase->intervals : intervals,
                         moray_campaign_method(c, p));
}

struct method moray_campaign_method(const struct campaign *c, int p)
{
    return c->own && c->own[p].stages > 0 ? c->own[p] : c->method;
}

// One name for all phases that have no scheme of their own, or one for each, with commas between.
static moray_status read_schemes(struct campaign *c)
{
    const char *name = c->settings->scheme;
    const int phases = c->ocp->phases;
    int names = 0;
    for (int p = 0; p < phases; p++)
        c->own[p] = c->ocp->phase[p].method;
    if (!strchr(name, ','))
        return moray_scheme_parse(name, &c->method.family, &c->method.stages);
    for (; name; name = strchr(name, ','), names++) {
        char one[40];
        name += *name == ',';
        snprintf(one, sizeof one, "%.*s", (int)strcspn(name, ","), name);
        MORAY_TRY(moray_scheme_parse(one, &c->method.family, &c->method.stages));
        if (names < phases)
            c->own[names] = c->method;
    }
    if (names != phases)
        return moray_error(MORAY_INPUT, "scheme = %.80s: %d names for %d phases", c->settings->scheme, names, phases);
    return moray_ok();
}

// The mesh of the solution that the guess comes from.
static moray_status continued_mesh(struct campaign *c, const struct layout *other, int p)
{
    if (p >= other->phases)
        return moray_error(MORAY_INPUT, "guess: the solution has %d phases, the problem %d", other->phases,
                           c->ocp->phases);
    struct method *method = &c->meshes[p].method;
    MORAY_TRY(moray_mesh_copy(&c->meshes[p], &other->phase[p].mesh));
    method->stages = moray_campaign_method(c, p).stages;
    if (method->family == MORAY_LOBATTO && method->stages < 2)
        method->stages = 2;
    if (c->own[p].stages > 0)
        c->own[p] = *method;
    else
        c->method = *method;
    return moray_ok();
}

// Meshes of the settings, or those of the solution that the guess comes from.
static moray_status first_meshes(struct campaign *c, const moray_guess *guess)
{
    const int phases = c->ocp->phases;
    c->meshes = calloc((size_t)phases, sizeof *c->meshes);
    c->own = calloc((size_t)phases, sizeof *c->own);
    if (!c->meshes || !c->own)
        return moray_error(MORAY_MEMORY, "no memory for %d meshes", phases);
    MORAY_TRY(read_schemes(c));
    for (int p = 0; p < phases; p++)
        MORAY_TRY(c->settings->intervals > 0 ? moray_campaign_first_mesh(c, p, c->settings->intervals)
                                             : continued_mesh(c, &guess->from->transcription->layout, p));
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

static bool may_refine(const struct campaign *c)
{
    const int aside = c->widenings + c->escapes + c->moves + c->restarts;
    return c->tried - aside < c->settings->max_refinements;
}

// Measures the mesh error and, unless it suffices or no more meshes may be tried, leaves finer meshes in c.
static moray_status record_and_refine(struct campaign *c, moray_solution *solution, bool *again)
{
    double error = NAN;
    const double tolerance = margin * c->settings->mesh_tolerance;
    const bool more = may_refine(c);
    moray_campaign_free_meshes(c);
    if (moray_is_solved(solution))
        MORAY_TRY(moray_refine(solution, tolerance, more ? c->meshes : NULL, &error));
    moray_campaign_record(c, solution, error, 0);
    *again = more && error > tolerance;
    if (*again)
        MORAY_TRY(moray_leave_ringing(c, solution));
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
            moray_campaign_drop(c->best);
        if (old)
            moray_campaign_drop(old);
        c->best = last;
        c->best_error = error;
    } else if (old != c->best) {
        moray_campaign_drop(old);
    }
}

// Solves on the finer meshes in c. Keeps the old solution where the new one is not solved.
static moray_status solve_finer(struct campaign *c, moray_solution **solution, bool *again)
{
    moray_solution *old = *solution, *finer;
    const moray_guess guess = moray_guess_from_solution(old);
    MORAY_TRY(moray_campaign_solve(c, c->best_error < nonsense ? &guess : c->guess, &finer));
    moray_status status = record_and_refine(c, finer, again);
    if (finer->info.outcome == MORAY_NLP_INTERRUPTED)
        c->best->info.outcome = MORAY_NLP_INTERRUPTED;
    if (moray_is_solved(finer) && !moray_failed(status)) {
        take(c, finer, old);
        *solution = finer;
    } else {
        moray_campaign_drop(finer);
    }
    *again = *again && c->vain < patience;
    return status;
}

static moray_status refine_until_good(struct campaign *c, moray_solution **solution)
{
    bool again;
    MORAY_TRY(record_and_refine(c, *solution, &again));
    take(c, *solution, NULL);
    while (again) {
        MORAY_TRY(solve_finer(c, solution, &again));
        if (may_refine(c) && moray_is_no_better(c, again)) {
            MORAY_TRY(moray_go_back(c, solution));
            again = within_limits(c);
        }
    }
    return moray_ok();
}

// Of the last and the best solution, leaves the best.
static void keep_best(struct campaign *c, moray_solution **solution)
{
    if (c->best && c->best != *solution) {
        moray_campaign_drop(*solution);
        *solution = c->best;
    }
    (*solution)->history = c->history;
    (*solution)->meshes = c->tried;
    (*solution)->iterations = c->iterations;
}

static moray_status run_campaign(struct campaign *c, const moray_guess *guess, moray_solution **solution)
{
    const int room = c->settings->max_refinements + 1 + most_widenings + most_escapes + most_moves + most_restarts;
    c->history = calloc((size_t)room, sizeof *c->history);
    c->iterations = calloc(1, sizeof *c->iterations);
    if (!c->history || !c->iterations)
        return moray_error(MORAY_MEMORY, "no memory for a history of %d meshes", room);
    c->iterations->progress = c->settings->progress;
    c->iterations->observer = c->settings->observer;
    MORAY_TRY(moray_campaign_solve(c, guess, solution));
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
    struct campaign c = {.ocp = ocp, .settings = settings, .guess = guess};
    *solution = NULL;
    MORAY_TRY(check_settings(settings, guess));
    moray_status status = first_meshes(&c, guess);
    if (!moray_failed(status))
        status = run_campaign(&c, guess, solution);
    moray_campaign_free_meshes(&c);
    free(c.meshes);
    free(c.own);
    if (moray_failed(status)) {
        if (*solution)
            moray_campaign_drop(*solution);
        free(c.history);
        moray_iterations_free(c.iterations);
        *solution = NULL;
    }
    return status;
}
