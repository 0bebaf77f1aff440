// SPDX-License-Identifier: MIT
//
// Orbits about the oblate Earth in modified equinoctial elements (p, f, g, h, k, L), in feet and seconds (Betts 2001,
// ch. 5; constants as there).
#ifndef PROBLEMS_CLASSICS_ORBIT_H
#define PROBLEMS_CLASSICS_ORBIT_H

#include "moray/ocp.h"

// Rates of the elements under the accelerations delta (radial, transverse, normal) besides the oblate Earth's.
void orbit_rates(const moray_num *element, const moray_num *delta, moray_num *rate);

// Radial and transverse velocity.
void orbit_velocity(const moray_num *element, moray_num *radial, moray_num *transverse);

// A part of a start by simulation: x[n], n <= 8, carried on for `time` by the dynamics under constant controls and
// parameters, with four steps of the classical Runge-Kutta method.
void orbit_propagate(moray_continuous_fn *dynamics, int n, double *x, const moray_num *u, const moray_num *s,
                     double time);

#endif
