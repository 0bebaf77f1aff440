// SPDX-License-Identifier: MIT
#include "ocp/certificate/saddle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/certificate/curvature.h"

static const double stride = 0.3; // of a size, by the variable that moves most: far enough not to come back

static bool has_length(const struct transcription *t)
{
    for (int p = 0; p < t->ocp->phases; p++)
        if (!(t->phase[p].tf > t->phase[p].t0))
            return false;
    return true;
}

static moray_status direction_of(const moray_solution *solution, double *curvature, double *direction)
{
    struct witness w;
    MORAY_TRY(moray_witness_of_sizes(&w, solution));
    const moray_status status = moray_measure_curvature(&w, curvature, direction);
    moray_witness_free(&w);
    return status;
}

static void move(moray_solution *solution, const double *direction)
{
    const moray_nlp *nlp = &solution->transcription->nlp;
    for (int j = 0; j < nlp->n; j++) {
        const double x = solution->iterate.x[j] + stride * direction[j];
        solution->iterate.x[j] = fmin(fmax(x, nlp->x_lower[j]), nlp->x_upper[j]);
    }
}

moray_status moray_leave_saddle(moray_solution *solution, double *kept, bool *moved)
{
    const size_t n = (size_t)solution->transcription->nlp.n;
    double curvature = 0, *direction = calloc(n, sizeof *direction);
    *moved = false;
    if (!direction)
        return moray_error(MORAY_MEMORY, "no memory for a direction of %zu variables", n);
    moray_status status = moray_ok();
    if (has_length(solution->transcription))
        status = direction_of(solution, &curvature, direction);
    *moved = !moray_failed(status) && isfinite(curvature) && curvature > MORAY_LIMIT_CURVATURE;
    if (*moved) {
        memcpy(kept, solution->iterate.x, n * sizeof *kept);
        move(solution, direction);
    }
    free(direction);
    return status;
}
