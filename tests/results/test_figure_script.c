// SPDX-License-Identifier: MIT
//
// What gnuplot is told of axes, curves and fields, number by number.
#include "tap.h"

#include <stdio.h>
#include <string.h>

#include "results/figure.h"

typedef void writer(FILE *script, const moray_figure *figure);

static char *script_of(writer *write, const moray_figure *figure)
{
    char *text = NULL;
    size_t size;
    FILE *script = open_memstream(&text, &size);
    if (script) {
        write(script, figure);
        fclose(script);
    }
    return text;
}

// Whether these numbers, and no more of them, follow these words in their line.
static bool tells(const char *script, const char *words, int n, const double *numbers)
{
    const char *at = strstr(script, words);
    if (!at)
        return false;
    at += strlen(words);
    for (int k = 0; k < n; k++) {
        char *end;
        at += strspn(at, " [:,(");
        if (!(fabs(strtod(at, &end) - numbers[k]) < 1e-6) || end == at)
            return false;
        at = end;
    }
    at += strspn(at, " ])");
    return *at == '\n' || *at == 'L';
}

#define CHECK_TELLS(script, words, ...)                                                                                \
    CHECK(tells((script), (words), (int)(sizeof((double[]){__VA_ARGS__}) / sizeof(double)), (double[]){__VA_ARGS__}),  \
          "%s %s in %s", words, #__VA_ARGS__, script)

static void test_log_axes(void)
{
    const double x[] = {4, 0.03, NAN, 0.3}, y[] = {2, 2000, 30, 20};
    const moray_curve curve = {.x = x, .y = y, .n = 4};
    moray_figure figure = {.log_x = true, .log_y = true, .curves = &curve, .n_curves = 1};
    char *script = script_of(moray_figure_axes, &figure);
    CHECK_TELLS(script, "set xrange", 0.03 / 1.1, 4 * 1.1);
    CHECK_TELLS(script, "set xtics", 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5);
    CHECK_TELLS(script, "set yrange", 2 / 1.1, 2000 * 1.1);
    CHECK_TELLS(script, "set ytics", 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000);
    CHECK(strstr(script, "set logscale x\n") && strstr(script, "set logscale y\n"), "both are logarithmic");
    free(script);
    const double beyond[] = {2, 2000.1}, none[] = {0, 1};
    const moray_curve far = {.x = beyond, .y = none, .n = 2};
    figure.curves = &far;
    script = script_of(moray_figure_axes, &figure);
    CHECK_TELLS(script, "set xrange", 2 / 1.1, 2000.1 * 1.1);
    CHECK(!strstr(script, "set xtics"), "over more than three decades gnuplot chooses the numbers");
    CHECK(strstr(script, "set logscale y\n") && !strstr(script, "set yrange"), "no range from 0 on");
    free(script);
}

static void test_equal_axes(void)
{
    static const struct {
        double x[2], y[2], x_range[2], y_range[2], height;
    } cases[] = {
        // 0.53 of the length to either side of the middle, and a quarter of it across; the frame is 486 wide.
        {{0, 16}, {0, 0.5}, {8 - 8.48, 8 + 8.48}, {0.25 - 2, 0.25 + 2}, 150},
        {{0, 0.5}, {0, 16}, {0.25 - 2, 0.25 + 2}, {8 - 8.48, 8 + 8.48}, 420},
        {{-1, 1}, {2, 3}, {-1.06, 1.06}, {2.5 - 0.53, 2.5 + 0.53}, 243},
        {{-1, 1}, {3, 3}, {-1.06, 1.06}, {3 - 0.25, 3 + 0.25}, 150},
    };
    for (int k = 0; k < 4; k++) {
        const moray_curve curve = {.label = "c", .x = cases[k].x, .y = cases[k].y, .n = 2};
        const moray_figure figure = {.title = "t", .equal_axes = true, .curves = &curve, .n_curves = 1};
        char *script = script_of(moray_figure_axes, &figure);
        CHECK_TELLS(script, "set xrange", cases[k].x_range[0], cases[k].x_range[1]);
        CHECK_TELLS(script, "set yrange", cases[k].y_range[0], cases[k].y_range[1]);
        free(script);
        const moray_figure_layout at = moray_figure_lay_out(&figure);
        CHECK(at.height - at.top - at.bottom == cases[k].height, "the frame is %g high",
              at.height - at.top - at.bottom);
    }
    const double point[] = {1, 1};
    const moray_curve curve = {.x = point, .y = point, .n = 2};
    const moray_figure figure = {.equal_axes = true, .curves = &curve, .n_curves = 1};
    char *script = script_of(moray_figure_axes, &figure);
    CHECK(!strstr(script, "set xrange"), "a point has no range");
    free(script);
}

// A line of 20 for each line of the title and for each curve in the key; the rest is as wide always.
static void test_layout(void)
{
    const double at[] = {0.5, 1, 3};
    const moray_curve curves[] = {{.label = "one", .x = at, .y = at, .n = 3},
                                  {.x = at, .y = at, .n = 3},
                                  {.label = "two", .x = at, .y = at, .n = 2, .style = MORAY_CURVE_POINTS}};
    moray_figure figure = {.title = "t", .over_time = true, .curves = curves, .n_curves = 2};
    moray_figure_layout one = moray_figure_lay_out(&figure);
    CHECK(one.width == 600 && one.top == 22 + 20 && one.bottom == 70 + 20 && one.height == 42 + 90 + 298,
          "%d by %d, %g and %g beside the frame", one.width, one.height, one.top, one.bottom);
    char *script = script_of(moray_figure_axes, &figure);
    CHECK_TELLS(script, "set tmargin at screen", 1 - 42 / 430.0);
    CHECK_TELLS(script, "set bmargin at screen", 90 / 430.0);
    CHECK_TELLS(script, "set key left top at screen", 40 / 600.0, 28 / 430.0);
    CHECK_TELLS(script, "set xrange", 0.5, 3);
    CHECK_TELLS(script, "set lmargin at screen", 96 / 600.0);
    CHECK_TELLS(script, "set rmargin at screen", 1 - 18 / 600.0);
    CHECK(strstr(script, "set offsets graph 0, graph 0, "), "lines reach to the sides");
    free(script);
    figure.n_curves = 3;
    figure.title = NULL;
    one = moray_figure_lay_out(&figure);
    CHECK(one.top == 22 && one.bottom == 70 + 40, "no title, two curves in the key: %g, %g", one.top, one.bottom);
    script = script_of(moray_figure_axes, &figure);
    CHECK(strstr(script, "set offsets graph 0.03, graph 0.03, "), "points do not");
    free(script);
    double range[2];
    CHECK(moray_figure_time(&figure, range) && range[0] == 0.5 && range[1] == 3, "from %g to %g", range[0], range[1]);
    figure.log_x = true;
    CHECK(!moray_figure_time(&figure, range), "no time on a logarithmic axis");
    figure.log_x = false, figure.over_time = false;
    CHECK(!moray_figure_time(&figure, range), "nor where x is no time");
    const moray_curve still = {.x = (double[]){2, 2}, .y = at, .n = 2};
    figure.over_time = true, figure.curves = &still, figure.n_curves = 1;
    CHECK(!moray_figure_time(&figure, range), "nor where none goes by");
    for (int k = 0; k < 2; k++) {
        const moray_curve endless = {.x = (double[]){k ? 0 : -INFINITY, k ? INFINITY : 0}, .y = at, .n = 2};
        figure.curves = &endless;
        CHECK(!moray_figure_time(&figure, range), "nor without an end");
    }
    figure.n_curves = 0;
    CHECK(!moray_figure_time(&figure, range), "nor where nothing is drawn");
}

// At most 76 letters in a line, which ends at the last blank that they hold.
static void test_title(void)
{
    enum { most = 76 };
    for (int length = most - 5; length <= most; length++) {
        char title[200] = "", first[200];
        memset(title, 'a', (size_t)length);
        strcpy(title + length, " bb cc");
        snprintf(first, sizeof first, "'%.*s'", length + (length + 3 <= most ? 3 : 0), title);
        const moray_figure figure = {.title = title};
        char *script = script_of(moray_figure_axes, &figure);
        CHECK(strstr(script, first) != NULL, "%d letters and a rest: the first line is %s", length, first);
        CHECK(strstr(script, length + 3 <= most ? "'cc'" : "'bb cc'") != NULL, "the rest in the second");
        CHECK(moray_figure_lay_out(&figure).top == 22 + 2 * 20, "two lines");
        free(script);
    }
    const moray_figure figure = {.title =
                                     "exactly seventy-six letters stand in this one title, which is a line as it is"};
    CHECK(strlen(figure.title) == most + 1 && moray_figure_lay_out(&figure).top == 22 + 2 * 20, "one more: two lines");
    const moray_figure other = {.title = figure.title + 1};
    CHECK(moray_figure_lay_out(&other).top == 22 + 20, "as many: one");
}

static void test_names(void)
{
    const char *const names[] = {"up", "middle", "down"};
    const moray_figure figure = {.y_names = names, .n_y_names = 3};
    char *script = script_of(moray_figure_axes, &figure);
    CHECK(strstr(script, "set ytics ('up' 0, 'middle' 1, 'down' 2)\nset yrange [2.5:-0.5]\n"), "names from the top");
    free(script);
}

static void test_data(void)
{
    const double at[] = {1, 2, NAN, 4, 5, 6}, z[] = {1, 2, NAN, 4, 5, 6}, x[] = {0, 1, 3}, y[] = {10, 14};
    const moray_field field = {.label = "h", .x = x, .y = y, .z = z, .n_x = 3, .n_y = 2};
    const moray_curve curves[] = {{.x = at, .y = at, .n = 4}, {.x = at, .y = at + 1, .n = 3, .stride = 2}};
    const moray_figure figure = {.curves = curves, .n_curves = 2, .field = &field};
    char *script = script_of(moray_figure_data, &figure);
    CHECK(strstr(script, "$curve0 << EOD\n1 1\n2 2\n\n4 4\nEOD\n"), "a gap where there is no number");
    CHECK(strstr(script, "$curve1 << EOD\n1 2\n\n5 6\nEOD\n"), "every second one");
    CHECK(strstr(script, "$field << EOD\n0 10 1\n1 10 2\n3 10 NaN\n\n0 14 4\n1 14 5\n3 14 6\n\nEOD\n"), "row by row");
    CHECK_TELLS(script, "set xrange", -0.75, 3.75);
    CHECK_TELLS(script, "set yrange", 8, 16);
    free(script);
}

static void test_curves(void)
{
    const double at[40] = {0};
    const struct {
        moray_curve curve;
        const char *words;
    } cases[] = {
        {{.n = 15, .style = MORAY_CURVE_MARKED}, "with linespoints lw 2 ps 0.7 dt solid pt 7 pi -1 lc rgb '#0072B2' "},
        {{.n = 30, .style = MORAY_CURVE_MARKED, .colour = MORAY_COLOUR_SECOND},
         "with linespoints lw 2 ps 0.7 dt (3,5) pt 9 pi -2 lc rgb '#009E73' "},
        {{.n = 2, .colour = MORAY_COLOUR_LIMIT}, "with lines lw 1.2 dt (14,5,3,5) lc rgb '#000000' "},
        {{.n = 2, .colour = MORAY_COLOUR_WATER}, "with lines lw 2 dt solid lc rgb '#5A6B78' "},
        {{.n = 2, .colour = MORAY_COLOUR_BASELINE, .dotted = true}, "with lines lw 2 dt (2,4) lc rgb '#D55E00' "},
        {{.n = 2, .style = MORAY_CURVE_POINTS, .colour = MORAY_COLOUR_THIRD}, "with points ps 0.8 lw 1.5 pt 4 lc rgb "},
        {{.n = 2, .style = MORAY_CURVE_BODY, .colour = MORAY_COLOUR_BEST}, "with lines lw 6 lc rgb '#0072B2' "},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        moray_curve curve = cases[k].curve;
        curve.x = curve.y = at;
        curve.label = k % 2 ? "it's" : NULL;
        const moray_figure figure = {.curves = &curve, .n_curves = 1};
        char *script = script_of(moray_figure_plot, &figure), want[200];
        snprintf(want, sizeof want, "plot $curve0 using 1:2 %s", cases[k].words);
        CHECK(strncmp(script, want, strlen(want)) == 0, "%s: %s", cases[k].words, script);
        CHECK(strstr(script, k % 2 ? "title 'it'.\"'\".'s'\n" : "notitle\n"), "with its name, or none");
        free(script);
    }
    moray_curve many[9];
    for (int k = 0; k < 9; k++)
        many[k] = (moray_curve){.x = at, .y = at, .n = 2};
    const moray_figure figure = {.curves = many, .n_curves = 9};
    char *script = script_of(moray_figure_plot, &figure);
    CHECK(strstr(script, "notitle, $curve7 using 1:2 with lines lw 2 dt solid lc rgb '#0072B2' notitle, $curve8 using "
                         "1:2 with lines lw 2 dt (14,6) lc rgb '#D55E00' notitle\n"),
          "by number, of which there are seven, then from the first on");
    free(script);
}

int main(void)
{
    test_log_axes();
    test_equal_axes();
    test_layout();
    test_title();
    test_names();
    test_data();
    test_curves();
    return tap_done();
}
