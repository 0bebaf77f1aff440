// SPDX-License-Identifier: MIT
//
// Every allocation of command lines, INI files and help fails once, each by itself.
#define _GNU_SOURCE // mkdtemp
#include "allocations.h"
#include "arguments.h"

#include <string.h>
#include <unistd.h>

#include "options/options.h"

typedef struct settings {
    moray_common common;
    double depth;
    int mode;
    bool said[2];
} settings;

static const moray_option rows[] = {MORAY_ROW(REAL, settings, depth, "body", "depth_m", .help = "h"),
                                    MORAY_ROW(INT, settings, mode, "body", "mode", .max = 9, .help = "h")};
static const moray_word word[] = {{"eel", "one"}, {"cod", "two"}};
static const moray_words words = {
    .noun = "fish", .word = word, .n = 2, .all = "all", .offset = offsetof(settings, said)};
static const moray_program program = {.name = "prog", .summary = "s", .options = rows, .n_options = 2, .words = &words};

static moray_status parse(settings *s, char **ini, const char *const *arguments, int n)
{
    command_line line;
    moray_request request;
    command_set(&line, "prog", arguments, n);
    *s = (settings){.common = moray_common_default()};
    return moray_options_parse(&program, line.argc, line.argv, s, &request, ini);
}

static moray_status read_line(void)
{
    settings s;
    MORAY_TRY(parse(&s, NULL, (const char *const[]){"eel", "--set", "depth_m=4", "--config", "in.ini"}, 5));
    return s.depth == 4 && s.mode == 7 && s.said[0] ? moray_ok()
                                                    : moray_error(MORAY_NUMERIC, "%g, %d", s.depth, s.mode);
}

static moray_status help(void)
{
    const settings s = {.common = moray_common_default()};
    FILE *file = fopen("/dev/null", "w");
    moray_status status = moray_app_help(&program, &s, file);
    if (!moray_failed(status))
        status = moray_app_help_list(&program, &s, file);
    fclose(file);
    return status;
}

// What the library of C allocates by itself is freed here, so that blocks are not counted any more.

static moray_status set_ini(void)
{
    static const moray_ini_entry entries[] = {{"mode", "7"}, {"depth_m", "3"}};
    return moray_ini_set("in.ini", "body", entries, 2);
}

// A key of which it cannot be found out whether its text gives it back is left out.
static moray_status tell(void)
{
    settings s;
    char *ini = NULL;
    const moray_status status = parse(&s, &ini, (const char *const[]){"eel", "--out", "x", "--set", "depth_m=4"}, 5);
    if (!moray_failed(status))
        CHECK(ini && strstr(ini, "depth_m"), "told");
    free(ini);
    return status;
}

int main(void)
{
    char folder[] = "/tmp/moray-memory-XXXXXX";
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    FILE *file = fopen("in.ini", "w");
    fputs("; it\n[body]\nmode = 7\n", file);
    fclose(file);
    fail_each("a command line", false, read_line);
    fail_each("help", false, help);
    CHECK(uneven == 0, "what a run takes it frees, but for %ld", uneven);
    fail_each("an INI file set", false, set_ini);
    fail_each("settings told", true, tell);
    unlink("in.ini");
    CHECK(chdir("/") == 0 && rmdir(folder) == 0, "nothing is left behind");
    return tap_done();
}
