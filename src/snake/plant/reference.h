// SPDX-License-Identifier: MIT
//
// The gait (25) and its time derivatives as functions of p = (a, omega, delta, phi_0, taper, t, phi_0', phi_0''), with
// first and second derivatives: phi_i = a_i sin(omega t + (i-1) delta) + phi_0, v_i = a_i omega cos(..) + phi_0',
// acc_i = -a_i omega^2 sin(..) + phi_0'', where a_i = a (1 + taper s_i). With a constant offset the first six are all.
#ifndef SRC_SNAKE_PLANT_REFERENCE_H
#define SRC_SNAKE_PLANT_REFERENCE_H

enum { GAIT_A, GAIT_OMEGA, GAIT_DELTA, GAIT_PHI_0, GAIT_TAPER, GAIT_T, GAIT_INPUTS };
enum { GAIT_DPHI_0 = GAIT_INPUTS, GAIT_DDPHI_0, GAIT_KINDS };
enum { GAIT_PAIRS = GAIT_INPUTS * (GAIT_INPUTS + 1) / 2 }; // lower triangle by rows

typedef struct reference {
    int n;                         // joints
    double a, omega, t, offset[3]; // phi_0 and its derivatives
    double *sine, *cosine;         // of omega t + (i-1) delta
    double *place, *growth;        // s_i, 1 + taper s_i; all n each, the owner's memory
} reference;

void moray_reference_set(reference *at, const double p[GAIT_KINDS]);

// phi, v, acc: n each
void moray_reference_values(const reference *at, double *phi, double *v, double *acc);

// Derivatives of phi, v, acc by p[input].
void moray_reference_tangent(const reference *at, int input, double *phi, double *v, double *acc);

// Gradient by p and weighted second derivatives by the first GAIT_INPUTS, on which alone they depend, of
// on_phi . phi + on_v . v + on_acc . acc.
void moray_reference_gradient(const reference *at, const double *on_phi, const double *on_v, const double *on_acc,
                              double gradient[GAIT_KINDS]);
void moray_reference_hessian(const reference *at, const double *on_phi, const double *on_v, const double *on_acc,
                             double hessian[GAIT_PAIRS]);

#endif
