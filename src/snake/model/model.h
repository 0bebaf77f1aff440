// SPDX-License-Identifier: MIT
//
// What moray_swimmer_* asks of a model: one table for each. Arguments as in moray/snake.h.
#ifndef SRC_SNAKE_MODEL_MODEL_H
#define SRC_SNAKE_MODEL_MODEL_H

#include <stddef.h>

#include "moray/snake/model.h"

typedef struct snake_model {
    size_t (*scratch_bytes)(int N);                           // of the scratch space that rates needs
    void (*prepare)(const moray_robot *robot, void *scratch); // once, before; NULL: nothing
    void (*rest)(int N, double theta, double p_x, double p_y, double *x);
    void (*joints)(int N, const double *x, double *phi, double *v_phi);
    void (*body)(int N, const double *x, double body[MORAY_BODY_STATES]);
    void (*assemble)(int N, const double *phi, const double *v_phi, const double body[MORAY_BODY_STATES], double *x);
    bool (*rates)(const moray_robot *robot, const double current[2], const double *x, const double *ubar, double *dx,
                  double *u, void *scratch);
    // Forces of the water on the links; NULL: it knows none.
    bool (*water)(const moray_robot *robot, const double current[2], const double *x, const double *ubar, double *along,
                  double *across, void *scratch);
    moray_pose (*pose)(const moray_robot *robot, const double *x);
    void (*links)(const moray_robot *robot, const double *x, double *x_i, double *y_i, double *angle_i);
} snake_model;

// Error: MORAY_INPUT where the gait has a series, which `what` ("an orbit") does not know.
moray_status moray_gait_without_series(const moray_gait *gait, const char *what);

extern const snake_model moray_control_model, moray_fp_model;

#endif
