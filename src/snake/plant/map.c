// SPDX-License-Identifier: MIT
//
// The three callbacks. The order of the values is that of plant_pattern.c.
#include "snake/plant/plant.h"

#include <string.h>

#include "snake/model/shape.h"

void moray_plant_value(void *context, const double *in, double *out)
{
    plant *self = context;
    moray_plant_to_values(self, in);
    const int n = self->n;
    if (self->form->joint_rates)
        self->form->joint_rates(self, out);
    moray_body_rates(&self->body, &self->at, in[self->v_theta], out + self->theta, out + self->v_theta);
    if (self->forces >= 0)
        memcpy(out + self->forces, self->u, (size_t)n * sizeof *out);
    if (self->angles >= 0)
        for (int i = 0; i <= n; i++) // (12)
            out[self->angles + i] =
                self->half_inverse_L * ((i > 0 ? self->phi[i - 1] : 0) + (i < n ? self->phi[i] : 0));
    out[self->power] = dot(n, self->u, self->v_phi);
}

static double *put(double *values, int n, const double *from)
{
    memcpy(values, from, (size_t)n * sizeof *from);
    return values + n;
}

// (23b)-(23d), (23f)
static double *heading_jacobian(const plant *self, double *values)
{
    const body_point *at = &self->at;
    const double turning = self->body.turning, s = at->y[FEATURE_S], v_tr = at->v_tr;
    const double head[] = {
        1,
        -at->v_t * at->sine - at->v_n * at->cosine,
        at->cosine,
        -at->sine,
        at->v_t * at->cosine - at->v_n * at->sine,
        at->sine,
        at->cosine,
        turning * s * at->tr_b[BODY_THETA],
        turning * s * at->tr_b[BODY_V_T],
        -self->body.damping,
    };
    values = put(values, sizeof head / sizeof *head, head);
    for (int k = 0; k < self->n_s; k++)
        *values++ = turning * v_tr * self->y_x[FEATURE_S][k];
    return values;
}

static double *force_jacobian(plant *self, double *values)
{
    const int n_shape = self->n_shape, stride = n_shape + BODY_INPUTS;
    self->form->force_jacobian(self, values, stride);
    for (int i = 0; i < self->n; i++, values += stride) {
        const double bt_phi = self->bt_phi[i];
        for (int k = 0; k < n_shape; k++)
            values[k] += bt_phi * self->kappa_x[k];
        for (int b = 0; b < BODY_INPUTS; b++)
            values[n_shape + b] = bt_phi * self->at.kappa_b[b];
    }
    return values;
}

// Power = v_phi . g_load + kappa w.
static void power_jacobian(const plant *self, double *values)
{
    const double w = self->at.y[FEATURE_W], kappa = self->at.kappa, *w_x = self->y_x[FEATURE_W];
    for (int k = 0; k < self->n_shape; k++)
        *values++ = self->load_x[k] + kappa * w_x[k] + w * self->kappa_x[k];
    for (int b = 0; b < BODY_INPUTS; b++)
        *values++ = w * self->at.kappa_b[b];
}

// Row of dv_t or dv_n: by the shape, theta, v_t, v_n and, where the frame turns, by v_theta; turning holds the
// derivatives of what the frame adds by v_theta, v_t, v_n.
static double *acceleration_jacobian(const plant *self, const double *by_shape, const double *by_body,
                                     const double turning[3], double *values)
{
    values = put(values, self->n_shape, by_shape);
    values = put(values, BODY_INPUTS, by_body);
    if (self->body.frame == 0)
        return values;
    values[-2] += turning[1];
    values[-1] += turning[2];
    *values++ = turning[0];
    return values;
}

void moray_plant_jacobian(void *context, const double *in, double *values)
{
    plant *self = context;
    moray_plant_to_gradients(self, in);
    if (self->form->joint_rates_jacobian)
        values = self->form->joint_rates_jacobian(self, values);
    values = heading_jacobian(self, values);
    const double v_theta = in[self->v_theta];
    values = acceleration_jacobian(self, self->dv_t_x, self->at.dv_t_b, (double[]){self->at.v_n, 0, v_theta}, values);
    values = acceleration_jacobian(self, self->dv_n_x, self->at.dv_n_b, (double[]){-self->at.v_t, -v_theta, 0}, values);
    if (self->forces >= 0)
        values = force_jacobian(self, values);
    if (self->angles >= 0)
        values = self->form->angle_jacobian(self, values);
    power_jacobian(self, values);
}

// The weighted sum is, besides what plant_form.joint_rates adds,
//     lambda . body rates + kappa bend + power_weight v_phi . g_load + (G lambda_u) . (mt ubar + c_n v_phi) + angles
// with bend = power_weight w + (B lambda_u) . phi. Returns bend; b_lambda, g_lambda, bend_x are set.
static double bending(plant *self, const double *lambda_u, double power_weight)
{
    const int n = self->n, N = n + 1;
    for (int k = 0; k < self->n_shape; k++)
        self->bend_x[k] = power_weight * self->y_x[FEATURE_W][k];
    if (!lambda_u)
        return power_weight * self->at.y[FEATURE_W];
    moray_shape_a_dbar(N, lambda_u, self->b_lambda);
    moray_shape_gram_inverse(N, lambda_u, self->g_lambda);
    self->form->pull_back(self, self->b_lambda, self->zeros, self->zeros, self->a_x);
    for (int k = 0; k < self->n_shape; k++)
        self->bend_x[k] += self->a_x[k];
    return power_weight * self->at.y[FEATURE_W] + dot(n, lambda_u, self->bt_phi);
}

// Gradient of the weighted sum by the shape vectors; g by the features.
static void gradient_on_shape(plant *self, const double g[FEATURES], double power_weight, const double *lambda_angles)
{
    const double mt = self->body.mt, c_n = self->body.c_n;
    for (int i = 0; i < self->n; i++) {
        const double load = power_weight * self->g_v[i] + self->g_lambda[i];
        self->on_phi[i] = g[FEATURE_S] + 2 * g[FEATURE_Q] * self->aa_phi[i] + g[FEATURE_W] * self->b_v[i] +
                          g[FEATURE_Z] * self->b_ubar[i] + self->at.kappa * self->b_lambda[i];
        self->on_v[i] = g[FEATURE_W] * self->bt_phi[i] + power_weight * self->g_load[i] + c_n * load;
        self->on_ubar[i] = g[FEATURE_Z] * self->bt_phi[i] + mt * load;
    }
    if (lambda_angles)
        for (int i = 0; i < self->n; i++)
            self->on_phi[i] += self->half_inverse_L * (lambda_angles[i] + lambda_angles[i + 1]);
}

// Adds grad s v a + grad kappa v grad bend over the pairs that plant_form.hessian has written; returns the place behind
// them.
static double *add_rank_terms(const plant *self, double *values)
{
    const double *restrict s = self->y_x[FEATURE_S], *restrict a = self->a_x;
    const double *restrict kappa = self->kappa_x, *restrict bend = self->bend_x;
    for (int i = 0; i < self->n_curved; i++) {
        for (int j = 0; j <= i; j++)
            values[j] += s[i] * a[j] + a[i] * s[j] + kappa[i] * bend[j] + bend[i] * kappa[j];
        values += i + 1;
    }
    for (int i = self->n_curved; i < self->n_shape; i++, values += self->n_curved)
        for (int j = 0; j < self->n_curved; j++)
            values[j] += a[i] * s[j] + kappa[i] * bend[j];
    return values + self->n_last;
}

static void body_hessian(const plant *self, const body_curvature *second, const body_weights *weight, double *values)
{
    const double *s = self->y_x[FEATURE_S], *q = self->y_x[FEATURE_Q], *bend = self->bend_x;
    for (int b = 0; b < BODY_INPUTS; b++) {
        const double a_b = second->a_b[b], e_b = second->e_b[b], kappa_b = self->at.kappa_b[b];
        for (int k = 0; k < self->n_curved; k++)
            *values++ = a_b * s[k] + e_b * q[k] + kappa_b * bend[k];
    }
    values = put(values, BODY_INPUTS, second->bb);
    if (self->body.frame == 0)
        return;
    *values++ = -weight->dv_n; // theta' v_t
    *values = weight->dv_t;    // theta' v_n
}

void moray_plant_hessian(void *context, const double *in, const double *weight, double *values)
{
    plant *self = context;
    moray_plant_to_gradients(self, in);
    const double power_weight = weight[self->power];
    const double *lambda_u = self->forces >= 0 ? weight + self->forces : NULL;
    const double *lambda_angles = self->angles >= 0 ? weight + self->angles : NULL;
    const body_weights body_weight = {.dp_x = weight[self->theta + 1],
                                      .dp_y = weight[self->theta + 2],
                                      .dv_theta = weight[self->v_theta],
                                      .dv_t = weight[self->v_theta + 1],
                                      .dv_n = weight[self->v_theta + 2],
                                      .bend = bending(self, lambda_u, power_weight)};
    body_curvature second = moray_body_second(&self->body, &self->at, &body_weight);
    second.g[FEATURE_W] += self->at.kappa * power_weight;
    gradient_on_shape(self, second.g, power_weight, lambda_angles);
    self->form->hessian(self, second.g, weight, values);
    for (int k = 0; k < self->n_shape; k++)
        self->a_x[k] = second.a_dv_t * self->dv_t_x[k] + second.a_dv_n * self->dv_n_x[k];
    body_hessian(self, &second, &body_weight, add_rank_terms(self, values));
}
