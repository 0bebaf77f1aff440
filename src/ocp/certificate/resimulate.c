// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/certificate/certify.h"

struct resimulation {
    struct examiner *e;
    const struct interval *interval; // the one being integrated: its control also at its ends, where controls may jump
    double start;                    // of the phase, from which time counts: steps would drown in a late one's digits
};

static bool resimulated_rhs(double t, const double *x, double *dx, void *self)
{
    const struct resimulation *r = self;
    struct examiner *e = r->e;
    moray_examiner_evaluate(e, r->interval, r->start + t, x);
    for (int i = 0; i < e->n; i++) {
        dx[i] = e->out[moray_examiner_output(e, i)];
        if (!isfinite(dx[i]))
            return false;
    }
    return true;
}

// Largest relative difference between n of the integrated quantities and what was found.
static double difference(const struct examiner *e, const double *x, const double *found, int first, int n)
{
    double worst = 0;
    for (int i = 0; i < n; i++) {
        const double far = fabs(x[first + i] - found[i]) / e->size[first + i];
        worst = isnan(far) ? INFINITY : fmax(worst, far);
    }
    return worst;
}

// One pass over the intervals, the integrals along with the states: from every start anew, or on from where it is.
static moray_status run(struct examiner *e, const moray_integrator *integrator, bool anew, double *x,
                        const double *time, struct finding *worst)
{
    const struct phase_layout *layout = &e->solution->transcription->layout.phase[e->p];
    const double *found = e->solution->iterate.x;
    const int nx = e->solution->transcription->ocp->phase[e->p].nx;
    struct resimulation resimulation = {e, NULL, time[0]};
    const moray_ode ode = {e->n, resimulated_rhs, &resimulation};
    memset(x, 0, (size_t)e->n * sizeof *x);
    for (int k = 0; k < layout->mesh.intervals; k++) {
        const int first = layout->interval[k].first, last = first + layout->interval[k].scheme->points - 1;
        if (k == 0 || anew)
            memcpy(x, found + layout->node[first].x, (size_t)nx * sizeof *x);
        resimulation.interval = &layout->interval[k];
        MORAY_TRY(
            integrator->run(integrator, &ode, time[first] - time[0], time[last] - time[0], x, NULL, 0, NULL, NULL));
        moray_find(worst, difference(e, x, found + layout->node[last].x, 0, nx), e->p, time[last]);
    }
    moray_find(worst, difference(e, x, found + layout->q, nx, e->n - nx), e->p, time[layout->nodes - 1]);
    return moray_ok();
}

moray_status moray_resimulate(struct examiner *e, const moray_integrator *integrator, struct finding *shooting,
                              double *composed)
{
    const int nodes = e->solution->transcription->layout.phase[e->p].nodes;
    double *x = calloc((size_t)(e->n + nodes), sizeof *x);
    if (!x)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    double *time = x + e->n;
    struct finding whole = {0};
    moray_solution_nodes(e->solution, e->p, time, NULL);
    moray_status status = run(e, integrator, true, x, time, shooting);
    if (status.code == MORAY_NUMERIC) { // the found controls lead out of where the functions are defined
        moray_find(shooting, INFINITY, e->p, time[0]);
        *composed = INFINITY;
        status = moray_ok();
    } else if (!moray_failed(status)) {
        const moray_status composition = run(e, integrator, false, x, time, &whole);
        if (composition.code == MORAY_MEMORY)
            status = composition;
        *composed = moray_failed(composition) ? INFINITY : fmax(*composed, whole.value);
    }
    free(x);
    return status;
}
