// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <limits.h>
#include <string.h>

static bool *given(const moray_words *words, void *settings)
{
    return (bool *)((char *)settings + words->offset);
}

bool moray_word_known(const moray_words *words, const char *name)
{
    bool known = strcmp(name, words->all) == 0;
    for (int i = 0; i < words->n; i++)
        known = known || strcmp(name, words->word[i].name) == 0;
    return known;
}

moray_status moray_word_unknown(const moray_words *words, const char *name)
{
    const char *nearest = words->all;
    int least = moray_edit_distance(name, words->all);
    for (int i = 0; i < words->n; i++) {
        const int distance = moray_edit_distance(name, words->word[i].name);
        if (distance < least) {
            least = distance;
            nearest = words->word[i].name;
        }
    }
    if (moray_is_near(least, name))
        return moray_error(MORAY_INPUT, "unknown %s %.60s; did you mean %s?", words->noun, name, nearest);
    return moray_error(MORAY_INPUT, "unknown %s %.60s; --help lists them", words->noun, *name ? name : "(empty)");
}

void moray_word_mark(const moray_words *words, const char *name, void *settings)
{
    const bool all = strcmp(name, words->all) == 0;
    for (int i = 0; i < words->n; i++)
        if (all || strcmp(name, words->word[i].name) == 0)
            given(words, settings)[i] = true;
}

moray_status moray_words_check(const moray_words *words, const void *settings)
{
    const bool *marked = (const bool *)((const char *)settings + words->offset);
    for (int i = 0; i < words->n; i++)
        if (marked[i])
            return moray_ok();
    return moray_error(MORAY_INPUT, "no %s is named: must be %s or some of those that --help lists", words->noun,
                       words->all);
}
