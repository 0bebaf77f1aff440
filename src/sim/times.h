// SPDX-License-Identifier: MIT
#ifndef SRC_SIM_TIMES_H
#define SRC_SIM_TIMES_H

#include "moray/status.h"

// Error: MORAY_INPUT unless t0 <= t1 and times[n_times] ascend within [t0, t1].
moray_status moray_sim_check_times(double t0, double t1, const double *times, int n_times);

#endif
