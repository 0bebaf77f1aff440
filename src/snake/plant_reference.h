// SPDX-License-Identifier: MIT
//
// The gait (25) and its time derivatives as functions of p = (a, omega, delta, phi_0, t, phi_0', phi_0''), with first
// and second derivatives: phi_i = a sin(omega t + (i-1) delta) + phi_0, v_i = a omega cos(..) + phi_0',
// acc_i = -a omega^2 sin(..) + phi_0''. With a constant offset the first five are all.
#ifndef MORAY_SNAKE_PLANT_REFERENCE_H
#define MORAY_SNAKE_PLANT_REFERENCE_H

enum { GAIT_A, GAIT_OMEGA, GAIT_DELTA, GAIT_PHI_0, GAIT_T, GAIT_INPUTS };
enum { GAIT_DPHI_0 = GAIT_INPUTS, GAIT_DDPHI_0, STEERED_INPUTS };
enum { GAIT_PAIRS = GAIT_INPUTS * (GAIT_INPUTS + 1) / 2 }; // lower triangle by rows

typedef struct reference {
    int n;                         // joints
    int n_inputs;                  // GAIT_INPUTS or STEERED_INPUTS
    double a, omega, t, offset[3]; // phi_0 and its derivatives
    double *sine, *cosine;         // of omega t + (i-1) delta, n each; the owner's memory
} reference;

void reference_set(reference *at, const double *p); // p[n_inputs]

// phi, v, acc: n each
void reference_values(const reference *at, double *phi, double *v, double *acc);

// Derivatives of phi, v, acc by p[input].
void reference_tangent(const reference *at, int input, double *phi, double *v, double *acc);

// Gradient by p[n_inputs] and weighted second derivatives by the first five, on which alone they depend, of
// on_phi . phi + on_v . v + on_acc . acc.
void reference_gradient(const reference *at, const double *on_phi, const double *on_v, const double *on_acc,
                        double *gradient);
void reference_hessian(const reference *at, const double *on_phi, const double *on_v, const double *on_acc,
                       double hessian[GAIT_PAIRS]);

#endif
