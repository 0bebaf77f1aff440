// SPDX-License-Identifier: MIT
//
// Parts of the witness: boxes and sizes.
#ifndef SRC_OCP_SIZES_H
#define SRC_OCP_SIZES_H

#include "ocp/certificate/witness.h"

const struct phase_cache *moray_witness_cache(const struct witness *e, int p);
const struct phase_layout *moray_witness_layout(const struct witness *e, int p);
double moray_witness_span(const struct witness *e, int p);
double moray_witness_width(moray_bounds bounds); // 0 where it says nothing

// The boxes that functions may be asked in. Of a fixed input nothing is said.
void moray_fill_boxes(struct witness *e);

// Each raises sizes: of the inputs of phase p along the trajectory; of what is smaller than it takes to move a state
// that it drives; of integrals; of the inputs of the endpoint, by those of the phases; of states and integrals whose
// displacement would hardly change the objective, by their multipliers.
void moray_size_by_range(struct witness *e, int p);
void moray_size_by_effect(struct witness *e, int p);
void moray_size_integrals(struct witness *e, int p);
void moray_size_ends(struct witness *e);
moray_status moray_size_by_costate(struct witness *e, int p);

// Of controls and parameters, by moving them until an output does. Error: MORAY_MEMORY.
moray_status moray_size_idle(struct witness *e);

// Of outputs, by moving inputs. Error: MORAY_MEMORY.
moray_status moray_size_outputs(struct witness *e, int p);
moray_status moray_size_end_outputs(struct witness *e);

#endif
