// SPDX-License-Identifier: MIT
//
// A program over all combinations of settings: on all cores of this machine or, under mpirun or srun, on many.
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "moray/app/program.h"
#include "moray/app/run.h"
#include "sweep/measure.h"
#include "sweep/point.h"
#include "sweep/report.h"

// Of a file that is named, what is in it, as a sum (FNV-1a): a robot that was changed makes another sweep.
static void add_contents(FILE *to, const char *name)
{
    uint64_t sum = 14695981039346656037u;
    struct stat about;
    FILE *file = stat(name, &about) == 0 && S_ISREG(about.st_mode) ? fopen(name, "r") : NULL;
    if (!file)
        return;
    for (int c; (c = getc(file)) != EOF;)
        sum = (sum ^ (uint64_t)c) * 1099511628211u;
    fclose(file);
    fprintf(to, " (%016llx)", (unsigned long long)sum);
}

// Keys of files that the program itself makes along the way, as [--]KEY=FILE or KEY.
static bool is_made(const char *key)
{
    static const char *const made[] = {"tuned", "results"};
    key += strspn(key, "-");
    const size_t length = strcspn(key, "=");
    bool found = false;
    for (unsigned k = 0; k < sizeof made / sizeof *made; k++)
        found = found || (strlen(made[k]) == length && strncmp(key, made[k], length) == 0);
    return found;
}

// The program and its own arguments, as one text: what they are decides what a point is.
static char *configuration_of(const sweep_arguments *a)
{
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    if (!file)
        return NULL;
    fprintf(file, "%s", a->program->name);
    for (int k = 0; k < a->rest_n; k++) {
        const char *equals = strchr(a->rest[k], '=');
        fprintf(file, " %s", a->rest[k]);
        if (!is_made(a->rest[k]))
            add_contents(file, equals ? equals + 1 : a->rest[k]);
    }
    for (int k = 0; k < a->axes; k++)
        for (int i = 0; a->axis[k].word && !is_made(a->axis[k].key) && i < a->axis[k].n; i++)
            add_contents(file, a->axis[k].word[i]);
    fclose(file);
    return text;
}

static char *command_of(int argc, char **argv)
{
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    if (!file)
        return NULL;
    fprintf(file, "sweep");
    for (int k = 1; k < argc; k++)
        fprintf(file, " %s", argv[k]);
    fclose(file);
    return text;
}

static moray_status run(sweep_arguments *a, int argc, char **argv)
{
    char *configuration = configuration_of(a), *command = command_of(argc, argv);
    const moray_sweep_spec spec = {.file = a->file,
                                   .title = a->program->name,
                                   .command = command,
                                   .configuration = configuration,
                                   .axis = a->axis,
                                   .axes = a->axes,
                                   .range = a->range,
                                   .ranges = a->ranges,
                                   .draws = a->draws,
                                   .seed = a->seed,
                                   .solve = sweep_run_program,
                                   .self = a,
                                   .objective = a->objective,
                                   .warm = !a->cold && a->program->guess,
                                   .jobs = a->jobs,
                                   .point_seconds = a->point_seconds,
                                   .point_megabytes = a->point_megabytes,
                                   .silent_seconds = a->silent_seconds,
                                   .page = a->page,
                                   .keep = a->keep,
                                   .keeps = a->kept,
                                   .quiet = a->quiet,
                                   .stop = moray_interrupted};
    moray_sweep_result result;
    moray_status status =
        configuration && command ? moray_sweep(&spec, &result) : moray_error(MORAY_MEMORY, "no memory for the command");
    free(configuration);
    free(command);
    return moray_failed(status) || moray_sweep_rank() > 0 ? status : sweep_report(a, &result, argc, argv);
}

int main(int argc, char **argv)
{
    sweep_arguments arguments;
    int exit_code;
    if (!sweep_arguments_read(argc, argv, &arguments, &exit_code))
        return exit_code;
    signal(SIGXFSZ, SIG_IGN); // a file that grows beyond a limit is told, as a disk that is full is
    moray_interrupt_begin();
    const moray_status status =
        arguments.program->main ? run(&arguments, argc, argv) : sweep_measure(&arguments, argc, argv);
    moray_interrupt_end();
    sweep_arguments_free(&arguments);
    if (moray_failed(status))
        fprintf(stderr, "sweep: %s\n", status.text);
    return moray_exit_of(status.code);
}
