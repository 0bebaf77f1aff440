// SPDX-License-Identifier: MIT
//
// Columns of a Jacobian by differences with shrinking steps and Richardson's extrapolation. Every entry is the
// extrapolate that agrees best with its neighbours, rounding counted. Central quotients across a kink that is nearer
// than the smallest step agree on the mean of its slopes: both sides are differenced where quotients ahead and behind
// keep apart.
#include "ocp/certificate/columns.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { levels = 8 };
static const double first_step = 0.02; // of the size
static const double enough = 1e-10;    // doubt, relative, at which no smaller step is tried
static const double narrow = 1e-2;     // of a step: a side with less room is none
static const double stays = 0.5;       // of a bend after a step four times as large: a smooth one falls to a quarter
static const double certain = 4;       // doubts by which the slopes on either side of a kink differ
enum side { behind_only = -1, both, ahead_only };

struct columns {
    const moray_map *map;
    const moray_bounds *box; // NULL: none
    double *in, *here, *ahead, *behind;
    double *bend;  // [n_out]: quotient ahead less that behind
    double *table; // [n_out][levels]: the last row of each extrapolation
    bool bent;     // whether some output keeps a bend
};

// One side of a column.
struct slope {
    double *jac, *doubt; // [n_out]
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
        above = row[k];
        row[k] = row[k - 1] + (row[k - 1] - old) / (power - 1);
        const double spread = fabs(row[k] - old) + rounding; // row[k - 1] is nearer
        if (spread < *doubt) {
            *doubt = spread;
            *jac = row[k];
        }
    }
}

// Notes whether quotients ahead and behind differ, beyond rounding, as much as they did with the larger step.
static void watch_bends(struct columns *c, int level, double step)
{
    for (int i = 0; i < c->map->n_out; i++) {
        double rounding, before = c->bend[i];
        quotient(c, both, i, step, &rounding);
        c->bend[i] = fabs(c->ahead[i] - 2 * c->here[i] + c->behind[i]) / step;
        c->bent = c->bent || (level > 0 && c->bend[i] > fmax(stays * before, certain * rounding));
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
        if (side == both)
            watch_bends(c, level, step);
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

// Where both sides are certain to differ, their mean and half their difference.
static void tell_kinks(struct columns *c, int j, double size, const struct slope side[2], double *jac, double *doubt,
                       double *kink)
{
    difference(c, j, behind_only, size, side[0].jac, side[0].doubt);
    difference(c, j, ahead_only, size, side[1].jac, side[1].doubt);
    for (int i = 0; i < c->map->n_out; i++) {
        const double jump = side[1].jac[i] - side[0].jac[i], either = side[0].doubt[i] + side[1].doubt[i];
        if (!(fabs(jump) > certain * either))
            continue;
        jac[i] = (side[0].jac[i] + side[1].jac[i]) / 2;
        doubt[i] = fmax(side[0].doubt[i], side[1].doubt[i]);
        kink[i] = jump / 2;
    }
}

// Whether both sides leave room for steps, or which does; the size falls to what fits.
static enum side find_room(const struct columns *c, int j, double *size)
{
    const double at = c->in[j], behind = c->box ? at - c->box[j].lower : INFINITY,
                 ahead = c->box ? c->box[j].upper - at : INFINITY;
    const double less = fmin(behind, ahead), more = fmax(behind, ahead);
    if (!(more > 0))
        return both;
    const enum side side = less > narrow * first_step * *size ? both : ahead > behind ? ahead_only : behind_only;
    *size = fmin(*size, (side == both ? less : more) / first_step);
    return side;
}

static void difference_column(struct columns *c, int j, double size, const struct slope side[2], double *jac,
                              double *doubt, double *kink)
{
    static const enum side order[] = {both, ahead_only, behind_only};
    const int n_out = c->map->n_out;
    const enum side room = find_room(c, j, &size);
    memset(kink, 0, (size_t)n_out * sizeof *kink);
    c->bent = false;
    if (room != both) {
        difference(c, j, room, size, jac, doubt);
        return;
    }
    for (int k = 0; k < 3; k++) {
        difference(c, j, order[k], size, jac, doubt);
        if (all_known(doubt, n_out)) {
            if (order[k] == both && c->bent)
                tell_kinks(c, j, size, side, jac, doubt, kink);
            return;
        }
    }
}

moray_status moray_difference_columns(const moray_map *map, const double *in, const double *size,
                                      const moray_bounds *box, double *jac, double *doubt, double *kink)
{
    const size_t n_in = (size_t)map->n_in, n_out = (size_t)map->n_out;
    double *block = calloc(n_in + (8 + levels) * n_out + 1, sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory to difference %d functions", map->n_out);
    double *at = block + n_in;
    struct columns c = {.map = map, .box = box, .in = block, .here = at, .ahead = at + n_out, .behind = at + 2 * n_out};
    const struct slope side[] = {{at + 3 * n_out, at + 4 * n_out}, {at + 5 * n_out, at + 6 * n_out}};
    c.bend = at + 7 * n_out;
    c.table = at + 8 * n_out;
    memcpy(c.in, in, n_in * sizeof *in);
    map->value(map->self, in, c.here);
    for (size_t j = 0; j < n_in; j++)
        difference_column(&c, (int)j, size[j], side, jac + j * n_out, doubt + j * n_out, kink + j * n_out);
    free(block);
    return moray_ok();
}
