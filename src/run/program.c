// SPDX-License-Identifier: MIT
#include "moray/app/program.h"
#include "options/options.h"
#include "results/results.h"
#include "run/versions.h"

#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <signal.h>
#include <stdlib.h>
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
    signal(SIGXFSZ, SIG_IGN); // a file that grows beyond a limit is told, as a disk that is full is
    before_start = uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0)); // numbers have points, read and written
    moray_status status = moray_options_parse(program, argc, argv, settings, &request, &common->ini);
    if (!moray_failed(status) && request != MORAY_REQUEST_RUN)
        status = answer(program, settings, request);
    else if (!moray_failed(status) && common->out[0])
        status = moray_output_open(&common->output, common->out);
    if (!moray_failed(status) && request == MORAY_REQUEST_RUN)
        return true;
    *exit_code = moray_app_end(program, settings, status);
    return false;
}

// A run that has nothing to show leaves why. Bad usage and an interruption are known to who caused them; what is shown
// says it already.
static moray_status leave_reason(const moray_program *program, const moray_common *common, moray_status status)
{
    const moray_exit exit_code = moray_exit_of(status.code);
    FILE *file;
    if (!common->output || exit_code == MORAY_EXIT_USAGE || exit_code == MORAY_EXIT_INTERRUPTED ||
        moray_output_summarised(common->output))
        return moray_ok();
    moray_output_discard(common->output);
    MORAY_TRY(moray_write_ini(common));
    MORAY_TRY(moray_output_file(common->output, "summary.json", &file));
    moray_json *json = moray_json_new();
    moray_json_text(json, "problem", program->name);
    moray_json_text(json, "version", moray_version());
    moray_json_text(json, "status", "not solved");
    moray_json_text(json, "reason", status.text);
    moray_status written = moray_json_write(json, file);
    moray_json_free(json);
    return moray_failed(written) ? written : moray_output_commit(common->output);
}

int moray_app_certified(const moray_program *program, moray_status certified)
{
    if (!moray_failed(certified))
        return MORAY_EXIT_SOLVED;
    fprintf(stderr, "%s: %s\n", program->name, certified.text);
    return MORAY_EXIT_CERTIFICATE;
}

int moray_app_end(const moray_program *program, void *settings, moray_status status)
{
    moray_common *common = settings;
    const moray_status left = moray_failed(status) ? leave_reason(program, common, status) : moray_ok();
    if (moray_failed(left))
        fprintf(stderr, "%s: %s\n", program->name, left.text);
    moray_output_free(common->output);
    common->output = NULL;
    free(common->ini);
    common->ini = NULL;
    const moray_status printed = finish_standard_output();
    if (moray_failed(printed))
        status = printed;
    uselocale(before_start);
    before_start = (locale_t)0;
    if (moray_failed(status))
        fprintf(stderr, "%s: %s\n", program->name, status.text);
    return moray_exit_of(status.code);
}
