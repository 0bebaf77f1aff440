// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "ocp/names.h"
#include "ocp/solution.h"

enum { named_size = 160, listed = 6 };

__attribute__((format(printf, 2, 3))) static void say(moray_solution *solution, const char *format, ...)
{
    const size_t used = strlen(solution->diagnosis);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(solution->diagnosis + used, diagnosis_size - used, format, arguments);
    va_end(arguments);
}

static double distance_outside(double value, double lower, double upper)
{
    return fmax(fmax(lower - value, value - upper), 0);
}

static void say_worst_violation(moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    const moray_nlp *nlp = &t->nlp;
    const moray_iterate *it = &solution->iterate;
    double worst = 0;
    int where = -1;
    for (int i = 0; i < nlp->m; i++) {
        const double scale = nlp->g_scale ? nlp->g_scale[i] : 1;
        const double violation = scale * distance_outside(it->g[i], nlp->g_lower[i], nlp->g_upper[i]);
        if (violation > worst) {
            worst = violation;
            where = i;
        }
    }
    if (where < 0 || worst < solution->settings.tolerance) {
        say(solution, "No constraint is violated by more than %.1e (scaled).\n", solution->settings.tolerance);
        return;
    }
    char name[named_size];
    layout_row_name(&t->layout, t->ocp, it->x, where, name, named_size);
    say(solution, "Largest violation: %s, %.3g where [%.6g, %.6g] is allowed (scaled %.1e).\n", name, it->g[where],
        nlp->g_lower[where], nlp->g_upper[where], worst);
}

// Parameters, times and events that sit on a bound with a multiplier: what holds the solution back.
static void say_active(moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    const moray_nlp *nlp = &t->nlp;
    const moray_iterate *it = &solution->iterate;
    char name[named_size];
    int said = 0;
    for (int j = 0; j < nlp->n && said < listed; j++) {
        const double multiplier = it->z_upper[j] - it->z_lower[j],
                     bound = multiplier > 0 ? nlp->x_upper[j] : nlp->x_lower[j];
        if (nlp->x_lower[j] == nlp->x_upper[j] || fabs(multiplier) < 1e-4 ||
            fabs(it->x[j] - bound) > 1e-5 * (1 + fabs(bound)))
            continue;
        layout_column_name(&t->layout, t->ocp, it->x, j, name, named_size);
        say(solution, "%s%s at its %s bound %.6g", said++ ? "; " : "Active: ", name, multiplier > 0 ? "upper" : "lower",
            bound);
    }
    for (int i = 0; i < nlp->m && said < listed; i++) {
        const double bound = it->lambda[i] > 0 ? nlp->g_upper[i] : nlp->g_lower[i];
        if (nlp->g_lower[i] == nlp->g_upper[i] || fabs(it->lambda[i]) < 1e-4)
            continue;
        layout_row_name(&t->layout, t->ocp, it->x, i, name, named_size);
        say(solution, "%s%s at its %s bound %.6g", said++ ? "; " : "Active: ", name,
            it->lambda[i] > 0 ? "upper" : "lower", bound);
    }
    say(solution, said ? ".\n" : "No bound is active.\n");
}

void diagnose(moray_solution *solution)
{
    solution->diagnosis[0] = 0;
    say(solution, "%s after %d iterations.\n", moray_nlp_outcome_text(solution->info.outcome),
        solution->info.iterations);
    assemble_constraints(solution->transcription, solution->iterate.g);
    say_worst_violation(solution);
    say_active(solution);
}
