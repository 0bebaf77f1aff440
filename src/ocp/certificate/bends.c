// SPDX-License-Identifier: MIT
#include "ocp/certificate/bends.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/dense.h"

enum { directions = 3, levels = 7 };
static const double first_step = 0.05; // of the sizes
static const double least_room = 1e-3; // of a size, on either side, for an input to be moved
static const double certain = 10;      // doubts that a disagreement is to exceed
static const double tolerant = 1e-2;   // of a disagreement: second derivatives in use may be differences themselves
static const double small_part = 1e-2; // of what the weighted functions move by, that counts beside what is found

// One map at one point, weighted.
struct bending {
    const moray_map *map;
    const double *in, *size;
    const moray_bounds *box;
    double *weight;                      // [n_out]
    double *direction, *at, *out, *hess; // [n_in], [n_in], [n_out], [nnz]
    const int *column;                   // [n_in], -1: no variable; NULL: all are
    bool timeless;                       // the last input, the time, is none
};

static double weighted_at(const struct bending *b, double step, double *rounding)
{
    double sum = 0;
    for (int j = 0; j < b->map->n_in; j++)
        b->at[j] = b->in[j] + step * b->direction[j];
    b->map->value(b->map->self, b->at, b->out);
    for (int i = 0; i < b->map->n_out; i++) {
        sum += b->weight[i] != 0 ? b->weight[i] * b->out[i] : 0;
        *rounding = fmax(*rounding, DBL_EPSILON * fabs(b->weight[i] * b->out[i]));
    }
    return sum;
}

// Inputs without room on both sides stay.
static void choose_direction(const struct bending *b, int which, int seed)
{
    for (int j = 0; j < b->map->n_in; j++) {
        const double entry = moray_dense_entry(j, MORAY_DENSE_BENDS + directions * seed + which);
        const double room = fmin(b->in[j] - b->box[j].lower, b->box[j].upper - b->in[j]);
        const double reach = fmin(fabs(entry) * b->size[j], room / first_step);
        const bool still = b->column ? b->column[j] < 0 : b->timeless && j == b->map->n_in - 1;
        b->direction[j] = !still && reach > least_room * b->size[j] ? copysign(reach, entry) : 0;
    }
}

// What the steps up to one of them say, and how far off it may be.
struct told {
    double value, doubt;
};

// Which points a second difference is of: the one in the middle is `at` steps off.
enum side { behind = -1, both, ahead };

// Second differences of one step after another, extrapolated: row[levels] is that of the step before. Errors go with
// the square of the step, or with the step.
static struct told extrapolate(const struct bending *b, enum side at, int level, double noise, double *row)
{
    struct told told = {NAN, INFINITY};
    const double h = ldexp(first_step, -2 * level), middle = (int)at;
    double rounding = noise, above = row[0], power = 1;
    row[0] = (weighted_at(b, (middle + 1) * h, &rounding) - 2 * weighted_at(b, middle * h, &rounding) +
              weighted_at(b, (middle - 1) * h, &rounding)) /
             (h * h);
    for (int k = 1; k <= level; k++) {
        const double old = above;
        power *= at == both ? 16 : 4;
        above = k < level ? row[k] : 0;
        row[k] = row[k - 1] + (row[k - 1] - old) / (power - 1);
        const double spread = fabs(row[k] - old) + 4 * b->map->n_out * rounding / (h * h); // row[k - 1] is nearer
        if (spread < told.doubt)
            told = (struct told){row[k], spread};
    }
    return told;
}

// The step that agrees best with itself and with all smaller ones: where a function is flat but here, larger ones agree
// on nothing.
static double difference_beside(const struct bending *b, enum side at, double *doubt)
{
    struct told told[levels];
    double row[levels] = {0}, noise = 0, best = NAN;
    weighted_at(b, 0, &noise);
    for (int level = 0; level < levels; level++)
        told[level] = extrapolate(b, at, level, noise, row);
    *doubt = INFINITY;
    for (int level = 1; level < levels; level++) {
        double far = told[level].doubt;
        for (int less = level + 1; less < levels; less++)
            far = fmax(far, fabs(told[less].value - told[level].value) - 2 * told[less].doubt);
        if (far < *doubt) {
            *doubt = far;
            best = told[level].value;
        }
    }
    return best;
}

// On one side where functions are not finite on the other.
static double difference(const struct bending *b, double *doubt)
{
    static const enum side order[] = {both, ahead, behind};
    double found = NAN;
    *doubt = INFINITY;
    for (int k = 0; k < 3 && !isfinite(*doubt); k++)
        found = difference_beside(b, order[k], doubt);
    return found;
}

static double in_use(const struct bending *b)
{
    const moray_pattern *hess = &b->map->hess;
    double sum = 0;
    b->map->hessian(b->map->self, b->in, b->weight, b->hess);
    for (int e = 0; e < hess->nnz; e++)
        sum += (hess->row[e] == hess->col[e] ? 1 : 2) * b->hess[e] * b->direction[hess->row[e]] *
               b->direction[hess->col[e]];
    return sum;
}

// In two directions at least: what is wrong is wrong in all. matters: a bend of that size does.
static double disagreement(const struct bending *b, const double *out_size, double matters, int seed)
{
    double worst = 0, second = 0, moved = 0;
    for (int i = 0; i < b->map->n_out; i++)
        moved += fabs(b->weight[i]) * out_size[i];
    for (int which = 0; which < directions; which++) {
        double doubt;
        choose_direction(b, which, seed);
        const double found = difference(b, &doubt), far = fabs(in_use(b) - found) - certain * doubt;
        const double error = isfinite(doubt) ? far / (fabs(found) + matters + small_part * moved) : 0;
        second = fmax(second, fmin(error, worst));
        worst = fmax(worst, error);
    }
    return second;
}

// ---- Where ----

static void weigh_node(const struct transcription *t, const double *lambda, int p, int n, double *weight)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const int nx = phase->nx, nc = phase->nc;
    memcpy(weight, t->phase[p].lambda + n * nx, (size_t)nx * sizeof *weight);
    memcpy(weight + nx, lambda + layout->node[n].path, (size_t)nc * sizeof *weight);
    for (int m = 0; m < phase->nq; m++)
        weight[nx + nc + m] =
            -(t->phase[p].tf - t->phase[p].t0) * layout->node[n].weight * lambda[layout->integral_row + m];
}

struct worst_bend {
    double value;
    int p, node; // p < 0: the endpoint
};

static void check_phase(const struct witness *w, struct bending *b, int p, struct worst_bend *worst)
{
    const struct transcription *t = w->solution->transcription;
    const double *lambda = w->solution->iterate.lambda;
    b->map = t->phase[p].map;
    b->size = w->phase[p].size;
    b->box = w->phase[p].box;
    b->column = NULL;
    b->timeless = t->layout.phase[p].t0 == absent && t->layout.phase[p].tf == absent;
    moray_dynamics_multipliers(t, p, lambda, t->phase[p].lambda);
    for (int n = 0; n < t->layout.phase[p].nodes; n++) {
        const struct node *node = &t->layout.phase[p].node[n];
        if (!node->collocated)
            continue;
        b->in = t->phase[p].in + n * b->map->n_in;
        weigh_node(t, lambda, p, n, b->weight);
        const double value = disagreement(b, w->phase[p].out_size, node->weight * moray_witness_objective(w), n);
        if (value > worst->value)
            *worst = (struct worst_bend){value, p, n};
    }
}

static void check_endpoint(const struct witness *w, struct bending *b, struct worst_bend *worst)
{
    const struct transcription *t = w->solution->transcription;
    b->map = t->endpoint;
    b->in = t->end_in;
    b->size = w->end_size;
    b->box = w->end_box;
    b->column = t->end_column;
    b->weight[0] = 1;
    memcpy(b->weight + 1, w->solution->iterate.lambda + t->layout.events,
           (size_t)(b->map->n_out - 1) * sizeof *b->weight);
    const double value = disagreement(b, w->end_out_size, moray_witness_objective(w), 0);
    if (value > worst->value)
        *worst = (struct worst_bend){value, -1, 0};
}

static void say_where(const struct transcription *t, const double *x, const struct worst_bend *worst, char *where,
                      int size)
{
    if (worst->p < 0)
        snprintf(where, (size_t)size, "a second derivative of the endpoint");
    else
        snprintf(where, (size_t)size, "a second derivative in phase %.100s at t = %.6g", t->ocp->phase[worst->p].name,
                 moray_layout_time(&t->layout, t->ocp, x, worst->p, t->layout.phase[worst->p].node[worst->node].tau));
}

static size_t larger(size_t one, int other)
{
    return one > (size_t)other ? one : (size_t)other;
}

moray_status moray_difference_bends(const struct witness *w, double *worst, char *where, int size)
{
    const struct transcription *t = w->solution->transcription;
    size_t in = (size_t)t->endpoint->n_in, out = (size_t)t->endpoint->n_out, nnz = (size_t)t->endpoint->hess.nnz;
    for (int p = 0; p < t->ocp->phases; p++) {
        in = larger(in, t->phase[p].map->n_in);
        out = larger(out, t->phase[p].map->n_out);
        nnz = larger(nnz, t->phase[p].map->hess.nnz);
    }
    double *block = calloc(2 * in + 2 * out + nnz + 1, sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    struct bending b = {.direction = block, .at = block + in, .out = block + 2 * in, .weight = block + 2 * in + out};
    b.hess = b.weight + out;
    struct worst_bend found = {.p = -1};
    for (int p = 0; p < t->ocp->phases; p++)
        check_phase(w, &b, p, &found);
    check_endpoint(w, &b, &found);
    found.value *= tolerant;
    if (found.value > *worst) {
        *worst = found.value;
        say_where(t, w->solution->iterate.x, &found, where, size);
    }
    free(block);
    return moray_ok();
}
