// SPDX-License-Identifier: MIT
//
// What Ipopt says besides its numbers, kept in memory: Ipopt writes into a file by its name.
#ifndef SRC_NLP_IPOPT_LOG_H
#define SRC_NLP_IPOPT_LOG_H

#include <IpStdCInterface.h>
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

// The logs of a solve. They close after the problem is freed; a log that cannot be opened is empty.
struct ipopt_logs {
    struct ipopt_log errors, timing;
};
void moray_ipopt_logs_open(IpoptProblem problem, int print_level, bool timing, struct ipopt_logs *logs);
void moray_ipopt_logs_close(struct ipopt_logs *logs);

// Whether MUMPS tells that it could not allocate. Ipopt takes the failed factorisation for one of a singular matrix and
// tries others; its code in the end is of many kinds.
bool moray_ipopt_log_lacked_memory(const struct ipopt_log *errors);

#endif
