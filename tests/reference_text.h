// SPDX-License-Identifier: MIT
#ifndef TESTS_REFERENCE_TEXT_H
#define TESTS_REFERENCE_TEXT_H

#include "moray/snake/heading.h"
#include "tap.h"

// A heading reference whose text is right.
static inline moray_reference read_ok(const char *text)
{
    moray_reference reference;
    CHECK_OK(moray_reference_read(&reference, text), text);
    return reference;
}

#endif
