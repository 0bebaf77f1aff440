// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_SWEEP_FIGURES_H
#define PROBLEMS_SWEEP_FIGURES_H

#include "moray/app/results.h"
#include "sweep/shown.h"

// Slices of every number shown: over the last axis of numbers, a curve for each value of the one before it, a figure
// for each value of the others; and over every other axis of numbers, all else in the middle. Error: as
// moray_output_figure; MORAY_MEMORY.
moray_status sweep_draw(const shown *s, moray_output *output);

#endif
