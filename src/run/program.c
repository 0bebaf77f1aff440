// SPDX-License-Identifier: MIT
#include "moray/app/program.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

moray_exit moray_exit_of(moray_code code)
{
    switch (code) {
    case MORAY_OK:
        return MORAY_EXIT_SOLVED;
    case MORAY_INPUT:
    case MORAY_IO:
        return MORAY_EXIT_USAGE;
    case MORAY_INTERRUPTED:
        return MORAY_EXIT_INTERRUPTED;
    case MORAY_MEMORY:
    case MORAY_NUMERIC:
    case MORAY_NOT_SOLVED:
        break;
    }
    return MORAY_EXIT_NOT_SOLVED;
}

static moray_status answer(const moray_program *program, const void *settings, moray_request request)
{
    if (request == MORAY_REQUEST_HELP)
        return moray_app_help(program, settings, stdout);
    if (request == MORAY_REQUEST_LIST)
        return moray_app_help_list(program, settings, stdout);
    printf("%s (moray) %s\n", program->name, moray_version());
    return moray_ok();
}

static _Thread_local locale_t before_start; // of the host; 0: not started

// In the place of a standard stream that is closed, a file would be opened and take what is meant for the stream.
static void hold_standard_streams(void)
{
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY) < 0)
            return;
}

static moray_status finish_standard_output(void)
{
    errno = 0;
    bool failed = fflush(stdout) != 0 || ferror(stdout);
    const int copy = failed ? -1 : dup(STDOUT_FILENO); // closing tells what a file system found late
    if (copy >= 0)
        failed = close(copy) != 0;
    if (!failed)
        return moray_ok();
    return moray_error(MORAY_IO, "standard output cannot be written%s%s", errno ? ": " : "",
                       errno ? strerror(errno) : "");
}

bool moray_app_start(const moray_program *program, int argc, char **argv, void *settings, int *exit_code)
{
    moray_common *common = settings;
    moray_request request;
    hold_standard_streams();
    signal(SIGCHLD, SIG_DFL); // a parent that ignores it hands that on, and no child could be waited for
    before_start = uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0)); // numbers have points, read and written
    moray_status status = moray_app_parse(program, argc, argv, settings, &request);
    if (!moray_failed(status) && request != MORAY_REQUEST_RUN)
        status = answer(program, settings, request);
    else if (!moray_failed(status) && common->out[0])
        status = moray_output_open(&common->output, common->out);
    if (!moray_failed(status) && request == MORAY_REQUEST_RUN)
        return true;
    *exit_code = moray_app_end(program, settings, status);
    return false;
}

int moray_app_end(const moray_program *program, void *settings, moray_status status)
{
    moray_common *common = settings;
    moray_output_free(common->output);
    common->output = NULL;
    const moray_status printed = finish_standard_output();
    if (moray_failed(printed))
        status = printed;
    uselocale(before_start);
    before_start = (locale_t)0;
    if (moray_failed(status)) {
        for (char *c = status.text; *c; c++)
            if (iscntrl((unsigned char)*c))
                *c = '?';
        fprintf(stderr, "%s: %s\n", program->name, status.text);
    }
    return moray_exit_of(status.code);
}
