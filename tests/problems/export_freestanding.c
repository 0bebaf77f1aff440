// SPDX-License-Identifier: MIT
//
// A controller's use of the exported header, without a standard library.
#include "snake.h"

void control_step(snake_state *state, snake_real t, snake_real *phi, snake_real *dphi, snake_real *ubar);

void control_step(snake_state *state, snake_real t, snake_real *phi, snake_real *dphi, snake_real *ubar)
{
    snake_joints(state, t, phi, dphi, ubar);
    snake_control(state, t, phi, dphi, ubar);
#ifdef STEER
    snake_start(state);
    STEER;
#endif
}
