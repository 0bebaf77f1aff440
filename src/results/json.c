// SPDX-License-Identifier: MIT
#include "moray/app/results.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>

enum { DEEPEST = 8 };

struct moray_json {
    cJSON *open[DEEPEST]; // open[0] is the root, which owns the rest
    int depth;
    bool failed;
};

moray_json *moray_json_new(void)
{
    moray_json *json = calloc(1, sizeof *json);
    if (json)
        json->failed = !(json->open[0] = cJSON_CreateObject());
    return json;
}

// Gives the item to the innermost open object or list.
static void attach(moray_json *json, const char *key, cJSON *item)
{
    cJSON *parent = json && !json->failed ? json->open[json->depth] : NULL;
    if (parent && (key ? cJSON_AddItemToObject(parent, key, item) : cJSON_AddItemToArray(parent, item)))
        return;
    cJSON_Delete(item);
    if (json)
        json->failed = true;
}

static void descend(moray_json *json, const char *key, cJSON *item)
{
    attach(json, key, item);
    if (!json || json->failed)
        return;
    if (json->depth + 1 < DEEPEST)
        json->open[++json->depth] = item;
    else
        json->failed = true;
}

void moray_json_open(moray_json *json, const char *key)
{
    descend(json, key, cJSON_CreateObject());
}

void moray_json_open_list(moray_json *json, const char *key)
{
    descend(json, key, cJSON_CreateArray());
}

void moray_json_close(moray_json *json)
{
    if (json && json->depth > 0)
        json->depth--;
}

int moray_json_depth(const moray_json *json)
{
    return json ? json->depth : 0;
}

// Raw, since cJSON itself prints 15 digits wherever they are right to 1 ulp.
static cJSON *number(double value)
{
    char text[32];
    return isfinite(value) ? cJSON_CreateRaw(moray_number_text(value, text)) : cJSON_CreateNull();
}

void moray_json_number(moray_json *json, const char *key, double value)
{
    attach(json, key, number(value));
}

void moray_json_numbers(moray_json *json, const char *key, const double *values, int n)
{
    moray_json_open_list(json, key);
    for (int i = 0; i < n; i++)
        attach(json, NULL, number(values[i]));
    moray_json_close(json);
}

void moray_json_members(moray_json *json, const moray_json_member *members, int n)
{
    for (int k = 0; k < n; k++)
        moray_json_number(json, members[k].key, members[k].value);
}

void moray_json_object(moray_json *json, const char *key, const moray_json_member *members, int n)
{
    moray_json_open(json, key);
    moray_json_members(json, members, n);
    moray_json_close(json);
}

void moray_json_text(moray_json *json, const char *key, const char *text)
{
    attach(json, key, text ? cJSON_CreateString(text) : cJSON_CreateNull());
}

void moray_json_bool(moray_json *json, const char *key, bool value)
{
    attach(json, key, cJSON_CreateBool(value));
}

moray_status moray_json_write(const moray_json *json, FILE *file)
{
    char *text = json && !json->failed ? cJSON_Print(json->open[0]) : NULL;
    if (!text)
        return moray_error(MORAY_MEMORY, "no memory for the summary, or more than %d objects in each other", DEEPEST);
    fprintf(file, "%s\n", text);
    cJSON_free(text);
    if (fflush(file) || ferror(file))
        return moray_error(MORAY_IO, "the summary cannot be written");
    return moray_ok();
}

void moray_json_free(moray_json *json)
{
    if (json)
        cJSON_Delete(json->open[0]);
    free(json);
}
