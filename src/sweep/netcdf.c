// SPDX-License-Identifier: MIT
//
// The file, to the disk and back.
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <math.h>
#include <netcdf.h>
#include <netcdf_mem.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "sweep/sweep.h"

// The file as it stands in memory, to the disk.
static int write_image(const NC_memio *image, const char *path)
{
    const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0)
        return errno;
    size_t done = 0;
    int error = 0;
    while (done < image->size && !error) {
        const ssize_t n = write(fd, (const char *)image->memory + done, image->size - done);
        if (n >= 0)
            done += (size_t)n;
        else if (errno != EINTR)
            error = errno;
    }
    if (!error && fsync(fd) != 0 && errno != EINVAL)
        error = errno;
    if (close(fd) != 0 && !error)
        error = errno;
    return error;
}

static int make_image(const struct store *store, bool finished, const char *name, NC_memio *image)
{
    int file;
    int error = nc_create_mem(name, NC_NETCDF4, 1 << 16, &file);
    if (error != NC_NOERR)
        return error;
    error = moray_netcdf_content(file, store, finished);
    const int closed = nc_close_memio(file, image);
    return error != NC_NOERR ? error : closed;
}

// HDF5 does not survive a disk that is full, so the file is made in memory and written by us.
moray_status moray_store_write(const struct store *store, bool finished)
{
    const char *name = store->grid->spec->file;
    char temporary[4200];
    snprintf(temporary, sizeof temporary, "%s.new", name);
    NC_memio image = {0};
    const int failed = make_image(store, finished, temporary, &image);
    const int error = failed == NC_NOERR ? write_image(&image, temporary) : 0;
    free(image.memory);
    if (failed == NC_NOERR && !error && rename(temporary, name) == 0)
        return moray_ok();
    const char *why = failed != NC_NOERR ? nc_strerror(failed) : strerror(error ? error : errno);
    unlink(temporary);
    return moray_error(failed == NC_ENOMEM ? MORAY_MEMORY : MORAY_IO, "%.200s cannot be written: %s", name, why);
}

// The path of a number, which its variable has as long name; "" where there is none.
static void path_of(int file, int id, char path[NETCDF_NAME])
{
    size_t length = 0;
    memset(path, 0, NETCDF_NAME);
    if (nc_inq_attlen(file, id, "long_name", &length) != NC_NOERR || length >= NETCDF_NAME ||
        nc_get_att_text(file, id, "long_name", path) != NC_NOERR)
        path[0] = 0;
}

// The variable of a number, by its path, since names of two paths can be alike; else by its name.
static int find(int file, const char *path, int *id)
{
    char there[NETCDF_NAME];
    int variables = 0;
    const int error = nc_inq_nvars(file, &variables);
    if (error != NC_NOERR)
        return error;
    for (*id = 0; *id < variables; ++*id) {
        path_of(file, *id, there);
        if (strcmp(there, path) == 0)
            return NC_NOERR;
    }
    moray_netcdf_name(path, there);
    return nc_inq_varid(file, there, id);
}

static int read_numbers(int file, int id, double **value, size_t *n)
{
    int axes, dimension[NC_MAX_VAR_DIMS];
    int error = nc_inq_varndims(file, id, &axes);
    if (error == NC_NOERR)
        error = nc_inq_vardimid(file, id, dimension);
    *n = 1;
    for (int k = 0; error == NC_NOERR && k < axes; k++) {
        size_t length = 0;
        error = nc_inq_dimlen(file, dimension[k], &length);
        *n *= length;
    }
    if (error == NC_NOERR && !(*value = calloc(*n, sizeof **value)))
        return NC_ENOMEM;
    return error == NC_NOERR ? nc_get_var_double(file, id, *value) : error;
}

static moray_status tell(int error, const char *path, const char *name)
{
    if (error == NC_NOERR)
        return moray_ok();
    if (error == NC_ENOTVAR)
        return moray_error(MORAY_INPUT, "%.200s has no number %.60s", path, name);
    return moray_error(error == NC_ENOMEM ? MORAY_MEMORY : MORAY_IO, "%.200s: %s", path, nc_strerror(error));
}

moray_status moray_sweep_numbers(const char *path, const char *name, double **value, long *n)
{
    int file, id = 0;
    size_t count = 0;
    *value = NULL;
    int error = nc_open(path, NC_NOWRITE, &file);
    if (error != NC_NOERR)
        return tell(error, path, name);
    error = find(file, name, &id);
    if (error == NC_NOERR)
        error = read_numbers(file, id, value, &count);
    nc_close(file);
    *n = (long)count;
    if (error != NC_NOERR) {
        free(*value);
        *value = NULL;
    }
    return tell(error, path, name);
}

static void widen(double *least, double *most, const double *value, size_t n)
{
    for (size_t k = 0; k < n; k++) { // NaN gives way to any number
        least[k] = fmin(least[k], value[k]);
        most[k] = fmax(most[k], value[k]);
    }
}

// Takes in variable `id` where its path matches.
static int match(int file, int id, const char *pattern, double **least, double **most, size_t *n)
{
    char path[NETCDF_NAME];
    size_t count = 0;
    double *value = NULL;
    path_of(file, id, path);
    if (!*path || fnmatch(pattern, path, 0) != 0)
        return NC_NOERR;
    const int error = read_numbers(file, id, &value, &count);
    if (error != NC_NOERR || (*least && count != *n)) { // of another shape: no result
        free(value);
        return error;
    }
    if (*least) {
        widen(*least, *most, value, count);
        free(value);
        return NC_NOERR;
    }
    *least = value;
    *n = count;
    *most = malloc(count * sizeof **most);
    if (!*most)
        return NC_ENOMEM;
    memcpy(*most, value, count * sizeof *value);
    return NC_NOERR;
}

moray_status moray_sweep_extremes(const char *path, const char *pattern, double **least, double **most, long *n)
{
    int file, variables = 0;
    size_t count = 0;
    *least = *most = NULL;
    int error = nc_open(path, NC_NOWRITE, &file);
    if (error != NC_NOERR)
        return tell(error, path, pattern);
    error = nc_inq_nvars(file, &variables);
    for (int id = 0; error == NC_NOERR && id < variables; id++)
        error = match(file, id, pattern, least, most, &count);
    nc_close(file);
    *n = (long)count;
    if (error == NC_NOERR && *least)
        return moray_ok();
    free(*least);
    free(*most);
    *least = *most = NULL;
    return tell(error == NC_NOERR ? NC_ENOTVAR : error, path, pattern);
}
