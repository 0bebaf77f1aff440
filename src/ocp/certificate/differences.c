// SPDX-License-Identifier: MIT
//
// Derivatives of the programme at a solution against differences along dense directions: what the solver believed, told
// apart from what the functions do. A direction makes of the programme a function of one number, which is checked as
// any map is.
#include "ocp/certificate/differences.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/dense.h"
#include "ocp/certificate/columns.h"

enum { directions = 3 };
static const double certain = 1e4;    // doubts of a difference that a disagreement is to exceed
static const double step_part = 0.05; // of a variable's size: the largest step of the differences is 0.02 of it

// The programme along x + in[0] * direction. Outputs: [f, g], or the gradient of the Lagrangian, scaled.
struct ray {
    const moray_solution *solution;
    const moray_nlp *nlp;
    double *size, *direction, *x, *gradient, *entry; // [n] each but the last, of Jacobian or Hessian in turn
};

static void move_to(struct ray *ray, double step)
{
    for (int j = 0; j < ray->nlp->n; j++)
        ray->x[j] = ray->solution->iterate.x[j] + step * ray->direction[j];
}

static double g_scale(const struct ray *ray, int i)
{
    return ray->nlp->g_scale ? ray->nlp->g_scale[i] : 1;
}

static double f_scale(const struct ray *ray)
{
    return ray->nlp->f_scale > 0 ? ray->nlp->f_scale : 1;
}

static void fill_nan(double *out, int n)
{
    for (int i = 0; i < n; i++)
        out[i] = NAN;
}

static void functions_at(void *self, const double *in, double *out)
{
    struct ray *ray = self;
    const moray_nlp *nlp = ray->nlp;
    move_to(ray, in[0]);
    if (!nlp->objective(nlp->self, ray->x, true, out) || !nlp->constraints(nlp->self, ray->x, false, out + 1)) {
        fill_nan(out, 1 + nlp->m);
        return;
    }
    out[0] *= f_scale(ray);
    for (int i = 0; i < nlp->m; i++)
        out[1 + i] *= g_scale(ray, i);
}

static void slopes_at(void *self, const double *in, double *values)
{
    struct ray *ray = self;
    const moray_nlp *nlp = ray->nlp;
    move_to(ray, in[0]);
    memset(values, 0, (size_t)(1 + nlp->m) * sizeof *values);
    if (!nlp->gradient(nlp->self, ray->x, true, ray->gradient) ||
        !nlp->jacobian(nlp->self, ray->x, false, ray->entry)) {
        fill_nan(values, 1 + nlp->m);
        return;
    }
    for (int j = 0; j < nlp->n; j++)
        values[0] += f_scale(ray) * ray->gradient[j] * ray->direction[j];
    for (int k = 0; k < nlp->nnz_jac; k++)
        values[1 + nlp->jac_row[k]] += g_scale(ray, nlp->jac_row[k]) * ray->entry[k] * ray->direction[nlp->jac_col[k]];
}

// What each variable, moved by its size, does to the Lagrangian beside what the objective does.
static void lagrangian_at(void *self, const double *in, double *out)
{
    struct ray *ray = self;
    const moray_nlp *nlp = ray->nlp;
    move_to(ray, in[0]);
    if (!nlp->gradient(nlp->self, ray->x, true, out) || !nlp->jacobian(nlp->self, ray->x, false, ray->entry)) {
        fill_nan(out, nlp->n);
        return;
    }
    for (int k = 0; k < nlp->nnz_jac; k++)
        out[nlp->jac_col[k]] += ray->solution->iterate.lambda[nlp->jac_row[k]] * ray->entry[k];
    for (int j = 0; j < nlp->n; j++)
        out[j] *= f_scale(ray) * ray->size[j];
}

static void lagrangian_slopes_at(void *self, const double *in, double *values)
{
    struct ray *ray = self;
    const moray_nlp *nlp = ray->nlp;
    move_to(ray, in[0]);
    memset(values, 0, (size_t)nlp->n * sizeof *values);
    if (!nlp->hessian(nlp->self, ray->x, true, 1, ray->solution->iterate.lambda, ray->entry)) {
        fill_nan(values, nlp->n);
        return;
    }
    for (int k = 0; k < nlp->nnz_hess; k++) {
        const int r = nlp->hess_row[k], c = nlp->hess_col[k];
        const double value = f_scale(ray) * ray->entry[k];
        values[r] += value * ray->size[r] * ray->direction[c];
        if (r != c)
            values[c] += value * ray->size[c] * ray->direction[r];
    }
}

// Factors of 0.5 to 1.5 and both signs, other ones for every direction. Beyond bounds the functions need not exist:
// variables that a step would take past one stay, but along the first direction, which is walked to one side, go
// inwards.
static void set_direction(struct ray *ray, int which)
{
    const moray_nlp *nlp = ray->nlp;
    for (int j = 0; j < nlp->n; j++) {
        const double entry = moray_dense_entry(j, MORAY_DENSE_COLUMNS + which);
        const double step = step_part * fabs(entry) * ray->size[j], x = ray->solution->iterate.x[j];
        const bool low = x - 0.02 * step<nlp->x_lower[j], high = x + 0.02 * step> nlp->x_upper[j];
        const double inwards = which > 0 || (low && high) ? 0 : low ? 1 : -1;
        ray->direction[j] = step * (low || high ? inwards : copysign(1, entry));
    }
}

static moray_status dense_column(moray_map *map, struct ray *ray, int n_out)
{
    *map = (moray_map){.n_in = 1, .n_out = n_out, .self = ray};
    MORAY_TRY(moray_pattern_new(&map->jac, n_out));
    for (int i = 0; i < n_out; i++)
        map->jac.row[i] = i;
    return moray_ok();
}

// Relative to 1 + what is found and to what that is in doubt; at a kink from the slope on the nearer side. Where
// nothing is found, nothing is said of a number.
static double disagreement(double given, double found, double doubt, double kink)
{
    if (isnan(found) && isfinite(given))
        return 0;
    const double far = fmin(fabs(given - (found + kink)), fabs(given - (found - kink)));
    const double error = far / (1 + fabs(found) + certain * doubt);
    return isnan(far) ? INFINITY : isnan(error) ? 0 : error;
}

static moray_status check_along(const moray_map *map, int which, double *worst)
{
    const double here = 0, size = 1;
    const moray_bounds box = which > 0 ? moray_free() : moray_at_least(0);
    const size_t n = (size_t)map->n_out;
    double *given = calloc(4 * n + 1, sizeof *given);
    if (!given)
        return moray_error(MORAY_MEMORY, "no memory to check derivatives of %d functions", map->n_out);
    double *found = given + n, *doubt = found + n, *kink = doubt + n;
    const moray_status status = moray_difference_columns(map, &here, &size, &box, found, doubt, kink);
    map->jacobian(map->self, &here, given);
    for (size_t i = 0; i < n && !moray_failed(status); i++)
        *worst = fmax(*worst, disagreement(given[i], found[i], doubt[i], kink[i]));
    free(given);
    return status;
}

static moray_status check_all(struct ray *ray, double *worst)
{
    moray_map functions, lagrangian = {0};
    moray_status status = dense_column(&functions, ray, 1 + ray->nlp->m);
    if (!moray_failed(status))
        status = dense_column(&lagrangian, ray, ray->nlp->n);
    functions.value = functions_at, functions.jacobian = slopes_at;
    lagrangian.value = lagrangian_at, lagrangian.jacobian = lagrangian_slopes_at;
    for (int k = 0; k < directions && !moray_failed(status); k++) {
        set_direction(ray, k);
        status = check_along(&functions, k, worst);
        if (!moray_failed(status))
            status = check_along(&lagrangian, k, worst);
    }
    moray_pattern_free(&functions.jac);
    moray_pattern_free(&lagrangian.jac);
    return status;
}

moray_status moray_difference_solution(const struct witness *w, double *worst)
{
    const moray_solution *solution = w->solution;
    struct transcription *t = solution->transcription;
    const moray_nlp *nlp = &t->nlp;
    const moray_status failure = t->failure;
    const int failures = t->failures;
    const size_t n = (size_t)nlp->n;
    double *block = calloc(4 * n + (size_t)fmax(nlp->nnz_jac, nlp->nnz_hess) + 1, sizeof *block);
    *worst = 0;
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory to check %d variables", nlp->n);
    struct ray ray = {.solution = solution, .nlp = nlp, .direction = block, .x = block + n, .gradient = block + 2 * n};
    ray.size = block + 3 * n;
    ray.entry = block + 4 * n;
    moray_witness_columns(w, ray.size);
    for (int j = 0; j < nlp->n; j++) // a box may be wide beside what the trajectory does of it
        ray.size[j] = nlp->x_scale ? fmin(ray.size[j], 1 / nlp->x_scale[j]) : ray.size[j];
    const moray_status status = check_all(&ray, worst);
    free(block);
    moray_transcription_jacobians(t, solution->iterate.x); // accessors read the caches
    t->failure = failure;
    t->failures = failures;
    return status;
}
