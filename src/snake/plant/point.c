// SPDX-License-Identifier: MIT
#include "snake/plant/plant.h"

#include <string.h>

#include "snake/model/shape.h"

void moray_plant_to_values(plant *self, const double *in)
{
    const size_t size = (size_t)self->n_in * sizeof *in;
    if (self->level != AT_NOTHING && memcmp(in, self->in, size) == 0)
        return;
    memcpy(self->in, in, size);
    if (self->form->shape)
        self->form->shape(self);
    double y[FEATURES];
    moray_body_features(self->n + 1, self->phi, self->v_phi, self->ubar, self->bt_phi, y);
    const double body_in[BODY_INPUTS] = {in[self->theta], in[self->v_theta + 1], in[self->v_theta + 2]};
    moray_body_values(&self->body, y, body_in, &self->at);
    moray_body_joint_forces(&self->body, &self->at, self->v_phi, self->ubar, self->bt_phi, self->work, self->g_load,
                            self->u);
    self->level = AT_VALUES;
}

static void pull_back_features(plant *self)
{
    const int n = self->n;
    const plant_form *form = self->form;
    double *on_phi = self->on_phi, *on_v = self->on_v, *on_ubar = self->on_ubar;
    for (int i = 0; i < n; i++)
        on_phi[i] = 2 * self->aa_phi[i];
    form->pull_back(self, self->ones, self->zeros, self->zeros, self->y_x[FEATURE_S]);
    form->pull_back(self, on_phi, self->zeros, self->zeros, self->y_x[FEATURE_Q]);
    form->pull_back(self, self->b_v, self->bt_phi, self->zeros, self->y_x[FEATURE_W]);
    form->pull_back(self, self->b_ubar, self->zeros, self->bt_phi, self->y_x[FEATURE_Z]);
    for (int i = 0; i < n; i++) {
        on_v[i] = self->g_load[i] + self->body.c_n * self->g_v[i];
        on_ubar[i] = self->body.mt * self->g_v[i];
    }
    form->pull_back(self, self->zeros, on_v, on_ubar, self->load_x);
}

static void accelerations_by_shape(plant *self)
{
    const double *const *y_x = (const double *const *)self->y_x;
    const body_point *at = &self->at;
    for (int k = 0; k < self->n_shape; k++) {
        double dv_t = 0, dv_n = 0;
        for (int f = 0; f < FEATURES; f++) {
            dv_t += at->dv_t_y[f] * y_x[f][k];
            dv_n += at->dv_n_y[f] * y_x[f][k];
        }
        self->dv_t_x[k] = dv_t;
        self->dv_n_x[k] = dv_n;
        self->kappa_x[k] = self->body.mu_p * dv_t;
    }
}

void moray_plant_to_gradients(plant *self, const double *in)
{
    moray_plant_to_values(self, in);
    if (self->level == AT_GRADIENTS)
        return;
    const int N = self->n + 1;
    aa_transposed(N - 1, self->phi, self->aa_phi);
    moray_shape_a_dbar(N, self->v_phi, self->b_v);
    moray_shape_a_dbar(N, self->ubar, self->b_ubar);
    moray_shape_gram_inverse(N, self->v_phi, self->g_v);
    if (self->form->tangents)
        self->form->tangents(self);
    moray_body_gradients(&self->body, &self->at);
    pull_back_features(self);
    accelerations_by_shape(self);
    self->level = AT_GRADIENTS;
}
