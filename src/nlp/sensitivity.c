// SPDX-License-Identifier: MIT
#include "nlp/sensitivity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

static const double singular = 1e-16;   // reciprocal condition beyond which nothing is determined
static const double regularity = 1e-10; // of active constraints, see fill; in the scale of the solver
static const double followed = 1e-6;    // residual of a right-hand side, relative
enum { refinements = 3 };

// ---- KKT matrix ----------------------------------------------------------------------------------------------------
//
// [H J'; J 0] for d(x, lambda), where the row of a column at a bound says what the bound makes of it, and that of a
// constraint that is not active says that its multiplier stays 0. Factored is [H J'; J -r], regular where active
// constraints depend on each other too: refinement takes away what r does, but for a right-hand side that they cannot
// all follow.

static bool is_held(const moray_nlp_sensitivity *s, int row)
{
    const int n = s->nlp->n, m = s->nlp->m;
    return row < n ? s->activity[m + row] != INACTIVE : s->activity[row - n] == INACTIVE;
}

static void put(moray_nlp_sensitivity *s, int k, int row, int col, double value)
{
    s->pattern.row[k] = row;
    s->pattern.col[k] = col;
    s->values[k] = is_held(s, row) ? 0 : value;
}

// Full storage of the symmetric matrix: KLU pivots freely. A held row is a unit row, the equation that bound or zero
// multiplier imposes.
static void fill(moray_nlp_sensitivity *s)
{
    const moray_nlp *nlp = s->nlp;
    const int n = nlp->n, m = nlp->m;
    int k = 0;
    for (; k < n + m; k++) {
        const double g_scale = k >= n && nlp->g_scale ? nlp->g_scale[k - n] : 1;
        put(s, k, k, k, k < n ? 0 : -regularity * moray_objective_scale(nlp) / (g_scale * g_scale));
        if (is_held(s, k))
            s->values[k] = 1;
    }
    for (int e = 0; e < nlp->nnz_jac; e++) {
        put(s, k++, n + nlp->jac_row[e], nlp->jac_col[e], s->jac[e]);
        put(s, k++, nlp->jac_col[e], n + nlp->jac_row[e], s->jac[e]);
    }
    for (int e = 0; e < nlp->nnz_hess; e++) {
        const int row = nlp->hess_row[e], col = nlp->hess_col[e];
        if (row == col && !is_held(s, row))
            s->values[row] = s->hess[e];
        if (row == col)
            continue;
        put(s, k++, row, col, s->hess[e]);
        put(s, k++, col, row, s->hess[e]);
    }
    s->pattern.nnz = k;
}

static moray_status evaluate(moray_nlp_sensitivity *s)
{
    const moray_nlp *nlp = s->nlp;
    if (nlp->gradient(nlp->self, s->at->x, true, s->gradient) && nlp->jacobian(nlp->self, s->at->x, false, s->jac) &&
        nlp->hessian(nlp->self, s->at->x, false, 1, s->at->lambda, s->hess))
        return moray_ok();
    return moray_error(MORAY_NUMERIC, "a function of the problem is not finite at the solution");
}

static moray_status factor(moray_nlp_sensitivity *s)
{
    MORAY_TRY(moray_sparse_lu_new(&s->lu, s->nlp->n + s->nlp->m, &s->pattern));
    const moray_status status = moray_sparse_lu_factor(s->lu, s->values);
    const double condition = moray_sparse_lu_condition(s->lu);
    if (status.code == MORAY_MEMORY || (!moray_failed(status) && condition > singular))
        return status;
    return moray_error(MORAY_NUMERIC,
                       "the KKT matrix is singular (reciprocal condition %.1e): the minimum is not a strict one",
                       condition);
}

static moray_status allocate(moray_nlp_sensitivity *s)
{
    const moray_nlp *nlp = s->nlp;
    const size_t n = (size_t)nlp->n, m = (size_t)nlp->m, jac = (size_t)nlp->nnz_jac, hess = (size_t)nlp->nnz_hess;
    const size_t entries = n + m + 2 * jac + 2 * hess;
    s->jac = calloc(jac + hess + n + entries + 3 * (n + m), sizeof *s->jac);
    s->activity = calloc(n + m, sizeof *s->activity);
    s->weak = calloc(n + m, sizeof *s->weak);
    if (!s->jac || !s->activity || !s->weak)
        return moray_error(MORAY_MEMORY, "no memory for the sensitivities of %d variables", nlp->n);
    s->hess = s->jac + jac;
    s->gradient = s->hess + hess;
    s->values = s->gradient + n;
    s->rhs = s->values + entries;
    s->residual = s->rhs + n + m;
    s->solution = s->residual + n + m;
    return moray_pattern_new(&s->pattern, (int)entries);
}

moray_status moray_nlp_sensitivity_new(moray_nlp_sensitivity **result, const moray_nlp *nlp,
                                       const moray_iterate *solution)
{
    *result = NULL;
    moray_nlp_sensitivity *s = calloc(1, sizeof *s);
    if (!s)
        return moray_error(MORAY_MEMORY, "no memory for sensitivities");
    s->nlp = nlp;
    s->at = solution;
    moray_status status = allocate(s);
    if (!moray_failed(status)) {
        moray_find_activity(s);
        status = evaluate(s);
    }
    if (!moray_failed(status)) {
        fill(s);
        status = factor(s);
    }
    if (moray_failed(status))
        moray_nlp_sensitivity_free(s);
    else
        *result = s;
    return status;
}

void moray_nlp_sensitivity_free(moray_nlp_sensitivity *s)
{
    if (!s)
        return;
    moray_sparse_lu_free(s->lu);
    moray_pattern_free(&s->pattern);
    free(s->jac);
    free(s->activity);
    free(s->weak);
    free(s);
}

// ---- Slopes --------------------------------------------------------------------------------------------------------

static double entry(const double *vector, int i)
{
    return vector ? vector[i] : 0;
}

static void fill_rhs(moray_nlp_sensitivity *s, const moray_nlp_shift *shift)
{
    const int n = s->nlp->n, m = s->nlp->m;
    for (int j = 0; j < n; j++)
        s->rhs[j] = is_held(s, j) ? moray_bound_slope(s->nlp, shift, m + j, s->activity[m + j] == AT_UPPER)
                                  : -entry(shift->gradient, j);
    for (int i = 0; i < m; i++)
        s->rhs[n + i] = is_held(s, n + i)
                            ? 0
                            : moray_bound_slope(s->nlp, shift, i, s->activity[i] == AT_UPPER) - entry(shift->g, i);
}

// What takes a row of the matrix to the solver's scale.
static double row_scale(const moray_nlp_sensitivity *s, int row)
{
    const moray_nlp *nlp = s->nlp;
    if (row >= nlp->n)
        return nlp->g_scale && !is_held(s, row) ? nlp->g_scale[row - nlp->n] : 1;
    const double scale = nlp->x_scale ? nlp->x_scale[row] : 1;
    return is_held(s, row) ? scale : moray_objective_scale(nlp) / scale;
}

static double scaled_norm(const moray_nlp_sensitivity *s, const double *vector)
{
    double largest = 0;
    for (int i = 0; i < s->nlp->n + s->nlp->m; i++)
        largest = moray_worse(largest, fabs(vector[i] * row_scale(s, i)));
    return largest;
}

// residual <- rhs - [H J'; J 0] solution
static void find_residual(moray_nlp_sensitivity *s)
{
    const int n = s->nlp->n, size = n + s->nlp->m;
    memcpy(s->residual, s->rhs, (size_t)size * sizeof *s->residual);
    for (int k = 0; k < s->pattern.nnz; k++)
        if (k < n || k >= size || is_held(s, k))
            s->residual[s->pattern.row[k]] -= s->values[k] * s->solution[s->pattern.col[k]];
}

// Iterative refinement against the unregularised matrix: what is left over tells constraints that cannot all follow.
static moray_status solve_kkt(moray_nlp_sensitivity *s)
{
    const int size = s->nlp->n + s->nlp->m;
    memset(s->solution, 0, (size_t)size * sizeof *s->solution);
    for (int k = 0; k < refinements; k++) {
        find_residual(s);
        MORAY_TRY(moray_sparse_lu_solve(s->lu, 1, s->residual));
        for (int i = 0; i < size; i++)
            s->solution[i] += s->residual[i];
    }
    find_residual(s);
    if (scaled_norm(s, s->residual) <= followed * scaled_norm(s, s->rhs))
        return moray_ok();
    return moray_error(MORAY_NUMERIC, "the active constraints depend on each other and cannot all follow: one of them "
                                      "lets go at once");
}

// What the multipliers of the bounds must do for the Lagrangian's gradient to stay 0, in z_upper.
static void complete_multipliers(const moray_nlp_sensitivity *s, const moray_nlp_shift *shift, moray_iterate *slope)
{
    const moray_nlp *nlp = s->nlp;
    for (int j = 0; j < nlp->n; j++)
        slope->z_upper[j] = -entry(shift->gradient, j);
    for (int e = 0; e < nlp->nnz_jac; e++)
        slope->z_upper[nlp->jac_col[e]] -= s->jac[e] * slope->lambda[nlp->jac_row[e]];
    for (int e = 0; e < nlp->nnz_hess; e++) {
        const int row = nlp->hess_row[e], col = nlp->hess_col[e];
        slope->z_upper[row] -= s->hess[e] * slope->x[col];
        if (row != col)
            slope->z_upper[col] -= s->hess[e] * slope->x[row];
    }
    for (int j = 0; j < nlp->n; j++) {
        const enum activity activity = s->activity[nlp->m + j];
        slope->z_lower[j] = activity == AT_LOWER ? -slope->z_upper[j] : 0;
        if (activity == AT_LOWER || activity == INACTIVE)
            slope->z_upper[j] = 0;
    }
}

// Implicit function theorem on the KKT conditions with the active set held: K d(x, lambda) = -d(KKT
// residual)/d(parameter).
moray_status moray_nlp_sensitivity_solve(moray_nlp_sensitivity *s, const moray_nlp_shift *shift, moray_iterate *slope)
{
    const moray_nlp *nlp = s->nlp;
    const size_t n = (size_t)nlp->n, m = (size_t)nlp->m;
    fill_rhs(s, shift);
    MORAY_TRY(solve_kkt(s));
    memcpy(slope->x, s->solution, n * sizeof *slope->x);
    memcpy(slope->lambda, s->solution + n, m * sizeof *slope->lambda);
    complete_multipliers(s, shift, slope);
    for (int i = 0; i < nlp->m; i++)
        slope->g[i] = entry(shift->g, i);
    for (int e = 0; e < nlp->nnz_jac; e++)
        slope->g[nlp->jac_row[e]] += s->jac[e] * slope->x[nlp->jac_col[e]];
    slope->objective = shift->objective;
    for (int j = 0; j < nlp->n; j++)
        slope->objective += s->gradient[j] * slope->x[j];
    return moray_ok();
}
