// SPDX-License-Identifier: MIT
//
// What the functions do between the nodes where no node can tell: the optimality conditions at the nodes know nothing
// of a control that acts, or of a cost that a state has, only there. On every interval the effects that the nodes have
// are interpolated as the scheme does, and compared at many points with those that are found there.
#ifndef SRC_OCP_UNSEEN_H
#define SRC_OCP_UNSEEN_H

#include "ocp/refinement/examine.h"

// Effects: along states and parameters, and of controls put in place of those at hand.
enum { along_states, low_control, high_control, MORAY_UNSEEN_KINDS };

// The phase of an examiner, with room for its effects.
struct unseen {
    struct examiner *e;
    int kinds;               // of effects that there are
    double *costate, *price; // [nodes][nx]; [n_out] what outputs cost on the interval at hand
    double *control[2];      // [nu]: the least and the largest that are tried along the whole phase
    double *direction;       // [n_in]: of states and parameters
    double *at_nodes;        // [MORAY_UNSEEN_KINDS][points][n_out] effects at the nodes of the interval at hand
    double *spread[MORAY_UNSEEN_KINDS]; // [n_out]: how far those differ
    double *here, *moved, *told;        // [n_out] each
    double *state, *last;               // [nx]: at the point at hand and at the one before it, if any
    double *before, *half, *end;        // [nx] each, in between
    bool begun;
};

// Error: MORAY_MEMORY. The examiner must last.
moray_status moray_unseen_new(struct unseen *u, struct examiner *e);
void moray_unseen_free(struct unseen *u);

// What an interval, the next one, has of effects that its nodes do not tell, at most, in parts of the objective;
// *where: tau in the interval, 0..1, of the largest. *jumps (NULL: not asked): what functions jump by as states move on
// since the last point of the interval before, over the whole phase: derivatives on either side know nothing of when
// that is.
double moray_unseen_interval(struct unseen *u, const struct interval *interval, double objective, double *jumps,
                             double *where);
#endif
