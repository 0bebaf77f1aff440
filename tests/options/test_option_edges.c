// SPDX-License-Identifier: MIT
//
// Options at their edges: rows of flags alone between others, groups of several places, ends of what is allowed, lines
// as long as there is room for, and numbers of degrees that rounding leaves.
#define _GNU_SOURCE // mkdtemp
#include "arguments.h"
#include "tap.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "moray/angle.h"
#include "options/options.h"

typedef struct part {
    double mass, length;
    int finished;
} part;

typedef struct settings {
    moray_common common;
    part head, tail;
    int jobs, other, count;
    bool asleep;
    double turn[2], rate, list[300];
} settings;

static moray_status finish(void *place)
{
    part *p = place;
    p->finished += 1 + (int)p->mass;
    return p->mass < 100 ? moray_ok() : moray_error(MORAY_INPUT, "a mass of %g kg", p->mass);
}

static moray_status finish_tail(void *place)
{
    ((part *)place)->finished += 100;
    return finish(place);
}

static const moray_option head_rows[] = {MORAY_ROW(REAL, part, mass, "head", "head_kg", .help = "h")},
                          tail_rows[] = {MORAY_ROW(REAL, part, mass, "tail", "tail_kg", .help = "h"),
                                         MORAY_ROW(REAL, part, length, "tail", "tail_m", .help = "h")};
static const moray_option_table head_table = {head_rows, 1, finish}, tail_table = {tail_rows, 2, finish_tail};
static const moray_option_group groups[] = {{&head_table, offsetof(settings, head)},
                                            {&tail_table, offsetof(settings, tail)}};

static const moray_option rows[] = {
    MORAY_ROW(INT, settings, other, "one", "other", .flag = "other", .help = "h"),
    {.flag = "jobs", .type = MORAY_OPTION_INT, MORAY_AT(settings, jobs), .max = 9, .help = "h"},
    MORAY_ROW(INT, settings, count, "one", "count", .min = -5, .max = 5, .help = "h"),
    MORAY_ROW(BOOL, settings, asleep, "two", "asleep", .help = "h"),
    MORAY_ROW(RANGE, settings, turn, "one", "turn", .min = -20, .max = 90, .unit = "deg", .help = "h"),
    MORAY_ROW(LIMIT, settings, rate, "two", "rate", .max = 180, .unit = "deg/s", .help = "h"),
    MORAY_ROW(LIST, settings, list, "two", "list", .min = 0, .max = 9, .help = "h")};

static bool sleeps(const void *self)
{
    return ((const settings *)self)->asleep;
}

static const moray_idle idle[] = {
    {"scheme", sleeps, "asleep"}, {"jobs", sleeps, "asleep"}, {"tail_m", sleeps, "asleep"}, {NULL, NULL, NULL}};
static const char *const without[] = {"scheme", "ipopt.KEY", NULL};
static const moray_program program = {.name = "edge",
                                      .summary = "s",
                                      .options = rows,
                                      .n_options = sizeof rows / sizeof *rows,
                                      .groups = groups,
                                      .n_groups = 2,
                                      .idle = idle,
                                      .without = without};

static moray_status parse(settings *s, const char *const arguments[6])
{
    command_line line;
    moray_request request;
    command_set(&line, "edge", arguments, 6);
    *s = (settings){.common = moray_common_default(), .jobs = 2, .head = {.mass = 1}, .tail = {.mass = 2, .length = 3}};
    return moray_app_parse(&program, line.argc, line.argv, s, &request);
}
#define PARSE(s, ...) parse((s), (const char *const[6]){__VA_ARGS__})

static void refused(moray_status status, const char *says)
{
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "%s, not %s", status.text, says);
}

// ---- Tables --------------------------------------------------------------------------------------------------------

static void test_defaults(void)
{
    const moray_common common = moray_common_default();
    CHECK(strcmp(common.scheme, "hermite-simpson") == 0 && common.intervals == 40 && common.tol == 1e-8 &&
              common.linear_solver == 0 && !common.json && !common.quiet && !*common.out,
          "%s, %d, %g", common.scheme, common.intervals, common.tol);
}

// Each group is finished at its own place.
static void test_groups(void)
{
    settings s;
    CHECK_OK(PARSE(&s, "--set", "tail_kg=7", "--set", "head_kg=4"), "two groups");
    CHECK(s.head.mass == 4 && s.tail.mass == 7 && s.head.finished == 5 && s.tail.finished == 108, "finished %d and %d",
          s.head.finished, s.tail.finished);
    refused(PARSE(&s, "--set", "tail_kg=700"), "a mass of 700 kg");
    refused(PARSE(&s, "--set", "head_kg=400"), "a mass of 400 kg");
}

static moray_status derive(void *place)
{
    part *p = place;
    p->length = 2 * p->mass;
    return moray_ok();
}

// With --out the settings are told as they were asked for, and behind them what has followed from these.
static void test_told(void)
{
    static const moray_option_table table = {tail_rows, 2, derive};
    static const moray_option_group one = {&table, offsetof(settings, tail)};
    static const moray_program deriving = {
        .name = "d", .summary = "s", .groups = &one, .n_groups = 1, .without = without};
    settings s = {.common = moray_common_default(), .tail = {.mass = NAN, .length = NAN}};
    char *argv[] = {"d", "--out", "x", "--set", "tail_kg=4"}, *ini = NULL;
    moray_request request;
    const locale_t before = uselocale((locale_t)0);
    CHECK_OK(moray_options_parse(&deriving, 5, argv, &s, &request, &ini), "read");
    CHECK(uselocale((locale_t)0) == before, "the locale is what it was");
    CHECK(s.common.argc == 5 && s.common.argv == argv && s.tail.length == 8, "with the command line");
    CHECK(ini && strstr(ini, "\n[tail]\ntail_kg = 4\n; tail_m: not given\n") &&
              strstr(ini, "\n; What follows from these:\n;   tail_m = 8\n"),
          "%s", ini);
    free(ini);
}

// Of a flag alone, which has no key, and of a key.
static void test_idle(void)
{
    settings s;
    CHECK_OK(PARSE(&s, "--set", "asleep=yes", "--other", "5"), "what is used");
    CHECK_OK(PARSE(&s, "--jobs", "5"), "a flag where it is used");
    CHECK_OK(PARSE(&s, "--set", "asleep=yes", "--jobs", "2"), "as it is anyway");
    refused(PARSE(&s, "--set", "asleep=yes", "--jobs", "5"), "jobs: edge has no use for it asleep");
    refused(PARSE(&s, "--set", "asleep=yes", "--set", "tail_m=5"), "tail_m: edge has no use for it asleep");
}

static void test_unused(void)
{
    const moray_options options = {.row = rows, .n = 7, .program = "edge", .without = without};
    refused(moray_option_unused(&options, "--scheme"), "--scheme: edge has no use for it; --help lists the options");
    refused(moray_option_unused(&options, "ipopt.tol"), "ipopt.tol: edge has no use for it; --help lists the options");
    static const char *const others[] = {"schemes", "scheme2", "--schem", "ipopt", "--ipopt", "count", "ipopr.KEY"};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        CHECK_OK(moray_option_unused(&options, others[k]), others[k]);
}

// Of names that are as near as each other the first one is suggested; of words that for all goes before.
static void test_nearest(void)
{
    static const moray_option taps[] = {MORAY_ROW(INT, settings, count, "one", "tap_a", .flag = "tap-a", .help = "h"),
                                        MORAY_ROW(INT, settings, other, "one", "tap_b", .flag = "tap-b", .help = "h")};
    static const moray_word word[] = {{"cod", "h"}, {"cob", "h"}, {"alp", "h"}};
    static const moray_words words = {
        .noun = "fish", .word = word, .n = 3, .all = "all", .offset = offsetof(settings, asleep)};
    static const moray_program nearest = {
        .name = "n", .summary = "s", .options = taps, .n_options = 2, .words = &words};
    static const struct {
        const char *argument[2], *told;
    } cases[] = {{{"--set", "tap_c=1"}, "unknown key tap_c; did you mean tap_a?"},
                 {{"--tap-c", NULL}, "unknown option --tap-c; did you mean --tap-a?"},
                 {{"cot", NULL}, "unknown fish cot; did you mean cod?"},
                 {{"alq", NULL}, "unknown fish alq; did you mean all?"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        command_line line;
        moray_request request;
        settings s = {.common = moray_common_default()};
        command_set(&line, "n", cases[k].argument, 2);
        refused(moray_app_parse(&nearest, line.argc, line.argv, &s, &request), cases[k].told);
    }
}

// A row without a section between two of one.
static void test_sections(void)
{
    const moray_options options = {.row = rows, .n = 4, .program = "edge"};
    const settings s = {.other = 3, .count = -2, .asleep = true};
    char *text = NULL;
    size_t size = 0;
    bool given[4] = {false};
    FILE *file = open_memstream(&text, &size);
    moray_options_write(&options, &s, file, given);
    fclose(file);
    CHECK(strcmp(text, "; The settings of a run; --config with this file repeats it.\n[run]\nprogram = edge\n"
                       "\n[one]\nother = 3\ncount = -2\n\n[two]\nasleep = yes\n") == 0,
          "%s", text);
    CHECK(given[0] && !given[1] && given[2] && given[3], "those that have a key");
    free(text);
}

// ---- Help ----------------------------------------------------------------------------------------------------------

// A name stands beside its text while there are two blanks between them.
static void test_columns(void)
{
    static const char *const names[] = {"abcdefghijklmnopqrst", "abcdefghijklmnopqrstu", "abcdefghijklmnopqrstuv"};
    static const char *const want[] = {
        "  abcdefghijklmnopqrst=N   h; an integer; default 0\n",
        "  abcdefghijklmnopqrstu=N  h; an integer; default 0\n",
        "  abcdefghijklmnopqrstuv=N\n                           h; an integer; default 0\n"};
    for (int k = 0; k < 3; k++) {
        const moray_option row = MORAY_ROW(INT, settings, count, "one", names[k], .help = "h");
        const moray_program one = {.name = "p", .summary = "s", .options = &row, .n_options = 1};
        const settings s = {.count = 0};
        char *text = NULL;
        size_t size = 0;
        FILE *file = open_memstream(&text, &size);
        CHECK_OK(moray_app_help(&one, &s, file), "help");
        fclose(file);
        CHECK(strstr(text, want[k]), "%s", want[k]);
        free(text);
    }
}

static void test_no_choices(void)
{
    static const char *const none[] = {NULL};
    char text[MORAY_SHOWN_SIZE] = "xx";
    moray_option_allowed(&(moray_option){.type = MORAY_OPTION_CHOICE, .choices = none}, text);
    CHECK(!*text, "nothing is allowed: %s", text);
}

// As much as there is room for, and nothing behind it.
static void test_many_choices(void)
{
    static const char *const many[] = {"a_choice_whose_name_is_long_enough_for_three_of_them_to_fill_the_room_there_is",
                                       "b_choice_whose_name_is_long_enough_for_three_of_them_to_fill_the_room_there_is",
                                       "c_choice_whose_name_is_long_enough_for_three_of_them_to_fill_the_room_there_is",
                                       "d", NULL};
    char text[2 * MORAY_SHOWN_SIZE];
    memset(text, '#', sizeof text);
    moray_option_allowed(&(moray_option){.type = MORAY_OPTION_CHOICE, .choices = many}, text);
    CHECK(memchr(text, 0, sizeof text) == text + MORAY_SHOWN_SIZE - 1 && text[MORAY_SHOWN_SIZE] == '#' &&
              memcmp(text + MORAY_SHOWN_SIZE, text + MORAY_SHOWN_SIZE + 1, MORAY_SHOWN_SIZE - 1) == 0,
          "cut where the room ends: %.*s", (int)MORAY_SHOWN_SIZE, text);
}

// ---- Numbers -------------------------------------------------------------------------------------------------------

// "none" is the end of what is allowed, in the unit that is stored.
static void test_ends(void)
{
    settings s;
    CHECK_OK(PARSE(&s, "--set", "turn=none", "--set", "rate=none"), "both ends");
    CHECK_NEAR(s.turn[0], -20 * MORAY_DEGREE, 1e-15, "the lower");
    CHECK_NEAR(s.turn[1], 90 * MORAY_DEGREE, 1e-15, "the upper");
    CHECK_NEAR(s.rate, M_PI, 1e-15, "of a limit");
    CHECK_OK(PARSE(&s, "--set", "turn=10:none"), "one end");
    CHECK_NEAR(s.turn[0], 10 * MORAY_DEGREE, 1e-15, "as it is given");
    CHECK_NEAR(s.turn[1], 90 * MORAY_DEGREE, 1e-15, "the other");
    refused(PARSE(&s, "--set", "count=6"), "count = 6: must be an integer from -5 to 5");
    refused(PARSE(&s, "--set", "count=-6"), "count = -6: must be an integer from -5 to 5");
}

// Whether some double near the quotient is that number of degrees.
static bool is_degrees(double value, double scale)
{
    double above = value / scale, below = above;
    for (int k = 0; k < 5; k++) {
        if (above * scale == value || below * scale == value)
            return true;
        above = nextafter(above, INFINITY);
        below = nextafter(below, -INFINITY);
    }
    return false;
}

// With as few digits as tell it; where a double is degrees at all those are shown.
static void test_degrees(void)
{
    const moray_option *row = &rows[4];
    const double scale = moray_option_scale(row);
    unsigned long long seed = 41;
    char text[32];
    int wrong = 0, longer = 0, none = 0;
    for (int k = 0; k < 3000; k++) {
        const double value = tap_random(&seed, -4, 4), tenths = floor(tap_random(&seed, -1800, 1800)) / 10;
        moray_option_show_exactly(row, value, text);
        wrong += strtod(text, NULL) * scale != value && is_degrees(value, scale);
        none += !is_degrees(value, scale);
        moray_option_show_exactly(row, tenths * scale, text);
        longer += strlen(text) > 6 || strtod(text, NULL) != tenths;
    }
    CHECK(wrong == 0 && none > 20, "%d are others, and %d none", wrong, none);
    CHECK(longer == 0, "%d tenths of degrees with more digits than they have", longer);
    moray_option_show_exactly(row, INFINITY, text);
    CHECK(strcmp(text, "none") == 0, "%s", text);
}

// ---- Files ---------------------------------------------------------------------------------------------------------

// A line that goes on with a list is as long as one that begins one may be: 199 bytes, with its key.
static void test_lines(void)
{
    for (int longer = 0; longer < 2; longer++) {
        settings s;
        char line[400] = "";
        FILE *file = fopen("edge.ini", "w");
        for (int k = 0; k < 97; k++)
            strcat(line, "1,");
        line[193] = 0; // 97 numbers
        strcat(line, longer ? ".0" : ".");
        fprintf(file, "[two]\nlist = 2,\n%s\n", line);
        fclose(file);
        const moray_status status = PARSE(&s, "--config", "edge.ini");
        if (longer)
            CHECK(status.code == MORAY_INPUT && strcmp(status.text, "edge.ini:3: longer than 199 characters") == 0,
                  "%zu bytes: %s", strlen(line), status.text);
        else
            CHECK(!moray_failed(status) && s.list[0] == 2 && s.list[96] == 1 && s.list[97] == 1 && isnan(s.list[98]),
                  "%zu bytes: %s", strlen(line), status.text);
    }
    unlink("edge.ini");
}

int main(void)
{
    char folder[] = "/tmp/moray-edges-XXXXXX";
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    test_defaults();
    test_groups();
    test_told();
    test_idle();
    test_unused();
    test_nearest();
    test_sections();
    test_columns();
    test_no_choices();
    test_many_choices();
    test_ends();
    test_degrees();
    test_lines();
    CHECK(chdir("/") == 0 && rmdir(folder) == 0, "nothing is left behind");
    return tap_done();
}
