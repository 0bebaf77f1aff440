// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_PLANT_SERIES_H
#define SRC_SNAKE_PLANT_SERIES_H

#include "moray/snake/plant.h"

// What every plant of a model is checked for. Error: MORAY_INPUT.
moray_status moray_plant_check(const moray_plant_spec *spec, bool first_principles);

typedef moray_status plant_maker(moray_map *map, const moray_plant_spec *spec);

// A plant of a checked robot with its joints on a series, out of the same model's plant with free joints, which `make`
// gives: the chain rule through phi, phi', phi''. Error: MORAY_INPUT (harmonics), MORAY_MEMORY, and those of `make`.
moray_status moray_plant_series(moray_map *map, const moray_plant_spec *spec, plant_maker *make);

#endif
