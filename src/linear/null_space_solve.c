// SPDX-License-Identifier: MIT
//
// Solutions from the factors, with refinement.
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "linear/null_space_parts.h"

static const double accurate = 1e-14; // residual that refinement would hardly better
enum { refinements = 3 };

static double larger(double a, double b)
{
    return a > b ? a : b;
}

// What constraints ask of the basis, what is left to the others in the null space, and the multipliers that balance it:
// step <- the solution for `residual`, which is overwritten.
static moray_status solve_once(null_space *ns)
{
    const int f = ns->freedom, v = ns->variables, m = ns->m;
    double *p = ns->step, *s = ns->step + v, *left = ns->residual;
    memcpy(s, left + v, (size_t)m * sizeof *s);
    MORAY_TRY(moray_sparse_lu_solve(ns->basis.lu, 1, s));
    for (int i = 0; i < v; i++)
        p[i] = ns->basis.place[i] >= 0 ? -s[ns->basis.place[i]] : 0;
    moray_null_space_multiply(ns, 1, p, left); // with its sign turned, so that it comes off
    for (int c = 0; c < f; c++) {
        ns->r[c] = 0;
        for (int i = 0; i < v; i++)
            ns->r[c] += ns->Z[i * f + c] * left[i];
    }
    if (f > 0)
        MORAY_TRY(moray_ldl_solve(ns->reduced, 1, ns->r));
    for (int i = 0; i < v; i++) {
        p[i] = -p[i];
        for (int c = 0; c < f; c++) {
            p[i] += ns->Z[i * f + c] * ns->r[c];
            left[i] -= ns->HZ[i * f + c] * ns->r[c];
        }
    }
    for (int i = 0; i < v; i++)
        if (ns->basis.place[i] >= 0)
            s[ns->basis.place[i]] = left[i];
    return moray_sparse_lu_solve_transposed(ns->basis.lu, 1, s);
}

// residual <- rhs - matrix x. Returns its largest entry, each over what its row makes of the largest of the solution.
static double find_residual(null_space *ns)
{
    const int *row = ns->pattern.row, *col = ns->pattern.col;
    double *r = ns->residual, worst = 0, size = 0;
    const double *x = ns->x;
    memcpy(r, ns->rhs, (size_t)ns->n * sizeof *r);
    for (int k = 0; k < ns->pattern.nnz; k++) {
        const int i = row[k], j = col[k];
        const double value = ns->values[k];
        r[i] -= value * x[j];
        r[j] -= (i == j ? 0 : value) * x[i];
    }
    for (int i = 0; i < ns->n; i++)
        size = larger(size, fabs(x[i]));
    for (int i = 0; i < ns->n; i++) {
        const double least = ns->largest[i] * size + fabs(ns->rhs[i]), here = fabs(r[i]);
        worst = moray_worse(worst, least > 0 ? here / least : here);
    }
    return worst;
}

moray_status moray_null_space_solve(null_space *ns, double *b, double *error)
{
    if (!ns->factored)
        return moray_error(MORAY_NUMERIC, "a sparse matrix of %d rows has no factors to solve with", ns->n);
    double before = INFINITY;
    memcpy(ns->rhs, b, (size_t)ns->n * sizeof *b);
    memcpy(ns->residual, b, (size_t)ns->n * sizeof *b);
    memset(ns->x, 0, (size_t)ns->n * sizeof *ns->x);
    *error = INFINITY;
    for (int k = 0; k <= refinements && *error > accurate && (k < 2 || *error < before / 2); k++) {
        MORAY_TRY(solve_once(ns));
        for (int i = 0; i < ns->n; i++)
            ns->x[i] += ns->step[i];
        before = *error;
        *error = find_residual(ns);
    }
    memcpy(b, ns->x, (size_t)ns->n * sizeof *b);
    return moray_ok();
}
