// SPDX-License-Identifier: MIT
#include "tap.h"

#include <dirent.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "moray/app/results.h"

static char root[] = "/tmp/moray-output-XXXXXX";

// root/name, in memory that lives until the fourth next call.
static const char *in_root(const char *name)
{
    static char path[4][300];
    static int next;
    next = (next + 1) % 4;
    snprintf(path[next], sizeof path[next], "%s/%s", root, name);
    return path[next];
}

static void put(const char *name, const char *text)
{
    FILE *file = fopen(in_root(name), "w");
    fputs(text, file);
    fclose(file);
}

// The whole file, "" when there is none; free it.
static char *content(const char *name)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = fopen(in_root(name), "r");
    if (!file || getdelim(&text, &size, 0, file) < 0) {
        free(text);
        text = strdup("");
    }
    if (file)
        fclose(file);
    return text;
}

static bool holds(const char *name, const char *text)
{
    char *got = content(name);
    const bool same = strcmp(got, text) == 0;
    free(got);
    return same;
}

// Entries of a directory, hidden ones too; -1 when there is no such directory.
static int entries(const char *name)
{
    DIR *directory = opendir(in_root(name));
    int n = directory ? -2 : -1; // . and ..
    for (; directory && readdir(directory); n++)
        ;
    if (directory)
        closedir(directory);
    return n;
}

static moray_output *open_in(const char *name)
{
    moray_output *output = NULL;
    CHECK_OK(moray_output_open(&output, in_root(name)), "open");
    return output;
}

static FILE *start(moray_output *output, const char *name)
{
    FILE *file = NULL;
    CHECK_OK(moray_output_file(output, name, &file), name);
    return file;
}

static void test_commit(void)
{
    moray_output *output = open_in("a/b/c");
    CHECK(entries("") == 0, "opening leaves nothing behind");
    FILE *first = start(output, "first.txt"), *second = start(output, "second.txt");
    fprintf(first, "one %d", 1);
    fprintf(second, "two");
    fflush(NULL);
    CHECK(access(in_root("a/b/c/first.txt"), F_OK) != 0, "no file is in place before the commit");
    CHECK_OK(moray_output_commit(output), "commit");
    CHECK(holds("a/b/c/first.txt", "one 1") && holds("a/b/c/second.txt", "two"), "both files are in place");
    CHECK(entries("a/b/c") == 2, "and nothing else: %d", entries("a/b/c"));
    fprintf(start(output, "third.txt"), "three");
    CHECK_OK(moray_output_commit(output), "a second commit");
    moray_output_free(output);
    CHECK(holds("a/b/c/third.txt", "three") && entries("a/b/c") == 3, "adds to the first");
    output = open_in("a/b/c");
    fprintf(start(output, "first.txt"), "new");
    CHECK(holds("a/b/c/first.txt", "one 1"), "an earlier file stays until the commit");
    CHECK_OK(moray_output_commit(output), "commit over it");
    moray_output_free(output);
    struct stat about;
    CHECK(holds("a/b/c/first.txt", "new") && entries("a/b/c") == 3, "it is replaced");
    const mode_t mask = umask(0);
    umask(mask);
    CHECK(stat(in_root("a/b/c/first.txt"), &about) == 0 && (about.st_mode & 0777) == (0666 & ~mask),
          "with the usual permissions %o", about.st_mode & 0777);
}

static void test_abandoned(void)
{
    moray_output *output = open_in("new/deep");
    fprintf(start(output, "x"), "x");
    moray_output_free(output);
    CHECK(entries("new") == -1, "directories made for an abandoned output are removed");
    mkdir(in_root("old"), 0777);
    put("old/x", "kept");
    output = open_in("old/");
    fprintf(start(output, "x"), "lost");
    moray_output_free(output);
    CHECK(holds("old/x", "kept") && entries("old") == 1, "an earlier file survives an abandoned output");
    moray_output_free(NULL);
}

// What a killed run has left goes with the next one, what it had set aside goes back; a run under way keeps its own.
static void test_killed(void)
{
    mkdir(in_root("killed"), 0777);
    const pid_t child = fork();
    if (child == 0) {
        moray_output *output;
        FILE *file;
        if (!moray_failed(moray_output_open(&output, in_root("killed"))) &&
            !moray_failed(moray_output_file(output, "x", &file)))
            raise(SIGKILL);
        _exit(0);
    }
    int ended = 0;
    waitpid(child, &ended, 0);
    CHECK(WIFSIGNALED(ended) && entries("killed") == 1, "a killed run leaves its folder: %d", entries("killed"));
    moray_output *output = open_in("killed");
    CHECK(entries("killed") == 0, "which the next one removes: %d", entries("killed"));
    mkdir(in_root("killed/.moray-abcdef"), 0777);
    put("killed/.moray-abcdef/old.y", "kept");
    put("killed/.moray-abcdef/new.z", "lost");
    fprintf(start(output, "x"), "mine");
    moray_output *other = open_in("killed");
    CHECK(holds("killed/y", "kept") && entries("killed") == 2, "killed while it put files in place: %d",
          entries("killed"));
    moray_output_free(other);
    CHECK_OK(moray_output_commit(output), "a run under way keeps its own");
    CHECK(holds("killed/x", "mine") && entries("killed") == 2, "and ends as ever");
    moray_output_free(output);
}

// The second of three files cannot be put in place: the first goes back to what it was, the third never comes.
static void test_failed_commit(void)
{
    mkdir(in_root("half"), 0777);
    put("half/1", "kept");
    mkdir(in_root("half/2"), 0777);
    moray_output *output = open_in("half");
    for (const char *const *name = (const char *const[]){"0", "1", "2", "3", NULL}; *name; name++)
        fprintf(start(output, *name), "lost");
    const moray_status status = moray_output_commit(output);
    CHECK(status.code == MORAY_IO && strstr(status.text, "output file 2: is a directory"), "commit fails: %s",
          status.text);
    CHECK(holds("half/1", "kept") && entries("half") == 2, "all is as it was before");
    moray_output_free(output);
    CHECK(entries("half") == 2, "and stays so");
}

static void test_full_disk(void)
{
    struct rlimit limit, was;
    put("old/x", "kept");
    moray_output *output = open_in("old");
    FILE *x = start(output, "x"), *y = start(output, "y");
    getrlimit(RLIMIT_FSIZE, &was);
    limit = was;
    limit.rlim_cur = 8192;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    fprintf(x, "lost");
    for (int i = 0; i < 20000; i++)
        fputc('y', y);
    const moray_status status = moray_output_commit(output);
    setrlimit(RLIMIT_FSIZE, &was);
    CHECK(status.code == MORAY_IO && strstr(status.text, "output file y: cannot be written"), "%s", status.text);
    moray_output_free(output);
    CHECK(holds("old/x", "kept") && entries("old") == 1, "a full disk leaves the earlier files");
}

static void test_unwritable(void)
{
    put("file", "in the way");
    const char *const bad[] = {"/proc/moray/x", in_root("file"), in_root("file/x"), ""};
    for (unsigned i = 0; i < sizeof bad / sizeof *bad; i++) {
        moray_output *output = NULL;
        const moray_status status = moray_output_open(&output, bad[i]);
        CHECK(status.code == MORAY_IO && strstr(status.text, "output directory") && !output, "%s", status.text);
    }
    char lengthy[6000];
    memset(lengthy, 'x', sizeof lengthy - 1);
    lengthy[sizeof lengthy - 1] = 0;
    moray_output *output = NULL;
    CHECK(moray_output_open(&output, lengthy).code == MORAY_IO && !output, "a name too long");
    memcpy(lengthy, root, strlen(root));
    memcpy(lengthy + strlen(root), "/made/", 6);
    lengthy[1000] = 0;
    CHECK(moray_output_open(&output, lengthy).code == MORAY_IO && entries("made") == -1,
          "what was made on the way to a failure is removed");
    output = open_in("names");
    FILE *file;
    const char *const names[] = {"", "a/b", "..", ".hidden", lengthy};
    for (unsigned i = 0; i < sizeof names / sizeof *names; i++)
        CHECK(moray_output_file(output, names[i], &file).code == MORAY_INPUT, "file name %.20s is refused", names[i]);
    start(output, "twice");
    CHECK(moray_output_file(output, "twice", &file).code == MORAY_INPUT, "a name taken is refused");
    moray_output_free(output);
    unlink(in_root("file"));
}

static const double t[] = {0, 1, 2, 3}, x[] = {0, 1, NAN, 0.5}, y[] = {1, 2, 3, 4};
static const moray_curve curves[] = {
    {.label = "with 'quotes' '' \"and\" `ls`", .x = t, .y = x, .n = 4},
    {.label = "b_1^2", .x = t, .y = y, .n = 4, .style = MORAY_CURVE_MARKED},
    {.label = "c", .x = t, .y = y, .n = 2, .stride = 2, .style = MORAY_CURVE_POINTS},
};
static const moray_figure figure = {.name = "figure",
                                    .title = "T'\n!touch pwned\nsystem('touch pwned') <&>",
                                    .x_label = "time [s]",
                                    .y_label = "θ [deg]",
                                    .curves = curves,
                                    .n_curves = 3};

static void test_figure(void)
{
    moray_output *output = open_in("it's $(touch pwned) \"here\"");
    CHECK_OK(moray_output_figure(output, &figure), "figure");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *svg = content("it's $(touch pwned) \"here\"/figure.svg");
    CHECK(strstr(svg, "<svg") && strstr(svg, "</svg>"), "a whole SVG");
    CHECK(strstr(svg, "time [s]") && strstr(svg, "θ [deg]") && strstr(svg, "b_1^2"), "axes and legend as given");
    CHECK(strstr(svg, "with 'quotes' '' \"and\" `ls`"), "quotes are only quotes");
    CHECK(strstr(svg, "touch pwned") && access("pwned", F_OK) != 0 && entries("it's $(touch pwned) \"here\"") == 1,
          "a title is no command");
    CHECK(strstr(svg, "rgb(  0, 114, 178)") && strstr(svg, "rgb(213,  94,   0)") && strstr(svg, "stroke-dasharray"),
          "curves differ in colour and in dashes");
    free(svg);
}

static void test_log_axes(void)
{
    const double power[] = {0.03, 0.3, 4}, speed[] = {0.19, 0.5, 2.1};
    const moray_curve curve = {.label = "c", .x = power, .y = speed, .n = 3};
    const moray_figure drawn = {
        .name = "log", .title = "t", .log_x = true, .log_y = true, .curves = &curve, .n_curves = 1};
    moray_output *output = open_in("log");
    CHECK_OK(moray_output_figure(output, &drawn), "drawn");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *svg = content("log/log.svg");
    CHECK(strstr(svg, "> 0.05<") && strstr(svg, "> 0.2<") && strstr(svg, "> 0.5<"), "numbers at 1, 2 and 5");
    CHECK(!strstr(svg, "> 0.01<") && !strstr(svg, "> 10<"), "no more decades than are used");
    free(svg);
}

static bool has_stroke(const char *svg, const char *rgb)
{
    char stroke[40];
    snprintf(stroke, sizeof stroke, "rgb(%s)", rgb);
    return strstr(svg, stroke);
}

// One thing has one colour, whatever its place; a curve without a label is not in the key; a field has its lines of
// equal height and no cell where it is not a number.
static void test_colours_and_field(void)
{
    const double at[] = {0, 1, 2}, z[] = {0, 1, 2, 1, NAN, 3, 2, 3, 4};
    const moray_curve some[] = {{.label = "limit", .x = at, .y = at, .n = 3, .colour = MORAY_COLOUR_LIMIT},
                                {.x = at, .y = at + 1, .n = 2, .colour = MORAY_COLOUR_THIRD},
                                {.label = "best", .x = at, .y = at, .n = 2, .colour = MORAY_COLOUR_BEST}};
    const moray_field field = {.label = "height [m]", .x = at, .y = at, .z = z, .n_x = 3, .n_y = 3};
    const moray_figure drawn = {.name = "colours", .title = "t", .curves = some, .n_curves = 3},
                       map = {.name = "map", .title = "m", .curves = some, .n_curves = 3, .field = &field};
    moray_output *output = open_in("colours");
    CHECK_OK(moray_output_figure(output, &drawn), "drawn");
    CHECK_OK(moray_output_figure(output, &map), "a field under it");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *svg = content("colours/colours.svg"), *other = content("colours/map.svg");
    CHECK(has_stroke(svg, "  0,   0,   0") && has_stroke(svg, "204, 121, 167") && has_stroke(svg, "  0, 114, 178") &&
              !has_stroke(svg, "213,  94,   0"),
          "colours by meaning, not by place");
    CHECK(!strstr(svg, "(null)") && !strstr(svg, "curve1"), "no label, no line in the key");
    CHECK(strstr(other, "height [m]") && has_stroke(other, " 90, 107, 120"), "the field has its scale and its lines");
    free(svg);
    free(other);
}

static void test_failed_figure(void)
{
    moray_output *output = open_in("without");
    const char *path = getenv("PATH");
    char *kept = strdup(path ? path : "");
    fprintf(start(output, "first"), "1");
    setenv("PATH", root, 1);
    moray_status status = moray_output_figure(output, &figure);
    setenv("PATH", kept, 1);
    free(kept);
    CHECK(status.code == MORAY_IO && strstr(status.text, "gnuplot"), "without gnuplot: %s", status.text);
    const double nothing[] = {NAN};
    const moray_curve none = {.label = "none", .x = nothing, .y = nothing, .n = 1};
    const moray_figure empty = {.name = "empty", .title = "e", .curves = &none, .n_curves = 1};
    status = moray_output_figure(output, &empty);
    CHECK(status.code == MORAY_IO && strstr(status.text, "figure empty not drawn"), "gnuplot fails: %s", status.text);
    fprintf(start(output, "last"), "2");
    CHECK_OK(moray_output_commit(output), "the rest can be committed");
    moray_output_free(output);
    CHECK(holds("without/first", "1") && holds("without/last", "2") && entries("without") == 2, "and appears alone");
}

// A gnuplot that never ends, and one that writes half a picture: both are told, the first only once waited for.
static void test_bad_gnuplot(void)
{
    moray_output *output = open_in("bad");
    char *kept = strdup(getenv("PATH") ? getenv("PATH") : "");
    CHECK(mkdir(in_root("bin"), 0777) == 0, "a place for programs");
    put("bin/gnuplot", "#!/bin/sh\nprintf '<svg '\n");
    chmod(in_root("bin/gnuplot"), 0755);
    setenv("PATH", in_root("bin"), 1);
    moray_status status = moray_output_figure(output, &figure);
    CHECK(status.code == MORAY_IO && strstr(status.text, "not whole"), "half a picture: %s", status.text);
    if (tap_thorough()) { // twenty seconds of waiting, in which nothing is computed
        put("bin/gnuplot", "#!/bin/sh\nexec /bin/sleep 1000\n");
        for (int i = 0; i < 2; i++) {
            status = moray_output_figure(output, &figure);
            CHECK(status.code == MORAY_IO && strstr(status.text, i ? "hung before" : "was stopped"), "%s", status.text);
        }
    }
    setenv("PATH", kept, 1);
    free(kept);
    moray_output_free(output);
    CHECK(entries("bad") == -1, "nothing is left of them");
}

static void test_report(void)
{
    const moray_table_row rows[] = {{"speed <ground>", {0.2293}, "m/s", NULL}, {"scheme", {0}, NULL, "radau3"}};
    const moray_table table = {
        .title = "Gait & co", .columns = {"validated"}, .n_columns = 1, .rows = rows, .n_rows = 2};
    char *argv[] = {"/tmp/x/max_speed", "--out", "/tmp/here", "--set", "c_n=it's <9>", ""};
    moray_output *output = open_in("report");
    CHECK_OK(moray_output_figure(output, &figure), "figure");
    CHECK_OK(moray_output_report(output, &(moray_report){.title = "Max <speed>",
                                                         .text = "Text & more.",
                                                         .tables = &table,
                                                         .n_tables = 1,
                                                         .argc = 6,
                                                         .argv = argv}),
             "report");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *page = content("report/report.html"), *svg = content("report/figure.svg");
    CHECK(strncmp(page, "<!DOCTYPE html>", 15) == 0 && strstr(page, "</html>"), "a whole page");
    CHECK(strstr(page, "<h1>Max &lt;speed&gt;</h1>") && strstr(page, "<p>Text &amp; more.</p>"), "title and text");
    CHECK(strstr(page, "<caption>Gait &amp; co</caption>") &&
              strstr(page, "<tr><th scope=\"row\">speed &lt;ground&gt;</th><td><data "
                           "value=\"0.2293\">0.2293</data></td><td class=\"unit\">m/s</td></tr>") &&
              strstr(page, "<td class=\"words\">radau3</td>"),
          "the table");
    CHECK(strstr(page, "role=\"img\" aria-label=\"T'") && strstr(page, "</svg>") && !strstr(page, "<?xml") &&
              !strstr(page, "Gnuplot"),
          "the whole figure inline, with its own title");
    CHECK(!strstr(page, " id=\"gp") && !strstr(page, " id='gp") && strstr(page, "f0-gp"), "and ids of its own");
    CHECK(!strstr(page, "src=") && !strstr(page, "stylesheet") && !strstr(page, "@import"), "nothing from elsewhere");
    CHECK(strstr(page, "<pre>max_speed --set 'c_n=it'\\''s &lt;9&gt;' ''</pre>"),
          "the command line, as a shell reads it, without the places of the files");
    free(page);
    free(svg);
}

// Three figures, of which two begin with the names of sections; headings, paragraphs and figures in their order.
static void test_report_sections(void)
{
    static const char *const names[] = {"wave", "other", "wind_speed"};
    const moray_table_row row = {"force", {1}, "N", NULL};
    const moray_table table = {.title = "Forces", .n_columns = 1, .rows = &row, .n_rows = 1};
    const moray_section sections[] = {
        {.title = "Wind & weather", .text = "One.\nTwo < three.", .figures = "wind", .tables = &table, .n_tables = 1},
        {.title = "Waves", .figures = "wave"}};
    moray_output *output = open_in("sections");
    for (int i = 0; i < 3; i++) {
        moray_figure named = figure;
        named.name = named.title = names[i];
        CHECK_OK(moray_output_figure(output, &named), "figure");
    }
    CHECK_OK(
        moray_output_report(output, &(moray_report){.title = "Sea", .sections = sections, .n_sections = 2, .argc = 0}),
        "report");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *page = content("sections/report.html"), *at = page;
    static const char *const order[] = {"<h1>Sea</h1>",
                                        ">other<",
                                        ">Wind &amp; weather</h2>",
                                        "<p>One.</p>\n<p>Two &lt; three.</p>",
                                        "<caption>Forces</caption>",
                                        ">wind_speed<",
                                        ">Waves</h2>",
                                        ">wave<",
                                        "What was asked</h2>"};
    for (unsigned i = 0; i < sizeof order / sizeof *order; i++) {
        char *found = at ? strstr(at, order[i]) : NULL;
        CHECK(found, "part %u of the page stands after the one before", i);
        at = found;
    }
    free(page);
}

// Of many parts the page has a list with the way to each; of few it has none.
static void test_contents(void)
{
    const moray_section sections[] = {{.title = "A"}, {.title = "B"}, {.title = "C"}, {.title = "D < E"}};
    for (int n = 3; n <= 4; n++) {
        moray_output *output = open_in(n == 3 ? "few" : "many");
        CHECK_OK(moray_output_report(output, &(moray_report){.title = "T", .sections = sections, .n_sections = n}),
                 "report");
        CHECK_OK(moray_output_commit(output), "commit");
        moray_output_free(output);
    }
    char *few = content("few/report.html"), *many = content("many/report.html");
    CHECK(!strstr(few, "<nav"), "three parts need no list");
    CHECK(strstr(many, "<a href=\"#part4\">D &lt; E</a>") && strstr(many, "id=\"part4\""), "four have one");
    free(few);
    free(many);
}

int main(void)
{
    char remove[64];
    if (!mkdtemp(root) || chdir(root))
        return 1;
    test_commit();
    test_abandoned();
    test_killed();
    test_failed_commit();
    test_full_disk();
    test_unwritable();
    test_figure();
    test_log_axes();
    test_colours_and_field();
    test_failed_figure();
    test_bad_gnuplot();
    test_report();
    test_report_sections();
    test_contents();
    snprintf(remove, sizeof remove, "rm -r %s", root);
    CHECK(system(remove) == 0, "clean up");
    return tap_done();
}
