// SPDX-License-Identifier: MIT
//
// What stands beside the file of a sweep, and whether the file is its own.
#include "sweep/sweep.h"

#include <dirent.h>
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void moray_files_beside(const moray_sweep_spec *spec, const char *end, char path[BESIDE_SIZE])
{
    snprintf(path, BESIDE_SIZE, "%s.%s", spec->file, end);
}

moray_status moray_files_begin(const moray_sweep_spec *spec)
{
    char path[BESIDE_SIZE];
    moray_files_beside(spec, "solutions", path);
    if (!spec->warm || mkdir(path, 0777) == 0 || errno == EEXIST)
        return moray_ok();
    return moray_error(MORAY_IO, "%.200s: %s", path, strerror(errno));
}

void moray_files_remove_solutions(const moray_sweep_spec *spec)
{
    char path[BESIDE_SIZE], name[BESIDE_SIZE + 400];
    moray_files_beside(spec, "solutions", path);
    DIR *folder = opendir(path);
    for (const struct dirent *entry; folder && (entry = readdir(folder));) {
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        if (entry->d_name[0] != '.')
            unlink(name);
    }
    if (folder)
        closedir(folder);
    rmdir(path);
}

moray_status moray_files_check(const moray_sweep_spec *spec)
{
    char journal[BESIDE_SIZE];
    struct stat about;
    moray_files_beside(spec, "journal", journal);
    if (stat(spec->file, &about) != 0)
        return moray_ok();
    if (!S_ISREG(about.st_mode))
        return moray_error(MORAY_INPUT, "%.200s is not a regular file", spec->file);
    return access(journal, F_OK) == 0 ? moray_ok()
                                      : moray_error(MORAY_INPUT,
                                                    "%.90s is there and %.90s, from which it would be gone on with, is "
                                                    "not: give another file, or remove it",
                                                    spec->file, journal);
}

void moray_files_remove_all(const moray_sweep_spec *spec)
{
    char path[BESIDE_SIZE];
    moray_files_beside(spec, "journal", path);
    unlink(path);
    unlink(spec->file);
    moray_files_remove_solutions(spec);
}
