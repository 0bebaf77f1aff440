// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_IDENTIFY_UNKNOWNS_H
#define SRC_SNAKE_IDENTIFY_UNKNOWNS_H

#include <stddef.h>

#include "moray/snake/identify.h"

struct unknown {
    const char *name, *unit;
    size_t at;               // in moray_unknowns
    bool fp, control;        // of this model only
    bool torque;             // of (4), whose place strips take
    bool offset, instrument; // may have any sign; changes the readings only, not the swimming
    double scale;            // of an offset; that of a coefficient is its value
};
extern const struct unknown moray_unknown_table[];

#endif
