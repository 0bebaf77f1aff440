// SPDX-License-Identifier: MIT
//
// The optimal-gait problem of gait_problem.h as a search in three variables, with the orbit solved for at every point:
// local from a start, or global.
#ifndef MORAY_SNAKE_GAIT_SEARCH_H
#define MORAY_SNAKE_GAIT_SEARCH_H

#include "moray/export.h"
#include "moray/snake/gait_problem.h"
#include "moray/snake/orbit.h"
#include "moray/search.h"

MORAY_BEGIN

typedef struct moray_gait_search moray_gait_search; // not for two threads at once

// Variables theta_max, omega, delta within their limits; the offset is the one that holds the heading. Joint effort is
// limited at every degree of phase. (The control-oriented model's limit of single link angles stays with the
// collocation.) On the mesh of `scheme` and `intervals`. Error: MORAY_INPUT naming what is wrong, where joints are not
// MORAY_JOINTS_ON_GAIT too, a taper is allowed, link_angles are what is bounded, or the offset's limits leave out 0 in
// still water; MORAY_MEMORY.
MORAY_API moray_status moray_gait_search_new(moray_gait_search **search, const moray_gait_problem_spec *spec,
                                             const char *scheme, int intervals);
MORAY_API void moray_gait_search_free(moray_gait_search *search);

// Searches from *gait for the gait of the problem's goal, and leaves the best one found there, with its orbit in
// *result: of those within the limits, unless info->violation says (relative to the limit) that there is none. Error:
// those of moray_search and moray_orbit_solve.
MORAY_API moray_status moray_gait_search_run(moray_gait_search *search, const moray_search_settings *settings,
                                             moray_gait *gait, moray_orbit_result *result, moray_search_info *info);

// The orbit that *result of the last run describes.
MORAY_API moray_orbit *moray_gait_search_orbit(const moray_gait_search *search);

MORAY_END

#endif
