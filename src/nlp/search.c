// SPDX-License-Identifier: MIT
//
// NLopt; the only file that knows of it.
#include "moray/search.h"

#include <math.h>
#include <nlopt.h>

enum { MOST = MORAY_SEARCH_VARIABLES };

typedef struct {
    const moray_search_spec *spec;
    nlopt_opt search;
    int evaluations;
    bool gave_up, not_finite;
} hunt;

// NLopt's objective. Forcing it to stop is the only way to leave it.
static double evaluate(unsigned n, const double *x, double *gradient, void *self)
{
    (void)n, (void)gradient; // BOBYQA asks for none
    hunt *h = self;
    double value = NAN;
    h->evaluations++;
    h->gave_up = !h->spec->function(x, &value, h->spec->self);
    h->not_finite = !h->gave_up && !isfinite(value);
    if (h->gave_up || h->not_finite) {
        nlopt_force_stop(h->search);
        return INFINITY;
    }
    return value;
}

static moray_status check(const moray_search_spec *spec, const double *x)
{
    if (spec->n < 2 || spec->n > MOST)
        return moray_error(MORAY_INPUT, "search in n = %d variables: must be from 2 to %d", spec->n, MOST);
    for (int i = 0; i < spec->n; i++) {
        const double lower = spec->lower[i], upper = spec->upper[i];
        if (!(isfinite(lower) && isfinite(upper) && lower < upper))
            return moray_error(MORAY_INPUT, "search: bounds %g and %g of variable %d: must be finite and in order",
                               lower, upper, i);
        if (!(x[i] >= lower && x[i] <= upper))
            return moray_error(MORAY_INPUT, "search: x[%d] = %g: must start from %g to %g", i, x[i], lower, upper);
        if (!(spec->step[i] > 0 && spec->step[i] <= (upper - lower) / 2))
            return moray_error(MORAY_INPUT, "search: step[%d] = %g: must lie above 0 and be at most half of %g to %g",
                               i, spec->step[i], lower, upper);
    }
    if (!(spec->tolerance > 0 && spec->tolerance < 1))
        return moray_error(MORAY_INPUT, "search: tolerance = %g: must lie between 0 and 1", spec->tolerance);
    if (spec->max_evaluations < 1)
        return moray_error(MORAY_INPUT, "search: max_evaluations = %d: must be at least 1", spec->max_evaluations);
    return moray_ok();
}

static bool set_tolerance(hunt *h)
{
    double tolerance[MOST];
    for (int i = 0; i < h->spec->n; i++)
        tolerance[i] = h->spec->tolerance * h->spec->step[i];
    return nlopt_set_xtol_rel(h->search, 0) > 0 && nlopt_set_xtol_abs(h->search, tolerance) > 0;
}

static bool configure(hunt *h)
{
    const moray_search_spec *spec = h->spec;
    return nlopt_set_min_objective(h->search, evaluate, h) > 0 && nlopt_set_lower_bounds(h->search, spec->lower) > 0 &&
           nlopt_set_upper_bounds(h->search, spec->upper) > 0 && nlopt_set_initial_step(h->search, spec->step) > 0 &&
           set_tolerance(h) && nlopt_set_maxeval(h->search, spec->max_evaluations) > 0;
}

static bool touches(const moray_search_spec *spec, const double *x)
{
    for (int i = 0; i < spec->n; i++)
        if (fmin(x[i] - spec->lower[i], spec->upper[i] - x[i]) <= spec->tolerance * spec->step[i])
            return true;
    return false;
}

static moray_status conclude(const hunt *h, nlopt_result result)
{
    if (h->gave_up)
        return moray_error(MORAY_INTERRUPTED, "search given up after %d evaluations", h->evaluations);
    if (h->not_finite)
        return moray_error(MORAY_NUMERIC, "search: the function is not finite at evaluation %d", h->evaluations);
    if (result == NLOPT_MAXEVAL_REACHED)
        return moray_error(MORAY_NOT_SOLVED, "search: no minimum to %g within %d evaluations", h->spec->tolerance,
                           h->spec->max_evaluations);
    if (result == NLOPT_OUT_OF_MEMORY)
        return moray_error(MORAY_MEMORY, "search: no memory");
    // Rounding keeps it from any progress: what there is stands.
    if (result > 0 || result == NLOPT_ROUNDOFF_LIMITED)
        return moray_ok();
    return moray_error(MORAY_NUMERIC, "search: NLopt says %s", nlopt_result_to_string(result));
}

moray_status moray_search(const moray_search_spec *spec, double *x, moray_search_end *end)
{
    *end = (moray_search_end){.value = NAN};
    MORAY_TRY(check(spec, x));
    hunt h = {.spec = spec, .search = nlopt_create(NLOPT_LN_BOBYQA, (unsigned)spec->n)};
    if (!h.search)
        return moray_error(MORAY_MEMORY, "search: no memory");
    moray_status status = moray_error(MORAY_NUMERIC, "search: NLopt refuses the settings");
    if (configure(&h))
        status = conclude(&h, nlopt_optimize(h.search, x, &end->value));
    end->evaluations = h.evaluations;
    end->at_bound = touches(spec, x);
    nlopt_destroy(h.search);
    return status;
}
