// SPDX-License-Identifier: MIT
//
// Minimum or saddle: the inertia of [H + shift S, J'; J, -r] with the active bounds held is (n, m, 0) where H + shift S
// is positive on what the active constraints leave free. Everything in sizes, so that no unit matters.
#include "ocp/certificate/curvature.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear/ldl.h"

static const double regularity = 1e-10; // r: dependent constraints are no saddle
static const double least_shift = 1e-5, most_shift = 1e7;
static const double held_part = 1e-3;         // of a slack, that a multiplier outweighs where its bound is held
static const double safe = 1e-2, fast = 1e-8; // thresholds of the factorisation; the second where the first fills it
enum { turns = 6 };                           // of inverse iteration

struct bend {
    const struct witness *w;
    const moray_nlp *nlp;
    double *column, *row, *weight;  // sizes [n], [m]; S [n + m]
    double *g, *jac, *hess, *d, *v; // [m], [nnz], [nnz], [n], [n + m]
    bool *held;                     // [n + m] columns at a bound, rows that are not
    double *values;
    moray_pattern pattern;
    moray_ldl *ldl;
};

// ---- What is active ----

static void weigh(struct bend *b)
{
    const struct transcription *t = b->w->solution->transcription;
    for (int k = 0; k < b->nlp->n + b->nlp->m; k++)
        b->weight[k] = 1;
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase *phase = &t->ocp->phase[p];
        const struct phase_layout *layout = &t->layout.phase[p];
        for (int n = 0; n < layout->nodes; n++) {
            const struct node *node = &layout->node[n];
            const double weight = node->weight > 0 ? node->weight : 1.0 / layout->nodes;
            for (int i = 0; i < phase->nx + (node->collocated ? phase->nu : 0); i++)
                b->weight[node->x + i] = weight;
            for (int i = 0; i < phase->nc && node->collocated; i++)
                b->weight[b->nlp->n + node->path + i] = weight;
        }
    }
}

// One side of a bound, in sizes and per part of the phase; an absent one is too far away.
static bool holds(const struct bend *b, double multiplier, double slack, double size, double weight)
{
    return multiplier * size / (weight * moray_witness_objective(b->w)) > held_part * slack / size;
}

static void find_held(struct bend *b)
{
    const moray_nlp *nlp = b->nlp;
    const moray_iterate *at = &b->w->solution->iterate;
    for (int j = 0; j < nlp->n; j++) {
        const double low = nlp->x_lower[j], high = nlp->x_upper[j], size = b->column[j], weight = b->weight[j];
        b->held[j] = low == high || holds(b, at->z_lower[j], at->x[j] - low, size, weight) ||
                     holds(b, at->z_upper[j], high - at->x[j], size, weight);
    }
    for (int i = 0; i < nlp->m; i++) {
        const double low = nlp->g_lower[i], high = nlp->g_upper[i], size = b->row[i], weight = b->weight[nlp->n + i];
        b->held[nlp->n + i] = low != high && !holds(b, -at->lambda[i], b->g[i] - low, size, weight) &&
                              !holds(b, at->lambda[i], high - b->g[i], size, weight);
    }
}

// ---- The matrix ----

static moray_status set_pattern(struct bend *b)
{
    const moray_nlp *nlp = b->nlp;
    const int size = nlp->n + nlp->m;
    MORAY_TRY(moray_pattern_new(&b->pattern, size + nlp->nnz_jac + nlp->nnz_hess));
    int k = 0;
    for (; k < size; k++)
        b->pattern.row[k] = b->pattern.col[k] = k;
    for (int e = 0; e < nlp->nnz_jac; e++, k++)
        b->pattern.row[k] = nlp->n + nlp->jac_row[e], b->pattern.col[k] = nlp->jac_col[e];
    for (int e = 0; e < nlp->nnz_hess; e++, k++)
        b->pattern.row[k] = nlp->hess_row[e], b->pattern.col[k] = nlp->hess_col[e];
    return moray_ldl_new(&b->ldl, size, &b->pattern);
}

static void fill(struct bend *b, double shift)
{
    const moray_nlp *nlp = b->nlp;
    const double objective = moray_witness_objective(b->w);
    int k = 0;
    for (; k < nlp->n; k++)
        b->values[k] = b->held[k] ? 1 : shift * b->weight[k];
    for (; k < nlp->n + nlp->m; k++)
        b->values[k] = b->held[k] ? -1 : -regularity;
    for (int e = 0; e < nlp->nnz_jac; e++, k++) {
        const int i = nlp->jac_row[e], j = nlp->jac_col[e];
        b->values[k] = b->held[j] || b->held[nlp->n + i] ? 0 : b->jac[e] * b->column[j] / b->row[i];
    }
    for (int e = 0; e < nlp->nnz_hess; e++, k++) {
        const int i = nlp->hess_row[e], j = nlp->hess_col[e];
        b->values[k] = b->held[i] || b->held[j] ? 0 : b->hess[e] * b->column[i] * b->column[j] / objective;
    }
}

// Whether nothing bends down further than the shift lifts.
static moray_status factor(struct bend *b, double shift, bool *convex)
{
    fill(b, shift);
    moray_status status = moray_ldl_factor(b->ldl, b->values, safe);
    if (status.code == MORAY_NOT_SOLVED)
        status = moray_ldl_factor(b->ldl, b->values, fast);
    MORAY_TRY(status);
    *convex = moray_ldl_inertia_of(b->ldl).negative <= b->nlp->m;
    return moray_ok();
}

// ---- The direction ----

// d' H d / d' S d, without the shift.
static double curvature_along(const struct bend *b)
{
    const moray_nlp *nlp = b->nlp;
    const double *hess = b->values + nlp->n + nlp->m + nlp->nnz_jac;
    double bent = 0, length = 0;
    for (int j = 0; j < nlp->n; j++)
        length += b->weight[j] * b->d[j] * b->d[j];
    for (int e = 0; e < nlp->nnz_hess; e++) {
        const int i = nlp->hess_row[e], j = nlp->hess_col[e];
        bent += (i == j ? 1 : 2) * hess[e] * b->d[i] * b->d[j];
    }
    return length > 0 ? bent / length : 0;
}

// Inverse iteration with the factors at hand finds what lies next to the shift.
static moray_status iterate(struct bend *b)
{
    const int n = b->nlp->n, size = n + b->nlp->m;
    for (int j = 0; j < n; j++)
        b->d[j] = b->held[j] ? 0 : 0.5 + fmod(0.618033988749895 * (j + 1), 1);
    for (int turn = 0; turn < turns; turn++) {
        double largest = 0;
        for (int k = 0; k < size; k++)
            b->v[k] = k < n && !b->held[k] ? b->weight[k] * b->d[k] : 0;
        MORAY_TRY(moray_ldl_solve(b->ldl, 1, b->v));
        for (int j = 0; j < n; j++)
            largest = fmax(largest, fabs(b->v[j]));
        for (int j = 0; j < n; j++)
            b->d[j] = largest > 0 ? b->v[j] / largest : 0;
    }
    return moray_ok();
}

// The least power of ten that lifts everything bounds the curvature; a direction close to it says what it is.
static moray_status search(struct bend *b, double *worst)
{
    bool convex;
    double shift = least_shift;
    *worst = 0;
    MORAY_TRY(factor(b, shift, &convex));
    if (convex)
        return moray_ok();
    for (; !convex && shift < most_shift; shift *= 10)
        MORAY_TRY(factor(b, 10 * shift, &convex));
    MORAY_TRY(iterate(b));
    *worst = fmax(0, -curvature_along(b));
    return moray_ok();
}

// ---- All of it ----

static moray_status allocate(struct bend *b)
{
    const size_t n = (size_t)b->nlp->n, m = (size_t)b->nlp->m, jac = (size_t)b->nlp->nnz_jac;
    const size_t hess = (size_t)b->nlp->nnz_hess;
    b->column = calloc(5 * (n + m) + 2 * (jac + hess), sizeof *b->column);
    b->held = calloc(n + m, sizeof *b->held);
    if (!b->column || !b->held)
        return moray_error(MORAY_MEMORY, "no memory for the inertia of %d variables", b->nlp->n);
    b->row = b->column + n;
    b->g = b->row + m;
    b->weight = b->g + m;
    b->d = b->weight + n + m;
    b->v = b->d + n;
    b->jac = b->v + n + m;
    b->hess = b->jac + jac;
    b->values = b->hess + hess;
    return set_pattern(b);
}

static moray_status examine(struct bend *b, double *worst, double *direction)
{
    const moray_iterate *at = &b->w->solution->iterate;
    const moray_nlp *nlp = b->nlp;
    MORAY_TRY(allocate(b));
    moray_witness_columns(b->w, b->column);
    moray_witness_rows(b->w, b->row);
    weigh(b);
    if (!nlp->constraints(nlp->self, at->x, true, b->g) || !nlp->jacobian(nlp->self, at->x, false, b->jac) ||
        !nlp->hessian(nlp->self, at->x, false, 1, at->lambda, b->hess)) {
        *worst = INFINITY;
        return moray_ok();
    }
    find_held(b);
    const moray_status status = search(b, worst);
    if (status.code == MORAY_NOT_SOLVED)
        *worst = NAN;
    else
        MORAY_TRY(status);
    for (int j = 0; direction && j < nlp->n; j++)
        direction[j] = *worst > 0 ? b->d[j] * b->column[j] : 0;
    return moray_ok();
}

moray_status moray_measure_curvature(const struct witness *w, double *worst, double *direction)
{
    struct bend b = {.w = w, .nlp = &w->solution->transcription->nlp};
    const moray_status status = examine(&b, worst, direction);
    moray_ldl_free(b.ldl);
    moray_pattern_free(&b.pattern);
    free(b.column);
    free(b.held);
    return status;
}
