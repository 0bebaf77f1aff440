// SPDX-License-Identifier: MIT
//
// The same estimate as a navigator's from all readings of a window at once: the averaged plant fitted to them by
// collocation, with the readings inside it.
#ifndef MORAY_SNAKE_MOVING_HORIZON_H
#define MORAY_SNAKE_MOVING_HORIZON_H

#include "moray/export.h"
#include "moray/fit.h"
#include "moray/snake/navigator.h"

MORAY_BEGIN

// What was steered and read, ascending in time; all [n], borrowed.
typedef struct moray_log {
    int n;
    const double *t;
    const double *offset;              // of the control-oriented model, straight from one to the next [m]
    const double *heading, *p_x, *p_y; // read then, the heading without undulation; NAN: nothing was
} moray_log;

// What is believed at the end of the log, from its last `window` [s]: the state x at the start of the window, the
// current V and the factors f of the spec's belief that minimise
//     sum_k |(reading_k - x(t_k)) / error|^2 + |(V - V_belief) / current_doubt|^2
//         + |(ln f - ln f_belief) / factor_doubt|^2
// along the averaged plant, the errors those of heading and position in the spec; where a doubt is 0 the belief stays.
// *found: V and f; error[4], unless NULL: standard deviations of V_x, V_y [m/s] and of the factors of amplitude and
// turning, by what the readings say of them alone (INFINITY: nothing). Borrows spec, log and settings. Error:
// MORAY_INPUT where there are fewer than two readings in the window; MORAY_NOT_SOLVED; those of moray_average_plant,
// moray_solve and moray_fit_new.
MORAY_API moray_status moray_moving_horizon(const moray_navigator_spec *spec, const moray_log *log, double window,
                                            const moray_settings *settings, moray_belief *found, double error[4]);

MORAY_END

#endif
