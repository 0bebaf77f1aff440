// SPDX-License-Identifier: MIT
//
// Dense programmes of a few variables, whose solutions are known.
#ifndef TESTS_NLP_PROGRAMME_H
#define TESTS_NLP_PROGRAMME_H

#include <math.h>
#include <string.h>

#include "moray/nlp.h"

enum { most = 3 };

// Dense programmes of at most three variables and two rows; a function gives all there is to know of one at x.
struct facts {
    double f, gradient[most], g[2], jac[2][most], hess[most][most], hess_g[2][most][most];
};
struct dense {
    moray_nlp nlp;
    void (*facts)(const double *x, const double *p, struct facts *facts);
    double p[5], x_lower[most], x_upper[most], g_lower[2], g_upper[2];
    int row[9], col[9], hess_row[9], hess_col[9];
    double x[most], z_lower[most], z_upper[most], g[2], lambda[2]; // the solution
    moray_iterate at;
};

static inline struct facts facts_at(void *self, const double *x)
{
    const struct dense *d = self;
    struct facts facts = {0};
    d->facts(x, d->p, &facts);
    return facts;
}

static inline bool objective(void *self, const double *x, bool fresh, double *f)
{
    (void)fresh;
    *f = facts_at(self, x).f;
    return true;
}

static inline bool gradient(void *self, const double *x, bool fresh, double *values)
{
    (void)fresh;
    memcpy(values, facts_at(self, x).gradient, (size_t)((struct dense *)self)->nlp.n * sizeof *values);
    return true;
}

static inline bool constraints(void *self, const double *x, bool fresh, double *g)
{
    (void)fresh;
    memcpy(g, facts_at(self, x).g, (size_t)((struct dense *)self)->nlp.m * sizeof *g);
    return true;
}

static inline bool jacobian(void *self, const double *x, bool fresh, double *values)
{
    (void)fresh;
    const struct dense *d = self;
    const struct facts facts = facts_at(self, x);
    for (int k = 0; k < d->nlp.nnz_jac; k++)
        values[k] = facts.jac[d->row[k]][d->col[k]];
    return isfinite(x[0]);
}

static inline bool hessian(void *self, const double *x, bool fresh, double sigma, const double *lambda, double *values)
{
    (void)fresh;
    const struct dense *d = self;
    const struct facts facts = facts_at(self, x);
    for (int k = 0; k < d->nlp.nnz_hess; k++) {
        const int i = d->hess_row[k], j = d->hess_col[k];
        values[k] = sigma * facts.hess[i][j];
        for (int r = 0; r < d->nlp.m; r++)
            values[k] += lambda[r] * facts.hess_g[r][i][j];
    }
    return true;
}

static inline void dense_new(struct dense *d, int n, int m)
{
    int k = 0, l = 0;
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++, k++)
            d->row[k] = i, d->col[k] = j;
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++, l++)
            d->hess_row[l] = i, d->hess_col[l] = j;
    d->nlp = (moray_nlp){.n = n,
                         .m = m,
                         .x_lower = d->x_lower,
                         .x_upper = d->x_upper,
                         .g_lower = d->g_lower,
                         .g_upper = d->g_upper,
                         .nnz_jac = k,
                         .nnz_hess = l,
                         .jac_row = d->row,
                         .jac_col = d->col,
                         .hess_row = d->hess_row,
                         .hess_col = d->hess_col,
                         .self = d,
                         .objective = objective,
                         .gradient = gradient,
                         .constraints = constraints,
                         .jacobian = jacobian,
                         .hessian = hessian};
    for (int j = 0; j < n; j++)
        d->x_lower[j] = -MORAY_INFINITY, d->x_upper[j] = MORAY_INFINITY;
    d->at = (moray_iterate){.x = d->x, .z_lower = d->z_lower, .z_upper = d->z_upper, .g = d->g, .lambda = d->lambda};
}

// x0^2 + 2 x1^2 + 3 x2^2, x0 + x1 + x2
static inline void weighted_squares(const double *x, const double *p, struct facts *f)
{
    (void)p;
    for (int j = 0; j < 3; j++) {
        f->f += (j + 1) * x[j] * x[j];
        f->g[0] += x[j];
        f->gradient[j] = 2 * (j + 1) * x[j];
        f->jac[0][j] = 1;
        f->hess[j][j] = 2 * (j + 1);
    }
}

// Room for a slope.
struct slope {
    double x[most], z_lower[most], z_upper[most], beyond, g[2], lambda[2];
};
static inline moray_iterate slope_in(struct slope *s)
{
    return (moray_iterate){.x = s->x, .z_lower = s->z_lower, .z_upper = s->z_upper, .g = s->g, .lambda = s->lambda};
}

#endif
