// SPDX-License-Identifier: MIT
//
// Observations of a phase: what is asked of them, and their places on a mesh.
#ifndef SRC_OCP_OBSERVED_H
#define SRC_OCP_OBSERVED_H

#include "ocp/layout.h"

// Error: MORAY_INPUT naming what is missing, not a number or outside of the phase.
moray_status moray_check_observations(const struct phase *phase, const moray_observations *given);

// Gives the mesh an edge at every observed time: moves one that is near, or cuts an interval. Error: MORAY_MEMORY.
moray_status moray_cut_at_observations(struct mesh *mesh, const struct phase *phase);

bool moray_is_observed_at(const struct phase *phase, double tau);

// Narrows the times of the phase so that it holds its data.
void moray_hold_observations(struct phase *phase, const moray_observations *given);

// Whether they move over the mesh, because a time of the phase is free: see sight.h.
bool moray_data_move(const struct phase *phase);

// What bounds residuals and their sum: how many events, bounds of the i-th and its time k and channel j; k = n for the
// sum.
int moray_observed_events(const struct observed *observed);
moray_bounds moray_observed_event(const struct observed *observed, int i, int *k, int *j);
bool moray_has_residual_event(const struct observed *observed, int k, int j);

// The node of the k-th time of phase p.
const struct node *moray_observed_node(const struct layout *layout, const moray_ocp *ocp, int p, int k);

#endif
