// SPDX-License-Identifier: MIT
//
// What feedback does to the stroboscopic map.
#include <complex.h>

#include "sea.h"

void sea_multipliers(const sea_job *job, const double *number, double largest[2])
{
    moray_num multiplier[MORAY_POINCARE_STATES];
    const moray_poincare_spec spec = {.robot = &job->believed,
                                      .straight = &job->believed_straight,
                                      .gain = number ? job->scale * number[0] : 0,
                                      .lookahead = number && job->task == SEA_PATH ? number[1] : 0,
                                      .looks = 30};
    largest[0] = largest[1] = NAN;
    if (moray_failed(moray_poincare_multipliers(&spec, multiplier)))
        return;
    largest[0] = cabs(multiplier[0]);
    largest[1] = cabs(multiplier[1]);
}
