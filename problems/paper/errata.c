// SPDX-License-Identifier: MIT
#include "errata.h"

moray_status paper_errata(paper *p)
{
    MORAY_TRY(erratum_23h(p));
    MORAY_TRY(paper_say(p,
                        "E1: eliminating the accelerations from (14), (15b), (15c) gives (16c). With (23h) the robot "
                        "is driven sideways by its forward motion, and nothing stops it."));
    MORAY_TRY(erratum_half_link(p));
    MORAY_TRY(erratum_offset_sign(p));
    MORAY_TRY(erratum_frequency(p));
    MORAY_TRY(erratum_lambda(p));
    MORAY_TRY(erratum_force_sign(p));
    return paper_say(p, "(13): with the sign as printed the body's bending would brake; (14a) is what (11) gives, and "
                        "its sum is the acceleration (15b) of the model.");
}
