// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "moray/dense.h"
#include "snake/swim/orbit.h"

enum { KEPT = 4 };                  // states but for the position
static const double NEUTRAL = 1e-9; // a multiplier as near to 1 says nothing

// The motion but for the position, turned back by what the body turned: theta, v_theta and the velocity.
static void reduce(const moray_orbit *orbit, double M[ORBIT_STATES][ORBIT_STATES], double reduced[KEPT][KEPT])
{
    static const int kept[KEPT] = {0, 3, 4, 5};
    const double turn = orbit->spec.model == MORAY_FIRST_PRINCIPLES ? moray_orbit_turn(orbit) : 0;
    const double c = cos(turn), s = sin(turn);
    for (int j = 0; j < KEPT; j++) {
        double column[KEPT];
        for (int i = 0; i < KEPT; i++)
            column[i] = M[kept[i]][kept[j]];
        reduced[0][j] = column[0];
        reduced[1][j] = column[1];
        reduced[2][j] = c * column[2] + s * column[3];
        reduced[3][j] = c * column[3] - s * column[2];
    }
}

// In still water the multiplier nearest to 1 is the rotation's; it goes first.
static void sort_out(const moray_orbit *orbit, moray_floquet *floquet)
{
    const double *V = orbit->spec.current;
    double complex *lambda = floquet->multiplier + 2;
    int first = 0, nearest = 0;
    for (int k = 1; k < KEPT; k++)
        if (cabs(lambda[k] - 1) < cabs(lambda[nearest] - 1))
            nearest = k;
    if (V[0] == 0 && V[1] == 0) {
        const double complex rotation = lambda[nearest];
        memmove(lambda + 1, lambda, (size_t)nearest * sizeof *lambda);
        lambda[0] = rotation;
        first = 1;
    }
    for (int k = 0; k < ORBIT_STATES; k++)
        floquet->mode[k] = k < 2 ? MORAY_MODE_TRANSLATION : k < 2 + first ? MORAY_MODE_ROTATION : MORAY_MODE_OTHER;
    floquet->largest = cabs(lambda[first]);
    floquet->stable = floquet->largest < 1 - NEUTRAL;
}

// Nothing depends on the position: two multipliers are 1, and the others those of the rest of the motion. (With the
// position in it the matrix is defective in still water, and its eigenvalues good to half the digits.)
moray_status moray_orbit_floquet(moray_orbit *orbit, moray_floquet *floquet)
{
    double reduced[KEPT][KEPT];
    MORAY_TRY(moray_orbit_check_found(orbit));
    MORAY_TRY(moray_periodic_orbit_monodromy(orbit->engine, floquet->monodromy[0]));
    reduce(orbit, floquet->monodromy, reduced);
    floquet->multiplier[0] = floquet->multiplier[1] = 1;
    MORAY_TRY(moray_eigenvalues(KEPT, reduced[0], floquet->multiplier + 2));
    sort_out(orbit, floquet);
    return moray_ok();
}

moray_status moray_orbit_stays(moray_orbit *orbit)
{
    const double most = 1 + 1e-3;
    moray_floquet floquet;
    MORAY_TRY(moray_orbit_floquet(orbit, &floquet));
    if (!(floquet.largest < most))
        return moray_error(MORAY_NOT_SOLVED, "the orbit is not stable: a deviation grows %.4g times a period",
                           floquet.largest);
    return moray_ok();
}
