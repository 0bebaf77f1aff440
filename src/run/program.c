// SPDX-License-Identifier: MIT
#include "moray/app/program.h"

#include <ctype.h>
#include <fcntl.h>
#include <signal.h>
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
    if (printf("%s (moray) %s\n", program->name, moray_version()) < 0 || fflush(stdout))
        return moray_error(MORAY_IO, "the version cannot be written");
    return moray_ok();
}

// Makes what the parent left behind harmless: a file opened later must not become a standard stream that is closed
// (what is then printed there fails instead), and children, which draw the figures, are to be waited for.
static void settle(void)
{
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", stream == STDOUT_FILENO ? O_RDONLY : O_RDWR) != stream)
            break;
    signal(SIGCHLD, SIG_DFL);
}

bool moray_app_start(const moray_program *program, int argc, char **argv, void *settings, int *exit_code)
{
    moray_common *common = settings;
    moray_request request;
    settle();
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
    if ((fflush(stdout) || ferror(stdout)) && !moray_failed(status))
        status = moray_error(MORAY_IO, "standard output cannot be written");
    if (moray_failed(status)) {
        for (char *c = status.text; *c; c++)
            if (iscntrl((unsigned char)*c))
                *c = '?';
        fprintf(stderr, "%s: %s\n", program->name, status.text);
    }
    return moray_exit_of(status.code);
}
