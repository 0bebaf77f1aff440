// SPDX-License-Identifier: MIT
//
// Numbers in texts, as the C locale has them, whatever locale the process has set.
#ifndef SRC_BASE_NUMBER_H
#define SRC_BASE_NUMBER_H

#include <locale.h>
#include <stdbool.h>

// A finite decimal number with nothing but blanks around it; false for all other texts, hexadecimal ones among them.
bool moray_number_read(const char *text, double *number);

// A count as an int, rounded up: 0 where it is negative or NaN, INT_MAX where no int is as large.
int moray_count_up(double count);

// Between these two the calling thread prints and scans numbers as the C locale has them.
locale_t moray_c_locale_begin(void);
void moray_c_locale_end(locale_t before);

#endif
