// SPDX-License-Identifier: MIT
#include "linear/basis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/btf.h>

// Ways to look at the constraints: as they are, or equilibrated; and what entries are matched.
static const struct view {
    int sweeps;
    double strong; // over the largest of its constraint
} views[MORAY_BASIS_VIEWS] = {{0, 1e-2}, {5, 1e-2}, {5, 1e-6}};

static moray_status no_memory(int m)
{
    return moray_error(MORAY_MEMORY, "no memory for a basis of %d constraints", m);
}

// ---- Choice --------------------------------------------------------------------------------------------------------

// Constraints as lists of the variables that may be theirs, those of few constraints first.
struct choice {
    int *degree, *begin, *list, *match, *work; // [variables], [m + 1], [entries], [variables], [5 m]
    double strong;
    double *column_scale, *column_largest, *row_scale, *row_largest; // [variables], [m] each
};

static int variable_of(const struct basis *basis, const moray_pattern *pattern, int k)
{
    const int at = basis->source[k], i = pattern->row[at], j = pattern->col[at];
    return i < j ? i : j;
}

static double size_of(const struct choice *c, const struct basis *basis, const moray_pattern *pattern,
                      const double *values, int k)
{
    return fabs(values[basis->source[k]]) * c->column_scale[variable_of(basis, pattern, k)] *
           c->row_scale[basis->row[k]];
}

static void divide(int n, double *scale, double *largest)
{
    for (int i = 0; i < n; i++) {
        scale[i] /= largest[i] > 0 ? sqrt(largest[i]) : 1;
        largest[i] = 0;
    }
}

// Brings the largest entry of each constraint and of each variable near 1, as the factors do (Ruiz).
static void equilibrate(struct choice *c, const struct basis *basis, const moray_pattern *pattern, const double *values,
                        int sweeps)
{
    for (int j = 0; j < basis->variables; j++)
        c->column_scale[j] = 1;
    for (int i = 0; i < basis->m; i++)
        c->row_scale[i] = 1;
    for (int sweep = 0; sweep <= sweeps; sweep++) {
        for (int k = 0; k < basis->entries; k++) {
            const int i = basis->row[k], j = variable_of(basis, pattern, k);
            const double size = size_of(c, basis, pattern, values, k);
            c->column_largest[j] = fmax(c->column_largest[j], size);
            c->row_largest[i] = fmax(c->row_largest[i], size);
        }
        if (sweep == sweeps) // what entries are compared with
            break;
        divide(basis->variables, c->column_scale, c->column_largest);
        divide(basis->m, c->row_scale, c->row_largest);
    }
}

static bool may_match(const struct choice *c, const struct basis *basis, const moray_pattern *pattern,
                      const double *values, int k)
{
    const double size = size_of(c, basis, pattern, values, k);
    return size > 0 && size >= c->strong * c->row_largest[basis->row[k]];
}

// The degree of the variable of an entry, at most m + 1.
static int degree_of(const struct choice *c, const struct basis *basis, const moray_pattern *pattern, int k)
{
    const int degree = c->degree[variable_of(basis, pattern, k)], most = basis->m + 1;
    return degree < most ? degree : most;
}

// Sorted by degree: entries are dealt out to the lists in the order of the degrees of their variables. order[entries].
static void list_matches(struct choice *c, const struct basis *basis, const moray_pattern *pattern,
                         const double *values, int *order, int *bucket)
{
    for (int k = 0; k < basis->entries; k++)
        bucket[degree_of(c, basis, pattern, k) + 1]++;
    for (int d = 0; d <= basis->m; d++)
        bucket[d + 1] += bucket[d];
    for (int k = 0; k < basis->entries; k++)
        order[bucket[degree_of(c, basis, pattern, k)]++] = k;
    for (int k = 0; k < basis->entries; k++)
        c->begin[basis->row[k] + 1] += may_match(c, basis, pattern, values, k);
    for (int i = 0; i < basis->m; i++)
        c->begin[i + 1] += c->begin[i];
    for (int t = 0; t < basis->entries; t++) {
        const int k = order[t];
        if (may_match(c, basis, pattern, values, k))
            c->list[c->begin[basis->row[k]]++] = variable_of(basis, pattern, k);
    }
    memmove(c->begin + 1, c->begin, (size_t)basis->m * sizeof *c->begin); // the filling has moved each to its end
    c->begin[0] = 0;
}

static bool match(struct basis *basis, const moray_pattern *pattern, const double *values, const struct view *view,
                  struct choice *c, int *order, int *bucket)
{
    for (int k = 0; k < basis->entries; k++)
        c->degree[variable_of(basis, pattern, k)]++;
    equilibrate(c, basis, pattern, values, view->sweeps);
    double work;
    c->strong = view->strong;
    list_matches(c, basis, pattern, values, order, bucket);
    const int matched = btf_maxtrans(basis->variables, basis->m, c->begin, c->list, 0, &work, c->match, c->work);
    int others = 0;
    for (int i = 0; i < basis->variables; i++)
        basis->place[i] = c->match[i] >= 0 ? c->match[i] : -1 - others++;
    return matched == basis->m;
}

static moray_status choose(struct basis *basis, const moray_pattern *pattern, const double *values,
                           const struct view *view, bool *found)
{
    const size_t v = (size_t)basis->variables, m = (size_t)basis->m, entries = (size_t)basis->entries;
    int *block = calloc(v + (m + 1) + entries + v + 5 * m + entries + (m + 3), sizeof *block);
    double *scales = calloc(v + v + m + m, sizeof *scales);
    struct choice c = {.column_scale = scales};
    moray_status status = no_memory(basis->m);
    if (block && scales) {
        c.column_largest = scales + v;
        c.row_scale = c.column_largest + v;
        c.row_largest = c.row_scale + m;
        c.degree = block;
        c.begin = c.degree + v;
        c.list = c.begin + m + 1;
        c.match = c.list + entries;
        c.work = c.match + v;
        int *order = c.work + 5 * m;
        *found = match(basis, pattern, values, view, &c, order, order + entries);
        status = moray_ok();
    }
    free(block);
    free(scales);
    return status;
}

// ---- Matrix --------------------------------------------------------------------------------------------------------

static moray_status list_entries(struct basis *basis, const moray_pattern *pattern)
{
    for (int k = 0; k < pattern->nnz; k++) {
        const int i = pattern->row[k], j = pattern->col[k];
        basis->entries += (i < basis->variables) != (j < basis->variables);
    }
    const size_t entries = (size_t)basis->entries;
    basis->place = malloc(((size_t)basis->variables + 3 * entries + 1) * sizeof *basis->place);
    if (!basis->place)
        return no_memory(basis->m);
    basis->source = basis->place + basis->variables;
    basis->slot = basis->source + entries;
    basis->row = basis->slot + entries;
    for (int k = 0, e = 0; k < pattern->nnz; k++) {
        const int i = pattern->row[k], j = pattern->col[k];
        if ((i < basis->variables) == (j < basis->variables))
            continue;
        basis->source[e] = k;
        basis->row[e++] = (i > j ? i : j) - basis->variables;
    }
    return moray_ok();
}

// Entries of the basis by columns; repeated ones share a slot. begin[m + 1], here[m], list[entries].
static moray_status make_matrix(struct basis *basis, const moray_pattern *pattern, int *begin, int *here, int *list)
{
    for (int k = 0; k < basis->entries; k++) {
        const int place = basis->place[variable_of(basis, pattern, k)];
        basis->slot[k] = place; // for now
        if (place >= 0)
            begin[place + 1]++;
    }
    for (int j = 0; j < basis->m; j++) {
        begin[j + 1] += begin[j];
        here[j] = -1;
    }
    for (int k = 0; k < basis->entries; k++)
        if (basis->slot[k] >= 0)
            list[begin[basis->slot[k]]++] = k;
    moray_pattern square;
    MORAY_TRY(moray_pattern_new(&square, begin[basis->m - 1]));
    for (int j = 0, t = 0; j < basis->m; j++)
        for (const int first = basis->slots; t < begin[j]; t++) {
            const int k = list[t], i = basis->row[k];
            if (here[i] < first) {
                here[i] = basis->slots;
                square.row[basis->slots] = i;
                square.col[basis->slots++] = j;
            }
            basis->slot[k] = here[i];
        }
    square.nnz = basis->slots;
    moray_status status = moray_sparse_lu_new_by_columns(&basis->lu, basis->m, &square);
    moray_pattern_free(&square);
    basis->values = malloc((2 * (size_t)basis->slots + 1) * sizeof *basis->values);
    return moray_failed(status) ? status : basis->values ? moray_ok() : no_memory(basis->m);
}

moray_status moray_basis_remake(struct basis *basis, const moray_pattern *pattern)
{
    const size_t m = (size_t)basis->m;
    int *work = calloc((m + 1) + m + (size_t)basis->entries, sizeof *work);
    if (!work)
        return no_memory(basis->m);
    moray_sparse_lu_free(basis->lu);
    free(basis->values);
    basis->lu = NULL;
    basis->values = NULL;
    basis->slots = 0;
    basis->factored = false;
    const moray_status status = make_matrix(basis, pattern, work, work + m + 1, work + m + 1 + m);
    free(work);
    return status;
}

static moray_status make(struct basis *basis, const moray_pattern *pattern, const double *values,
                         const struct view *view, bool *found)
{
    MORAY_TRY(list_entries(basis, pattern));
    MORAY_TRY(choose(basis, pattern, values, view, found));
    return *found ? moray_basis_remake(basis, pattern) : moray_ok();
}

moray_status moray_basis_choose(struct basis *basis, int variables, int m, const moray_pattern *pattern,
                                const double *values, int view, bool *found)
{
    *basis = (struct basis){.m = m, .variables = variables};
    *found = false;
    moray_status status = make(basis, pattern, values, &views[view], found);
    if (status.code == MORAY_INPUT) { // singular whatever its values: not with this matching
        *found = false;
        status = moray_ok();
    }
    if (moray_failed(status) || !*found)
        moray_basis_free(basis);
    return status;
}

void moray_basis_free(struct basis *basis)
{
    moray_sparse_lu_free(basis->lu);
    free(basis->place);
    free(basis->values);
    *basis = (struct basis){0};
}

static void gather(struct basis *basis, const double *values)
{
    memset(basis->values, 0, (size_t)basis->slots * sizeof *basis->values);
    for (int k = 0; k < basis->entries; k++)
        if (basis->slot[k] >= 0)
            basis->values[basis->slot[k]] += values[basis->source[k]];
}

moray_status moray_basis_factor(struct basis *basis, const double *values)
{
    const size_t size = (size_t)basis->slots * sizeof *basis->values;
    double *before = basis->values + basis->slots;
    gather(basis, values);
    if (basis->factored && memcmp(before, basis->values, size) == 0)
        return moray_ok();
    memcpy(before, basis->values, size);
    const moray_status status = moray_sparse_lu_factor(basis->lu, basis->values);
    basis->factored = !moray_failed(status);
    return status;
}

moray_status moray_basis_factor_nearly(struct basis *basis, const double *values)
{
    const double share = 1e-14, golden = 0.6180339887498949;
    gather(basis, values);
    for (int k = 0; k < basis->slots; k++) {
        const double far = golden * (k + 1) * (k + 1); // in steps that grow, which no sum cancels
        basis->values[k] *= 1 + share * (far - floor(far));
    }
    basis->factored = false;
    return moray_sparse_lu_factor(basis->lu, basis->values);
}

void moray_basis_others(const struct basis *basis, const double *values, double *columns)
{
    const int others = basis->variables - basis->m;
    memset(columns, 0, (size_t)others * (size_t)basis->m * sizeof *columns);
    for (int k = 0; k < basis->entries; k++)
        if (basis->slot[k] < 0)
            columns[(size_t)(-1 - basis->slot[k]) * (size_t)basis->m + (size_t)basis->row[k]] +=
                values[basis->source[k]];
}
