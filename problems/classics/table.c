// SPDX-License-Identifier: MIT
#include <stddef.h>
#include <string.h>

#include "classics.h"

// One list declares the problems and puts them in the table.
#define CLASSICS(X)                                                                                                    \
    X(brachistochrone)                                                                                                 \
    X(brachistochrone_near)                                                                                            \
    X(bryson_denham)                                                                                                   \
    X(bryson_denham_energy)                                                                                            \
    X(breakwell)                                                                                                       \
    X(tangent_steering)                                                                                                \
    X(hypersensitive)                                                                                                  \
    X(rayleigh)                                                                                                        \
    X(catalyst_mixing)                                                                                                 \
    X(jackson)                                                                                                         \
    X(van_der_pol)                                                                                                     \
    X(two_link_arm)                                                                                                    \
    X(obstacle)                                                                                                        \
    X(goddard)                                                                                                         \
    X(goddard_slow)                                                                                                    \
    X(robot_arm)                                                                                                       \
    X(hanging_chain)                                                                                                   \
    X(moon_lander)                                                                                                     \
    X(hang_glider_50)                                                                                                  \
    X(hang_glider_100)                                                                                                 \
    X(hang_glider_200)                                                                                                 \
    X(hang_glider_500)                                                                                                 \
    X(hang_glider_1000)                                                                                                \
    X(hang_glider)                                                                                                     \
    X(shuttle)                                                                                                         \
    X(launch)                                                                                                          \
    X(low_thrust)                                                                                                      \
    X(low_thrust_slack)                                                                                                \
    X(two_burn)                                                                                                        \
    X(manutec)                                                                                                         \
    X(swimmer)                                                                                                         \
    X(climb)                                                                                                           \
    X(gas_oil)                                                                                                         \
    X(marine_population)                                                                                               \
    X(methanol)                                                                                                        \
    X(alpha_pinene)                                                                                                    \
    X(bioreactor)                                                                                                      \
    X(tuberculosis)                                                                                                    \
    X(robertson)                                                                                                       \
    X(balanced_field)                                                                                                  \
    X(electric_vehicle)                                                                                                \
    X(pendulum)                                                                                                        \
    X(cannonball)                                                                                                      \
    X(zermelo)

#define DECLARE(name) extern const struct classic classic_##name;
CLASSICS(DECLARE)

#define ENTRY(name) &classic_##name,
const struct classic *const classics[] = {CLASSICS(ENTRY) NULL};

const struct classic *classic_find(const char *name)
{
    for (const struct classic *const *c = classics; *c; c++)
        if (strcmp((*c)->name, name) == 0)
            return *c;
    return NULL;
}
