// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // strdup
#include <cjson/cJSON.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/options.h"
#include "moray/app/results.h"
#include "sweep/sweep.h"

static void describe(const struct grid *grid, moray_json *json)
{
    const moray_sweep_spec *spec = grid->spec;
    moray_json_text(json, "version", moray_version());
    moray_json_text(json, "configuration", spec->configuration);
    moray_json_text(json, "objective", spec->objective);
    moray_json_bool(json, "warm", spec->warm);
    for (int k = 0; k < spec->axes; k++) {
        const moray_sweep_axis *axis = &spec->axis[k];
        if (axis->value) {
            moray_json_numbers(json, axis->key, axis->value, axis->n);
            continue;
        }
        moray_json_open_list(json, axis->key);
        for (int i = 0; i < axis->n; i++)
            moray_json_text(json, NULL, axis->word[i]);
        moray_json_close(json);
    }
    for (int r = 0; r < spec->ranges; r++)
        moray_json_numbers(json, spec->range[r].key, (const double[]){spec->range[r].low, spec->range[r].high}, 2);
    if (spec->draws > 0) {
        moray_json_number(json, "draws", (double)spec->draws);
        moray_json_number(json, "seed", (double)spec->seed);
    }
}

char *moray_identity_line(const struct grid *grid)
{
    char *text = NULL, *line = NULL;
    size_t size;
    moray_json *json = moray_json_new();
    describe(grid, json);
    FILE *file = open_memstream(&text, &size);
    const bool written = file && !moray_failed(moray_json_write(json, file));
    if (file)
        fclose(file);
    if (!written || moray_failed(moray_json_on_one_line(text, &line, NULL)))
        line = NULL;
    free(text);
    moray_json_free(json);
    return line;
}

// A value as it stands in the line, or that there is none.
static char *shown(const cJSON *item)
{
    return item ? cJSON_PrintUnformatted(item) : strdup("not given");
}

moray_status moray_identity_refuse(const char *path, const char *there, const char *asked)
{
    cJSON *old = cJSON_Parse(there), *new = cJSON_Parse(asked);
    char difference[300] = "";
    for (int side = 0; side < 2 && old && new && !*difference; side++)
        for (const cJSON *item = side ? old->child : new->child; old &&new &&item && !*difference; item = item->next) {
            const cJSON *was = cJSON_GetObjectItemCaseSensitive(old, item->string);
            const cJSON *is = cJSON_GetObjectItemCaseSensitive(new, item->string);
            if (was && is && cJSON_Compare(was, is, true))
                continue;
            char *before = shown(was), *now = shown(is);
            snprintf(difference, sizeof difference, " (%.40s: %.50s there, %.50s here)", item->string,
                     before ? before : "", now ? now : "");
            free(before);
            free(now);
        }
    cJSON_Delete(old);
    cJSON_Delete(new);
    return moray_error(MORAY_INPUT, "%.90s is of another sweep%s: give this one another file, or remove it", path,
                       difference);
}
