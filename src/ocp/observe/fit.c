// SPDX-License-Identifier: MIT
//
// Covariance of the parameters: the parameters' block of the inverse of
//     [ A' W A + e D   J' ]
//     [ J              0  ]
// with the Jacobian A of the predictions, and J of the active constraints, in sizes of variables and data. e D, which
// is tiny, makes regular what the data leave open: there the block grows as 1 / e, and that tells.
#include "moray/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear/ldl.h"
#include "ocp/certificate/witness.h"
#include "ocp/names.h"

static const double floor_of_parameters = 1e-12; // e D: information, where that of all data is 1, that counts as none
static const double floor_of_others = 1e-18;
static const double open_part = 1e-3; // of a parameter: in directions that the data leave open
static const double regularity = 1e-14, active = 1e-6, safe = 1e-2;

struct inverse {
    const moray_solution *solution;
    const struct transcription *t;
    double *column, *row, *jac, *info, *values, *rhs; // [n], [m], [nnz_jac], ...
    int *info_row, *info_col, entries;                // of the information, as columns of the programme
    bool *held;                                       // [n] at a bound, then [m] not active
    double data;                                      // weighted sum of the squares of all data
    moray_pattern pattern;
    moray_ldl *ldl;
};

static moray_status no_memory(void)
{
    return moray_error(MORAY_MEMORY, "no memory for the covariance of the parameters");
}

static moray_status allocate(struct inverse *v)
{
    const moray_nlp *nlp = &v->t->nlp;
    const size_t n = (size_t)nlp->n, m = (size_t)nlp->m;
    v->entries = moray_fit_information(v->t->fit, v->t->end_in, NULL, NULL, NULL);
    const size_t entries = (size_t)v->entries, total = n + m + (size_t)nlp->nnz_jac + entries;
    v->column = calloc(2 * n + 2 * m + (size_t)nlp->nnz_jac + entries + total + 1, sizeof *v->column);
    v->info_row = calloc(2 * entries + 1, sizeof *v->info_row);
    v->held = calloc(n + m + 1, sizeof *v->held);
    if (!v->column || !v->info_row || !v->held)
        return no_memory();
    v->row = v->column + n;
    v->rhs = v->row + m;
    v->jac = v->rhs + n + m;
    v->info = v->jac + nlp->nnz_jac;
    v->values = v->info + entries;
    v->info_col = v->info_row + entries;
    return moray_pattern_new(&v->pattern, (int)total);
}

static void release(struct inverse *v)
{
    free(v->column);
    free(v->info_row);
    free(v->held);
    moray_pattern_free(&v->pattern);
    moray_ldl_free(v->ldl);
}

// ---- What is active ----

static moray_status measure(struct inverse *v, double *objective)
{
    struct witness w;
    MORAY_TRY(moray_witness_of_sizes(&w, v->solution));
    moray_witness_columns(&w, v->column);
    moray_witness_rows(&w, v->row);
    *objective = moray_witness_objective(&w);
    moray_witness_free(&w);
    return moray_ok();
}

static void find_held(struct inverse *v, double objective)
{
    const moray_nlp *nlp = &v->t->nlp;
    const moray_iterate *at = &v->solution->iterate;
    for (int j = 0; j < nlp->n; j++) {
        const double size = v->column[j], most = active * objective / size;
        v->held[j] = nlp->x_lower[j] == nlp->x_upper[j] ||
                     (at->z_lower[j] > most && at->x[j] - nlp->x_lower[j] < active * size) ||
                     (at->z_upper[j] > most && nlp->x_upper[j] - at->x[j] < active * size);
    }
    for (int i = 0; i < nlp->m; i++)
        v->held[nlp->n + i] =
            nlp->g_lower[i] != nlp->g_upper[i] && !(fabs(at->lambda[i]) * v->row[i] > active * objective);
}

static int count_free(const struct inverse *v)
{
    int free_ones = 0;
    for (int j = 0; j < v->t->nlp.n; j++)
        free_ones += !v->held[j];
    for (int i = 0; i < v->t->nlp.m; i++)
        free_ones -= !v->held[v->t->nlp.n + i];
    return free_ones;
}

// ---- The matrix ----

static void take_information(struct inverse *v)
{
    const struct transcription *t = v->t;
    moray_fit_information(t->fit, t->end_in, v->info_row, v->info_col, v->info);
    for (int e = 0; e < v->entries; e++) {
        const int i = t->end_column[v->info_row[e]], j = t->end_column[v->info_col[e]];
        v->info_row[e] = i > j ? i : j;
        v->info_col[e] = i > j ? j : i;
    }
}

static void fill(struct inverse *v)
{
    const moray_nlp *nlp = &v->t->nlp;
    const int n = nlp->n, m = nlp->m, s = v->t->layout.s, ns = v->t->ocp->ns;
    int k = 0;
    for (; k < n + m; k++) {
        v->pattern.row[k] = v->pattern.col[k] = k;
        const double floor = k >= s && k < s + ns ? floor_of_parameters : floor_of_others;
        v->values[k] = k < n ? (v->held[k] ? 1 : floor) : v->held[k] ? -1 : -regularity;
    }
    for (int e = 0; e < nlp->nnz_jac; e++, k++) {
        const int i = nlp->jac_row[e], j = nlp->jac_col[e];
        v->pattern.row[k] = n + i, v->pattern.col[k] = j;
        v->values[k] = v->held[j] || v->held[n + i] ? 0 : v->jac[e] * v->column[j] / v->row[i];
    }
    for (int e = 0; e < v->entries; e++, k++) {
        const int i = v->info_row[e], j = v->info_col[e];
        const bool none = v->held[i] || v->held[j];
        v->pattern.row[k] = none ? 0 : i, v->pattern.col[k] = none ? 0 : j;
        v->values[k] = none ? 0 : v->info[e] * v->column[i] * v->column[j] / v->data;
    }
}

static moray_status factor(struct inverse *v)
{
    const moray_nlp *nlp = &v->t->nlp;
    double objective;
    MORAY_TRY(measure(v, &objective));
    find_held(v, objective);
    if (!nlp->jacobian(nlp->self, v->solution->iterate.x, true, v->jac))
        return moray_error(MORAY_NUMERIC, "at the solution, %s", v->t->failure.text);
    take_information(v);
    fill(v);
    MORAY_TRY(moray_ldl_new(&v->ldl, nlp->n + nlp->m, &v->pattern));
    return moray_ldl_factor(v->ldl, v->values, safe);
}

// ---- The result ----

static void name_open(const moray_fit *fit, const moray_ocp *ocp, char *text, size_t size)
{
    size_t used = 0;
    for (int i = 0; i < fit->ns; i++) {
        char name[120];
        if (!isinf(fit->error[i]) || used >= size)
            continue;
        moray_function_entry_name("parameter", "s", ocp->s_names, i, name, sizeof name);
        used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "", name + strlen("parameter "));
    }
}

// The row of a parameter; one held at its bound does not vary.
static moray_status solve_row(struct inverse *v, moray_fit *fit, int i)
{
    const int n = v->t->nlp.n, m = v->t->nlp.m, s = v->t->layout.s;
    memset(v->rhs, 0, (size_t)(n + m) * sizeof *v->rhs);
    v->rhs[s + i] = v->held[s + i] ? 0 : 1;
    MORAY_TRY(moray_ldl_solve(v->ldl, 1, v->rhs));
    const bool open = floor_of_parameters * v->rhs[s + i] > open_part;
    const double unit = fit->variance * v->column[s + i] / v->data;
    fit->undetermined += open;
    for (int j = 0; j < fit->ns; j++)
        fit->covariance[i * fit->ns + j] = open ? NAN : unit * v->column[s + j] * v->rhs[s + j];
    fit->error[i] = open ? INFINITY : sqrt(fmax(fit->covariance[i * fit->ns + i], 0));
    if (isnan(fit->variance) && !open)
        fit->error[i] = NAN;
    return moray_ok();
}

// Of those that the objective has.
static void add_up(struct inverse *v, moray_fit *fit, const moray_residual *residual, int n)
{
    for (int k = 0; k < n; k++) {
        if (v->t->ocp->phase[residual[k].phase].observed.events_only)
            continue;
        fit->observations++;
        const double r = residual[k].predicted - residual[k].observed;
        fit->sum += residual[k].weight * r * r;
        v->data += residual[k].weight * fmax(pow(residual[k].observed, 2), pow(residual[k].predicted, 2));
    }
    v->data = v->data > 0 ? v->data : 1;
}

static moray_status gather(struct inverse *v, moray_fit *fit, bool known)
{
    const double *parameters = moray_solution_parameters(v->solution);
    const int n = moray_solution_residuals(v->solution, NULL);
    moray_residual *residual = calloc((size_t)n + 1, sizeof *residual);
    if (!residual)
        return no_memory();
    moray_solution_residuals(v->solution, residual);
    add_up(v, fit, residual, n);
    free(residual);
    MORAY_TRY(allocate(v));
    MORAY_TRY(factor(v));
    fit->freedom = count_free(v);
    const int degrees = fit->observations - fit->freedom;
    fit->variance = known ? 1 : degrees > 0 ? fit->sum / degrees : NAN;
    for (int i = 0; i < fit->ns; i++) {
        MORAY_TRY(solve_row(v, fit, i));
        const double half = moray_student_95(known ? 0 : degrees) * fit->error[i];
        fit->value[i] = parameters[i];
        fit->lower[i] = parameters[i] - half;
        fit->upper[i] = parameters[i] + half;
    }
    for (int i = 0; i < fit->ns; i++)
        for (int j = 0; j < fit->ns; j++)
            if (isinf(fit->error[j]))
                fit->covariance[i * fit->ns + j] = NAN;
    name_open(fit, v->t->ocp, fit->names, sizeof fit->names);
    return moray_ok();
}

static bool fits(const moray_ocp *ocp)
{
    for (int p = 0; p < ocp->phases; p++)
        if (ocp->phase[p].observed.n > 0 && !ocp->phase[p].observed.events_only)
            return true;
    return false;
}

moray_status moray_fit_new(moray_fit *fit, const moray_solution *solution, bool known)
{
    const struct transcription *t = solution->transcription;
    const size_t ns = (size_t)t->ocp->ns;
    *fit = (moray_fit){.ns = t->ocp->ns};
    if (!fits(t->ocp))
        return moray_error(MORAY_INPUT, "nothing that is observed in %s is in its objective", t->ocp->name);
    if (!moray_is_solved(solution))
        return moray_error(MORAY_NOT_SOLVED, "confidence is that of an optimum, and this is none: %s",
                           moray_nlp_outcome_text(solution->info.outcome));
    fit->value = calloc(4 * ns + ns * ns + 1, sizeof *fit->value);
    if (!fit->value)
        return no_memory();
    fit->error = fit->value + ns;
    fit->lower = fit->error + ns;
    fit->upper = fit->lower + ns;
    fit->covariance = fit->upper + ns;
    struct inverse v = {.solution = solution, .t = t};
    const moray_status status = gather(&v, fit, known);
    release(&v);
    return status;
}

void moray_fit_free(moray_fit *fit)
{
    free(fit->value);
    *fit = (moray_fit){0};
}
