// SPDX-License-Identifier: MIT
//
// Data that move over the mesh because a time of their phase is free. Each has variables x and u of its own and rows
// that make them those of the polynomials of one interval at sigma = ((t_k - t0) / T - tau) / w:
//   x_k - x_first - T w sum_j I_j(sigma) f_j = 0,   u_k - sum_j ell_j(sigma) u_j = 0.
// The interval is the one into which the datum falls where the mesh says that the phase is.
#ifndef SRC_OCP_SIGHT_H
#define SRC_OCP_SIGHT_H

#include "ocp/transcription.h"

// Chooses intervals and takes columns and rows; nothing where no data move. Error: MORAY_MEMORY.
moray_status moray_place_sights(struct layout *layout, struct phase_layout *phase, const struct phase *p);

// The rows at the current point, their entries of the Jacobian, what they add to the multipliers of f, and, beside what
// those make of it, to the Lagrangian's gradient.
void moray_assemble_sights(const struct transcription *t, int p, double *g);
void moray_walk_sights(const struct transcription *t, int p, triplets *out);
void moray_add_sights_to_dynamics(const struct transcription *t, int p, const double *lambda, double *lambda_f);
void moray_add_sights(const struct transcription *t, int p, const double *lambda, double *gradient);

// by_time[nodes][2][nx]: what the free times, through sigma, make of f at a node: d2 L / d t0 d f, d2 L / d tf d f.
void moray_sights_by_time(const struct transcription *t, int p, const double *lambda, double *by_time);

// The rest of their second derivatives: by the times alone, and with controls.
void moray_bend_sights(const struct transcription *t, int p, const double *lambda, triplets *out);

// Sets what belongs to rows or columns, of size[nx + nu], where `of_rows` or not.
void moray_fill_sights(const struct phase_layout *layout, const struct phase *phase, const double *size, bool of_rows,
                       double *filled);

// Whether data have left their intervals at the current point; then the meshes, one a phase, say where the phases are.
bool moray_sights_left(const struct transcription *t, struct mesh *meshes);

// Largest distance of what is seen to the trajectory's polynomials at the time, in size[nx + nu].
double moray_sight_error(const struct transcription *t, int p, int k, const double *x, const double *u,
                         const double *size);

#endif
