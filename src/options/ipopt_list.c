// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <string.h>

static const char prefix[] = "ipopt.";

const moray_option *moray_option_find_ipopt(const moray_options *options, const char *text)
{
    if (strncmp(text, prefix, strlen(prefix)) != 0)
        return NULL;
    for (int i = 0; i < options->n; i++)
        if (options->row[i].type == MORAY_OPTION_IPOPT)
            return &options->row[i];
    return NULL;
}

static int find(const moray_ipopt_list *list, const char *key)
{
    int i = 0;
    while (i < list->n && strcmp(list->at[i].key, key) != 0)
        i++;
    return i;
}

bool moray_ipopt_list_has(const moray_ipopt_list *list, const char *key)
{
    return find(list, key) < list->n;
}

moray_status moray_ipopt_list_set(moray_ipopt_list *list, const char *text)
{
    char given[MORAY_IPOPT_SIZE];
    const char *equals = strchr(text, '=');
    if (!equals || equals == text || !equals[1])
        return moray_error(MORAY_INPUT, "ipopt.%.60s: must be ipopt.KEY=VALUE", text);
    if (strlen(text) >= sizeof given)
        return moray_error(MORAY_INPUT, "ipopt.%.60s...: longer than %d bytes", text, (int)sizeof given - 1);
    strcpy(given, text);
    given[equals - text] = 0;
    const int i = find(list, given);
    if (i == MORAY_IPOPT_OPTIONS)
        return moray_error(MORAY_INPUT, "ipopt.%.60s: more than %d options of Ipopt", given, (int)MORAY_IPOPT_OPTIONS);
    memcpy(list->text[i], given, strlen(text) + 1);
    list->at[i] = (moray_key_value){list->text[i], list->text[i] + (equals - text) + 1};
    list->n += i == list->n;
    return moray_ok();
}
