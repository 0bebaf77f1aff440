// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_CLASSICS_PICTURE_H
#define PROBLEMS_CLASSICS_PICTURE_H

#include "classics.h"
#include "moray/app/results.h"

// NAME.svg of a solution: up to seven of its states and controls. Error: MORAY_MEMORY, those of moray_output_figure.
moray_status classic_draw(const struct classic *classic, const moray_ocp *ocp, const moray_solution *solution,
                          moray_output *output);

#endif
