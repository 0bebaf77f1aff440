// SPDX-License-Identifier: MIT
//
// The control-oriented model as a map. Its outputs depend on the shape vectors phi, v_phi, ubar only through the
// features of control_body.h and through forms linear or quadratic in them, so all joint forms share everything but the
// shape vectors as functions of the inputs: a plant_form. "Shape inputs" are the inputs these vectors depend on: phi,
// v_phi and (closed loop) the gait parameters and t or (free) ubar; on the gait only the parameters and t, steered
// phi_0' and phi_0'' too. B = A Dbar and G = (D D^T)^{-1} throughout.
#ifndef SRC_SNAKE_PLANT_PLANT_H
#define SRC_SNAKE_PLANT_PLANT_H

#include <stddef.h>

#include "snake/model/control_body.h"
#include "snake/plant/reference.h"

typedef struct plant plant;

// Gathers the entries of a pattern; with into NULL only counts them.
typedef struct entries {
    int count;
    moray_pattern *into;
} entries;

static inline void add_entry(entries *list, int row, int col)
{
    if (list->into) {
        list->into->row[list->count] = row;
        list->into->col[list->count] = col;
    }
    list->count++;
}

// Functions returning double * write from `values` on and return the place behind what they wrote; the pattern
// functions list the same entries in the same order.
typedef struct plant_form {
    // Sets phi, v_phi, ubar from self->in.
    void (*shape)(plant *self);
    // What the functions below need besides; once a point.
    void (*tangents)(plant *self);
    // Gradient by the shape inputs of a scalar with gradient on_phi, on_v, on_ubar by the shape vectors.
    void (*pull_back)(const plant *self, const double *on_phi, const double *on_v, const double *on_ubar, double *out);

    // State derivatives of the joints or their offset, their Jacobian rows.
    void (*joint_rates)(const plant *self, double *out);
    double *(*joint_rates_jacobian)(const plant *self, double *values);
    void (*joint_rates_pattern)(const plant *self, entries *list);

    // Writes the derivatives of kappa B^T phi + g_load by the shape inputs, kappa held, to n rows `stride` apart.
    void (*force_jacobian)(const plant *self, double *values, int stride);

    // Rows of the link angles (12).
    double *(*angle_jacobian)(const plant *self, double *values);
    void (*angle_pattern)(const plant *self, entries *list);

    // Second derivatives of the weighted sum by pairs of shape inputs, save the terms of rank one that plant_map.c
    // adds: those by the shape vectors are
    //     phi phi: 2 g_q A A^T   phi v: g_w B   phi ubar: g_z B   v v: 2 c_n lambda G   v ubar: mt lambda G
    // with the weight lambda of the power, and its gradient by the shape vectors is self->on_phi, on_v, on_ubar.
    // Order: the lower triangle of the first n_curved inputs, the others by these, n_last among the others.
    void (*hessian)(const plant *self, const double g[FEATURES], const double *weight, double *values);
    void (*last_hessian_pattern)(const plant *self, entries *list);
} plant_form;

extern const plant_form moray_plant_on_gait, moray_plant_steered, moray_plant_closed_loop, moray_plant_free;

typedef enum { AT_NOTHING, AT_VALUES, AT_GRADIENTS } plant_level;

enum { WORK_VECTORS = 8 };

struct plant {
    const plant_form *form;
    control_body body;
    int n;             // joints, N-1
    bool joint_states; // the joints are states
    int n_in, n_out;
    int n_shape, n_s, n_curved; // shape inputs; how many first ones move s, and phi or v_phi
    int n_last;                 // second derivatives among the shape inputs behind n_curved
    int theta, v_theta;         // places in the state; p_x, p_y and v_t, v_n follow
    int rest;                   // place of the first input behind the state
    int offset;                 // place of phi_0 in the steered state; phi_0' and, the control, phi_0'' follow
    int forces, angles, power;  // places of the outputs; forces, angles -1 where not wanted
    double half_inverse_L;      // 1 / (2 L) of (12)
    double k_p, k_d;            // of (34); zero where ubar is an input
    int *col;                   // places of the shape inputs
    double *b_columns, *g;      // B^T and G by rows, n x n; joints as states only
    double *zeros, *ones;       // n each

    // The point last seen and what is known there.
    plant_level level;
    double *in;
    double *phi, *v_phi, *ubar; // n each
    reference gait;
    const int *kind;            // of the shape inputs, on the gait
    double *bt_phi, *aa_phi;    // B^T phi, A A^T phi
    double *g_load, *u;         // G (mt ubar + c_n v_phi), joint forces (22)
    double *b_v, *b_ubar, *g_v; // B v_phi, B ubar, G v_phi
    body_point at;
    double *y_x[FEATURES], *load_x;    // gradients by the shape inputs: of the features, of v_phi . g_load,
    double *dv_t_x, *dv_n_x, *kappa_x; // and of these
    double *tangent;                   // the form's, n each
    double *b_tangent, *g_tangent;     // B and G times these

    // Scratch.
    double *on_phi, *on_v, *on_ubar, *b_lambda, *g_lambda; // n each
    double *a_x, *bend_x;                                  // n_shape each
    double *work;                                          // WORK_VECTORS of n
    double memory[];
};

void moray_plant_to_values(plant *self, const double *in);
void moray_plant_to_gradients(plant *self, const double *in);
void moray_plant_jacobian_pattern(const plant *self, entries *list);
void moray_plant_hessian_pattern(const plant *self, entries *list);
void moray_plant_value(void *self, const double *in, double *out);
void moray_plant_jacobian(void *self, const double *in, double *values);
void moray_plant_hessian(void *self, const double *in, const double *weight, double *values);

static inline double dot(int n, const double *x, const double *y)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += x[i] * y[i];
    return sum;
}

// out = A A^T v
static inline void aa_transposed(int n, const double *v, double *out)
{
    for (int i = 0; i < n; i++)
        out[i] = 2 * v[i] + (i > 0 ? v[i - 1] : 0) + (i + 1 < n ? v[i + 1] : 0);
}

#endif
