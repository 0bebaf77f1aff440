// SPDX-License-Identifier: MIT
//
// Joints on the gait: phi, v_phi, ubar are (25) and its derivatives, the shape inputs a, omega, delta, phi_0, taper, t;
// where the offset moves, phi_0' and phi_0'' too, but no taper.
#include "snake/plant/plant.h"

#include "snake/model/shape.h"

// A triple of vectors on the shape, in the plant's scratch space.
typedef struct triple {
    double *phi, *v, *ubar;
} triple;

static triple triple_at(const plant *self, int k)
{
    double *start = self->work + 3 * k * self->n;
    return (triple){start, start + self->n, start + 2 * self->n};
}

static void shape(plant *self)
{
    double p[GAIT_KINDS] = {0};
    for (int k = 0; k < self->n_shape; k++)
        p[self->kind[k]] = self->in[self->col[k]];
    moray_reference_set(&self->gait, p);
    moray_reference_values(&self->gait, self->phi, self->v_phi, self->ubar);
}

static void pull_back(const plant *self, const double *on_phi, const double *on_v, const double *on_ubar, double *out)
{
    double by[GAIT_KINDS];
    moray_reference_gradient(&self->gait, on_phi, on_v, on_ubar, by);
    for (int k = 0; k < self->n_shape; k++)
        out[k] = by[self->kind[k]];
}

static triple tangent(const plant *self, int k)
{
    const triple along = triple_at(self, 0);
    moray_reference_tangent(&self->gait, self->kind[k], along.phi, along.v, along.ubar);
    return along;
}

// out = G (c_v v + c_ubar ubar)
static void gram(const plant *self, double c_v, const double *v, double c_ubar, const double *ubar, double *out)
{
    double *sum = triple_at(self, 2).phi;
    for (int i = 0; i < self->n; i++)
        sum[i] = c_v * v[i] + c_ubar * ubar[i];
    moray_shape_gram_inverse(self->n + 1, sum, out);
}

static void force_jacobian(const plant *self, double *values, int stride)
{
    const triple product = triple_at(self, 1);
    for (int k = 0; k < self->n_shape; k++) {
        const triple along = tangent(self, k);
        moray_shape_a_dbar_transposed(self->n + 1, along.phi, product.phi);
        gram(self, self->body.c_n, along.v, self->body.mt, along.ubar, product.v);
        for (int i = 0; i < self->n; i++)
            values[i * stride + k] = self->at.kappa * product.phi[i] + product.v[i];
    }
}

// delta does not move the first joint, taper not a joint that is alone.
static bool moves_link(const plant *self, int input, int link)
{
    return input == GAIT_DELTA ? link > 0 && self->n > 1 : input != GAIT_TAPER || self->n > 1;
}

static double *angle_jacobian(const plant *self, double *values)
{
    const int n = self->n;
    for (int k = 0; k < self->n_s; k++) {
        const double *phi = tangent(self, k).phi;
        for (int i = 0; i <= n; i++)
            if (moves_link(self, self->kind[k], i))
                *values++ = self->half_inverse_L * ((i > 0 ? phi[i - 1] : 0) + (i < n ? phi[i] : 0));
    }
    return values;
}

static void angle_pattern(const plant *self, entries *list)
{
    for (int k = 0; k < self->n_s; k++)
        for (int i = 0; i <= self->n; i++)
            if (moves_link(self, self->kind[k], i))
                add_entry(list, self->angles + i, self->col[k]);
}

// Product of the second derivatives by the shape vectors, as given with plant_form.hessian, with `along`.
static triple curvature_along(const plant *self, const double g[FEATURES], double power_weight, triple along)
{
    const int n = self->n, N = n + 1;
    const double mt = power_weight * self->body.mt, c_n = power_weight * self->body.c_n;
    const triple out = triple_at(self, 1);
    double *sum = triple_at(self, 2).phi, *product = triple_at(self, 2).v;
    for (int i = 0; i < n; i++)
        sum[i] = g[FEATURE_W] * along.v[i] + g[FEATURE_Z] * along.ubar[i];
    moray_shape_a_dbar(N, sum, product);
    aa_transposed(n, along.phi, out.phi);
    for (int i = 0; i < n; i++)
        out.phi[i] = 2 * g[FEATURE_Q] * out.phi[i] + product[i];
    moray_shape_a_dbar_transposed(N, along.phi, product);
    gram(self, 2 * c_n, along.v, mt, along.ubar, out.v);
    gram(self, mt, along.v, 0, along.ubar, out.ubar);
    for (int i = 0; i < n; i++) {
        out.v[i] += g[FEATURE_W] * product[i];
        out.ubar[i] += g[FEATURE_Z] * product[i];
    }
    return out;
}

static void hessian(const plant *self, const double g[FEATURES], const double *weight, double *values)
{
    double second[GAIT_PAIRS], by[GAIT_KINDS];
    moray_reference_hessian(&self->gait, self->on_phi, self->on_v, self->on_ubar, second);
    for (int k = 0; k < self->n_shape; k++) {
        const int kind = self->kind[k];
        const triple row = curvature_along(self, g, weight[self->power], tangent(self, k));
        moray_reference_gradient(&self->gait, row.phi, row.v, row.ubar, by);
        for (int j = 0; j <= k && j < self->n_curved; j++) // linear in phi_0', phi_0''
            *values++ = by[self->kind[j]] + (kind < GAIT_INPUTS ? second[kind * (kind + 1) / 2 + self->kind[j]] : 0);
    }
}

// The offset, v_n's neighbour in the state, and its rate.
static void offset_rates(const plant *self, double *out)
{
    out[self->offset] = self->in[self->offset + 1];
    out[self->offset + 1] = self->in[self->offset + 2];
}

static double *offset_jacobian(const plant *self, double *values)
{
    (void)self;
    *values++ = 1;
    *values++ = 1;
    return values;
}

static void offset_pattern(const plant *self, entries *list)
{
    add_entry(list, self->offset, self->offset + 1);
    add_entry(list, self->offset + 1, self->offset + 2);
}

const plant_form moray_plant_on_gait = {
    .shape = shape,
    .pull_back = pull_back,
    .force_jacobian = force_jacobian,
    .angle_jacobian = angle_jacobian,
    .angle_pattern = angle_pattern,
    .hessian = hessian,
};

const plant_form moray_plant_steered = {
    .shape = shape,
    .pull_back = pull_back,
    .joint_rates = offset_rates,
    .joint_rates_jacobian = offset_jacobian,
    .joint_rates_pattern = offset_pattern,
    .force_jacobian = force_jacobian,
    .angle_jacobian = angle_jacobian,
    .angle_pattern = angle_pattern,
    .hessian = hessian,
};
