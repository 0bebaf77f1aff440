// SPDX-License-Identifier: MIT
//
// The process of a point, seen from inside.
#include "sweep/sweep.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

void moray_solution_path(const moray_sweep_spec *spec, long point, int round, char *path, size_t size)
{
    snprintf(path, size, "%s.solutions/%ld.%d", spec->file, point, round);
}

static void limit_memory(double megabytes)
{
    if (megabytes <= 0)
        return;
    const struct rlimit limit = {(rlim_t)(megabytes * 1048576), (rlim_t)(megabytes * 1048576)};
    setrlimit(RLIMIT_AS, &limit); // where the system refuses it, the point runs without
}

// Solves the point and ends.
static _Noreturn void solve(const struct grid *grid, const struct task *task, int summary_fd)
{
    enum { most = MORAY_SWEEP_AXES + MORAY_SWEEP_RANGES };
    const moray_sweep_spec *spec = grid->spec;
    moray_key_value setting[most];
    double value[most];
    char text[most][32], guess[4200], solution[4200];
    moray_grid_settings(grid, task->point, setting, value, text);
    moray_solution_path(spec, task->point, task->round, solution, sizeof solution);
    if (task->start >= 0)
        moray_solution_path(spec, task->start, task->start_round, guess, sizeof guess);
    const moray_sweep_point point = {.index = task->point,
                                     .n = spec->axes + spec->ranges,
                                     .setting = setting,
                                     .value = value,
                                     .guess = task->start >= 0 ? guess : NULL,
                                     .solution = solution};
    limit_memory(spec->point_megabytes);
    FILE *summary = fdopen(summary_fd, "w");
    moray_status status =
        summary ? spec->solve(&point, summary, spec->self) : moray_error(MORAY_MEMORY, "no memory for a point");
    if (summary)
        fclose(summary);
    fflush(NULL);
    if (moray_failed(status) && status.text[0]) // else what it said last is the reason
        dprintf(STDERR_FILENO, "%c%s", REASON_MARK, status.text);
    _exit((int)status.code);
}

// A process group of its own, so that a point can be ended with all that it started; and it ends with its parent.
void moray_child_run(const struct grid *grid, const struct task *task, const int summary[2], const int errors[2],
                     pid_t parent)
{
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(MORAY_INTERRUPTED);
    signal(SIGINT, SIG_IGN); // of a terminal, for the parent to answer
    const int null = open("/dev/null", O_RDWR);
    dup2(null, STDIN_FILENO);
    dup2(null, STDOUT_FILENO);
    dup2(errors[1], STDERR_FILENO);
    const int out = fcntl(summary[1], F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    solve(grid, task, out);
}
