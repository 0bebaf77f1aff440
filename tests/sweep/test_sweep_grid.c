// SPDX-License-Identifier: MIT
//
// The grid of a sweep: points and places by enumeration, parents by what they are told to be, draws by brute force.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "sweep/sweep.h"

static moray_status never(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point, (void)summary, (void)self;
    return moray_ok();
}

// ---- Axes ----------------------------------------------------------------------------------------------------------

static const double five[] = {1, 2, 4, 8, 16}, four[] = {3, 2, 1, 0};
static const char *const words[] = {"one", "other", "third"};

// Five numbers, three words, four numbers: places count up like the digits of a clock, the last axis fastest.
static void test_places(const struct grid *grid)
{
    long point = 0;
    CHECK(grid->axes == 3 && grid->first == 0 && grid->points == 60, "%ld points", grid->points);
    bool in_order = true, neighbours = true;
    for (long i = 0; i < 5; i++)
        for (long j = 0; j < 3; j++)
            for (long k = 0; k < 4; k++, point++) {
                long at[GRID_AXES];
                moray_grid_place(grid, point, at);
                in_order = in_order && at[0] == i && at[1] == j && at[2] == k &&
                           moray_grid_coordinate(grid, point, 0) == five[i] &&
                           moray_grid_coordinate(grid, point, 2) == four[k];
                neighbours = neighbours && moray_grid_step(grid, point, 0, 1) == (i < 4 ? point + 12 : -1) &&
                             moray_grid_step(grid, point, 0, -2) == (i > 1 ? point - 24 : -1) &&
                             moray_grid_step(grid, point, 1, -1) == (j > 0 ? point - 4 : -1) &&
                             moray_grid_step(grid, point, 2, 2) == (k < 2 ? point + 2 : -1);
            }
    CHECK(in_order, "places and coordinates in their order");
    CHECK(neighbours, "and the neighbours beside them");
    CHECK(moray_grid_numeric(grid, 0) && !moray_grid_numeric(grid, 1) && moray_grid_numeric(grid, 2), "two of numbers");
}

// One step nearer to the middle along the axis of numbers on which it is furthest from it, in shares of the axis, the
// first of equals; words have no middle.
static void test_parents(const struct grid *grid)
{
    bool as_told = true;
    int without = 0;
    for (long point = 0; point < grid->points; point++) {
        const long i = point / 12, k = point % 4, parent = moray_grid_parent(grid, point);
        const double away[] = {fabs((double)i - 2) / 5, fabs((double)k - 1) / 4};
        const long expected = away[0] == 0 && away[1] == 0 ? -1
                              : away[0] >= away[1]         ? point + (i < 2 ? 12 : -12)
                                                           : point + (k < 1 ? 1 : -1);
        as_told = as_told && parent == expected;
        without += parent < 0;
    }
    CHECK(as_told, "parents are a step nearer to the middle");
    CHECK(without == 3, "%d have none: the middle of each word", without);
}

static void test_settings(const struct grid *grid)
{
    moray_key_value setting[3];
    double value[3];
    char text[3][32];
    moray_grid_settings(grid, 3 * 12 + 1 * 4 + 2, setting, value, text);
    CHECK(strcmp(setting[0].key, "first") == 0 && strcmp(setting[0].value, "8") == 0 && value[0] == 8, "first = %s",
          setting[0].value);
    CHECK(strcmp(setting[1].key, "second") == 0 && strcmp(setting[1].value, "other") == 0 && isnan(value[1]),
          "second = %s", setting[1].value);
    CHECK(strcmp(setting[2].key, "last") == 0 && strcmp(setting[2].value, "1") == 0 && value[2] == 1, "last = %s",
          setting[2].value);
}

// ---- Draws ---------------------------------------------------------------------------------------------------------

static double away(const moray_sweep_spec *spec, long draw, long other)
{
    const double x = (moray_grid_draw(spec, draw, 0) - moray_grid_draw(spec, other, 0)) / 4,
                 y = (moray_grid_draw(spec, draw, 1) - moray_grid_draw(spec, other, 1)) / 100;
    return x * x + y * y;
}

// Of draws in the middle of the axes the parent is the nearest in the first half of those before, of 256 at most;
// of other points it is a step towards the middle within the same draw.
static void test_earlier_draws(const moray_sweep_spec *spec, const struct grid *grid)
{
    bool nearest = true, within = true;
    for (long draw = 1; draw < spec->draws; draw++) {
        const long parent = moray_grid_parent(grid, 5 * draw + 2), least = draw / 2 - 256;
        const bool earlier = parent >= 0 && parent % 5 == 2 && 2 * (parent / 5) < draw && parent / 5 >= least;
        nearest = nearest && earlier;
        for (long other = least > 0 ? least : 0; nearest && 2 * other < draw; other++)
            nearest = away(spec, draw, parent / 5) <= away(spec, draw, other);
        within = within && moray_grid_parent(grid, 5 * draw) == 5 * draw + 1 &&
                 moray_grid_parent(grid, 5 * draw + 4) == 5 * draw + 3;
    }
    CHECK(nearest, "parents of draws are the nearest of those before");
    CHECK(within, "other points begin at their own draw's");
    CHECK(moray_grid_parent(grid, 2) == -1, "the first has none");
}

// Of the fourth number on the axis, of draw 9.
static void test_drawn_settings(const moray_sweep_spec *spec, const struct grid *grid)
{
    moray_key_value setting[4];
    double value[4];
    char text[4][32];
    moray_grid_settings(grid, 9 * 5 + 3, setting, value, text);
    CHECK(value[0] == 8 && moray_grid_coordinate(grid, 9 * 5 + 3, 1) == 8, "first = %g", value[0]);
    for (int r = 0; r < 3; r++)
        CHECK(value[1 + r] == moray_grid_draw(spec, 9, r) && strcmp(setting[1 + r].key, spec->range[r].key) == 0 &&
                  atof(setting[1 + r].value) == value[1 + r],
              "%s = %s", setting[1 + r].key, setting[1 + r].value);
}

// Uniform within their ranges, of no correlation, the same again for a seed and others for another.
static void test_draws(void)
{
    static const moray_sweep_axis axis = {.key = "first", .value = five, .n = 5};
    static const moray_sweep_range ranges[] = {{"a", -1, 3}, {"b", 100, 200}, {"c", 7, 7}};
    moray_sweep_spec spec = {
        .solve = never, .axes = 1, .axis = &axis, .ranges = 3, .range = ranges, .draws = 2000, .seed = 5};
    const double middle[] = {1, 150}, width[] = {4, 100};
    struct grid grid;
    CHECK_OK(moray_grid_new(&spec, &grid), "a grid with draws");
    CHECK(grid.axes == 2 && grid.first == 1 && grid.points == 5 * 2000, "%ld points", grid.points);
    double mean[2] = {0}, square[2] = {0}, product = 0;
    bool constant = true;
    for (long draw = 0; draw < spec.draws; draw++) {
        double part[2];
        for (int r = 0; r < 2; r++) {
            part[r] = (moray_grid_draw(&spec, draw, r) - middle[r]) / width[r];
            mean[r] += part[r] / (double)spec.draws;
            square[r] += part[r] * part[r] / (double)spec.draws;
        }
        product += part[0] * part[1] / (double)spec.draws;
        constant = constant && moray_grid_draw(&spec, draw, 2) == 7;
    }
    const double four_errors = 4 / sqrt(2000.0); // of a mean of numbers of standard deviation 1
    for (int r = 0; r < 2; r++) {
        CHECK_NEAR(mean[r], 0, four_errors / sqrt(12), "mean");
        CHECK_NEAR(square[r], 1.0 / 12, four_errors / sqrt(180), "variance of a uniform distribution");
    }
    CHECK_NEAR(product, 0, four_errors / 12, "covariance");
    CHECK(constant, "a range of no width is its value");
    test_earlier_draws(&spec, &grid);
    test_drawn_settings(&spec, &grid);
    const double before = moray_grid_draw(&spec, 9, 1);
    spec.seed = 6;
    CHECK(moray_grid_draw(&spec, 9, 1) != before, "another seed draws others");
}

// The numbers of SplitMix64 one after another, sixteen to a draw.
static void test_generator(void)
{
    static const moray_sweep_range ranges[] = {{"a", -1, 3}, {"b", 100, 200}, {"c", 0, 1}};
    const moray_sweep_spec spec = {.ranges = 3, .range = ranges, .draws = 5, .seed = 77};
    unsigned long long seed = 77;
    for (long draw = 0; draw < 5; draw++)
        for (int r = 0; r < 16; r++) {
            const double part = tap_random(&seed, 0, 1);
            if (r < 3)
                CHECK(moray_grid_draw(&spec, draw, r) == ranges[r].low + part * (ranges[r].high - ranges[r].low),
                      "draw %ld of %s", draw, ranges[r].key);
        }
}

static void refused(const moray_sweep_spec *spec, const char *text)
{
    struct grid grid;
    const moray_status status = moray_grid_new(spec, &grid);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, text) == 0, "%s", status.text);
}

// As many keys as there may be, and one more; ranges that are none; and more points than a number of them has room for.
static void test_bounds(void)
{
    static const double one[] = {5};
    moray_sweep_axis axis[MORAY_SWEEP_AXES + 1];
    moray_sweep_range range[MORAY_SWEEP_RANGES + 1];
    char key[MORAY_SWEEP_AXES + MORAY_SWEEP_RANGES + 2][16];
    struct grid grid;
    for (int k = 0; k <= MORAY_SWEEP_AXES; k++) {
        snprintf(key[k], sizeof key[k], "x%d", k);
        axis[k] = (moray_sweep_axis){.key = key[k], .value = one, .n = 1};
    }
    for (int r = 0; r <= MORAY_SWEEP_RANGES; r++) {
        snprintf(key[MORAY_SWEEP_AXES + 1 + r], sizeof *key, "z%d", r);
        range[r] = (moray_sweep_range){key[MORAY_SWEEP_AXES + 1 + r], r, r};
    }
    moray_sweep_spec spec = {.solve = never, .axis = axis, .range = range};
    refused(&spec, "nothing is varied");
    spec.axes = MORAY_SWEEP_AXES, spec.ranges = MORAY_SWEEP_RANGES, spec.draws = 2;
    CHECK_OK(moray_grid_new(&spec, &grid), "as many as there may be");
    CHECK(grid.axes == MORAY_SWEEP_AXES + 1 && grid.points == 2, "%d axes", grid.axes);
    spec.axes = MORAY_SWEEP_AXES + 1;
    refused(&spec, "17 axes: at most 16");
    spec.axes = -1;
    refused(&spec, "-1 axes: at most 16");
    spec.axes = 2, spec.ranges = MORAY_SWEEP_RANGES + 1;
    refused(&spec, "17 random keys: at most 16");
    spec.ranges = -1;
    refused(&spec, "-1 random keys: at most 16");
    spec.ranges = 3, spec.draws = 0;
    refused(&spec, "0 random draws of 3 keys: either needs the other");
    spec.ranges = 0, spec.draws = 4;
    refused(&spec, "4 random draws of 0 keys: either needs the other");
    spec.ranges = 3;
    range[1].low = 1.5;
    refused(&spec, "z1 = 1.5:1: must be finite and rising");
    range[1].low = -INFINITY;
    refused(&spec, "z1 = -inf:1: must be finite and rising");
    range[1] = (moray_sweep_range){"z1", 0, NAN};
    refused(&spec, "z1 = 0:nan: must be finite and rising");
    range[1] = (moray_sweep_range){"", 0, 1};
    refused(&spec, "random key 2 has no name");
    range[1].key = NULL;
    refused(&spec, "random key 2 has no name");
    range[1].key = "x1";
    refused(&spec, "x1 is varied twice");
    range[1].key = "z2";
    refused(&spec, "z2 is varied twice");
    axis[1].key = "";
    refused(&spec, "axis 2 has no key");
    axis[1] = (moray_sweep_axis){.key = "x1", .n = 1};
    refused(&spec, "x1 has no values");
    axis[1] = (moray_sweep_axis){.key = "w", .word = (const char *const[]){"a", "", "c"}, .n = 3};
    refused(&spec, "w: word 2 is empty");
    axis[1] = (moray_sweep_axis){.key = "w", .word = (const char *const[]){"a", "b", "c", "b"}, .n = 4};
    refused(&spec, "w: b is there twice");
    spec.axes = spec.ranges = 1;
    spec.draws = 2147483647;
    CHECK_OK(moray_grid_new(&spec, &grid), "as many points as there may be");
    CHECK(grid.points == spec.draws && grid.shape[0] == spec.draws && grid.shape[1] == 1, "%ld", grid.points);
    spec.draws++;
    refused(&spec, "more than 2147483647 points");
}

int main(void)
{
    static const moray_sweep_axis axes[] = {{.key = "first", .value = five, .n = 5},
                                            {.key = "second", .word = words, .n = 3},
                                            {.key = "last", .value = four, .n = 4}};
    const moray_sweep_spec spec = {.solve = never, .axes = 3, .axis = axes};
    struct grid grid;
    CHECK_OK(moray_grid_new(&spec, &grid), "a grid");
    test_places(&grid);
    test_parents(&grid);
    test_settings(&grid);
    test_draws();
    test_generator();
    test_bounds();
    return tap_done();
}
