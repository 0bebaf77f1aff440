// SPDX-License-Identifier: MIT
//
// User functions, on complex numbers or on real ones, become maps on packed vectors.
#include <math.h>
#include <stdlib.h>

#include "base/numeric_map.h"
#include "ocp/probe.h"

struct wrapped_phase {
    const struct phase *phase;
    moray_continuous_fn *function;
    moray_continuous_real_fn *real;
    const void *data;
};

static void call_observe(void *self, const double complex *in, double complex *out)
{
    const struct wrapped_phase *wrapped = self;
    const struct phase *p = wrapped->phase;
    const moray_node node = {.x = in, .u = in + p->nx, .s = in + p->nx + p->nu, .t = in[p->nx + p->nu + p->ns]};
    p->observed.observe(&node, out, wrapped->data);
}

static void call_continuous(void *self, const double complex *in, double complex *out)
{
    const struct wrapped_phase *wrapped = self;
    const struct phase *p = wrapped->phase;
    const moray_node node = {.x = in, .u = in + p->nx, .s = in + p->nx + p->nu, .t = in[p->nx + p->nu + p->ns]};
    moray_rates rates = {.f = out, .c = out + p->nx, .g = out + p->nx + p->nc};
    wrapped->function(&node, &rates, wrapped->data);
}

static void call_continuous_real(void *self, const double *in, double *out)
{
    const struct wrapped_phase *wrapped = self;
    const struct phase *p = wrapped->phase;
    const moray_real_node node = {.x = in, .u = in + p->nx, .s = in + p->nx + p->nu, .t = in[p->nx + p->nu + p->ns]};
    moray_real_rates rates = {.f = out, .c = out + p->nx, .g = out + p->nx + p->nc};
    wrapped->real(&node, &rates, wrapped->data);
}

static void call_endpoint(void *self, const double complex *in, double complex *out)
{
    const moray_ocp *ocp = self;
    for (int p = 0; p < ocp->phases; p++) {
        const struct phase *phase = &ocp->phase[p];
        const int nx = phase->nx, u = 2 * nx + 2 + phase->nq;
        ocp->ends[p] =
            (moray_phase_ends){.x0 = in, .t0 = in[nx], .xf = in + nx + 1, .tf = in[2 * nx + 1], .q = in + 2 * nx + 2};
        if (phase->end_controls)
            ocp->ends[p].u0 = in + u, ocp->ends[p].uf = in + u + phase->nu;
        in += moray_end_inputs(phase);
    }
    const moray_ends ends = {.phase = ocp->ends, .s = in};
    moray_end_values verdict = {.e = out + 1};
    ocp->endpoint_fn(&ends, &verdict, ocp->data);
    out[0] = verdict.objective;
}

static void call_endpoint_real(void *self, const double *in, double *out)
{
    const moray_ocp *ocp = self;
    for (int p = 0; p < ocp->phases; p++) {
        const struct phase *phase = &ocp->phase[p];
        const int nx = phase->nx, u = 2 * nx + 2 + phase->nq;
        ocp->real_ends[p] = (moray_real_phase_ends){
            .x0 = in, .t0 = in[nx], .xf = in + nx + 1, .tf = in[2 * nx + 1], .q = in + 2 * nx + 2};
        if (phase->end_controls)
            ocp->real_ends[p].u0 = in + u, ocp->real_ends[p].uf = in + u + phase->nu;
        in += moray_end_inputs(phase);
    }
    const moray_real_ends ends = {.phase = ocp->real_ends, .s = in};
    moray_real_end_values verdict = {.e = out + 1};
    ocp->endpoint_real_fn(&ends, &verdict, ocp->data);
    out[0] = verdict.objective;
}

enum { trials = 8 }; // probe points tried before a function is said not to be finite anywhere

// Sizes and points of one function, in one block.
struct looking {
    double *size, *points;
    struct numeric_probe probe;
};

static moray_status looking_new(struct looking *l, int n_in)
{
    double *block = calloc((size_t)(1 + moray_probe_points) * n_in + 1, sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for its functions");
    *l = (struct looking){block, block + n_in, {block + n_in, block, moray_probe_points}};
    return moray_ok();
}

// Room for one more map. Error: MORAY_MEMORY.
static moray_status own_map_new(struct own_map **own)
{
    *own = calloc(1, sizeof **own);
    return *own ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for its functions");
}

static void own_maps_free(struct own_map *own)
{
    while (own) {
        struct own_map *older = own->older;
        moray_map_release(&own->map);
        free(own);
        own = older;
    }
}

static moray_status phase_map(const moray_ocp *ocp, struct phase *p, int trial, const struct looking *l)
{
    const int n_in = moray_phase_inputs(p), n_out = p->nx + p->nc + p->nq;
    moray_phase_points(ocp, p, trial, l->points);
    moray_phase_sizes(ocp, p, l->size);
    if (p->wrapped->real)
        return moray_real_map_new(&p->own->map, n_in, n_out, call_continuous_real, p->wrapped, NULL, &l->probe);
    return moray_complex_map_new(&p->own->map, n_in, n_out, call_continuous, p->wrapped, NULL, &l->probe);
}

static moray_status endpoint_map(moray_ocp *ocp, int trial, const struct looking *l)
{
    const int n_in = moray_endpoint_inputs(ocp), n_out = 1 + ocp->ne;
    moray_endpoint_points(ocp, trial, l->points);
    moray_endpoint_sizes(ocp, l->size);
    if (ocp->endpoint_real_fn)
        return moray_real_map_new(&ocp->endpoint->own->map, n_in, n_out, call_endpoint_real, ocp, NULL, &l->probe);
    return moray_complex_map_new(&ocp->endpoint->own->map, n_in, n_out, call_endpoint, ocp, NULL, &l->probe);
}

static moray_status observed_map(const moray_ocp *ocp, struct phase *p, int trial, const struct looking *l)
{
    moray_phase_points(ocp, p, trial, l->points);
    moray_phase_sizes(ocp, p, l->size);
    return moray_complex_map_new(&p->observed.own->map, moray_phase_inputs(p), p->observed.ny, call_observe, p->wrapped,
                                 NULL, &l->probe);
}

static moray_status wrap_observed(moray_ocp *ocp, struct phase *p)
{
    struct looking l = {0};
    moray_status status = looking_new(&l, moray_phase_inputs(p));
    if (!moray_failed(status))
        status = own_map_new(&p->observed.own);
    if (!moray_failed(status))
        status = observed_map(ocp, p, 0, &l);
    for (int trial = 1; trial < trials && status.code == MORAY_INPUT; trial++)
        status = observed_map(ocp, p, trial, &l);
    p->observed.map = p->observed.own ? &p->observed.own->map : NULL;
    free(l.size);
    if (moray_failed(status))
        return moray_error(status.code, "observations of phase %s: %s", p->name, status.text);
    return status;
}

static moray_status wrap_phase(moray_ocp *ocp, struct phase *p)
{
    struct looking l = {0};
    moray_status status = looking_new(&l, moray_phase_inputs(p));
    if (!moray_failed(status))
        status = own_map_new(&p->own);
    if (!moray_failed(status))
        status = phase_map(ocp, p, 0, &l);
    for (int trial = 1; trial < trials && status.code == MORAY_INPUT; trial++)
        status = phase_map(ocp, p, trial, &l);
    p->map = p->own ? &p->own->map : NULL;
    free(l.size);
    if (moray_failed(status))
        return moray_error(status.code, "phase %s: %s", p->name, status.text);
    return status;
}

static moray_status wrap_endpoint(moray_ocp *ocp)
{
    struct looking l = {0};
    moray_status status = looking_new(&l, moray_endpoint_inputs(ocp));
    if (!moray_failed(status))
        status = own_map_new(&ocp->endpoint->own);
    if (!moray_failed(status))
        status = endpoint_map(ocp, 0, &l);
    for (int trial = 1; trial < trials && status.code == MORAY_INPUT; trial++)
        status = endpoint_map(ocp, trial, &l);
    ocp->endpoint->map = ocp->endpoint->own ? &ocp->endpoint->own->map : NULL;
    free(l.size);
    if (moray_failed(status))
        return moray_error(status.code, "endpoint of %s: %s", ocp->name, status.text);
    return status;
}

moray_status moray_wrap_functions(moray_ocp *ocp, const moray_ocp_spec *spec)
{
    for (int i = 0; i < ocp->phases; i++) {
        struct phase *p = &ocp->phase[i];
        p->wrapped = calloc(1, sizeof *p->wrapped);
        if (!p->wrapped)
            return moray_error(MORAY_MEMORY, "no memory for the functions of phase %s", p->name);
        *p->wrapped = (struct wrapped_phase){p, spec->phase[i].continuous, spec->phase[i].continuous_real, ocp->data};
        if (!p->map)
            MORAY_TRY(wrap_phase(ocp, p));
        if (p->observed.observe)
            MORAY_TRY(wrap_observed(ocp, p));
    }
    return ocp->endpoint->map ? moray_ok() : wrap_endpoint(ocp);
}

bool moray_phase_is_differenced(const struct phase *p)
{
    return p->wrapped && p->wrapped->real;
}

void moray_unwrap_functions(moray_ocp *ocp)
{
    for (int i = 0; ocp->phase && i < ocp->phases; i++) {
        own_maps_free(ocp->phase[i].own);
        own_maps_free(ocp->phase[i].observed.own);
        free(ocp->phase[i].wrapped);
    }
    own_maps_free(ocp->endpoint ? ocp->endpoint->own : NULL);
}
