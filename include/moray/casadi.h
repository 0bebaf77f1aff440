// SPDX-License-Identifier: MIT
//
// Maps of functions that stand in a shared object after the C convention of CasADi's generated code, for users who
// write their dynamics there (Function.generate, then cc -shared -fPIC) and solve here.
#ifndef MORAY_CASADI_H
#define MORAY_CASADI_H

#include "moray/export.h"
#include "moray/map.h"
#include "moray/status.h"

MORAY_BEGIN

// The function NAME of a shared object, casadi_real double and casadi_int long long int, as CasADi has them by default:
//   NAME                           int (const double **arg, double **res, long long *iw, double *w, int mem)
//   NAME_n_in, _n_out, _sparsity_in, _sparsity_out, _work                 where missing: one scalar in, one out
//   NAME_incref, _decref, _checkout, _release or _alloc_mem, _init_mem, _free_mem          where they are there
// The inputs of the map are the entries of all arguments in turn, its outputs those of all results, matrices by
// columns; entries outside a sparsity are zero. Derivatives, the best that are there:
//   jac_NAME        Jacobian: arguments of NAME, then its results; a block for each result and argument in turn, or one
//   jac_adj1_NAME   Hessian: arguments, results and weights of the results; blocks of d (adjoint of argument) / d
//   (each)
// Without the second, Hessians are central differences of the Jacobian; without the first, all is as in
// moray_map_from_real. The shared object stays loaded until the map is released; one map serves one thread.
typedef struct moray_casadi_spec {
    const char *path, *name;
    int n_in;            // of the map; 0: as many as the function has. More stand where dynamics ignore s or t
    const int *place;    // [entries of all arguments]: each one's input of the map, all different; NULL: in order
    const double *probe; // [n_in], where a function without jac_NAME is looked at first; NULL: zeros
} moray_casadi_spec;

// Error: MORAY_IO when the shared object cannot be loaded; MORAY_INPUT naming the function, argument or result that is
// missing or of the wrong shape; MORAY_MEMORY.
MORAY_API moray_status moray_map_from_casadi(moray_map *map, const moray_casadi_spec *spec);

MORAY_END

#endif
