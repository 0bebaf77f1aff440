// SPDX-License-Identifier: MIT
//
// The averaged plant as a function, for who builds functions of it.
#ifndef SRC_SNAKE_PLANT_AVERAGE_H
#define SRC_SNAKE_PLANT_AVERAGE_H

#include <complex.h>

#include "moray/snake/plant.h"

typedef struct moray_average moray_average;

// Error: MORAY_INPUT, MORAY_MEMORY. free() it.
moray_status moray_average_new(moray_average **average, const moray_plant_spec *spec);

// in and out of the map of moray_average_plant.
void moray_average_rates(void *average, const double complex *in, double complex *out);

#endif
