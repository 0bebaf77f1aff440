// SPDX-License-Identifier: MIT
//
// MA57's calls carry their state in the work arrays of the caller; here these hold no more than the number of the
// object, which the solve of this thread owns.
#include "nlp/ipopt_linear.h"

#include <stdlib.h>
#include <string.h>

#include "base/number.h"

#if __has_include(<HSLLoader.h>)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wstrict-prototypes" // its functions say () for (void)
#include <HSLLoader.h>
#pragma GCC diagnostic pop

static _Thread_local struct ipopt_linear *current;

// Numbers of MA57's info[], from 0, and what they say.
enum { needed_fact = 8, needed_ifact = 9, negative = 23, rank = 24 };
enum { fine = 0, no_object = -1, no_factors = -2, singular = 4 };

static void set_defaults(double *cntl, ipfint *icntl)
{
    memset(cntl, 0, 5 * sizeof *cntl);
    memset(icntl, 0, 20 * sizeof *icntl);
}

// The object of this pattern, made if there is none yet. Error: MORAY_NOT_SOLVED, MORAY_MEMORY.
static moray_status find_object(int n, const moray_pattern *pattern, int *number)
{
    for (int k = 0; k < current->patterns; k++)
        if (moray_kkt_factors_has_pattern(current->kkt[k], n, pattern)) {
            *number = k;
            return moray_ok();
        }
    if (current->patterns == ipopt_linear_patterns)
        return moray_error(MORAY_NOT_SOLVED, "Ipopt changes its pattern more than %d times", ipopt_linear_patterns);
    MORAY_TRY(moray_kkt_factors_new(&current->kkt[current->patterns], n, pattern));
    *number = current->patterns++;
    return moray_ok();
}

static void analyse(ipfint *n, ipfint *entries, const ipfint *row, const ipfint *col, ipfint *size, ipfint *keep,
                    ipfint *work, ipfint *icntl, ipfint *info, double *rinfo)
{
    (void)size, (void)work, (void)icntl, (void)rinfo;
    const double start = current->clock();
    moray_pattern pattern;
    int number = -1;
    moray_status status = moray_pattern_new(&pattern, *entries);
    if (!moray_failed(status)) {
        for (int k = 0; k < *entries; k++) { // Fortran counts from 1
            pattern.row[k] = row[k] - 1;
            pattern.col[k] = col[k] - 1;
        }
        status = find_object(*n, &pattern, &number);
        moray_pattern_free(&pattern);
    }
    if (moray_failed(status))
        current->failure = status;
    keep[0] = number;
    info[0] = fine; // 3.11 goes on whatever is said here: the factorisation will tell
    info[needed_fact] = info[needed_ifact] = 1;
    current->seconds += current->clock() - start;
}

static void factor(ipfint *n, ipfint *entries, double *values, double *fact, ipfint *fact_size, ipfint *ifact,
                   ipfint *ifact_size, ipfint *keep_size, ipfint *keep, ipfint *work, ipfint *icntl, double *cntl,
                   ipfint *info, double *rinfo)
{
    (void)entries, (void)fact, (void)fact_size, (void)ifact_size, (void)keep_size, (void)work, (void)icntl, (void)rinfo;
    const double start = current->clock();
    info[0] = no_object;
    ifact[0] = keep[0];
    if (keep[0] < 0)
        return;
    kkt_factors *kkt = current->kkt[keep[0]];
    const moray_status status = moray_kkt_factors_factor(kkt, values, cntl[0]);
    const moray_ldl_inertia inertia = moray_kkt_factors_inertia(kkt);
    if (status.code == MORAY_MEMORY || status.code == MORAY_NOT_SOLVED)
        current->failure = status;
    else // what is not finite is as good as singular: Ipopt then shortens its step or gives up
        info[0] = moray_failed(status) || inertia.zero > 0 ? singular : fine;
    info[negative] = inertia.negative;
    info[rank] = *n - inertia.zero;
    current->seconds += current->clock() - start;
}

static void solve(ipfint *job, ipfint *n, double *fact, ipfint *fact_size, ipfint *ifact, ipfint *ifact_size,
                  ipfint *columns, double *B, ipfint *B_size, double *work, ipfint *work_size, ipfint *iwork,
                  ipfint *icntl, ipfint *info)
{
    (void)job, (void)n, (void)fact, (void)fact_size, (void)ifact_size, (void)B_size, (void)work, (void)work_size;
    (void)iwork, (void)icntl;
    const double start = current->clock();
    kkt_factors *kkt = current->kkt[ifact[0]];
    const moray_status status = moray_kkt_factors_solve(kkt, *columns, B);
    current->error = moray_worse(current->error, moray_kkt_factors_error(kkt));
    info[0] = moray_failed(status) ? no_factors : fine;
    current->seconds += current->clock() - start;
}

// Never called, as no work array is ever too small.
static void enlarge(ipfint *n, ipfint *what, ipfint *keep, double *fact, ipfint *fact_size, double *new_fact,
                    ipfint *new_fact_size, ipfint *ifact, ipfint *ifact_size, ipfint *new_ifact, ipfint *new_ifact_size,
                    ipfint *info)
{
    (void)n, (void)what, (void)keep, (void)fact, (void)fact_size, (void)new_fact, (void)new_fact_size, (void)ifact;
    (void)ifact_size, (void)new_ifact, (void)new_ifact_size;
    info[0] = fine;
}

bool moray_ipopt_linear_available(void)
{
    return true;
}

void moray_ipopt_linear_open(struct ipopt_linear *linear, double (*clock)(void))
{
    *linear = (struct ipopt_linear){.clock = clock, .outer = current};
    current = linear;
    LSL_setMA57(analyse, factor, solve, enlarge, set_defaults);
}

void moray_ipopt_linear_close(struct ipopt_linear *linear)
{
    for (int k = 0; k < linear->patterns; k++)
        moray_kkt_factors_free(linear->kkt[k]);
    linear->patterns = 0;
    current = linear->outer;
}

moray_status moray_ipopt_linear_verdict(const struct ipopt_linear *linear, bool failed)
{
    static const double trusted = 1e-7; // backward error of a solution that Ipopt can refine
    if (moray_failed(linear->failure) || !failed || linear->error < trusted)
        return linear->failure;
    return moray_error(MORAY_NOT_SOLVED, "linear systems were solved with backward errors up to %.1e, not below %g",
                       linear->error, trusted);
}

void moray_ipopt_linear_stand_back(void)
{
    LSL_setMA57(NULL, NULL, NULL, NULL, NULL);
}

#else

bool moray_ipopt_linear_available(void)
{
    return false;
}

void moray_ipopt_linear_open(struct ipopt_linear *linear, double (*clock)(void))
{
    *linear = (struct ipopt_linear){.clock = clock};
}

void moray_ipopt_linear_close(struct ipopt_linear *linear)
{
    (void)linear;
}

moray_status moray_ipopt_linear_verdict(const struct ipopt_linear *linear, bool failed)
{
    (void)linear, (void)failed;
    return moray_ok();
}

void moray_ipopt_linear_stand_back(void)
{
}

#endif
