// SPDX-License-Identifier: MIT
#include "moray/app/sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "moray/number.h"

static moray_status no_memory(int n)
{
    return moray_error(MORAY_MEMORY, "no memory for %d values", n);
}

// low:high:count
static moray_status spread(char *text, double **value, int *n)
{
    enum { most = 1000000, LOW = 0, HIGH, COUNT, PARTS };
    char shown[64], *rest = text;
    double part[PARTS];
    bool good = true;
    snprintf(shown, sizeof shown, "%s", text);
    for (int k = 0; k < PARTS; k++)
        good = moray_number_read(strsep(&rest, ":"), &part[k]) && good;
    if (good && part[COUNT] == 1 && part[LOW] != part[HIGH])
        return moray_error(MORAY_INPUT, "%.60s: one value cannot be both %g and %g: give it alone", shown, part[LOW],
                           part[HIGH]);
    if (!good || rest || !(part[COUNT] >= 1 && part[COUNT] <= most) || part[COUNT] != floor(part[COUNT]))
        return moray_error(MORAY_INPUT, "%.60s: must be LOW:HIGH:COUNT, finite, with a count within 1:%d, or V,V,...",
                           shown, most);
    const int count = (int)part[COUNT];
    if (!(*value = calloc((size_t)count, sizeof **value)))
        return no_memory(count);
    for (int k = 0; k < count; k++) // symmetric, so that a middle of -1:1 is 0
        (*value)[k] = count == 1 ? part[LOW] : (part[LOW] * (count - 1 - k) + part[HIGH] * k) / (count - 1);
    *n = count;
    return moray_ok();
}

static bool all_numbers(const char *const *word, int n, double *value)
{
    for (int k = 0; k < n; k++)
        if (!moray_number_read(word[k], &value[k]))
            return false;
    return true;
}

// Words are names; not a number and infinity are meant as numbers.
static moray_status check_words(const char *const *word, int n)
{
    static const char *const odd[] = {"nan", "inf", "infinity"};
    for (int k = 0; k < n; k++)
        for (unsigned i = 0; i < sizeof odd / sizeof *odd; i++)
            if (strcasecmp(word[k] + strspn(word[k], "+-"), odd[i]) == 0)
                return moray_error(MORAY_INPUT, "value %d of the list, %.20s: must be finite", k + 1, word[k]);
    return moray_ok();
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
    if (!moray_failed(status))
        status = check_words(words, *n);
    if (moray_failed(status))
        free(words);
    else
        *word = words;
    return status;
}
