// SPDX-License-Identifier: MIT
//
// A map of a function after CasADi's convention and of its derivatives.
#ifndef SRC_BASE_CASADI_MAP_H
#define SRC_BASE_CASADI_MAP_H

#include "base/casadi.h"
#include "moray/map.h"

struct casadi_map {
    void *object;
    struct casadi_function value, jacobian, adjoint; // adjoint: its Jacobian
    int n_in, n_out, entries;                        // of the map; of all arguments
    int *place;                                      // [entries]
    const double **jac_from, **hess_from; // [nnz]: where the function leaves each entry; hess_from with adjoint
    moray_pattern jac, hess;
    double *in, *slopes[2]; // [n_in], [jac.nnz]: for differences
    int *slot;              // [n_in][n_in]: entry of hess, -1
};

// Opens jac_NAME, jac_adj1_NAME and takes the patterns and places of their entries; or makes the pattern that Hessians
// by differences have. Error: MORAY_INPUT naming what is of the wrong shape, MORAY_MEMORY.
moray_status moray_casadi_open_jacobian(struct casadi_map *map, const char *name);
moray_status moray_casadi_open_adjoint(struct casadi_map *map, const char *name);
moray_status moray_casadi_plan_differences(struct casadi_map *map);

#endif
