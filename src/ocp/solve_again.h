// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_SOLVE_AGAIN_H
#define SRC_OCP_SOLVE_AGAIN_H

#include "ocp/solution.h"

moray_nlp_settings moray_solver_settings(const moray_solution *solution, bool warm);

// Once more from a solution that was found, where its scales turned out to be wrong or the solver stopped well inside
// the constraints. Error: those of moray_ipopt_solve, MORAY_MEMORY.
moray_status moray_solve_again(moray_solution *solution);

#endif
