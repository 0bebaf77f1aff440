// SPDX-License-Identifier: MIT
//
// Groups of columns against their definition, on random patterns and on ones whose groups are known.
#include "tap.h"

#include <string.h>

#include "base/colouring.h"

enum { MOST = 12 };

static int entries_of(const bool *touches, int rows, int cols, int c)
{
    int n = 0;
    for (int r = 0; r < rows; r++)
        n += touches[r * cols + c];
    return n;
}

static bool share_a_row(const bool *touches, int rows, int cols, int one, int other)
{
    for (int r = 0; r < rows; r++)
        if (touches[r * cols + one] && touches[r * cols + other])
            return true;
    return false;
}

// In the order of their entries, the first of equal ones first, each column goes where no earlier one meets it.
static int expected(const bool *touches, int rows, int cols, int *group)
{
    int groups = 0;
    for (int c = 0; c < cols; c++)
        group[c] = -1;
    for (int n = rows; n > 0; n--)
        for (int c = 0; c < cols; c++) {
            if (entries_of(touches, rows, cols, c) != n)
                continue;
            bool free = false;
            for (int g = 0; !free; g++) {
                free = true;
                for (int other = 0; other < cols; other++)
                    free = free && !(group[other] == g && share_a_row(touches, rows, cols, c, other));
                if (free)
                    group[c] = g;
            }
            groups = group[c] + 1 > groups ? group[c] + 1 : groups;
        }
    return groups;
}

static void test_random(void)
{
    unsigned long long seed = 23;
    int wrong = 0, empty = 0, most = 0;
    for (int round = 0; round < 500; round++) {
        const int rows = (int)tap_random(&seed, 1, MOST + 1), cols = (int)tap_random(&seed, 1, MOST + 1);
        const double dense = tap_random(&seed, 0, 0.6);
        bool touches[MOST * MOST];
        int group[MOST], want[MOST], groups = -1;
        for (int k = 0; k < rows * cols; k++)
            touches[k] = tap_random(&seed, 0, 1) < dense;
        if (moray_failed(moray_colour_columns(touches, rows, cols, group, &groups)))
            break;
        const int want_groups = expected(touches, rows, cols, want);
        wrong += groups != want_groups || memcmp(group, want, (size_t)cols * sizeof *group) != 0;
        for (int c = 0; c < cols; c++)
            empty += group[c] < 0;
        most = groups > most ? groups : most;
    }
    CHECK(wrong == 0, "%d of 500 in other groups", wrong);
    CHECK(empty > 9 && most > 5, "%d columns were empty, as many as %d groups", empty, most);
}

static void test_known(void)
{
    bool touches[MOST * MOST] = {false};
    int group[MOST], groups;
    CHECK_OK(moray_colour_columns(touches, MOST, MOST, group, &groups), "nothing");
    CHECK(groups == 0 && group[0] == -1 && group[MOST - 1] == -1, "is in no group");
    for (int r = 0; r < MOST; r++)
        for (int c = 0; c < MOST; c++)
            touches[r * MOST + c] = abs(r - c) <= 1;
    CHECK_OK(moray_colour_columns(touches, MOST, MOST, group, &groups), "three diagonals");
    bool apart = true;
    for (int c = 0; c + 2 < MOST; c++)
        apart = apart && group[c] != group[c + 1] && group[c] != group[c + 2];
    CHECK(groups >= 3 && groups <= 4 && apart, "%d groups, no two neighbours in one", groups);
    for (int r = 0; r < MOST; r++)
        for (int c = 0; c < MOST; c++)
            touches[r * MOST + c] = r == c || c == 4;
    CHECK_OK(moray_colour_columns(touches, MOST, MOST, group, &groups), "a diagonal and a full column");
    CHECK(groups == 2 && group[4] == 0 && group[3] == 1 && group[5] == 1, "the full one alone, first");
}

int main(void)
{
    test_random();
    test_known();
    return tap_done();
}
