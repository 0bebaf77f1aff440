// SPDX-License-Identifier: MIT
//
// The entries in the order in which plant_map.c writes their values.
#include "snake/plant/plant.h"

static void add_lower(entries *list, int row, int col)
{
    add_entry(list, row > col ? row : col, row > col ? col : row);
}

static int body_col(const plant *self, int input)
{
    return input == BODY_THETA ? self->theta : self->v_theta + input;
}

// (23b)-(23d), (23f)
static void heading_pattern(const plant *self, entries *list)
{
    const int theta = self->theta, v_theta = self->v_theta;
    add_entry(list, theta, v_theta);
    for (int row = theta + 1; row <= theta + 2; row++)
        for (int b = 0; b < BODY_INPUTS; b++)
            add_entry(list, row, body_col(self, b));
    add_entry(list, v_theta, theta);
    add_entry(list, v_theta, body_col(self, BODY_V_T));
    add_entry(list, v_theta, v_theta);
    for (int k = 0; k < self->n_s; k++)
        add_entry(list, v_theta, self->col[k]);
}

static void full_row(const plant *self, entries *list, int row)
{
    for (int k = 0; k < self->n_shape; k++)
        add_entry(list, row, self->col[k]);
    for (int b = 0; b < BODY_INPUTS; b++)
        add_entry(list, row, body_col(self, b));
}

void moray_plant_jacobian_pattern(const plant *self, entries *list)
{
    if (self->form->joint_rates_pattern)
        self->form->joint_rates_pattern(self, list);
    heading_pattern(self, list);
    for (int row = self->v_theta + 1; row <= self->v_theta + 2; row++) {
        full_row(self, list, row);
        if (self->body.frame != 0)
            add_entry(list, row, self->v_theta);
    }
    if (self->forces >= 0)
        for (int i = 0; i < self->n; i++)
            full_row(self, list, self->forces + i);
    if (self->angles >= 0)
        self->form->angle_pattern(self, list);
    full_row(self, list, self->power);
}

void moray_plant_hessian_pattern(const plant *self, entries *list)
{
    const int *col = self->col;
    for (int i = 0; i < self->n_shape; i++)
        for (int j = 0; j < self->n_curved && j <= i; j++)
            add_lower(list, col[i], col[j]);
    if (self->form->last_hessian_pattern)
        self->form->last_hessian_pattern(self, list);
    for (int b = 0; b < BODY_INPUTS; b++)
        for (int k = 0; k < self->n_curved; k++)
            add_lower(list, body_col(self, b), col[k]);
    for (int b = 0; b < BODY_INPUTS; b++)
        add_entry(list, body_col(self, b), self->theta);
    for (int b = BODY_V_T; b <= BODY_V_N && self->body.frame != 0; b++)
        add_entry(list, body_col(self, b), self->v_theta);
}
