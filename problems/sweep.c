// SPDX-License-Identifier: MIT
//
// A program over all combinations of settings: on all cores of this machine or, under mpirun or srun, on many.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/program.h"
#include "moray/app/run.h"
#include "sweep/point.h"
#include "sweep/report.h"

// The program and its own arguments, as one text: what they are decides what a point is.
static char *configuration_of(const sweep_arguments *a)
{
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    if (!file)
        return NULL;
    fprintf(file, "%s", a->program->name);
    for (int k = 0; k < a->rest_n; k++)
        fprintf(file, " %s", a->rest[k]);
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
    moray_interrupt_begin();
    const moray_status status = run(&arguments, argc, argv);
    moray_interrupt_end();
    sweep_arguments_free(&arguments);
    if (moray_failed(status))
        fprintf(stderr, "sweep: %s\n", status.text);
    return moray_exit_of(status.code);
}
