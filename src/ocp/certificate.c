// SPDX-License-Identifier: MIT
//
// What a solution is worth, measured apart from the solver that found it.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/differences.h"
#include "ocp/examine.h"

// ---- Re-simulation ----

struct resimulation {
    struct examiner *e;
    const struct interval *interval; // the one being integrated: its control also at its ends, where controls may jump
};

static bool resimulated_rhs(double t, const double *x, double *dx, void *self)
{
    const struct resimulation *r = self;
    struct examiner *e = r->e;
    moray_examiner_evaluate(e, r->interval, t, x);
    for (int i = 0; i < e->n; i++) {
        dx[i] = e->out[moray_examiner_output(e, i)];
        if (!isfinite(dx[i]))
            return false;
    }
    return true;
}

// Raises *worst to the largest relative difference between n of the integrated quantities and what was found.
static void compare(const struct examiner *e, const double *x, const double *found, int first, int n, double *worst)
{
    for (int i = 0; i < n; i++) {
        const double difference = fabs(x[first + i] - found[i]) / e->size[first + i];
        *worst = isnan(difference) ? INFINITY : fmax(*worst, difference);
    }
}

// Integrates interval by interval, the integrals along with the states.
static moray_status resimulate(struct examiner *e, const moray_integrator *integrator, moray_certificate *certificate)
{
    const struct transcription *t = e->solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[e->p];
    const double *found = e->solution->iterate.x;
    const int nx = t->ocp->phase[e->p].nx;
    double *x = calloc((size_t)(e->n + layout->nodes), sizeof *x), *time = x + e->n;
    if (!x)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    memcpy(x, found + layout->node[0].x, (size_t)nx * sizeof *x);
    moray_solution_nodes(e->solution, e->p, time, NULL);
    struct resimulation resimulation = {e, NULL};
    const moray_ode ode = {e->n, resimulated_rhs, &resimulation};
    moray_status status = moray_ok();
    for (int k = 0; k < layout->mesh.intervals && !moray_failed(status); k++) {
        const int first = layout->interval[k].first, last = first + layout->interval[k].scheme->points - 1;
        resimulation.interval = &layout->interval[k];
        status = integrator->run(integrator, &ode, time[first], time[last], x, NULL, 0, NULL, NULL);
        compare(e, x, found + layout->node[last].x, 0, nx, &certificate->resimulation);
    }
    compare(e, x, found + layout->q, nx, e->n - nx, &certificate->resimulation);
    free(x);
    return status;
}

// ---- Hamiltonian ----

static bool is_autonomous(const moray_map *map)
{
    for (int k = 0; k < map->jac.nnz; k++)
        if (map->jac.col[k] == map->n_in - 1)
            return false;
    return true;
}

static moray_status spread_of_hamiltonian(const moray_solution *solution, int p, double *spread)
{
    double *values = calloc((size_t)solution->transcription->layout.phase[p].nodes, sizeof *values);
    if (!values)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    double least = INFINITY, most = -INFINITY;
    const int nodes = moray_solution_hamiltonian(solution, p, values);
    for (int n = 0; n < nodes; n++) {
        least = fmin(least, values[n]); // which pass over NaN
        most = fmax(most, values[n]);
    }
    *spread = fmax(*spread, (most - least) / (1 + fmax(fabs(least), fabs(most))));
    free(values);
    return moray_ok();
}

static moray_status examine_phase(const moray_solution *solution, int p, const moray_integrator *integrator,
                                  moray_certificate *certificate)
{
    struct examiner e;
    MORAY_TRY(moray_examiner_new(&e, solution, p));
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    for (int k = 0; k < layout->mesh.intervals; k++)
        certificate->mesh_error = fmax(certificate->mesh_error,
                                       moray_examiner_interval(&e, &layout->interval[k], &certificate->between_nodes));
    moray_status status = resimulate(&e, integrator, certificate);
    moray_examiner_free(&e);
    if (!moray_failed(status) && is_autonomous(solution->transcription->phase[p].map))
        status = spread_of_hamiltonian(solution, p, &certificate->hamiltonian);
    return status;
}

moray_status moray_certify(const moray_solution *solution, const moray_integrator *integrator,
                           moray_certificate *certificate)
{
    *certificate = (moray_certificate){.hamiltonian = NAN};
    moray_kkt kkt;
    MORAY_TRY(moray_kkt_error(&solution->transcription->nlp, &solution->iterate, &kkt));
    certificate->kkt = kkt.error;
    MORAY_TRY(moray_difference_solution(solution, &certificate->derivatives));
    for (int p = 0; p < solution->transcription->ocp->phases; p++)
        MORAY_TRY(examine_phase(solution, p, integrator, certificate));
    const moray_settings *settings = &solution->settings;
    certificate->pass = certificate->kkt <= 100 * settings->tolerance &&
                        certificate->derivatives <= MORAY_WORST_DERIVATIVES &&
                        certificate->mesh_error <= settings->mesh_tolerance &&
                        certificate->between_nodes <= violation_slack * settings->mesh_tolerance &&
                        certificate->resimulation <= 100 * settings->mesh_tolerance;
    return moray_ok();
}
