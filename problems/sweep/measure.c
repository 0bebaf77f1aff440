// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // mkdtemp, wait4
#include "sweep/measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "moray/app/results.h"
#include "moray/app/run.h"
#include "moray/clock.h"
#include "sweep/point.h"

static double size_of(const char *file, const char *end)
{
    char path[300];
    struct stat about;
    snprintf(path, sizeof path, "%s%s", file, end);
    return stat(path, &about) == 0 ? (double)about.st_size : NAN;
}

static double processor_of(const struct rusage *used)
{
    return (double)(used->ru_utime.tv_sec + used->ru_stime.tv_sec) +
           1e-6 * (double)(used->ru_utime.tv_usec + used->ru_stime.tv_usec);
}

static void fill(cost *c, const moray_sweep_spec *spec)
{
    struct rusage own, points;
    getrusage(RUSAGE_SELF, &own);
    getrusage(RUSAGE_CHILDREN, &points);
    c->processor = processor_of(&own);
    c->points = processor_of(&points);
    c->megabytes = (double)own.ru_maxrss / 1024;
    c->file = size_of(spec->file, "");
    c->journal = size_of(spec->file, ".journal");
}

// In a process of its own, whose times and memory are then those of this sweep.
static moray_status sweep_apart(const moray_sweep_spec *spec, cost *c)
{
    int to[2];
    *c = (cost){0};
    if (pipe(to) != 0)
        return moray_error(MORAY_IO, "no pipe for a measurement");
    fflush(NULL);
    const pid_t pid = fork();
    if (pid == 0) {
        const moray_status status = moray_sweep(spec, &c->result);
        fill(c, spec);
        const bool told = write(to[1], c, sizeof *c) == (ssize_t)sizeof *c;
        if (moray_failed(status))
            fprintf(stderr, "sweep: %s\n", status.text);
        _exit(moray_failed(status) || !told);
    }
    close(to[1]);
    const bool read_all = read(to[0], c, sizeof *c) == (ssize_t)sizeof *c;
    close(to[0]);
    int ended = 1;
    if (pid > 0)
        waitpid(pid, &ended, 0);
    return read_all && ended == 0 ? moray_ok() : moray_error(MORAY_NOT_SOLVED, "a sweep that was measured failed");
}

static moray_status costs_nothing(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)self;
    fprintf(summary, "{\"objective\": %.17g", point->value[0]);
    for (int k = 1; k < NUMBERS; k++)
        fprintf(summary, ", \"number_%d\": %.17g", k, point->value[0] / (1 + k));
    fprintf(summary, "}\n");
    return moray_ok();
}

static moray_status grow(measured *m, int k)
{
    const long n = m->size[k];
    double *x = calloc((size_t)n, sizeof *x);
    if (!x)
        return moray_error(MORAY_MEMORY, "no memory for %ld points", n);
    for (long i = 0; i < n; i++)
        x[i] = (double)i / 3;
    const moray_sweep_axis axis = {.key = "x", .value = x, .n = (int)n};
    const moray_sweep_spec spec = {.file = "grown.nc",
                                   .axis = &axis,
                                   .axes = 1,
                                   .solve = costs_nothing,
                                   .jobs = 2,
                                   .quiet = true,
                                   .stop = moray_interrupted};
    moray_status status = sweep_apart(&spec, &m->made[k]);
    if (!moray_failed(status))
        status = sweep_apart(&spec, &m->read[k]);
    free(x);
    unlink("grown.nc");
    unlink("grown.nc.journal");
    return status;
}

// Every n-th point by a loop in one process, without a sweep; what it says goes to a file. Does not return.
static _Noreturn void loop(const moray_sweep_axis *axis, sweep_arguments *a, int first, int n, const char *to)
{
    FILE *file = fopen(to, "w");
    int failed = !file || !freopen("/dev/null", "w", stderr);
    for (int k = first; !failed && k < axis->n; k += n) {
        char text[32];
        const moray_key_value setting = {axis->key, moray_number_text(axis->value[k], text)};
        const moray_sweep_point point = {
            .index = k, .n = 1, .setting = &setting, .value = &axis->value[k], .solution = "left"};
        failed = moray_failed(sweep_run_program(&point, file, a));
    }
    _exit(failed);
}

// The same points by n loops, one or two, at once: what the machine can do without a sweep.
static moray_status loops(const moray_sweep_axis *axis, sweep_arguments *a, int n, const char *to, plain_loop *best)
{
    plain_loop now = {0};
    pid_t pid[2] = {-1, -1};
    bool failed = false;
    fflush(NULL);
    const double begun = moray_clock();
    for (int k = 0; k < n; k++) {
        pid[k] = fork();
        if (pid[k] == 0)
            loop(axis, a, k, n, to);
    }
    for (int k = 0; k < n; k++) {
        int ended = 1;
        struct rusage used = {0};
        failed = pid[k] < 0 || wait4(pid[k], &ended, 0, &used) != pid[k] || ended != 0 || failed;
        now.processor += processor_of(&used);
    }
    now.seconds = moray_clock() - begun;
    if (best->seconds == 0 || now.seconds < best->seconds)
        *best = now;
    return failed ? moray_error(MORAY_NOT_SOLVED, "the plain loop failed") : moray_ok();
}

static moray_status sweep_real(const moray_sweep_axis *axis, sweep_arguments *a, int jobs, bool warm, cost *c)
{
    a->cold = !warm;
    const moray_sweep_spec spec = {.file = "real.nc",
                                   .axis = axis,
                                   .axes = 1,
                                   .solve = sweep_run_program,
                                   .self = a,
                                   .objective = a->program->objective,
                                   .warm = warm,
                                   .jobs = jobs,
                                   .quiet = true,
                                   .stop = moray_interrupted};
    const moray_status status = sweep_apart(&spec, c);
    unlink("real.nc");
    unlink("real.nc.journal");
    return status;
}

static moray_status says_as_much(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point;
    fputs(self, summary);
    return moray_ok();
}

// What an answer costs that is as long as a real one, and comes behind the other as of many cores.
static moray_status answer(measured *m, sweep_arguments *a)
{
    enum { longest = 1 << 20 };
    static const char *const keep[] = {"gait.*", "gain.*", "validated.*"};
    static char text[longest];
    double x[ANSWERS];
    for (int k = 0; k < ANSWERS; k++)
        x[k] = k;
    const moray_sweep_axis axis = {.key = "current_x", .value = x, .n = ANSWERS}, one = {"current_x", x, NULL, 1};
    const moray_sweep_spec spec = {.file = "answers.nc",
                                   .axis = &axis,
                                   .axes = 1,
                                   .solve = says_as_much,
                                   .self = text,
                                   .keep = keep,
                                   .keeps = 3,
                                   .jobs = 2,
                                   .quiet = true,
                                   .stop = moray_interrupted};
    plain_loop taken = {0};
    MORAY_TRY(loops(&one, a, 1, "told", &taken));
    FILE *told = fopen("told", "r");
    text[told ? fread(text, 1, longest - 1, told) : 0] = 0;
    if (told)
        fclose(told);
    unlink("told");
    const moray_status status = sweep_apart(&spec, &m->answers);
    unlink("answers.nc");
    unlink("answers.nc.journal");
    return status;
}

// The quickest of several measurements: what disturbs a machine makes it slower only.
static moray_status compare(measured *m, sweep_arguments *a)
{
    double x[REAL_POINTS];
    for (int k = 0; k < REAL_POINTS; k++)
        x[k] = 0.1 * k / (REAL_POINTS - 1);
    const moray_sweep_axis axis = {.key = "current_x", .value = x, .n = REAL_POINTS};
    for (int repeat = 0; repeat < a->repeats; repeat++)
        for (int jobs = 1; jobs <= 2; jobs++) {
            cost now;
            cost *best = jobs == 1 ? &m->one : &m->two;
            a->cold = true;
            MORAY_TRY(loops(&axis, a, jobs, "/dev/null", jobs == 1 ? &m->loop : &m->two_loops));
            MORAY_TRY(sweep_real(&axis, a, jobs, false, &now));
            if (repeat == 0 || now.result.seconds < best->result.seconds)
                *best = now;
        }
    return sweep_real(&axis, a, 2, true, &m->warm);
}

static moray_status measure_all(measured *m, sweep_arguments *a)
{
    for (int k = SIZES - 1; k >= 0; k--)
        m->size[k] = k == SIZES - 1 ? a->most : (m->size[k + 1] + 9) / 10;
    for (int k = 0; k < SIZES; k++)
        MORAY_TRY(grow(m, k));
    MORAY_TRY(answer(m, a));
    return compare(m, a);
}

moray_status sweep_measure(sweep_arguments *a, int argc, char **argv)
{
    static char consistent[] = "--hydrodynamics=consistent", *rest[] = {consistent};
    static measured m;
    char folder[] = "/tmp/moray-measure-XXXXXX", here[4096];
    sweep_arguments real = *a;
    real.program = sweepable_find("max_speed");
    real.rest = rest;
    real.rest_n = 1;
    if (!getcwd(here, sizeof here) || !mkdtemp(folder) || chdir(folder) != 0)
        return moray_error(MORAY_IO, "no folder to measure in");
    moray_status status = measure_all(&m, &real);
    unlink("left");
    if (chdir(here) != 0 && !moray_failed(status))
        status = moray_error(MORAY_IO, "%.200s is no longer there", here);
    rmdir(folder);
    return moray_failed(status) ? status : measured_tell(&m, a, argc, argv);
}
