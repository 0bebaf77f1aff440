// SPDX-License-Identifier: MIT
//
// Columns of the Hessian of the first-principles model by the motion of its joints: fp_tangent.h, with the chain's
// joints for the angles of its links.
#ifndef SRC_SNAKE_PLANT_FP_COLUMNS_H
#define SRC_SNAKE_PLANT_FP_COLUMNS_H

#include "snake/model/fp_tangent.h"

// n directions side by side, or what moves along them: [rows x stride] by the mean angle and its rate [1 row], the
// joints' angles, rates and accelerations [N-1], and the velocity of (p_x, p_y) [2].
typedef struct fp_joint_motion {
    double *mean, *v_mean, *phi, *v_phi, *ubar, *v;
} fp_joint_motion;

typedef struct fp_columns {
    int N, n, stride, wide;
    fp_joint_motion along, gradient; // along: zeros until they are set
    fp_directions links;
    fp_tangents by_links;
    double *sum; // scratch, one row
    void *memory;
} fp_columns;

// Room for `most` directions; columns->n, of which, is 0. Error: MORAY_MEMORY.
moray_status moray_fp_columns_new(fp_columns *columns, int N, int most);
void moray_fp_columns_free(fp_columns *columns);

// How the gradient of the weighted sum moves along n directions of the motion at a point.
void moray_fp_columns_find(fp_columns *columns, const fp_point *at);

#endif
