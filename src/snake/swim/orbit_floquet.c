// SPDX-License-Identifier: MIT
//
// The monodromy matrix as the product of what the collocation of each interval does to a small deviation.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "snake/swim/orbit.h"
#include "moray/dense.h"

enum { NX = ORBIT_STATES };
static const double NEUTRAL = 1e-9; // a multiplier as near to 1 says nothing

// A y = B y_0 for the deviations y of the nodes after the interval's first, from its defects: A[m][m], B[m][NX],
// m = (points - 1) NX.
static void interval_equations(const orbit_system *system, int interval, double *A, double *B)
{
    const moray_scheme *scheme = &system->scheme;
    const int points = scheme->points, m = (points - 1) * NX;
    const double h = moray_orbit_step(system);
    for (int i = 0; i < points - 1; i++)
        for (int j = 0; j < points; j++) {
            const double P = scheme->P[i * points + j], hQ = h * scheme->Q[i * points + j];
            const double *slope = system->slope + (interval * (points - 1) + j) * system->outputs * ORBIT_INPUTS;
            for (int r = 0; r < NX; r++)
                for (int c = 0; c < NX; c++) {
                    const double entry = P * (r == c) - hQ * slope[r * ORBIT_INPUTS + c];
                    if (j == 0)
                        B[(i * NX + r) * NX + c] = -entry;
                    else
                        A[(i * NX + r) * m + (j - 1) * NX + c] = entry;
                }
        }
}

// left <- right left, both NX x NX
static void multiply(const double *right, double left[NX][NX])
{
    double product[NX][NX] = {{0}};
    for (int i = 0; i < NX; i++)
        for (int k = 0; k < NX; k++)
            for (int j = 0; j < NX; j++)
                product[i][j] += right[i * NX + k] * left[k][j];
    memcpy(left, product, sizeof product);
}

static moray_status monodromy(const orbit_system *system, double M[NX][NX])
{
    const int m = (system->scheme.points - 1) * NX;
    double *A = malloc((size_t)(m * m + m * NX) * sizeof *A), *B = A + m * m;
    bool regular = A != NULL;
    if (!A)
        return moray_error(MORAY_MEMORY, "no memory for a monodromy matrix");
    for (int i = 0; i < NX; i++)
        for (int j = 0; j < NX; j++)
            M[i][j] = i == j;
    for (int k = 0; k < system->spec.intervals && regular; k++) {
        interval_equations(system, k, A, B);
        regular = moray_dense_solve(m, A, NX, B);
        if (regular)
            multiply(B + m * NX - NX * NX, M);
    }
    free(A);
    return regular ? moray_ok() : moray_error(MORAY_NUMERIC, "the linearisation of an interval is singular");
}

// The motion but for the position, turned back by what the body turned: theta, v_theta and the velocity.
static void reduce(const moray_orbit *orbit, double M[NX][NX], double *reduced)
{
    static const int kept[] = {0, 3, 4, 5};
    const orbit_system *system = &orbit->system;
    const bool turns = system->spec.model == MORAY_FIRST_PRINCIPLES && !system->spec.steered;
    const double turn = turns ? orbit->z[system->unknowns - 1] : 0, c = cos(turn), s = sin(turn);
    for (int j = 0; j < 4; j++) {
        double column[4];
        for (int i = 0; i < 4; i++)
            column[i] = M[kept[i]][kept[j]];
        reduced[0 * 4 + j] = column[0];
        reduced[1 * 4 + j] = column[1];
        reduced[2 * 4 + j] = c * column[2] + s * column[3];
        reduced[3 * 4 + j] = c * column[3] - s * column[2];
    }
}

// In still water the multiplier nearest to 1 is the rotation's; it goes first.
static void sort_out(const moray_orbit *orbit, moray_floquet *floquet)
{
    const double *V = orbit->system.spec.current;
    double complex *lambda = floquet->multiplier + 2;
    int first = 0, nearest = 0;
    for (int k = 1; k < 4; k++)
        if (cabs(lambda[k] - 1) < cabs(lambda[nearest] - 1))
            nearest = k;
    if (V[0] == 0 && V[1] == 0) {
        const double complex rotation = lambda[nearest];
        memmove(lambda + 1, lambda, (size_t)nearest * sizeof *lambda);
        lambda[0] = rotation;
        first = 1;
    }
    for (int k = 0; k < 6; k++)
        floquet->mode[k] = k < 2 ? MORAY_MODE_TRANSLATION : k < 2 + first ? MORAY_MODE_ROTATION : MORAY_MODE_OTHER;
    floquet->largest = cabs(lambda[first]);
    floquet->stable = floquet->largest < 1 - NEUTRAL;
}

// Nothing depends on the position: two multipliers are 1, and the others those of the rest of the motion. (With the
// position in it the matrix is defective in still water, and its eigenvalues good to half the digits.)
moray_status moray_orbit_floquet(moray_orbit *orbit, moray_floquet *floquet)
{
    double reduced[16];
    MORAY_TRY(moray_orbit_factor(orbit));
    MORAY_TRY(monodromy(&orbit->system, floquet->monodromy));
    reduce(orbit, floquet->monodromy, reduced);
    floquet->multiplier[0] = floquet->multiplier[1] = 1;
    MORAY_TRY(moray_eigenvalues(4, reduced, floquet->multiplier + 2));
    sort_out(orbit, floquet);
    return moray_ok();
}
