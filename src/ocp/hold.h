// SPDX-License-Identifier: MIT
//
// Controls that are held: constant over each of the intervals that the phase gives, however these are cut by meshes.
// Where a node is not the first of its hold, rows u - u of the node before say so, and only the first has bounds.
#ifndef SRC_OCP_HOLD_H
#define SRC_OCP_HOLD_H

#include "ocp/transcription.h"

bool moray_is_held(const struct phase *phase, int control);
bool moray_holds_at(const struct phase *phase, double tau); // whether a hold begins or ends there

// Fills node.before. Error: MORAY_INPUT where the scheme has nodes on both sides of a jump, or the mesh no edge there.
moray_status moray_link_holds(struct phase_layout *layout, const struct phase *phase);

// The rows at the current point, their entries of the Jacobian, and what they add to the Lagrangian's gradient.
void moray_assemble_holds(const struct transcription *t, int p, double *g);
void moray_walk_holds(const struct transcription *t, int p, triplets *out);
void moray_add_holds(const struct transcription *t, int p, const double *lambda, double *gradient);

// Sets what belongs to the rows, of control[nu].
void moray_fill_holds(const struct phase_layout *layout, const struct phase *phase, const double *control, double *row);

void moray_guess_holds(const struct transcription *t, int p, double *x); // as at the first node of each hold

#endif
