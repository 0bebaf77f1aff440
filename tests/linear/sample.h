// SPDX-License-Identifier: MIT
//
// A random symmetric matrix, as entries and as a whole.
#ifndef TESTS_LINEAR_SAMPLE_H
#define TESTS_LINEAR_SAMPLE_H

#include <string.h>

#include "moray/map.h"
#include "tap.h"

extern void dsyev_(const char *job, const char *uplo, const int *n, double *A, const int *lda, double *w, double *work,
                   const int *lwork, int *info);
enum { MOST = 60, ROOM = 8 * MOST * MOST };

typedef struct sample {
    int n, m; // rows; those of constraints, which come last, where there are such
    int row[ROOM], col[ROOM];
    moray_pattern pattern;
    double value[ROOM], A[MOST * MOST];
    unsigned long long seed;
} sample;

static inline int pick(sample *s, int n)
{
    return (int)tap_random(&s->seed, 0, n);
}

static inline void put(sample *s, int i, int j, double value)
{
    const int k = s->pattern.nnz++;
    const bool turned = pick(s, 2);
    s->row[k] = turned ? j : i;
    s->col[k] = turned ? i : j;
    s->value[k] = value;
    s->A[i * s->n + j] += value;
    if (i != j)
        s->A[j * s->n + i] += value;
}

static inline void start(sample *s, int n)
{
    s->n = n;
    s->pattern = (moray_pattern){0, s->row, s->col};
    memset(s->A, 0, sizeof s->A);
}

// Constraints of all variables, entries of either sign; of two of the variables they are about 1, of others `distance`.
static inline void put_constraints(sample *s, int one, int other, double distance)
{
    const int variables = s->n - s->m;
    for (int c = 0; c < s->m; c++) {
        const double common = tap_random(&s->seed, 0.5, 1);
        for (int j = 0; j < variables; j++)
            put(s, variables + c, j,
                (pick(s, 2) ? 1 : -1) * (j == one || j == other ? common : distance) * tap_random(&s->seed, 0.3, 1));
    }
}

// The largest residual of A x = b, each over what its row adds up.
static inline double residual_of(const sample *s, const double *x, const double *b)
{
    double worst = 0;
    for (int i = 0; i < s->n; i++) {
        double left = b[i], size = fabs(b[i]);
        for (int j = 0; j < s->n; j++) {
            left -= s->A[i * s->n + j] * x[j];
            size += fabs(s->A[i * s->n + j] * x[j]);
        }
        worst = tap_worse(worst, fabs(left) / size);
    }
    return worst;
}

#endif
