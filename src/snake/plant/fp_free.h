// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_PLANT_FP_FREE_H
#define SRC_SNAKE_PLANT_FP_FREE_H

#include "moray/snake/plant.h"

// moray_fp_plant of a checked robot with MORAY_JOINTS_FREE. Error: MORAY_MEMORY.
moray_status moray_fp_free_plant(moray_map *map, const moray_plant_spec *spec);

#endif
