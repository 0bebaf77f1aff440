// SPDX-License-Identifier: MIT
#include <math.h>

#include "moray/fit.h"
#include "ocp/names.h"
#include "ocp/solution.h"

int moray_solution_residuals(const moray_solution *solution, moray_residual *residual)
{
    const struct transcription *t = solution->transcription;
    int n = 0;
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct observed *o = &t->ocp->phase[p].observed;
        for (int k = 0; k < o->n; k++) {
            const double *predicted = residual ? moray_fit_predict(t->fit, p, k, t->end_in) : NULL;
            for (int j = 0; j < o->ny; j++) {
                const double y = o->value[k * o->ny + j];
                if (isnan(y))
                    continue;
                if (residual)
                    residual[n] = (moray_residual){p, k, j, o->time[k], y, predicted[j], o->weight[j]};
                n++;
            }
        }
    }
    return n;
}

void moray_observation_name(const moray_solution *solution, int phase, int channel, char *text, int size)
{
    const struct observed *o = &solution->transcription->ocp->phase[phase].observed;
    if (o->names)
        snprintf(text, (size_t)size, "%s", o->names[channel]);
    else
        snprintf(text, (size_t)size, "y[%d]", channel);
}
