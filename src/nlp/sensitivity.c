// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/nlp.h"
#include "nlp/klu.h"

static const double small = 1e-4;     // of a multiplier or slack in the scale of the solver
static const double singular = 1e-15; // reciprocal condition beyond which nothing is determined

enum activity { INACTIVE, AT_LOWER, AT_UPPER, EQUAL };

// Constraints are numbered rows first, then bounds of the columns.
struct moray_nlp_sensitivity {
    const moray_nlp *nlp;
    const moray_iterate *at;
    enum activity *activity; // [m + n]
    bool *weak;              // [m + n]
    double *jac, *hess, *gradient;
    double *values, *rhs; // [entries], [n + m]
    moray_pattern pattern;
    sparse_lu *lu;
};

// ---- Active set ----------------------------------------------------------------------------------------------------

// One side of a constraint: slack, and multiplier that is positive where it holds the constraint; both in user units,
// with what takes the slack to the solver's.
struct side {
    bool bounded, fixed;
    double slack, multiplier, scale;
};

static struct side side_of(const moray_nlp *nlp, const moray_iterate *at, int i, bool upper)
{
    const int j = i - nlp->m;
    const bool row = i < nlp->m;
    const double low = row ? nlp->g_lower[i] : nlp->x_lower[j], high = row ? nlp->g_upper[i] : nlp->x_upper[j];
    const double value = row ? at->g[i] : at->x[j];
    const double *scales = row ? nlp->g_scale : nlp->x_scale;
    return (struct side){.bounded = upper ? high < MORAY_INFINITY : low > -MORAY_INFINITY,
                         .fixed = low == high,
                         .slack = upper ? high - value : value - low,
                         .multiplier = row     ? (upper ? at->lambda[i] : -at->lambda[i])
                                       : upper ? at->z_upper[j]
                                               : at->z_lower[j],
                         .scale = scales ? scales[row ? i : j] : 1};
}

static void find_activity(moray_nlp_sensitivity *s)
{
    const moray_nlp *nlp = s->nlp;
    const double f_scale = nlp->f_scale != 0 ? nlp->f_scale : 1;
    for (int i = 0; i < nlp->m + nlp->n; i++)
        for (int upper = 0; upper < 2; upper++) {
            const struct side side = side_of(nlp, s->at, i, upper);
            const double slack = side.slack * side.scale, multiplier = side.multiplier * f_scale / side.scale;
            if (side.fixed)
                s->activity[i] = EQUAL;
            else if (side.bounded && multiplier > slack)
                s->activity[i] = upper ? AT_UPPER : AT_LOWER;
            if (!side.fixed && side.bounded)
                s->weak[i] = s->weak[i] || (slack < small && multiplier < small);
        }
}

int moray_nlp_sensitivity_weak(const moray_nlp_sensitivity *s, int *constraint, int most)
{
    int n = 0;
    for (int i = 0; i < s->nlp->m + s->nlp->n; i++)
        if (s->weak[i] && n++ < most)
            constraint[n - 1] = i;
    return n;
}

// ---- KKT matrix ----------------------------------------------------------------------------------------------------
//
// [H J'; J 0] for d(x, lambda), where the row of a column at a bound says what the bound makes of it, and that of a
// constraint that is not active says that its multiplier stays 0.

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

static void fill(moray_nlp_sensitivity *s)
{
    const moray_nlp *nlp = s->nlp;
    const int n = nlp->n, m = nlp->m;
    int k = 0;
    for (; k < n + m; k++) {
        put(s, k, k, k, 0);
        s->values[k] = is_held(s, k);
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
    MORAY_TRY(sparse_lu_new(&s->lu, s->nlp->n + s->nlp->m, &s->pattern));
    MORAY_TRY(sparse_lu_factor(s->lu, s->values));
    const double condition = sparse_lu_condition(s->lu);
    if (condition > singular)
        return moray_ok();
    return moray_error(MORAY_NUMERIC,
                       "the KKT matrix is singular to rounding (reciprocal condition %.1e): active constraints that "
                       "depend on each other, or a minimum that is not strict",
                       condition);
}

static moray_status allocate(moray_nlp_sensitivity *s)
{
    const moray_nlp *nlp = s->nlp;
    const size_t n = (size_t)nlp->n, m = (size_t)nlp->m, jac = (size_t)nlp->nnz_jac, hess = (size_t)nlp->nnz_hess;
    const size_t entries = n + m + 2 * jac + 2 * hess;
    s->jac = calloc(jac + hess + n + entries + n + m, sizeof *s->jac);
    s->activity = calloc(n + m, sizeof *s->activity);
    s->weak = calloc(n + m, sizeof *s->weak);
    if (!s->jac || !s->activity || !s->weak)
        return moray_error(MORAY_MEMORY, "no memory for the sensitivities of %d variables", nlp->n);
    s->hess = s->jac + jac;
    s->gradient = s->hess + hess;
    s->values = s->gradient + n;
    s->rhs = s->values + entries;
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
        find_activity(s);
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
    sparse_lu_free(s->lu);
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

// d/dp of one bound of a constraint.
static double bound_slope(const moray_nlp *nlp, const moray_nlp_shift *shift, int i, bool upper)
{
    if (i < nlp->m)
        return entry(upper ? shift->g_upper : shift->g_lower, i);
    return entry(upper ? shift->x_upper : shift->x_lower, i - nlp->m);
}

static void fill_rhs(moray_nlp_sensitivity *s, const moray_nlp_shift *shift)
{
    const int n = s->nlp->n, m = s->nlp->m;
    for (int j = 0; j < n; j++)
        s->rhs[j] = is_held(s, j) ? bound_slope(s->nlp, shift, m + j, s->activity[m + j] == AT_UPPER)
                                  : -entry(shift->gradient, j);
    for (int i = 0; i < m; i++)
        s->rhs[n + i] =
            is_held(s, n + i) ? 0 : bound_slope(s->nlp, shift, i, s->activity[i] == AT_UPPER) - entry(shift->g, i);
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

moray_status moray_nlp_sensitivity_solve(moray_nlp_sensitivity *s, const moray_nlp_shift *shift, moray_iterate *slope)
{
    const moray_nlp *nlp = s->nlp;
    const size_t n = (size_t)nlp->n, m = (size_t)nlp->m;
    fill_rhs(s, shift);
    MORAY_TRY(sparse_lu_solve(s->lu, 1, s->rhs));
    memcpy(slope->x, s->rhs, n * sizeof *slope->x);
    memcpy(slope->lambda, s->rhs + n, m * sizeof *slope->lambda);
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

// ---- Changes of the active set -------------------------------------------------------------------------------------

// The step at which what is `value` > 0 now and changes at `rate` is 0; infinite where it never is.
static double step_to_zero(double value, double rate, int direction)
{
    return rate * direction < 0 ? fmax(value, 0) / fabs(rate) : INFINITY;
}

static moray_nlp_change change_of(const moray_nlp_sensitivity *s, const moray_nlp_shift *shift,
                                  const moray_iterate *slope, int i, bool upper, int direction)
{
    const moray_nlp *nlp = s->nlp;
    const enum activity activity = s->activity[i];
    const struct side side = side_of(nlp, s->at, i, upper), rate = side_of(nlp, slope, i, upper);
    moray_nlp_change change = {INFINITY, i, upper, activity == (upper ? AT_UPPER : AT_LOWER)};
    if (activity == EQUAL || !side.bounded)
        return change;
    if (change.leaves) {
        change.step = step_to_zero(side.multiplier, rate.multiplier, direction);
    } else if (activity == INACTIVE) {
        const double value = i < nlp->m ? slope->g[i] : slope->x[i - nlp->m];
        const double gap = bound_slope(nlp, shift, i, upper) - value;
        change.step = step_to_zero(side.slack, upper ? gap : -gap, direction);
    }
    return change;
}

moray_nlp_change moray_nlp_sensitivity_change(const moray_nlp_sensitivity *s, const moray_nlp_shift *shift,
                                              const moray_iterate *slope, int direction)
{
    moray_nlp_change first = {INFINITY, -1, false, false};
    for (int i = 0; i < s->nlp->m + s->nlp->n; i++)
        for (int upper = 0; upper < 2; upper++) {
            const moray_nlp_change change = change_of(s, shift, slope, i, upper, direction);
            if (change.step < first.step)
                first = change;
        }
    first.step *= direction;
    return first;
}
