// SPDX-License-Identifier: MIT
#ifndef SRC_BASE_COLOURING_H
#define SRC_BASE_COLOURING_H

#include "moray/map.h"

// Gives every column of touches[rows][cols] a group such that no row holds two columns of one group, so that one
// directional derivative serves a whole group; columns with most entries choose first. group[cols]; empty columns get
// -1. Error: MORAY_MEMORY.
moray_status moray_colour_columns(const bool *touches, int rows, int cols, int *group, int *groups);

#endif
