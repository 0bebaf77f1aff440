// SPDX-License-Identifier: MIT
//
// The one command that is installed: lists the programs, and becomes the one that is named.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "moray/app/options.h"
#include "moray/app/program.h"

enum { PATH_SIZE = 4200 };

typedef struct listed {
    const char *name, *does;
    const char *file; // of the executable, where Meson keeps the name to itself
} listed;

static const listed programs[] = {
    {"max_speed", "fastest gait along a course in a current", NULL},
    {"min_energy", "gait of least work per distance", NULL},
    {"search_gait", "all optima within the limits, by many starts", NULL},
    {"pareto", "fronts of speed against power on both models", NULL},
    {"free_gait", "what the sinusoidal gait leaves on the table", NULL},
    {"sensitivity", "how the fastest gait moves with current, robot and limits", NULL},
    {"heading_tracking", "gait and joint offset over time that follow a heading", NULL},
    {"path_following", "gait and joint offset over time that follow legs and arcs", NULL},
    {"min_time_turn", "fastest change of heading, or from pose to pose", NULL},
    {"sea_trials", "steering under robots, currents and noise not foreseen", NULL},
    {"identify", "a robot from logs of its swimming", NULL},
    {"ladder", "any gaits on the ladder of models", NULL},
    {"export", "a gait and its steering as C, tables, URDF", NULL},
    {"simulate", "any gait or schedule of gaits, on either model", NULL},
    {"paper", "the figures and propositions of the paper as studies", NULL},
    {"classics", "textbook problems beside their published optima", NULL},
    {"sweep", "any of these over grids, lists and draws of settings", NULL},
    {"benchmark", "where the time of a solve goes, and how it grows", "moray-benchmark"},
};
enum { N_PROGRAMS = sizeof programs / sizeof *programs };

static int width(void)
{
    int most = 0;
    for (int k = 0; k < N_PROGRAMS; k++)
        most = (int)strlen(programs[k].name) > most ? (int)strlen(programs[k].name) : most;
    return most;
}

static void list(FILE *file)
{
    fputs("Usage: moray PROGRAM [OPTION]...\n"
          "Trajectory optimisation, of the gaits of swimming snake robots above all.\n\nPROGRAM is one of:\n",
          file);
    for (int k = 0; k < N_PROGRAMS; k++)
        fprintf(file, "  %-*s  %s\n", width(), programs[k].name, programs[k].does);
    fputs("\nmoray PROGRAM --help tells its options, moray --version the version.\n", file);
}

static const listed *find(const char *name)
{
    for (int k = 0; k < N_PROGRAMS; k++)
        if (strcmp(programs[k].name, name) == 0)
            return &programs[k];
    return NULL;
}

// The folder that this command stands in.
static bool own_folder(char folder[PATH_SIZE])
{
    const ssize_t n = readlink("/proc/self/exe", folder, PATH_SIZE - 1);
    if (n <= 0)
        return false;
    folder[n] = 0;
    char *slash = strrchr(folder, '/');
    if (slash)
        *slash = 0;
    return slash != NULL;
}

// Becomes the program: installed, or beside this command where both were built. Returns only where there is none.
static int become(const listed *program, char **argv)
{
    static const char *const places[] = {MORAY_PROGRAMS, "."}; // from this command's folder
    char folder[PATH_SIZE], path[2 * PATH_SIZE];
    const char *file = program->file ? program->file : program->name;
    if (!own_folder(folder)) {
        fputs("moray: its own place cannot be told, and so not that of the programs\n", stderr);
        return MORAY_EXIT_USAGE;
    }
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        snprintf(path, sizeof path, "%s/%s/%s", folder, places[k], file);
        execv(path, argv);
        if (errno != ENOENT && errno != ENOTDIR)
            break;
    }
    fprintf(stderr, "moray: %s cannot be run: %s\n", path, strerror(errno));
    return MORAY_EXIT_USAGE;
}

// Standard output, to its last byte.
static int written(void)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return MORAY_EXIT_SOLVED;
    fprintf(stderr, "moray: standard output cannot be written: %s\n", strerror(errno));
    return MORAY_EXIT_USAGE;
}

int main(int argc, char **argv)
{
    const char *first = argc > 1 ? argv[1] : "";
    const listed *program = find(first);
    if (program)
        return become(program, argv + 1);
    if (strcmp(first, "--help") == 0) {
        list(stdout);
        return written();
    }
    if (strcmp(first, "--help=list") == 0) { // for programs that read it
        for (int k = 0; k < N_PROGRAMS; k++)
            printf("command\t%s\t%s\n", programs[k].name, programs[k].does);
        return written();
    }
    if (strcmp(first, "--version") == 0) {
        printf("moray %s\n", moray_version());
        return written();
    }
    if (*first)
        fprintf(stderr, "moray: no program %.60s; moray --help lists them\n", first);
    else
        list(stderr);
    return MORAY_EXIT_USAGE;
}
