// SPDX-License-Identifier: MIT
//
// A second solve from the solution of the first.
#include "ocp/solve_again.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/guess_sizes.h"
#include "ocp/transcription.h"

static const double out_of_scale = 1e-3; // of what a duration was scaled by
static const double loose = 1e-6;        // of a state: what defects in it may be
static const double far_inside = 0.3;    // of the gap that the certificate allows
static const double closer = 0.1;        // of the tolerance before
enum { usual_bounds = 1500 };            // that a barrier is meant for

static bool is_bound(double bound)
{
    return fabs(bound) < MORAY_ENDLESS;
}

static int count_bounds(const double *lower, const double *upper, int n)
{
    int count = 0;
    for (int k = 0; k < n; k++)
        if (lower[k] < upper[k])
            count += is_bound(lower[k]) + is_bound(upper[k]);
    return count;
}

// A limit along a phase is as many bounds as its mesh has nodes: from a start that is nearly right the barrier of many
// would lead inside, far away, unless each of them weighs less.
static double first_barrier(const moray_solution *solution)
{
    const moray_nlp *nlp = &solution->transcription->nlp;
    const double asked = solution->settings.barrier;
    const int bounds =
        count_bounds(nlp->x_lower, nlp->x_upper, nlp->n) + count_bounds(nlp->g_lower, nlp->g_upper, nlp->m);
    return solution->settings.barrier_shared && bounds > usual_bounds ? asked * usual_bounds / bounds : asked;
}

moray_nlp_settings moray_solver_settings(const moray_solution *solution, bool warm)
{
    const moray_settings *settings = &solution->settings;
    return (moray_nlp_settings){.tolerance = settings->tolerance,
                                .max_iterations = settings->max_iterations,
                                .max_cpu_seconds = settings->max_cpu_seconds,
                                .barrier = warm ? settings->tolerance : first_barrier(solution),
                                .warm = warm,
                                .print_level = settings->print_level,
                                .linear_solver = settings->linear_solver,
                                .timing = settings->timing,
                                .ipopt = settings->ipopt,
                                .n_ipopt = settings->n_ipopt,
                                .progress = moray_iterations_keep,
                                .observer = solution->iterations};
}

static void add(moray_nlp_info *sum, const moray_nlp_info *more)
{
    sum->iterations += more->iterations;
    sum->seconds += more->seconds;
    sum->cpu_seconds += more->cpu_seconds;
    sum->evaluation_seconds += more->evaluation_seconds;
    sum->linear_seconds += more->linear_seconds;
    for (int k = 0; k < 5; k++) {
        sum->evaluations[k] += more->evaluations[k];
        sum->evaluation_by[k] += more->evaluation_by[k];
    }
}

// ---- Scales --------------------------------------------------------------------------------------------------------

static bool is_small(double scaled)
{
    return fabs(scaled) < out_of_scale && !moray_is_rounding(scaled, 1);
}

static double largest_defect(const moray_solution *solution, int p, int state)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    const int nx = solution->transcription->ocp->phase[p].nx;
    double largest = 0;
    for (int k = 0; k < layout->mesh.intervals; k++)
        for (int i = 0; i < layout->interval[k].scheme->points - 1; i++)
            largest = fmax(largest, fabs(solution->iterate.g[layout->interval[k].defect + i * nx + state]));
    return largest;
}

// Whether a state is far smaller than what it was scaled by, and its dynamics hold to that alone.
static bool is_loose(const moray_solution *solution, int p, int state)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    const double largest = moray_largest_in_phase(layout, solution->iterate.x, state);
    return moray_is_far_below(largest, 1 / solution->transcription->nlp.x_scale[layout->node[0].x + state]) &&
           largest_defect(solution, p, state) > loose * largest;
}

// Whether a duration, an integral or a state that was found is far smaller than what it was scaled by: a guess of one
// unit of time, where nothing better is known; bounds that are far from what is used of them.
static bool is_out_of_scale(const moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    for (int p = 0; p < t->ocp->phases; p++) {
        double t0, tf;
        const struct phase_layout *layout = &t->layout.phase[p];
        moray_layout_span(&t->layout, t->ocp, solution->iterate.x, p, &t0, &tf);
        if (layout->tf != absent && is_small((tf - t0) * t->nlp.x_scale[layout->tf]))
            return true;
        for (int m = layout->q; m < layout->q + t->ocp->phase[p].nq; m++)
            if (is_small(solution->iterate.x[m] * t->nlp.x_scale[m]))
                return true;
        for (int r = 0; r < t->ocp->phase[p].nx; r++)
            if (is_loose(solution, p, r))
                return true;
    }
    return false;
}

// Once more from the solution, with scales of its own.
static moray_status solve_in_scale(moray_solution *solution)
{
    struct transcription *t = solution->transcription;
    const moray_nlp_settings settings = moray_solver_settings(solution, true);
    MORAY_TRY(moray_iterations_room(solution->iterations, settings.max_iterations));
    MORAY_TRY(moray_choose_scales(t, solution->iterate.x, by_solution));
    return moray_ipopt_solve(&t->nlp, &settings, &solution->iterate, &solution->info);
}

// ---- Slacks --------------------------------------------------------------------------------------------------------

// An absent bound is a large number, not infinite.
static double product(double multiplier, double slack)
{
    return slack > 0 && is_bound(slack) && multiplier > 0 ? multiplier * slack : 0;
}

// What multipliers times slacks hold the objective from, relative to it: the barrier leaves about as much at every
// bound, and of many bounds that adds up.
static double gap_of(const moray_solution *solution)
{
    const moray_nlp *nlp = &solution->transcription->nlp;
    const moray_iterate *at = &solution->iterate;
    double sum = 0;
    for (int j = 0; j < nlp->n; j++)
        if (nlp->x_lower[j] < nlp->x_upper[j])
            sum += product(at->z_lower[j], at->x[j] - nlp->x_lower[j]) +
                   product(at->z_upper[j], nlp->x_upper[j] - at->x[j]);
    for (int i = 0; i < nlp->m; i++)
        if (nlp->g_lower[i] < nlp->g_upper[i])
            sum += product(at->lambda[i], nlp->g_upper[i] - at->g[i]) +
                   product(-at->lambda[i], at->g[i] - nlp->g_lower[i]);
    return sum / fabs(at->objective);
}

// To a smaller tolerance; where that is not reached, the solution stays as it was.
static moray_status solve_closer(moray_solution *solution)
{
    const moray_nlp *nlp = &solution->transcription->nlp;
    const size_t size = (size_t)(4 * nlp->n + 2 * nlp->m) * sizeof(double);
    moray_nlp_settings settings = moray_solver_settings(solution, true);
    const moray_nlp_info first = solution->info;
    const double objective = solution->iterate.objective;
    double *kept = malloc(size);
    if (!kept)
        return moray_error(MORAY_MEMORY, "no memory to solve %d variables more closely", nlp->n);
    memcpy(kept, solution->iterate.x, size);
    settings.barrier = settings.tolerance *= closer;
    moray_status status = moray_iterations_room(solution->iterations, settings.max_iterations);
    if (!moray_failed(status))
        status = moray_ipopt_solve(nlp, &settings, &solution->iterate, &solution->info);
    if (!moray_failed(status) && moray_is_solved(solution))
        add(&solution->info, &first);
    else if (!moray_failed(status)) {
        memcpy(solution->iterate.x, kept, size);
        solution->iterate.objective = objective;
        solution->info = first;
    }
    free(kept);
    return status;
}

// Between what counts and what a tenth of it would still be too much: there the objective is near 0, and no measure.
static bool is_inside(const moray_solution *solution)
{
    const double gap = gap_of(solution);
    return moray_is_solved(solution) && gap > far_inside * MORAY_LIMIT_GAP && gap < MORAY_LIMIT_GAP / closer;
}

moray_status moray_solve_again(moray_solution *solution)
{
    const moray_nlp_info first = solution->info;
    if (solution->settings.own_scaling && is_out_of_scale(solution)) {
        MORAY_TRY(solve_in_scale(solution));
        add(&solution->info, &first);
    }
    return !solution->settings.rough && is_inside(solution) ? solve_closer(solution) : moray_ok();
}
