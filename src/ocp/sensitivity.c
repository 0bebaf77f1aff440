// SPDX-License-Identifier: MIT
#include "moray/sensitivity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/names.h"
#include "ocp/solution.h"

enum { weak_size = 1000, weak_names = 5, name_size = 160 };

struct moray_sensitivity {
    const moray_solution *solution;
    moray_nlp_sensitivity *factors;
    double *block;                                                // owns all of:
    double *gradient, *g, *x_lower, *x_upper, *g_lower, *g_upper; // of shift
    double *t0, *tf;                                              // [phases] slopes of the times that are fixed
    double *here;                                                 // scratch [n + m]
    moray_nlp_shift shift;
    moray_iterate slope;
    char weak[weak_size];
};

static void constraint_name(const moray_sensitivity *s, int i, char *name)
{
    const struct transcription *t = s->solution->transcription;
    const double *x = s->solution->iterate.x;
    if (i < t->nlp.m)
        moray_layout_row_name(&t->layout, t->ocp, x, i, name, name_size);
    else
        moray_layout_column_name(&t->layout, t->ocp, x, i - t->nlp.m, name, name_size);
}

static void name_weak(moray_sensitivity *s)
{
    int weak[weak_names], used = 0;
    const int n = moray_nlp_sensitivity_weak(s->factors, weak, weak_names);
    for (int k = 0; k < n && k < weak_names; k++) {
        char name[name_size];
        constraint_name(s, weak[k], name);
        used += snprintf(s->weak + used, (size_t)(weak_size - used), "%s%s", k > 0 ? "; " : "", name);
    }
    if (n > weak_names)
        snprintf(s->weak + used, (size_t)(weak_size - used), "; and %d more", n - weak_names);
}

static moray_status allocate(moray_sensitivity *s)
{
    const moray_nlp *nlp = &s->solution->transcription->nlp;
    const size_t n = (size_t)nlp->n, m = (size_t)nlp->m;
    const int phases = s->solution->transcription->ocp->phases;
    s->block = calloc(7 * n + 6 * m + 2 * (size_t)phases, sizeof *s->block);
    if (!s->block)
        return moray_error(MORAY_MEMORY, "no memory for the sensitivities of %d variables", nlp->n);
    double *next = s->block;
    double **const of_columns[] = {&s->gradient, &s->x_lower,       &s->x_upper,
                                   &s->slope.x,  &s->slope.z_lower, &s->slope.z_upper};
    double **const of_rows[] = {&s->g, &s->g_lower, &s->g_upper, &s->slope.g, &s->slope.lambda};
    for (unsigned i = 0; i < sizeof of_columns / sizeof *of_columns; i++, next += n)
        *of_columns[i] = next;
    for (unsigned i = 0; i < sizeof of_rows / sizeof *of_rows; i++, next += m)
        *of_rows[i] = next;
    s->t0 = next;
    s->tf = next + phases;
    s->here = s->tf + phases;
    return moray_ok();
}

moray_status moray_sensitivity_new(moray_sensitivity **result, const moray_solution *solution)
{
    *result = NULL;
    if (!moray_is_solved(solution))
        return moray_error(MORAY_NOT_SOLVED, "sensitivities are those of an optimum, and this is none: %s",
                           moray_nlp_outcome_text(solution->info.outcome));
    moray_sensitivity *s = calloc(1, sizeof *s);
    if (!s)
        return moray_error(MORAY_MEMORY, "no memory for sensitivities");
    s->solution = solution;
    moray_status status = allocate(s);
    if (!moray_failed(status))
        status = moray_nlp_sensitivity_new(&s->factors, &solution->transcription->nlp, &solution->iterate);
    if (moray_failed(status)) {
        moray_sensitivity_free(s);
        return status;
    }
    name_weak(s);
    *result = s;
    return moray_ok();
}

void moray_sensitivity_free(moray_sensitivity *s)
{
    if (!s)
        return;
    moray_nlp_sensitivity_free(s->factors);
    free(s->block);
    free(s);
}

const char *moray_sensitivity_weak(const moray_sensitivity *s)
{
    return s->weak;
}

// ---- What the parameter does ---------------------------------------------------------------------------------------

// Another problem on the mesh of the solution.
static moray_status on_same_mesh(const moray_solution *solution, const moray_ocp *ocp, struct transcription **result)
{
    const struct transcription *own = solution->transcription;
    *result = NULL;
    if (ocp->phases != own->ocp->phases)
        return moray_error(MORAY_INPUT, "a displaced problem has %d phases, the solution %d", ocp->phases,
                           own->ocp->phases);
    struct mesh *meshes = calloc((size_t)ocp->phases, sizeof *meshes);
    if (!meshes)
        return moray_error(MORAY_MEMORY, "no memory for %d meshes", ocp->phases);
    for (int p = 0; p < ocp->phases; p++)
        meshes[p] = own->layout.phase[p].mesh;
    moray_status status = moray_transcription_new(result, ocp, meshes);
    free(meshes);
    if (moray_failed(status) || ((*result)->nlp.n == own->nlp.n && (*result)->nlp.m == own->nlp.m))
        return status;
    status = moray_error(MORAY_INPUT, "a displaced problem has %d variables and %d constraints, the solution %d and %d",
                         (*result)->nlp.n, (*result)->nlp.m, own->nlp.n, own->nlp.m);
    moray_transcription_free(*result);
    *result = NULL;
    return status;
}

// Of bounds that do not exist nobody asks the sum.
static void add_all(double *sum, double weight, const double *values, int n)
{
    for (int i = 0; i < n; i++)
        sum[i] += weight * values[i];
}

static void add_fixed_times(moray_sensitivity *s, double weight, const moray_ocp *ocp)
{
    for (int p = 0; p < ocp->phases; p++) {
        s->t0[p] += weight * ocp->phase[p].t0.lower;
        s->tf[p] += weight * ocp->phase[p].tf.lower;
    }
}

static moray_status add_lagrangian(moray_sensitivity *s, const moray_nlp *nlp, double weight)
{
    const moray_iterate *at = &s->solution->iterate;
    double *jac = calloc((size_t)nlp->nnz_jac + 1, sizeof *jac);
    if (!jac)
        return moray_error(MORAY_MEMORY, "no memory for a Jacobian of %d entries", nlp->nnz_jac);
    const bool ok = nlp->gradient(nlp->self, at->x, false, s->here) && nlp->jacobian(nlp->self, at->x, false, jac);
    add_all(s->gradient, weight, s->here, nlp->n);
    for (int k = 0; k < nlp->nnz_jac; k++)
        s->gradient[nlp->jac_col[k]] += weight * at->lambda[nlp->jac_row[k]] * jac[k];
    free(jac);
    return ok ? moray_ok() : moray_error(MORAY_NUMERIC, "a derivative is not finite");
}

// Adds weight times objective, gradient of the Lagrangian, constraints and bounds of a displaced problem.
static moray_status add(moray_sensitivity *s, struct transcription *t, double weight)
{
    const moray_nlp *nlp = &t->nlp;
    double f, *x = s->solution->iterate.x, *g = s->here;
    if (!nlp->objective(t, x, true, &f) || !nlp->constraints(t, x, false, g))
        return moray_error(MORAY_NUMERIC, "in a displaced problem, %s", t->failure.text);
    s->shift.objective += weight * f;
    add_all(s->g, weight, g, nlp->m);
    add_all(s->x_lower, weight, nlp->x_lower, nlp->n);
    add_all(s->x_upper, weight, nlp->x_upper, nlp->n);
    add_all(s->g_lower, weight, nlp->g_lower, nlp->m);
    add_all(s->g_upper, weight, nlp->g_upper, nlp->m);
    add_fixed_times(s, weight, t->ocp);
    return add_lagrangian(s, nlp, weight);
}

moray_status moray_sensitivity_by(moray_sensitivity *s, const moray_ocp *const displaced[4], double h)
{
    static const double stencil[] = {1 / 12.0, -8 / 12.0, 8 / 12.0, -1 / 12.0};
    static const int order[] = {0, 3, 1, 2}; // by pairs, so that what stands still sums to 0 exactly
    if (!(h > 0 && isfinite(h)))
        return moray_error(MORAY_INPUT, "h = %g: must be finite and above 0", h);
    memset(s->block, 0, (size_t)(s->here - s->block) * sizeof *s->block);
    s->shift = (moray_nlp_shift){0, s->gradient, s->g, s->x_lower, s->x_upper, s->g_lower, s->g_upper};
    for (int i = 0; i < 4; i++) {
        const int k = order[i];
        struct transcription *t;
        MORAY_TRY(on_same_mesh(s->solution, displaced[k], &t));
        const moray_status status = add(s, t, stencil[k] / h);
        moray_transcription_free(t);
        MORAY_TRY(status);
    }
    return moray_nlp_sensitivity_solve(s->factors, &s->shift, &s->slope);
}

// ---- Derivatives ---------------------------------------------------------------------------------------------------

double moray_sensitivity_objective(const moray_sensitivity *s)
{
    return s->slope.objective;
}

const double *moray_sensitivity_parameters(const moray_sensitivity *s)
{
    return s->slope.x + s->solution->transcription->layout.s;
}

const double *moray_sensitivity_integrals(const moray_sensitivity *s, int phase)
{
    return s->slope.x + s->solution->transcription->layout.phase[phase].q;
}

void moray_sensitivity_times(const moray_sensitivity *s, int phase, double *t0, double *tf)
{
    const struct phase_layout *layout = &s->solution->transcription->layout.phase[phase];
    *t0 = layout->t0 != absent ? s->slope.x[layout->t0] : s->t0[phase];
    *tf = layout->tf != absent ? s->slope.x[layout->tf] : s->tf[phase];
}

void moray_sensitivity_ends(const moray_sensitivity *s, int phase, double *x0, double *xf)
{
    const struct transcription *t = s->solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[phase];
    const size_t size = (size_t)t->ocp->phase[phase].nx * sizeof *x0;
    memcpy(x0, s->slope.x + layout->node[0].x, size);
    memcpy(xf, s->slope.x + layout->node[layout->nodes - 1].x, size);
}

moray_active_change moray_sensitivity_change(const moray_sensitivity *s, int direction)
{
    const moray_nlp_change change = moray_nlp_sensitivity_change(s->factors, &s->shift, &s->slope, direction);
    moray_active_change named = {.step = change.step};
    char name[name_size];
    if (change.constraint < 0)
        return named;
    constraint_name(s, change.constraint, name);
    snprintf(named.what, sizeof named.what, "%s would %s its %s bound", name, change.leaves ? "leave" : "pass",
             change.upper ? "upper" : "lower");
    return named;
}

// ---- Prediction ----------------------------------------------------------------------------------------------------

static void extrapolate(const moray_sensitivity *s, double step, moray_solution *to)
{
    const moray_nlp *nlp = &to->transcription->nlp;
    const moray_iterate *from = &s->solution->iterate, *slope = &s->slope;
    moray_iterate *it = &to->iterate;
    for (int j = 0; j < nlp->n; j++) {
        it->x[j] = fmin(fmax(from->x[j] + step * slope->x[j], nlp->x_lower[j]), nlp->x_upper[j]);
        it->z_lower[j] = fmax(from->z_lower[j] + step * slope->z_lower[j], 0);
        it->z_upper[j] = fmax(from->z_upper[j] + step * slope->z_upper[j], 0);
    }
    for (int i = 0; i < nlp->m; i++)
        it->lambda[i] = from->lambda[i] + step * slope->lambda[i];
}

static moray_status predict(const moray_sensitivity *s, const moray_ocp *problem, double step, moray_solution *to)
{
    to->settings = s->solution->settings;
    to->info.outcome = MORAY_NLP_ITERATION_LIMIT;
    MORAY_TRY(on_same_mesh(s->solution, problem, &to->transcription));
    MORAY_TRY(moray_allocate_iterate(to));
    extrapolate(s, step, to);
    MORAY_TRY(moray_complete_solution(to));
    to->iterate.objective = to->transcription->end_out[0];
    return moray_ok();
}

moray_status moray_sensitivity_predict(const moray_sensitivity *s, const moray_ocp *problem, double step,
                                       moray_solution **predicted)
{
    *predicted = NULL;
    moray_solution *to = calloc(1, sizeof *to);
    if (!to)
        return moray_error(MORAY_MEMORY, "no memory for a prediction");
    const moray_status status = predict(s, problem, step, to);
    if (moray_failed(status))
        moray_solution_free(to);
    else
        *predicted = to;
    return status;
}
