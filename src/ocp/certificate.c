// SPDX-License-Identifier: MIT
//
// What a solution is worth, measured apart from the solver that found it.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/solution.h"

enum { samples_between = 5 }; // per stage polynomial degree, placed between the nodes

struct examiner {
    const moray_solution *solution;
    int p;
    double *in, *out, *slope, *x_size; // x_size[nx]: 1 + max |x| over the phase
};

static moray_status examiner_new(struct examiner *e, const moray_solution *solution, int p)
{
    const struct phase *phase = &solution->transcription->ocp->phase[p];
    double *block = calloc((size_t)(phase->map->n_in + phase->map->n_out + 2 * phase->nx), sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    *e = (struct examiner){solution, p, block, block + phase->map->n_in, block + phase->map->n_in + phase->map->n_out,
                           NULL};
    e->x_size = e->slope + phase->nx;
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    for (int r = 0; r < phase->nx; r++) {
        for (int n = 0; n < layout->nodes; n++)
            e->x_size[r] = fmax(e->x_size[r], fabs(solution->iterate.x[layout->node[n].x + r]));
        e->x_size[r] += 1;
    }
    return moray_ok();
}

// Functions of the phase at time t with the interpolated control; state from the interpolant unless given.
static void evaluate_at(struct examiner *e, double t, const double *x)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[e->p];
    moray_solution_at(e->solution, e->p, t, e->in, e->in + phase->nx);
    if (x)
        memcpy(e->in, x, (size_t)phase->nx * sizeof *x);
    memcpy(e->in + phase->nx + phase->nu, moray_solution_parameters(e->solution), (size_t)phase->ns * sizeof *e->in);
    e->in[phase->map->n_in - 1] = t;
    phase->map->value(phase->map->self, e->in, e->out);
}

// x~' at tau of the interval: the stage polynomials through f at the nodes.
static void interpolant_slope(struct examiner *e, const struct interval *interval, double tau)
{
    const struct transcription *t = e->solution->transcription;
    const struct phase *phase = &t->ocp->phase[e->p];
    double ell[MORAY_MAX_STAGES + 2], integral[MORAY_MAX_STAGES + 2];
    moray_scheme_basis(interval->scheme, tau, ell, integral);
    memset(e->slope, 0, (size_t)phase->nx * sizeof *e->slope);
    for (int j = interval->scheme->first; j <= interval->scheme->last; j++)
        for (int r = 0; r < phase->nx; r++)
            e->slope[r] += ell[j] * t->phase[e->p].out[(interval->first + j) * phase->map->n_out + r];
}

static double outside(double value, moray_bounds bounds)
{
    if (isnan(value))
        return INFINITY;
    if (value < bounds.lower)
        return (bounds.lower - value) / (1 + fabs(bounds.lower));
    return value > bounds.upper ? (value - bounds.upper) / (1 + fabs(bounds.upper)) : 0;
}

static double worst_outside(const struct examiner *e)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[e->p];
    double worst = 0;
    for (int r = 0; r < phase->nx; r++)
        worst = fmax(worst, outside(e->in[r], phase->x[r]));
    for (int r = 0; r < phase->nu; r++)
        worst = fmax(worst, outside(e->in[phase->nx + r], phase->u[r]));
    for (int r = 0; r < phase->nc; r++)
        worst = fmax(worst, outside(e->out[phase->nx + r], phase->c[r]));
    return worst;
}

// Integral over one interval of |x~' - f(x~, u~)| relative to the state's size, by the midpoint rule between the nodes.
static void examine_interval(struct examiner *e, const struct interval *interval, moray_certificate *certificate)
{
    const struct transcription *t = e->solution->transcription;
    const struct phase *phase = &t->ocp->phase[e->p];
    const struct phase_cache *cache = &t->phase[e->p];
    const double T = cache->tf - cache->t0, start = t->layout.phase[e->p].node[interval->first].tau;
    const int count = samples_between * interval->scheme->points;
    double *error = calloc((size_t)phase->nx, sizeof *error);
    for (int k = 0; k < count && error; k++) {
        const double tau = (k + 0.5) / count;
        evaluate_at(e, cache->t0 + T * (start + tau * interval->width), NULL);
        interpolant_slope(e, interval, tau);
        certificate->between_nodes = fmax(certificate->between_nodes, worst_outside(e));
        for (int r = 0; r < phase->nx; r++) {
            error[r] += T * interval->width / count * fabs(e->slope[r] - e->out[r]) / e->x_size[r];
            certificate->mesh_error = fmax(certificate->mesh_error, isnan(error[r]) ? INFINITY : error[r]);
        }
    }
    free(error);
}

// ---- Re-simulation ----

static bool resimulated_rhs(double t, const double *x, double *dx, void *self)
{
    struct examiner *e = self;
    const int nx = e->solution->transcription->ocp->phase[e->p].nx;
    evaluate_at(e, t, x);
    memcpy(dx, e->out, (size_t)nx * sizeof *dx);
    for (int r = 0; r < nx; r++)
        if (!isfinite(dx[r]))
            return false;
    return true;
}

struct comparison {
    const struct examiner *e;
    int node;
    double worst;
};

static bool compare_node(double t, const double *x, void *self)
{
    (void)t;
    struct comparison *c = self;
    const struct transcription *tr = c->e->solution->transcription;
    const double *found = c->e->solution->iterate.x + tr->layout.phase[c->e->p].node[c->node++].x;
    for (int r = 0; r < tr->ocp->phase[c->e->p].nx; r++) {
        const double difference = fabs(x[r] - found[r]) / c->e->x_size[r];
        c->worst = isnan(difference) ? INFINITY : fmax(c->worst, difference);
    }
    return true;
}

// Integrates interval by interval, since the control may jump between them.
static moray_status resimulate(struct examiner *e, const moray_integrator *integrator, moray_certificate *certificate)
{
    const struct transcription *t = e->solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[e->p];
    const int nx = t->ocp->phase[e->p].nx;
    double *x = calloc((size_t)(nx + layout->nodes), sizeof *x), *time = x + nx;
    if (!x)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    memcpy(x, e->solution->iterate.x + layout->node[0].x, (size_t)nx * sizeof *x);
    moray_solution_nodes(e->solution, e->p, time, NULL);
    const moray_ode ode = {nx, resimulated_rhs, e};
    struct comparison comparison = {e, 0, 0};
    moray_status status = moray_ok();
    for (int k = 0; k < layout->mesh.intervals && !moray_failed(status); k++) {
        const int first = layout->interval[k].first, last = first + layout->interval[k].scheme->points - 1;
        status = integrator->run(integrator, &ode, time[first], time[last], x, NULL, 0, NULL, NULL);
        comparison.node = last;
        compare_node(time[last], x, &comparison);
    }
    certificate->resimulation = fmax(certificate->resimulation, comparison.worst);
    free(x);
    return status;
}

static moray_status examine_phase(const moray_solution *solution, int p, const moray_integrator *integrator,
                                  moray_certificate *certificate)
{
    struct examiner e;
    MORAY_TRY(examiner_new(&e, solution, p));
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    for (int k = 0; k < layout->mesh.intervals; k++)
        examine_interval(&e, &layout->interval[k], certificate);
    moray_status status = resimulate(&e, integrator, certificate);
    free(e.in);
    return status;
}

moray_status moray_certify(const moray_solution *solution, const moray_integrator *integrator,
                           moray_certificate *certificate)
{
    *certificate = (moray_certificate){0};
    moray_kkt kkt;
    MORAY_TRY(moray_kkt_error(&solution->transcription->nlp, &solution->iterate, &kkt));
    certificate->kkt = kkt.error;
    for (int p = 0; p < solution->transcription->ocp->phases; p++)
        MORAY_TRY(examine_phase(solution, p, integrator, certificate));
    const moray_settings *settings = &solution->settings;
    certificate->pass = certificate->kkt <= 100 * settings->tolerance &&
                        certificate->mesh_error <= settings->mesh_tolerance &&
                        certificate->between_nodes <= 100 * settings->mesh_tolerance &&
                        certificate->resimulation <= 100 * settings->mesh_tolerance;
    return moray_ok();
}
