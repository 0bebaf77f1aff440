// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static bool is_text(const char *text, const char *other)
{
    return text && strcmp(text, other) == 0;
}

static bool is_named(const moray_option *row, const char *name)
{
    return is_text(row->flag, name) || is_text(row->key, name);
}

static bool has(const moray_program *program, const moray_option *shared)
{
    for (const char *const *name = program->without; name && *name; name++)
        if (is_named(shared, *name))
            return false;
    return true;
}

moray_status moray_option_unused(const moray_options *options, const char *name)
{
    const char *bare = strncmp(name, "--", 2) == 0 ? name + 2 : name;
    const size_t prefix = strlen("ipopt.");
    for (const char *const *other = options->without; other && *other; other++)
        if (strcmp(bare, *other) == 0 || (strncmp(bare, "ipopt.", prefix) == 0 && strncmp(*other, bare, prefix) == 0))
            return moray_error(MORAY_INPUT, "%.60s: %s has no use for it; --help lists the options", name,
                               options->program);
    return moray_ok();
}

static void add_group(moray_options *options, const moray_program *program, const moray_option_group *group)
{
    for (int i = 0; i < group->table->n; i++)
        if (has(program, &group->table->rows[i])) {
            options->own[options->n] = group->table->rows[i];
            options->own[options->n++].offset += group->at;
        }
}

moray_status moray_options_new(moray_options *options, const moray_program *program)
{
    int room = program->n_options + moray_common_table.n;
    for (int i = 0; i < program->n_groups; i++)
        room += program->groups[i].table->n;
    *options = (moray_options){.own = calloc((size_t)room, sizeof *options->own),
                               .words = program->words,
                               .program = program->name,
                               .without = program->without};
    options->row = options->own;
    if (!options->own)
        return moray_error(MORAY_MEMORY, "no memory for the table of options");
    for (int i = 0; i < program->n_options; i++)
        options->own[options->n++] = program->options[i];
    for (int i = 0; i < program->n_groups; i++)
        add_group(options, program, &program->groups[i]);
    add_group(options, program, &(moray_option_group){&moray_common_table, 0});
    return moray_ok();
}

const moray_option *moray_option_find(const moray_options *options, const char *key)
{
    for (int i = 0; i < options->n; i++)
        if (options->row[i].key && strcmp(options->row[i].key, key) == 0)
            return &options->row[i];
    return NULL;
}

int moray_edit_distance(const char *a, const char *b)
{
    enum { longest = 63 };
    int cost[longest + 1];
    const size_t n = strlen(b);
    if (strlen(a) > longest || n > longest)
        return INT_MAX;
    for (size_t j = 0; j <= n; j++)
        cost[j] = (int)j;
    for (size_t i = 0; a[i]; i++) {
        int diagonal = cost[0];
        cost[0]++;
        for (size_t j = 1; j <= n; j++) {
            const int replace = diagonal + (a[i] != b[j - 1]),
                      shift = 1 + (cost[j] < cost[j - 1] ? cost[j] : cost[j - 1]);
            diagonal = cost[j];
            cost[j] = replace < shift ? replace : shift;
        }
    }
    return cost[n];
}

bool moray_is_near(int distance, const char *text)
{
    return distance <= 1 + (int)strlen(text) / 3;
}

moray_status moray_option_unknown(const moray_options *options, const char *key)
{
    const char *nearest = NULL;
    int least = INT_MAX;
    MORAY_TRY(moray_option_unused(options, key));
    for (int i = 0; i < options->n; i++) {
        const int distance = options->row[i].key ? moray_edit_distance(key, options->row[i].key) : INT_MAX;
        if (distance < least) {
            least = distance;
            nearest = options->row[i].key;
        }
    }
    if (moray_is_near(least, key))
        return moray_error(MORAY_INPUT, "unknown key %.60s; did you mean %s?", key, nearest);
    return moray_error(MORAY_INPUT, "unknown key %.60s; --help lists the keys", key);
}
