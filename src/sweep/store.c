// SPDX-License-Identifier: MIT
#include "sweep/sweep.h"

#include <cjson/cJSON.h>
#include <fnmatch.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double *blank(long points)
{
    double *value = moray_apart_new((size_t)points, sizeof *value);
    for (long k = 0; value && k < points; k++)
        value[k] = NAN;
    return value;
}

moray_status moray_store_new(struct store *store, const struct grid *grid)
{
    const size_t n = (size_t)grid->points;
    *store = (struct store){.grid = grid,
                            .state = moray_apart_new(n, 1),
                            .code = moray_apart_new(n, 1),
                            .round = moray_apart_new(n, 1),
                            .start = moray_apart_new(n, sizeof *store->start),
                            .seconds = moray_apart_new(n, sizeof *store->seconds),
                            .objective = blank(grid->points),
                            .other = blank(grid->points),
                            .reason = moray_apart_new(n, sizeof *store->reason)};
    if (store->state && store->code && store->round && store->start && store->seconds && store->objective &&
        store->other && store->reason)
        return moray_ok();
    moray_store_free(store);
    return moray_error(MORAY_MEMORY, "no memory for %ld points", grid->points);
}

void moray_store_free(struct store *store)
{
    const size_t n = store->grid ? (size_t)store->grid->points : 0;
    for (int k = 0; k < store->n; k++) {
        free(store->name[k]);
        moray_apart_free(store->value[k], n, sizeof *store->value[k]);
    }
    for (long k = 0; store->reason && k < store->grid->points; k++)
        free(store->reason[k]);
    free(store->name);
    free(store->value);
    moray_apart_free(store->state, n, 1);
    moray_apart_free(store->code, n, 1);
    moray_apart_free(store->round, n, 1);
    moray_apart_free(store->start, n, sizeof *store->start);
    moray_apart_free(store->seconds, n, sizeof *store->seconds);
    moray_apart_free(store->objective, n, sizeof *store->objective);
    moray_apart_free(store->other, n, sizeof *store->other);
    moray_apart_free(store->reason, n, sizeof *store->reason);
    *store = (struct store){0};
}

static bool grow(struct store *store)
{
    const int room = store->room ? 2 * store->room : 64;
    char **name = realloc(store->name, (size_t)room * sizeof *name);
    if (name)
        store->name = name;
    double **value = realloc(store->value, (size_t)room * sizeof *value);
    if (value)
        store->value = value;
    if (name && value)
        store->room = room;
    return name && value;
}

// The column of that name, made if need be. Summaries have the same order as a rule, so the search begins behind the
// last one found. -1: no memory.
static int column(struct store *store, const char *name, int *last)
{
    for (int k = 0; k < store->n; k++) {
        const int i = (*last + 1 + k) % store->n;
        if (strcmp(store->name[i], name) == 0)
            return *last = i;
    }
    if (store->n == store->room && !grow(store))
        return -1;
    const int i = store->n;
    store->name[i] = strdup(name);
    store->value[i] = blank(store->grid->points);
    if (!store->name[i] || !store->value[i]) {
        free(store->name[i]);
        moray_apart_free(store->value[i], (size_t)store->grid->points, sizeof *store->value[i]);
        return -1;
    }
    store->n++;
    return *last = i;
}

enum { PATH_SIZE = 256, MOST_IN_LIST = 64 };
typedef struct walk {
    struct store *store;
    long point;
    int last;
    bool write; // else only looks for `wanted`
    const char *wanted;
    double found;
    bool no_memory;
} walk;

static bool is_kept(const moray_sweep_spec *spec, const char *path)
{
    bool kept = spec->keeps == 0;
    for (int k = 0; !kept && k < spec->keeps; k++)
        kept = fnmatch(spec->keep[k], path, 0) == 0;
    return kept;
}

static void put(walk *w, const char *path, double value)
{
    if (!w->write) {
        if (w->wanted && strcmp(path, w->wanted) == 0)
            w->found = value;
        return;
    }
    if (!is_kept(w->store->grid->spec, path))
        return;
    const int i = column(w->store, path, &w->last);
    w->no_memory = w->no_memory || i < 0;
    if (i >= 0)
        w->store->value[i][w->point] = value;
}

// What tells an object of a list from the others: a text in it; else its number.
static const char *tag(const cJSON *item, int k, char text[32])
{
    static const char *const keys[] = {"model", "name", "key", "problem"};
    for (unsigned i = 0; i < sizeof keys / sizeof *keys; i++) {
        const cJSON *name = cJSON_GetObjectItemCaseSensitive(item, keys[i]);
        if (cJSON_IsString(name))
            return name->valuestring;
    }
    snprintf(text, 32, "%d", k);
    return text;
}

static void descend(walk *w, const cJSON *item, const char *path) // NOLINT(misc-no-recursion): as deep as the summary
{
    char longer[PATH_SIZE], number[32];
    if (cJSON_IsNumber(item) || cJSON_IsBool(item)) {
        put(w, path, cJSON_IsNumber(item) ? item->valuedouble : cJSON_IsTrue(item));
        return;
    }
    const bool list = cJSON_IsArray(item);
    if (!cJSON_IsObject(item) && (!list || cJSON_GetArraySize(item) > MOST_IN_LIST))
        return;
    int k = 0;
    for (const cJSON *child = item->child; child; child = child->next, k++) {
        const char *name = list ? tag(child, k, number) : child->string;
        if (snprintf(longer, sizeof longer, "%s%s%s", path, *path ? "." : "", name) < (int)sizeof longer)
            descend(w, child, longer);
    }
}

static void clear(struct store *store, long point)
{
    for (int k = 0; k < store->n; k++)
        store->value[k][point] = NAN;
}

static double objective_of(const struct store *store, const cJSON *found)
{
    walk w = {.wanted = store->grid->spec->objective, .found = NAN};
    if (found && w.wanted)
        descend(&w, found, "");
    return w.found;
}

static const double rounding = 1e-6; // of objectives, what two solves of the same may differ by

// A solution is better than none, and of two the one whose objective is lower by more than solves of the same differ.
static bool is_better(const struct store *store, const struct record *record, double objective)
{
    const long at = record->task.point;
    if (store->state[at] == POINT_UNTRIED)
        return true;
    if (record->code != MORAY_OK)
        return false;
    const double before = store->objective[at];
    return store->state[at] != POINT_SOLVED || objective < before - rounding * fabs(before) ||
           (!isfinite(before) && isfinite(objective));
}

moray_status moray_store_add(struct store *store, const struct record *record, bool *better)
{
    const long at = record->task.point;
    const cJSON *found = record->read;
    const double objective = objective_of(store, found);
    *better = is_better(store, record, objective);
    store->seconds[at] += record->seconds;
    walk w = {.store = store, .point = at, .last = -1, .write = true};
    if (*better) {
        char *reason = strdup(record->reason ? record->reason : "");
        w.no_memory = !reason;
        free(store->reason[at]);
        store->reason[at] = reason;
        if (store->state[at] == POINT_SOLVED)
            store->other[at] = store->objective[at];
        store->state[at] = record->code == MORAY_OK ? POINT_SOLVED : POINT_FAILED;
        store->code[at] = (signed char)record->code;
        store->start[at] = record->task.start;
        store->round[at] = (signed char)record->task.round;
        store->objective[at] = objective;
        clear(store, at);
        if (found)
            descend(&w, found, "");
    } else if (record->code == MORAY_OK) {
        store->other[at] = objective;
    }
    return w.no_memory ? moray_error(MORAY_MEMORY, "no memory for the numbers of point %ld", at) : moray_ok();
}
