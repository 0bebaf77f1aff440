// SPDX-License-Identifier: MIT
#include "folder.h"
#include "drawn.h"

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

// Where time runs along the axis, and where that stands in the picture.
static void test_time(void)
{
    const double at[] = {0.5, 1, 3};
    const moray_curve curve = {.label = "c", .x = at, .y = at, .n = 3};
    const moray_figure drawn = {.name = "time", .title = "t", .over_time = true, .curves = &curve, .n_curves = 1};
    moray_output *output = open_in("time");
    CHECK_OK(moray_output_figure(output, &drawn), "drawn");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *svg = content("time/time.svg");
    CHECK(strstr(svg, "aria-label=\"t\" data-time=\"0.5 3 96 582 42 340\" "), "%.200s", svg);
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
    CHECK(has_stroke(svg, "  0,   0,   0") && has_stroke(svg, "176,  87, 138") && has_stroke(svg, "  0, 114, 178") &&
              !has_stroke(svg, "213,  94,   0"),
          "colours by meaning, not by place");
    CHECK(!strstr(svg, "(null)") && !strstr(svg, "curve1"), "no label, no line in the key");
    CHECK(strstr(other, "height [m]") && has_stroke(other, " 90, 107, 120"), "the field has its scale and its lines");
    free(svg);
    free(other);
}

// As much of an axis as is used: a curve ends at the frame, and no number stands beyond it. A long title has two lines.
static void test_layout(void)
{
    const double at[] = {0, 1, 2.64}, value[] = {0.234, 0.2395, 0.238};
    const moray_curve curve = {.label = "speed", .x = at, .y = value, .n = 3};
    const moray_figure drawn = {.name = "short", .title = "t", .curves = &curve, .n_curves = 1},
                       titled = {.name = "long",
                                 .title = "A title of more letters than have room side by side above a figure that a "
                                          "telephone shows, so in two lines",
                                 .curves = &curve,
                                 .n_curves = 1};
    moray_output *output = open_in("layout");
    CHECK_OK(moray_output_figure(output, &drawn), "drawn");
    CHECK_OK(moray_output_figure(output, &titled), "with a long title");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *svg = content("layout/short.svg"), *other = content("layout/long.svg");
    CHECK(strstr(svg, "> 2.5<") && !strstr(svg, "> 3<") && strstr(svg, "> 0.239<") && !strstr(svg, "> 0.24<"),
          "no axis goes on behind the curve");
    CHECK(strstr(svg, ">speed<"), "the key");
    CHECK(!strstr(other, "side by side above a figure that a telephone shows, so in two lines</text>") &&
              strstr(other, "so in two lines</text>"),
          "the title in two lines");
    free(svg);
    free(other);
}

// A path is drawn as large as the picture is wide, without empty space above and below it.
static void test_equal_axes(void)
{
    const double along[] = {0, 16}, across[] = {0, 0.5};
    const moray_curve curve[] = {{.label = "flat", .x = along, .y = across, .n = 2},
                                 {.label = "tall", .x = across, .y = along, .n = 2}};
    long height[2] = {0};
    for (int k = 0; k < 2; k++) {
        moray_output *output = open_in(curve[k].label);
        CHECK_OK(
            moray_output_figure(
                output,
                &(moray_figure){.name = "path", .title = "t", .equal_axes = true, .curves = &curve[k], .n_curves = 1}),
            "drawn");
        CHECK_OK(moray_output_commit(output), "commit");
        moray_output_free(output);
        char *svg = content(k ? "tall/path.svg" : "flat/path.svg");
        CHECK(sscanf(svg + strcspn(svg, "\n") + 1, "%*[^\n] width=\"%*d\" height=\"%ld\"", &height[k]) == 1,
              "a height");
        free(svg);
    }
    CHECK(height[0] > 200 && height[0] < 300 && height[1] > 500, "%ld and %ld high", height[0], height[1]);
}

static double linear(long channel)
{
    const double c = (double)channel / 255;
    return c <= 0.03928 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

// Every colour of a curve holds the contrast of 3 on white that graphics want (WCAG 2, 1.4.11).
static void test_contrast(void)
{
    const double at[] = {0, 1};
    moray_curve eight[8];
    for (int k = 0; k < 8; k++)
        eight[k] = (moray_curve){.label = "c", .x = at, .y = at, .n = 2};
    eight[7].colour = MORAY_COLOUR_WATER;
    const moray_figure drawn = {.name = "all", .title = "t", .curves = eight, .n_curves = 8};
    moray_output *output = open_in("contrast");
    CHECK_OK(moray_output_figure(output, &drawn), "drawn");
    CHECK_OK(moray_output_commit(output), "commit");
    moray_output_free(output);
    char *svg = content("contrast/all.svg");
    static const char stroke[] = "<path stroke='rgb(";
    int n = 0;
    for (char *c = svg; (c = strstr(c, stroke));) {
        long rgb[3];
        c += strlen(stroke);
        for (int i = 0; i < 3; i++, c++)
            rgb[i] = strtol(c, &c, 10);
        if (strncmp(c, "' class=\"gridline\"", 10) == 0)
            continue;
        n++;
        const double light = 0.2126 * linear(rgb[0]) + 0.7152 * linear(rgb[1]) + 0.0722 * linear(rgb[2]);
        CHECK(1.05 / (light + 0.05) >= 3, "contrast of rgb(%ld, %ld, %ld) on white: %.2f", rgb[0], rgb[1], rgb[2],
              1.05 / (light + 0.05));
    }
    CHECK(n >= 8, "every curve's colour seen: %d", n);
    free(svg);
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

int main(void)
{
    if (!enter())
        return 1;
    const int open = handles();
    test_figure();
    test_time();
    test_log_axes();
    test_colours_and_field();
    test_layout();
    test_equal_axes();
    test_contrast();
    test_failed_figure();
    test_bad_gnuplot();
    CHECK(handles() == open, "no file stays open");
    leave();
    return tap_done();
}
