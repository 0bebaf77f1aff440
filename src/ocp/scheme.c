// SPDX-License-Identifier: MIT
#include "moray/scheme.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "moray/dense.h"
#include "ocp/legendre.h"

static void place_nodes(moray_scheme *scheme)
{
    switch (scheme->family) {
    case MORAY_LOBATTO:
        moray_legendre_lobatto(scheme->stages, scheme->node);
        break;
    case MORAY_RADAU:
        moray_legendre_radau(scheme->stages, scheme->node + 1);
        break;
    case MORAY_GAUSS:
        moray_legendre_gauss(scheme->stages, scheme->node + 1, NULL);
        scheme->node[scheme->points - 1] = 1;
        break;
    }
}

static double lagrange(const moray_scheme *scheme, int j, double tau)
{
    double value = 1;
    for (int k = scheme->first; k <= scheme->last; k++)
        if (k != j)
            value *= (tau - scheme->node[k]) / (scheme->node[j] - scheme->node[k]);
    return value;
}

void moray_scheme_basis(const moray_scheme *scheme, double tau, double *ell, double *integral)
{
    for (int j = 0; j < scheme->points; j++) {
        ell[j] = integral[j] = 0;
        if (j < scheme->first || j > scheme->last)
            continue;
        ell[j] = lagrange(scheme, j, tau);
        for (int k = 0; k < scheme->exact; k++)
            integral[j] += tau * scheme->weight[k] * lagrange(scheme, j, tau * scheme->gauss[k]);
    }
}

// Divides a row of P and Q so that the largest coefficient of P is 1: a defect is then an error in x.
static void scale_row(moray_scheme *scheme, int i)
{
    const int n = scheme->points;
    double largest = 0;
    for (int j = 0; j < n; j++)
        largest = fmax(largest, fabs(scheme->P[i * n + j]));
    for (int j = 0; j < n; j++) {
        scheme->P[i * n + j] /= largest;
        scheme->Q[i * n + j] /= largest;
    }
}

// With M the inverse of A's part that belongs to the stages after the first point: P = M (x_i - x_0), Q = M A, of which
// only the first column is neither 1 nor 0.
static bool differentiate(moray_scheme *scheme, double *block, double *right)
{
    const int n = scheme->points, inner = scheme->last, width = n + 1; // points 1..last are solved for
    for (int i = 0; i < inner; i++) {
        for (int j = 0; j < inner; j++)
            block[i * inner + j] = scheme->A[(i + 1) * n + j + 1];
        for (int j = 0; j < n; j++)
            right[i * width + j] = (j == i + 1) - (j == 0);
        right[i * width + n] = scheme->A[(i + 1) * n];
    }
    if (!moray_dense_solve(inner, block, width, right))
        return false;
    for (int i = 0; i < inner; i++)
        for (int j = 0; j < n; j++) {
            scheme->P[i * n + j] = right[i * width + j];
            scheme->Q[i * n + j] = j == i + 1 ? 1 : j == 0 ? right[i * width + n] : 0;
        }
    return true;
}

// Gauss: the end of the interval, x_end - x_0 = h sum b f, with h f taken from the rows above.
static void close_gauss(moray_scheme *scheme)
{
    const int n = scheme->points, row = n - 2;
    for (int j = 0; j < n; j++) {
        scheme->P[row * n + j] = (j == n - 1) - (j == 0);
        for (int i = 0; i < row; i++)
            scheme->P[row * n + j] -= scheme->b[i + 1] * scheme->P[i * n + j];
    }
}

static moray_status fill_tables(moray_scheme *scheme)
{
    const int n = scheme->points;
    double *block = calloc((size_t)(n * (2 * n + 1)), sizeof *block), ell[MORAY_MAX_STAGES + 2];
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for a scheme of %d stages", scheme->stages);
    place_nodes(scheme);
    moray_legendre_gauss(scheme->exact, scheme->gauss, scheme->weight);
    for (int i = 0; i < n; i++)
        moray_scheme_basis(scheme, scheme->node[i], ell, scheme->A + i * n);
    memcpy(scheme->b, scheme->A + (n - 1) * n, (size_t)n * sizeof *scheme->b);
    const bool ok = differentiate(scheme, block, block + n * n);
    if (scheme->family == MORAY_GAUSS)
        close_gauss(scheme);
    for (int i = 0; i < n - 1; i++)
        scale_row(scheme, i);
    free(block);
    return ok ? moray_ok() : moray_error(MORAY_NUMERIC, "the table of %d stages is singular", scheme->stages);
}

moray_status moray_scheme_new(moray_scheme *scheme, moray_family family, int stages)
{
    const int least = family == MORAY_LOBATTO ? 2 : 1;
    *scheme = (moray_scheme){0};
    if (stages < least || stages > MORAY_MAX_STAGES)
        return moray_error(MORAY_INPUT, "%d stages: this family has %d to %d", stages, least, MORAY_MAX_STAGES);
    const int n = family == MORAY_LOBATTO ? stages : family == MORAY_RADAU ? stages + 1 : stages + 2;
    *scheme = (moray_scheme){.family = family, .stages = stages, .points = n};
    scheme->first = family == MORAY_LOBATTO ? 0 : 1;
    scheme->last = scheme->first + stages - 1;
    scheme->order = 2 * stages - (family == MORAY_LOBATTO ? 2 : family == MORAY_RADAU ? 1 : 0);
    scheme->exact = stages / 2 + 1; // of degree s - 1
    scheme->node = calloc((size_t)(n * (2 + 3 * n) + 2 * scheme->exact), sizeof *scheme->node);
    if (!scheme->node)
        return moray_error(MORAY_MEMORY, "no memory for a scheme of %d stages", stages);
    scheme->b = scheme->node + n;
    scheme->A = scheme->b + n;
    scheme->P = scheme->A + n * n;
    scheme->Q = scheme->P + n * n;
    scheme->gauss = scheme->Q + n * n;
    scheme->weight = scheme->gauss + scheme->exact;
    moray_status status = fill_tables(scheme);
    if (moray_failed(status))
        moray_scheme_free(scheme);
    return status;
}

void moray_scheme_free(moray_scheme *scheme)
{
    free(scheme->node);
    *scheme = (moray_scheme){0};
}

moray_status moray_scheme_parse(const char *name, moray_family *family, int *stages)
{
    static const struct {
        const char *name;
        moray_family family;
        int stages; // 0: a number follows
    } known[] = {{"trapezoid", MORAY_LOBATTO, 2},
                 {"hermite-simpson", MORAY_LOBATTO, 3},
                 {"lobatto", MORAY_LOBATTO, 0},
                 {"radau", MORAY_RADAU, 0},
                 {"gauss", MORAY_GAUSS, 0}};
    for (unsigned i = 0; i < sizeof known / sizeof *known; i++) {
        const size_t length = strlen(known[i].name);
        if (strncmp(name, known[i].name, length) != 0)
            continue;
        int read = 0;
        *family = known[i].family;
        *stages = known[i].stages;
        if (known[i].stages == 0 && (sscanf(name + length, "%2d%n", stages, &read) != 1 || *stages < 1))
            continue;
        if (name[length + read] == 0 && *stages <= MORAY_MAX_STAGES && (*stages > 1 || *family != MORAY_LOBATTO))
            return moray_ok();
    }
    return moray_error(MORAY_INPUT,
                       "scheme = %.40s: must be trapezoid, hermite-simpson, lobatto<s> (s = 2..64), radau<s> or "
                       "gauss<s> (s = 1..64)",
                       name);
}
