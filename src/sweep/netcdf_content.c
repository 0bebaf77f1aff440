// SPDX-License-Identifier: MIT
//
// What the file holds; with netcdf.c, which knows the way to the disk and back, all that calls NetCDF. One dimension a
// key, results over all of them; conventions of CF 1.8.
#include <ctype.h>
#include <netcdf.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/options.h"
#include "sweep/sweep.h"

// The first error of many calls.
typedef struct writer {
    const struct store *store;
    int file, error;
    int dimension[GRID_AXES];
} writer;

static void call(writer *w, int error)
{
    if (w->error == NC_NOERR)
        w->error = error;
}

// Letters, digits and underscores, as CF recommends; signs of numbers in words, so that c_n+20 and c_n-20 differ.
void moray_netcdf_name(const char *path, char name[NETCDF_NAME])
{
    int n = 0;
    if (!isalpha((unsigned char)path[0]))
        name[n++] = 'p';
    for (; *path && n + 6 < NC_MAX_NAME; path++) {
        const bool sign = (*path == '+' || *path == '-') && isdigit((unsigned char)path[1]);
        if (sign)
            n += snprintf(name + n, 7, *path == '+' ? "_plus" : "_minus");
        else
            name[n++] = isalnum((unsigned char)*path) ? *path : '_';
    }
    name[n] = 0;
}

// What the end of a name says, as UDUNITS has it: speed_m_s is in m s-1.
static const char *unit_of(const char *name)
{
    static const char *const ends[][2] = {
        {"_J_m", "J m-1"}, {"_deg_s", "degree s-1"}, {"_m_s", "m s-1"}, {"_N_m", "N m"}, {"_deg", "degree"},
        {"_W", "W"},       {"_percent", "percent"},  {"_m", "m"},       {"_s", "s"},     {"_J", "J"}};
    for (unsigned k = 0; k < sizeof ends / sizeof *ends; k++) {
        const size_t length = strlen(name), end = strlen(ends[k][0]);
        if (length > end && strcmp(name + length - end, ends[k][0]) == 0)
            return ends[k][1];
    }
    return "1";
}

static void text(writer *w, int variable, const char *name, const char *value)
{
    if (w->error == NC_NOERR && value)
        call(w, nc_put_att_text(w->file, variable, name, strlen(value), value));
}

static int define(writer *w, const char *name, nc_type type, int n, const int *dimension, const char *about,
                  const char *unit)
{
    int id = -1;
    char plain[NETCDF_NAME];
    moray_netcdf_name(name, plain);
    if (w->error != NC_NOERR)
        return id;
    while (nc_inq_varid(w->file, plain, &id) == NC_NOERR && strlen(plain) + 6 < sizeof plain) { // a key, say
        memmove(plain + 6, plain, strlen(plain) + 1);
        memcpy(plain, "found_", 6);
    }
    call(w, nc_def_var(w->file, plain, type, n, dimension, &id));
    text(w, id, "long_name", about);
    text(w, id, "units", unit);
    return id;
}

static void define_axes(writer *w)
{
    const struct grid *grid = w->store->grid;
    char plain[NETCDF_NAME];
    for (int k = 0; k < grid->axes; k++) {
        moray_netcdf_name(k < grid->first ? "draw" : grid->spec->axis[k - grid->first].key, plain);
        call(w, nc_def_dim(w->file, plain, (size_t)grid->shape[k], &w->dimension[k]));
    }
}

static void write_axis(writer *w, int k)
{
    const struct grid *grid = w->store->grid;
    const moray_sweep_axis *axis = &grid->spec->axis[k - grid->first];
    const int id = define(w, axis->key, axis->value ? NC_DOUBLE : NC_STRING, 1, &w->dimension[k], axis->key,
                          axis->value ? unit_of(axis->key) : NULL);
    if (w->error != NC_NOERR)
        return;
    if (axis->value) {
        call(w, nc_put_var_double(w->file, id, axis->value));
        return;
    }
    for (size_t i = 0; i < (size_t)axis->n; i++) {
        const char *word = axis->word[i];
        call(w, nc_put_var1_string(w->file, id, &i, &word));
    }
}

static void write_draws(writer *w)
{
    const moray_sweep_spec *spec = w->store->grid->spec;
    for (int r = 0; r < spec->ranges; r++) {
        const int id = define(w, spec->range[r].key, NC_DOUBLE, 1, &w->dimension[0], "drawn at random",
                              unit_of(spec->range[r].key));
        for (size_t i = 0; w->error == NC_NOERR && i < (size_t)spec->draws; i++) {
            const double value = moray_grid_draw(spec, (long)i, r);
            call(w, nc_put_var1_double(w->file, id, &i, &value));
        }
    }
}

static int over_points(writer *w, const char *name, nc_type type, const char *about, const char *unit)
{
    return define(w, name, type, w->store->grid->axes, w->dimension, about, unit);
}

static void put_doubles(writer *w, const char *name, const char *about, const double *value)
{
    const int id = over_points(w, name, NC_DOUBLE, about, unit_of(name));
    if (w->error == NC_NOERR)
        call(w, nc_put_var_double(w->file, id, value));
}

// A code a point, with what each stands for, as CF's flags.
static void put_flags(writer *w, const char *name, const char *about, const char *meanings, int n,
                      const signed char *value)
{
    signed char values[16];
    for (int k = 0; k < n; k++)
        values[k] = (signed char)k;
    const int id = over_points(w, name, NC_BYTE, about, NULL);
    if (w->error != NC_NOERR)
        return;
    call(w, nc_put_att_schar(w->file, id, "flag_values", NC_BYTE, (size_t)n, values));
    text(w, id, "flag_meanings", meanings);
    call(w, nc_put_var_schar(w->file, id, value));
}

static void put_starts(writer *w)
{
    const int id =
        over_points(w, "sweep_start", NC_INT64,
                    "point, counted in the order of the dimensions, whose solution it began with; -1: none", NULL);
    if (w->error != NC_NOERR)
        return;
    long long *value = calloc((size_t)w->store->grid->points, sizeof *value);
    if (!value) {
        call(w, NC_ENOMEM);
        return;
    }
    for (long k = 0; k < w->store->grid->points; k++)
        value[k] = w->store->start[k];
    call(w, nc_put_var_longlong(w->file, id, value));
    free(value);
}

static void put_reasons(writer *w)
{
    const int id = over_points(w, "sweep_reason", NC_STRING, "why the point is not solved", NULL);
    if (w->error != NC_NOERR)
        return;
    const char **value = calloc((size_t)w->store->grid->points, sizeof *value);
    if (!value) {
        call(w, NC_ENOMEM);
        return;
    }
    for (long k = 0; k < w->store->grid->points; k++)
        value[k] = w->store->reason[k] ? w->store->reason[k] : "";
    call(w, nc_put_var_string(w->file, id, value));
    free(value);
}

static void write_header(writer *w, bool finished)
{
    const moray_sweep_spec *spec = w->store->grid->spec;
    char seed[32];
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)spec->seed);
    text(w, NC_GLOBAL, "Conventions", "CF-1.8");
    text(w, NC_GLOBAL, "title", spec->title);
    text(w, NC_GLOBAL, "source", "moray");
    text(w, NC_GLOBAL, "version", moray_version());
    text(w, NC_GLOBAL, "command", spec->command);
    text(w, NC_GLOBAL, "configuration", spec->configuration);
    text(w, NC_GLOBAL, "seed", spec->draws > 0 ? seed : NULL);
    text(w, NC_GLOBAL, "complete", finished ? "yes" : "no");
}

static void write_all(writer *w, bool finished)
{
    const struct store *store = w->store;
    write_header(w, finished);
    define_axes(w);
    for (int k = store->grid->first; k < store->grid->axes; k++)
        write_axis(w, k);
    write_draws(w);
    put_flags(w, "sweep_state", "what became of the point", "untried solved failed", 3, store->state);
    put_flags(w, "sweep_code", "kind of failure",
              "none bad_input out_of_memory cannot_read_or_write numerical_failure not_solved interrupted", 7,
              store->code);
    put_flags(w, "sweep_round", "0: solved from its parent; later: from a neighbour whose branch was better",
              "parent first second third", 4, store->round);
    put_starts(w);
    put_doubles(w, "sweep_objective", "what the better of two solutions is told by", store->objective);
    put_doubles(w, "sweep_other_objective", "the same of the branch that was given up", store->other);
    put_doubles(w, "sweep_time_s", "time on the clock for all attempts at the point", store->seconds);
    put_reasons(w);
    for (int k = 0; k < store->n; k++)
        put_doubles(w, store->name[k], store->name[k], store->value[k]);
}

int moray_netcdf_content(int file, const struct store *store, bool finished)
{
    writer w = {.store = store, .file = file};
    write_all(&w, finished);
    return w.error;
}
