// SPDX-License-Identifier: MIT
#include "ocp/refinement/examine.h"

#include <math.h>
#include <string.h>

static const double same_tau = 1e-12;

const moray_nlp_info *moray_solution_info(const moray_solution *solution)
{
    return &solution->info;
}

double moray_solution_objective(const moray_solution *solution)
{
    return solution->iterate.objective;
}

const double *moray_solution_parameters(const moray_solution *solution)
{
    return solution->iterate.x + solution->transcription->layout.s;
}

const double *moray_solution_event_multipliers(const moray_solution *solution)
{
    return solution->iterate.lambda + solution->transcription->layout.events;
}

const double *moray_solution_integrals(const moray_solution *solution, int phase)
{
    return solution->iterate.x + solution->transcription->layout.phase[phase].q;
}

void moray_solution_times(const moray_solution *solution, int phase, double *t0, double *tf)
{
    *t0 = solution->transcription->phase[phase].t0; // a fixed one of the problem may have moved on since
    *tf = solution->transcription->phase[phase].tf;
}

moray_nlp_size moray_solution_size(const moray_solution *solution)
{
    const moray_nlp *nlp = &solution->transcription->nlp;
    return (moray_nlp_size){nlp->n, nlp->m, nlp->nnz_jac, nlp->nnz_hess};
}

const moray_mesh_record *moray_solution_history(const moray_solution *solution, int *meshes)
{
    *meshes = solution->meshes;
    return solution->history;
}

int moray_solution_intervals(const moray_solution *solution, int phase, double *edge)
{
    const struct mesh *mesh = &solution->transcription->layout.phase[phase].mesh;
    double t0, tf;
    moray_solution_times(solution, phase, &t0, &tf);
    for (int k = 0; edge && k <= mesh->intervals; k++)
        edge[k] = t0 + (tf - t0) * mesh->edge[k];
    return mesh->intervals;
}

moray_status moray_solution_interval_errors(const moray_solution *solution, int phase, double *error)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[phase];
    struct witness w;
    struct examiner e;
    MORAY_TRY(moray_witness_of_sizes(&w, solution));
    const moray_status status = moray_examiner_new(&e, &w, phase);
    if (!moray_failed(status)) {
        for (int k = 0; k < layout->mesh.intervals; k++)
            error[k] = moray_examiner_error(&e, &layout->interval[k]);
        moray_examiner_free(&e);
    }
    moray_witness_free(&w);
    return status;
}

const char *moray_solution_diagnosis(const moray_solution *solution)
{
    return solution->diagnosis;
}

// Of the lines of a diagnosis those without which nobody knows what happened and what to do.
static bool is_needed(const char *line, bool first)
{
    return first || strncmp(line, "Largest violation", 17) == 0 || strncmp(line, "Try:", 4) == 0;
}

moray_status moray_solution_failure(const moray_solution *solution)
{
    const char *line = solution->diagnosis;
    char needed[sizeof solution->diagnosis] = "";
    size_t used = 0;
    for (bool first = true; *line; first = false) {
        const size_t length = strcspn(line, "\n") + (line[strcspn(line, "\n")] == '\n');
        if (is_needed(line, first)) {
            memcpy(needed + used, line, length);
            used += length;
        }
        line += length;
    }
    moray_status failure = moray_error(MORAY_NOT_SOLVED, "%s", solution->diagnosis);
    if (strlen(solution->diagnosis) >= sizeof failure.text)
        failure = moray_error(MORAY_NOT_SOLVED, "%s", needed);
    size_t n = strlen(failure.text);
    while (n > 0 && failure.text[n - 1] == ' ')
        failure.text[--n] = 0;
    return failure;
}

// The interval that ends at tau where two meet there: nodes at its end are its own (Radau).
static const struct interval *interval_at(const struct phase_layout *layout, double tau)
{
    int low = 0, high = layout->mesh.intervals - 1;
    while (low < high) {
        const int middle = (low + high + 1) / 2;
        if (layout->mesh.edge[middle] < tau - same_tau)
            low = middle;
        else
            high = middle - 1;
    }
    return &layout->interval[low];
}

// State: x at the start plus the integral of the interpolated slopes, which is the collocation polynomial for every
// scheme; control: the polynomial through its values at the stage points.
void moray_solution_by_basis(const moray_solution *solution, int p, const struct interval *interval, const double *ell,
                             const double *integral, double *x, double *u)
{
    const struct transcription *t = solution->transcription;
    const struct phase_cache *cache = &t->phase[p];
    const int nx = t->ocp->phase[p].nx, nu = t->ocp->phase[p].nu, n_out = t->phase[p].map->n_out;
    const struct node *node = t->layout.phase[p].node + interval->first;
    if (x)
        memcpy(x, solution->iterate.x + node->x, (size_t)nx * sizeof *x);
    if (u)
        memset(u, 0, (size_t)nu * sizeof *u);
    for (int j = interval->scheme->first; j <= interval->scheme->last; j++) {
        const double *f = cache->out + (interval->first + j) * n_out;
        for (int r = 0; x && r < nx; r++)
            x[r] += (cache->tf - cache->t0) * interval->width * integral[j] * f[r];
        for (int r = 0; u && r < nu; r++)
            u[r] += ell[j] * solution->iterate.x[node[j].x + nx + r];
    }
    for (int r = 0; u && r < nu; r++)
        u[r] = fmin(fmax(u[r], t->ocp->phase[p].u[r].lower), t->ocp->phase[p].u[r].upper);
}

void moray_solution_at_tau(const moray_solution *solution, int p, const struct interval *interval, double tau,
                           double *x, double *u)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    double ell[MORAY_MAX_STAGES + 2], integral[MORAY_MAX_STAGES + 2];
    if (!interval)
        interval = interval_at(layout, tau);
    moray_scheme_basis(interval->scheme, (tau - layout->node[interval->first].tau) / interval->width, ell, integral);
    moray_solution_by_basis(solution, p, interval, ell, integral, x, u);
}

void moray_solution_at(const moray_solution *solution, int p, double time, double *x, double *u)
{
    const struct phase_cache *cache = &solution->transcription->phase[p];
    const double T = cache->tf - cache->t0, tau = T > 0 ? fmin(fmax((time - cache->t0) / T, 0), 1) : 0;
    moray_solution_at_tau(solution, p, NULL, tau, x, u);
}
