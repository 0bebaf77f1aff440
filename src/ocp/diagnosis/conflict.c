// SPDX-License-Identifier: MIT
//
// Constraints that repeat or contradict each other, and bounds that stand in the way of the rest.
#include <math.h>
#include <string.h>

#include "nlp/rank.h"
#include "ocp/diagnosis/diagnosis.h"

static struct selection select_active(struct evidence *e, bool with_bounds)
{
    const moray_nlp *nlp = &e->t->nlp;
    for (int i = 0; i < nlp->m; i++) {
        const struct standing s = moray_standing_of(e->solution, true, i);
        e->rows[i] = s.fixed || s.at_lower || s.at_upper;
    }
    for (int j = 0; j < nlp->n; j++) {
        const struct standing s = moray_standing_of(e->solution, false, j);
        e->cols[j] = !s.fixed && !(with_bounds && (s.at_lower || s.at_upper));
    }
    return (struct selection){nlp, e->jac, e->rows, e->cols};
}

// ---- Dependent constraints ----

enum { most_names = 4 };

struct ranking {
    const struct evidence *e;
    int found; // bands with a part
    struct band band[most_names];
    double part[most_names]; // descending
    bool only_dynamics;
};

// Keeps the few bands of largest violation, each by its worst member: a list for people, not of rows.
static void rank_band(const struct band *band, void *self)
{
    struct ranking *ranking = self;
    double part = 0;
    for (int n = 0; band->rows && n < moray_band_members(ranking->e->t, band); n++) {
        const int i = moray_band_member(ranking->e->t, band, n);
        part = i == absent ? part : hypot(part, ranking->e->weight[i]);
    }
    if (part < 1e-3)
        return;
    ranking->only_dynamics = ranking->only_dynamics && band->kind == band_dynamics;
    int k = ranking->found++;
    k = k < most_names ? k : most_names;
    for (; k > 0 && part > ranking->part[k - 1]; k--)
        if (k < most_names) {
            ranking->band[k] = ranking->band[k - 1];
            ranking->part[k] = ranking->part[k - 1];
        }
    if (k < most_names) {
        ranking->band[k] = *band;
        ranking->part[k] = part;
    }
}

// Whether a band's rows could be influenced, at another point if not here.
static bool has_free_entry(const struct evidence *e, const struct band *band)
{
    const moray_nlp *nlp = &e->t->nlp;
    for (int n = 0; n < moray_band_members(e->t, band); n++)
        for (int k = 0; k < nlp->nnz_jac; k++)
            if (nlp->jac_row[k] == moray_band_member(e->t, band, n) && e->cols[nlp->jac_col[k]])
                return true;
    return false;
}

static void say_dependent(const struct evidence *e, const struct ranking *ranking)
{
    char name[name_size];
    moray_diagnosis_say(e->solution, "%s: ",
                        ranking->only_dynamics ? "Try: free an end value or a time; the fixed ones leave no choice to"
                        : ranking->found == 1
                            ? "Try: drop a constraint on which nothing free has an influence"
                            : "Try: drop or loosen one of these constraints, which depend on each other");
    for (int k = 0; k < ranking->found && k < most_names; k++) {
        moray_band_name(e->solution, &ranking->band[k], name, name_size);
        moray_diagnosis_say(e->solution, "%s%s", k ? "; " : "", name);
    }
    if (ranking->found > most_names)
        moray_diagnosis_say(e->solution, "; and %d more", ranking->found - most_names);
    moray_diagnosis_say(e->solution, ".\n");
}

bool moray_dependent_constraints(struct evidence *e)
{
    const struct selection selection = select_active(e, false);
    struct ranking ranking = {.e = e, .only_dynamics = true};
    double norm;
    if (moray_failed(moray_nlp_dependent_rows(&selection, e->weight, &norm)) || norm > 1e-6)
        return false;
    moray_visit_bands(e->t, rank_band, &ranking);
    if (ranking.found == 1 && !ranking.only_dynamics && has_free_entry(e, &ranking.band[0]))
        return false; // a stationary point of this constraint
    say_dependent(e, &ranking);
    return true;
}

// ---- Bounds in the way ----

struct search {
    const struct evidence *e; // weight: violation that nothing away from its bounds removes
    double most;
    struct band band;
    bool upper;
};

// pull[n]: d (weight^2 / 2) / d x
static void gather_pull(const struct evidence *e)
{
    const moray_nlp *nlp = &e->t->nlp;
    memset(e->pull, 0, (size_t)nlp->n * sizeof *e->pull);
    for (int k = 0; k < nlp->nnz_jac; k++)
        e->pull[nlp->jac_col[k]] += e->weight[nlp->jac_row[k]] * e->jac[k];
}

static void search_band(const struct band *band, void *self)
{
    struct search *search = self;
    const struct evidence *e = search->e;
    double gain[2] = {0, 0};
    for (int n = 0; n < moray_band_members(e->t, band); n++) {
        const int i = moray_band_member(e->t, band, n);
        const struct standing s =
            i == absent ? (struct standing){.fixed = true} : moray_standing_of(e->solution, band->rows, i);
        if (s.fixed || !(s.at_lower || s.at_upper))
            continue;
        const double outward = band->rows ? e->weight[i] : -e->pull[i]; // if it could, it would go this way
        if (s.at_upper && outward > 0)
            gain[1] += outward;
        if (s.at_lower && outward < 0)
            gain[0] -= outward;
    }
    for (int upper = 0; upper < 2; upper++)
        if (gain[upper] > search->most)
            *search = (struct search){e, gain[upper], *band, upper};
}

// By the multipliers: the bound whose loosening would reduce the remaining violation fastest.
bool moray_hardest_bound(struct evidence *e)
{
    const struct selection selection = select_active(e, true);
    const double least = 1e-3 * e->worst;
    struct search search = {.e = e, .most = least};
    memcpy(e->weight, e->violation, (size_t)e->t->nlp.m * sizeof *e->weight);
    if (moray_failed(moray_nlp_unremovable(&selection, e->weight)))
        return false;
    gather_pull(e);
    moray_visit_bands(e->t, search_band, &search);
    if (search.most <= least)
        return false;
    char name[name_size];
    moray_band_name(e->solution, &search.band, name, name_size);
    moray_diagnosis_say(e->solution,
                        "Try: a looser %s bound for %s; of all bounds, the violation would give way to it most.\n",
                        search.upper ? "upper" : "lower", name);
    return true;
}
