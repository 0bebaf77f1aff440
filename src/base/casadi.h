// SPDX-License-Identifier: MIT
//
// One function of a shared object after CasADi's C convention, with its scratch.
#ifndef SRC_BASE_CASADI_H
#define SRC_BASE_CASADI_H

#include "moray/status.h"

// An argument or result: its shape, and where its nonzeros stand in the dense matrix, by columns.
struct casadi_block {
    int rows, cols, nnz;
    int *position;
    double *value; // [nnz]
};

struct casadi_function {
    char name[128];
    int (*evaluate)(const double **arg, double **res, long long *iw, double *w, int mem);
    void (*decref)(void);
    void (*give_back)(int mem);
    int mem, n_in, n_out;
    struct casadi_block *in, *out; // [n_in], [n_out]
    const double **arg;
    double **res;
    long long *iw;
    double *w;
};

// Whether the shared object has it.
bool moray_casadi_has(void *object, const char *name);

// Error: MORAY_INPUT naming what is missing or wrong, MORAY_MEMORY. moray_casadi_close in any case.
moray_status moray_casadi_open(struct casadi_function *function, void *object, const char *name);
void moray_casadi_close(struct casadi_function *function);

// Evaluates what stands in the values of in; false, and NaN in all of out, when the function fails.
bool moray_casadi_evaluate(struct casadi_function *function);

// Entries of all blocks together, zeros among them.
int moray_casadi_entries(const struct casadi_block *block, int n);

#endif
