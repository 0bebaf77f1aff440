// SPDX-License-Identifier: MIT
//
// Products with the matrices of Sec. III-A, each O(N) by running sums: A adds neighbours, D subtracts them, both
// (N-1) x N; Dbar = D^T (D D^T)^{-1} is the pseudo-inverse of D. None allocates; v and out must not overlap.
#ifndef SRC_SNAKE_MODEL_SHAPE_H
#define SRC_SNAKE_MODEL_SHAPE_H

void moray_shape_dbar(int N, const double *v /*N-1*/, double *out /*N*/);                // Dbar v
void moray_shape_a_dbar(int N, const double *v /*N-1*/, double *out /*N-1*/);            // A Dbar v
void moray_shape_a_dbar_transposed(int N, const double *v /*N-1*/, double *out /*N-1*/); // (A Dbar)^T v
void moray_shape_gram_inverse(int N, const double *v /*N-1*/, double *out /*N-1*/);      // (D D^T)^{-1} v
void moray_shape_a_dt(int N, const double *v /*N-1*/, double *out /*N-1*/);              // A D^T v
void moray_shape_at(int N, const double *v /*N-1*/, double *out /*N*/);                  // A^T v

#endif
