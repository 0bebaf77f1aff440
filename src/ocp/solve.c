// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "ocp/solution.h"

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

static moray_status check_settings(const moray_settings *settings)
{
    if (settings->intervals < 1)
        return moray_error(MORAY_INPUT, "intervals = %d: must be at least 1", settings->intervals);
    if (!(settings->tolerance > 0 && settings->tolerance < 1))
        return moray_error(MORAY_INPUT, "tolerance = %g: must lie between 0 and 1", settings->tolerance);
    if (!(settings->mesh_tolerance > 0))
        return moray_error(MORAY_INPUT, "mesh_tolerance = %g: must be positive", settings->mesh_tolerance);
    if (settings->max_iterations < 0)
        return moray_error(MORAY_INPUT, "max_iterations = %d: must not be negative", settings->max_iterations);
    return moray_ok();
}

static moray_status transcribe(const moray_ocp *ocp, const moray_settings *settings, struct transcription **t)
{
    moray_family family;
    int stages;
    MORAY_TRY(moray_scheme_parse(settings->scheme, &family, &stages));
    struct mesh *meshes = calloc((size_t)ocp->phases, sizeof *meshes);
    moray_status status = meshes ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d meshes", ocp->phases);
    for (int p = 0; p < ocp->phases && !moray_failed(status); p++)
        status = mesh_uniform(&meshes[p], settings->intervals, stages);
    if (!moray_failed(status))
        status = transcription_new(t, ocp, family, meshes);
    for (int p = 0; meshes && p < ocp->phases; p++)
        mesh_free(&meshes[p]);
    free(meshes);
    return status;
}

static moray_status allocate_iterate(moray_solution *solution)
{
    const int n = solution->transcription->nlp.n, m = solution->transcription->nlp.m;
    double *block = calloc((size_t)(3 * n + 2 * m), sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for %d variables", n);
    solution->iterate = (moray_iterate){
        .x = block, .z_lower = block + n, .z_upper = block + 2 * n, .g = block + 3 * n, .lambda = block + 3 * n + m};
    return moray_ok();
}

static moray_status run(moray_solution *solution, const moray_guess *guess)
{
    struct transcription *t = solution->transcription;
    const moray_settings *settings = &solution->settings;
    MORAY_TRY(fill_guess(t, guess, solution->iterate.x));
    if (settings->own_scaling)
        MORAY_TRY(choose_scales(t, solution->iterate.x));
    const moray_nlp_settings nlp_settings = {.tolerance = settings->tolerance,
                                             .max_iterations = settings->max_iterations,
                                             .barrier = settings->barrier,
                                             .print_level = settings->print_level,
                                             .progress = settings->progress,
                                             .observer = settings->observer};
    MORAY_TRY(moray_ipopt_solve(&t->nlp, &nlp_settings, &solution->iterate, &solution->info));
    if (!transcription_jacobians(t, solution->iterate.x)) // accessors read the caches
        return moray_error(MORAY_NUMERIC, "at the solver's last point, %.200s", t->failure.text);
    diagnose(solution);
    return moray_ok();
}

moray_status moray_solve(const moray_ocp *ocp, const moray_settings *settings, const moray_guess *guess,
                         moray_solution **result)
{
    *result = NULL;
    MORAY_TRY(check_settings(settings));
    moray_solution *solution = calloc(1, sizeof *solution);
    if (!solution)
        return moray_error(MORAY_MEMORY, "no memory for a solution");
    solution->settings = *settings;
    moray_status status = transcribe(ocp, settings, &solution->transcription);
    if (!moray_failed(status))
        status = allocate_iterate(solution);
    if (!moray_failed(status))
        status = run(solution, guess);
    if (moray_failed(status))
        moray_solution_free(solution);
    else
        *result = solution;
    return status;
}

void moray_solution_free(moray_solution *solution)
{
    if (!solution)
        return;
    transcription_free(solution->transcription);
    free(solution->iterate.x);
    free(solution);
}
