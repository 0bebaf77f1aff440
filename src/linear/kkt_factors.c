// SPDX-License-Identifier: MIT
#include "linear/kkt_factors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "linear/null_space.h"

static const double accurate = 1e-11; // residual that the null-space form may leave
enum { most_failures = 3 };           // of that form, after which it is given up

struct kkt_factors {
    moray_ldl *ldl;
    null_space *ns; // NULL: not for this matrix, or given up
    int n, nnz, failures;
    bool in_null_space;             // which of the two holds the factors
    double usual, threshold, error; // threshold of the first factorisation, of the last
    double *values, *kept;          // [nnz] as factored last; [n] a right-hand side
};

static moray_status make(kkt_factors *kkt, int n, const moray_pattern *pattern)
{
    kkt->n = n;
    kkt->nnz = pattern->nnz;
    MORAY_TRY(moray_ldl_new(&kkt->ldl, n, pattern));
    MORAY_TRY(moray_null_space_new(&kkt->ns, n, pattern));
    kkt->values = malloc(((size_t)pattern->nnz + (size_t)n + 1) * sizeof *kkt->values);
    if (!kkt->values)
        return moray_error(MORAY_MEMORY, "no memory for a sparse symmetric matrix of %d rows", n);
    kkt->kept = kkt->values + pattern->nnz;
    return moray_ok();
}

moray_status moray_kkt_factors_new(kkt_factors **result, int n, const moray_pattern *pattern)
{
    *result = NULL;
    kkt_factors *kkt = calloc(1, sizeof *kkt);
    if (!kkt)
        return moray_error(MORAY_MEMORY, "no memory for a sparse symmetric matrix of %d rows", n);
    const moray_status status = make(kkt, n, pattern);
    if (moray_failed(status))
        moray_kkt_factors_free(kkt);
    else
        *result = kkt;
    return status;
}

void moray_kkt_factors_free(kkt_factors *kkt)
{
    if (!kkt)
        return;
    moray_ldl_free(kkt->ldl);
    moray_null_space_free(kkt->ns);
    free(kkt->values);
    free(kkt);
}

static void count_failure(kkt_factors *kkt)
{
    kkt->in_null_space = false;
    if (++kkt->failures < most_failures)
        return;
    moray_null_space_free(kkt->ns);
    kkt->ns = NULL;
}

moray_status moray_kkt_factors_factor(kkt_factors *kkt, const double *values, double threshold)
{
    kkt->in_null_space = false;
    kkt->threshold = threshold;
    kkt->usual = kkt->usual > 0 ? kkt->usual : threshold;
    if (kkt->ns && threshold <= kkt->usual) { // a higher one asks for more digits
        memcpy(kkt->values, values, (size_t)kkt->nnz * sizeof *values);
        MORAY_TRY(moray_null_space_factor(kkt->ns, values, &kkt->in_null_space));
        if (kkt->in_null_space)
            return moray_ok();
    }
    return moray_ldl_factor(kkt->ldl, values, threshold);
}

// A basis that was chosen for matrices of long before loses digits: another is sought for this one. *good <- false
// where too many are lost all the same.
static moray_status solve_in_null_space(kkt_factors *kkt, double *b, bool *good)
{
    const size_t size = (size_t)kkt->n * sizeof *b;
    double error = INFINITY;
    bool fits = true;
    memcpy(kkt->kept, b, size);
    MORAY_TRY(moray_null_space_solve(kkt->ns, b, &error));
    if (error > accurate) {
        memcpy(b, kkt->kept, size);
        moray_null_space_forget(kkt->ns);
        MORAY_TRY(moray_null_space_factor(kkt->ns, kkt->values, &fits));
        if (fits)
            MORAY_TRY(moray_null_space_solve(kkt->ns, b, &error));
    }
    *good = error <= accurate;
    if (!*good)
        memcpy(b, kkt->kept, size);
    kkt->error = *good ? moray_worse(kkt->error, error) : 0;
    return moray_ok();
}

// Where the null-space form cannot do it the matrix is factored again, and the form counted out.
static moray_status solve_one(kkt_factors *kkt, double *b)
{
    if (kkt->in_null_space) {
        bool good;
        MORAY_TRY(solve_in_null_space(kkt, b, &good));
        if (good)
            return moray_ok();
        MORAY_TRY(moray_ldl_factor(kkt->ldl, kkt->values, kkt->threshold));
        count_failure(kkt);
    }
    MORAY_TRY(moray_ldl_solve(kkt->ldl, 1, b));
    kkt->error = moray_worse(kkt->error, moray_ldl_statistics_of(kkt->ldl).error);
    return moray_ok();
}

moray_status moray_kkt_factors_solve(kkt_factors *kkt, int columns, double *B)
{
    kkt->error = 0;
    for (int j = 0; j < columns; j++)
        MORAY_TRY(solve_one(kkt, B + (size_t)j * (size_t)kkt->n));
    return moray_ok();
}

moray_ldl_inertia moray_kkt_factors_inertia(const kkt_factors *kkt)
{
    return kkt->in_null_space ? moray_null_space_inertia(kkt->ns) : moray_ldl_inertia_of(kkt->ldl);
}

double moray_kkt_factors_error(const kkt_factors *kkt)
{
    return kkt->error;
}

bool moray_kkt_factors_has_pattern(const kkt_factors *kkt, int n, const moray_pattern *pattern)
{
    return moray_ldl_has_pattern(kkt->ldl, n, pattern);
}
