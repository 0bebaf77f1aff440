// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_IDENTIFY_LOG_H
#define SRC_SNAKE_IDENTIFY_LOG_H

#include "base/csv.h"
#include "moray/snake/identify.h"

enum { LOG_TIME, LOG_JOINT, LOG_REFERENCE, LOG_X, LOG_Y, LOG_HEADING, LOG_TORQUE, LOG_QUANTITIES };

struct log_unit {
    const char *name;
    double factor; // to SI; NAN: the torque constant
};

struct log_reader {
    const moray_swim_log_format *format;
    moray_csv csv;
    int column[LOG_QUANTITIES]; // the first of a numbered one
    bool said[LOG_QUANTITIES];  // the user said the unit
    bool currents;              // u is in A
};

// Room for n rows: line, t, phi are set, the others NULL with their room behind phi. Error: MORAY_MEMORY.
moray_status moray_swim_log_new(moray_swim_log *log, int n, int joints);

// What must hold of a log that was read; fills notes, takes jumps of 2 pi out of the heading. Error: MORAY_INPUT.
moray_status moray_swim_log_check(const struct log_reader *reader, moray_swim_log *log);

#endif
