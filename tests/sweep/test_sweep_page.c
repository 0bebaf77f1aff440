// SPDX-License-Identifier: MIT
//
// The page of a sweep, character by character where it is small, and what is left out where it would be too large.
#define _GNU_SOURCE // mkdtemp
#include "tap.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sweep/sweep.h"

static moray_status none(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point, (void)summary, (void)self;
    return moray_ok();
}

static char *page_of(const struct store *store, const char *progress, bool ended)
{
    char *text = NULL;
    size_t size = 0;
    CHECK_OK(moray_page_write(store, progress, ended), "a page");
    FILE *file = fopen(store->grid->spec->page, "r");
    CHECK(file && getdelim(&text, &size, 0, file) > 0, "which is there");
    if (file)
        fclose(file);
    CHECK(access("map.html.new", F_OK) != 0, "under its own name alone");
    return text ? text : strdup("");
}

static int count(const char *text, const char *word)
{
    int n = 0;
    for (const size_t length = strlen(word); *text; text++) // strstr is slow under the sanitizers
        n += *text == *word && strncmp(text, word, length) == 0;
    return n;
}

static void solved(struct store *store, long point, double objective)
{
    store->state[point] = POINT_SOLVED;
    store->objective[point] = objective;
}

static void failed(struct store *store, long point, const char *reason)
{
    store->state[point] = POINT_FAILED;
    store->reason[point] = reason ? strdup(reason) : NULL;
}

// The colours go straight from rgb(30,60,140), of the lowest, to rgb(240,210,50): a fifth of the way is rgb(72,90,122).
#define CELL(x, y, fill, title)                                                                                        \
    "<rect x=\"" x "\" y=\"" y "\" width=\"27.0\" height=\"27.0\" fill=\"" fill "\"><title>" title "</title></rect>\n"
static const char small[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<meta http-equiv=\"refresh\" content=\"3\">\n"
    "<title>a &#60; b</title><style>body{font:15px sans-serif;margin:1.5em}</style></head><body>\n<h1>a &#60; b</h1>\n"
    "<p>4 of 6 &#38; more</p>\n"
    "<p>fin&#62; from left to right, a row for each setting of the others; grey: not tried yet, red: not solved, "
    "from blue to yellow: cost&#34; from -8 to -3. What a cell is, it tells under the pointer.</p>\n"
    "<svg width=\"84\" height=\"56\">\n" CELL("0.0", "0.0", "rgb(30,60,140)", "depth -1, fin&#62; a&#34;b, one 5: -8")
        CELL("28.0", "0.0", "rgb(240,210,50)", "depth -1, fin&#62; c, one 5: -3")
            CELL("56.0", "0.0", "rgb(30,60,140)", "depth -1, fin&#62; d, one 5: nan")
                CELL("0.0", "28.0", "#d03030", "depth 2, fin&#62; a&#34;b, one 5") CELL("28.0", "28.0", "#e4e4e4",
                                                                                        "depth 2, fin&#62; c, one 5")
                    CELL("56.0", "28.0", "rgb(72,90,122)",
                         "depth 2, fin&#62; d, one 5: -7") "</svg>\n"
                                                           "<h2>Not solved</h2>\n<ul>\n<li>depth 2, fin&#62; a&#34;b, "
                                                           "one 5: x &#60; y</li>\n</ul>\n</body></html>\n";

static void test_small(void)
{
    static const char *const words[] = {"a\"b", "c", "d"};
    const moray_sweep_axis axes[] = {{.key = "depth", .value = (const double[]){-1, 2}, .n = 2},
                                     {.key = "fin>", .word = words, .n = 3},
                                     {.key = "one", .value = (const double[]){5}, .n = 1}};
    moray_sweep_spec spec = {
        .page = "map.html", .axis = axes, .axes = 3, .solve = none, .title = "a < b", .objective = "cost\""};
    struct grid grid;
    struct store store;
    CHECK_OK(moray_grid_new(&spec, &grid), "a grid");
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    store.objective[3] = store.objective[4] = -20; // of no solution: it counts for nothing
    solved(&store, 0, -8), solved(&store, 1, -3), solved(&store, 2, NAN), solved(&store, 5, -7);
    failed(&store, 3, "x < y");
    char *text = page_of(&store, "4 of 6 & more", false);
    CHECK(strcmp(text, small) == 0, "the page: %s", text);
    free(text);

    spec.title = NULL, spec.objective = NULL;
    solved(&store, 1, -8), solved(&store, 5, INFINITY);
    text = page_of(&store, "", true);
    CHECK(strstr(text, "<title>sweep</title>") && !strstr(text, "refresh"), "of one that has ended, without a title");
    CHECK(!strstr(text, "from blue to yellow"), "which lowers nothing");
    CHECK(count(text, "fill=\"rgb(30,60,140)\"") == 4, "of one value all have one colour");
    free(text);
    moray_store_free(&store);

    spec.objective = "cost";
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    text = page_of(&store, "", true);
    CHECK(!strstr(text, "from blue to yellow") && !strstr(text, "Not solved"), "before anything is tried");
    free(text);
    solved(&store, 4, 6);
    text = page_of(&store, "", true);
    CHECK(strstr(text, "from blue to yellow: cost from 6 to 6."), "one solution is the range");
    free(text);
    moray_store_free(&store);
}

static void test_draws(void)
{
    static const moray_sweep_range range = {"a", 2, 2};
    const moray_sweep_spec spec = {
        .page = "map.html", .range = &range, .ranges = 1, .draws = 60, .solve = none, .title = "drawn"};
    struct grid grid;
    struct store store;
    CHECK_OK(moray_grid_new(&spec, &grid), "a grid of draws");
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    solved(&store, 0, 1);
    for (long k = 1; k < 51; k++)
        failed(&store, k, NULL);
    char *text = page_of(&store, "", false);
    CHECK(strstr(text, "<p>draw from left to right"), "draws are a row");
    CHECK(count(text, "<li>a 2: </li>\n") == 50 && count(text, "<h2>") == 1, "of which all fifty failures are told");
    free(text);
    failed(&store, 51, "one more"), failed(&store, 59, "the last");
    text = page_of(&store, "", false);
    CHECK(count(text, "<li>") == 50 && !strstr(text, "one more"), "and no more than fifty");
    free(text);
    moray_store_free(&store);
}

// A grid of rows and columns: all of its cells, or every second one, in a picture of at most 1000 by 800.
static void check_large(int rows, int columns, int step_row, int step_column)
{
    static double value[300];
    const moray_sweep_axis axes[] = {{.key = "r", .value = value, .n = rows},
                                     {.key = "c", .value = value, .n = columns}};
    const moray_sweep_spec spec = {.page = "map.html", .axis = axes, .axes = 2, .solve = none};
    struct grid grid;
    struct store store;
    char line[300];
    for (int k = 0; k < 300; k++)
        value[k] = k;
    CHECK_OK(moray_grid_new(&spec, &grid), "a large grid");
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    const int down = (rows - 1) / step_row, across = (columns - 1) / step_column; // the last ones
    const double height = 800. / (down + 1), width = 1000. / (across + 1);
    char *text = page_of(&store, "", false);
    CHECK(count(text, "<rect ") == (down + 1) * (across + 1), "%d cells", count(text, "<rect "));
    CHECK(strstr(text, "<svg width=\"1000\" height=\"800\">"), "fill the picture");
    // Between cells a line, which takes at most a fifth of a cell.
    snprintf(line, sizeof line,
             "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"#e4e4e4\"><title>r %d, c %d</title>",
             across * width, down * height, width < 5 ? width * 4 / 5 : width - 1, height - 1, down * step_row,
             across * step_column);
    CHECK(strstr(text, line), "the last is %s", line);
    free(text);
    moray_store_free(&store);
}

static void test_refused(void)
{
    const moray_sweep_axis axis = {.key = "x", .value = (const double[]){1}, .n = 1};
    moray_sweep_spec spec = {.page = "nowhere/map.html", .axis = &axis, .axes = 1, .solve = none};
    struct grid grid;
    struct store store;
    CHECK_OK(moray_grid_new(&spec, &grid), "a grid");
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    moray_status status = moray_page_write(&store, "", true);
    CHECK(status.code == MORAY_IO && strcmp(status.text, "nowhere/map.html.new: No such file or directory") == 0, "%s",
          status.text);
    CHECK(mkdir("folder", 0777) == 0, "a folder");
    spec.page = "folder";
    status = moray_page_write(&store, "", true);
    CHECK(status.code == MORAY_IO && strcmp(status.text, "folder cannot be written: Is a directory") == 0, "%s",
          status.text);
    CHECK(access("folder.new", F_OK) != 0, "and nothing is left of it");
    moray_store_free(&store);
}

int main(void)
{
    char folder[] = "/tmp/moray-page-XXXXXX", command[100];
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    test_small();
    test_draws();
    check_large(120, 240, 1, 1);
    check_large(121, 241, 2, 2);
    check_large(125, 100, 2, 1);
    test_refused();
    snprintf(command, sizeof command, "rm -rf %s", folder);
    CHECK(chdir("/") == 0 && system(command) == 0, "nothing is left behind");
    return tap_done();
}
