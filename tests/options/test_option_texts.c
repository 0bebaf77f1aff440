// SPDX-License-Identifier: MIT
//
// Help and list of a small program whole, what is allowed and shown of single rows, and a run.ini of words.
#define _GNU_SOURCE // mkdtemp
#include "arguments.h"
#include "tap.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "moray/angle.h"
#include "options/options.h"

typedef struct part {
    double mass, angle;
} part;
typedef struct settings {
    moray_common common;
    part part;
    int count, mode;
    double turn[2], rate, list[3];
    bool deep, said[3];
    char name[8];
} settings;

static const char *const modes[] = {"slow|calm", "fast", "still", NULL};
static const moray_option part_rows[] = {
    MORAY_ROW(REAL, part, mass, "body", "m_kg", .max = INFINITY, .open = true, .unit = "kg", .help = "its mass"),
    MORAY_ROW(REAL, part, angle, "water", "angle", .flag = "angle", .argument = "DEG", .unit = "deg",
              .help = "where to")};
static const moray_option_table part_table = {.rows = part_rows, .n = 2};
static const moray_option_group groups[] = {{&part_table, offsetof(settings, part)}};
static const moray_option rows[] = {
    MORAY_ROW(INT, settings, count, "body", "count", .flag = "count", .min = 2, .max = 9, .help = "how many"),
    MORAY_ROW(CHOICE, settings, mode, "body", "mode", .choices = modes,
              .help = "how it goes, which is told in more words than one line of the text has room for"),
    MORAY_ROW(RANGE, settings, turn, "water", "turn", .min = -90, .max = 90, .unit = "deg", .help = "turns"),
    MORAY_ROW(LIMIT, settings, rate, "water", "rate", .max = INFINITY, .unit = "deg/s", .help = "at most"),
    MORAY_ROW(LIST, settings, list, "body", "list", .min = -1, .max = 1, .open = true, .help = "a list"),
    MORAY_ROW(BOOL, settings, deep, "water", "deep", .help = "below"),
    MORAY_ROW(TEXT, settings, name, "body", "name_of_something_that_is_long", .help = "a name")};
static const moray_word word[] = {{"eel", "one"}, {"cod", "two"}, {"ray", "three"}};
static const moray_words words = {
    .noun = "fish", .word = word, .n = 3, .all = "all", .offset = offsetof(settings, said)};
static const char *const without[] = {"scheme", "intervals", "tol", "linear_solver", "json", NULL};
static const moray_program program = {.name = "prog",
                                      .summary = "Does it.",
                                      .options = rows,
                                      .n_options = 7,
                                      .groups = groups,
                                      .n_groups = 1,
                                      .words = &words,
                                      .without = without};

static settings usual(void)
{
    return (settings){.common = moray_common_default(),
                      .part = {.mass = 2.5, .angle = 45 * MORAY_DEGREE},
                      .count = 4,
                      .mode = 1,
                      .turn = {-30 * MORAY_DEGREE, 60 * MORAY_DEGREE},
                      .rate = 90 * MORAY_DEGREE,
                      .list = {NAN, NAN, NAN},
                      .name = "moray"};
}

static void check_text(moray_status (*write)(const moray_program *, const void *, FILE *), const char *wanted)
{
    char *text = NULL;
    size_t size = 0;
    const settings s = usual();
    FILE *file = open_memstream(&text, &size);
    CHECK_OK(write(&program, &s, file), "a text");
    fclose(file);
    CHECK(strcmp(text, wanted) == 0, "%s", text);
    free(text);
}

static void test_help(void)
{
    check_text(moray_app_help,
               "Usage: prog [OPTION]... FISH...\nDoes it.\n\nFISH is one or more of:\n"
               "  eel                      one\n  cod                      two\n  ray                      three\n"
               "  all                      all of these\n"
               "\nOptions:\n"
               "  --count N                how many; an integer from 2 to 9; default 4\n"
               "  --angle DEG              where to; a finite number in deg; default 45\n"
               "  --out DIR                write summary, trajectory, figures and report into\n"
               "                           this directory\n"
               "  --config FILE            INI file with any of the keys below\n"
               "  --quiet                  show no progress\n"
               "  --set KEY=VALUE          set any key of the lists below; may be repeated\n"
               "  --help                   show this text\n"
               "  --version                show the version\n"
               "\nKeys for --set, in INI files under [body]:\n"
               "  count=N                  as --count\n"
               "  mode=NAME                how it goes, which is told in more words than one\n"
               "                           line of the text has room for; slow, fast or still;\n"
               "                           default fast\n"
               "  list=X,...               a list; at most 3 numbers by commas, k*X for k\n"
               "                           alike, each a number above -1 and below 1\n"
               "  name_of_something_that_is_long=TEXT\n"
               "                           a name; default moray\n"
               "  m_kg=X                   its mass; a number above 0 kg; default 2.5\n"
               "\nKeys for --set, in INI files under [water]:\n"
               "  turn=LOW:HIGH            turns; LOW:HIGH or one value, LOW <= HIGH, each none\n"
               "                           or a number from -90 to 90 deg; default -30:60\n"
               "  rate=X|none              at most; none or a number of at least 0 deg/s;\n"
               "                           default 90\n"
               "  deep=yes|no              below; default no\n"
               "  angle=DEG                as --angle\n"
               "\nKeys for --set, in INI files under [ipopt]:\n"
               "  ipopt.KEY=VALUE          any option of Ipopt by its name, after all that is\n"
               "                           set otherwise; in INI files KEY = VALUE\n"
               "\nThe INI file overrides the defaults, the command line overrides both.\n"
               "Exit status: 0 solved and certified, 1 not solved, 2 bad usage or input, 3\n"
               "certificate failed, 130 interrupted.\n");
}

static void test_list(void)
{
    check_text(moray_app_help_list,
               "program\tprog\tDoes it.\nword\teel\tone\nword\tcod\ttwo\nword\tray\tthree\nword\tall\tall of these\n"
               "flag\tcount\tN\t\thow many; an integer from 2 to 9; default 4\n"
               "flag\tangle\tDEG\t\twhere to; a finite number in deg; default 45\n"
               "flag\tout\tDIR\t\twrite summary, trajectory, figures and report into this directory\n"
               "flag\tconfig\tFILE\t\tINI file with any of the keys below\n"
               "flag\tquiet\t\t\tshow no progress\n"
               "flag\tset\tKEY=VALUE\t\tset any key of the lists below; may be repeated\n"
               "flag\thelp\t\t\tshow this text\nflag\tversion\t\t\tshow the version\n"
               "key\tbody\tcount\tN\t\tas --count\n"
               "key\tbody\tmode\tNAME\tslow fast still\thow it goes, which is told in more words than one line of the "
               "text has room for; slow, fast or still; default fast\n"
               "key\twater\tturn\tLOW:HIGH\t\tturns; LOW:HIGH or one value, LOW <= HIGH, each none or a number from "
               "-90 to 90 deg; default -30:60\n"
               "key\twater\trate\tX|none\t\tat most; none or a number of at least 0 deg/s; default 90\n"
               "key\tbody\tlist\tX,...\t\ta list; at most 3 numbers by commas, k*X for k alike, each a number above "
               "-1 and below 1\n"
               "key\twater\tdeep\tyes|no\tyes no\tbelow; default no\n"
               "key\tbody\tname_of_something_that_is_long\tTEXT\t\ta name; default moray\n"
               "key\tbody\tm_kg\tX\t\tits mass; a number above 0 kg; default 2.5\n"
               "key\twater\tangle\tDEG\t\tas --angle\n"
               "key\tipopt\tipopt.KEY\tVALUE\t\tany option of Ipopt by its name, after all that is set otherwise; in "
               "INI files KEY = VALUE\n"
               "note\tThe INI file overrides the defaults, the command line overrides both.\n"
               "note\tExit status: 0 solved and certified, 1 not solved, 2 bad usage or input, 3 certificate failed, "
               "130 interrupted.\n");
}

// What cannot be written is told, even where nothing is left in a buffer.
static void test_full(void)
{
    const settings s = usual();
    for (int k = 0; k < 4; k++) {
        FILE *full = fopen("/dev/full", "w");
        if (k / 2)
            setvbuf(full, NULL, _IONBF, 0);
        const moray_status status = (k % 2 ? moray_app_help : moray_app_help_list)(&program, &s, full);
        CHECK(status.code == MORAY_IO && strcmp(status.text, k % 2 ? "the help text cannot be written"
                                                                   : "the list of options cannot be written") == 0,
              "%s", status.text);
        fclose(full);
    }
}

// Texts of 63 bytes have a distance, longer ones none.
static void test_distance(void)
{
    char lengthy[65];
    memset(lengthy, 'x', 64);
    lengthy[64] = 0;
    CHECK(moray_edit_distance(lengthy, "links") == INT_MAX && moray_edit_distance("links", lengthy) == INT_MAX,
          "64 bytes are too many on either side");
    lengthy[63] = 0;
    CHECK(moray_edit_distance(lengthy, "x") == 62 && moray_edit_distance("x", lengthy) == 62, "63 are not");
    CHECK(moray_is_near(2, "abcde") && !moray_is_near(3, "abcde") && moray_is_near(3, "abcdef"),
          "one in three is near");
}

// A row of a number, with each sort of bounds.
static void test_allowed(void)
{
    static const struct {
        moray_option row;
        const char *text;
    } cases[] = {{{.type = MORAY_OPTION_REAL, .min = -2, .max = 3}, "a number from -2 to 3"},
                 {{.type = MORAY_OPTION_REAL, .min = -2, .max = 3, .open = true, .unit = "m"},
                  "a number above -2 and below 3 m"},
                 {{.type = MORAY_OPTION_REAL, .min = 1, .max = INFINITY}, "a number of at least 1"},
                 {{.type = MORAY_OPTION_REAL, .min = -INFINITY, .max = 1, .unit = "s"}, "a number of at most 1 s"},
                 {{.type = MORAY_OPTION_REAL, .min = -INFINITY, .max = 1, .open = true}, "a number below 1"},
                 {{.type = MORAY_OPTION_REAL, .unit = "s"}, "a finite number in s"},
                 {{.type = MORAY_OPTION_INT}, "an integer"},
                 {{.type = MORAY_OPTION_INT, .min = -INFINITY, .max = 4}, "an integer of at most 4"},
                 {{.type = MORAY_OPTION_BOOL}, "yes or no"},
                 {{.type = MORAY_OPTION_TEXT, .size = 8}, "a text of 1 to 7 bytes"},
                 {{.type = MORAY_OPTION_RUN, .size = 8}, "the folder of a run, with a run.ini"},
                 {{.type = MORAY_OPTION_INI}, "the path of a file"},
                 {{.type = MORAY_OPTION_CHOICE, .choices = modes}, "slow, fast or still"},
                 {{.type = MORAY_OPTION_CHOICE, .choices = modes + 1}, "fast or still"},
                 {{.type = MORAY_OPTION_CHOICE, .choices = modes + 2}, "still"}};
    char text[MORAY_SHOWN_SIZE];
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        moray_option_allowed(&cases[k].row, text);
        CHECK(strcmp(text, cases[k].text) == 0, "%s", text);
    }
}

// What is shown of a value that has none to show, or is the program's to choose.
static void test_shown(void)
{
    static const struct {
        int row, count, mode;
        double low, high;
        const char *text; // NULL: nothing
    } cases[] = {{0, 1, 0, 0, 0, "by the program"},
                 {0, 2, 0, 0, 0, "2"},
                 {1, 0, -1, 0, 0, NULL},
                 {1, 0, 0, 0, 0, "slow"},
                 {1, 0, 2, 0, 0, "still"},
                 {2, 0, 0, NAN, 1, NULL},
                 {2, 0, 0, 1, NAN, NULL},
                 {2, 0, 0, -INFINITY, 0, "none:0"},
                 {2, 0, 0, 0, INFINITY, "0:none"}};
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[MORAY_SHOWN_SIZE] = "";
        const settings s = {.count = cases[k].count, .mode = cases[k].mode, .turn = {cases[k].low, cases[k].high}};
        const bool shown = moray_option_default(&rows[cases[k].row], &s, text);
        CHECK(shown == !!cases[k].text && (!shown || strcmp(text, cases[k].text) == 0), "%s", text);
    }
    settings s = usual();
    char text[MORAY_SHOWN_SIZE];
    s.deep = true, s.name[0] = 0;
    CHECK(moray_option_default(&rows[5], &s, text) && strcmp(text, "yes") == 0, "%s", text);
    CHECK(!moray_option_default(&rows[6], &s, text), "an empty text is none");
    CHECK(!moray_option_default(&rows[4], &s, text), "nor is a list shown");
}

static moray_status parse(settings *s, char **ini, const char *const arguments[6])
{
    command_line line;
    moray_request request;
    command_set(&line, "prog", arguments, 6);
    *s = usual();
    return moray_options_parse(&program, line.argc, line.argv, s, &request, ini);
}
#define PARSE(s, ini, ...) parse((s), (ini), (const char *const[6]){__VA_ARGS__})

// A run's file names its words, which the next run has too unless it is given others.
static void test_run(void)
{
    static const char wanted[] =
        "; The settings of a run; --config with this file repeats it.\n[run]\nprogram = prog\nword = eel\nword = ray\n"
        "\n[body]\ncount = 4\nmode = fast\nlist = 0.5, 2*-0.25\nname_of_something_that_is_long = moray\nm_kg = 2.5\n"
        "\n[water]\nturn = -30:60\nrate = 90\ndeep = no\nangle = 45\n"
        "\n[ipopt]\nmu_init = 0.5\nmax_iter = 7\n";
    settings s;
    char *ini = NULL;
    CHECK_OK(PARSE(&s, &ini, "ray", "eel", "--set=list=0.5,2*-.25", "--set=ipopt.mu_init=0.5", "--set=ipopt.max_iter=7",
                   "--out=x"),
             "a run");
    CHECK(ini && strcmp(ini, wanted) == 0, "its file: %s", ini);
    CHECK(s.common.ipopt.n == 2 && strcmp(s.common.ipopt.at[0].key, "mu_init") == 0 &&
              strcmp(s.common.ipopt.at[1].value, "7") == 0,
          "options of Ipopt by --set");
    FILE *file = fopen("run.ini", "w");
    fputs(ini ? ini : "", file);
    fclose(file);
    free(ini);
    ini = NULL;
    CHECK_OK(PARSE(&s, &ini, "--config", "run.ini"), "the same again");
    CHECK(s.said[0] && !s.said[1] && s.said[2] && s.list[2] == -0.25 && s.common.ipopt.n == 2, "with its words");
    CHECK_OK(PARSE(&s, &ini, "cod", "--set=turn=30:30"), "a range of one value");
    CHECK(s.turn[0] == 30 * MORAY_DEGREE && s.turn[1] == s.turn[0], "%g:%g", s.turn[0], s.turn[1]);
    CHECK(!ini, "of which no file is made without a folder");
    CHECK_OK(PARSE(&s, &ini, "cod", "--config", "run.ini"), "with another word");
    CHECK(!s.said[0] && s.said[1] && !s.said[2], "that one stands alone");
    file = fopen("run.ini", "w");
    fputs("[run]\nprogram = prog\nword = eal\n", file);
    fclose(file);
    const moray_status status = PARSE(&s, &ini, "--config", "run.ini");
    CHECK(status.code == MORAY_INPUT && strstr(status.text, ":3: unknown fish eal; did you mean eel?"), "%s",
          status.text);
    unlink("run.ini");
}

// A section that is indented.
static void test_indented(void)
{
    char text[200] = "";
    const moray_ini_entry entries[] = {{"a", "1"}, {"b", "2"}};
    FILE *file = fopen("in.ini", "w");
    fputs("[other]\na = 9\n  \t[robot]\n a = 5\n\n[last]\nb = 3\n", file);
    fclose(file);
    CHECK_OK(moray_ini_set("in.ini", "robot", entries, 2), "two keys");
    file = fopen("in.ini", "r");
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    CHECK(strcmp(text, "[other]\na = 9\n  \t[robot]\na = 1\nb = 2\n\n[last]\nb = 3\n") == 0, "%s", text);
    unlink("in.ini");
}

int main(void)
{
    char folder[] = "/tmp/moray-texts-XXXXXX";
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    test_help();
    test_list();
    test_full();
    test_distance();
    test_allowed();
    test_shown();
    test_run();
    test_indented();
    CHECK(chdir("/") == 0 && rmdir(folder) == 0, "nothing is left behind");
    return tap_done();
}
