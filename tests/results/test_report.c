// SPDX-License-Identifier: MIT
#include "folder.h"
#include "drawn.h"

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

// The first paragraph, then the robots, then the rest; names are told what they stand for.
static void test_report_order(void)
{
    const double t2[] = {0, 1}, at[] = {0, 0, 0, 1, 0, 0};
    const moray_scene_body body = {.name = "robot", .links = 1, .length = 1, .width = 0.1, .at = at};
    const moray_scene scene = {.title = "Swimming", .frames = 2, .t = t2, .bodies = &body, .n_bodies = 1};
    const moray_meaning words[] = {{"LOS", "line of sight <ahead>"}, {NULL, NULL}};
    moray_output *output = open_in("order");
    CHECK_OK(moray_output_figure(output, &figure), "figure");
    CHECK_OK(
        moray_output_report(
            output, &(moray_report){.title = "T", .text = "First.\nSecond.\nThird.", .scene = &scene, .words = words}),
        "report");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *page = content("order/report.html"), *at_page = page;
    static const char *const order[] = {"<p>First.</p>",
                                        "id=\"stage\"",
                                        "<p>Second.</p>\n<p>Third.</p>",
                                        "<div class=\"pictures\">",
                                        "<figure class=\"picture\"",
                                        "<dt>LOS</dt><dd>line of sight &lt;ahead&gt;</dd>",
                                        "What was asked</h2>"};
    for (unsigned i = 0; i < sizeof order / sizeof *order; i++) {
        char *found = at_page ? strstr(at_page, order[i]) : NULL;
        CHECK(found, "%s stands after what is before it", order[i]);
        at_page = found;
    }
    CHECK(page == strstr(page, "<!DOCTYPE") && strstr(page, "<p>First.</p>\n</div>"), "the first paragraph is alone");
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

// What the animation reads: numbers to four digits, nothing for what rounds to nothing or is no number, next to others
// that are some.
static void test_scene(void)
{
    const double at[] = {0, 0.5, -1e-5, 1, 0, -1.25, NAN, 0.25, 0, -1, 1e-5, INFINITY}, times[] = {0, 0.1};
    const moray_scene_body body = {
        .name = "robot", .colour = MORAY_COLOUR_BEST, .links = 2, .length = 0.14, .width = 0.07, .at = at};
    const moray_scene scene = {
        .title = "Swimming", .frames = 2, .t = times, .bodies = &body, .n_bodies = 1, .current = {0, -0.1}};
    moray_output *output = open_in("scene");
    CHECK_OK(moray_output_report(output, &(moray_report){.title = "Seen", .scene = &scene}), "report");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *page = content("scene/report.html");
    CHECK(strstr(page, "\"at\":[[0,0.5000,0,1.0000,0,-1.2500],\n[0,0.2500,0,-1.0000,0,0]]"), "every link's place");
    CHECK(strstr(page, "\"current\":[0,-0.1000]") && strstr(page, "\"t\":[0,0.1000]"), "current and times");
    free(page);
}

// All that a scene may have, of two bodies.
static void test_whole_scene(void)
{
    const double at[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, times[] = {0, 0.1}, lengths[] = {0.1, 0.2},
                 effort[] = {0.5, -0.5}, force[] = {1, 2, 3, 4, 5, 6, 7, 8}, speed[] = {0.25, 0.75}, power[] = {8, 9},
                 asked[] = {0, 1, 2}, beside[] = {0, -1, -2};
    const moray_scene_body bodies[] = {{.name = "one", .links = 2, .length = 0.3, .width = 0.1, .at = at},
                                       {.name = "<two>",
                                        .colour = MORAY_COLOUR_BEST,
                                        .links = 2,
                                        .length = 0.4,
                                        .width = 0.2,
                                        .lengths = lengths,
                                        .at = at,
                                        .effort = effort,
                                        .force = force}};
    const moray_channel channels[] = {{"speed", "m/s", speed}, {"power", "W", power}};
    const moray_scene scene = {.title = "All",
                               .frames = 2,
                               .t = times,
                               .bodies = bodies,
                               .n_bodies = 2,
                               .effort = "Torque",
                               .asked_x = asked,
                               .asked_y = beside,
                               .n_asked = 3,
                               .channels = channels,
                               .n_channels = 2};
    moray_output *output = open_in("whole");
    CHECK_OK(moray_output_report(output, &(moray_report){.title = "Seen", .scene = &scene}), "report");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *page = content("whole/report.html");
    CHECK(strstr(page, "\"asked\":[[0,0],[1.000,-1.000],[2.000,-2.000]]"), "the path that is asked for");
    CHECK(strstr(page, "\"channels\":[{\"name\":\"speed\",\"unit\":\"m/s\",\"values\":[0.2500,0.7500]},"
                       "{\"name\":\"power\",\"unit\":\"W\",\"values\":[8.0000,9.0000]}]"),
          "each number over time has its name and unit");
    CHECK(strstr(page, "{\"name\":\"one\",\"colour\":0,\"length\":0.3000,\"width\":0.1000,\"at\":[[1.0000,"),
          "a body of equal links without forces");
    CHECK(strstr(page, "12.0000]]}\n,{\"name\":\"\\u003ctwo>\""), "which ends with its last place");
    CHECK(strstr(page, "\"colour\":0,\"length\":0.4000"), "another has the first of the colours that say something");
    CHECK(strstr(page, "\"width\":0.2000,\"lengths\":[0.1000,0.2000],\"at\":"), "another has lengths");
    CHECK(strstr(page, "\"effort\":[[0.5000],\n[-0.5000]],\"force\":[[1.0000,2.0000,3.0000,4.0000],\n[5.0000,6.0000,"
                       "7.0000,8.0000]]}"),
          "efforts and forces, frame by frame");
    CHECK(strstr(page, "Torque in the joints") && strstr(page, "drag of the water") &&
              strstr(page, "what is asked for"),
          "and a key to them");
    free(page);
    page = content("scene/report.html");
    CHECK(!strstr(page, "in the joints:") && !strstr(page, "drag of the water") && !strstr(page, "what is asked for"),
          "which a scene without them has not");
    free(page);
}

int main(void)
{
    if (!enter())
        return 1;
    test_report();
    test_report_sections();
    test_report_order();
    test_contents();
    test_scene();
    test_whole_scene();
    leave();
    return tap_done();
}
