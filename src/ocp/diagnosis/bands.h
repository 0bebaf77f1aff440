// SPDX-License-Identifier: MIT
//
// Columns and rows of the programme that are one thing to the user: a state, control, path constraint or the dynamics
// of a state at all nodes of a phase, or a single integral, its definition, a time, parameter or event.
#ifndef SRC_OCP_BANDS_H
#define SRC_OCP_BANDS_H

#include "ocp/solution.h"

struct band {
    enum { band_state, band_control, band_path, band_dynamics, band_single } kind;
    bool rows; // of the constraints, else columns
    int p;     // phase; -1 for singles
    int index; // of the state, ...; column or row of a single
};

// Calls visit for every band, in the order of phases, then singles.
void moray_visit_bands(const struct transcription *t, void (*visit)(const struct band *band, void *self), void *self);

// Members are numbered by node, those of dynamics from the second; a member's column or row, or -1 where it has none at
// this node.
int moray_band_members(const struct transcription *t, const struct band *band);
int moray_band_member(const struct transcription *t, const struct band *band, int n);

// "control u of phase cart"
void moray_band_name(const moray_solution *solution, const struct band *band, char *text, int size);

// Which bounds a member is at, by its scaled distance: value, bounds and scale of a column or row.
struct standing {
    double value, lower, upper, scale;
    bool fixed, at_lower, at_upper;
};
struct standing moray_standing_of(const moray_solution *solution, bool row, int i);

#endif
