// SPDX-License-Identifier: MIT
//
// What a solution shows, in words.
#include "ocp/diagnosis/diagnosis.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "ocp/names.h"

enum { most_lines = 12 };
static const double small_error = 1e-2; // of a mesh whose optimum is to be believed
static const double much = 0.1;         // of an optimum, that another is away

void moray_diagnosis_say(moray_solution *solution, const char *format, ...)
{
    const size_t used = strlen(solution->diagnosis);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(solution->diagnosis + used, diagnosis_size - used, format, arguments);
    va_end(arguments);
}

double moray_scaled_violation(const moray_solution *solution, int i)
{
    const struct standing s = moray_standing_of(solution, true, i);
    return s.scale * (s.value < s.lower ? s.value - s.lower : s.value > s.upper ? s.value - s.upper : 0);
}

static void say_allowed(moray_solution *solution, double lower, double upper)
{
    if (lower == upper)
        moray_diagnosis_say(solution, "%.6g", lower);
    else if (upper >= MORAY_INFINITY)
        moray_diagnosis_say(solution, "at least %.6g", lower);
    else if (lower <= -MORAY_INFINITY)
        moray_diagnosis_say(solution, "at most %.6g", upper);
    else
        moray_diagnosis_say(solution, "%.6g to %.6g", lower, upper);
}

static void say_worst_violation(moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    double worst = 0;
    int where = -1;
    for (int i = 0; i < t->nlp.m; i++) {
        const double violation = fabs(moray_scaled_violation(solution, i));
        if (violation > worst) {
            worst = violation;
            where = i;
        }
    }
    if (where < 0 || worst < solution->settings.tolerance) {
        moray_diagnosis_say(solution, "No constraint is violated by more than %.1e (scaled).\n",
                            solution->settings.tolerance);
        return;
    }
    char name[name_size];
    moray_layout_row_name(&t->layout, t->ocp, solution->iterate.x, where, name, name_size);
    moray_diagnosis_say(solution, "Largest violation: %s, %.3g where ", name, solution->iterate.g[where]);
    say_allowed(solution, t->nlp.g_lower[where], t->nlp.g_upper[where]);
    moray_diagnosis_say(solution, " is allowed (scaled %.1e).\n", worst);
}

static void say_furthest(moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    double furthest = 0;
    int where = 0;
    for (int j = 0; j < t->nlp.n; j++) {
        const double distance =
            moray_standing_of(solution, false, j).scale * fabs(solution->iterate.x[j] - solution->guess[j]);
        if (distance > furthest) {
            furthest = distance;
            where = j;
        }
    }
    char name[name_size];
    moray_layout_column_name(&t->layout, t->ocp, solution->iterate.x, where, name, name_size);
    moray_diagnosis_say(solution, "Furthest from the guess: %s, %.4g instead of %.4g (scaled distance %.1e).\n", name,
                        solution->iterate.x[where], solution->guess[where], furthest);
}

// ---- Active bounds ----

struct listing {
    moray_solution *solution;
    int lines;
};

static void say_band(const struct band *band, bool upper, struct listing *list)
{
    moray_solution *solution = list->solution;
    const struct transcription *t = solution->transcription;
    int active = 0, all = 0, first = 0, last = 0;
    double bound = 0;
    for (int n = 0; n < moray_band_members(t, band); n++) {
        const int i = moray_band_member(t, band, n);
        const struct standing s =
            i == absent ? (struct standing){.fixed = true} : moray_standing_of(solution, band->rows, i);
        all += i != absent;
        if (s.fixed || !(upper ? s.at_upper : s.at_lower))
            continue;
        if (active++ == 0) {
            first = n;
            bound = upper ? s.upper : s.lower;
        }
        last = n;
    }
    if (active == 0 || list->lines++ >= most_lines)
        return;
    char name[name_size];
    moray_band_name(solution, band, name, name_size);
    moray_diagnosis_say(solution, "Active: %s at its %s bound %.6g", name, upper ? "upper" : "lower", bound);
    if (band->kind != band_single) {
        const struct phase_layout *layout = &t->layout.phase[band->p];
        moray_diagnosis_say(
            solution, " on %d of %d nodes, t = %.6g .. %.6g", active, all,
            moray_layout_time(&t->layout, t->ocp, solution->iterate.x, band->p, layout->node[first].tau),
            moray_layout_time(&t->layout, t->ocp, solution->iterate.x, band->p, layout->node[last].tau));
    }
    moray_diagnosis_say(solution, ".\n");
}

static void list_band(const struct band *band, void *self)
{
    say_band(band, false, self);
    say_band(band, true, self);
}

static void say_active(moray_solution *solution)
{
    struct listing list = {solution, 0};
    moray_visit_bands(solution->transcription, list_band, &list);
    if (list.lines == 0)
        moray_diagnosis_say(solution, "No bound is active.\n");
    else if (list.lines > most_lines)
        moray_diagnosis_say(solution, "And %d more at their bounds.\n", list.lines - most_lines);
}

static void say_ringing(moray_solution *solution, const moray_mesh_record *mesh)
{
    const moray_ocp *ocp = solution->transcription->ocp;
    int p = 0, control = mesh->ringing - 1;
    while (control >= ocp->phase[p].nu)
        control -= ocp->phase[p++].nu;
    char name[200];
    moray_phase_input_name(ocp, p, ocp->phase[p].nx + control, name, sizeof name);
    moray_diagnosis_say(solution,
                        "On %d intervals the %s of phase %.100s went to and fro from node to node, as on fewer: a "
                        "singular arc, on which this scheme rings; changed to %s.\n",
                        mesh->intervals, name, ocp->phase[p].name, mesh->changed_to);
}

// Meshes whose errors are small, and whose optima differ by far more: other optima, or an error that no sample sees.
static void say_disagreement(moray_solution *solution)
{
    const moray_mesh_record *before = NULL;
    for (int k = 0; k < solution->meshes; k++) {
        const moray_mesh_record *mesh = &solution->history[k];
        if (!(mesh->error < small_error))
            continue;
        const double size = before ? fmax(fabs(before->objective), fabs(mesh->objective)) : 0;
        if (before && fabs(mesh->objective - before->objective) > much * size)
            moray_diagnosis_say(solution,
                                "The optima of %d and %d intervals differ, %.6g and %.6g: try other guesses.\n",
                                before->intervals, mesh->intervals, before->objective, mesh->objective);
        before = mesh;
    }
}

static void say_equation(moray_solution *solution, const moray_mesh_record *mesh)
{
    const moray_ocp *ocp = solution->transcription->ocp;
    int p = 0, equation = mesh->equation - 1;
    while (equation >= ocp->phase[p].nc)
        equation -= ocp->phase[p++].nc;
    char name[200];
    moray_phase_output_name(ocp, p, ocp->phase[p].nx + equation, name, sizeof name);
    moray_diagnosis_say(solution,
                        "The %s of phase %.100s is an equation in which no control stands, of higher index, for which "
                        "this scheme is not made; changed to %s.\n",
                        name, ocp->phase[p].name, mesh->changed_to);
}

static void say_meshes(moray_solution *solution, const moray_mesh_record *tried)
{
    say_disagreement(solution);
    const bool solved = tried->outcome == MORAY_NLP_SOLVED || tried->outcome == MORAY_NLP_ACCEPTABLE;
    for (int k = 0; k < solution->meshes; k++)
        if (solution->history[k].ringing > 0)
            say_ringing(solution, &solution->history[k]);
        else if (solution->history[k].equation > 0)
            say_equation(solution, &solution->history[k]);
        else if (solution->history[k].changed_to)
            moray_diagnosis_say(solution, "On %d intervals that did no better; back to %.40s.\n",
                                solution->history[k].intervals, solution->history[k].changed_to);
    if (tried->objective == solution->iterate.objective)
        return;
    if (solved)
        moray_diagnosis_say(solution,
                            "The error did not fall any more with finer meshes, the last of %d intervals; "
                            "this is the best.\n",
                            tried->intervals);
    else
        moray_diagnosis_say(solution, "A finer mesh of %d intervals was not solved (%s); this is the best that was.\n",
                            tried->intervals, moray_nlp_outcome_text(tried->outcome));
}

void moray_diagnose(moray_solution *solution)
{
    const moray_mesh_record *tried = &solution->history[solution->meshes - 1];
    solution->diagnosis[0] = 0;
    moray_diagnosis_say(solution, "%s after %d iterations.\n", moray_nlp_outcome_text(solution->info.outcome),
                        solution->info.iterations);
    say_meshes(solution, tried);
    for (int k = 0; k < solution->meshes; k++)
        if (solution->history[k].dependences > 0)
            moray_diagnosis_say(
                solution,
                "At the solution of %d intervals the functions depend on %d more inputs or pairs of them "
                "than elsewhere; solved again with these.\n",
                solution->history[k].intervals, solution->history[k].dependences);
    moray_assemble_constraints(solution->transcription, solution->iterate.g);
    say_worst_violation(solution);
    say_active(solution);
    if (solution->info.outcome == MORAY_NLP_SOLVED)
        return;
    say_furthest(solution);
    moray_diagnosis_suggest(solution);
}
