// SPDX-License-Identifier: MIT
//
// A setting as two texts, which its owner keeps: what a program passes through without knowing it.
#ifndef MORAY_KEY_VALUE_H
#define MORAY_KEY_VALUE_H

typedef struct moray_key_value {
    const char *key, *value; // numbers as texts
} moray_key_value;

#endif
