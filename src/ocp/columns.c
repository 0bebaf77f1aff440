// SPDX-License-Identifier: MIT
//
// Columns of a Jacobian by differences with shrinking steps and Richardson's extrapolation. Every entry is the
// extrapolate that agrees best with its neighbours, rounding counted.
#include "ocp/columns.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { levels = 8 };
static const double first_step = 0.02; // of the size
static const double enough = 1e-10;    // doubt, relative, at which no smaller step is tried
enum side { behind_only = -1, both, ahead_only };

struct columns {
    const moray_map *map;
    double *in, *here, *ahead, *behind;
    double *table; // [n_out][levels]: the last row of each extrapolation
};

// Quotients of one step, and what rounding makes of them.
static double quotient(const struct columns *c, enum side side, int i, double step, double *rounding)
{
    const double high = side == behind_only ? c->here[i] : c->ahead[i];
    const double low = side == ahead_only ? c->here[i] : c->behind[i], width = side == both ? 2 * step : step;
    *rounding = 2 * DBL_EPSILON * (fabs(high) + fabs(low)) / width;
    return (high - low) / width;
}

// Adds the quotient of a level to the extrapolation of an output. Errors go with the square of the step, or with the
// step.
static void extrapolate(const struct columns *c, enum side side, int i, int level, double step, double *jac,
                        double *doubt)
{
    double rounding, *row = c->table + i * levels, above = row[0], power = 1;
    row[0] = quotient(c, side, i, step, &rounding);
    if (level == 0)
        return;
    for (int k = 1; k <= level; k++) {
        power *= side == both ? 16 : 4;
        const double old = above;
        above = k < level ? row[k] : 0;
        row[k] = row[k - 1] + (row[k - 1] - old) / (power - 1);
        const double spread = fmax(fabs(row[k] - row[k - 1]), fabs(row[k] - old)) + rounding;
        if (spread < *doubt) {
            *doubt = spread;
            *jac = row[k];
        }
    }
}

static bool finished(const struct columns *c, double size, const double *jac, const double *doubt)
{
    for (int i = 0; i < c->map->n_out; i++)
        if (!(doubt[i] <= enough * (fabs(jac[i]) + fabs(c->here[i]) / size)))
            return false;
    return true;
}

static void difference(struct columns *c, int j, enum side side, double size, double *jac, double *doubt)
{
    const double at = c->in[j];
    for (int i = 0; i < c->map->n_out; i++) {
        jac[i] = NAN;
        doubt[i] = INFINITY;
    }
    for (int level = 0; level < levels; level++) {
        const double step = ldexp(first_step * size, -2 * level);
        if (at + step == at)
            break;
        c->in[j] = at + step;
        if (side != behind_only)
            c->map->value(c->map->self, c->in, c->ahead);
        c->in[j] = at - step;
        if (side != ahead_only)
            c->map->value(c->map->self, c->in, c->behind);
        for (int i = 0; i < c->map->n_out; i++)
            extrapolate(c, side, i, level, step, &jac[i], &doubt[i]);
        if (finished(c, size, jac, doubt))
            break;
    }
    c->in[j] = at;
}

static bool all_known(const double *doubt, int n)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(doubt[i]))
            return false;
    return true;
}

moray_status moray_difference_columns(const moray_map *map, const double *in, const double *size, double *jac,
                                      double *doubt)
{
    const size_t n_in = (size_t)map->n_in, n_out = (size_t)map->n_out;
    double *block = calloc(n_in + (3 + levels) * n_out + 1, sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory to difference %d functions", map->n_out);
    struct columns c = {map, block, block + n_in, block + n_in + n_out, block + n_in + 2 * n_out, NULL};
    c.table = c.behind + n_out;
    memcpy(c.in, in, n_in * sizeof *in);
    map->value(map->self, in, c.here);
    for (size_t j = 0; j < n_in; j++) {
        static const enum side order[] = {both, ahead_only, behind_only};
        for (int k = 0; k < 3; k++) {
            difference(&c, (int)j, order[k], size[j], jac + j * n_out, doubt + j * n_out);
            if (all_known(doubt + j * n_out, map->n_out))
                break;
        }
    }
    free(block);
    return moray_ok();
}
