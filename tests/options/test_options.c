// SPDX-License-Identifier: MIT
#include "degree.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "options/options.h"

typedef struct settings {
    moray_common common;
    int count, mode;
    double real, angle, limit, range[2], turn[2], pair[2];
    bool yes;
    char word[8];
} settings;

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
static const moray_program program = {
    .name = "test", .summary = "s", .options = rows, .n_options = sizeof rows / sizeof *rows};

static char directory[] = "/tmp/moray-options-XXXXXX";

// Parses up to eight arguments into *s, which starts at the defaults.
static moray_status parse(settings *s, const char *const arguments[8])
{
    char *argv[10] = {"test"};
    int argc = 1;
    for (int i = 0; i < 8 && arguments[i]; i++)
        argv[argc++] = (char *)arguments[i];
    moray_request request;
    *s = (settings){.common = moray_common_defaults(), .limit = INFINITY, .range = {0, INFINITY}, .word = "word"};
    return moray_app_parse(&program, argc, argv, s, &request);
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
    CHECK(s.common.robot.links == 6, "the last of several wins: %d", s.common.robot.links);
    CHECK(s.common.current[0] == -0.1 && s.common.current[1] == 0.2, "a value may begin with a dash");
    CHECK_NEAR(s.common.course, M_PI / 4, 1e-15, "--course is in degrees");
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
        {{"--set", "rho_kg_m3=1e308"}, "m = inf: must be finite"},
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
    const char *path =
        ini("[robot]\nlinks = 6\nC_D = 1\n[test]\nreal = 2\nword=ini ; a comment\n[solver]\ntol = 1e-3\n");
    CHECK_OK(PARSE(&s, "--robot", path), "a file alone");
    CHECK(s.common.robot.links == 6 && s.real == 2 && s.common.tol == 1e-3, "the file overrides the defaults");
    CHECK(strcmp(s.word, "ini") == 0 && s.common.intervals == 40, "comments go, what the file leaves out stays");
    CHECK_OK(PARSE(&s, "--links", "7", "--robot", path, "--set", "real=3"), "the command line, before and after");
    CHECK(s.common.robot.links == 7, "an option before --robot overrides the file: %d", s.common.robot.links);
    CHECK(s.real == 3 && s.common.tol == 1e-3, "an option after --robot overrides the file: %g", s.real);
    moray_request request;
    char *argv[] = {"test", "--links", "1", "--help"};
    s.common.robot.links = 8;
    CHECK_OK(moray_app_parse(&program, 4, argv, &s, &request), "--help beside a bad value");
    CHECK(request == MORAY_REQUEST_HELP && s.common.robot.links == 8, "help is asked for and nothing is set");
}

static bool same_robot(const moray_robot *a, const moray_robot *b)
{
    return a->links == b->links &&
           memcmp(&a->l, &b->l, sizeof *a - offsetof(moray_robot, l)) == 0; // doubles only, without padding
}

static void test_robot(void)
{
    settings s;
    const moray_robot paper = moray_robot_paper();
    CHECK_OK(PARSE(&s, NULL), "no arguments");
    CHECK(same_robot(&s.common.robot, &paper), "the default is the paper's robot");
    CHECK_OK(PARSE(&s, "--set", "C_D=1", "--set", "length_m=0.2", "--set", "m_kg=3", "--set", "c_t=0"), "a mix");
    CHECK_NEAR(s.common.robot.c_n, 1000 * 1 * 2 * 0.03 * 0.1, 1e-12, "c_n = rho C_D 2 b_e l from the geometry");
    CHECK(s.common.robot.l == 0.1, "l is half of length_m: %g", s.common.robot.l);
    CHECK(s.common.robot.m == 3 && s.common.robot.c_t == 0, "direct keys override the geometry");
    const char *path =
        ini("[robot]\nlinks=3\nl_m=0.1\nm_kg=1\nJ_kg_m2=2\nc_t=3\nc_n=4\nmu_n=5\nlambda_1=6\nlambda_2=7\n"
            "lambda_3=8\nrot_damping=9\nrot_gain=10\nk_p=11\nk_d=12\n");
    CHECK_OK(PARSE(&s, "--robot", path), "all direct keys");
    const moray_robot direct = {3, 0.1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    CHECK(same_robot(&s.common.robot, &direct), "each direct key reaches its field");
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
    CHECK(status.code == MORAY_IO && strstr(status.text, "is a directory"), "a directory: %s", status.text);
    status = PARSE(&s, "--robot", "/tmp/moray-no-such-file");
    CHECK(status.code == MORAY_IO && strstr(status.text, "No such file"), "no file: %s", status.text);
    memset(wide, 'p', sizeof wide - 1);
    status = PARSE(&s, "--robot", wide);
    CHECK(status.code == MORAY_IO && strstr(status.text, "too long"), "a path too long: %s", status.text);
    CHECK_OK(PARSE(&s, "--robot", ini("\xEF\xBB\xBF[robot]\r\n\tlinks = 5\r\n   ; done")),
             "BOM, CR, tab, no last newline");
    CHECK(s.common.robot.links == 5, "they do not disturb: %d", s.common.robot.links);
    CHECK_OK(PARSE(&s, "--robot", "/dev/null"), "an empty file");
    unlink(ini(""));
}

static size_t size_of(const moray_option *row)
{
    switch (row->type) {
    case MORAY_OPTION_INT:
    case MORAY_OPTION_CHOICE:
        return sizeof(int);
    case MORAY_OPTION_REAL:
    case MORAY_OPTION_LIMIT:
        return sizeof(double);
    case MORAY_OPTION_BOOL:
        return sizeof(bool);
    case MORAY_OPTION_RANGE:
    case MORAY_OPTION_PAIR:
        return 2 * sizeof(double);
    case MORAY_OPTION_TEXT:
        break;
    }
    return row->size;
}

// Every row is sound: its name is its own, its size fits its type, and its default as --help shows it is allowed and
// means the same.
static void test_table(void)
{
    settings s, again;
    moray_options options;
    CHECK_OK(PARSE(&s, "--set", "turn=10:20"), "settings");
    CHECK_OK(moray_options_new(&options, &program), "table");
    for (int i = 0; i < options.n; i++) {
        const moray_option *row = &options.row[i];
        char shown[MORAY_SHOWN_SIZE];
        const char *name = row->key ? row->key : row->flag;
        CHECK(row->size == size_of(row) && row->help && (!row->key == !row->section), "%s is well formed", name);
        for (int j = 0; j < i; j++)
            if ((row->key && options.row[j].key && strcmp(row->key, options.row[j].key) == 0) ||
                (row->flag && options.row[j].flag && strcmp(row->flag, options.row[j].flag) == 0))
                CHECK(false, "%s is there twice", name);
        if (!moray_option_default(row, &s, shown))
            continue;
        again = (settings){0};
        CHECK_OK(moray_option_read(row, name, shown, &again), name);
        const char *was = (char *)&s + row->offset, *is = (char *)&again + row->offset;
        const bool reals = row->type == MORAY_OPTION_REAL || row->type == MORAY_OPTION_PAIR;
        CHECK(reals ? fabs(*(const double *)was - *(const double *)is) <= 1e-9 * fabs(*(const double *)was)
              : row->type == MORAY_OPTION_TEXT ? strcmp(was, is) == 0
                                               : row->type == MORAY_OPTION_RANGE || memcmp(was, is, row->size) == 0,
              "%s: the default shown as %s reads back", name, shown);
    }
    free(options.row);
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
    free(options.row);
}

static void test_without_robot(void)
{
    moray_common s = moray_common_defaults();
    moray_request request;
    const moray_program plain = {.name = "plain", .summary = "s", .no_robot = true};
    char *good[] = {"plain", "--scheme", "radau3", "--intervals", "7"}, *bad[] = {"plain", "--links", "5"};
    CHECK_OK(moray_app_parse(&plain, 5, good, &s, &request), "a program without robot has the solver's options");
    CHECK(strcmp(s.scheme, "radau3") == 0 && s.intervals == 7, "they are set: %s %d", s.scheme, s.intervals);
    CHECK(moray_app_parse(&plain, 3, bad, &s, &request).code == MORAY_INPUT, "but not those of the robot");
}

// Words without a flag, and shared options left out.
typedef struct wordy {
    moray_common common;
    bool said[3];
} wordy;

static moray_status parse_words(wordy *s, const char *const arguments[4])
{
    static const moray_word word[] = {{"eel", "h"}, {"straight", "h"}, {"turning", "what turns"}};
    static const moray_words words = {
        .noun = "study", .word = word, .n = 3, .all = "all", .offset = offsetof(wordy, said)};
    static const char *const without[] = {"scheme", "course", NULL};
    static const moray_program wordy_program = {.name = "w", .summary = "s", .words = &words, .without = without};
    char *argv[6] = {"w"};
    int argc = 1;
    moray_request request;
    for (int i = 0; i < 4 && arguments[i]; i++)
        argv[argc++] = (char *)arguments[i];
    *s = (wordy){.common = moray_common_defaults()};
    const moray_status status = moray_app_parse(&wordy_program, argc, argv, s, &request);
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
    CHECK(s.said[0] && !s.said[1] && s.said[2] && s.common.robot.links == 5, "each is marked");
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
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "unknown option --scheme"), "%s", status.text);
    status = PARSE_WORDS(&s, "eel", "--set", "course=3");
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "unknown key course"), "%s", status.text);
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
    CHECK(moray_exit_of(MORAY_OK) == 0 && moray_exit_of(MORAY_NOT_SOLVED) == 1 && moray_exit_of(MORAY_NUMERIC) == 1 &&
              moray_exit_of(MORAY_MEMORY) == 1 && moray_exit_of(MORAY_INPUT) == 2 && moray_exit_of(MORAY_IO) == 2 &&
              moray_exit_of(MORAY_INTERRUPTED) == 130,
          "exit codes");
    CHECK(strcmp(moray_version(), MORAY_VERSION) == 0, "version %s", moray_version());
}

int main(void)
{
    if (!mkdtemp(directory))
        return 1;
    test_values();
    test_bad_values();
    test_messages();
    test_precedence();
    test_robot();
    test_bad_files();
    test_table();
    test_help();
    test_without_robot();
    test_words();
    test_small_parts();
    rmdir(directory);
    return tap_done();
}
