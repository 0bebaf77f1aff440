// SPDX-License-Identifier: MIT
//
// A vector function with sparse first and second derivatives: the one form in which models meet the transcription.
#ifndef MORAY_MAP_H
#define MORAY_MAP_H

#include "moray/export.h"
#include "moray/num.h"
#include "moray/status.h"

MORAY_BEGIN

// Positions of the entries that may be non-zero; row and col have nnz entries. Values travel in the same order.
typedef struct moray_pattern {
    int nnz;
    int *row, *col;
} moray_pattern;

// in[n_in] -> out[n_out], with
//   jacobian: values[k] = d out[row k] / d in[col k]                        over `jac`
//   hessian:  values[k] = d2 (sum_i weight[i] out[i]) / d in[row k] d in[col k]  over `hess`, lower triangle (row >=
//   col)
// No entry stands twice in a pattern. The callbacks write every value of their pattern, allocate nothing, and show
// that they are outside their domain by a NaN. `self` may hold scratch space, so one map serves one thread. `hold`,
// NULL where there is nothing to gain by it, is told which inputs keep their values from here on, held[n_in], or by
// NULL that none does: entries of the Hessian by held ones may be left 0. `release` frees what `self` and the patterns
// own; NULL where nothing is owned.
typedef struct moray_map {
    int n_in, n_out;
    moray_pattern jac, hess;
    void *self;
    void (*value)(void *self, const double *in, double *out);
    void (*jacobian)(void *self, const double *in, double *values);
    void (*hessian)(void *self, const double *in, const double *weight, double *values);
    void (*hold)(void *self, const bool *held);
    void (*release)(struct moray_map *map);
} moray_map;

// Frees what the map owns and zeroes it; safe on a zeroed map, and twice.
MORAY_API void moray_map_release(moray_map *map);

// The same function written for complex arguments (num.h).
typedef void moray_complex_fn(void *self, const moray_num *in, moray_num *out);

// Makes a map of a complex-valued function: exact Jacobians by complex step, Hessians by central differences of them,
// both along groups of inputs that no output feels together. Patterns are what is felt, to the last bit, at
// `probe`[n_in] and at points around it, up to half of 1 + |probe| away; no input is ever a NaN. `release`, unless
// NULL, frees `self` with the map (or on error). Error: MORAY_MEMORY; MORAY_INPUT when the function is not finite at
// the probe.
MORAY_API moray_status moray_map_from_complex(moray_map *map, int n_in, int n_out, moray_complex_fn *function,
                                              void *self, void (*release)(void *self), const double *probe);

// Joins two maps into one with the inputs of `extra`, of which place[k], ascending in k, is input k of `base`, and with
// the outputs of `base`, those of `extra` inserted before output `at`. Takes over both, and leaves them zeroed, whether
// it succeeds or not. Error: MORAY_MEMORY.
MORAY_API moray_status moray_map_join(moray_map *map, moray_map *base, const int *place, moray_map *extra, int at);
// The same for a function that knows only real numbers (tables, other people's code): Jacobians by central differences
// of fourth order (about 1e-10 where the function is smooth), Hessians by second differences (about 1e-7).
typedef void moray_real_fn(void *self, const double *in, double *out);
MORAY_API moray_status moray_map_from_real(moray_map *map, int n_in, int n_out, moray_real_fn *function, void *self,
                                           void (*release)(void *self), const double *probe);

// The worst disagreement between a map's derivatives and an independent route, relative to 1 + |reference| and to
// 1e4 times what the reference itself is in doubt, so that steep functions and large values accuse nobody.
typedef struct moray_derivative_report {
    double jacobian_error, hessian_error;
    int jacobian_row, jacobian_col, hessian_row, hessian_col;
    double jacobian_given, jacobian_reference, hessian_given, hessian_reference;
} moray_derivative_report;

// Checks at in[n_in]: the Jacobian against Richardson-extrapolated differences of the value (about 1e-10 where the
// function is smooth), the Hessian with weight[n_out] against the same of the Jacobian; entries missing from a
// pattern are found too. Allocates its own scratch. Error: MORAY_MEMORY.
MORAY_API moray_status moray_check_derivatives(const moray_map *map, const double *in, const double *weight,
                                               moray_derivative_report *report);

// Ownership of patterns: zeroed arrays of nnz entries; free with moray_pattern_free. Error: MORAY_MEMORY.
MORAY_API moray_status moray_pattern_new(moray_pattern *pattern, int nnz);
MORAY_API void moray_pattern_free(moray_pattern *pattern);

MORAY_END

#endif
