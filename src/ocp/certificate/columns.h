// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_COLUMNS_H
#define SRC_OCP_COLUMNS_H

#include "moray/ocp.h"

// Differences the outputs of a map at in[n_in], each input by steps that begin at a fiftieth of its size and shrink
// until rounding tells: jac[n_in][n_out] and how far each entry may be off, doubt[n_in][n_out] (infinite where nothing
// converges). Where the functions, or box[n_in], end on one side, those of the other are taken (NULL: no box). At a
// kink, or nearer to it than the steps can tell, jac is the mean of the slopes on either side, jac + kink and jac -
// kink; kink[n_in][n_out] is 0 elsewhere. Error: MORAY_MEMORY.
moray_status moray_difference_columns(const moray_map *map, const double *in, const double *size,
                                      const moray_bounds *box, double *jac, double *doubt, double *kink);

#endif
