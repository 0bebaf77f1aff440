// SPDX-License-Identifier: MIT
//
// User functions on complex numbers become maps on packed vectors.
#include "ocp/problem.h"

#include <math.h>
#include <stdlib.h>

struct wrapped_phase {
    const struct phase *phase;
    moray_continuous_fn *function;
    const void *data;
};

static void call_continuous(void *self, const double complex *in, double complex *out)
{
    const struct wrapped_phase *wrapped = self;
    const struct phase *p = wrapped->phase;
    const moray_node node = {.x = in, .u = in + p->nx, .s = in + p->nx + p->nu, .t = in[p->nx + p->nu + p->ns]};
    moray_rates rates = {.f = out, .c = out + p->nx, .g = out + p->nx + p->nc};
    wrapped->function(&node, &rates, wrapped->data);
}

static void call_endpoint(void *self, const double complex *in, double complex *out)
{
    const moray_ocp *ocp = self;
    for (int p = 0; p < ocp->phases; p++) {
        const int nx = ocp->phase[p].nx;
        ocp->ends[p] =
            (moray_phase_ends){.x0 = in, .t0 = in[nx], .xf = in + nx + 1, .tf = in[2 * nx + 1], .q = in + 2 * nx + 2};
        in += 2 * nx + 2 + ocp->phase[p].nq;
    }
    const moray_ends ends = {.phase = ocp->ends, .s = in};
    moray_verdict verdict = {.e = out + 1};
    ocp->endpoint_fn(&ends, &verdict, ocp->data);
    out[0] = verdict.objective;
}

// A point of a vector with these bounds to look at patterns from: off the middle, so that nothing vanishes by symmetry;
// a further trial moves it.
static double probe_value(moray_bounds bounds, int i, int trial)
{
    const double shift = 0.2 * (fmod(0.618033988749895 * (i + 1) + 0.37 * trial, 1) - 0.5);
    const bool boxed = bounds.lower > -MORAY_INFINITY && bounds.upper < MORAY_INFINITY;
    const double width = boxed ? bounds.upper - bounds.lower : 1 + fabs(bounds_middle(bounds));
    const double value = bounds_middle(bounds) + width * (shift + (boxed ? 0 : 0.3));
    return fmin(fmax(value, bounds.lower), bounds.upper);
}

static void probe_list(const moray_bounds *bounds, int n, int trial, double **out)
{
    for (int i = 0; i < n; i++)
        *(*out)++ = probe_value(bounds[i], i, trial);
}

// The middle between the ends says most about where a state lives.
static void probe_states(const struct phase *p, int trial, double **out)
{
    for (int i = 0; i < p->nx; i++) {
        const double x0 = probe_value(p->x0[i], i, trial), xf = probe_value(p->xf[i], i + 7, trial);
        *(*out)++ = 0.55 * x0 + 0.45 * xf;
    }
}

static void phase_probe(const moray_ocp *ocp, const struct phase *p, int trial, double *out)
{
    probe_states(p, trial, &out);
    probe_list(p->u, p->nu, trial, &out);
    probe_list(ocp->s, ocp->ns, trial, &out);
    *out = 0.6 * probe_value(p->t0, 0, trial) + 0.4 * probe_value(p->tf, 1, trial);
}

static void endpoint_probe(const moray_ocp *ocp, int trial, double *out)
{
    for (int i = 0; i < ocp->phases; i++) {
        const struct phase *p = &ocp->phase[i];
        probe_list(p->x0, p->nx, trial, &out);
        probe_list(&p->t0, 1, trial, &out);
        probe_list(p->xf, p->nx, trial, &out);
        probe_list(&p->tf, 1, trial + 1, &out);
        probe_list(p->q, p->nq, trial, &out);
    }
    probe_list(ocp->s, ocp->ns, trial, &out);
}

enum { trials = 8 }; // probe points tried before a function is said not to be finite anywhere

static moray_status wrap_phase(moray_ocp *ocp, struct phase *p, moray_continuous_fn *function)
{
    const int n_in = p->nx + p->nu + p->ns + 1, n_out = p->nx + p->nc + p->nq;
    double *probe = calloc((size_t)n_in, sizeof *probe);
    p->wrapped = calloc(1, sizeof *p->wrapped);
    moray_status status = moray_error(MORAY_MEMORY, "no memory for phase %s", p->name);
    if (p->wrapped && probe) {
        *p->wrapped = (struct wrapped_phase){p, function, ocp->data};
        for (int trial = 0; trial < trials && moray_failed(status); trial++) {
            phase_probe(ocp, p, trial, probe);
            status = moray_map_from_complex(&p->own_map, n_in, n_out, call_continuous, p->wrapped, NULL, probe);
        }
    }
    p->map = &p->own_map;
    free(probe);
    if (moray_failed(status))
        return moray_error(status.code, "phase %s: %s", p->name, status.text);
    return status;
}

static moray_status wrap_endpoint(moray_ocp *ocp)
{
    int n_in = ocp->ns;
    for (int i = 0; i < ocp->phases; i++)
        n_in += 2 * ocp->phase[i].nx + 2 + ocp->phase[i].nq;
    double *probe = calloc((size_t)n_in, sizeof *probe);
    moray_status status = moray_error(MORAY_MEMORY, "no memory for the endpoint of %s", ocp->name);
    for (int trial = 0; probe && trial < trials && moray_failed(status); trial++) {
        endpoint_probe(ocp, trial, probe);
        status = moray_map_from_complex(&ocp->own_endpoint, n_in, 1 + ocp->ne, call_endpoint, ocp, NULL, probe);
    }
    ocp->endpoint = &ocp->own_endpoint;
    free(probe);
    if (moray_failed(status))
        return moray_error(status.code, "endpoint of %s: %s", ocp->name, status.text);
    return status;
}

moray_status wrap_functions(moray_ocp *ocp, const moray_ocp_spec *spec)
{
    for (int i = 0; i < ocp->phases; i++)
        if (spec->phase[i].continuous)
            MORAY_TRY(wrap_phase(ocp, &ocp->phase[i], spec->phase[i].continuous));
    return ocp->endpoint ? moray_ok() : wrap_endpoint(ocp);
}

void unwrap_functions(moray_ocp *ocp)
{
    for (int i = 0; ocp->phase && i < ocp->phases; i++) {
        moray_map_release(&ocp->phase[i].own_map);
        free(ocp->phase[i].wrapped);
    }
    moray_map_release(&ocp->own_endpoint);
}
