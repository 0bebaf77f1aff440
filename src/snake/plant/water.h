// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_PLANT_WATER_H
#define SRC_SNAKE_PLANT_WATER_H

#include "moray/snake/plant.h"

typedef moray_status moray_plant_maker(moray_map *map, const moray_plant_spec *spec);

// The plant that `make` gives in uniform water, in the water of the spec. Error: that of `make`; MORAY_INPUT,
// MORAY_MEMORY.
moray_status moray_water_plant(moray_map *map, const moray_plant_spec *spec, bool first_principles,
                               moray_plant_maker *make);

#endif
