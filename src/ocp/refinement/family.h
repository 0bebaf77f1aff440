// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_FAMILY_H
#define SRC_OCP_FAMILY_H

#include "ocp/refinement/campaign.h"

// After a mesh that is to be refined: where a control goes to and fro on it as far as on the one before, the first
// meshes again in c, with another family. Error: MORAY_MEMORY.
moray_status moray_leave_ringing(struct campaign *c, const moray_solution *solution);

// After a first mesh that was not solved: where an equation between states alone, in which no control stands, is asked
// of a Lobatto scheme, the same mesh in c with Radau's, which holds such of higher index. Notes the mesh. Error:
// MORAY_MEMORY.
moray_status moray_leave_higher_index(struct campaign *c, moray_solution *failed, bool *changed);

// Whether the family that took over has failed: more nodes than the one before it had, or no finer meshes (`again`),
// and the best is from before.
bool moray_is_no_better(const struct campaign *c, bool again);

// The meshes in c become those that follow on the best, with the family that it was solved with; *solution becomes the
// best. Error: MORAY_MEMORY.
moray_status moray_go_back(struct campaign *c, moray_solution **solution);

#endif
