// SPDX-License-Identifier: MIT
//
// Values into slots, and their scale: sweeps that divide each row by the root of its largest entry (Ruiz) go on from
// the scale of the factorisation before, whose matrix is seldom far.
#include <math.h>
#include <string.h>

#include "linear/parts.h"

enum { first_sweeps = 5, sweeps = 2 };

static bool sum_up(moray_ldl *ldl, const double *values)
{
    const struct plan *plan = &ldl->plan;
    double check = 0;
    memset(ldl->value, 0, (size_t)plan->slots * sizeof *ldl->value);
    for (int k = 0; k < plan->puts; k++) {
        const double value = values[plan->source[k]];
        ldl->value[plan->slot[k]] += value;
        check += value - value; // NaN for what is infinite
    }
    return check == 0;
}

// peak[row] <- the largest entry of each row as scaled.
static void find_peaks(const struct plan *plan, const double *restrict value, const double *restrict scale,
                       double *restrict peak)
{
    memset(peak, 0, (size_t)plan->n * sizeof *peak);
    for (int c = 0; c < plan->n; c++) {
        const double own = scale[c];
        double most = peak[c];
        for (int k = plan->start[c]; k < plan->start[c + 1]; k++) {
            const int row = plan->row[k];
            const double size = fabs(value[k]) * own * scale[row], here = peak[row];
            most = size > most ? size : most;
            peak[row] = size > here ? size : here;
        }
        peak[c] = most > peak[c] ? most : peak[c];
    }
}

static void sweep(moray_ldl *ldl)
{
    find_peaks(&ldl->plan, ldl->value, ldl->scale, ldl->peak);
    for (int c = 0; c < ldl->plan.n; c++)
        if (ldl->peak[c] > 0)
            ldl->scale[c] /= sqrt(ldl->peak[c]);
}

bool moray_ldl_load(moray_ldl *ldl, const double *values)
{
    if (!sum_up(ldl, values))
        return false;
    for (int k = 0; k < (ldl->usual == 0 ? first_sweeps : sweeps); k++)
        sweep(ldl);
    for (int c = 0; c < ldl->plan.n; c++)
        for (int k = ldl->plan.start[c]; k < ldl->plan.start[c + 1]; k++)
            ldl->scaled[k] = ldl->value[k] * ldl->scale[c] * ldl->scale[ldl->plan.row[k]];
    return true;
}
