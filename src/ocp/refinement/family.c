// SPDX-License-Identifier: MIT
//
// The family of the scheme changes where a control rings or an equation is not for it, and back where the other does no
// better.
#include "ocp/refinement/family.h"

#include <math.h>

#include "ocp/refinement/refine.h"
#include "ocp/refinement/ringing.h"

static const double least_swing = 0.01, falls = 0.5; // of a control's range; of the swing on the mesh before
static const double nearly = 100; // of the mesh tolerance: an error that refinement will soon have down
enum { smooth_stages = 3 };       // of the family that takes over

static int intervals_at_first(const struct campaign *c)
{
    const int intervals =
        c->settings->intervals > 0 ? c->settings->intervals : c->history[0].intervals / c->ocp->phases;
    return intervals > 1 ? intervals : 1;
}

// Radau damps what stiff equations or index-3 constraints do to others; on some singular arcs it is Radau that rings,
// and Gauss that does not.
static bool find_other_family(struct campaign *c, moray_family *other)
{
    c->left[c->method.family] = true;
    *other = c->left[MORAY_RADAU] ? MORAY_GAUSS : MORAY_RADAU;
    return !c->left[*other];
}

static const char *scheme_of(const struct campaign *c)
{
    for (int k = c->tried - 2; k >= 0; k--)
        if (c->history[k].changed_to)
            return c->history[k].changed_to;
    return c->settings->intervals > 0 ? c->settings->scheme : c->guess->from->settings.scheme;
}

// Whether a control, counted from 1 through the phases, is of a phase whose scheme stays.
static bool has_own_scheme(const struct campaign *c, int control)
{
    int p = 0;
    for (; control > c->ocp->phase[p].nu; p++)
        control -= c->ocp->phase[p].nu;
    return c->own && c->own[p].stages > 0;
}

// Of the phases whose scheme changes.
static moray_family family_of(const struct campaign *c, const moray_solution *solution)
{
    int p = 0;
    while (p + 1 < c->ocp->phases && c->own && c->own[p].stages > 0)
        p++;
    return solution->transcription->layout.phase[p].mesh.method.family;
}

// The meshes in c become those of the start, with another family.
static moray_status change_family(struct campaign *c, moray_family family)
{
    moray_mesh_record *here = &c->history[c->tried - 1];
    here->changed_to = family == MORAY_RADAU ? "radau3" : "gauss3";
    c->before = (struct left_family){c->method, scheme_of(c), here->nodes};
    c->method = (struct method){family, smooth_stages};
    c->vain = 0;
    moray_campaign_free_meshes(c);
    for (int p = 0; p < c->ocp->phases; p++)
        MORAY_TRY(moray_campaign_first_mesh(c, p, intervals_at_first(c)));
    return moray_ok();
}

moray_status moray_leave_ringing(struct campaign *c, const moray_solution *solution)
{
    moray_mesh_record *here = &c->history[c->tried - 1], *before = here - 1;
    moray_family other;
    here->seen = moray_is_solved(solution) ? moray_find_ringing(solution, &here->swing) : 0;
    const bool again = c->tried > 1 && !before->changed_to && here->seen > 0 && here->seen == before->seen &&
                       here->swing > fmax(least_swing, falls * before->swing) &&
                       fmin(here->error, before->error) > nearly * c->settings->mesh_tolerance;
    if (!again || has_own_scheme(c, here->seen) || !find_other_family(c, &other))
        return moray_ok();
    here->ringing = here->seen;
    return change_family(c, other);
}

// Of a phase whose scheme may change, an equation between states alone, counted from 1 through the phases; 0: none.
static int find_equation_of_states(const struct campaign *c, const moray_solution *solution)
{
    int first = 1;
    for (int p = 0; p < c->ocp->phases; first += c->ocp->phase[p++].nc) {
        const struct phase *phase = &c->ocp->phase[p];
        const moray_pattern *jac = &solution->transcription->phase[p].map->jac;
        for (int i = 0; i < phase->nc && !(c->own && c->own[p].stages > 0); i++) {
            bool of_states = false, of_controls = !moray_bounds_are_fixed(phase->c[i]);
            for (int k = 0; k < jac->nnz; k++)
                if (jac->row[k] == phase->nx + i) {
                    of_states = of_states || jac->col[k] < phase->nx;
                    of_controls = of_controls || (jac->col[k] >= phase->nx && jac->col[k] < phase->nx + phase->nu);
                }
            if (of_states && !of_controls)
                return first + i;
        }
    }
    return 0;
}

moray_status moray_leave_higher_index(struct campaign *c, moray_solution *failed, bool *changed)
{
    const int equation = find_equation_of_states(c, failed);
    *changed = equation > 0 && c->method.family == MORAY_LOBATTO;
    if (!*changed)
        return moray_ok();
    moray_campaign_record(c, failed, NAN, 0);
    c->history[c->tried - 1].equation = equation;
    c->left[c->method.family] = true;
    return change_family(c, MORAY_RADAU);
}

bool moray_is_no_better(const struct campaign *c, bool again)
{
    const moray_mesh_record *here = &c->history[c->tried - 1];
    return c->before.nodes > 0 && family_of(c, c->best) == c->before.method.family &&
           c->best->info.outcome != MORAY_NLP_INTERRUPTED && (!again || here->nodes > c->before.nodes);
}

moray_status moray_go_back(struct campaign *c, moray_solution **solution)
{
    double error;
    c->history[c->tried - 1].changed_to = c->before.scheme;
    c->left[c->method.family] = true;
    c->method = c->before.method;
    c->before.nodes = 0;
    c->vain = 0;
    if (*solution != c->best)
        moray_campaign_drop(*solution);
    *solution = c->best;
    moray_campaign_free_meshes(c);
    return moray_refine(c->best, c->settings->mesh_tolerance, c->meshes, &error);
}
