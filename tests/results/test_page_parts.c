// SPDX-License-Identifier: MIT
//
// Parts of a page word by word: tables, pictures, what was asked and judged.
#include "folder.h"

#include "results/page.h"

static char *text;
static size_t size;

static void is(FILE *page, const char *want, const char *what)
{
    fclose(page);
    CHECK(strcmp(text, want) == 0, "%s: %s", what, text);
    free(text);
}

// ---- Tables --------------------------------------------------------------------------------------------------------

#define BEGIN(title) "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" title "\">\n<table>\n"
#define END "</tbody>\n</table>\n</div>\n"

static void test_tables(void)
{
    const moray_table_row rows[] = {{"a & b", {1.5, NAN, -INFINITY}, "m", NULL}, {"c", {0}, NULL, "x < y"}};
    const moray_table full = {
        .title = "T \"1\"", .columns = {"one", NULL, "three"}, .n_columns = 3, .rows = rows, .n_rows = 2};
    FILE *page = open_memstream(&text, &size);
    moray_html_table(page, &full);
    is(page,
       BEGIN("T &quot;1&quot;") "<caption>T &quot;1&quot;</caption><thead><tr><td></td><th scope=\"col\">one</th>"
                                "<th scope=\"col\"></th><th scope=\"col\">three</th><td></td></tr></thead>\n<tbody>\n"
                                "<tr><th scope=\"row\">a &amp; b</th><td><data value=\"1.5\">1.5</data></td><td></td>"
                                "<td>-inf</td><td class=\"unit\">m</td></tr>\n"
                                "<tr><th scope=\"row\">c</th><td class=\"words\">x &lt; y</td><td></td><td></td>"
                                "<td class=\"unit\"></td></tr>\n" END,
       "a table with units and heads");
    const moray_table_row bare_rows[] = {{"a", {-2e12}, "", NULL}, {"b", {0.125}, NULL, NULL}};
    const moray_table bare = {.columns = {NULL, "beyond"}, .n_columns = 1, .rows = bare_rows, .n_rows = 2};
    page = open_memstream(&text, &size);
    moray_html_table(page, &bare);
    is(page,
       BEGIN(
           "table") "<tbody>\n<tr><th scope=\"row\">a</th><td><data value=\"-2000000000000\">-2e+12</data></td></tr>\n"
                    "<tr><th scope=\"row\">b</th><td><data value=\"0.125\">0.125</data></td></tr>\n" END,
       "one without");
    const moray_table headed = {.columns = {"v"}, .n_columns = 1, .rows = bare_rows, .n_rows = 1};
    page = open_memstream(&text, &size);
    moray_html_table(page, &headed);
    is(page,
       BEGIN("table") "<thead><tr><td></td><th scope=\"col\">v</th></tr></thead>\n<tbody>\n<tr><th scope=\"row\">a</th>"
                      "<td><data value=\"-2000000000000\">-2e+12</data></td></tr>\n" END,
       "one with heads alone");
}

// ---- Pictures ------------------------------------------------------------------------------------------------------

static void check_picture(const char *svg, const char *want, const char *what)
{
    FILE *picture = tmpfile(), *page = open_memstream(&text, &size);
    fputs(svg, picture);
    moray_html_figure(page, picture, 7);
    fclose(picture);
    is(page, want, what);
}

static void test_pictures(void)
{
    check_picture(
        "<?xml version=\"1.0\"?>\n<svg role=\"img\" aria-label=\"A 'b'\" width=\"3\">\n<g id=\"g1\" id='g2'>\n"
        "<use xlink:href='#g1' href=\"#g2\" fill=\"url(#g2)\" idle=\"x\"/>\n</svg>\n",
        "<figure class=\"picture\" aria-label=\"A 'b'\">\n<svg role=\"img\" aria-label=\"A 'b'\" width=\"3\">\n"
        "<g id=\"f7-g1\" id='f7-g2'>\n<use xlink:href='#f7-g1' href=\"#f7-g2\" fill=\"url(#f7-g2)\" "
        "idle=\"x\"/>\n</svg>\n</figure>\n",
        "ids of its own, and its name");
    check_picture("<svg width=\"3\">\n</svg>\n", "<figure class=\"picture\">\n<svg width=\"3\">\n</svg>\n</figure>\n",
                  "without a name");
    check_picture("<svg aria-label=\"open>\n</svg>",
                  "<figure class=\"picture\">\n<svg aria-label=\"open>\n</svg></figure>\n", "a name without an end");
    check_picture("nothing\n", "", "no picture");
}

static void test_paragraphs(void)
{
    FILE *page = open_memstream(&text, &size);
    moray_html_paragraphs(page, "one\n\ntwo & 3\n");
    moray_html_paragraphs(page, NULL);
    is(page, "<p>one</p>\n<p>two &amp; 3</p>\n", "paragraphs");
}

// What is added is cut behind a whole word where there is no room for all of it.
static void test_added(void)
{
    char line[25] = "one";
    moray_text_add(line, sizeof line, ", %s", "two");
    CHECK(strcmp(line, "one, two") == 0, "%s", line);
    moray_text_add(line, sizeof line, ", %d digits", 123);
    CHECK(strcmp(line, "one, two, 123 digits") == 0, "%s", line);
    moray_text_add(line, sizeof line, " %s", "now");
    CHECK(strcmp(line, "one, two, 123 digits now") == 0, "as much as there is room for: %s", line);
    moray_text_add(line, sizeof line, ".");
    char more[40];
    memset(more, '#', sizeof more);
    strcpy(more, "one two");
    moray_text_add(more, 16, " six and more");
    CHECK(strcmp(more, "one two six ...") == 0 && more[16] == '#' && more[20] == '#', "nothing behind its room: %s",
          more);
    CHECK(strcmp(line, "one, two, 123 digits ...") == 0, "%s", line);
}

// ---- Pages ---------------------------------------------------------------------------------------------------------

static char *page_of(const char *name, const moray_report *report, const char *const *files)
{
    moray_output *output = open_in(name);
    for (; *files; files++)
        fputs("<svg aria-label=\"x\">\n</svg>\n", start(output, *files));
    CHECK_OK(moray_output_report(output, report), "report");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char file[100];
    snprintf(file, sizeof file, "%s/report.html", name);
    return content(file);
}

static void has(const char *page, const char *part)
{
    CHECK(strstr(page, part), "%s", part);
}

static void lacks(const char *page, const char *part)
{
    CHECK(!strstr(page, part), "no %s", part);
}

static void test_asked(void)
{
    char *argv[] = {"./a b/tool", "--json", "x/y", "--out=here", "--quiet", "--out", "there", "--outer", "-9"};
    setenv("SOURCE_DATE_EPOCH", "86400", 1);
    char *page = page_of("asked",
                         &(moray_report){.title = "T",
                                         .asked = "Why?\nBecause.",
                                         .argc = 9,
                                         .argv = argv,
                                         .configuration = "[a]\nb = <c>\n",
                                         .judged = "So & so",
                                         .judgement = MORAY_JUDGED_FAIL},
                         (const char *const[]){"a.csv", "b.svg", "c&d.txt", NULL});
    has(page, "<p>Why?</p>\n<p>Because.</p>\n<pre>tool x/y --outer -9</pre>\n<dl class=\"facts\">\n"
              "<dt>date</dt><dd>1970-01-02 00:00 UTC</dd>\n<dt>version</dt><dd>moray ");
    has(page, "<dt>files</dt><dd><a href=\"a.csv\">a.csv</a>, <a href=\"c&amp;d.txt\">c&amp;d.txt</a></dd>\n");
    has(page, "<pre>[a]\nb = &lt;c&gt;\n</pre></details>");
    has(page, "<p class=\"judged fail\">So &amp; so</p>");
    has(page, "<h2 id=\"results\">Results</h2>\n<div class=\"pictures\">\n<figure class=\"picture\" aria-label=\"x\">");
    free(page);
    page = page_of("plain", &(moray_report){.title = "T", .judged = "neither"}, (const char *const[]){"a.csv", NULL});
    has(page, "<p class=\"judged\">neither</p>");
    lacks(page, "id=\"results\"");
    lacks(page, "<details>");
    lacks(page, "id=\"words\"");
    lacks(page, "class=\"pictures\"");
    free(page);
    page = page_of("passed", &(moray_report){.title = "T", .judged = "yes", .judgement = MORAY_JUDGED_PASS},
                   (const char *const[]){NULL});
    has(page, "<p class=\"judged pass\">yes</p>");
    has(page, "<dt>files</dt><dd></dd>");
    free(page);
    unsetenv("SOURCE_DATE_EPOCH");
}

// Figures that all belong to parts leave none to the results beside them; tables of parts stand there.
static void test_parts(void)
{
    const moray_section part = {.title = "P", .figures = "p"};
    const moray_table_row row = {"r", {1}, NULL, NULL};
    const moray_table table = {.n_columns = 1, .rows = &row, .n_rows = 1};
    char *page = page_of("parts", &(moray_report){.title = "T", .sections = &part, .n_sections = 1},
                         (const char *const[]){"p1.svg", "p2.svg", NULL});
    lacks(page, "id=\"results\"");
    has(page, "<section aria-labelledby=\"part1\">\n<h2 id=\"part1\">P</h2>\n<div class=\"pictures\">\n");
    free(page);
    page = page_of("tables",
                   &(moray_report){.title = "T", .sections = &part, .n_sections = 1, .tables = &table, .n_tables = 1},
                   (const char *const[]){"p1.svg", NULL});
    has(page, "<h2 id=\"results\">Results</h2>\n<div class=\"scroll\"");
    free(page);
}

int main(void)
{
    if (!enter())
        return 1;
    test_tables();
    test_pictures();
    test_paragraphs();
    test_added();
    test_asked();
    test_parts();
    leave();
    return tap_done();
}
