// SPDX-License-Identifier: MIT
//
// Joints on the gait: phi, v_phi, ubar are (25) and its derivatives, the shape inputs a, omega, delta, phi_0, taper, t.
#include "plant.h"

#include "shape.h"

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
    reference_set(&self->gait, self->in + self->rest);
    reference_values(&self->gait, self->phi, self->v_phi, self->ubar);
}

static void pull_back(const plant *self, const double *on_phi, const double *on_v, const double *on_ubar, double *out)
{
    reference_gradient(&self->gait, on_phi, on_v, on_ubar, out);
}

static triple tangent(const plant *self, int input)
{
    const triple along = triple_at(self, 0);
    reference_tangent(&self->gait, input, along.phi, along.v, along.ubar);
    return along;
}

// out = G (c_v v + c_ubar ubar)
static void gram(const plant *self, double c_v, const double *v, double c_ubar, const double *ubar, double *out)
{
    double *sum = triple_at(self, 2).phi;
    for (int i = 0; i < self->n; i++)
        sum[i] = c_v * v[i] + c_ubar * ubar[i];
    shape_gram_inverse(self->n + 1, sum, out);
}

static void force_jacobian(const plant *self, double *values, int stride)
{
    const triple product = triple_at(self, 1);
    for (int k = 0; k < GAIT_INPUTS; k++) {
        const triple along = tangent(self, k);
        shape_a_dbar_transposed(self->n + 1, along.phi, product.phi);
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
    for (int k = 0; k < GAIT_INPUTS; k++) {
        const double *phi = tangent(self, k).phi;
        for (int i = 0; i <= n; i++)
            if (moves_link(self, k, i))
                *values++ = self->half_inverse_L * ((i > 0 ? phi[i - 1] : 0) + (i < n ? phi[i] : 0));
    }
    return values;
}

static void angle_pattern(const plant *self, entries *list)
{
    for (int k = 0; k < GAIT_INPUTS; k++)
        for (int i = 0; i <= self->n; i++)
            if (moves_link(self, k, i))
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
    shape_a_dbar(N, sum, product);
    aa_transposed(n, along.phi, out.phi);
    for (int i = 0; i < n; i++)
        out.phi[i] = 2 * g[FEATURE_Q] * out.phi[i] + product[i];
    shape_a_dbar_transposed(N, along.phi, product);
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
    reference_hessian(&self->gait, self->on_phi, self->on_v, self->on_ubar, values);
    for (int k = 0; k < GAIT_INPUTS; k++) {
        double by_all[GAIT_INPUTS];
        const triple row = curvature_along(self, g, weight[self->power], tangent(self, k));
        reference_gradient(&self->gait, row.phi, row.v, row.ubar, by_all);
        for (int j = 0; j <= k; j++)
            *values++ += by_all[j];
    }
}

const plant_form plant_on_gait = {
    .shape = shape,
    .pull_back = pull_back,
    .force_jacobian = force_jacobian,
    .angle_jacobian = angle_jacobian,
    .angle_pattern = angle_pattern,
    .hessian = hessian,
};
