// SPDX-License-Identifier: MIT
#include "sweep/sweep.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/results.h"

static moray_status check_ranges(const moray_sweep_spec *spec)
{
    if (spec->ranges < 0 || spec->ranges > MORAY_SWEEP_RANGES)
        return moray_error(MORAY_INPUT, "%d random keys: at most %d", spec->ranges, MORAY_SWEEP_RANGES);
    if ((spec->ranges > 0) != (spec->draws > 0))
        return moray_error(MORAY_INPUT, "%ld random draws of %d keys: either needs the other", spec->draws,
                           spec->ranges);
    for (int r = 0; r < spec->ranges; r++)
        if (!spec->range[r].key || !*spec->range[r].key)
            return moray_error(MORAY_INPUT, "random key %d has no name", r + 1);
        else if (!(isfinite(spec->range[r].low) && isfinite(spec->range[r].high) &&
                   spec->range[r].low <= spec->range[r].high))
            return moray_error(MORAY_INPUT, "%s = %g:%g: must be finite and rising", spec->range[r].key,
                               spec->range[r].low, spec->range[r].high);
    return moray_ok();
}

// Coordinates of a file rise or fall throughout, by which a point's neighbours are its nearest, too.
static moray_status check_numbers(const moray_sweep_axis *axis)
{
    for (int i = 0; i < axis->n; i++) {
        if (!isfinite(axis->value[i]))
            return moray_error(MORAY_INPUT, "%.60s = %g: must be finite", axis->key, axis->value[i]);
        if (i > 0 && !((axis->value[i] - axis->value[i - 1]) * (axis->value[1] - axis->value[0]) > 0))
            return moray_error(MORAY_INPUT, "%.60s: values must rise or fall throughout, and %g follows %g", axis->key,
                               axis->value[i], axis->value[i - 1]);
    }
    return moray_ok();
}

static moray_status check_words(const moray_sweep_axis *axis)
{
    for (int i = 0; i < axis->n; i++) {
        if (!axis->word[i] || !axis->word[i][0])
            return moray_error(MORAY_INPUT, "%.60s: word %d is empty", axis->key, i + 1);
        for (int other = 0; other < i; other++)
            if (strcmp(axis->word[i], axis->word[other]) == 0)
                return moray_error(MORAY_INPUT, "%.60s: %.100s is there twice", axis->key, axis->word[i]);
    }
    return moray_ok();
}

static moray_status check_axes(const moray_sweep_spec *spec)
{
    if (spec->axes < 0 || spec->axes > MORAY_SWEEP_AXES)
        return moray_error(MORAY_INPUT, "%d axes: at most %d", spec->axes, MORAY_SWEEP_AXES);
    for (int k = 0; k < spec->axes; k++) {
        const moray_sweep_axis *axis = &spec->axis[k];
        if (!axis->key || !*axis->key)
            return moray_error(MORAY_INPUT, "axis %d has no key", k + 1);
        if (axis->n < 1 || (!axis->value && !axis->word))
            return moray_error(MORAY_INPUT, "%.60s has no values", axis->key);
        MORAY_TRY(axis->value ? check_numbers(axis) : check_words(axis));
    }
    return moray_ok();
}

static const char *key_of(const moray_sweep_spec *spec, int k)
{
    return k < spec->axes ? spec->axis[k].key : spec->range[k - spec->axes].key;
}

static moray_status check_keys(const moray_sweep_spec *spec)
{
    const int n = spec->axes + spec->ranges;
    for (int k = 0; k < n; k++)
        for (int other = 0; other < k; other++)
            if (strcmp(key_of(spec, k), key_of(spec, other)) == 0)
                return moray_error(MORAY_INPUT, "%s is varied twice", key_of(spec, k));
    return moray_ok();
}

moray_status moray_grid_new(const moray_sweep_spec *spec, struct grid *grid)
{
    if (!spec->solve)
        return moray_error(MORAY_INPUT, "a sweep without a function that solves a point");
    MORAY_TRY(check_axes(spec));
    MORAY_TRY(check_ranges(spec));
    MORAY_TRY(check_keys(spec));
    *grid = (struct grid){.spec = spec, .points = 1};
    if (spec->draws > 0)
        grid->shape[grid->axes++] = spec->draws;
    grid->first = grid->axes;
    for (int k = 0; k < spec->axes; k++)
        grid->shape[grid->axes++] = spec->axis[k].n;
    for (int k = 0; k < grid->axes; k++) {
        if (grid->points > INT_MAX / grid->shape[k])
            return moray_error(MORAY_INPUT, "more than %d points", INT_MAX);
        grid->points *= grid->shape[k];
    }
    if (grid->axes == 0)
        return moray_error(MORAY_INPUT, "nothing is varied");
    return moray_ok();
}

void moray_grid_place(const struct grid *grid, long point, long at[GRID_AXES])
{
    for (int k = grid->axes - 1; k >= 0; k--) {
        at[k] = point % grid->shape[k];
        point /= grid->shape[k];
    }
}

static long point_at(const struct grid *grid, const long at[GRID_AXES])
{
    long point = 0;
    for (int k = 0; k < grid->axes; k++)
        point = point * grid->shape[k] + at[k];
    return point;
}

double moray_grid_coordinate(const struct grid *grid, long point, int axis)
{
    long at[GRID_AXES];
    moray_grid_place(grid, point, at);
    return grid->spec->axis[axis - grid->first].value[at[axis]];
}

bool moray_grid_numeric(const struct grid *grid, int axis)
{
    return axis >= grid->first && grid->spec->axis[axis - grid->first].value;
}

double moray_grid_draw(const moray_sweep_spec *spec, long draw, int r)
{
    // The mixing of SplitMix64: every (seed, draw, r) has its own number, whatever else is drawn.
    uint64_t z = spec->seed + 0x9e3779b97f4a7c15u * ((uint64_t)draw * MORAY_SWEEP_RANGES + (uint64_t)r + 1);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    const double part = (double)(z >> 11) * 0x1p-53;
    return spec->range[r].low + part * (spec->range[r].high - spec->range[r].low);
}

static double distance(const moray_sweep_spec *spec, long draw, long other)
{
    double sum = 0;
    for (int r = 0; r < spec->ranges; r++) {
        const double width = spec->range[r].high - spec->range[r].low;
        const double d = width > 0 ? (moray_grid_draw(spec, draw, r) - moray_grid_draw(spec, other, r)) / width : 0;
        sum += d * d;
    }
    return sum;
}

// The nearest of some draws in the first half, so that the chains of starts stay short and many can run at once.
static long earlier_draw(const moray_sweep_spec *spec, long draw)
{
    enum { looked_at = 256 };
    long best = -1;
    double least = INFINITY;
    for (long other = draw / 2 > looked_at ? draw / 2 - looked_at : 0; other < (draw + 1) / 2; other++) {
        const double d = distance(spec, draw, other);
        if (d < least) {
            least = d;
            best = other;
        }
    }
    return best;
}

long moray_grid_parent(const struct grid *grid, long point)
{
    long at[GRID_AXES];
    int furthest = -1;
    double most = 0;
    moray_grid_place(grid, point, at);
    for (int k = grid->first; k < grid->axes; k++) {
        const long middle = (grid->shape[k] - 1) / 2;
        const double away = moray_grid_numeric(grid, k) ? (double)labs(at[k] - middle) / (double)grid->shape[k] : 0;
        if (away > most) {
            most = away;
            furthest = k;
        }
    }
    if (furthest >= 0)
        at[furthest] += at[furthest] > (grid->shape[furthest] - 1) / 2 ? -1 : 1;
    else if (grid->first == 1 && at[0] > 0)
        at[0] = earlier_draw(grid->spec, at[0]);
    else
        return -1;
    return point_at(grid, at);
}

long moray_grid_step(const struct grid *grid, long point, int axis, long steps)
{
    long at[GRID_AXES];
    moray_grid_place(grid, point, at);
    at[axis] += steps;
    return at[axis] >= 0 && at[axis] < grid->shape[axis] ? point_at(grid, at) : -1;
}

void moray_grid_settings(const struct grid *grid, long point, moray_key_value *setting, double *value, char (*text)[32])
{
    const moray_sweep_spec *spec = grid->spec;
    long at[GRID_AXES];
    moray_grid_place(grid, point, at);
    for (int k = 0; k < spec->axes + spec->ranges; k++) {
        const moray_sweep_axis *axis = k < spec->axes ? &spec->axis[k] : NULL;
        const long i = axis ? at[grid->first + k] : 0;
        value[k] = !axis ? moray_grid_draw(spec, at[0], k - spec->axes) : axis->value ? axis->value[i] : NAN;
        setting[k] = (moray_key_value){key_of(spec, k),
                                       axis && !axis->value ? axis->word[i] : moray_number_text(value[k], text[k])};
    }
}
