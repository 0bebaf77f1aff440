// SPDX-License-Identifier: MIT
#include <math.h>

#include "nlp/sensitivity.h"

// Of a multiplier and a slack in the scale of the solver that do not tell which of them is to be 0: neither is large,
// nor much larger than the other (at an interior point their product is the same everywhere), or both are nothing.
static bool in_doubt(double slack, double multiplier)
{
    const double large = 1e-4, much = 10, nothing = 1e-8, larger = fmax(slack, multiplier);
    return larger < large && larger <= fmax(nothing, much * sqrt(fmax(slack * multiplier, 0)));
}

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

double moray_objective_scale(const moray_nlp *nlp)
{
    return nlp->f_scale != 0 ? nlp->f_scale : 1;
}

// An interior-point solution is never at a bound: a bound is active where its multiplier outweighs its slack, in the
// solver's scale.
void moray_find_activity(moray_nlp_sensitivity *s)
{
    const moray_nlp *nlp = s->nlp;
    const double f_scale = moray_objective_scale(nlp);
    for (int i = 0; i < nlp->m + nlp->n; i++)
        for (int upper = 0; upper < 2; upper++) {
            const struct side side = side_of(nlp, s->at, i, upper);
            const double slack = side.slack * side.scale, multiplier = side.multiplier * f_scale / side.scale;
            if (side.fixed)
                s->activity[i] = EQUAL;
            else if (side.bounded && multiplier > slack)
                s->activity[i] = upper ? AT_UPPER : AT_LOWER;
            if (!side.fixed && side.bounded)
                s->weak[i] = s->weak[i] || in_doubt(slack, multiplier);
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

// ---- Changes of the active set -------------------------------------------------------------------------------------

// The step at which what is `value` > 0 now and changes at `rate` is 0; infinite where it never is.
static double step_to_zero(double value, double rate, int direction)
{
    return rate * direction < 0 ? fmax(value, 0) / fabs(rate) : INFINITY;
}

double moray_bound_slope(const moray_nlp *nlp, const moray_nlp_shift *shift, int i, bool upper)
{
    const double *of_rows = upper ? shift->g_upper : shift->g_lower;
    const double *of_columns = upper ? shift->x_upper : shift->x_lower;
    if (i < nlp->m)
        return of_rows ? of_rows[i] : 0;
    return of_columns ? of_columns[i - nlp->m] : 0;
}

// How far the parameter may go until a multiplier of an active bound, or the slack of an inactive one, reaches zero
// linearly.
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
        const double gap = moray_bound_slope(nlp, shift, i, upper) - value;
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
