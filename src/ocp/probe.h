// SPDX-License-Identifier: MIT
//
// Points and magnitudes at which the functions of a problem are looked at before anything is solved.
#ifndef OCP_PROBE_H
#define OCP_PROBE_H

#include "ocp/problem.h"

int phase_inputs(const struct phase *p);
int endpoint_inputs(const moray_ocp *ocp);

// A point within the bounds, off the middle, so that nothing vanishes by symmetry; another trial moves it.
// in[phase_inputs] = [x, u, s, t]; in[endpoint_inputs] = [x0, t0, xf, tf, q of each phase in turn, s].
void phase_probe(const moray_ocp *ocp, const struct phase *p, int trial, double *in);
void endpoint_probe(const moray_ocp *ocp, int trial, double *in);

// Magnitudes for difference steps: 1, or what the bounds say where that is less (wide bounds say nothing).
void phase_sizes(const moray_ocp *ocp, const struct phase *p, double *size);
void endpoint_sizes(const moray_ocp *ocp, double *size);

#endif
