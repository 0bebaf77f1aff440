// SPDX-License-Identifier: MIT
#include "snake/swim/limits.h"

#include "moray/angle.h"

moray_status moray_limits_check_range(const char *name, moray_bounds range, double least, double most, double unit)
{
    if (!(range.lower <= range.upper) || range.lower < least || range.upper > most)
        return moray_error(MORAY_INPUT, "%s = %g:%g: must be a range lo:hi within %g:%g", name, range.lower / unit,
                           range.upper / unit, least / unit, most / unit);
    return moray_ok();
}

moray_status moray_limits_check_above_zero(const char *name, double value)
{
    if (!(value > 0))
        return moray_error(MORAY_INPUT, "%s = %g: must be above 0, or none", name, value);
    return moray_ok();
}

moray_status moray_limits_check_gait(moray_bounds theta_max, moray_bounds omega, moray_bounds delta)
{
    const double degree = MORAY_DEGREE;
    MORAY_TRY(moray_limits_check_range("theta_max_deg", theta_max, 0, 89 * degree, degree));
    MORAY_TRY(moray_limits_check_range("omega_deg_s", omega, 1e-3 * degree, 1e5 * degree, degree));
    return moray_limits_check_range("delta_deg", delta, 1 * degree, 179 * degree, degree);
}
