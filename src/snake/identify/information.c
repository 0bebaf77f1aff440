// SPDX-License-Identifier: MIT
//
// What the data say of the unknowns: the normal equations with every run's first state eliminated,
//     S = A_uu - sum_r A_ur A_rr^-1 A_ru,
// in scales of the unknowns; its eigenvectors are the directions, 1/sqrt(eigenvalue) how well each is known.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/results.h"
#include "moray/dense.h"
#include "snake/identify/identify.h"

static const double nothing = 1e-11; // of the largest eigenvalue: rounding
static const double poor = 1;        // a standard error of so many scales is no knowledge
static const double part = 1e-3, notable = 0.15;

// ---- Elimination ---------------------------------------------------------------------------------------------------

static moray_status eliminate(const moray_identify *v, moray_information *info)
{
    const int n = v->spec.n, m = v->columns;
    for (int i = 0; i < n; i++)
        memcpy(info->matrix + i * n, v->normal + i * m, (size_t)n * sizeof *info->matrix);
    for (int r = 0; r < v->runs; r++) {
        const double *rows = v->normal + (n + r * FIRST) * m;
        double block[FIRST * FIRST], right[FIRST * MORAY_MOST_UNKNOWNS], largest = 0;
        for (int i = 0; i < FIRST; i++) {
            memcpy(block + i * FIRST, rows + i * m + n + r * FIRST, FIRST * sizeof *block);
            memcpy(right + i * n, rows + i * m, (size_t)n * sizeof *right);
            largest = fmax(largest, block[i * FIRST + i]);
        }
        for (int i = 0; i < FIRST; i++) // states that nothing depends on
            block[i * FIRST + i] += 1e-14 * largest + 1e-300;
        if (!moray_dense_solve(FIRST, block, n, right))
            return moray_error(MORAY_NUMERIC, "log %s: where it starts is not determined", v->run[r].log->name);
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++)
                for (int k = 0; k < FIRST; k++)
                    info->matrix[i * n + j] -= rows[k * m + i] * right[k * n + j];
    }
    return moray_ok();
}

moray_status moray_identify_information(const moray_identify *v, const moray_estimate *at, moray_information *info)
{
    double cost;
    *info = (moray_information){.n = v->spec.n};
    if (!moray_identify_equations(v, at, &cost))
        return moray_error(MORAY_NUMERIC, "the logs cannot be swum with these coefficients");
    memcpy(info->scale, v->scale, sizeof info->scale);
    for (int k = 0; k < info->n; k++)
        info->held[k] = at->value[k] <= v->lower[k] || at->value[k] >= v->upper[k];
    MORAY_TRY(eliminate(v, info));
    return moray_information_examine(info);
}

// ---- Directions ----------------------------------------------------------------------------------------------------

static bool is_known(double variance)
{
    return sqrt(variance) < poor;
}

static void spread(moray_information *info)
{
    const int n = info->n;
    double largest = info->value[0];
    info->rank = 0;
    for (int k = 0; k < n; k++)
        info->rank += info->value[k] > nothing * largest && is_known(1 / info->value[k]);
    memset(info->covariance, 0, sizeof info->covariance);
    for (int i = 0; i < n; i++) {
        double variance = 0, open = 0;
        for (int k = 0; k < n; k++) {
            const double share = info->vector[k * n + i] * info->vector[k * n + i];
            if (info->value[k] > nothing * largest)
                variance += share / info->value[k];
            else
                open += share;
        }
        info->error[i] = info->held[i]                        ? 0
                         : open > part || !is_known(variance) ? INFINITY
                                                              : sqrt(variance) * info->scale[i];
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            for (int k = 0; k < n && info->value[k] > nothing * largest; k++)
                info->covariance[i * n + j] += info->vector[k * n + i] * info->vector[k * n + j] / info->value[k] *
                                               info->scale[i] * info->scale[j];
}

// Those held do not vary: they stand last, with no part in the others.
moray_status moray_information_examine(moray_information *info)
{
    const int n = info->n;
    int at[MORAY_MOST_UNKNOWNS], used = 0;
    double small[MORAY_MOST_UNKNOWNS * MORAY_MOST_UNKNOWNS], vector[MORAY_MOST_UNKNOWNS * MORAY_MOST_UNKNOWNS];
    for (int i = 0; i < n; i++)
        if (!info->held[i])
            at[used++] = i;
    for (int i = 0; i < used; i++)
        for (int j = 0; j < used; j++)
            small[i * used + j] = (info->matrix[at[i] * n + at[j]] + info->matrix[at[j] * n + at[i]]) / 2;
    memset(info->value, 0, sizeof info->value);
    memset(info->vector, 0, sizeof info->vector);
    if (used > 0)
        MORAY_TRY(moray_symmetric_eigen(used, small, info->value, vector));
    for (int k = 0; k < used; k++)
        for (int i = 0; i < used; i++)
            info->vector[k * n + at[i]] = vector[k * used + i];
    spread(info);
    return moray_ok();
}

// ---- In words ------------------------------------------------------------------------------------------------------

static void tell_direction(const double *v, const int *unknown, int n, char *text, size_t size)
{
    int at[MORAY_MOST_UNKNOWNS], parts = 0;
    for (int i = 0; i < n; i++)
        if (fabs(v[i]) > notable)
            at[parts++] = i;
    if (parts == 1) {
        moray_text_add(text, size, "%s", moray_unknown_name(unknown[at[0]]));
        return;
    }
    for (int i = 0; i < parts; i++)
        moray_text_add(text, size, "%s%s",
                       i == 0           ? ""
                       : i == parts - 1 ? " and "
                                        : ", ",
                       moray_unknown_name(unknown[at[i]]));
    moray_text_add(text, size, " only together: they may move by");
    for (int i = 0; i < parts; i++)
        moray_text_add(text, size, "%s %+.2f", i ? "," : "", v[at[i]] / fabs(v[at[0]]));
    moray_text_add(text, size, " of their scales at once");
    if (parts == 2)
        moray_text_add(text, size, " (what is known is their %s)",
                       v[at[0]] * v[at[1]] < 0 ? "sum" : "difference or ratio");
}

void moray_information_open(const moray_information *info, const int *unknown, char *text, size_t size)
{
    int used = 0;
    text[0] = 0;
    for (int i = 0; i < info->n; i++)
        used += !info->held[i];
    for (int k = info->rank; k < used; k++) {
        if (k > info->rank)
            moray_text_add(text, size, "\n");
        tell_direction(info->vector + k * info->n, unknown, info->n, text, size);
    }
}
