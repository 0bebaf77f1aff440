// SPDX-License-Identifier: MIT
//
// What nobody could go below: the arithmetic of a factorisation that follows the stages, at the rate at which this
// machine factors a dense matrix, the values that pass through memory once, and one sweep over the nodes with the
// user's functions for each evaluation that Ipopt asked for.
#include <stdlib.h>
#include <string.h>

#include "benchmark.h"
#include "moray/clock.h"

extern void dpotrf_(const char *uplo, const int *n, double *A, const int *lda, int *info);

enum { order = 500, size = 1 << 26, repetitions = 10 };

// Operations in a Cholesky factor of the dense matrix n I + 1 1'.
static double factor_dense(double *A)
{
    const int n = order;
    int info;
    for (int k = 0; k < n * n; k++)
        A[k] = k % (n + 1) ? 1 : n + 1;
    dpotrf_("L", &n, A, &n, &info);
    return info == 0 ? (double)n * n * n / 3 : 0;
}

// Bytes read and written in a copy of more than the cache holds.
static double copy(double *to)
{
    memcpy(to, (const char *)to + size, size);
    return 2.0 * size;
}

// What `work` does a second of the processor, at best.
static double best_rate(double (*work)(double *), double *room)
{
    double best = 0;
    for (int k = 0; k < repetitions; k++) {
        const double start = moray_processor_clock(), done = work(room);
        best = fmax(best, done / (moray_processor_clock() - start));
    }
    return best;
}

moray_status machine_measure(machine *found)
{
    double *room = malloc(2 * (size_t)size);
    if (!room)
        return moray_error(MORAY_MEMORY, "no memory to measure this machine with");
    memset(room, 0, 2 * (size_t)size);
    *found = (machine){.flops = best_rate(factor_dense, room), .bytes = best_rate(copy, room)};
    free(room);
    return moray_ok();
}

// Of one stage of nx defects and nu variables more than that: the recursion of Riccati (Frison and Jorgensen 2013).
static double stage_flops(double nx, double nu)
{
    return 7.0 / 3 * nx * nx * nx + 4 * nx * nx * nu + 2 * nx * nu * nu + nu * nu * nu / 3;
}

double cost_floor(const machine *rates, const cost *c, double term[FLOOR_TERMS])
{
    const double n = c->size.variables, m = c->size.constraints, nodes = c->nodes, nx = fmin(n, m) / nodes;
    const double values = (double)c->size.nnz_jac + c->size.nnz_hess + 3 * n + m; // of J, H, x, both z, lambda
    term[FLOOR_FACTORS] = c->iterations * nodes * stage_flops(nx, n / nodes - nx) / rates->flops;
    term[FLOOR_STREAM] = c->iterations * 2 * values * sizeof(double) / rates->bytes;
    term[FLOOR_CALLS] = c->sweeps * c->sweep;
    return term[FLOOR_FACTORS] + term[FLOOR_STREAM] + term[FLOOR_CALLS];
}

const char *floor_term_text(const double term[FLOOR_TERMS])
{
    static const char *const texts[FLOOR_TERMS] = {"factorisation", "streaming", "functions"};
    int most = 0;
    for (int k = 1; k < FLOOR_TERMS; k++)
        most = term[k] > term[most] ? k : most;
    return texts[most];
}
