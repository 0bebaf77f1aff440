// SPDX-License-Identifier: MIT
#include "nlp/scaled.h"

#include <math.h>
#include <stdlib.h>

static double scale_at(const double *scale, int i)
{
    return scale ? scale[i] : 1;
}

static double objective_scale(const moray_nlp *nlp)
{
    return nlp->f_scale != 0 ? nlp->f_scale : 1;
}

static double scaled_bound(double bound, double scale)
{
    return fabs(bound) < MORAY_INFINITY ? bound * scale : bound;
}

// ---- Callbacks -----------------------------------------------------------------------------------------------------

static const double *unscaled(struct scaled_nlp *s, const double *x)
{
    for (int j = 0; j < s->of->n; j++)
        s->x[j] = x[j] / scale_at(s->of->x_scale, j);
    return s->x;
}

static bool scaled_objective(void *self, const double *x, bool fresh, double *f)
{
    struct scaled_nlp *s = self;
    const bool ok = s->of->objective(s->of->self, unscaled(s, x), fresh, f);
    *f *= objective_scale(s->of);
    return ok;
}

static bool scaled_gradient(void *self, const double *x, bool fresh, double *gradient)
{
    struct scaled_nlp *s = self;
    const bool ok = s->of->gradient(s->of->self, unscaled(s, x), fresh, gradient);
    for (int j = 0; j < s->of->n; j++)
        gradient[j] *= objective_scale(s->of) / scale_at(s->of->x_scale, j);
    return ok;
}

static bool scaled_constraints(void *self, const double *x, bool fresh, double *g)
{
    struct scaled_nlp *s = self;
    const moray_nlp *of = s->of;
    const bool ok = of->constraints(of->self, unscaled(s, x), fresh, g);
    s->violation = 0;
    for (int i = 0; i < of->m; i++) {
        s->violation = fmax(s->violation, fmax(of->g_lower[i] - g[i], g[i] - of->g_upper[i]));
        g[i] *= scale_at(of->g_scale, i);
    }
    return ok;
}

static bool scaled_jacobian(void *self, const double *x, bool fresh, double *values)
{
    struct scaled_nlp *s = self;
    const bool ok = s->of->jacobian(s->of->self, unscaled(s, x), fresh, values);
    for (int k = 0; k < s->of->nnz_jac; k++)
        values[k] *= s->jac[k];
    return ok;
}

static bool scaled_hessian(void *self, const double *x, bool fresh, double sigma, const double *lambda, double *values)
{
    struct scaled_nlp *s = self;
    const moray_nlp *of = s->of;
    for (int i = 0; i < of->m; i++)
        s->lambda[i] = lambda[i] * scale_at(of->g_scale, i);
    const bool ok = of->hessian(of->self, unscaled(s, x), fresh, sigma * objective_scale(of), s->lambda, values);
    for (int k = 0; k < of->nnz_hess; k++)
        values[k] *= s->hess[k];
    return ok;
}

// ---- Iterates ------------------------------------------------------------------------------------------------------

void scale_iterate(const struct scaled_nlp *s, moray_iterate *iterate)
{
    const double f = objective_scale(s->of);
    for (int j = 0; j < s->of->n; j++) {
        const double scale = scale_at(s->of->x_scale, j);
        iterate->x[j] *= scale;
        iterate->z_lower[j] *= f / scale;
        iterate->z_upper[j] *= f / scale;
    }
    for (int i = 0; i < s->of->m; i++)
        iterate->lambda[i] *= f / scale_at(s->of->g_scale, i);
}

void unscale_iterate(const struct scaled_nlp *s, moray_iterate *iterate)
{
    const moray_nlp *of = s->of;
    const double f = objective_scale(of);
    for (int j = 0; j < of->n; j++) {
        const double scale = scale_at(of->x_scale, j);
        iterate->x[j] = of->x_lower[j] == of->x_upper[j] ? of->x_lower[j] : iterate->x[j] / scale; // to the last digit
        iterate->z_lower[j] *= scale / f;
        iterate->z_upper[j] *= scale / f;
    }
    for (int i = 0; i < of->m; i++) {
        const double scale = scale_at(of->g_scale, i);
        iterate->g[i] /= scale;
        iterate->lambda[i] *= scale / f;
    }
    iterate->objective /= f;
}

// ---- Construction --------------------------------------------------------------------------------------------------

static void fill(struct scaled_nlp *s)
{
    const moray_nlp *of = s->of;
    double *x_lower = s->bounds, *x_upper = x_lower + of->n, *g_lower = x_upper + of->n, *g_upper = g_lower + of->m;
    for (int j = 0; j < of->n; j++) {
        x_lower[j] = scaled_bound(of->x_lower[j], scale_at(of->x_scale, j));
        x_upper[j] = scaled_bound(of->x_upper[j], scale_at(of->x_scale, j));
    }
    for (int i = 0; i < of->m; i++) {
        g_lower[i] = scaled_bound(of->g_lower[i], scale_at(of->g_scale, i));
        g_upper[i] = scaled_bound(of->g_upper[i], scale_at(of->g_scale, i));
    }
    for (int k = 0; k < of->nnz_jac; k++)
        s->jac[k] = scale_at(of->g_scale, of->jac_row[k]) / scale_at(of->x_scale, of->jac_col[k]);
    for (int k = 0; k < of->nnz_hess; k++)
        s->hess[k] = 1 / (scale_at(of->x_scale, of->hess_row[k]) * scale_at(of->x_scale, of->hess_col[k]));
    s->nlp = (moray_nlp){.n = of->n,
                         .m = of->m,
                         .x_lower = x_lower,
                         .x_upper = x_upper,
                         .g_lower = g_lower,
                         .g_upper = g_upper,
                         .nnz_jac = of->nnz_jac,
                         .nnz_hess = of->nnz_hess,
                         .jac_row = of->jac_row,
                         .jac_col = of->jac_col,
                         .hess_row = of->hess_row,
                         .hess_col = of->hess_col,
                         .self = s,
                         .objective = scaled_objective,
                         .gradient = scaled_gradient,
                         .constraints = scaled_constraints,
                         .jacobian = scaled_jacobian,
                         .hessian = scaled_hessian};
}

moray_status scaled_nlp_new(struct scaled_nlp *s, const moray_nlp *of)
{
    const size_t n = (size_t)of->n, m = (size_t)of->m, jac = (size_t)of->nnz_jac, hess = (size_t)of->nnz_hess;
    *s = (struct scaled_nlp){.of = of, .bounds = calloc(3 * (n + m) + jac + hess + 1, sizeof *s->bounds)};
    if (!s->bounds)
        return moray_error(MORAY_MEMORY, "no memory for %d variables", of->n);
    s->jac = s->bounds + 2 * (n + m);
    s->hess = s->jac + jac;
    s->x = s->hess + hess;
    s->lambda = s->x + n;
    fill(s);
    return moray_ok();
}

void scaled_nlp_free(struct scaled_nlp *s)
{
    free(s->bounds);
}
