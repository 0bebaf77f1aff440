// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "moray/control/periodic_orbit.h"

typedef struct closing {
    int nx, n;
    moray_closing_condition condition[];
} closing;

static void value(void *self, const double *in, double *out)
{
    const closing *c = self;
    for (int k = 0; k < c->n; k++) {
        const moray_closing_condition *condition = &c->condition[k];
        const double start = in[condition->state], end = in[c->nx + condition->state];
        out[k] = (condition->kind == MORAY_CLOSE_RETURNS ? end - start : start) - condition->value;
    }
}

static void jacobian(void *self, const double *in, double *values)
{
    const closing *c = self;
    (void)in;
    for (int k = 0; k < c->n; k++) {
        const bool returns = c->condition[k].kind == MORAY_CLOSE_RETURNS;
        *values++ = returns ? -1 : 1;
        if (returns)
            *values++ = 1;
    }
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)self, (void)in, (void)weight, (void)values; // linear
}

static void release(moray_map *map)
{
    moray_pattern_free(&map->jac);
    free(map->self);
}

static int count(const moray_closing_condition *condition, int n)
{
    int nnz = n;
    for (int k = 0; k < n; k++)
        nnz += condition[k].kind == MORAY_CLOSE_RETURNS;
    return nnz;
}

// Row by row, the start before the end.
static void fill_pattern(moray_pattern *pattern, const closing *c)
{
    int at = 0;
    for (int k = 0; k < c->n; k++)
        for (int end = 0; end <= (c->condition[k].kind == MORAY_CLOSE_RETURNS); end++) {
            pattern->row[at] = k;
            pattern->col[at++] = end * c->nx + c->condition[k].state;
        }
}

moray_status moray_closing_map(moray_map *map, int nx, int ns, const moray_closing_condition *condition, int n)
{
    *map = (moray_map){0};
    if (nx < 1 || ns < 0 || n < 1)
        return moray_error(MORAY_INPUT,
                           "%d closing conditions of %d states and %d parameters: must be at least 1, 1, 0", n, nx, ns);
    for (int k = 0; k < n; k++)
        if (condition[k].state < 0 || condition[k].state >= nx)
            return moray_error(MORAY_INPUT, "closing condition %d is of state %d: must be 0 to %d", k,
                               condition[k].state, nx - 1);
    closing *c = malloc(sizeof *c + (size_t)n * sizeof *condition);
    if (!c)
        return moray_error(MORAY_MEMORY, "no memory for %d closing conditions", n);
    c->nx = nx;
    c->n = n;
    memcpy(c->condition, condition, (size_t)n * sizeof *condition);
    *map = (moray_map){.n_in = 2 * nx + ns + 1,
                       .n_out = n,
                       .self = c,
                       .value = value,
                       .jacobian = jacobian,
                       .hessian = hessian,
                       .release = release};
    const moray_status status = moray_pattern_new(&map->jac, count(condition, n));
    if (moray_failed(status))
        moray_map_release(map);
    else
        fill_pattern(&map->jac, c);
    return status;
}
