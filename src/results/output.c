// SPDX-License-Identifier: MIT
#include "results/results.h"
#include "results/staging.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_FILES = 128, NAME_SIZE = 128 };

typedef struct staged_file {
    char name[NAME_SIZE];
    FILE *file;           // NULL once closed
    bool replaces, moved; // during the commit: an earlier file was put aside; the new one is in place
} staged_file;

// Staging is a directory inside the target, so that a rename never crosses file systems. It exists from the first file
// to the commit only: nothing is on disk while the solver works.
struct moray_output {
    char directory[PATH_MAX - 2 * NAME_SIZE];
    char staging[PATH_MAX - NAME_SIZE]; // empty while there is none
    int held;                           // lock of it
    size_t made;                        // length of the topmost directory that we made, as a prefix of directory; or 0
    staged_file file[MOST_FILES];
    int n;
    bool gnuplot_hangs, summarised;
};

// mkdir -p that remembers the first directory it had to make; returns 0 or errno.
static int make_directories(moray_output *output)
{
    char path[sizeof output->directory];
    for (size_t i = 1; i <= strlen(output->directory); i++) {
        if (output->directory[i] != '/' && output->directory[i] != 0)
            continue;
        snprintf(path, sizeof path, "%.*s", (int)i, output->directory);
        if (mkdir(path, 0777) == 0)
            output->made = output->made ? output->made : i;
        else if (errno != EEXIST)
            return errno;
    }
    return 0;
}

// Removes the directories that we made and that are empty.
static void remove_directories(moray_output *output)
{
    char path[sizeof output->directory];
    for (size_t i = strlen(output->directory); output->made && i >= output->made; i--) {
        if (output->directory[i] != '/' && output->directory[i] != 0)
            continue;
        snprintf(path, sizeof path, "%.*s", (int)i, output->directory);
        rmdir(path);
    }
    output->made = 0;
}

static void unstage(moray_output *output)
{
    if (output->staging[0])
        moray_staging_end(output->staging, output->held);
    output->staging[0] = 0;
    remove_directories(output);
}

static moray_status stage(moray_output *output)
{
    if (output->staging[0])
        return moray_ok();
    int why = make_directories(output);
    snprintf(output->staging, sizeof output->staging, "%s/.moray-XXXXXX", output->directory);
    if (why == 0)
        why = moray_staging_new(output->staging, &output->held);
    if (why == 0)
        return moray_ok();
    output->staging[0] = 0;
    unstage(output);
    return moray_error(MORAY_IO, "output directory %.120s: cannot be written to: %s", output->directory, strerror(why));
}

moray_status moray_output_open(moray_output **output, const char *directory)
{
    moray_output *made = calloc(1, sizeof *made);
    if (!made)
        return moray_error(MORAY_MEMORY, "output directory %.100s: no memory for its files", directory);
    moray_status status;
    if (!*directory || strlen(directory) >= sizeof made->directory) {
        status = moray_error(MORAY_IO, "output directory %.100s: the name is %s", directory,
                             *directory ? "too long" : "empty");
    } else {
        strcpy(made->directory, directory);
        moray_staging_clear(directory);
        status = stage(made);
    }
    unstage(made);
    if (moray_failed(status))
        free(made);
    else
        *output = made;
    return status;
}

// Where a file stands: "" in place, "new." while it is written, "old." an earlier one that it replaces.
typedef char file_path[PATH_MAX];
static const char *path_of(const moray_output *output, const char *name, const char *stage_of, file_path path)
{
    const char *directory = *stage_of ? output->staging : output->directory;
    snprintf(path, sizeof(file_path), "%s/%s%s", directory, stage_of, name);
    return path;
}

static moray_status check_name(const moray_output *output, const char *name)
{
    if (!*name || strchr(name, '/') || *name == '.' || strlen(name) >= NAME_SIZE)
        return moray_error(MORAY_INPUT, "output file %.80s: not a plain file name of at most %d bytes", name,
                           NAME_SIZE - 1);
    for (int i = 0; i < output->n; i++)
        if (strcmp(output->file[i].name, name) == 0)
            return moray_error(MORAY_INPUT, "output file %s: written twice", name);
    if (output->n == MOST_FILES)
        return moray_error(MORAY_INPUT, "output file %s: more than %d files", name, MOST_FILES);
    return moray_ok();
}

moray_status moray_output_file(moray_output *output, const char *name, FILE **file)
{
    file_path path;
    MORAY_TRY(check_name(output, name));
    MORAY_TRY(stage(output));
    FILE *opened = fopen(path_of(output, name, "new.", path), "w+e");
    if (!opened)
        return moray_error(MORAY_IO, "output file %s: cannot be written: %s", name, strerror(errno));
    staged_file *next = &output->file[output->n++];
    *next = (staged_file){.file = opened};
    strcpy(next->name, name);
    *file = opened;
    return moray_ok();
}

const char *moray_output_name(const moray_output *output, int i)
{
    return i < output->n ? output->file[i].name : NULL;
}

bool moray_output_summarised(const moray_output *output)
{
    return output->summarised;
}

bool *moray_output_gnuplot_hangs(moray_output *output)
{
    return &output->gnuplot_hangs;
}

FILE *moray_output_stream(const moray_output *output, int i)
{
    return output->file[i].file;
}

void moray_output_drop(moray_output *output)
{
    file_path path;
    const staged_file *last = &output->file[--output->n];
    if (last->file)
        fclose(last->file);
    unlink(path_of(output, last->name, "new.", path));
}

void moray_output_discard(moray_output *output)
{
    while (output->n)
        moray_output_drop(output);
    unstage(output);
}

static moray_status close_files(moray_output *output)
{
    for (int i = 0; i < output->n; i++) {
        staged_file *file = &output->file[i];
        const bool failed = ferror(file->file);
        if (fclose(file->file) != 0 || failed) {
            const int why = errno;
            file->file = NULL;
            return moray_error(MORAY_IO, "output file %s: cannot be written: %s", file->name, strerror(why));
        }
        file->file = NULL;
    }
    return moray_ok();
}

static moray_status put_in_place(const moray_output *output, staged_file *file)
{
    file_path target, fresh, old;
    struct stat about;
    path_of(output, file->name, "", target);
    path_of(output, file->name, "old.", old);
    if (lstat(target, &about) == 0) {
        if (S_ISDIR(about.st_mode))
            return moray_error(MORAY_IO, "output file %s: is a directory in %.100s", file->name, output->directory);
        file->replaces = rename(target, old) == 0;
    }
    file->moved = rename(path_of(output, file->name, "new.", fresh), target) == 0;
    if (!file->moved)
        return moray_error(MORAY_IO, "output file %s: cannot be put in place: %s", file->name, strerror(errno));
    return moray_ok();
}

static void take_back(const moray_output *output, const staged_file *file)
{
    file_path target, fresh, old;
    path_of(output, file->name, "", target);
    if (file->moved)
        rename(target, path_of(output, file->name, "new.", fresh));
    if (file->replaces)
        rename(path_of(output, file->name, "old.", old), target);
}

moray_status moray_output_commit(moray_output *output)
{
    file_path old;
    moray_status status = close_files(output);
    for (int i = 0; i < output->n && !moray_failed(status); i++)
        status = put_in_place(output, &output->file[i]);
    if (moray_failed(status)) {
        for (int i = 0; i < output->n; i++)
            take_back(output, &output->file[i]);
        moray_output_discard(output);
        return status;
    }
    for (int i = 0; i < output->n; i++) {
        output->summarised = output->summarised || strcmp(output->file[i].name, "summary.json") == 0;
        if (output->file[i].replaces)
            unlink(path_of(output, output->file[i].name, "old.", old));
    }
    output->n = 0;
    output->made = 0;
    unstage(output);
    return status;
}

void moray_output_free(moray_output *output)
{
    if (output)
        moray_output_discard(output);
    free(output);
}
