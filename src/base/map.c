// SPDX-License-Identifier: MIT
#include "moray/map.h"

#include <stdlib.h>

moray_status moray_pattern_new(moray_pattern *pattern, int nnz)
{
    const size_t room = nnz > 0 ? (size_t)nnz : 1; // none to spare: sanitizers see what is beyond
    *pattern = (moray_pattern){
        .nnz = nnz, .row = calloc(room, sizeof *pattern->row), .col = calloc(room, sizeof *pattern->col)};
    if (pattern->row && pattern->col)
        return moray_ok();
    moray_pattern_free(pattern);
    return moray_error(MORAY_MEMORY, "no memory for a pattern of %d entries", nnz);
}

void moray_pattern_free(moray_pattern *pattern)
{
    free(pattern->row);
    free(pattern->col);
    *pattern = (moray_pattern){0};
}

void moray_map_release(moray_map *map)
{
    if (map->release)
        map->release(map);
    *map = (moray_map){0};
}
