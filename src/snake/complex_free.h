// SPDX-License-Identifier: MIT
#ifndef MORAY_SNAKE_COMPLEX_FREE_H
#define MORAY_SNAKE_COMPLEX_FREE_H

#include "moray/snake.h"

// moray_complex_plant of a checked robot with MORAY_JOINTS_FREE. Error: MORAY_MEMORY.
moray_status complex_free_plant(moray_map *map, const moray_plant_spec *spec);

#endif
