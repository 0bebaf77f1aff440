// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_DIAGNOSIS_H
#define SRC_OCP_DIAGNOSIS_H

#include "ocp/diagnosis/bands.h"

enum { name_size = 160 };

// Appends to the diagnosis.
__attribute__((format(printf, 2, 3))) void moray_diagnosis_say(moray_solution *solution, const char *format, ...);

// One thing to try, chosen by what the iterate shows.
void moray_diagnosis_suggest(moray_solution *solution);

// What the iterate of a programme that was not solved shows, in scaled units.
struct evidence {
    moray_solution *solution;
    const struct transcription *t;
    double *violation; // [m], signed: above 0 where a constraint is too large
    double worst;      // of them
    double *jac;       // [nnz_jac]
    double *weight;    // [m] scratch
    double *pull;      // [n] scratch
    bool *rows, *cols; // [m], [n] scratch
};

// Each looks for one cause and, where it has the evidence, says what to try and returns true.
bool moray_dependent_constraints(struct evidence *e);
bool moray_hardest_bound(struct evidence *e);

// Says so where a function has a kink in an input, within what it is along the trajectory.
bool moray_has_kink(const struct evidence *e);

// Signed scaled amount by which row i is outside its bounds.
double moray_scaled_violation(const moray_solution *solution, int i);

#endif
