// SPDX-License-Identifier: MIT
//
// Joints as states: the shape inputs are phi, v_phi and behind them what steers the joints, the gait's parameters and t
// through (34) or ubar itself. Either way ubar = R(steering) - k_p phi - k_d v_phi; `tangent` holds the derivatives of
// R by rows, save in the free form, where they are the unit vectors.
#include "snake/plant/plant.h"

#include <string.h>

#include "snake/model/shape.h"
#include "snake/model/taper.h"

static int steering_inputs(const plant *self)
{
    return self->n_shape - self->n_curved;
}

static void joint_rates(const plant *self, double *out)
{
    const size_t size = (size_t)self->n * sizeof *out;
    memcpy(out, self->v_phi, size);                  // (23a)
    memcpy(out + self->theta + 3, self->ubar, size); // (23e)
}

// dphi_i by v_phi,i
static double *positions_jacobian(const plant *self, double *values)
{
    for (int i = 0; i < self->n; i++)
        *values++ = 1;
    return values;
}

static void positions_pattern(const plant *self, entries *list)
{
    for (int i = 0; i < self->n; i++)
        add_entry(list, i, self->col[self->n + i]);
}

static void force_jacobian(const plant *self, double *values, int stride)
{
    const int n = self->n;
    const double kappa = self->at.kappa, mt = self->body.mt;
    const double by_phi = -self->k_p * mt, by_v = self->body.c_n - self->k_d * mt;
    for (int i = 0; i < n; i++, values += stride) {
        const double *restrict b = self->b_columns + i * n, *restrict g = self->g + i * n;
        for (int j = 0; j < n; j++) {
            values[j] = kappa * b[j] + by_phi * g[j];
            values[n + j] = by_v * g[j];
        }
        for (int k = 0; k < steering_inputs(self); k++)
            values[2 * n + k] = mt * self->g_tangent[k * n + i];
    }
}

static double *angle_jacobian(const plant *self, double *values)
{
    for (int k = 0; k < 2 * self->n; k++)
        *values++ = self->half_inverse_L;
    return values;
}

static void angle_pattern(const plant *self, entries *list)
{
    for (int i = 0; i < self->n; i++) {
        add_entry(list, self->angles + i, self->col[i]);
        add_entry(list, self->angles + i + 1, self->col[i]);
    }
}

// With ubar = R - k_p phi - k_d v_phi inserted; B + B^T has the entries 2 - 2 (i + j) / N for i, j = 1..N-1.
static double *hessian_of_joints(const plant *self, const double g[FEATURES], double power_weight, double *values)
{
    const int n = self->n;
    const double c = -self->k_p * g[FEATURE_Z], mt = power_weight * self->body.mt;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++)
            values[j] = c * (2 - 2 * (i + j + 2) / self->body.N);
        values[i] += 4 * g[FEATURE_Q];
        if (i > 0)
            values[i - 1] += 2 * g[FEATURE_Q];
        values += i + 1;
    }
    const double by_b = g[FEATURE_W] - self->k_d * g[FEATURE_Z], by_g = -self->k_p * mt;
    const double by_gg = 2 * (power_weight * self->body.c_n - self->k_d * mt);
    for (int i = 0; i < n; i++) {
        const double *restrict b = self->b_columns + i * n, *restrict gram = self->g + i * n;
        for (int j = 0; j < n; j++)
            values[j] = by_b * b[j] + by_g * gram[j];
        for (int j = 0; j <= i; j++)
            values[n + j] = by_gg * gram[j];
        values += n + i + 1;
    }
    return values;
}

static double *hessian_of_steering(const plant *self, const double g[FEATURES], double power_weight, double *values)
{
    const int n = self->n;
    const double mt = power_weight * self->body.mt;
    for (int k = 0; k < steering_inputs(self); k++, values += 2 * n)
        for (int j = 0; j < n; j++) {
            values[j] = g[FEATURE_Z] * self->b_tangent[k * n + j];
            values[n + j] = mt * self->g_tangent[k * n + j];
        }
    return values;
}

// ---- Steered by the gait -----------------------------------------------------------------------------------------

static void closed_loop_shape(plant *self)
{
    const int n = self->n;
    double *phi_ref = self->work, *v_ref = phi_ref + n, p[GAIT_KINDS] = {0};
    memcpy(p, self->in + self->rest, GAIT_INPUTS * sizeof *p);
    moray_reference_set(&self->gait, p);
    moray_reference_values(&self->gait, phi_ref, v_ref, self->ubar);
    for (int i = 0; i < n; i++) // (34)
        self->ubar[i] += self->k_d * (v_ref[i] - self->v_phi[i]) + self->k_p * (phi_ref[i] - self->phi[i]);
}

static void closed_loop_tangents(plant *self)
{
    const int n = self->n;
    double *phi = self->work, *v = phi + n;
    for (int k = 0; k < GAIT_INPUTS; k++) {
        double *R = self->tangent + k * n;
        moray_reference_tangent(&self->gait, k, phi, v, R);
        for (int i = 0; i < n; i++)
            R[i] += self->k_d * v[i] + self->k_p * phi[i];
    }
}

static void closed_loop_pull_back(const plant *self, const double *on_phi, const double *on_v, const double *on_ubar,
                                  double *out)
{
    const int n = self->n;
    for (int i = 0; i < n; i++) {
        out[i] = on_phi[i] - self->k_p * on_ubar[i];
        out[n + i] = on_v[i] - self->k_d * on_ubar[i];
    }
    for (int k = 0; k < GAIT_INPUTS; k++)
        out[2 * n + k] = dot(n, self->tangent + k * n, on_ubar);
}

// delta does not move the first joint, taper not one in the middle.
static bool moves_joint(const plant *self, int input, int joint)
{
    return input == GAIT_DELTA ? joint > 0 : input != GAIT_TAPER || taper_place(joint, self->n) != 0;
}

static double *closed_loop_rates_jacobian(const plant *self, double *values)
{
    const int n = self->n;
    values = positions_jacobian(self, values);
    for (int i = 0; i < n; i++) {
        *values++ = -self->k_p;
        *values++ = -self->k_d;
        for (int k = 0; k < GAIT_INPUTS; k++)
            if (moves_joint(self, k, i))
                *values++ = self->tangent[k * n + i];
    }
    return values;
}

static void closed_loop_rates_pattern(const plant *self, entries *list)
{
    const int n = self->n;
    positions_pattern(self, list);
    for (int i = 0; i < n; i++) {
        const int row = self->theta + 3 + i;
        add_entry(list, row, self->col[i]);
        add_entry(list, row, self->col[n + i]);
        for (int k = 0; k < GAIT_INPUTS; k++)
            if (moves_joint(self, k, i))
                add_entry(list, row, self->col[2 * n + k]);
    }
}

static void tangent_products(const plant *self)
{
    const int n = self->n;
    for (int k = 0; k < GAIT_INPUTS; k++) {
        moray_shape_a_dbar(n + 1, self->tangent + k * n, self->b_tangent + k * n);
        moray_shape_gram_inverse(n + 1, self->tangent + k * n, self->g_tangent + k * n);
    }
}

static void closed_loop_force_jacobian(const plant *self, double *values, int stride)
{
    tangent_products(self);
    force_jacobian(self, values, stride);
}

// R is linear in phi_0, and in a and in taper for themselves.
static bool curves(int input, int other)
{
    return input != GAIT_PHI_0 && other != GAIT_PHI_0 && (input != other || (input != GAIT_A && input != GAIT_TAPER));
}

static void closed_loop_hessian(const plant *self, const double g[FEATURES], const double *weight, double *values)
{
    const int n = self->n;
    double *on_phi = self->work, *on_v = on_phi + n, *on_acc = on_v + n, second[GAIT_PAIRS];
    tangent_products(self);
    values = hessian_of_joints(self, g, weight[self->power], values);
    values = hessian_of_steering(self, g, weight[self->power], values);
    for (int i = 0; i < n; i++) {
        on_acc[i] = self->on_ubar[i] + weight[self->theta + 3 + i];
        on_v[i] = self->k_d * on_acc[i];
        on_phi[i] = self->k_p * on_acc[i];
    }
    moray_reference_hessian(&self->gait, on_phi, on_v, on_acc, second);
    for (int k = 0, pair = 0; k < GAIT_INPUTS; k++)
        for (int j = 0; j <= k; j++, pair++)
            if (curves(k, j))
                *values++ = second[pair];
}

static void closed_loop_last_pattern(const plant *self, entries *list)
{
    const int *col = self->col + self->n_curved;
    for (int k = 0; k < GAIT_INPUTS; k++)
        for (int j = 0; j <= k; j++)
            if (curves(k, j))
                add_entry(list, col[k], col[j]);
}

const plant_form moray_plant_closed_loop = {
    .shape = closed_loop_shape,
    .tangents = closed_loop_tangents,
    .pull_back = closed_loop_pull_back,
    .joint_rates = joint_rates,
    .joint_rates_jacobian = closed_loop_rates_jacobian,
    .joint_rates_pattern = closed_loop_rates_pattern,
    .force_jacobian = closed_loop_force_jacobian,
    .angle_jacobian = angle_jacobian,
    .angle_pattern = angle_pattern,
    .hessian = closed_loop_hessian,
    .last_hessian_pattern = closed_loop_last_pattern,
};

// ---- Free --------------------------------------------------------------------------------------------------------

static void free_pull_back(const plant *self, const double *on_phi, const double *on_v, const double *on_ubar,
                           double *out)
{
    const size_t size = (size_t)self->n * sizeof *out;
    memcpy(out, on_phi, size);
    memcpy(out + self->n, on_v, size);
    memcpy(out + 2 * self->n, on_ubar, size);
}

static double *free_rates_jacobian(const plant *self, double *values)
{
    values = positions_jacobian(self, values);
    for (int i = 0; i < self->n; i++)
        *values++ = 1;
    return values;
}

static void free_rates_pattern(const plant *self, entries *list)
{
    positions_pattern(self, list);
    for (int i = 0; i < self->n; i++)
        add_entry(list, self->theta + 3 + i, self->col[2 * self->n + i]);
}

static void free_hessian(const plant *self, const double g[FEATURES], const double *weight, double *values)
{
    values = hessian_of_joints(self, g, weight[self->power], values);
    hessian_of_steering(self, g, weight[self->power], values);
}

const plant_form moray_plant_free = {
    .pull_back = free_pull_back,
    .joint_rates = joint_rates,
    .joint_rates_jacobian = free_rates_jacobian,
    .joint_rates_pattern = free_rates_pattern,
    .force_jacobian = force_jacobian,
    .angle_jacobian = angle_jacobian,
    .angle_pattern = angle_pattern,
    .hessian = free_hessian,
};
