// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_REFINE_H
#define SRC_OCP_REFINE_H

#include "ocp/solution.h"

enum { REFINE_MOST_STAGES = 10 };

// Errors of the solution's intervals, see moray_mesh_record.error: the largest of all phases; with `meshes`
// (zeroed, one a phase) not NULL, also finer meshes that should bring every interval to `tolerance`, new intervals with
// the stages of the mesh. The caller frees the meshes, whatever is returned. Error: MORAY_MEMORY.
moray_status moray_refine(const moray_solution *solution, double tolerance, struct mesh *meshes, double *worst);

#endif
