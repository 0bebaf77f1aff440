// SPDX-License-Identifier: MIT
#include "moray/app/results.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct moray_json_file {
    cJSON *root;
};

static moray_status cannot_read(const char *path, const char *why)
{
    return moray_error(MORAY_IO, "JSON file %.180s: cannot be read: %s", path, why);
}

static char *read_text(const char *path)
{
    FILE *file = fopen(path, "r");
    char *text = NULL;
    size_t size = 0;
    if (!file)
        return NULL;
    errno = 0;
    const ssize_t read = getdelim(&text, &size, 0, file);
    if (read < 0) {
        free(text);
        text = NULL;
    } else if ((size_t)read > strlen(text)) {
        text[0] = 0; // a byte 0, behind which there may be more, is no JSON
    }
    fclose(file);
    return text;
}

moray_status moray_json_read(moray_json_file **result, const char *path)
{
    *result = NULL;
    char *text = read_text(path);
    if (!text)
        return cannot_read(path, errno ? strerror(errno) : "it is empty");
    moray_json_file *json = calloc(1, sizeof *json);
    if (json)
        json->root = cJSON_ParseWithOpts(text, NULL, true); // nothing behind it
    free(text);
    if (!json)
        return moray_error(MORAY_MEMORY, "no memory for a JSON file");
    if (!json->root) {
        free(json);
        return moray_error(MORAY_INPUT, "JSON file %.180s: is not JSON", path);
    }
    *result = json;
    return moray_ok();
}

void moray_json_file_free(moray_json_file *json)
{
    if (!json)
        return;
    cJSON_Delete(json->root);
    free(json);
}

static const cJSON *item_of(const cJSON *list, const char *number)
{
    char *end;
    const long at = strtol(number, &end, 10);
    return *end || end == number || at < 0 || at >= cJSON_GetArraySize(list) ? NULL : cJSON_GetArrayItem(list, (int)at);
}

static const cJSON *find(const moray_json_file *json, const char *place)
{
    const cJSON *at = json ? json->root : NULL;
    while (at && *place) {
        char key[128];
        const size_t length = strcspn(place, ".");
        if (length >= sizeof key)
            return NULL;
        memcpy(key, place, length);
        key[length] = 0;
        at = cJSON_IsArray(at) ? item_of(at, key) : cJSON_GetObjectItemCaseSensitive(at, key);
        place += length + (place[length] == '.');
    }
    return at;
}

double moray_json_number_at(const moray_json_file *json, const char *place)
{
    const cJSON *item = find(json, place);
    return cJSON_IsNumber(item) ? item->valuedouble : NAN;
}

const char *moray_json_text_at(const moray_json_file *json, const char *place)
{
    const cJSON *item = find(json, place);
    return cJSON_IsString(item) ? item->valuestring : NULL;
}

int moray_json_count_at(const moray_json_file *json, const char *place)
{
    const cJSON *item = find(json, place);
    return cJSON_IsArray(item) || cJSON_IsObject(item) ? cJSON_GetArraySize(item) : -1;
}
