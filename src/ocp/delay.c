// SPDX-License-Identifier: MIT
#include "moray/delay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct moray_delay {
    moray_delay_spec spec;
    moray_ocp *ocp;
    moray_num *past; // scratch [nx + nu], then as much for what of the past was not asked for
    moray_bounds *bounds;
};

// ---- The functions of all steps ------------------------------------------------------------------------------------

// Values of `width` numbers a step, of `delay` steps before step k, which are of the past where there are none.
static const moray_num *before(const moray_num *values, int width, int k, int delay, const moray_num *past)
{
    return k >= delay ? values + (k - delay) * width : past;
}

static void all_steps(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_delay *d = data;
    const moray_delay_spec *spec = &d->spec;
    const int nx = spec->nx, nu = spec->nu;
    moray_num *past_x = d->past, *past_u = past_x + nx, *unasked = past_u + nu;
    out->g[0] = 0;
    for (int k = 0; k < spec->steps; k++) {
        const moray_num t = at->t + k * spec->step;
        if (k < spec->x_delay)
            spec->past(t - spec->x_delay * spec->step, past_x, unasked, spec->data);
        if (k < spec->u_delay)
            spec->past(t - spec->u_delay * spec->step, unasked, past_u, spec->data);
        const moray_delay_node node = {.x = at->x + k * nx,
                                       .u = at->u + k * nu,
                                       .past_x = before(at->x, nx, k, spec->x_delay, past_x),
                                       .past_u = before(at->u, nu, k, spec->u_delay, past_u),
                                       .t = t};
        moray_num g = 0;
        moray_rates rates = {.f = out->f + k * nx, .c = out->c + k * spec->nc, .g = &g};
        spec->continuous(&node, &rates, spec->data);
        out->g[0] += g;
    }
}

static void join_steps(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_delay *d = data;
    const int nx = d->spec.nx, joins = nx * (d->spec.steps - 1);
    const moray_phase_ends *ends = &at->phase[0];
    out->objective = ends->q[0];
    if (d->spec.final)
        out->objective += d->spec.final(ends->xf + joins, d->spec.data);
    for (int i = 0; i < joins; i++)
        out->e[i] = ends->x0[nx + i] - ends->xf[i];
}

// ---- The problem ---------------------------------------------------------------------------------------------------

static moray_status check_list(const char *what, moray_bounds_list list, int n, bool required)
{
    if (list.n != n && (list.n != 0 || required))
        return moray_error(MORAY_INPUT, "%s: %d bounds given, %d needed", what, list.n, n);
    return moray_ok();
}

static moray_status check(const moray_delay_spec *spec)
{
    if (spec->nx < 1 || spec->nu < 0 || spec->nc < 0)
        return moray_error(MORAY_INPUT, "nx %d, nu %d, nc %d: nx must be positive, none negative", spec->nx, spec->nu,
                           spec->nc);
    if (!(spec->step > 0 && isfinite(spec->step)) || spec->steps < 1)
        return moray_error(MORAY_INPUT, "%d steps of %g: must be at least 1, of positive length", spec->steps,
                           spec->step);
    if (spec->x_delay < 0 || spec->x_delay > spec->steps || spec->u_delay < 0 || spec->u_delay > spec->steps)
        return moray_error(MORAY_INPUT, "delays of %d and %d steps: must be 0 to %d", spec->x_delay, spec->u_delay,
                           spec->steps);
    if (!spec->continuous || (!spec->past && (spec->x_delay > 0 || spec->u_delay > 0)))
        return moray_error(MORAY_INPUT, "needs a continuous function, and with a delay the past");
    MORAY_TRY(check_list("x", spec->x, spec->nx, false));
    MORAY_TRY(check_list("x0", spec->x0, spec->nx, false));
    MORAY_TRY(check_list("xf", spec->xf, spec->nx, false));
    MORAY_TRY(check_list("u", spec->u, spec->nu, false));
    return check_list("c", spec->c, spec->nc, true);
}

// Bounds of step `from` to step `to`, free elsewhere; moves *next on.
static moray_bounds_list spread(const moray_delay_spec *spec, moray_bounds_list list, int width, int from, int to,
                                moray_bounds **next)
{
    const moray_bounds_list all = {*next, width * spec->steps};
    for (int k = 0; k < spec->steps; k++)
        for (int i = 0; i < width; i++)
            *(*next)++ = list.n > 0 && k >= from && k <= to ? list.at[i] : moray_free();
    return all;
}

static moray_status build(moray_delay *d)
{
    const moray_delay_spec *spec = &d->spec;
    const int n = spec->steps, last = n - 1, joins = spec->nx * last;
    const size_t width = (size_t)(4 * spec->nx + spec->nu + spec->nc);
    d->bounds = calloc(width * (size_t)n, sizeof *d->bounds);
    d->past = calloc(2 * (size_t)(spec->nx + spec->nu), sizeof *d->past);
    if (!d->bounds || !d->past)
        return moray_error(MORAY_MEMORY, "no memory for %d steps", n);
    moray_bounds *next = d->bounds;
    const moray_phase_spec phase = {.nx = n * spec->nx,
                                    .nu = n * spec->nu,
                                    .nc = n * spec->nc,
                                    .nq = 1,
                                    .continuous = all_steps,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(spec->step),
                                    .x = spread(spec, spec->x, spec->nx, 0, last, &next),
                                    .x0 = spread(spec, spec->x0, spec->nx, 0, 0, &next),
                                    .xf = spread(spec, spec->xf, spec->nx, last, last, &next),
                                    .u = spread(spec, spec->u, spec->nu, 0, last, &next),
                                    .c = spread(spec, spec->c, spec->nc, 0, last, &next)};
    return moray_ocp_new(&d->ocp, &(moray_ocp_spec){.name = spec->name,
                                                    .phases = 1,
                                                    .phase = &phase,
                                                    .ne = joins,
                                                    .e = {next, joins}, // zeroed, which fixes them to 0
                                                    .endpoint = join_steps,
                                                    .data = d});
}

moray_status moray_delay_new(moray_delay **result, const moray_delay_spec *spec)
{
    *result = NULL;
    MORAY_TRY(check(spec));
    moray_delay *d = calloc(1, sizeof *d);
    if (!d)
        return moray_error(MORAY_MEMORY, "no memory for a problem with delays");
    d->spec = *spec;
    const moray_status status = build(d);
    if (moray_failed(status))
        moray_delay_free(d);
    else
        *result = d;
    return status;
}

void moray_delay_free(moray_delay *delay)
{
    if (!delay)
        return;
    moray_ocp_free(delay->ocp);
    free(delay->past);
    free(delay->bounds);
    free(delay);
}

const moray_ocp *moray_delay_ocp(const moray_delay *delay)
{
    return delay->ocp;
}

moray_status moray_delay_at(const moray_delay *delay, const moray_solution *solution, double t, double *x, double *u)
{
    const moray_delay_spec *spec = &delay->spec;
    const int nx = spec->nx, nu = spec->nu, n = spec->steps;
    const int k = (int)fmin(fmax(ceil(t / spec->step) - 1, 0), n - 1);
    double *all = calloc((size_t)n * (size_t)(nx + nu), sizeof *all);
    if (!all)
        return moray_error(MORAY_MEMORY, "no memory for %d steps", n);
    double *controls = all + n * nx;
    moray_solution_at(solution, 0, t - k * spec->step, all, controls);
    if (x)
        memcpy(x, all + k * nx, (size_t)nx * sizeof *x);
    if (u)
        memcpy(u, controls + k * nu, (size_t)nu * sizeof *u);
    free(all);
    return moray_ok();
}
