// SPDX-License-Identifier: MIT
#include "moray/sim.h"

#include <math.h>

moray_sim_settings moray_sim_settings_default(void)
{
    return (moray_sim_settings){.method = MORAY_SIM_EXPLICIT, .rtol = 1e-10, .atol = 1e-10, .max_steps = 1000000};
}

moray_sim_settings moray_sim_settings_paper(void)
{
    moray_sim_settings settings = moray_sim_settings_default();
    settings.method = MORAY_SIM_TR_BDF2;
    settings.rtol = settings.atol = 1e-4;
    return settings;
}

moray_status moray_sim_settings_check(const moray_sim_settings *settings)
{
    if ((int)settings->method < MORAY_SIM_EXPLICIT || settings->method > MORAY_SIM_TR_BDF2)
        return moray_error(MORAY_INPUT,
                           "method = %d: must be MORAY_SIM_EXPLICIT, MORAY_SIM_ARKODE or MORAY_SIM_TR_BDF2",
                           (int)settings->method);
    if (!(settings->rtol >= 1e-14 && settings->rtol < 1))
        return moray_error(MORAY_INPUT, "rtol = %g: must be at least 1e-14 and below 1", settings->rtol);
    if (!(settings->atol > 0 && isfinite(settings->atol)))
        return moray_error(MORAY_INPUT, "atol = %g: must be finite and above 0", settings->atol);
    if (!(settings->max_step >= 0 && isfinite(settings->max_step)))
        return moray_error(MORAY_INPUT, "max_step = %g: must be finite and at least 0 (no limit)", settings->max_step);
    if (settings->max_steps < 1)
        return moray_error(MORAY_INPUT, "max_steps = %ld: must be at least 1", settings->max_steps);
    return moray_ok();
}
