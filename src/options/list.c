// SPDX-License-Identifier: MIT
//
// Lists of numbers: "0.2, 8*0.14, 0.1".
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "options/options.h"

enum { NUMBER = 64, LINE = 150 }; // bytes of a number; of a line of a file, about

static int capacity(const moray_option *row)
{
    return (int)(row->size / sizeof(double));
}

// One item, X or k*X, into to[0..most-1]; returns how many numbers it is, 0: none of these.
static int read_item(const moray_option *row, char *text, double *to, int most)
{
    char *star = strchr(text, '*'), *end = NULL;
    long times = 1;
    if (star) {
        *star = 0;
        times = strtol(text, &end, 10);
        end += strspn(end, " \t");
        if (*end || times < 1)
            return 0;
    }
    double number, min, max;
    moray_option_bounds(row, &min, &max);
    if (times > most || !moray_number_read(star ? star + 1 : text, &number) || !(number >= min && number <= max) ||
        (row->open && (number == min || number == max)))
        return 0;
    for (long k = 0; k < times; k++)
        to[k] = number * moray_option_scale(row);
    return (int)times;
}

bool moray_list_read(const moray_option *row, const char *text, double *to)
{
    char item[NUMBER];
    int n = 0;
    for (bool more = true; more; text++) {
        const size_t length = strcspn(text, ",");
        if (length >= sizeof item)
            return false;
        memcpy(item, text, length);
        item[length] = 0;
        const int read = read_item(row, item, to + n, capacity(row) - n);
        if (read == 0)
            return false;
        n += read;
        text += length;
        more = *text == ',';
    }
    for (int i = n; i < capacity(row); i++)
        to[i] = NAN;
    return true;
}

int moray_list_length(const double *list, int most)
{
    int n = 0;
    while (n < most && !isnan(list[n]))
        n++;
    return n;
}

static int alike(const double *list, int i, int n)
{
    int k = i + 1;
    while (k < n && list[k] == list[i])
        k++;
    return k - i;
}

void moray_list_write(const moray_option *row, const double *list, FILE *file)
{
    const int n = moray_list_length(list, capacity(row));
    int column = fprintf(file, "%s = ", row->key);
    for (int i = 0, k; i < n; i += k) {
        char number[32];
        k = alike(list, i, n);
        moray_option_show_exactly(row, list[i], number);
        if (k > 1)
            column += fprintf(file, "%d*", k);
        column += fprintf(file, "%s%s", number, i + k < n ? "," : "\n");
        if (i + k < n && column > LINE)
            column = fprintf(file, "\n    ") - 1;
        else if (i + k < n)
            column += fprintf(file, " ");
    }
}
