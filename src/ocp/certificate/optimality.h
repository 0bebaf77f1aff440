// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_OPTIMALITY_H
#define SRC_OCP_OPTIMALITY_H

#include "ocp/certificate/witness.h"

// Optimality conditions of a solution with derivatives by differences, in no unit. Where something is worst: a column
// or a row of the programme, -1 for none.
struct optimality {
    double improvement; // first-order gain of the Lagrangian where every variable moves by its size against its
                        // gradient and every violation is taken back, relative to the size of the objective
    double gap;         // the same where every slack of a bound or row with a multiplier is used up
    double feasibility; // largest violation of a row or a bound, relative to its size
    double told;     // difference of the objective that the solution tells to that of its trajectory, relative; of what
                     // moving data see to it
    int column, row; // of the improvement; of the feasibility, rows + j for bounds of column j
};

// Error: MORAY_MEMORY.
moray_status moray_measure_optimality(const struct witness *e, struct optimality *optimality);

#endif
