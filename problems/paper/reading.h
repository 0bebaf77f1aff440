// SPDX-License-Identifier: MIT
//
// The control-oriented model as printed, errata and all: only the studies of the paper swim it.
#ifndef PROBLEMS_PAPER_READING_H
#define PROBLEMS_PAPER_READING_H

#include "moray/snake/model.h"

typedef enum {
    PAPER_CORRECTED = 0,
    PAPER_23H_PRINTED = 1, // (23h) with h_4 and h_5 as printed (erratum E1)
    PAPER_L_PRINTED = 2,   // l of (8), (12), (13) half a link, as everywhere else (erratum E2)
    PAPER_PRINTED = 3      // both
} paper_reading;

// A swimmer of the model so read; the first-principles model has no misprints. Read as printed, the l of its robot is
// what (8), (12) and (13) then mean. Error: those of moray_swimmer_new.
moray_status paper_reading_swimmer(moray_swimmer **swimmer, const moray_robot *robot, moray_model model,
                                   paper_reading reading);

#endif
