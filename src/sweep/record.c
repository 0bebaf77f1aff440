// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // strndup
#include "sweep/sweep.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void moray_record_free(struct record *record)
{
    free(record->reason);
    free(record->found);
    cJSON_Delete(record->read);
    *record = (struct record){0};
}

char *moray_record_line(const struct record *record)
{
    cJSON *line = cJSON_CreateObject();
    bool ok = cJSON_AddNumberToObject(line, "point", (double)record->task.point) &&
              cJSON_AddNumberToObject(line, "round", record->task.round) &&
              cJSON_AddNumberToObject(line, "start", (double)record->task.start) &&
              cJSON_AddNumberToObject(line, "start_round", record->task.start_round) &&
              cJSON_AddNumberToObject(line, "code", record->code) &&
              cJSON_AddNumberToObject(line, "seconds", record->seconds) &&
              cJSON_AddStringToObject(line, "reason", record->reason ? record->reason : "");
    if (ok && record->found)
        ok = cJSON_AddRawToObject(line, "found", record->found);
    char *text = ok ? cJSON_PrintUnformatted(line) : NULL;
    cJSON_Delete(line);
    return text;
}

bool moray_record_task(const char *line, struct task *task)
{
    // The beginning of moray_record_line, which is all that has to be read of a long line.
    return sscanf(line, "{\"point\":%ld,\"round\":%d,\"start\":%ld,\"start_round\":%d,", &task->point, &task->round,
                  &task->start, &task->start_round) == 4;
}

static double member(const cJSON *line, const char *key)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(line, key);
    return cJSON_IsNumber(item) ? item->valuedouble : NAN;
}

// Whole numbers that a long and an int hold.
static const double MOST_POINTS = 1e15, MOST_ROUNDS = 1e9;

// Whether a number is a whole one of that range; false for NaN.
static bool within(double number, double least, double most)
{
    return number >= least && number <= most && number == floor(number);
}

// As it stands at the end of the line: printed anew, numbers would lose digits. NULL where no writer of ours has left
// it.
static const char *place_of_found(const char *line, size_t *length)
{
    static const char key[] = ",\"found\":"; // inside a text the quotes would be escaped
    const char *at = strstr(line, key), *end = strrchr(line, '}');
    const char *from = at ? at + sizeof key - 1 : NULL;
    *length = from && end && end >= from ? (size_t)(end - from) : 0;
    return *length > 0 ? from : NULL;
}

moray_status moray_record_read(const char *text, struct record *record)
{
    *record = (struct record){0};
    cJSON *line = cJSON_ParseWithOpts(text, NULL, true);
    const double point = member(line, "point"), round = member(line, "round"), start = member(line, "start"),
                 start_round = member(line, "start_round"), code = member(line, "code"),
                 seconds = member(line, "seconds");
    const cJSON *reason = cJSON_GetObjectItemCaseSensitive(line, "reason");
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(line, "found");
    size_t length = 0;
    const char *raw = found ? place_of_found(text, &length) : NULL;
    moray_status status = moray_ok();
    if (!(within(point, 0, MOST_POINTS) && within(round, 0, MOST_ROUNDS) && within(start, -1, MOST_POINTS) &&
          within(start_round, 0, MOST_ROUNDS) && within(code, MORAY_OK, MORAY_INTERRUPTED) && seconds >= 0 &&
          cJSON_IsString(reason) && (!found || (raw && cJSON_IsObject(found))))) {
        status = moray_error(MORAY_INPUT, "no record of a sweep: %.60s", text);
    } else {
        record->task = (struct task){(long)point, (long)start, (int)round, (int)start_round};
        record->code = (moray_code)code;
        record->seconds = seconds;
        record->reason = strdup(reason->valuestring);
        record->found = raw ? strndup(raw, length) : NULL;
        record->read = cJSON_DetachItemFromObjectCaseSensitive(line, "found");
        if (!record->reason || (raw && !record->found))
            status = moray_error(MORAY_MEMORY, "no memory for a record");
    }
    cJSON_Delete(line);
    if (moray_failed(status))
        moray_record_free(record);
    return status;
}

moray_status moray_json_on_one_line(const char *text, char **line, cJSON **read)
{
    const char *end = text; // of the object: what a program says behind it does not belong into a record
    cJSON *object = text ? cJSON_ParseWithOpts(text, &end, false) : NULL;
    const bool is_object = cJSON_IsObject(object);
    *line = is_object ? strndup(text, (size_t)(end - text)) : NULL;
    if (*line)
        cJSON_Minify(*line);
    if (read && *line)
        *read = object;
    else
        cJSON_Delete(object);
    const bool failed = is_object && !*line;
    return failed ? moray_error(MORAY_MEMORY, "no memory for a summary") : moray_ok();
}
