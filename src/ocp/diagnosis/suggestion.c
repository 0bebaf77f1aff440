// SPDX-License-Identifier: MIT
//
// Why a programme was not solved: the likely causes in turn, each with the evidence for it. The first that has evidence
// is the one thing to try that the diagnosis names.
#include <math.h>
#include <stdlib.h>

#include "ocp/diagnosis/diagnosis.h"

static const double feasible = 1e-6;
enum { most_inputs = 120 }; // of a function whose derivatives are checked

// ---- Wrong derivatives ----

static bool can_be_checked(const moray_ocp *ocp)
{
    bool analytic = ocp->endpoint_real_fn == NULL;
    for (int p = 0; p < ocp->phases; p++)
        analytic = analytic && ocp->phase[p].map->n_in <= most_inputs && !moray_phase_is_differenced(&ocp->phase[p]);
    return analytic && ocp->endpoint->map->n_in <= most_inputs;
}

static bool wrong_derivative(const struct evidence *e)
{
    moray_ocp_derivative_report report;
    if (!can_be_checked(e->t->ocp) || moray_failed(moray_ocp_check_derivatives(e->t->ocp, &report)))
        return false;
    if (report.jacobian_error > 1e-3)
        moray_diagnosis_say(e->solution, "Try: correct a derivative. %s.\n", report.jacobian);
    else if (report.hessian_error > 1e-2)
        moray_diagnosis_say(e->solution, "Try: correct a second derivative. %s.\n", report.hessian);
    return report.jacobian_error > 1e-3 || report.hessian_error > 1e-2;
}

// ---- Too few variables ----

static bool too_few_variables(const struct evidence *e)
{
    const moray_nlp *nlp = &e->t->nlp;
    int equations = 0, variables = 0;
    for (int i = 0; i < nlp->m; i++)
        equations += nlp->g_lower[i] == nlp->g_upper[i];
    for (int j = 0; j < nlp->n; j++)
        variables += nlp->x_lower[j] != nlp->x_upper[j];
    if (equations <= variables)
        return false;
    moray_diagnosis_say(
        e->solution, "Try: free an end value or a time, or add a control: there are %d equations for %d variables.\n",
        equations, variables);
    return true;
}

// ---- Functions outside their domain, variables that run away ----

static bool not_finite(const struct evidence *e)
{
    const bool gave_up = e->solution->info.outcome != MORAY_NLP_ITERATION_LIMIT;
    if (e->t->failures == 0 || (!gave_up && 2 * e->t->failures < e->solution->info.iterations))
        return false;
    moray_diagnosis_say(e->solution, "Try: bounds that keep the functions in their domain. Last, %s.\n",
                        e->t->failure.text);
    return true;
}

struct search {
    const struct evidence *e;
    double most;
    struct band band;
    bool upper;
};

static void find_runaway(const struct band *band, void *self)
{
    struct search *search = self;
    const struct evidence *e = search->e;
    for (int n = 0; !band->rows && n < moray_band_members(e->t, band); n++) {
        const int j = moray_band_member(e->t, band, n);
        if (j == absent)
            continue;
        const struct standing s = moray_standing_of(e->solution, false, j);
        const bool upper = s.value > 0, free = upper ? s.upper >= MORAY_INFINITY : s.lower <= -MORAY_INFINITY;
        if (free && s.scale * fabs(s.value) > search->most)
            *search = (struct search){e, s.scale * fabs(s.value), *band, upper};
    }
}

// An objective that keeps falling with variables far beyond their guess: nothing bounds it.
static bool runaway(const struct evidence *e)
{
    struct search search = {.e = e, .most = 1e4};
    moray_visit_bands(e->t, find_runaway, &search);
    if (search.most <= 1e4)
        return false;
    char name[name_size];
    double reached = 0, guessed = 0;
    moray_band_name(e->solution, &search.band, name, name_size);
    for (int n = 0; n < moray_band_members(e->t, &search.band); n++) {
        const int j = moray_band_member(e->t, &search.band, n);
        if (j != absent) {
            reached = fmax(reached, fabs(e->solution->iterate.x[j]));
            guessed = fmax(guessed, fabs(e->solution->guess[j]));
        }
    }
    moray_diagnosis_say(e->solution, "Try: %s bound for %s, which went to %s%.3g from a guess of at most %.3g.\n",
                        search.upper ? "an upper" : "a lower", name, search.upper ? "" : "-", reached, guessed);
    return true;
}

// ---- The choice ----

static void say_otherwise(const struct evidence *e)
{
    const moray_settings *settings = &e->solution->settings;
    if (e->solution->info.outcome == MORAY_NLP_ITERATION_LIMIT)
        moray_diagnosis_say(e->solution, "Try: more than max_iterations = %d, from this solution as the guess.\n",
                            settings->max_iterations);
    else if (e->worst < feasible) // Ipopt's acceptable level is 1e-6
        moray_diagnosis_say(e->solution, "Try: tolerance = %.0e; rounding in the functions hides anything finer.\n",
                            fmax(1e-6, 100 * settings->tolerance));
    else
        moray_diagnosis_say(e->solution,
                            "Try: another guess; no bound stands in the way, yet from here the violation does not "
                            "shrink.\n");
}

static void choose(struct evidence *e)
{
    const moray_nlp_outcome outcome = e->solution->info.outcome;
    const bool violated = e->worst > feasible, gave_up = outcome != MORAY_NLP_ITERATION_LIMIT;
    if (outcome == MORAY_NLP_INTERRUPTED)
        moray_diagnosis_say(e->solution, "Try: go on, with this solution as the guess.\n");
    else if (!too_few_variables(e) && !wrong_derivative(e) && !not_finite(e) &&
             !(violated && moray_dependent_constraints(e)) && !runaway(e) &&
             !(outcome != MORAY_NLP_INFEASIBLE && moray_has_kink(e)) &&
             !(violated && gave_up && moray_hardest_bound(e)))
        say_otherwise(e);
}

static void gather(struct evidence *e)
{
    const moray_nlp *nlp = &e->t->nlp;
    for (int i = 0; i < nlp->m; i++) {
        e->violation[i] = moray_scaled_violation(e->solution, i);
        e->worst = fmax(e->worst, fabs(e->violation[i]));
    }
    nlp->jacobian(nlp->self, e->solution->iterate.x, false, e->jac);
    for (int k = 0; k < nlp->nnz_jac; k++)
        e->jac[k] *=
            (nlp->g_scale ? nlp->g_scale[nlp->jac_row[k]] : 1) / (nlp->x_scale ? nlp->x_scale[nlp->jac_col[k]] : 1);
}

void moray_diagnosis_suggest(moray_solution *solution)
{
    struct evidence e = {.solution = solution, .t = solution->transcription};
    const size_t n = (size_t)e.t->nlp.n, m = (size_t)e.t->nlp.m;
    e.violation = calloc(2 * m + n + (size_t)e.t->nlp.nnz_jac + 1, sizeof *e.violation);
    e.rows = calloc(m + n, sizeof *e.rows);
    if (e.violation && e.rows) {
        e.weight = e.violation + m;
        e.pull = e.weight + m;
        e.jac = e.pull + n;
        e.cols = e.rows + m;
        gather(&e);
        choose(&e);
    }
    free(e.violation);
    free(e.rows);
}
