// SPDX-License-Identifier: MIT
//
// Points and magnitudes at which the functions of a problem are looked at before anything is solved.
#ifndef SRC_OCP_PROBE_H
#define SRC_OCP_PROBE_H

#include "ocp/problem.h"

int moray_phase_inputs(const struct phase *p);
int moray_endpoint_inputs(const moray_ocp *ocp);

// A point within the bounds, off the middle, so that nothing vanishes by symmetry; another trial moves it.
// in[moray_phase_inputs] = [x, u, s, t]; in[moray_endpoint_inputs] = [x0, t0, xf, tf, q of each phase in turn, s].
void moray_phase_probe(const moray_ocp *ocp, const struct phase *p, int trial, double *in);
void moray_endpoint_probe(const moray_ocp *ocp, int trial, double *in);

// Magnitudes for difference steps: 1, or what the bounds say where that is less (wide bounds say nothing).
void moray_phase_sizes(const moray_ocp *ocp, const struct phase *p, double *size);
void moray_endpoint_sizes(const moray_ocp *ocp, double *size);

#endif
