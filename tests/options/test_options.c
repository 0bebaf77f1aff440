// SPDX-License-Identifier: MIT
#include "arguments.h"
#include "degree.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "options/options.h"
#include "sound_table.h"

// A group of another place's.
typedef struct body {
    int links, model;
    double m_kg, c_n, lambda_2, current[2], course;
} body;

typedef struct settings {
    moray_common common;
    body body;
    int count, mode;
    double real, angle, limit, range[2], turn[2], pair[2];
    bool yes;
    char word[8];
} settings;

static const char *const models[] = {"control", "fp|complex|other", NULL};
static const moray_option body_rows[] = {
    {.flag = "robot", .argument = "FILE", .type = MORAY_OPTION_INI, .help = "h"},
    {.section = "robot",
     .key = "links",
     .flag = "links",
     .type = MORAY_OPTION_INT,
     MORAY_AT(body, links),
     .min = 2,
     .max = 1000,
     .help = "h"},
    {.section = "problem",
     .key = "model",
     .flag = "model",
     .type = MORAY_OPTION_CHOICE,
     MORAY_AT(body, model),
     .choices = models,
     .help = "h"},
    {.section = "problem",
     .key = "current",
     .flag = "current",
     .type = MORAY_OPTION_PAIR,
     MORAY_AT(body, current),
     .help = "h"},
    {.section = "problem",
     .key = "course",
     .flag = "course",
     .type = MORAY_OPTION_REAL,
     MORAY_AT(body, course),
     .unit = "deg",
     .help = "h"},
    {.section = "robot",
     .key = "m_kg",
     .type = MORAY_OPTION_REAL,
     MORAY_AT(body, m_kg),
     .max = INFINITY,
     .open = true,
     .unit = "kg",
     .help = "h"},
    {.section = "robot",
     .key = "c_n",
     .type = MORAY_OPTION_REAL,
     MORAY_AT(body, c_n),
     .max = INFINITY,
     .unit = "kg/s",
     .help = "h"},
    {.section = "robot",
     .key = "lambda_2",
     .type = MORAY_OPTION_REAL,
     MORAY_AT(body, lambda_2),
     .max = INFINITY,
     .help = "h"},
};

static moray_status finish_body(void *place)
{
    const body *b = place;
    return b->m_kg * b->links < 1e300 ? moray_ok() : moray_error(MORAY_INPUT, "m = inf: must be finite");
}

static const moray_option_table body_table = {
    .rows = body_rows, .n = sizeof body_rows / sizeof *body_rows, .finish = finish_body};
static const moray_option_group groups[] = {{&body_table, offsetof(settings, body)}};

static const char *const modes[] = {"slow", "fast", NULL};
#define AT(type_of, field) .section = "test", .key = #field, .type = MORAY_OPTION_##type_of, MORAY_AT(settings, field)
static const moray_option rows[] = {
    {AT(INT, count), .min = -3, .max = INFINITY, .help = "h"},
    {AT(CHOICE, mode), .choices = modes, .help = "h"},
    {AT(REAL, real), .min = -INFINITY, .max = 5, .open = true, .unit = "m", .help = "h"},
    {AT(REAL, angle), .min = -180, .max = 180, .unit = "deg", .help = "h"},
    {AT(LIMIT, limit), .min = 0, .max = INFINITY, .open = true, .unit = "deg/s", .help = "h"},
    {AT(RANGE, range), .help = "h"},
    {AT(RANGE, turn), .min = 0, .max = 90, .unit = "deg/s", .help = "h"},
    {AT(PAIR, pair), .help = "h"},
    {AT(BOOL, yes), .flag = "yes", .help = "h"},
    {AT(TEXT, word), .help = "h"},
};
static const moray_program program = {.name = "test",
                                      .summary = "s",
                                      .options = rows,
                                      .n_options = sizeof rows / sizeof *rows,
                                      .groups = groups,
                                      .n_groups = 1};

static char directory[] = "/tmp/moray-options-XXXXXX";

// Parses up to eight arguments into *s, which starts at the defaults.
static moray_status parse(settings *s, const char *const arguments[8])
{
    command_line line;
    command_set(&line, "test", arguments, 8);
    moray_request request;
    *s = (settings){.common = moray_common_default(),
                    .body = {.links = 10, .m_kg = 1},
                    .limit = INFINITY,
                    .range = {0, INFINITY},
                    .word = "word"};
    return moray_app_parse(&program, line.argc, line.argv, s, &request);
}
#define PARSE(s, ...) parse((s), (const char *const[8]){__VA_ARGS__})

// A file of this text; the path lives until the next call.
static const char *ini(const char *text)
{
    static char path[64];
    snprintf(path, sizeof path, "%s/robot.ini", directory);
    FILE *file = fopen(path, "w");
    fputs(text, file);
    fclose(file);
    return path;
}

static void test_values(void)
{
    settings s;
    CHECK_OK(PARSE(&s, "--set", "count=-3", "--set", "mode=fast", "--set", "real=4.5e0", "--set=angle=-90"), "values");
    CHECK(s.count == -3 && s.mode == 1 && s.real == 4.5, "int, choice, real: %d %d %g", s.count, s.mode, s.real);
    CHECK_NEAR(s.angle, -M_PI / 2, 1e-15, "degrees are stored in rad");
    CHECK_OK(PARSE(&s, "--set", "range=-1:2", "--set", "turn=none:45", "--set", "pair= -1 , 2e3 ", "--yes"), "values");
    CHECK(s.range[0] == -1 && s.range[1] == 2, "range %g:%g", s.range[0], s.range[1]);
    CHECK(s.turn[0] == 0, "none is the end of what is allowed: %g", s.turn[0]);
    CHECK_NEAR(s.turn[1], M_PI / 4, 1e-15, "ranges of angles are stored in rad");
    CHECK(s.pair[0] == -1 && s.pair[1] == 2000, "pair %g,%g", s.pair[0], s.pair[1]);
    CHECK(s.yes, "a flag means yes");
    CHECK_OK(PARSE(&s, "--set", "range=none:3", "--set", "turn=30", "--set", "word=1234567", "--set", "yes=on"),
             "more");
    CHECK(isinf(s.range[0]) && s.range[0] < 0 && s.range[1] == 3, "an unlimited end: %g:%g", s.range[0], s.range[1]);
    CHECK(s.turn[0] == s.turn[1] && fabs(s.turn[0] - M_PI / 6) < 1e-15, "one value is both ends: %g", s.turn[0]);
    CHECK(strcmp(s.word, "1234567") == 0 && s.yes, "text to its last byte, bool by word");
    CHECK_OK(PARSE(&s, "--set", "range=none", "--set", "count=2147483647"), "none alone");
    CHECK(isinf(s.range[0]) && isinf(s.range[1]) && s.count == 2147483647, "both ends unlimited");
    CHECK_OK(PARSE(&s, "--set", "limit=90"), "a limit");
    CHECK_NEAR(s.limit, M_PI / 2, 1e-15, "in rad/s");
    CHECK_OK(PARSE(&s, "--set", "limit=90", "--set", "limit=none"), "no limit");
    CHECK(isinf(s.limit) && s.limit > 0, "is infinite: %g", s.limit);
    CHECK_OK(PARSE(&s, "--current", "-0.1,0.2", "--course=45", "--links", "5", "--links=6"), "shared options");
    CHECK(s.body.links == 6, "the last of several wins: %d", s.body.links);
    CHECK(s.body.current[0] == -0.1 && s.body.current[1] == 0.2, "a value may begin with a dash");
    CHECK_NEAR(s.body.course, M_PI / 4, 1e-15, "--course is in degrees");
    for (int i = 0; i < 3; i++) {
        const char *const names[] = {"fp", "complex", "other"};
        CHECK_OK(PARSE(&s, "--model", names[i]), "a choice by its name or by another");
        CHECK(s.body.model == 1, "%s is the second: %d", names[i], s.body.model);
    }
}

static void test_bad_values(void)
{
    static const char *const bad[] = {
        "count=-4",
        "count=1.5",
        "count=2147483648",
        "count=99999999999999999999",
        "count=7x",
        "count=",
        "count= ",
        "mode=fas",
        "mode=",
        "real=5",
        "real=nan",
        "real=inf",
        "real=1e999",
        "real=1,5",
        "real=12abc",
        "angle=181",
        "range=2:1",
        "range=:1",
        "range=1:",
        "range=1:2:3",
        "range=none:nan",
        "range=nonesuch",
        "range=inf:inf",
        "turn=-1:5",
        "turn=5:91",
        "pair=1",
        "pair=1,2,3",
        "pair=,",
        "pair=none,1",
        "yes=2",
        "yes=YES",
        "word=12345678",
        "word=",
        "real=--",
        "real",
        "=1",
        "limit=0",
        "limit=-1",
        "limit=None",
        "limit=1:2",
        "limit=inf",
    };
    for (unsigned i = 0; i < sizeof bad / sizeof *bad; i++) {
        settings s;
        char key[16];
        snprintf(key, sizeof key, "%.*s", (int)strcspn(bad[i], "="), bad[i]);
        const moray_status status = PARSE(&s, "--set", bad[i]);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, key) && strstr(status.text, "must be"),
              "--set %s is refused: %s", bad[i], status.text);
    }
    settings s;
    char lengthy[400] = "range=";
    memset(lengthy + 6, '1', 390);
    moray_status status = PARSE(&s, "--set", lengthy);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "LOW <= HIGH"),
          "a long value is cut, not what is allowed: %s", status.text);
}

static void test_messages(void)
{
    const struct {
        const char *arguments[3], *text;
    } cases[] = {
        {{"--links", "1"}, "--links = 1: must be an integer from 2 to 1000"},
        {{"--set", "links=1"}, "links = 1: must be an integer from 2 to 1000"},
        {{"--set", "m_kg=-1"}, "m_kg = -1: must be a number above 0 kg"},
        {{"--set", "c_n=nan"}, "c_n = nan: must be a number of at least 0 kg/s"},
        {{"--set", "real=6"}, "real = 6: must be a number below 5 m"},
        {{"--tol", "0"}, "--tol = 0: must be a number above 0 and below 1"},
        {{"--intervals", ""}, "--intervals = (empty): must be an integer from 1 to 100000"},
        {{"--model", "simple"}, "--model = simple: must be control or fp"},
        {{"--model", "fp|complex"}, "--model = fp|complex: must be control or fp"},
        {{"--model", "comp"}, "--model = comp: must be control or fp"},
        {{"--config", ""}, "--config = (empty): must be the path of a file"},
        {{"--config"}, "--config has no value: must be the path of a file"},
        {{"--set", "lamda_2=1"}, "unknown key lamda_2; did you mean lambda_2?"},
        {{"--set", "Links=4"}, "unknown key Links; did you mean links?"},
        {{"--set", "zzzzzzzz=4"}, "unknown key zzzzzzzz; --help lists the keys"},
        {{"--set", "json=yes"}, "unknown key json"},
        {{"--linsk", "4"}, "unknown option --linsk; did you mean --links?"},
        {{"--sat", "c_n=4"}, "unknown option --sat; did you mean --set?"},
        {{"--quite"}, "unknown option --quite; did you mean --quiet?"},
        {{"--xyzxyzxyz=3"}, "unknown option --xyzxyzxyz; --help lists the options"},
        {{"-q"}, "unknown option -q"},
        {{"--json", "-abc"}, "unknown option -abc"},
        {{"--links", "4", "-abc"}, "unknown option -abc"},
        {{"--json=yes"}, "--json takes no value"},
        {{"--links"}, "--links has no value: must be an integer from 2 to 1000"},
        {{"--set"}, "--set has no value: must be KEY=VALUE"},
        {{"--c", "4"}, "option --c is ambiguous"},
        {{"max_speed"}, "unexpected argument max_speed"},
        {{"--", "--links"}, "unexpected argument --links"},
        {{""}, "unexpected argument (empty)"},
        {{"--set", "m_kg=1e308"}, "m = inf: must be finite"},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        settings s;
        const char *const *a = cases[i].arguments;
        const moray_status status = PARSE(&s, a[0], a[1], a[2]);
        CHECK(status.code == MORAY_INPUT && strncmp(status.text, cases[i].text, strlen(cases[i].text)) == 0,
              "\"%s\" says: %s", a[0], status.text);
    }
}

static void test_precedence(void)
{
    settings s;
    moray_status status;
    const char *path =
        ini("[robot]\nlinks = 6\nc_n = 1\n[test]\nreal = 2\nword=ini ; a comment\n[solver]\ntol = 1e-3\n");
    CHECK_OK(PARSE(&s, "--robot", path), "a file alone");
    CHECK(s.body.links == 6 && s.real == 2 && s.common.tol == 1e-3, "the file overrides the defaults");
    CHECK(strcmp(s.word, "ini") == 0 && s.common.intervals == 40, "comments go, what the file leaves out stays");
    CHECK_OK(PARSE(&s, "--links", "7", "--robot", path, "--set", "real=3"), "the command line, before and after");
    CHECK(s.body.links == 7, "an option before --robot overrides the file: %d", s.body.links);
    CHECK(s.real == 3 && s.common.tol == 1e-3, "an option after --robot overrides the file: %g", s.real);
    char first[64];
    snprintf(first, sizeof first, "%s/first.ini", directory);
    rename(path, first);
    path = ini("[robot]\nlinks = 9\n");
    CHECK_OK(PARSE(&s, "--config", first, "--robot", path), "a file of each option");
    CHECK(s.body.links == 9 && s.real == 2, "the later one overrides: %d %g", s.body.links, s.real);
    CHECK_OK(PARSE(&s, "--config", first, "--config", path), "two of one option");
    CHECK(s.body.links == 9 && s.real == 0, "the last stands alone: %d %g", s.body.links, s.real);
    status = PARSE(&s, "--config", "nowhere.ini");
    CHECK(status.code == MORAY_IO && strstr(status.text, "config file nowhere.ini"), "%s", status.text);
    unlink(first);
    moray_request request;
    char *argv[] = {"test", "--links", "1", "--help"};
    s.body.links = 8;
    CHECK_OK(moray_app_parse(&program, 4, argv, &s, &request), "--help beside a bad value");
    CHECK(request == MORAY_REQUEST_HELP && s.body.links == 8, "help is asked for and nothing is set");
}

static void test_bad_files(void)
{
    const struct {
        const char *text, *error;
    } cases[] = {
        {"[robot]\nc_m = 1\n", ":2: unknown key c_m; did you mean"},
        {"[robot]\nlinks = 5\n\n  links = 6\n", ":4: links is given twice, first in line 2"},
        {"[robot]\nlinks = 1\n", ":2: links = 1: must be an integer from 2 to 1000"},
        {"[robot]\nm_kg = -1\n", ":2: m_kg = -1: must be a number above 0 kg"},
        {"[robot]\nm_kg =\n", ":2: m_kg = (empty): must be"},
        {"[solver]\nlinks = 5\n", ":2: links belongs in section [robot], not in [solver]"},
        {"links = 5\n", ":1: links belongs in section [robot], not in []"},
        {"[robot]\nnonsense\n[robot]\nc_n = 1x\n", ":2: neither [section]"},
        {"# well\n[robot]\nnonsense\n", ":3: neither [section] nor KEY = VALUE"},
        {"[robot\nlinks = 5\n", ":1: neither [section]"},
        {"[robot]\nlinks = \"5\"\n", ":2: links = \"5\": must be"},
    };
    settings s;
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        const moray_status status = PARSE(&s, "--robot", ini(cases[i].text));
        CHECK(status.code == MORAY_INPUT && strstr(status.text, "robot.ini") && strstr(status.text, cases[i].error),
              "bad file: %s", status.text);
    }
    char wide[400];
    memset(wide, ';', sizeof wide);
    wide[sizeof wide - 1] = 0;
    moray_status status = PARSE(&s, "--robot", ini(wide));
    CHECK(status.code == MORAY_INPUT && strstr(status.text, ":1: longer than"), "a line too long: %s", status.text);
    status = PARSE(&s, "--robot", directory);
    CHECK(status.code == MORAY_IO && strstr(status.text, "Is a directory"), "a directory: %s", status.text);
    status = PARSE(&s, "--robot", "/tmp/moray-no-such-file");
    CHECK(status.code == MORAY_IO && strstr(status.text, "No such file"), "no file: %s", status.text);
    memset(wide, 'p', sizeof wide - 1);
    status = PARSE(&s, "--robot", wide);
    CHECK(status.code == MORAY_IO && strstr(status.text, "too long"), "a path too long: %s", status.text);
    CHECK_OK(PARSE(&s, "--robot", ini("\xEF\xBB\xBF[robot]\r\n\tlinks = 5\r\n   ; done")),
             "BOM, CR, tab, no last newline");
    CHECK(s.body.links == 5, "they do not disturb: %d", s.body.links);
    CHECK_OK(PARSE(&s, "--robot", "/dev/null"), "an empty file");
    unlink(ini(""));
}

static void test_help(void)
{
    settings s;
    moray_options options;
    char *text = NULL;
    size_t size = 0;
    CHECK_OK(PARSE(&s, "--links", "12", "--set", "c_n=9"), "settings");
    CHECK_OK(moray_options_new(&options, &program), "table");
    FILE *file = open_memstream(&text, &size);
    CHECK_OK(moray_app_help(&program, &s, file), "help");
    fclose(file);
    int missing = 0, widest = 0;
    for (int i = 0; i < options.n; i++) {
        char name[64];
        snprintf(name, sizeof name, options.row[i].flag ? "\n  --%s" : "\n  %s=",
                 options.row[i].flag ? options.row[i].flag : options.row[i].key);
        missing += !strstr(text, name);
    }
    for (const char *line = text; *line; line += strcspn(line, "\n") + 1)
        widest = (int)strcspn(line, "\n") > widest ? (int)strcspn(line, "\n") : widest;
    CHECK(missing == 0, "every flag and every key stands in --help");
    CHECK(widest <= 80, "it fits 80 columns: %d", widest);
    CHECK(strstr(text, "--links N") && strstr(text, "default 12"), "with the present values as defaults");
    CHECK(strstr(text, "range=LOW:HIGH") && strstr(text, "default 0:none"), "and unlimited ends as none");
    free(text);
    free(options.own);
}

static void test_plain(void)
{
    moray_common s = moray_common_default();
    moray_request request;
    const moray_program plain = {.name = "plain", .summary = "s"};
    char *good[] = {"plain", "--scheme", "radau3", "--intervals", "7"}, *bad[] = {"plain", "--links", "5"};
    CHECK_OK(moray_app_parse(&plain, 5, good, &s, &request), "a program without groups has the solver's options");
    CHECK(strcmp(s.scheme, "radau3") == 0 && s.intervals == 7, "they are set: %s %d", s.scheme, s.intervals);
    CHECK(moray_app_parse(&plain, 3, bad, &s, &request).code == MORAY_INPUT, "but not those of a group it has not");
}

// Words without a flag, and shared options left out.
typedef struct wordy {
    moray_common common;
    body body;
    bool said[3];
} wordy;

static moray_status parse_words(wordy *s, const char *const arguments[4])
{
    static const moray_word word[] = {{"eel", "h"}, {"straight", "h"}, {"turning", "what turns"}};
    static const moray_words words = {
        .noun = "study", .word = word, .n = 3, .all = "all", .offset = offsetof(wordy, said)};
    static const char *const without[] = {"scheme", "course", NULL};
    static const moray_option_group bodies[] = {{&body_table, offsetof(wordy, body)}};
    static const moray_program wordy_program = {
        .name = "w", .summary = "s", .groups = bodies, .n_groups = 1, .words = &words, .without = without};
    command_line line;
    command_set(&line, "w", arguments, 4);
    moray_request request;
    *s = (wordy){.common = moray_common_default()};
    const moray_status status = moray_app_parse(&wordy_program, line.argc, line.argv, s, &request);
    if (request == MORAY_REQUEST_HELP) {
        char text[8192] = "";
        FILE *file = fmemopen(text, sizeof text, "w");
        CHECK_OK(moray_app_help(&wordy_program, s, file), "help");
        fclose(file);
        CHECK(strstr(text, "Usage: w [OPTION]... STUDY...\n") && strstr(text, "STUDY is one or more of:"), "usage");
        CHECK(strstr(text, "  turning                  what turns\n") && strstr(text, "  all  "), "the words");
        CHECK(!strstr(text, "--scheme") && !strstr(text, "--course") && strstr(text, "--links"), "what is left out");
    }
    return status;
}
#define PARSE_WORDS(s, ...) parse_words((s), (const char *const[4]){__VA_ARGS__})

static void test_words(void)
{
    wordy s;
    CHECK_OK(PARSE_WORDS(&s, "turning", "--links", "5", "eel"), "words between options");
    CHECK(s.said[0] && !s.said[1] && s.said[2] && s.body.links == 5, "each is marked");
    CHECK_OK(PARSE_WORDS(&s, "eel", "eel"), "the same twice");
    CHECK(s.said[0] && !s.said[1] && !s.said[2], "is marked once");
    CHECK_OK(PARSE_WORDS(&s, "all"), "all");
    CHECK(s.said[0] && s.said[1] && s.said[2], "marks every word");
    CHECK_OK(PARSE_WORDS(&s, "--help"), "help needs no word");
    moray_status status = PARSE_WORDS(&s, "strait");
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, "unknown study strait; did you mean straight?") == 0, "%s",
          status.text);
    status = PARSE_WORDS(&s, "eel", "weather");
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, "unknown study weather; --help lists them") == 0, "%s",
          status.text);
    status = PARSE_WORDS(&s, "--links", "5");
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "no study is named: must be all or some"), "%s",
          status.text);
    status = PARSE_WORDS(&s, "eel", "--scheme", "gauss3");
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "--scheme: w has no use for it"), "%s", status.text);
    status = PARSE_WORDS(&s, "eel", "--set", "course=3");
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "course: w has no use for it"), "%s", status.text);
}

// Keys without a use in a mode.
typedef struct moody {
    moray_common common;
    bool asleep;
    double depth;
    char name[8];
} moody;

static bool sleeps(const void *self)
{
    return ((const moody *)self)->asleep;
}

static moray_status parse_moody(moody *s, const char *const arguments[4])
{
    static const moray_option moods[] = {
        MORAY_ROW(BOOL, moody, asleep, "problem", "asleep", .help = "h"),
        MORAY_ROW(REAL, moody, depth, "problem", "depth_m", .flag = "depth", .argument = "M", .help = "h"),
        MORAY_ROW(TEXT, moody, name, "problem", "name", .help = "h")};
    static const moray_idle idle[] = {{"depth_m", sleeps, "asleep"}, {"name", sleeps, "asleep"}, {NULL, NULL, NULL}};
    static const moray_program moody_program = {
        .name = "m", .summary = "s", .options = moods, .n_options = 3, .idle = idle};
    command_line line;
    command_set(&line, "m", arguments, 4);
    moray_request request;
    *s = (moody){.common = moray_common_default(), .depth = 3, .name = "eel"};
    return moray_app_parse(&moody_program, line.argc, line.argv, s, &request);
}
#define PARSE_MOODY(s, ...) parse_moody((s), (const char *const[4]){__VA_ARGS__})

static void test_idle(void)
{
    moody s;
    CHECK_OK(PARSE_MOODY(&s, "--depth", "5"), "a key where it has a use");
    CHECK_OK(PARSE_MOODY(&s, "--set", "asleep=yes"), "the mode without it");
    CHECK_OK(PARSE_MOODY(&s, "--set", "asleep=yes", "--depth", "3"), "what it is anyway says nothing else");
    CHECK_OK(PARSE_MOODY(&s, "--set", "asleep=yes", "--set", "name=eel"), "nor does a word");
    moray_status status = PARSE_MOODY(&s, "--depth", "5", "--set", "asleep=yes");
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "depth_m: m has no use for it asleep"), "%s", status.text);
    status = PARSE_MOODY(&s, "--set", "name=cod", "--set", "asleep=yes");
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "name: m has no use for it asleep"), "%s", status.text);
    FILE *file = fopen("moody.ini", "w");
    fputs("[problem]\nasleep = yes\ndepth_m = 4\n", file);
    fclose(file);
    status = PARSE_MOODY(&s, "--config", "moody.ini");
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "depth_m: m has no use for it"), "of a file: %s",
          status.text);
    CHECK_OK(PARSE_MOODY(&s, "--config", "moody.ini", "--depth", "3"), "unless the command line has the default");
    unlink("moody.ini");
}

static void test_small_parts(void)
{
    CHECK(moray_edit_distance("kitten", "sitting") == 3 && moray_edit_distance("", "abc") == 3 &&
              moray_edit_distance("links", "links") == 0 && moray_edit_distance("ab", "ba") == 2,
          "edit distance");
    char lengthy[100];
    memset(lengthy, 'x', sizeof lengthy - 1);
    lengthy[sizeof lengthy - 1] = 0;
    CHECK(!moray_is_near(moray_edit_distance(lengthy, "links"), lengthy), "nothing is near a monster");
    CHECK(strcmp(moray_version(), MORAY_VERSION) == 0, "version %s", moray_version());
}

// ---- Settings of a run of another program ----

typedef struct heir {
    moray_common common;
    double depth;
    char from[64];
} heir;

static void test_run_of_another(void)
{
    static const moray_option own[] = {
        MORAY_ROW(REAL, heir, depth, "problem", "depth_m", .help = "h"),
        MORAY_ROW(RUN, heir, from, "problem", "from", .flag = "from", .argument = "DIR", .help = "h")};
    static const moray_program heir_program = {.name = "h", .summary = "s", .options = own, .n_options = 2};
    char path[64], *argv[] = {"h", "--from", directory};
    heir s = {.common = moray_common_default()};
    moray_request request;
    snprintf(path, sizeof path, "%s/run.ini", directory);
    FILE *file = fopen(path, "w");
    fputs("[links]\nlink_m_kg = 0.4,\n  0.5,\n\n  0.6\n[problem]\ndepth_m = 4\nodd = 1,\n[ipopt]\nmu_strategy = "
          "adaptive\n",
          file);
    fclose(file);
    CHECK_OK(moray_app_parse(&heir_program, 3, argv, &s, &request), "a list of another program");
    CHECK(s.depth == 4, "its own keys are taken: %g", s.depth);
    CHECK(s.common.ipopt.n == 1 && strcmp(s.common.ipopt.at[0].key, "mu_strategy") == 0, "and the options of Ipopt");
    unlink(path);
}

int main(void)
{
    if (!mkdtemp(directory))
        return 1;
    test_values();
    test_bad_values();
    test_messages();
    test_precedence();
    test_bad_files();
    settings s;
    CHECK_OK(PARSE(&s, "--set", "turn=10:20"), "settings");
    check_sound_table(&program, &s, sizeof s);
    test_help();
    test_plain();
    test_words();
    test_idle();
    test_run_of_another();
    test_small_parts();
    rmdir(directory);
    return tap_done();
}
