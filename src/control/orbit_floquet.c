// SPDX-License-Identifier: MIT
//
// The monodromy matrix as the product of what the collocation of each interval does to a small deviation.
#include <stdlib.h>
#include <string.h>

#include "control/periodic_orbit.h"
#include "moray/dense.h"

// A y = B y_0 for the deviations y of the nodes after the interval's first, from its defects: A[m][m], B[m][nx],
// m = (points - 1) nx.
static void interval_equations(const orbit_system *system, int interval, double *A, double *B)
{
    const moray_scheme *scheme = &system->scheme;
    const int points = scheme->points, nx = system->nx, m = (points - 1) * nx;
    const double h = moray_orbit_step(system);
    for (int i = 0; i < points - 1; i++)
        for (int j = 0; j < points; j++) {
            const double P = scheme->P[i * points + j], hQ = h * scheme->Q[i * points + j];
            const double *slope = orbit_slope_at(system, interval * (points - 1) + j);
            for (int r = 0; r < nx; r++)
                for (int c = 0; c < nx; c++) {
                    const double entry = P * (r == c) - hQ * slope[r * system->inputs + c];
                    if (j == 0)
                        B[(i * nx + r) * nx + c] = -entry;
                    else
                        A[(i * nx + r) * m + (j - 1) * nx + c] = entry;
                }
        }
}

// left <- right left, both n x n
static void multiply(int n, const double *right, double *left, double *product)
{
    memset(product, 0, (size_t)(n * n) * sizeof *product);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            for (int j = 0; j < n; j++)
                product[i * n + j] += right[i * n + k] * left[k * n + j];
    memcpy(left, product, (size_t)(n * n) * sizeof *product);
}

moray_status moray_periodic_orbit_monodromy(moray_periodic_orbit *orbit, double *M)
{
    const orbit_system *system = &orbit->system;
    const int nx = system->nx, m = (system->scheme.points - 1) * nx;
    MORAY_TRY(moray_periodic_orbit_factor(orbit));
    double *A = malloc((size_t)m * (size_t)(m + nx) * sizeof *A);
    if (!A)
        return moray_error(MORAY_MEMORY, "no memory for a monodromy matrix");
    double *B = A + m * m;
    bool regular = true;
    for (int k = 0; k < nx * nx; k++)
        M[k] = k % (nx + 1) == 0;
    for (int k = 0; k < system->intervals && regular; k++) {
        interval_equations(system, k, A, B);
        regular = moray_dense_solve(m, A, nx, B);
        if (regular)
            multiply(nx, B + (m - nx) * nx, M, A); // which the solution has done with
    }
    free(A);
    return regular ? moray_ok() : moray_error(MORAY_NUMERIC, "the linearisation of an interval is singular");
}

moray_status moray_periodic_orbit_multipliers(moray_periodic_orbit *orbit, double complex *lambda)
{
    const size_t nx = (size_t)orbit->system.nx;
    double *M = malloc(nx * nx * sizeof *M);
    if (!M)
        return moray_error(MORAY_MEMORY, "no memory for a monodromy matrix");
    moray_status status = moray_periodic_orbit_monodromy(orbit, M);
    if (!moray_failed(status))
        status = moray_eigenvalues(orbit->system.nx, M, lambda);
    free(M);
    return status;
}
