// SPDX-License-Identifier: MIT
//
// Residuals, their derivatives by central differences, and the normal equations. What changes only the readings is read
// off again without swimming.
#include <math.h>
#include <string.h>

#include "snake/identify/identify.h"

static const double difference = 1e-5; // of a scale: the truncation is its square, rounding 1e-16 over it

moray_unknowns moray_identify_world_of(const moray_identify *v, const double *value)
{
    moray_unknowns world = v->spec.start;
    for (int k = 0; k < v->spec.n; k++)
        *moray_unknown_at(v->unknown[k], &world) = value[k];
    return world;
}

bool moray_identify_first_varies(const moray_identify *v, int state)
{
    return !v->spec.rest || state == MORAY_STATE_THETA || state == MORAY_STATE_P_X || state == MORAY_STATE_P_Y;
}

// ---- Derivatives ---------------------------------------------------------------------------------------------------

static void divide(const struct run *run, const double *up, const double *down, double *column, int stride)
{
    for (int k = 0; k < run->items; k++)
        column[k * stride] = (up[k] - down[k]) / (2 * difference * run->item[k].sigma);
}

// The predictions with unknown k moved.
static bool move(const moray_identify *v, const struct run *run, const moray_unknowns *world, const double *first,
                 int k, double by, double *predicted)
{
    moray_unknowns moved = *world;
    *moray_unknown_at(v->unknown[k], &moved) += by;
    return (moray_unknown_table[v->unknown[k]].instrument || moray_identify_swim(v, run, &moved, first)) &&
           moray_identify_read(v, run, &moved, predicted);
}

// A coefficient at 0 has no robot on its other side: (4 (f(h) - f) - (f(2h) - f)) / 2h, f the predictions here.
static bool by_unknown(const moray_identify *v, const struct run *run, const moray_unknowns *world, const double *first,
                       int k, double *column, int stride)
{
    moray_unknowns here = *world;
    const double step = difference * v->scale[k];
    const bool one_sided = !moray_unknown_table[v->unknown[k]].offset && *moray_unknown_at(v->unknown[k], &here) < step;
    if (!move(v, run, world, first, k, step, v->up) ||
        !move(v, run, world, first, k, one_sided ? 2 * step : -step, v->down))
        return false;
    for (int i = 0; i < run->items && one_sided; i++) {
        v->up[i] = 4 * (v->up[i] - v->here[i]);
        v->down[i] -= v->here[i];
    }
    divide(run, v->up, v->down, column, stride);
    return true;
}

// A robot that starts elsewhere is a camera that stands the other way: the water is the same everywhere.
static bool by_position(const moray_identify *v, const struct run *run, const moray_unknowns *world, int state,
                        double *column, int stride)
{
    moray_unknowns moved = *world;
    const int axis = state - MORAY_STATE_P_X;
    const double step = difference * first_scale;
    moved.camera[axis] = world->camera[axis] - step;
    if (!moray_identify_read(v, run, &moved, v->up))
        return false;
    moved.camera[axis] = world->camera[axis] + step;
    if (!moray_identify_read(v, run, &moved, v->down))
        return false;
    divide(run, v->up, v->down, column, stride);
    return true;
}

static bool by_first(const moray_identify *v, const struct run *run, const moray_unknowns *world, const double *first,
                     int state, double *column, int stride)
{
    double moved[FIRST];
    const double step = difference * first_scale;
    memcpy(moved, first, sizeof moved);
    moved[state] = first[state] + step;
    if (!moray_identify_swim(v, run, world, moved) || !moray_identify_read(v, run, world, v->up))
        return false;
    moved[state] = first[state] - step;
    if (!moray_identify_swim(v, run, world, moved) || !moray_identify_read(v, run, world, v->down))
        return false;
    divide(run, v->up, v->down, column, stride);
    return true;
}

// First what reads off the grid as it is, then what swims anew.
static bool derivatives(const moray_identify *v, const struct run *run, const moray_unknowns *world,
                        const double *first, double *jacobian)
{
    const int n = v->spec.n, stride = n + FIRST;
    bool good = true;
    memset(jacobian, 0, (size_t)run->items * (size_t)stride * sizeof *jacobian);
    for (int k = 0; k < n && good; k++)
        if (moray_unknown_table[v->unknown[k]].instrument)
            good = by_unknown(v, run, world, first, k, jacobian + k, stride);
    for (int i = MORAY_STATE_P_X; i <= MORAY_STATE_P_Y && good; i++)
        good = by_position(v, run, world, i, jacobian + n + i, stride);
    for (int k = 0; k < n && good; k++)
        if (!moray_unknown_table[v->unknown[k]].instrument)
            good = by_unknown(v, run, world, first, k, jacobian + k, stride);
    for (int i = 0; i < FIRST && good; i++)
        if (i != MORAY_STATE_P_X && i != MORAY_STATE_P_Y && moray_identify_first_varies(v, i))
            good = by_first(v, run, world, first, i, jacobian + n + i, stride);
    return good;
}

// ---- Residuals -----------------------------------------------------------------------------------------------------

// A heading that was logged beyond a turn is the same heading.
static double miss(const struct item *item, double predicted)
{
    double r = predicted - item->observed;
    if (item->kind == MORAY_CHANNEL_HEADING)
        r -= 2 * M_PI * round(r / (2 * M_PI));
    return r / item->sigma;
}

bool moray_identify_residual(const moray_identify *v, int r, const moray_estimate *at, double *residual,
                             double *jacobian)
{
    const struct run *run = &v->run[r];
    const moray_unknowns world = moray_identify_world_of(v, at->value);
    if (!moray_identify_swim(v, run, &world, at->first[r]) || !moray_identify_read(v, run, &world, v->here))
        return false;
    for (int k = 0; k < run->items; k++)
        residual[k] = miss(&run->item[k], v->here[k]);
    return !jacobian || derivatives(v, run, &world, at->first[r], jacobian);
}

// ---- The loss ------------------------------------------------------------------------------------------------------

// Huber's: r^2 within the bound, 2 b |r| - b^2 beyond; its weight.
static double loss(const moray_identify *v, double r, double *weight)
{
    const double bound = v->spec.huber > 0 ? v->spec.huber : INFINITY, size = fabs(r);
    *weight = size <= bound ? 1 : bound / size;
    return size <= bound ? r * r : (2 * size - bound) * bound;
}

bool moray_identify_cost(const moray_identify *v, const moray_estimate *at, double *cost)
{
    double weight;
    *cost = 0;
    for (int r = 0; r < v->runs; r++) {
        if (!moray_identify_residual(v, r, at, v->residual, NULL))
            return false;
        for (int k = 0; k < v->run[r].items; k++)
            *cost += loss(v, v->residual[k], &weight);
    }
    return isfinite(*cost);
}

static void add_item(const moray_identify *v, int r, const double *row, double residual, double weight)
{
    const int n = v->spec.n, m = v->columns, shift = r * FIRST; // column i >= n of the run is column i + shift of all
    for (int i = 0; i < n + FIRST; i++) {
        const int to = i < n ? i : i + shift;
        if (row[i] == 0)
            continue;
        v->gradient[to] += weight * row[i] * residual;
        for (int j = 0; j <= i; j++)
            v->normal[to * m + (j < n ? j : j + shift)] += weight * row[i] * row[j];
    }
}

bool moray_identify_equations(const moray_identify *v, const moray_estimate *at, double *cost)
{
    const int m = v->columns, stride = v->spec.n + FIRST;
    double weight;
    *cost = 0;
    memset(v->normal, 0, (size_t)m * (size_t)m * sizeof *v->normal);
    memset(v->gradient, 0, (size_t)m * sizeof *v->gradient);
    for (int r = 0; r < v->runs; r++) {
        if (!moray_identify_residual(v, r, at, v->residual, v->jacobian))
            return false;
        for (int k = 0; k < v->run[r].items; k++) {
            *cost += loss(v, v->residual[k], &weight);
            add_item(v, r, v->jacobian + k * stride, v->residual[k], weight);
        }
    }
    for (int i = 0; i < m; i++)
        for (int j = 0; j < i; j++)
            v->normal[j * m + i] = v->normal[i * m + j];
    return isfinite(*cost);
}
