// SPDX-License-Identifier: MIT
//
// The settings of a run as a file: what stands in it, and that it gives them back to the last bit.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "options/options.h"

enum { MANY = 60 };

typedef struct settings {
    int count, mode;
    double real, angle, limit, none, range[2], turn[2], pair[2], unset, list[MANY], turns[MANY], empty[MANY];
    bool yes;
    char word[40], odd[40];
    moray_ipopt_list ipopt;
} settings;

static const char *const modes[] = {"slow", "fast|quick", NULL};
#define ROW(kind, part, field, ...) MORAY_ROW(kind, settings, field, part, #field, __VA_ARGS__)
static const moray_option rows[] = {
    ROW(INT, "one", count, .min = 1, .max = 1000, .help = "h"),
    ROW(CHOICE, "two", mode, .choices = modes, .help = "h"),
    ROW(REAL, "one", real, .help = "h"),
    ROW(REAL, "one", angle, .unit = "deg", .help = "h"),
    ROW(LIMIT, "two", limit, .max = INFINITY, .help = "h"),
    ROW(LIMIT, "one", none, .max = INFINITY, .help = "h"),
    ROW(RANGE, "one", range, .help = "h"),
    ROW(RANGE, "two", turn, .unit = "deg", .help = "h"),
    ROW(PAIR, "one", pair, .help = "h"),
    ROW(REAL, "two", unset, .help = "h"),
    ROW(LIST, "three", list, .help = "h"),
    ROW(LIST, "three", turns, .min = -1e9, .max = 1e9, .unit = "deg", .help = "h"),
    ROW(LIST, "three", empty, .min = 0, .max = 2, .open = true, .help = "h"),
    ROW(BOOL, "two", yes, .help = "h"),
    ROW(TEXT, "one", word, .help = "h"),
    ROW(TEXT, "one", odd, .help = "h"),
    {.flag = "ipopt", .type = MORAY_OPTION_IPOPT, MORAY_AT(settings, ipopt), .help = "h"},
    {.flag = "config", .type = MORAY_OPTION_INI, .help = "h"},
};
enum { N = sizeof rows / sizeof *rows };
static const moray_options options = {.row = rows, .n = N, .program = "test"};

static const moray_option *row_of(const char *key)
{
    return moray_option_find(&options, key);
}

static void fill(double *list, int n, const double *values)
{
    for (int k = 0; k < MANY; k++)
        list[k] = k < n ? values[k] : NAN;
}

static settings plain(void)
{
    settings s = {.count = 7,
                  .mode = 1,
                  .real = 0.1,
                  .angle = M_PI / 4,
                  .limit = 2.5,
                  .none = INFINITY,
                  .range = {-INFINITY, 3},
                  .turn = {0, M_PI / 2},
                  .pair = {-1, 1e-300},
                  .unset = NAN,
                  .yes = true,
                  .word = "two words",
                  .odd = "a ; b"};
    fill(s.list, 6, (const double[]){0.2, 0.14, 0.14, 0.14, 0.1, 0.2});
    fill(s.turns, 3, (const double[]){M_PI, M_PI, -M_PI / 2});
    fill(s.empty, 0, NULL);
    return s;
}

static char *written(const settings *s, bool given[N])
{
    static char *text;
    static size_t size;
    FILE *file = open_memstream(&text, &size);
    moray_options_write(&options, s, file, given);
    moray_options_write_rest(&options, s, file, given);
    fclose(file);
    return text;
}

static moray_status read_back(const char *text, settings *s)
{
    char path[] = "/tmp/moray-settings-XXXXXX";
    const int handle = mkstemp(path);
    FILE *file = fdopen(handle, "w");
    fputs(text, file);
    fclose(file);
    const moray_status status = moray_ini_read(&options, &rows[N - 1], path, s);
    unlink(path);
    return status;
}

// Each section once, with all that belongs to it; what a file could not give is told as a remark.
static void test_text(void)
{
    static const char *const want =
        "; The settings of a run; --config with this file repeats it.\n[run]\nprogram = test\n"
        "\n[one]\ncount = 7\nreal = 0.1\nangle = 45\nnone = none\nrange = none:3\npair = -1,1e-300\nword = two words\n"
        "; odd: not given\n"
        "\n[two]\nmode = fast\nlimit = 2.5\nturn = 0:90\n; unset: not given\nyes = yes\n"
        "\n[three]\nlist = 0.2, 3*0.14, 0.1, 0.2\nturns = 2*180, -90\n; empty: not given\n"
        "\n[ipopt]\nmu_init = 0.5\n";
    settings s = plain();
    bool given[N] = {false};
    CHECK_OK(moray_ipopt_list_set(&s.ipopt, "mu_init=0.5"), "an option of Ipopt");
    char *text = written(&s, given);
    CHECK(strcmp(text, want) == 0, "%s", text);
    settings again = {.mode = 0};
    CHECK_OK(read_back(text, &again), "read again");
    CHECK(again.count == 7 && again.mode == 1 && again.yes && strcmp(again.word, s.word) == 0 && !*again.odd,
          "whole numbers and words");
    CHECK(again.real == s.real && again.angle == s.angle && again.limit == s.limit && isinf(again.none) &&
              isinf(again.range[0]) && again.range[1] == 3 && again.turn[1] == s.turn[1] && again.pair[1] == 1e-300,
          "numbers");
    CHECK(memcmp(again.list, s.list, sizeof s.list) == 0 && memcmp(again.turns, s.turns, sizeof s.turns) == 0, "lists");
    CHECK(again.ipopt.n == 1 && strcmp(again.ipopt.at[0].value, "0.5") == 0, "Ipopt's");
    free(text);
    char *other = written(&s, given);
    given[9] = given[14] = false;
    strcpy(s.word, "later");
    s.unset = 3;
    text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    moray_options_write_rest(&options, &s, file, given);
    fclose(file);
    CHECK(strcmp(text, "\n; What follows from these:\n;   unset = 3\n;   word = later\n") == 0, "what followed: %s",
          text);
    free(text);
    free(other);
}

// A line goes on until it is longer than 150 letters, and no list changes on the way.
static void test_long_lists(void)
{
    unsigned long long seed = 31;
    bool sound = true;
    int lines = 0, exact = 0;
    for (int round = 0; round < 60; round++) {
        settings s = plain(), again = {.mode = 0};
        bool given[N];
        for (int k = 0; k < MANY; k++) {
            const double digits = pow(10, floor(tap_random(&seed, 1, 12)));
            s.list[k] = k > 0 && tap_random(&seed, 0, 1) < 0.2 ? s.list[k - 1] : tap_random(&seed, -digits, digits);
            s.list[k] = round % 2 ? floor(s.list[k]) : s.list[k];
            s.turns[k] = tap_random(&seed, -180, 180) * moray_option_scale(row_of("turns"));
        }
        char *text = written(&s, given);
        sound = sound && !moray_failed(read_back(text, &again)) && memcmp(again.list, s.list, sizeof s.list) == 0 &&
                memcmp(again.turns, s.turns, sizeof s.turns) == 0;
        for (char *line = strtok(strstr(text, "list = "), "\n"); line && *line != ';'; line = strtok(NULL, "\n")) {
            const size_t length = strlen(line);
            const bool goes_on = line[length - 1] == ',';
            line[length - 1] = 0;
            const char *last = strrchr(line, ',');
            lines += goes_on;
            exact += goes_on && length == 151;
            sound = sound && (!goes_on || (length > 150 && last && last - line + 1 <= 150));
        }
        free(text);
    }
    CHECK(sound, "the same, in lines as long as that");
    CHECK(lines > 100 && exact > 0, "%d lines, %d of them by a letter", lines, exact);
}

// Not every double is a number of degrees in rad: then it is one that is no farther than the next.
static void test_between(void)
{
    unsigned long long seed = 7;
    const moray_option *row = row_of("angle");
    const double scale = moray_option_scale(row);
    int exact = 0, beside = 0;
    for (int k = 0; k < 1000; k++) {
        char text[32];
        const double value = tap_random(&seed, -4, 4);
        moray_option_show_exactly(row, value, text);
        const double got = strtod(text, NULL) * scale;
        exact += got == value;
        beside += got == nextafter(value, INFINITY) || got == nextafter(value, -INFINITY);
    }
    CHECK(exact + beside == 1000 && exact > 700 && beside > 0, "%d the same, %d beside it", exact, beside);
}

static void test_bad_lists(void)
{
    static const char *const bad[] = {"",   ",",   "1,",    ",1",  "x*1", "2x*1", "0*1",     "-1*1", "*1",
                                      "1*", "1 1", "2*3*4", "nan", "inf", "61*1", "60*1, 1", "1.5*1"};
    const moray_option *row = row_of("list"), *open = row_of("empty");
    double to[MANY];
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        CHECK(!moray_list_read(row, bad[k], to), "no list: \"%s\"", bad[k]);
    CHECK(moray_list_read(row, " 2 * 3 , 4", to) && moray_list_length(to, MANY) == 3 && to[0] == 3 && to[1] == 3 &&
              to[2] == 4 && isnan(to[3]),
          "with blanks");
    CHECK(moray_list_read(row, "60*1", to) && moray_list_length(to, MANY) == MANY, "as many as there may be");
    CHECK(!moray_list_read(open, "0", to) && !moray_list_read(open, "2", to) && !moray_list_read(open, "-1", to) &&
              !moray_list_read(open, "1, 3", to) && moray_list_read(open, "1, 1.9", to),
          "within what is allowed");
    char lengthy[80];
    memset(lengthy, '0', sizeof lengthy);
    lengthy[63] = 0;
    CHECK(moray_list_read(row, lengthy, to), "63 letters of a number");
    lengthy[63] = '0', lengthy[64] = 0;
    CHECK(!moray_list_read(row, lengthy, to), "no more");
}

static void test_refused(void)
{
    settings s = plain();
    const struct {
        const char *text, *says;
    } cases[] = {{"[run]\nprogram = other\n", ":2: program = other: these are settings of that program, not of test"},
                 {"[run]\nword = all\n", ":2: unknown key word of [run]"},
                 {"[three]\nlist = 1,\n", "list: a list ends without a comma"},
                 {"[three]\nlist = 1,\nx\n", "list = 1,x: must be"},
                 {"[ipopt]\nmu_init = 1\nmu_init = 2\n", ":3: mu_init is given twice"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const moray_status status = read_back(cases[k].text, &s);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, cases[k].says), "%s", status.text);
    }
    CHECK_OK(read_back("[run]\nprogram = test\n[three]\nlist = 1,\n   2\n", &s), "a list of two lines");
    CHECK(s.list[0] == 1 && s.list[1] == 2 && isnan(s.list[2]), "%g, %g", s.list[0], s.list[1]);
}

// As long as there is room for, and no longer; as many as there is room for.
static void test_ipopt(void)
{
    moray_ipopt_list list = {0};
    char text[MORAY_IPOPT_SIZE + 1];
    memset(text, 'v', sizeof text);
    memcpy(text, "key=", 4);
    text[MORAY_IPOPT_SIZE] = 0;
    CHECK(moray_ipopt_list_set(&list, text).code == MORAY_INPUT && list.n == 0, "too long");
    text[MORAY_IPOPT_SIZE - 1] = 0;
    CHECK_OK(moray_ipopt_list_set(&list, text), "as long as may be");
    CHECK(strlen(list.at[0].value) == MORAY_IPOPT_SIZE - 5 && strcmp(list.at[0].key, "key") == 0, "kept whole");
    for (int k = 1; k < MORAY_IPOPT_OPTIONS; k++) {
        snprintf(text, sizeof text, "key%d=%d", k, k);
        CHECK_OK(moray_ipopt_list_set(&list, text), text);
    }
    CHECK(moray_ipopt_list_set(&list, "more=1").code == MORAY_INPUT, "one too many");
    CHECK_OK(moray_ipopt_list_set(&list, "key7=seven"), "one that is there");
    CHECK(list.n == MORAY_IPOPT_OPTIONS && strcmp(list.at[7].value, "seven") == 0 &&
              strcmp(list.at[8].value, "8") == 0 && moray_ipopt_list_has(&list, "key31") &&
              !moray_ipopt_list_has(&list, "key32"),
          "in its place");
    static const char *const bad[] = {"key", "=1", "key=", ""};
    for (int k = 0; k < 4; k++)
        CHECK(moray_ipopt_list_set(&list, bad[k]).code == MORAY_INPUT, "ipopt.%s", bad[k]);
}

// Help says of a row what is allowed where its value is a number or one of some words.
static void test_help(void)
{
    static const struct {
        const char *key, *text;
    } cases[] = {
        {"count", "h; an integer from 1 to 1000; default 7"},
        {"mode", "h; slow or fast; default fast"},
        {"real", "h; a finite number; default 0.1"},
        {"unset", "h; a finite number"},
        {"yes", "h; default yes"},
        {"word", "h; default two words"},
        {"pair", "h; X,Y, each a finite number; default -1,1e-300"},
    };
    const settings s = plain();
    char text[MORAY_TEXT_SIZE];
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        moray_option_text(row_of(cases[k].key), &s, text);
        CHECK(strcmp(text, cases[k].text) == 0, "%s: %s", cases[k].key, text);
    }
    const moray_option run = ROW(RUN, "one", word, .help = "r");
    moray_option_text(&run, &s, text);
    CHECK(strcmp(text, "r; default two words") == 0, "%s", text);
    for (int k = N - 2; k < N; k++) {
        moray_option_text(&rows[k], &s, text);
        CHECK(strcmp(text, "h") == 0, "%s", text);
    }
}

int main(void)
{
    test_text();
    test_long_lists();
    test_between();
    test_bad_lists();
    test_refused();
    test_ipopt();
    test_help();
    return tap_done();
}
