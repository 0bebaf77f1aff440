// SPDX-License-Identifier: MIT
//
// A log from a file: which column is what, in which unit, and its numbers.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/csv.h"
#include "base/number.h"
#include "snake/identify/log.h"

typedef struct quantity {
    const char *key, *names; // names: by which it is found, with | between; # for a number
    const struct log_unit *units;
} quantity;

static const struct log_unit times[] = {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {NULL, 0}};
static const struct log_unit angles[] = {{"rad", 1}, {"deg", M_PI / 180}, {NULL, 0}};
static const struct log_unit lengths[] = {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {NULL, 0}};
static const struct log_unit torques[] = {{"N m", 1}, {"Nm", 1}, {"mN m", 1e-3}, {"mNm", 1e-3}, {"A", NAN}, {NULL, 0}};

static const quantity quantities[LOG_QUANTITIES] = {
    [LOG_TIME] = {"t", "t|time|Time", times},
    [LOG_JOINT] = {"phi", "phi_#|phi#|joint_#|joint#", angles},
    [LOG_REFERENCE] = {"phi_ref", "phi_ref_#|phi_ref#|joint_ref_#|reference_#", angles},
    [LOG_X] = {"p_x", "p_x|x", lengths},
    [LOG_Y] = {"p_y", "p_y|y", lengths},
    [LOG_HEADING] = {"heading", "heading|theta|yaw", angles},
    [LOG_TORQUE] = {"u", "u_#|u#|torque_#|motor_current_#", torques},
};

// ---- Texts of the user ---------------------------------------------------------------------------------------------

static int quantity_named(const char *key, size_t length)
{
    for (int k = 0; k < LOG_QUANTITIES; k++)
        if (strlen(quantities[k].key) == length && strncmp(quantities[k].key, key, length) == 0)
            return k;
    return -1;
}

// The value of "KEY=VALUE,..." for a quantity, into value[size]; false where there is none.
static bool assigned(const char *list, int which, char *value, size_t size)
{
    for (const char *at = list; at && *at; at += strcspn(at, ","), at += *at == ',') {
        const size_t key = strcspn(at, "=,"), whole = strcspn(at, ",");
        if (at[key] != '=' || quantity_named(at, key) != which)
            continue;
        snprintf(value, size, "%.*s", (int)(whole - key - 1), at + key + 1);
        return true;
    }
    return false;
}

// Error: MORAY_INPUT naming what is not of the form KEY=VALUE, KEY a quantity.
static moray_status check_list(const char *list, const char *option)
{
    for (const char *at = list; at && *at; at += strcspn(at, ","), at += *at == ',') {
        const size_t key = strcspn(at, "=,"), whole = strcspn(at, ",");
        if (at[key] != '=' || whole == key + 1 || quantity_named(at, key) < 0)
            return moray_error(MORAY_INPUT,
                               "%s: %.*s: must be KEY=%s with KEY one of t, phi, phi_ref, p_x, p_y, heading, u", option,
                               (int)(whole < 60 ? whole : 60), at, strcmp(option, "units") ? "NAME" : "UNIT");
    }
    return moray_ok();
}

// ---- Columns -------------------------------------------------------------------------------------------------------

// Length of a column's name without a unit in brackets behind it.
static size_t bare_length(const char *name)
{
    size_t length = strcspn(name, "[(");
    if (!name[length])
        return length;
    while (length > 0 && name[length - 1] == ' ')
        length--;
    return length;
}

static int find_bare(const moray_csv *csv, const char *name)
{
    const int whole = moray_csv_find(csv, name);
    for (int j = 0; j < csv->columns && whole < 0; j++)
        if (bare_length(csv->name[j]) == strlen(name) && strncmp(csv->name[j], name, strlen(name)) == 0)
            return j;
    return whole;
}

// The column of one of the names, # being the number.
static int find_column(const moray_csv *csv, const char *names, int number)
{
    for (const char *at = names; *at; at += strcspn(at, "|"), at += *at == '|') {
        const size_t length = strcspn(at, "|"), before = strcspn(at, "#|");
        char name[160];
        if (before < length)
            snprintf(name, sizeof name, "%.*s%d%.*s", (int)before, at, number, (int)(length - before - 1),
                     at + before + 1);
        else
            snprintf(name, sizeof name, "%.*s", (int)length, at);
        const int column = find_bare(csv, name);
        if (column >= 0)
            return column;
    }
    return -1;
}

static moray_status refuse_unit(const moray_csv *csv, int column, const char *unit, const struct log_unit *units)
{
    char allowed[80] = "";
    for (; units->name; units++)
        snprintf(allowed + strlen(allowed), sizeof allowed - strlen(allowed), "%s%s", *allowed ? ", " : "",
                 units->name);
    return moray_csv_error(
        csv, -1,
        moray_error(MORAY_INPUT, "column %.60s: unit %.30s; must be one of %s", csv->name[column], unit, allowed));
}

// Factor to SI of a column: by the user's word, by what stands in brackets, else 1.
static moray_status find_unit(struct log_reader *r, int which, int column, double *factor)
{
    const struct log_unit *units = quantities[which].units;
    const char *name = r->csv.name[column], *bracket = strpbrk(name, "[(");
    char unit[40] = "";
    r->said[which] = assigned(r->format->units, which, unit, sizeof unit);
    if (!r->said[which] && bracket)
        snprintf(unit, sizeof unit, "%.*s", (int)strcspn(bracket + 1, "])"), bracket + 1);
    *factor = 1;
    if (!*unit)
        return moray_ok();
    for (; units->name; units++)
        if (strcmp(units->name, unit) == 0) {
            r->currents = r->currents || isnan(units->factor);
            *factor = isnan(units->factor) ? r->format->torque_constant : units->factor;
            if (isnan(*factor))
                return moray_csv_error(&r->csv, -1,
                                       moray_error(MORAY_INPUT,
                                                   "column %.60s: in A, but no torque constant "
                                                   "was given: --set torque_constant_N_m_A=K",
                                                   name));
            return moray_ok();
        }
    return refuse_unit(&r->csv, column, unit, quantities[which].units);
}

static moray_status find_quantity(struct log_reader *r, int which, int number, bool needed, int *column, double *factor)
{
    char mapped[120];
    const bool given = assigned(r->format->columns, which, mapped, sizeof mapped);
    const char *names = given ? mapped : quantities[which].names;
    *column = find_column(&r->csv, names, number);
    if (*column >= 0)
        return find_unit(r, which, *column, factor);
    if (!needed && !given)
        return moray_ok();
    return moray_csv_error(&r->csv, -1,
                           moray_error(MORAY_INPUT,
                                       "no column for %s%s%.0d: looked for %.80s; name it with --columns "
                                       "%s=NAME%s",
                                       quantities[which].key, number ? ", number " : "", number, names,
                                       quantities[which].key, number ? ", # for the number" : ""));
}

// ---- Numbers -------------------------------------------------------------------------------------------------------

static bool is_missing(const char *text)
{
    return !*text || strcasecmp(text, "nan") == 0 || strcasecmp(text, "na") == 0;
}

static moray_status read_number(const struct log_reader *r, int row, int column, bool needed, double *value)
{
    const char *text = r->csv.field[(size_t)row * (size_t)r->csv.columns + (size_t)column];
    *value = NAN;
    if (is_missing(text) && !needed)
        return moray_ok();
    return moray_csv_number(&r->csv, row, column, value);
}

// A column into value[k * stride].
static moray_status read_column(const struct log_reader *r, int column, double factor, bool needed, double *value,
                                int stride)
{
    for (int k = 0; k < r->csv.rows; k++) {
        MORAY_TRY(read_number(r, k, column, needed, &value[k * stride]));
        value[k * stride] *= factor;
    }
    return moray_ok();
}

static moray_status read_single(struct log_reader *r, int which, double *block, double **into)
{
    int column;
    double factor;
    const bool needed = which == LOG_TIME;
    MORAY_TRY(find_quantity(r, which, 0, needed, &column, &factor));
    if (column < 0)
        return moray_ok();
    r->column[which] = column;
    *into = block;
    return read_column(r, column, factor, needed, block, 1);
}

static moray_status read_numbered(struct log_reader *r, int which, bool needed, double *block, double **into)
{
    const int joints = r->format->joints;
    int column;
    double factor;
    for (int i = 0; i < joints; i++) {
        MORAY_TRY(find_quantity(r, which, i + 1, needed || i > 0, &column, &factor));
        if (column < 0)
            return moray_ok();
        r->column[which] = i ? r->column[which] : column;
        MORAY_TRY(read_column(r, column, factor, false, block + i, joints));
    }
    *into = block;
    return moray_ok();
}

// ---- The whole -----------------------------------------------------------------------------------------------------

static moray_status read_channels(struct log_reader *r, moray_swim_log *log)
{
    const int n = log->n, joints = log->joints;
    MORAY_TRY(read_single(r, LOG_TIME, log->t, &log->t));
    MORAY_TRY(read_numbered(r, r->format->reference ? LOG_REFERENCE : LOG_JOINT, true, log->phi, &log->phi));
    double *free_room = log->phi + (size_t)n * (size_t)joints;
    MORAY_TRY(read_numbered(r, LOG_TORQUE, false, free_room, &log->u));
    free_room += (size_t)n * (size_t)joints;
    MORAY_TRY(read_single(r, LOG_X, free_room, &log->p_x));
    MORAY_TRY(read_single(r, LOG_Y, free_room + n, &log->p_y));
    return read_single(r, LOG_HEADING, free_room + 2 * n, &log->heading);
}

moray_status moray_swim_log_read(moray_swim_log *log, const char *path, const moray_swim_log_format *format)
{
    struct log_reader r = {.format = format};
    *log = (moray_swim_log){.joints = format->joints, .reference = format->reference};
    snprintf(log->name, sizeof log->name, "%.79s", moray_path_tail(path));
    MORAY_TRY(check_list(format->columns, "columns"));
    MORAY_TRY(check_list(format->units, "units"));
    moray_status status = moray_csv_read(&r.csv, path, "log");
    if (!moray_failed(status))
        status = moray_swim_log_new(log, r.csv.rows, format->joints);
    if (!moray_failed(status)) {
        memcpy(log->line, r.csv.line, (size_t)log->n * sizeof *log->line);
        status = read_channels(&r, log);
        log->at_motors = r.currents;
    }
    if (!moray_failed(status))
        status = moray_swim_log_check(&r, log);
    moray_csv_free(&r.csv);
    return status;
}
