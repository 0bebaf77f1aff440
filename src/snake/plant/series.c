// SPDX-License-Identifier: MIT
//
// Joints on a series, as a chain of maps: the inputs [theta, p_x, p_y, their rates, omega, coefficients, t] move the
// inputs of the plant with free joints, and those its outputs, of which the rates of the joints are left out.
#include "snake/plant/series.h"

#include <stdlib.h>
#include <string.h>

#include "base/triplets.h"
#include "snake/model/series.h"

enum { BODY = 6, OMEGA = BODY, COEFFICIENTS = OMEGA + 1, MOST_LINKS = 2 * MORAY_SERIES_HARMONICS + 3 };

// The inputs that move one input of the base, with the derivatives.
typedef struct link {
    int n, input[MOST_LINKS];
    double slope[MOST_LINKS];
} link;

typedef struct chain {
    moray_map base;
    int n, K;                // joints, harmonics
    int n_in, n_out, rates;  // rates: place of the joint rates among the outputs, n_out - 1 - n; or -1
    double in[OMEGA + 1], t; // the point: all but the coefficients
    const double *at;        // coefficients
    series_pair basis[MORAY_SERIES_HARMONICS + 1][SERIES_RANKS][SERIES_DERIVATIVES];
    link *links;                         // of every input of the base
    int *row;                            // output, or -1, of every output of the base
    double *base_in, *base_out, *weight; // of the base, in one block with the next two
    double *values;                      // of either pattern of the base
    double *on_shape;                    // derivative of the weighted sum by phi, phi', phi'' [SERIES_RANKS][n]
    triplets jac, hess;
} chain;

// Place of the rank-th derivative of a joint among the inputs of the base.
static int shape_place(const chain *self, int rank, int joint)
{
    return rank * (self->n + 3) + joint;
}

static int coefficient(const chain *self, int harmonic, int joint)
{
    return COEFFICIENTS + series_place(self->n, harmonic, joint);
}

// ---- A point -------------------------------------------------------------------------------------------------------

static double of_joint(const chain *self, int harmonic, int rank, int derivative, int joint)
{
    const series_pair on = self->basis[harmonic][rank][derivative];
    const double *p = self->at + series_place(self->n, harmonic, joint);
    return on.p * p[0] + on.q * p[self->n];
}

static void set_link(chain *self, int rank, int joint)
{
    link *to = &self->links[shape_place(self, rank, joint)];
    double omega = 0, t = 0, *slope = to->slope;
    if (rank == 0)
        *slope++ = 1;
    for (int k = 1; k <= self->K; k++) {
        *slope++ = self->basis[k][rank][SERIES_WAVE].p;
        *slope++ = self->basis[k][rank][SERIES_WAVE].q;
        omega += of_joint(self, k, rank, SERIES_OMEGA, joint);
        t += of_joint(self, k, rank, SERIES_T, joint);
    }
    *slope++ = omega;
    *slope = t;
}

static void set_base_input(chain *self)
{
    const int n = self->n;
    double *phi = self->base_in, *v_phi = self->base_in + n + 3, *ubar = v_phi + n + 3;
    memset(self->base_in, 0, (size_t)self->base.n_in * sizeof *phi);
    moray_series_add(&(moray_series){n, self->K, self->at}, self->in[OMEGA], self->t, phi, v_phi, ubar);
    memcpy(phi + n, self->in, 3 * sizeof *phi);
    memcpy(v_phi + n, self->in + 3, 3 * sizeof *phi);
}

static void set_point(chain *self, const double *in)
{
    memcpy(self->in, in, sizeof self->in);
    self->at = in + COEFFICIENTS;
    self->t = in[self->n_in - 1];
    set_base_input(self);
}

static void set_slopes(chain *self)
{
    for (int k = 1; k <= self->K; k++)
        moray_series_basis(k, self->in[OMEGA], self->t, self->basis[k]);
    for (int rank = 0; rank < SERIES_RANKS; rank++)
        for (int i = 0; i < self->n; i++)
            set_link(self, rank, i);
}

// ---- Values and Jacobian -------------------------------------------------------------------------------------------

static void value(void *context, const double *in, double *out)
{
    chain *self = context;
    set_point(self, in);
    self->base.value(self->base.self, self->base_in, self->base_out);
    for (int r = 0; r < self->base.n_out; r++)
        if (self->row[r] >= 0)
            out[self->row[r]] = self->base_out[r];
    for (int i = 0; i < self->n && self->rates >= 0; i++)
        out[self->rates + i] = self->base_in[shape_place(self, 1, i)];
}

static void moray_walk_jacobian(chain *self, triplets *out)
{
    const moray_pattern *base = &self->base.jac;
    for (int e = 0; e < base->nnz; e++) {
        const link *from = &self->links[base->col[e]];
        const int row = self->row[base->row[e]];
        for (int a = 0; a < from->n && row >= 0; a++)
            triplets_put(out, row, from->input[a], self->values[e] * from->slope[a]);
    }
    for (int i = 0; i < self->n && self->rates >= 0; i++) {
        const link *from = &self->links[shape_place(self, 1, i)];
        for (int a = 0; a < from->n; a++)
            triplets_put(out, self->rates + i, from->input[a], from->slope[a]);
    }
}

static void jacobian(void *context, const double *in, double *values)
{
    chain *self = context;
    set_point(self, in);
    set_slopes(self);
    self->base.jacobian(self->base.self, self->base_in, self->values);
    moray_triplets_start(&self->jac, values);
    moray_walk_jacobian(self, &self->jac);
}

// ---- Hessian -------------------------------------------------------------------------------------------------------

// Products of first derivatives. An entry of the base off its diagonal stands for two.
static void walk_products(const chain *self, triplets *out)
{
    const moray_pattern *base = &self->base.hess;
    for (int e = 0; e < base->nnz; e++) {
        const link *one = &self->links[base->row[e]], *other = &self->links[base->col[e]];
        const bool diagonal = one == other;
        for (int a = 0; a < one->n; a++)
            for (int b = diagonal ? a : 0; b < other->n; b++) {
                const int twice = !diagonal && one->input[a] == other->input[b] ? 2 : 1;
                triplets_put_lower(out, one->input[a], other->input[b],
                                   twice * self->values[e] * one->slope[a] * other->slope[b]);
            }
    }
}

// Second derivatives of one joint's rank-th derivative, times `on`.
static void walk_curve(const chain *self, int rank, int joint, double on, triplets *out)
{
    const int t = self->n_in - 1;
    for (int k = 1; k <= self->K; k++) {
        const series_pair *basis = self->basis[k][rank];
        const int p = coefficient(self, k, joint), q = p + self->n;
        triplets_put_lower(out, p, OMEGA, on * basis[SERIES_OMEGA].p);
        triplets_put_lower(out, q, OMEGA, on * basis[SERIES_OMEGA].q);
        triplets_put_lower(out, p, t, on * basis[SERIES_T].p);
        triplets_put_lower(out, q, t, on * basis[SERIES_T].q);
        triplets_put_lower(out, OMEGA, OMEGA, on * of_joint(self, k, rank, SERIES_OMEGA_OMEGA, joint));
        triplets_put_lower(out, t, OMEGA, on * of_joint(self, k, rank, SERIES_OMEGA_T, joint));
        triplets_put_lower(out, t, t, on * of_joint(self, k, rank, SERIES_T_T, joint));
    }
}

static void moray_walk_hessian(const chain *self, triplets *out)
{
    walk_products(self, out);
    for (int rank = 0; rank < SERIES_RANKS; rank++)
        for (int i = 0; i < self->n; i++)
            walk_curve(self, rank, i, self->on_shape[rank * self->n + i], out);
}

static void find_on_shape(chain *self, const double *weight)
{
    const moray_pattern *base = &self->base.jac;
    const int n = self->n, width = n + 3;
    memset(self->on_shape, 0, (size_t)(SERIES_RANKS * n) * sizeof *self->on_shape);
    self->base.jacobian(self->base.self, self->base_in, self->values);
    for (int e = 0; e < base->nnz; e++) {
        const int rank = base->col[e] / width, joint = base->col[e] % width;
        if (joint < n && rank < SERIES_RANKS)
            self->on_shape[rank * n + joint] += self->weight[base->row[e]] * self->values[e];
    }
    for (int i = 0; i < n && self->rates >= 0; i++)
        self->on_shape[n + i] += weight[self->rates + i];
}

static void hessian(void *context, const double *in, const double *weight, double *values)
{
    chain *self = context;
    set_point(self, in);
    set_slopes(self);
    for (int r = 0; r < self->base.n_out; r++)
        self->weight[r] = self->row[r] >= 0 ? weight[self->row[r]] : 0;
    find_on_shape(self, weight);
    self->base.hessian(self->base.self, self->base_in, self->weight, self->values);
    moray_triplets_start(&self->hess, values);
    moray_walk_hessian(self, &self->hess);
}

// ---- Construction --------------------------------------------------------------------------------------------------

static void release(moray_map *map)
{
    chain *self = map->self;
    moray_map_release(&self->base);
    moray_triplets_free(&self->jac);
    moray_triplets_free(&self->hess);
    free(self->links);
    free(self->row);
    free(self->base_in);
    free(self);
}

// Which inputs move which of the base's: its own place for the body, a series for the joints, t nothing.
static void place_links(chain *self)
{
    const int n = self->n, width = n + 3;
    for (int k = 0; k < 3; k++)
        for (int half = 0; half < 2; half++)
            self->links[half * width + n + k] = (link){1, {3 * half + k}, {1}};
    for (int rank = 0; rank < SERIES_RANKS; rank++)
        for (int i = 0; i < n; i++) {
            link *to = &self->links[shape_place(self, rank, i)];
            if (rank == 0)
                to->input[to->n++] = COEFFICIENTS + i;
            for (int k = 1; k <= self->K; k++) {
                to->input[to->n++] = coefficient(self, k, i);
                to->input[to->n++] = coefficient(self, k, i) + n;
            }
            to->input[to->n++] = OMEGA;
            to->input[to->n++] = self->n_in - 1;
        }
}

static void place_rows(chain *self, int base_states)
{
    const int n = self->n, width = n + 3, last = self->base.n_out - 1;
    for (int r = 0; r <= last; r++)
        self->row[r] = r >= base_states ? BODY + r - base_states : r % width < n ? -1 : 3 * (r / width) + r % width - n;
    self->row[last] = self->n_out - 1;
    for (int k = 0; k < 3; k++) // the base has the joints' accelerations before the body's
        self->row[width + n + k] = 3 + k;
}

// While recording, any point does.
static moray_status record(chain *self)
{
    double *at = calloc((size_t)self->n_in, sizeof *at);
    if (!at)
        return moray_error(MORAY_MEMORY, "no memory for a plant of %d joints", self->n);
    self->at = at;
    moray_triplets_record(&self->jac);
    moray_walk_jacobian(self, &self->jac);
    moray_status status = moray_triplets_close(&self->jac);
    if (!moray_failed(status)) {
        moray_triplets_record(&self->hess);
        moray_walk_hessian(self, &self->hess);
        status = moray_triplets_close(&self->hess);
    }
    free(at);
    self->at = NULL;
    return status;
}

static moray_status fill(chain *self, int base_states)
{
    const moray_map *base = &self->base;
    const int longest = base->jac.nnz > base->hess.nnz ? base->jac.nnz : base->hess.nnz;
    self->links = calloc((size_t)base->n_in, sizeof *self->links);
    self->row = calloc((size_t)base->n_out, sizeof *self->row);
    self->base_in =
        calloc((size_t)(base->n_in + 2 * base->n_out + longest + SERIES_RANKS * self->n), sizeof *self->base_in);
    if (!self->links || !self->row || !self->base_in)
        return moray_error(MORAY_MEMORY, "no memory for a plant of %d joints", self->n);
    self->base_out = self->base_in + base->n_in;
    self->weight = self->base_out + base->n_out;
    self->on_shape = self->weight + base->n_out;
    self->values = self->on_shape + SERIES_RANKS * self->n;
    place_links(self);
    place_rows(self, base_states);
    return record(self);
}
moray_status moray_plant_series(moray_map *map, const moray_plant_spec *spec, plant_maker *make)
{
    if (spec->harmonics < 1 || spec->harmonics > MORAY_SERIES_HARMONICS)
        return moray_error(MORAY_INPUT, "harmonics = %d: must be within 1:%d", spec->harmonics, MORAY_SERIES_HARMONICS);
    moray_plant_spec free = *spec;
    free.joints = MORAY_JOINTS_FREE;
    free.path_rates = false;
    const moray_plant_size size = moray_plant_sizes(spec), base = moray_plant_sizes(&free);
    chain *self = calloc(1, sizeof *self);
    if (!self)
        return moray_error(MORAY_MEMORY, "no memory for a plant of %d links", spec->robot.links);
    self->n = spec->robot.links - 1;
    self->K = spec->harmonics;
    self->n_in = size.nx + size.ns + 1;
    self->n_out = size.nx + size.nc + size.nq;
    self->rates = spec->path_rates ? self->n_out - 1 - self->n : -1;
    moray_status status = make(&self->base, &free);
    if (!moray_failed(status))
        status = fill(self, base.nx);
    *map = (moray_map){.n_in = self->n_in,
                       .n_out = self->n_out,
                       .jac = self->jac.pattern,
                       .hess = self->hess.pattern,
                       .self = self,
                       .value = value,
                       .jacobian = jacobian,
                       .hessian = hessian,
                       .release = release};
    if (moray_failed(status))
        moray_map_release(map);
    return status;
}
