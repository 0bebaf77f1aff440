// SPDX-License-Identifier: MIT
//
// Parts of the certificate that have a file of their own.
#ifndef SRC_OCP_CERTIFY_H
#define SRC_OCP_CERTIFY_H

#include "ocp/refinement/examine.h"
#include "ocp/certificate/witness.h"

// The worst of a number over phases, and when.
struct finding {
    double value;
    int p;
    double time;
};

// Raises the finding.
void moray_find(struct finding *finding, double value, int p, double time);

// Integrates a phase again with the found controls: shooting interval by interval, each from the state found at its
// start, and in one go. Error: what the integrator returned, MORAY_MEMORY.
moray_status moray_resimulate(struct examiner *e, const moray_integrator *integrator, struct finding *shooting,
                              double *composed);

// Mean departure of the Hamiltonian of phase p from what H' = dH/dt makes of it, relative to the sum of the sizes of
// its terms, and when it is largest. *autonomous: no function changes with time. Error: MORAY_MEMORY.
moray_status moray_hamiltonian_drift(const struct witness *w, int p, struct finding *drift, bool *autonomous);

#endif
