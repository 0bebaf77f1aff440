// SPDX-License-Identifier: MIT
#include "ocp/certificate/kept.h"

#include <stdlib.h>
#include <string.h>

struct kept_entry {
    int place; // in the block
    double jac, doubt, kink;
};

static moray_status no_memory(void)
{
    return moray_error(MORAY_MEMORY, "no memory for the certificate");
}

static size_t block_of(const struct kept *k)
{
    return (size_t)k->map->n_in * (size_t)k->map->n_out;
}

moray_status moray_kept_new(struct kept *k, const moray_map *map, int nodes)
{
    *k = (struct kept){.map = map};
    const size_t block = block_of(k);
    k->jac = calloc(3 * block + 1, sizeof *k->jac);
    k->expected = calloc(block + 1, sizeof *k->expected);
    k->start = calloc((size_t)nodes + 1, sizeof *k->start);
    if (!k->jac || !k->expected || !k->start)
        return no_memory();
    k->doubt = k->jac + block;
    k->kink = k->doubt + block;
    for (int e = 0; e < map->jac.nnz; e++)
        k->expected[map->jac.col[e] * map->n_out + map->jac.row[e]] = true;
    return moray_ok();
}

void moray_kept_free(struct kept *k)
{
    free(k->jac);
    free(k->expected);
    free(k->entry);
    free(k->start);
    *k = (struct kept){0};
}

static bool says_something(const struct kept *k, size_t place)
{
    return k->expected[place] || k->jac[place] != 0 || k->kink[place] != 0; // a NaN does
}

static moray_status make_room(struct kept *k, size_t wanted)
{
    if (wanted <= k->room)
        return moray_ok();
    const size_t room = wanted > 2 * k->room ? wanted : 2 * k->room;
    struct kept_entry *entry = realloc(k->entry, room * sizeof *entry);
    if (!entry)
        return no_memory();
    k->entry = entry;
    k->room = room;
    return moray_ok();
}

moray_status moray_kept_add(struct kept *k)
{
    size_t at = k->start[k->nodes], more = 0;
    for (size_t place = 0; place < block_of(k); place++)
        more += says_something(k, place);
    MORAY_TRY(make_room(k, at + more));
    for (size_t place = 0; place < block_of(k); place++)
        if (says_something(k, place))
            k->entry[at++] = (struct kept_entry){(int)place, k->jac[place], k->doubt[place], k->kink[place]};
    k->start[++k->nodes] = at;
    return moray_ok();
}

void moray_kept_skip(struct kept *k)
{
    k->nodes++;
    k->start[k->nodes] = k->start[k->nodes - 1];
}

void moray_kept_show(const struct kept *k, int node)
{
    memset(k->jac, 0, 3 * block_of(k) * sizeof *k->jac);
    for (size_t e = k->start[node]; e < k->start[node + 1]; e++) {
        const struct kept_entry *entry = &k->entry[e];
        k->jac[entry->place] = entry->jac;
        k->doubt[entry->place] = entry->doubt;
        k->kink[entry->place] = entry->kink;
    }
}
