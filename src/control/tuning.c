// SPDX-License-Identifier: MIT
#include "moray/control/tuning.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/parallel.h"
#include "moray/search.h"

enum { most = MORAY_TUNED_NUMBERS, SPREAD = 4, POLISHED = 3, ROUNDS = 8 };
static const double worthwhile = 5e-3; // relative gain of a round that calls for another
static const double alike = 2e-2;      // relative difference of estimates that confirm each other
static const double rough = 1e-2;      // tolerance of searches whose ends are polished
static const double near = 1e-2;       // on all scales, and
static const double level = 1e-3;      // in cost, relatively: within these two ends are one

// A point in the box of all scales, each of which goes from 0 to 1.
typedef struct place {
    double z[most], cost; // INFINITY: there is none
    bool stopped, low;    // low: none beside it is better
} place;

// What a point costs; local searches come by many points again.
typedef struct tried {
    double z[most], cost;
    bool confirmed;
} tried;

typedef struct tuning {
    const moray_tuning_problem *problem;
    const moray_tuning_settings *settings;
    const place *from;
    double reach;   // half the width of the box that is searched
    bool polishing; // by a quadratic model
    tried *known;   // [n_known] of all tasks before
    int n_known;
    double best;  // of one task, confirmed
    bool stopped; // of one task
    tried *own;   // [n_own], likewise, of at most
    int n_own, room;
    int evaluations; // likewise: a search may go a little beyond its room
} tuning;

// Of a task: the place found, and what it tried.
typedef struct outcome {
    place at;
    int evaluations, n;
    tried tried[];
} outcome;

moray_tuning_settings moray_tuning_settings_default(void)
{
    return (moray_tuning_settings){.starts = 12, .evaluations = 25, .tolerance = 1e-4, .remembers = true};
}

// ---- Scales --------------------------------------------------------------------------------------------------------

static double on_scale(const moray_tuned_number *number, double x)
{
    return number->scale == MORAY_TUNED_LINEAR        ? x
           : number->scale == MORAY_TUNED_LOGARITHMIC ? log(x)
                                                      : asinh(x / number->unit);
}

static double to_unit(const moray_tuned_number *number, double x)
{
    const double low = on_scale(number, number->lower), high = on_scale(number, number->upper);
    return (on_scale(number, fmin(fmax(x, number->lower), number->upper)) - low) / (high - low);
}

static double from_unit(const moray_tuned_number *number, double z)
{
    const double low = on_scale(number, number->lower), high = on_scale(number, number->upper);
    const double at = low + z * (high - low);
    const double x = number->scale == MORAY_TUNED_LINEAR        ? at
                     : number->scale == MORAY_TUNED_LOGARITHMIC ? exp(at)
                                                                : number->unit * sinh(at);
    return fmin(fmax(x, number->lower), number->upper);
}

static moray_status check(const moray_tuning_problem *problem)
{
    if (problem->n < 1 || problem->n > most)
        return moray_error(MORAY_INPUT, "%d numbers to tune: must be from 1 to %d", problem->n, most);
    for (int k = 0; k < problem->n; k++) {
        const moray_tuned_number *number = &problem->number[k];
        if (!(number->lower < number->upper) || (number->scale == MORAY_TUNED_LOGARITHMIC && !(number->lower > 0)) ||
            (number->scale == MORAY_TUNED_WITH_ZERO && !(number->unit > 0)))
            return moray_error(MORAY_INPUT, "number %d to tune, from %g to %g: no range on its scale", k + 1,
                               number->lower, number->upper);
    }
    return moray_ok();
}

// ---- Searches ------------------------------------------------------------------------------------------------------

static const tried *recall(const tuning *t, const double *z)
{
    const size_t bytes = (size_t)t->problem->n * sizeof *z;
    for (int k = t->n_own - 1; k >= 0; k--)
        if (memcmp(t->own[k].z, z, bytes) == 0)
            return &t->own[k];
    for (int k = t->n_known - 1; k >= 0; k--)
        if (memcmp(t->known[k].z, z, bytes) == 0)
            return &t->known[k];
    return NULL;
}

static void remember(tuning *t, const double *z, double cost, bool confirmed)
{
    if (t->n_own == t->room)
        return;
    tried *at = &t->own[t->n_own++];
    *at = (tried){.cost = cost, .confirmed = confirmed};
    memcpy(at->z, z, (size_t)t->problem->n * sizeof *z);
}

static void numbers_at(const tuning *t, const double *z, double *x)
{
    for (int k = 0; k < t->problem->n; k++)
        x[k] = from_unit(&t->problem->number[k], z[k]);
}

// INFINITY where there is no cost.
static double try_out(tuning *t, const double *z)
{
    double x[most], cost;
    numbers_at(t, z, x);
    if (!t->problem->cost(t->problem->self, x, &cost) || !isfinite(cost))
        cost = INFINITY;
    t->evaluations++;
    return cost;
}

// The cost itself where all estimates are like it, else the first that is not and makes it no longer the best, or the
// largest.
static double confirm(tuning *t, const double *z, double cost)
{
    const double bound = cost + alike * fabs(cost);
    double x[most], other;
    numbers_at(t, z, x);
    for (int k = 0; k < t->problem->confirmations && cost < t->best; k++) {
        const bool known = t->problem->confirm(t->problem->self, x, k, &other) && isfinite(other);
        t->evaluations++;
        if (!known || other > bound)
            cost = fmax(cost, known ? other : INFINITY);
    }
    return cost;
}

static bool cost_at(tuning *t, const double *z, double *cost)
{
    const tried *before = t->settings->remembers ? recall(t, z) : NULL;
    bool confirmed = before && before->confirmed;
    if (!before && t->settings->go_on && !t->settings->go_on(t->settings->observer)) {
        t->stopped = true;
        return false;
    }
    *cost = before ? before->cost : try_out(t, z);
    if (!confirmed && *cost < t->best) {
        *cost = confirm(t, z, *cost);
        confirmed = *cost < t->best;
        before = NULL;
    }
    if (!before)
        remember(t, z, *cost, confirmed);
    t->best = fmin(t->best, *cost);
    return isfinite(*cost);
}

static bool evaluate(void *self, const double *z, double *f, double *c, double *gradient, double *jacobian)
{
    (void)c, (void)gradient, (void)jacobian;
    return cost_at(self, z, f);
}

static bool carry_on(void *observer, const moray_search_progress *progress)
{
    (void)progress;
    return !((const tuning *)observer)->stopped;
}

// Whether the whole box is searched, for places to polish: they are confirmed at the end, not on the way.
static bool looks_over(const tuning *t)
{
    return t->reach == 1;
}

static tuning begin_task(const tuning *all, outcome *of, int k)
{
    tuning t = *all;
    of->at = t.from[k];
    t.own = of->tried;
    t.best = looks_over(&t) ? -INFINITY : INFINITY;
    return t;
}

static void end_task(const tuning *t, outcome *of)
{
    of->n = t->n_own;
    of->evaluations = t->evaluations;
    of->at.stopped = t->stopped;
}

// A moray_task_fn; result: an outcome, the place with its cost.
static void look(int k, void *result, void *self)
{
    tuning t = begin_task(self, result, k);
    place *found = &((outcome *)result)->at;
    if (!cost_at(&t, found->z, &found->cost))
        found->cost = INFINITY;
    end_task(&t, result);
}

// Likewise; result: the best place near that one.
static void improve(int k, void *result, void *self)
{
    tuning t = begin_task(self, result, k);
    place *found = &((outcome *)result)->at;
    double z[most], lower[most], upper[most];
    const int n = t.problem->n;
    if (!looks_over(&t) && t.problem->confirmations > 0)
        found->cost = INFINITY; // until it is confirmed again, beside its neighbours
    for (int j = 0; j < n; j++) {
        z[j] = found->z[j];
        lower[j] = fmax(0, z[j] - t.reach);
        upper[j] = fmin(1, z[j] + t.reach);
    }
    const moray_search_problem problem = {.n = n, .lower = lower, .upper = upper, .self = &t, .evaluate = evaluate};
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    // Gains that make up for one another lie in a curved valley, along which a quadratic model gets further.
    settings.method = t.polishing && n > 1 ? MORAY_SEARCH_BOBYQA : MORAY_SEARCH_COBYLA;
    settings.x_tolerance = looks_over(&t) ? rough : 1e-4;
    settings.f_tolerance = looks_over(&t) ? rough : t.settings->tolerance;
    settings.max_evaluations = t.room;
    settings.progress = carry_on;
    settings.observer = &t;
    if (!moray_failed(moray_search(&problem, &settings, z, &info)) && info.objective < found->cost) {
        memcpy(found->z, z, sizeof z);
        found->cost = info.objective;
    }
    if (looks_over(&t) && isfinite(found->cost)) {
        t.best = INFINITY;
        found->cost = confirm(&t, found->z, found->cost);
    }
    end_task(&t, result);
}

// ---- All of them ---------------------------------------------------------------------------------------------------

static int by_cost(const void *a, const void *b)
{
    const double one = ((const place *)a)->cost, other = ((const place *)b)->cost;
    return (one > other) - (one < other);
}

// The points given, then a sequence of low discrepancy: fractional parts of k / g, k / g^2, ... with g^(n+1) = g + 1.
static void spread(const moray_tuning_problem *problem, const double *from, int n_from, int n, place *places)
{
    double g = 2;
    for (int k = 0; k < 40; k++)
        g = pow(1 + g, 1.0 / (problem->n + 1));
    for (int i = 0; i < n; i++)
        for (int j = 0; j < problem->n; j++)
            places[i].z[j] = i < n_from ? to_unit(&problem->number[j], from[i * problem->n + j])
                                        : fmod(0.5 + (i - n_from + 1) / pow(g, j + 1), 1);
}

static void take(tuning *t, const outcome *of, place *at, moray_tuning_info *info)
{
    info->evaluations += of->evaluations;
    *at = of->at;
    memcpy(t->known + t->n_known, of->tried, (size_t)of->n * sizeof *of->tried);
    t->n_known += of->n;
    t->stopped |= of->at.stopped;
}

// Does a task, which may try `room` points, from each of n places, and puts what is found in their place.
static moray_status from_each(tuning *t, moray_task_fn *task, int room, place *places, int n, moray_tuning_info *info)
{
    const size_t size = sizeof(outcome) + (size_t)room * sizeof(tried);
    char *found = calloc((size_t)n, size);
    tried *known = realloc(t->known, (size_t)(t->n_known + n * room) * sizeof *known);
    t->known = known ? known : t->known;
    t->from = places;
    t->room = room;
    moray_status status = found && known ? moray_parallel(n, size, found, task, t, t->settings->jobs)
                                         : moray_error(MORAY_MEMORY, "no memory for %d searches", n);
    for (int k = 0; k < n && !moray_failed(status); k++)
        take(t, (const outcome *)(const void *)(found + (size_t)k * size), &places[k], info);
    free(found);
    return status;
}

static bool is_one(const tuning *t, const place *a, const place *b)
{
    bool one = fabs(a->cost - b->cost) <= level * fabs(a->cost);
    for (int j = 0; j < t->problem->n; j++)
        one = one && fabs(a->z[j] - b->z[j]) < near;
    return one;
}

// Puts the best of n places, in the order of their costs, first; of those that are one the best alone. How many there
// are, up to `most_apart`.
static int set_apart(const tuning *t, place *places, int n, int most_apart)
{
    int apart = 0;
    for (int k = 0; k < n && apart < most_apart; k++) {
        bool another = true;
        for (int i = 0; i < apart; i++)
            another = another && !is_one(t, &places[i], &places[k]);
        if (another)
            places[apart++] = places[k];
    }
    return apart;
}

// The best of them once more and again, in boxes around them.
static moray_status polish(tuning *t, int room, place *places, int n, moray_tuning_info *info)
{
    double enough = INFINITY; // a cost below which another round is called for
    for (int round = 0; round < ROUNDS && !t->stopped; round++) {
        t->polishing = round % 2 == 0;
        t->reach = round < ROUNDS / 2 ? 0.15 : 0.04;
        MORAY_TRY(from_each(t, improve, room, places, n, info));
        qsort(places, (size_t)n, sizeof *places, by_cost);
        n = set_apart(t, places, n, n);
        if (round % 2 == 0)
            continue;
        if (!(places[0].cost < enough))
            break;
        enough = places[0].cost - worthwhile * fabs(places[0].cost);
    }
    return moray_ok();
}

// Whether none of n places on either side of the k-th, of one number, is better.
static bool is_low(const place *places, int n, int k)
{
    int below = -1, above = -1;
    for (int i = 0; i < n; i++) {
        const double z = places[i].z[0];
        if (z < places[k].z[0] && (below < 0 || z > places[below].z[0]))
            below = i;
        if (z > places[k].z[0] && (above < 0 || z < places[above].z[0]))
            above = i;
    }
    return (below < 0 || places[below].cost >= places[k].cost) && (above < 0 || places[above].cost >= places[k].cost);
}

// How many of n places are searched from: those given and the best of the others, up to `starts` of them. Along one
// number the places that were looked at show every valley that is as wide as they are apart, and the lowest of each is
// enough; it is put before the rest.
static int choose_starts(const tuning *t, place *places, int n, int n_from)
{
    const int enough = n_from + t->settings->starts; // of n_from + SPREAD times as many
    int starts = n_from;
    if (t->problem->n > 1)
        return enough;
    for (int k = n_from; k < n; k++)
        places[k].low = is_low(places, n, k);
    for (int k = n_from; k < n && starts < enough; k++)
        if (places[k].low)
            places[starts++] = places[k];
    return starts;
}

static moray_status search(tuning *t, place *places, int n, int n_from, moray_tuning_info *info)
{
    const int room = t->settings->evaluations * t->problem->n;
    t->reach = 1;
    MORAY_TRY(from_each(t, look, 1, places, n, info));
    qsort(places + n_from, (size_t)(n - n_from), sizeof *places, by_cost); // those given start whatever they cost
    const int starts = choose_starts(t, places, n, n_from);
    if (!t->stopped)
        MORAY_TRY(from_each(t, improve, room, places, starts, info));
    qsort(places, (size_t)starts, sizeof *places, by_cost);
    for (int k = 0; k < starts; k++)
        info->agree += places[k].cost - places[0].cost <= 0.05 * fabs(places[0].cost);
    info->searches = starts;
    return polish(t, room, places, set_apart(t, places, starts, POLISHED), info);
}

moray_status moray_tune(const moray_tuning_problem *problem, const moray_tuning_settings *settings, const double *from,
                        int n_from, double *x, moray_tuning_info *info)
{
    MORAY_TRY(check(problem));
    *info = (moray_tuning_info){.cost = INFINITY};
    if (settings->starts < 1 || settings->evaluations < 1)
        return moray_error(MORAY_INPUT, "starts = %d, evaluations = %d: must be at least 1", settings->starts,
                           settings->evaluations);
    const int n = n_from + SPREAD * settings->starts;
    place *places = calloc((size_t)n, sizeof *places);
    if (!places)
        return moray_error(MORAY_MEMORY, "no memory for %d starts", n);
    tuning t = {.problem = problem, .settings = settings};
    spread(problem, from, n_from, n, places);
    moray_status status = search(&t, places, n, n_from, info);
    info->cost = places[0].cost;
    for (int k = 0; k < problem->n; k++)
        x[k] = from_unit(&problem->number[k], places[0].z[k]);
    free(places);
    free(t.known);
    if (!moray_failed(status) && t.stopped)
        status = moray_error(MORAY_INTERRUPTED, "tuning was interrupted after %d evaluations", info->evaluations);
    if (!moray_failed(status) && !isfinite(info->cost))
        status = moray_error(MORAY_NUMERIC, "none of %d settings tried has a cost", info->evaluations);
    return status;
}
