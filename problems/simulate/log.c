// SPDX-License-Identifier: MIT
#include "simulate.h"

moray_status simulate_log(const simulate *run, const simulate_results *results)
{
    moray_swim_log log;
    moray_swim_log_noise noise = run->noise;
    noise.seed = (unsigned long)run->log_seed;
    moray_status status = moray_swim_log_swim(&log, results->swimmer, &results->schedule[0].gait, run->heading,
                                              run->log_from, results->t1, run->log_step, &noise);
    if (!moray_failed(status))
        status = moray_swim_log_save(&log, run->log_file);
    moray_swim_log_free(&log);
    return status;
}
