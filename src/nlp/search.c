// SPDX-License-Identifier: MIT
//
// The one file that knows NLopt.
#include "moray/search.h"

#include <math.h>
#include <nlopt.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "moray/clock.h"

static const struct method {
    const char *name;
    nlopt_algorithm plain, constrained, blind; // blind: without gradients; NLOPT_NUM_ALGORITHMS: there is none
    bool global;
} methods[] = {
    [MORAY_SEARCH_SLSQP] = {"slsqp", NLOPT_LD_SLSQP, NLOPT_LD_SLSQP, NLOPT_NUM_ALGORITHMS, false},
    [MORAY_SEARCH_MMA] = {"mma", NLOPT_LD_MMA, NLOPT_LD_MMA, NLOPT_NUM_ALGORITHMS, false},
    [MORAY_SEARCH_COBYLA] = {"cobyla", NLOPT_LN_COBYLA, NLOPT_LN_COBYLA, NLOPT_LN_COBYLA, false},
    [MORAY_SEARCH_BOBYQA] = {"bobyqa", NLOPT_LN_BOBYQA, NLOPT_NUM_ALGORITHMS, NLOPT_LN_BOBYQA, false},
    [MORAY_SEARCH_MLSL] = {"mlsl", NLOPT_G_MLSL_LDS, NLOPT_AUGLAG, NLOPT_G_MLSL_LDS, true},
    [MORAY_SEARCH_ISRES] = {"isres", NLOPT_GN_ISRES, NLOPT_GN_ISRES, NLOPT_GN_ISRES, true},
    [MORAY_SEARCH_DIRECT] = {"direct", NLOPT_GN_DIRECT_L, NLOPT_GN_ORIG_DIRECT_L, NLOPT_GN_DIRECT_L, true},
};
enum { METHODS = sizeof methods / sizeof *methods };

const char *moray_search_method_name(moray_search_method method)
{
    return (unsigned)method < METHODS ? methods[method].name : "unknown";
}

moray_search_settings moray_search_settings_default(void)
{
    return (moray_search_settings){
        .x_tolerance = 1e-10, .f_tolerance = 1e-12, .constraint_tolerance = 1e-9, .max_evaluations = 2000, .seed = 1};
}

const char *moray_search_outcome_text(moray_search_outcome outcome)
{
    static const char *const texts[] = {"converged", "evaluation limit", "time limit", "interrupted", "failed"};
    return (unsigned)outcome < sizeof texts / sizeof *texts ? texts[outcome] : "unknown";
}

// A point with its function values.
struct point {
    double *x; // [n]
    double f, violation;
};

struct session {
    const moray_search_problem *problem;
    const moray_search_settings *settings;
    moray_search_info *info;
    nlopt_opt opt;
    struct point last, best;
    double *c, *gradient, *jacobian;   // of the last point, the latter two when `sloped`
    double *lower, *upper, *tolerance; // as NLopt has them
    bool any, defined, sloped;         // there is a last point; it is defined; its gradients are known
    bool found;                        // there is a best point
    int repeats;                       // of one point in succession
    bool stalled;                      // they were too many
};

enum { MOST_REPEATS = 20 }; // a local method that asks more often for one point gets no further for rounding

static bool better(const struct point *one, const struct point *other, double tolerance)
{
    const bool inside = one->violation <= tolerance, other_inside = other->violation <= tolerance;
    if (inside != other_inside)
        return inside;
    return inside ? one->f < other->f : one->violation < other->violation;
}

static void keep_best(struct session *s)
{
    if (!s->defined || (s->found && !better(&s->last, &s->best, s->settings->constraint_tolerance)))
        return;
    s->found = true;
    s->best.f = s->last.f;
    s->best.violation = s->last.violation;
    memcpy(s->best.x, s->last.x, (size_t)s->problem->n * sizeof(double));
}

static void tell(struct session *s)
{
    const moray_search_progress progress = {s->info->evaluations, s->best.x, s->best.f, s->best.violation};
    if (s->settings->progress && s->found && !s->settings->progress(s->settings->observer, &progress))
        nlopt_force_stop(s->opt);
}

// NLopt asks for f and for c apart, with gradients or without: all come from one evaluation.
static void evaluate(struct session *s, const double *x, bool slopes)
{
    const moray_search_problem *p = s->problem;
    const bool again = s->any && memcmp(x, s->last.x, (size_t)p->n * sizeof *x) == 0;
    s->repeats = again ? s->repeats + 1 : 0;
    if (s->repeats == MOST_REPEATS && !methods[s->settings->method].global) {
        s->stalled = true;
        nlopt_force_stop(s->opt);
    }
    if (again && (s->sloped || !slopes))
        return;
    memcpy(s->last.x, x, (size_t)p->n * sizeof *x);
    s->any = true;
    s->sloped = slopes;
    s->defined = p->evaluate(p->self, x, &s->last.f, s->c, slopes ? s->gradient : NULL, slopes ? s->jacobian : NULL) &&
                 isfinite(s->last.f) && moray_all_finite(s->c, p->m) &&
                 (!slopes || (moray_all_finite(s->gradient, p->n) && moray_all_finite(s->jacobian, p->m * p->n)));
    s->last.violation = 0;
    for (int i = 0; i < p->m; i++)
        s->last.violation = fmax(s->last.violation, s->c[i]);
    s->info->evaluations++;
    keep_best(s);
    tell(s);
}

static double on_objective(unsigned n, const double *x, double *gradient, void *data)
{
    struct session *s = data;
    evaluate(s, x, gradient != NULL);
    if (gradient && s->defined)
        memcpy(gradient, s->gradient, n * sizeof *gradient);
    else if (gradient)
        memset(gradient, 0, n * sizeof *gradient);
    return s->defined ? s->last.f : HUGE_VAL;
}

static void on_constraints(unsigned m, double *c, unsigned n, const double *x, double *jacobian, void *data)
{
    struct session *s = data;
    evaluate(s, x, jacobian != NULL);
    for (unsigned i = 0; i < m; i++)
        c[i] = s->defined ? s->c[i] : HUGE_VAL;
    if (jacobian && s->defined)
        memcpy(jacobian, s->jacobian, (size_t)m * n * sizeof *jacobian);
    else if (jacobian)
        memset(jacobian, 0, (size_t)m * n * sizeof *jacobian);
}

// ---- Setting up ----------------------------------------------------------------------------------------------------

static moray_status check_problem(const moray_search_problem *p, const struct method *method)
{
    for (int j = 0; j < p->n; j++) {
        const bool bounded = p->lower[j] > -MORAY_INFINITY && p->upper[j] < MORAY_INFINITY;
        if (!(p->lower[j] <= p->upper[j]))
            return moray_error(MORAY_INPUT, "bounds of x[%d] = %g:%g: must be a range lo:hi", j, p->lower[j],
                               p->upper[j]);
        if (method->global && !bounded)
            return moray_error(MORAY_INPUT, "bounds of x[%d] = %g:%g: %s needs finite ones", j, p->lower[j],
                               p->upper[j], method->name);
    }
    if (!p->gradients && method->blind == NLOPT_NUM_ALGORITHMS)
        return moray_error(MORAY_INPUT, "method = %s: needs gradients, and the problem has none", method->name);
    if (p->m > 0 && method->constrained == NLOPT_NUM_ALGORITHMS)
        return moray_error(MORAY_INPUT, "method = %s: takes no constraints, and the problem has %d", method->name,
                           p->m);
    return moray_ok();
}

static moray_status check_settings(const moray_search_settings *settings)
{
    if ((unsigned)settings->method >= METHODS)
        return moray_error(MORAY_INPUT, "method = %d: there is no such one", (int)settings->method);
    const double tolerances[] = {settings->x_tolerance, settings->f_tolerance, settings->constraint_tolerance};
    const char *const names[] = {"x_tolerance", "f_tolerance", "constraint_tolerance"};
    for (int k = 0; k < 3; k++)
        if (!(tolerances[k] >= 0 && tolerances[k] < 1))
            return moray_error(MORAY_INPUT, "%s = %g: must lie between 0 and 1", names[k], tolerances[k]);
    if (settings->max_evaluations < 1)
        return moray_error(MORAY_INPUT, "max_evaluations = %d: must be at least 1", settings->max_evaluations);
    if (!(settings->max_seconds >= 0) || settings->population < 0)
        return moray_error(MORAY_INPUT, "max_seconds = %g, population = %d: must not be below 0", settings->max_seconds,
                           settings->population);
    return moray_ok();
}

static bool set_tolerances(nlopt_opt opt, const moray_search_settings *settings)
{
    return nlopt_set_xtol_rel(opt, settings->x_tolerance) == NLOPT_SUCCESS &&
           nlopt_set_ftol_rel(opt, settings->f_tolerance) == NLOPT_SUCCESS;
}

// The methods below another: MLSL's local search, and with constraints MLSL itself below the augmented Lagrangian.
static bool set_sub_methods(nlopt_opt opt, const moray_search_problem *p, const moray_search_settings *settings)
{
    const unsigned n = (unsigned)p->n;
    nlopt_opt local = nlopt_create(p->gradients ? NLOPT_LD_SLSQP : NLOPT_LN_COBYLA, n);
    nlopt_opt middle = p->m > 0 ? nlopt_create(NLOPT_G_MLSL_LDS, n) : NULL;
    nlopt_opt global = middle ? middle : opt;
    bool ok = local && (middle || p->m == 0) && set_tolerances(local, settings) &&
              nlopt_set_local_optimizer(global, local) == NLOPT_SUCCESS &&
              nlopt_set_population(global, (unsigned)settings->population) == NLOPT_SUCCESS;
    if (middle) // it stops by the count alone, which the rounds of the Lagrangian share
        ok = ok && nlopt_set_maxeval(middle, 1 + settings->max_evaluations / 4) == NLOPT_SUCCESS &&
             nlopt_set_local_optimizer(opt, middle) == NLOPT_SUCCESS;
    nlopt_destroy(middle);
    nlopt_destroy(local);
    return ok;
}

static bool set_up(struct session *s)
{
    const moray_search_problem *p = s->problem;
    const moray_search_settings *settings = s->settings;
    for (int j = 0; j < p->n; j++) {
        s->lower[j] = p->lower[j] > -MORAY_INFINITY ? p->lower[j] : -HUGE_VAL;
        s->upper[j] = p->upper[j] < MORAY_INFINITY ? p->upper[j] : HUGE_VAL;
    }
    for (int i = 0; i < p->m; i++)
        s->tolerance[i] = settings->constraint_tolerance;
    bool ok = nlopt_set_min_objective(s->opt, on_objective, s) == NLOPT_SUCCESS &&
              nlopt_set_lower_bounds(s->opt, s->lower) == NLOPT_SUCCESS &&
              nlopt_set_upper_bounds(s->opt, s->upper) == NLOPT_SUCCESS &&
              nlopt_set_maxeval(s->opt, settings->max_evaluations) == NLOPT_SUCCESS &&
              nlopt_set_maxtime(s->opt, settings->max_seconds) == NLOPT_SUCCESS;
    if (p->m > 0)
        ok = ok &&
             nlopt_add_inequality_mconstraint(s->opt, (unsigned)p->m, on_constraints, s, s->tolerance) == NLOPT_SUCCESS;
    if (!methods[settings->method].global)
        ok = ok && set_tolerances(s->opt, settings);
    if (settings->method == MORAY_SEARCH_MLSL)
        ok = ok && set_sub_methods(s->opt, p, settings);
    if (settings->method == MORAY_SEARCH_ISRES)
        ok = ok && nlopt_set_population(s->opt, (unsigned)settings->population) == NLOPT_SUCCESS;
    return ok;
}

// ---- Running -------------------------------------------------------------------------------------------------------

static moray_search_outcome outcome_of(const struct session *s, nlopt_result result)
{
    if (result == NLOPT_FORCED_STOP && s->stalled)
        return MORAY_SEARCH_CONVERGED;
    switch (result) {
    case NLOPT_SUCCESS:
    case NLOPT_STOPVAL_REACHED:
    case NLOPT_FTOL_REACHED:
    case NLOPT_XTOL_REACHED:
    case NLOPT_ROUNDOFF_LIMITED:
        return MORAY_SEARCH_CONVERGED;
    case NLOPT_MAXEVAL_REACHED:
        return MORAY_SEARCH_EVALUATION_LIMIT;
    case NLOPT_MAXTIME_REACHED:
        return MORAY_SEARCH_TIME_LIMIT;
    case NLOPT_FORCED_STOP:
        return MORAY_SEARCH_INTERRUPTED;
    default:
        return MORAY_SEARCH_FAILED;
    }
}

static moray_status make_memory(struct session *s)
{
    const size_t n = (size_t)s->problem->n, m = (size_t)s->problem->m;
    double *memory = calloc(5 * n + (2 + n) * m + 1, sizeof *memory);
    if (!memory)
        return moray_error(MORAY_MEMORY, "no memory for a search in %d variables", s->problem->n);
    s->last.x = memory;
    s->best.x = s->last.x + n;
    s->gradient = s->best.x + n;
    s->lower = s->gradient + n;
    s->upper = s->lower + n;
    s->c = s->upper + n;
    s->tolerance = s->c + m;
    s->jacobian = s->tolerance + m;
    return moray_ok();
}

// The result is the best point of all that were tried, which the session keeps: NLopt may end at another, infeasible
// one.
static moray_status run(struct session *s, double *x)
{
    const moray_search_problem *p = s->problem;
    double f;
    if (!set_up(s))
        return moray_error(MORAY_INPUT, "NLopt refuses the search: %s",
                           nlopt_get_errmsg(s->opt) ? nlopt_get_errmsg(s->opt) : "it does not say why");
    for (int j = 0; j < p->n; j++)
        x[j] = fmax(p->lower[j], fmin(p->upper[j], x[j]));
    nlopt_srand(s->settings->seed);
    const nlopt_result result = nlopt_optimize(s->opt, x, &f);
    s->info->outcome = outcome_of(s, result);
    if (result == NLOPT_OUT_OF_MEMORY)
        return moray_error(MORAY_MEMORY, "no memory for a search in %d variables", p->n);
    if (result == NLOPT_INVALID_ARGS)
        return moray_error(MORAY_INPUT, "NLopt refuses the search: %s",
                           nlopt_get_errmsg(s->opt) ? nlopt_get_errmsg(s->opt) : "it does not say why");
    if (!s->found)
        return moray_error(MORAY_NUMERIC, "the functions are not finite at any of %d points", s->info->evaluations);
    memcpy(x, s->best.x, (size_t)p->n * sizeof *x);
    s->info->objective = s->best.f;
    s->info->violation = s->best.violation;
    return moray_ok();
}

moray_status moray_search(const moray_search_problem *problem, const moray_search_settings *settings, double *x,
                          moray_search_info *info)
{
    *info = (moray_search_info){.outcome = MORAY_SEARCH_FAILED};
    MORAY_TRY(check_settings(settings));
    const struct method *method = &methods[settings->method];
    MORAY_TRY(check_problem(problem, method));
    struct session s = {.problem = problem, .settings = settings, .info = info};
    const double start = moray_clock();
    MORAY_TRY(make_memory(&s));
    s.opt = nlopt_create(problem->m > 0 ? method->constrained : method->plain, (unsigned)problem->n);
    moray_status status = s.opt ? run(&s, x) : moray_error(MORAY_MEMORY, "no memory for a search");
    nlopt_destroy(s.opt);
    free(s.last.x);
    info->seconds = moray_clock() - start;
    return status;
}
