// SPDX-License-Identifier: MIT
//
// Points and magnitudes at which the functions of a problem are looked at before anything is solved.
#ifndef SRC_OCP_PROBE_H
#define SRC_OCP_PROBE_H

#include "ocp/problem.h"

int moray_phase_inputs(const struct phase *p);
int moray_endpoint_inputs(const moray_ocp *ocp);
int moray_end_inputs(const struct phase *p); // of one phase: x0, t0, xf, tf, q, and where read u0, uf

// A point within the bounds, off the middle, so that nothing vanishes by symmetry; another trial moves it.
// in[moray_phase_inputs] = [x, u, s, t]; in[moray_endpoint_inputs] = [x0, t0, xf, tf, q of each phase in turn, s].
void moray_phase_probe(const moray_ocp *ocp, const struct phase *p, int trial, double *in);
void moray_endpoint_probe(const moray_ocp *ocp, int trial, double *in);

// points[n][inputs] over the whole box of the bounds, the first of them the probe of a trial. Along every input one
// point falls into each of the other n - 1 equal parts (n - 1 prime), of the box where it has both bounds; where it has
// not, or where they are wide, points lie at distances of several magnitudes around where the ends of the phase are.
enum { moray_probe_points = 32 };
void moray_phase_points(const moray_ocp *ocp, const struct phase *p, int trial, double *points);
void moray_endpoint_points(const moray_ocp *ocp, int trial, double *points);

// The box itself: box[inputs].
void moray_phase_box(const moray_ocp *ocp, const struct phase *p, moray_bounds *box);
void moray_endpoint_box(const moray_ocp *ocp, moray_bounds *box);

// Magnitudes for difference steps: 1, or what the bounds say where that is less (wide bounds say nothing).
void moray_phase_sizes(const moray_ocp *ocp, const struct phase *p, double *size);
void moray_endpoint_sizes(const moray_ocp *ocp, double *size);

#endif
