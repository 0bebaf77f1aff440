// SPDX-License-Identifier: MIT
#include <ctype.h>
#include <string.h>

#include "moray/app/run.h"

static void file_name(const char *name, char file[100])
{
    snprintf(file, 100, "%.80s.iterate", name);
    for (char *c = file; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr("._-", *c))
            *c = '-';
}

moray_status moray_iterate_keep(const moray_common *common, const char *name, const moray_solution *solution,
                                char path[MORAY_PATH_SIZE])
{
    char base[100];
    FILE *file;
    file_name(name, base);
    if (!common->output) {
        snprintf(path, MORAY_PATH_SIZE, "%s", base);
        return moray_solution_save(solution, path);
    }
    if (snprintf(path, MORAY_PATH_SIZE, "%s/%s", common->out, base) >= MORAY_PATH_SIZE)
        return moray_error(MORAY_INPUT, "the path %.60s... is too long", common->out);
    MORAY_TRY(moray_output_file(common->output, base, &file));
    moray_solution_write(solution, file);
    return moray_ok();
}

moray_status moray_interruption(const moray_solution *solution, const char *path)
{
    return moray_error(MORAY_INTERRUPTED, "interrupted after %d iterations; to go on: --continue %.220s",
                       moray_solution_info(solution)->iterations, path);
}

moray_status moray_check_starts(const char *from_file, const char *guess_file)
{
    if (from_file[0] && guess_file[0])
        return moray_error(MORAY_INPUT, "--continue and --guess: must be one of them");
    return moray_ok();
}

moray_status moray_solution_leave(const moray_solution *solution, moray_output *output)
{
    FILE *file;
    MORAY_TRY(moray_output_file(output, "solution.moray", &file));
    moray_solution_write(solution, file);
    return moray_ok();
}
