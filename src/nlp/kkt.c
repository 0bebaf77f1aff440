// SPDX-License-Identifier: MIT
#include "moray/nlp.h"

#include <math.h>
#include <stdlib.h>

#include "base/number.h"

// What is not a number is worse than any.
static void keep_worst(double *worst, int *where, double value, int here)
{
    if (!(value <= *worst || isnan(*worst))) {
        *worst = value;
        *where = here;
    }
}

// Relative to 1 + |bound| + size; not above 0 where there is none.
static double violation(double value, double lower, double upper, double size)
{
    const double below = lower > -MORAY_INFINITY ? (lower - value) / (1 + fabs(lower) + size) : 0;
    const double above = upper < MORAY_INFINITY ? (value - upper) / (1 + fabs(upper) + size) : 0;
    return moray_worse(below, above);
}

// max(1, mean |multiplier|), so that a problem stated in small units does not look unsolved
static double mean_multiplier(const moray_nlp *nlp, const moray_iterate *it)
{
    double sum = 0;
    for (int i = 0; i < nlp->m; i++)
        sum += fabs(it->lambda[i]);
    for (int j = 0; j < nlp->n; j++)
        sum += fabs(it->z_lower[j]) + fabs(it->z_upper[j]);
    const double mean = sum / (nlp->m + 2.0 * nlp->n);
    return mean <= 1 ? 1 : mean;
}

// A multiplier must vanish or its constraint be active.
static double row_complementarity(const moray_nlp *nlp, const moray_iterate *it, const double *g, int i)
{
    if (nlp->g_lower[i] == nlp->g_upper[i])
        return 0;
    const double bound = it->lambda[i] > 0 ? nlp->g_upper[i] : nlp->g_lower[i];
    return fabs(bound) >= MORAY_INFINITY ? fabs(it->lambda[i]) : fabs(it->lambda[i] * (bound - g[i]));
}

// A multiplier of a bound is not negative, and none of a bound that is not there.
static double side_complementarity(double z, double bound, double x)
{
    return z < 0 || fabs(bound) >= MORAY_INFINITY ? fabs(z) : z * fabs(bound - x);
}

static double bound_complementarity(const moray_nlp *nlp, const moray_iterate *it, int j)
{
    return fmax(side_complementarity(it->z_lower[j], nlp->x_lower[j], it->x[j]),
                side_complementarity(it->z_upper[j], nlp->x_upper[j], it->x[j]));
}

// gradient <- d L / d x
static void lagrangian_gradient(const moray_nlp *nlp, const moray_iterate *it, const double *jac, double *gradient)
{
    for (int k = 0; k < nlp->nnz_jac; k++)
        gradient[nlp->jac_col[k]] += it->lambda[nlp->jac_row[k]] * jac[k];
    for (int j = 0; j < nlp->n; j++)
        gradient[j] += it->z_upper[j] - it->z_lower[j];
}

// size[m]: largest |slope x_j| of each constraint, below whose rounding nothing can be asked of it
static void constraint_sizes(const moray_nlp *nlp, const moray_iterate *it, const double *jac, double *size)
{
    for (int k = 0; k < nlp->nnz_jac; k++)
        size[nlp->jac_row[k]] = fmax(size[nlp->jac_row[k]], fabs(jac[k] * it->x[nlp->jac_col[k]]));
}

static void measure(const moray_nlp *nlp, const moray_iterate *it, const double *g, const double *size,
                    const double *gradient, moray_kkt *kkt)
{
    *kkt = (moray_kkt){.dual_scale = mean_multiplier(nlp, it), .worst_variable = -1, .worst_constraint = -1};
    int ignored;
    for (int j = 0; j < nlp->n; j++) {
        if (nlp->x_lower[j] < nlp->x_upper[j]) // a fixed variable's own multiplier takes up whatever is left
            keep_worst(&kkt->stationarity, &kkt->worst_variable, fabs(gradient[j]) / kkt->dual_scale, j);
        keep_worst(&kkt->feasibility, &kkt->worst_constraint, violation(it->x[j], nlp->x_lower[j], nlp->x_upper[j], 0),
                   nlp->m + j);
        if (nlp->x_lower[j] < nlp->x_upper[j])
            keep_worst(&kkt->complementarity, &ignored, bound_complementarity(nlp, it, j) / kkt->dual_scale, j);
    }
    for (int i = 0; i < nlp->m; i++) {
        keep_worst(&kkt->feasibility, &kkt->worst_constraint,
                   violation(g[i], nlp->g_lower[i], nlp->g_upper[i], size[i]), i);
        keep_worst(&kkt->complementarity, &ignored, row_complementarity(nlp, it, g, i) / kkt->dual_scale, i);
    }
    const double parts[] = {kkt->stationarity, kkt->feasibility, kkt->complementarity};
    for (int k = 0; k < 3; k++)
        keep_worst(&kkt->error, &ignored, parts[k], k);
}

// gradient f + J' lambda - z_lower + z_upper, feasibility and complementarity anew from the callbacks, in unscaled
// units.
moray_status moray_kkt_error(const moray_nlp *nlp, const moray_iterate *iterate, moray_kkt *kkt)
{
    const int values = nlp->n + nlp->m + nlp->nnz_jac;
    double *block = calloc((size_t)(values + nlp->m) + 1, sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory to check %d variables", nlp->n);
    double *gradient = block, *g = block + nlp->n, *jac = g + nlp->m, *size = jac + nlp->nnz_jac;
    const bool ok = nlp->constraints(nlp->self, iterate->x, true, g) &&
                    nlp->gradient(nlp->self, iterate->x, false, gradient) &&
                    nlp->jacobian(nlp->self, iterate->x, false, jac) && moray_all_finite(block, values);
    if (ok) {
        lagrangian_gradient(nlp, iterate, jac, gradient);
        constraint_sizes(nlp, iterate, jac, size);
        measure(nlp, iterate, g, size, gradient, kkt);
    }
    free(block);
    return ok ? moray_ok() : moray_error(MORAY_NUMERIC, "a function of the problem is not finite at the solution");
}
