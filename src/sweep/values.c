// SPDX-License-Identifier: MIT
#include "moray/app/sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && !*end && isfinite(*value);
}

static moray_status no_memory(int n)
{
    return moray_error(MORAY_MEMORY, "no memory for %d values", n);
}

// low:high:count
static moray_status spread(const char *text, double **value, int *n)
{
    double low, high;
    int count, used = 0;
    enum { most = 1000000 };
    if (sscanf(text, "%lf:%lf:%d%n", &low, &high, &count, &used) < 3 || text[used] || !isfinite(low) ||
        !isfinite(high) || count < 1 || count > most || (count == 1 && low != high))
        return moray_error(MORAY_INPUT, "%.60s: must be LOW:HIGH:COUNT, finite, with a count within 1:%d, or V,V,...",
                           text, most);
    if (!(*value = calloc((size_t)count, sizeof **value)))
        return no_memory(count);
    for (int k = 0; k < count; k++) // symmetric, so that a middle of -1:1 is 0
        (*value)[k] = count == 1 ? low : (low * (count - 1 - k) + high * k) / (count - 1);
    *n = count;
    return moray_ok();
}

static bool all_numbers(const char *const *word, int n, double *value)
{
    for (int k = 0; k < n; k++)
        if (!number(word[k], &value[k]))
            return false;
    return true;
}

moray_status moray_sweep_values(char *text, double **value, const char ***word, int *n)
{
    *value = NULL;
    *word = NULL;
    *n = 0;
    if (strchr(text, ':') && !strchr(text, ','))
        return spread(text, value, n);
    int count = 1;
    for (const char *c = text; *c; c++)
        count += *c == ',';
    const char **words = calloc((size_t)count, sizeof *words);
    double *values = calloc((size_t)count, sizeof *values);
    moray_status status = words && values ? moray_ok() : no_memory(count);
    for (char *next = text; !moray_failed(status) && next;) {
        words[*n] = strsep(&next, ",");
        if (!words[(*n)++][0])
            status = moray_error(MORAY_INPUT, "value %d of the list is empty", *n);
    }
    if (!moray_failed(status) && all_numbers(words, *n, values)) {
        *value = values;
        free(words);
        return status;
    }
    free(values);
    if (moray_failed(status))
        free(words);
    else
        *word = words;
    return status;
}
