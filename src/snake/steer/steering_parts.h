// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_STEER_STEERING_PARTS_H
#define SRC_SNAKE_STEER_STEERING_PARTS_H

#include "moray/snake/steering.h"

enum { states = MORAY_STEERING_STATES, parameters = MORAY_STEERING_PARAMETERS, own_events = 2, rates = 2 };
enum { NAME_SIZE = 24 };

struct moray_steering {
    moray_steering_spec spec;
    moray_map plant;
    moray_bounds *block;
    const char **names;            // of controls, events and path outputs
    char (*path_names)[NAME_SIZE]; // that the motors' point into
    moray_ocp *ocp;
};

// Path outputs of what the motors' supply allows.
int moray_steering_supply_rows(const moray_steering_spec *spec);
// What the joints can turn at, where that is limited: path outputs are then alpha omega +- phi_0', the largest rates of
// a stroke either way.
int moray_steering_rate_rows(const moray_steering_spec *spec);

// States the problem of the plant that is made. Error: MORAY_MEMORY, those of moray_ocp_new.
moray_status moray_steering_make_ocp(moray_steering *problem);

#endif
