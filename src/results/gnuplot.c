// SPDX-License-Identifier: MIT
#include "results/results.h"

#include <errno.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "moray/clock.h"

extern char **environ;

enum { PATIENCE = 20 }; // seconds for one picture, which takes a tenth of one

// In a process group of its own, so that it ends with all that it started. Returns 0 or errno.
static int start(FILE *script, FILE *picture, FILE *complaints, pid_t *process)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    char *const arguments[] = {"gnuplot", "-d", "-", NULL};
    int failed = posix_spawn_file_actions_init(&files);
    if (failed)
        return failed;
    if ((failed = posix_spawnattr_init(&attributes)) == 0) {
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
        posix_spawn_file_actions_adddup2(&files, fileno(script), STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&files, fileno(picture), STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&files, fileno(complaints), STDERR_FILENO);
        failed = posix_spawnp(process, "gnuplot", &files, &attributes, arguments, environ);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&files);
    return failed;
}

// Until it ends or patience does: then it is made to, and ETIMEDOUT is returned.
static int wait_for(pid_t process, int *exit_status)
{
    const double until = moray_clock() + PATIENCE;
    struct timespec pause = {.tv_nsec = 2000000};
    for (;;) {
        const pid_t ended = waitpid(process, exit_status, WNOHANG);
        if (ended == process)
            return 0;
        if (ended < 0 && errno != EINTR)
            return errno;
        if (moray_clock() > until) {
            kill(-process, SIGKILL);
            while (waitpid(process, exit_status, 0) < 0 && errno == EINTR)
                continue;
            return ETIMEDOUT;
        }
        nanosleep(&pause, NULL);
    }
}

// The first line that is not blank.
static void first_line(FILE *file, char *line, int size)
{
    rewind(file);
    while (fgets(line, size, file)) {
        line[strcspn(line, "\r\n")] = 0;
        if (line[strspn(line, " \t^")])
            return;
    }
    snprintf(line, (size_t)size, "no message");
}

static moray_status draw(const char *name, FILE *script, FILE *picture, FILE *complaints, bool *hangs)
{
    char line[120];
    int exit_status = 0;
    pid_t process;
    rewind(script);
    int failed = start(script, picture, complaints, &process);
    if (!failed)
        failed = wait_for(process, &exit_status);
    *hangs = failed == ETIMEDOUT;
    if (*hangs)
        return moray_error(MORAY_IO, "figure %s not drawn: gnuplot did not end in %d s and was stopped", name,
                           (int)PATIENCE);
    if (failed)
        return moray_error(MORAY_IO, "figure %s not drawn: gnuplot: %s", name, strerror(failed));
    if (exit_status != 0 || fseek(picture, 0, SEEK_END) || ftell(picture) == 0) {
        first_line(complaints, line, sizeof line);
        return moray_error(MORAY_IO, "figure %s not drawn: gnuplot: %s", name, line);
    }
    return moray_ok();
}

moray_status moray_gnuplot(const char *name, FILE *script, FILE *picture, bool *hangs)
{
    if (*hangs)
        return moray_error(MORAY_IO, "figure %s not drawn: gnuplot hung before", name);
    FILE *complaints = tmpfile();
    if (!complaints)
        return moray_error(MORAY_IO, "figure %s not drawn: no temporary file", name);
    const moray_status status = draw(name, script, picture, complaints, hangs);
    fclose(complaints);
    return status;
}
