// SPDX-License-Identifier: MIT
//
// What Ipopt says besides its numbers, kept in memory: Ipopt writes into a file by its name.
#ifndef SRC_NLP_IPOPT_LOG_H
#define SRC_NLP_IPOPT_LOG_H

#include <stdbool.h>
#include <stddef.h>

struct ipopt_log {
    char path[40]; // for Ipopt; empty when the log is not open
    int file;
};

// The levels at which Ipopt tells its errors and the processor time that it took.
enum { ipopt_error_level = 1, ipopt_timing_level = 5 };

bool moray_ipopt_log_open(struct ipopt_log *log);
void moray_ipopt_log_close(struct ipopt_log *log);

// The following read what is written so far; the last of it is written when Ipopt frees its problem.

// Whether one of the lines holds `words`; that line goes to line[size], cut where it does not fit.
bool moray_ipopt_log_find(const struct ipopt_log *log, const char *words, char *line, size_t size);

// Seconds in the linear solver; NaN when the log does not tell.
double moray_ipopt_log_linear_seconds(const struct ipopt_log *log);

#endif
