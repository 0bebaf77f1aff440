// SPDX-License-Identifier: MIT
//
// The lists of [links]: a robot of unequal links from what is given for all and for each.
#ifndef SRC_SNAKE_SWIM_OPTIONS_LINKS_H
#define SRC_SNAKE_SWIM_OPTIONS_LINKS_H

#include "moray/snake/options.h"

void moray_links_none(moray_link_lists *lists);
bool moray_links_listed(const moray_link_lists *lists); // any of them

// Sets l, m, J, c_t, c_n, mu_n, lambda_1..3 of the robot from the geometry, but those that are given (not NaN).
void moray_link_of_geometry(moray_robot *robot, const moray_link_geometry *geometry, const moray_robot *given);

// Every link with units: by its lists, else by what is given for all links. Error: MORAY_INPUT where a list has not one
// number a link, or a thing is given for all links and for each.
moray_status moray_links_make(const moray_link_lists *lists, const moray_link_geometry *geometry,
                              const moray_robot *given, moray_link *link);

#endif
