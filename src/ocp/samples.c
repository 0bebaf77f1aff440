// SPDX-License-Identifier: MIT
#include "ocp/samples.h"

#include <stdlib.h>

void moray_guess_free(moray_guess *guess)
{
    if (guess->owned && guess->owned == guess->from)
        moray_solution_free(guess->owned);
    else
        free(guess->owned);
    *guess = (moray_guess){0};
}

// One block: the samples' headers, then their numbers.
moray_status moray_guess_allocate(moray_guess *guess, const moray_ocp *ocp, const int *rows, bool parameters,
                                  struct samples *phase, double **s)
{
    const size_t headers = (size_t)ocp->phases * sizeof(moray_samples);
    size_t numbers = (size_t)ocp->ns;
    for (int p = 0; p < ocp->phases; p++)
        numbers += (size_t)rows[p] * (size_t)(1 + ocp->phase[p].nx + ocp->phase[p].nu);
    *guess = (moray_guess){.owned = calloc(1, headers + (numbers + 1) * sizeof(double))};
    if (!guess->owned)
        return moray_error(MORAY_MEMORY, "no memory for a guess of %zu numbers", numbers);
    moray_samples *samples = guess->owned;
    double *next = (double *)((char *)guess->owned + headers);
    for (int p = 0; p < ocp->phases; p++) {
        const int nx = ocp->phase[p].nx, nu = ocp->phase[p].nu;
        phase[p] = (struct samples){.time = next, .x = next + rows[p], .u = next + rows[p] * (1 + nx)};
        samples[p] = (moray_samples){rows[p], phase[p].time, phase[p].x, nu > 0 ? phase[p].u : NULL};
        next += rows[p] * (1 + nx + nu);
    }
    guess->phase = samples;
    guess->s = parameters ? next : NULL;
    if (s)
        *s = next;
    return moray_ok();
}
