// SPDX-License-Identifier: MIT
//
// The matrices of an interior-point method, by the form that suits: in the null space of the constraints where few
// degrees of freedom are left, by LDL' everywhere else.
#ifndef SRC_LINEAR_KKT_FACTORS_H
#define SRC_LINEAR_KKT_FACTORS_H

#include "linear/ldl.h"

typedef struct kkt_factors kkt_factors;

// Errors, units and ownership as of moray_ldl_new, moray_ldl_factor and moray_ldl_solve.
moray_status moray_kkt_factors_new(kkt_factors **result, int n, const moray_pattern *pattern);
void moray_kkt_factors_free(kkt_factors *kkt);
moray_status moray_kkt_factors_factor(kkt_factors *kkt, const double *values, double threshold);
moray_status moray_kkt_factors_solve(kkt_factors *kkt, int columns, double *B);
moray_ldl_inertia moray_kkt_factors_inertia(const kkt_factors *kkt);
double moray_kkt_factors_error(const kkt_factors *kkt); // of the last solve
bool moray_kkt_factors_has_pattern(const kkt_factors *kkt, int n, const moray_pattern *pattern);

#endif
