// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_LEGENDRE_H
#define SRC_OCP_LEGENDRE_H

// Gauss, Radau (right end) and Lobatto points on [0, 1], ascending, to rounding. node[s].
void moray_legendre_gauss(int s, double *node, double *weight); // weight may be NULL
void moray_legendre_radau(int s, double *node);
void moray_legendre_lobatto(int s, double *node);

// The Legendre polynomial of degree n, shifted to [0, 1], at tau in (0, 1).
double moray_legendre_value(int n, double tau);

#endif
