// SPDX-License-Identifier: MIT
//
// With B the basic columns of A, N the others and Z = [-B^-1 N; I] every solution of the constraints is a particular
// one plus Z times something, so that Z' H Z, a few rows large, is all that is left. The inertia of the whole is that
// of Z' H Z and as many eigenvalues of either sign as there are constraints.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear/null_space_parts.h"

static const double regular = 1e-15; // reciprocal condition of a basis, by its pivots
static const double far =
    1e3; // what one of the other variables may move a basic one by, a little of which costs no digits
enum { most_freedom = 24, most_vain = 3, most_exchanges = 8, most_rounds = 3 };

static moray_status no_memory(int n)
{
    return moray_error(MORAY_MEMORY, "no memory for a sparse symmetric matrix of %d rows", n);
}

// ---- Form ----------------------------------------------------------------------------------------------------------

// The last rows that meet none of each other off the diagonal.
static int count_constraints(int n, const moray_pattern *pattern)
{
    int last = -1;
    for (int k = 0; k < pattern->nnz; k++)
        if (pattern->row[k] != pattern->col[k]) {
            const int lower = pattern->row[k] < pattern->col[k] ? pattern->row[k] : pattern->col[k];
            last = lower > last ? lower : last;
        }
    return n - 1 - last;
}

static moray_status allocate(null_space *ns)
{
    const size_t n = (size_t)ns->n, m = (size_t)ns->m, f = (size_t)ns->freedom, v = (size_t)ns->variables;
    const size_t nnz = (size_t)ns->pattern.nnz;
    ns->source = malloc((3 * (size_t)ns->hessian + 1) * sizeof *ns->source);
    ns->block =
        calloc(nnz + (size_t)ns->hessian + (2 * v + m) * f + f * (f + 1) / 2 + f + v + 5 * n + 1, sizeof *ns->block);
    if (!ns->block || !ns->source)
        return no_memory(ns->n);
    ns->i = ns->source + ns->hessian;
    ns->j = ns->i + ns->hessian;
    ns->values = ns->block;
    ns->H = ns->values + nnz;
    ns->Z = ns->H + ns->hessian;
    ns->HZ = ns->Z + v * f;
    ns->columns = ns->HZ + v * f;
    ns->R = ns->columns + m * f;
    ns->r = ns->R + f * (f + 1) / 2;
    ns->weight = ns->r + f;
    ns->largest = ns->weight + v;
    ns->rhs = ns->largest + n;
    ns->x = ns->rhs + n;
    ns->step = ns->x + n;
    ns->residual = ns->step + n;
    return moray_ok();
}

static moray_status make_reduced(null_space *ns)
{
    const int f = ns->freedom;
    moray_pattern full;
    MORAY_TRY(moray_pattern_new(&full, f * (f + 1) / 2));
    for (int i = 0, k = 0; i < f; i++)
        for (int j = 0; j <= i; j++, k++) {
            full.row[k] = i;
            full.col[k] = j;
        }
    const moray_status status = moray_ldl_new(&ns->reduced, f, &full);
    moray_pattern_free(&full);
    return status;
}

static bool is_hessian(const null_space *ns, int k)
{
    return ns->pattern.row[k] < ns->variables && ns->pattern.col[k] < ns->variables;
}

static void list_hessian(null_space *ns)
{
    for (int k = 0, e = 0; k < ns->pattern.nnz; k++)
        if (is_hessian(ns, k)) {
            ns->source[e] = k;
            ns->i[e] = ns->pattern.row[k];
            ns->j[e++] = ns->pattern.col[k];
        }
}

static moray_status make(null_space *ns, const moray_pattern *pattern)
{
    const size_t size = (size_t)pattern->nnz * sizeof *pattern->row;
    MORAY_TRY(moray_pattern_new(&ns->pattern, pattern->nnz));
    memcpy(ns->pattern.row, pattern->row, size);
    memcpy(ns->pattern.col, pattern->col, size);
    for (int k = 0; k < pattern->nnz; k++)
        ns->hessian += is_hessian(ns, k);
    MORAY_TRY(allocate(ns));
    list_hessian(ns);
    return make_reduced(ns);
}

moray_status moray_null_space_new(null_space **result, int n, const moray_pattern *pattern)
{
    const int m = count_constraints(n, pattern), freedom = n - 2 * m;
    *result = NULL;
    if (m <= 0 || freedom < 0 || freedom > most_freedom)
        return moray_ok();
    null_space *ns = calloc(1, sizeof *ns);
    if (!ns)
        return no_memory(n);
    ns->n = n;
    ns->m = m;
    ns->variables = n - m;
    ns->freedom = freedom;
    const moray_status status = make(ns, pattern);
    if (moray_failed(status))
        moray_null_space_free(ns);
    else
        *result = ns;
    return status;
}

void moray_null_space_free(null_space *ns)
{
    if (!ns)
        return;
    moray_basis_free(&ns->basis);
    moray_ldl_free(ns->reduced);
    moray_pattern_free(&ns->pattern);
    free(ns->source);
    free(ns->block);
    free(ns);
}

// ---- Factors -------------------------------------------------------------------------------------------------------

static double larger(double a, double b)
{
    return a > b ? a : b;
}

// Whether the values are finite, and the constraints have nothing on the diagonal; notes the largest entry of each row.
static bool look_through(null_space *ns, bool *finite)
{
    const int *row = ns->pattern.row, *col = ns->pattern.col;
    double check = 0, corner = 0;
    memset(ns->largest, 0, (size_t)ns->n * sizeof *ns->largest);
    for (int k = 0; k < ns->pattern.nnz; k++) {
        const int i = row[k], j = col[k];
        const double size = fabs(ns->values[k]);
        check += size - size;
        corner += i >= ns->variables && j >= ns->variables ? size : 0;
        ns->largest[i] = larger(ns->largest[i], size);
        ns->largest[j] = larger(ns->largest[j], size);
    }
    for (int e = 0; e < ns->hessian; e++)
        ns->H[e] = ns->values[ns->source[e]];
    *finite = check == 0;
    return corner == 0;
}

static inline __attribute__((always_inline)) void multiply(const null_space *ns, int columns, const double *x,
                                                           double *y)
{
    for (int e = 0; e < ns->hessian; e++) {
        const int i = ns->i[e], j = ns->j[e];
        const double h = ns->H[e], mirrored = i == j ? 0 : h;
        for (int c = 0; c < columns; c++)
            y[i * columns + c] += h * x[j * columns + c];
        for (int c = 0; c < columns; c++)
            y[j * columns + c] += mirrored * x[i * columns + c];
    }
}

void moray_null_space_multiply(const null_space *ns, int columns, const double *x, double *y)
{
    switch (columns) { // loops of known length
    case 1:
        multiply(ns, 1, x, y);
        break;
    case 2:
        multiply(ns, 2, x, y);
        break;
    case 3:
        multiply(ns, 3, x, y);
        break;
    case 4:
        multiply(ns, 4, x, y);
        break;
    default:
        multiply(ns, columns, x, y);
    }
}

// Z by rows of variables, from the basis.
static moray_status find_null_space(null_space *ns)
{
    const int f = ns->freedom, m = ns->m;
    moray_basis_others(&ns->basis, ns->values, ns->columns);
    MORAY_TRY(moray_sparse_lu_solve(ns->basis.lu, f, ns->columns));
    for (int i = 0; i < ns->variables; i++)
        for (int c = 0; c < f; c++) {
            const int basic = ns->basis.place[i];
            ns->Z[i * f + c] = basic >= 0 ? -ns->columns[c * m + basic] : basic == -1 - c;
        }
    return moray_ok();
}

static moray_status reduce(null_space *ns)
{
    const int f = ns->freedom;
    MORAY_TRY(find_null_space(ns));
    memset(ns->HZ, 0, (size_t)(ns->variables * f) * sizeof *ns->HZ);
    memset(ns->R, 0, (size_t)(f * (f + 1) / 2) * sizeof *ns->R);
    moray_null_space_multiply(ns, f, ns->Z, ns->HZ);
    for (int i = 0; i < ns->variables; i++)
        for (int a = 0, k = 0; a < f; a++)
            for (int b = 0; b <= a; b++, k++)
                ns->R[k] += ns->Z[i * f + a] * ns->HZ[i * f + b];
    return f > 0 ? moray_ldl_factor(ns->reduced, ns->R, 0.1) : moray_ok();
}

// With the values at hand. planned <- false where they make the basis singular, solvable where nearby ones do, too.
static moray_status try_basis(null_space *ns)
{
    moray_status status = moray_basis_factor(&ns->basis, ns->values);
    ns->planned = !moray_failed(status) && moray_sparse_lu_condition(ns->basis.lu) >= regular;
    if (status.code == MORAY_NUMERIC)
        status = moray_basis_factor_nearly(&ns->basis, ns->values);
    ns->solvable = !moray_failed(status);
    return status.code == MORAY_NUMERIC ? moray_ok() : status;
}

// What a step of each variable weighs: the root of its curvature, of which a bound nearby has much. Of little: 1.
static void find_weights(null_space *ns)
{
    for (int i = 0; i < ns->variables; i++)
        ns->weight[i] = 1;
    for (int e = 0; e < ns->hessian; e++)
        if (ns->i[e] == ns->j[e])
            ns->weight[ns->i[e]] = larger(ns->weight[ns->i[e]], sqrt(fabs(ns->H[e])));
}

// The entry of Z that weighs most among the basic variables, over the weight of the one that moves it.
static double find_largest(const null_space *ns, int *variable, int *column)
{
    const int f = ns->freedom;
    double of_other[most_freedom], largest = 0;
    for (int i = 0; i < ns->variables; i++)
        if (ns->basis.place[i] < 0)
            of_other[-1 - ns->basis.place[i]] = ns->weight[i];
    for (int i = 0; i < ns->variables; i++)
        for (int c = 0; c < f && ns->basis.place[i] >= 0; c++) {
            const double moved = fabs(ns->Z[i * f + c]) * ns->weight[i] / of_other[c];
            if (moved > largest) {
                largest = moved;
                *variable = i;
                *column = c;
            }
        }
    return largest;
}

// A basic variable and one of the others take each other's place; Z follows.
static void exchange(null_space *ns, int variable, int column)
{
    const int f = ns->freedom;
    const double pivot = ns->Z[variable * f + column];
    int other = 0;
    while (ns->basis.place[other] != -1 - column)
        other++;
    ns->basis.place[other] = ns->basis.place[variable];
    ns->basis.place[variable] = -1 - column;
    for (int i = 0; i < ns->variables; i++) {
        double *row = ns->Z + i * f;
        row[column] /= pivot;
        for (int c = 0; c < f && i != variable; c++)
            row[c] -= c == column ? 0 : row[column] * ns->Z[variable * f + c];
    }
    for (int c = 0; c < f; c++)
        ns->Z[variable * f + c] = c == column;
}

// Until the other variables move no basic one by far more than themselves, both as they weigh: each exchange makes the
// determinant of the basis larger by the entry of Z (a basis of nearly maximal volume), and Z is then well conditioned.
// Of a basis that is singular but for rounding the entries are the direction that it lacks, so that this repairs it;
// variables near a bound leave the basis, where their curvature would drown all other.
static moray_status enlarge_basis(null_space *ns, bool *changed)
{
    int variable = 0, column = 0, exchanges = 0;
    MORAY_TRY(find_null_space(ns));
    find_weights(ns);
    while (exchanges < most_exchanges * ns->freedom && find_largest(ns, &variable, &column) > far) {
        exchange(ns, variable, column);
        exchanges++;
    }
    *changed = exchanges > 0;
    if (!*changed)
        return moray_ok();
    ns->planned = ns->solvable = false;
    MORAY_TRY(moray_basis_remake(&ns->basis, &ns->pattern));
    return try_basis(ns);
}

// Z of a poor basis is poor too: once more with what it made.
static moray_status mend_basis(null_space *ns)
{
    bool changed = ns->freedom > 0;
    for (int round = 0; round < most_rounds && changed && ns->solvable; round++)
        MORAY_TRY(enlarge_basis(ns, &changed));
    return moray_ok();
}

// The basis of the time before, or another one that is regular; planned <- false where there is none.
static moray_status factor_basis(null_space *ns)
{
    if (ns->planned)
        MORAY_TRY(try_basis(ns));
    for (int view = 0; view < MORAY_BASIS_VIEWS && !ns->planned; view++) {
        bool found;
        moray_basis_free(&ns->basis);
        MORAY_TRY(moray_basis_choose(&ns->basis, ns->variables, ns->m, &ns->pattern, ns->values, view, &found));
        if (found) {
            MORAY_TRY(try_basis(ns));
            MORAY_TRY(mend_basis(ns));
        }
    }
    return moray_ok();
}

void moray_null_space_forget(null_space *ns)
{
    moray_basis_free(&ns->basis);
    ns->planned = ns->factored = false;
}

// factored <- false where there is no basis, or what is left is not finite or singular: rounding looks so, too.
static moray_status reduce_by_basis(null_space *ns)
{
    MORAY_TRY(factor_basis(ns));
    if (!ns->planned) {
        ns->vain++;
        return moray_ok();
    }
    const moray_status status = reduce(ns);
    ns->factored = !moray_failed(status) && (ns->freedom == 0 || moray_ldl_inertia_of(ns->reduced).zero == 0);
    return status.code == MORAY_NUMERIC ? moray_ok() : status;
}

moray_status moray_null_space_factor(null_space *ns, const double *values, bool *fits)
{
    bool finite;
    *fits = ns->factored = false;
    memcpy(ns->values, values, (size_t)ns->pattern.nnz * sizeof *values);
    const bool suitable = look_through(ns, &finite);
    if (!finite)
        return moray_error(MORAY_NUMERIC, "a sparse matrix of %d rows is not finite", ns->n);
    if (!suitable || ns->vain == most_vain)
        return moray_ok();
    const bool chosen = ns->planned;
    MORAY_TRY(reduce_by_basis(ns));
    if (chosen && ns->planned && !ns->factored) { // by a basis of before, whose variables have come to their bounds
        MORAY_TRY(mend_basis(ns));
        MORAY_TRY(reduce_by_basis(ns));
    }
    if (chosen && !ns->factored) {
        moray_null_space_forget(ns);
        MORAY_TRY(reduce_by_basis(ns));
    }
    *fits = ns->factored;
    return moray_ok();
}

moray_ldl_inertia moray_null_space_inertia(const null_space *ns)
{
    if (!ns->factored)
        return (moray_ldl_inertia){0};
    moray_ldl_inertia inertia = ns->freedom > 0 ? moray_ldl_inertia_of(ns->reduced) : (moray_ldl_inertia){0};
    inertia.positive += ns->m;
    inertia.negative += ns->m;
    return inertia;
}
