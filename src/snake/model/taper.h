// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_MODEL_TAPER_H
#define SRC_SNAKE_MODEL_TAPER_H

// Place s_i of a joint 0..n_joints-1 along the body, for the taper of its amplitude (moray_gait): -1 at the tail, 1 at
// the head.
static inline double taper_place(int joint, int n_joints)
{
    return n_joints > 1 ? 2.0 * joint / (n_joints - 1) - 1 : 0;
}

#endif
