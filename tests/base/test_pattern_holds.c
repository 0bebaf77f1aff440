// SPDX-License-Identifier: MIT
//
// A numeric map of a kind whose derivatives are exact but for what a test adds along dense directions: how much the
// doubts of the kind leave unseen, and at which points it is looked at.
#include "tap.h"

#include <string.h>

#include "base/dense.h"
#include "base/numeric_map.h"

enum { N_IN = 3, N_OUT = 2, CALLS = 1000 };

// out_i = shift_i + slope_i x + x' bend_i x / 2, bend symmetric
static const double shift[N_OUT] = {2.5, -7}, slopes[N_OUT][N_IN] = {{1.5, -0.4, 0.3}, {-2, 0, 0.25}};
static const double bends[N_OUT][N_IN][N_IN] = {{{-0.7, 0.3, 0}, {0.3, 0, -1.1}, {0, -1.1, 0.2}},
                                                {{0.9, 0, -0.6}, {0, 0, 0}, {-0.6, 0, -0.8}}};

static double extra_slope[N_OUT], extra_bend[N_OUT], called_at[CALLS][N_IN];
static int calls, looks, dense_looks, undefined = -1; // output that has no value, but slopes

static double slope_at(int i, int j, const double *in)
{
    double slope = slopes[i][j];
    for (int k = 0; k < N_IN; k++)
        slope += bends[i][j][k] * in[k];
    return slope;
}

static double bend_along(int i, const double *one, const double *other)
{
    double sum = 0;
    for (int j = 0; j < N_IN; j++)
        for (int k = 0; k < N_IN; k++)
            sum += one[j] * bends[i][j][k] * other[k];
    return sum;
}

static void value(void *self, const double *in, double *out)
{
    (void)self;
    if (calls < CALLS)
        memcpy(called_at[calls++], in, sizeof called_at[0]);
    for (int i = 0; i < N_OUT; i++) {
        out[i] = shift[i] + bend_along(i, in, in) / 2;
        for (int j = 0; j < N_IN; j++)
            out[i] += slopes[i][j] * in[j];
        out[i] = i == undefined ? NAN : out[i];
    }
}

static bool is_dense(const double *direction)
{
    for (int j = 0; j < N_IN; j++)
        if (direction[j] == 0)
            return false;
    return true;
}

static void along(struct numeric_map *map, const double *in, const double *direction, double *slope)
{
    (void)map;
    for (int i = 0; i < N_OUT; i++) {
        slope[i] = is_dense(direction) ? extra_slope[i] : 0;
        for (int j = 0; j < N_IN; j++)
            slope[i] += slope_at(i, j, in) * direction[j];
    }
}

static void bend(struct numeric_map *map, const double *in, const double *direction, double *curvature)
{
    (void)map, (void)in;
    dense_looks++;
    for (int i = 0; i < N_OUT; i++)
        curvature[i] = bend_along(i, direction, direction) + extra_bend[i];
}

static void bend_pair(struct numeric_map *map, const double *in, int g, int h, double *curvature)
{
    moray_set_direction(map, in, &map->nonlinear, g, map->direction);
    moray_set_direction(map, in, &map->nonlinear, h, map->other);
    for (int i = 0; i < N_OUT; i++)
        curvature[i] = bend_along(i, map->direction, map->other);
}

static void mark_slopes(struct numeric_map *map, const double *at)
{
    looks++;
    for (int i = 0; i < N_OUT; i++)
        for (int j = 0; j < N_IN; j++)
            if (slope_at(i, j, at) != 0)
                moray_mark_slope(map, i, j);
}

static void find_bent(struct numeric_map *map, const double *at)
{
    (void)at;
    for (int i = 0; i < N_OUT; i++)
        map->bent[i] = bend_along(i, map->direction, map->other) != 0;
}

static void release(struct numeric_map *map)
{
    (void)map;
}

static struct numeric_kind kind = {.value = value,
                                   .along = along,
                                   .bend = bend,
                                   .bend_pair = bend_pair,
                                   .mark_slopes = mark_slopes,
                                   .find_bent = find_bent,
                                   .release = release};

static struct numeric_map *self_new(void)
{
    struct numeric_map *self = calloc(1, sizeof *self);
    if (self)
        *self = (struct numeric_map){.kind = &kind, .n_in = N_IN, .n_out = N_OUT};
    return self;
}

// ---- What the doubts leave unseen ----------------------------------------------------------------------------------

static const double point[N_IN] = {-0.8, 0.5, -1.3}, sizes[N_IN] = {1, 0.5, 2};

// Of an output along the dense direction: the moduli of what its slope and its bend are made of, and of its value.
struct moduli {
    double slope, bend, value;
};

static struct moduli moduli_of(int i)
{
    double d[N_IN], out[N_OUT];
    for (int j = 0; j < N_IN; j++)
        d[j] = moray_dense_entry(j, MORAY_DENSE_PATTERN) * (sizes[j] + fabs(point[j]));
    value(NULL, point, out);
    struct moduli sum = {.value = fabs(out[i])};
    for (int j = 0; j < N_IN; j++) {
        sum.slope += fabs(slope_at(i, j, point) * d[j]);
        for (int k = 0; k < N_IN; k++)
            sum.bend += fabs(d[j] * bends[i][j][k] * d[k]);
    }
    return sum;
}

static const double beside = 1e-9; // below it rounding counts

static void check_limit(const moray_map *map, double *extra, double allowed, const char *what)
{
    for (int sign = -1; sign <= 1 && allowed > beside; sign += 2) {
        *extra = sign * 0.999 * allowed;
        CHECK(moray_map_pattern_holds(map, point), "%s: %.3g of %.3g is in doubt", what, *extra, allowed);
        *extra = sign * 1.001 * allowed;
        CHECK(!moray_map_pattern_holds(map, point), "%s: %.3g of %.3g is not", what, *extra, allowed);
    }
    *extra = 0;
}

// Each doubt alone, beside what rounding needs, and all.
static void test_doubts(void)
{
    static const double tiny = 1e-13;
    const struct numeric_doubt cases[] = {{1e-3, 0, tiny, 0, 0},    {tiny, 2e-3, tiny, 0, 0},
                                          {tiny, 0, 3e-3, 0, 0},    {tiny, 0, tiny, 4e-3, 0},
                                          {tiny, 0, tiny, 0, 5e-3}, {1e-3, 2e-3, 3e-3, 4e-3, 5e-3}};
    const struct numeric_probe probe = {.points = point, .size = sizes, .n = 1};
    moray_map map;
    CHECK_OK(moray_numeric_map_new(&map, self_new(), N_IN, NULL, NULL, &probe), "a map");
    CHECK(map.jac.nnz == 5 && map.hess.nnz == 5, "of %d slopes and %d bends", map.jac.nnz, map.hess.nnz);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct numeric_doubt *doubt = &cases[k];
        kind.doubt = *doubt;
        CHECK(moray_map_pattern_holds(&map, point), "by case %zu of doubts the pattern holds", k);
        for (int i = 0; i < N_OUT; i++) {
            const struct moduli of = moduli_of(i);
            check_limit(&map, &extra_slope[i], doubt->slope * of.slope + doubt->slope_of_value * of.value, "a slope");
            check_limit(&map, &extra_bend[i],
                        doubt->bend * of.bend + doubt->bend_of_slope * of.slope + doubt->bend_of_value * of.value,
                        "a bend");
        }
    }
    for (int i = 0; i < N_OUT; i++) {
        extra_slope[i] = NAN;
        CHECK(moray_map_pattern_holds(&map, point), "what is no number says nothing of output %d", i);
        extra_bend[1 - i] = 1;
        CHECK(!moray_map_pattern_holds(&map, point), "but the other's does");
        extra_slope[i] = extra_bend[1 - i] = 0;
        undefined = i;
        extra_slope[i] = 1;
        CHECK(moray_map_pattern_holds(&map, point), "nor does what has no value");
        extra_slope[i] = 0, extra_slope[1 - i] = 1;
        CHECK(!moray_map_pattern_holds(&map, point), "beside which the other's slope does");
        extra_slope[1 - i] = 0;
        undefined = -1;
    }
    moray_map_release(&map);
}

// ---- Where a map is looked at --------------------------------------------------------------------------------------

// Places in the order in which they were first looked at, relative to 1 + |at|. Returns how many.
static int places_around(const double *at, double place[][N_IN])
{
    moray_map map;
    int places = 0;
    calls = looks = dense_looks = 0;
    CHECK_OK(moray_numeric_map_around(&map, self_new(), N_IN, NULL, NULL, at), "a map by what is around");
    moray_map_release(&map);
    for (int k = 0; k < calls; k++)
        if (k == 0 || memcmp(called_at[k], called_at[k - 1], sizeof called_at[0]) != 0) {
            for (int j = 0; j < N_IN; j++)
                place[places][j] = (called_at[k][j] - at[j]) / (1 + fabs(at[j]));
            places++;
        }
    return places;
}

static void test_places(void)
{
    static const double here[N_IN] = {0}, there[N_IN] = {-1, 40, -0.3}, bound[] = {0.01, 0.1, 0.5};
    static double one[CALLS][N_IN], other[CALLS][N_IN];
    double low[3][N_IN] = {{0}}, high[3][N_IN] = {{0}};
    const int places = places_around(here, one);
    CHECK(looks == 5 && dense_looks == 8, "%d times thoroughly, %d times along one direction", looks, dense_looks);
    CHECK(places == 13 && places_around(there, other) == 13, "at %d places", places);
    for (int j = 0; j < N_IN; j++)
        CHECK(one[0][j] == 0 && other[0][j] == 0, "the first of which is given");
    const double golden = (sqrt(5) - 1) / 2; // whose multiples fill an interval evenly
    CHECK_NEAR(one[1][0], 0.1 * (2 * golden - 1), 1e-13, "the next as far as the golden section");
    CHECK_NEAR(one[2][0], 0.5 * (2 * (2 * golden - 1) - 1), 1e-13, "and its multiples");
    CHECK_NEAR(one[1][1], 0.1 * (2 * (2 * golden - 1) - 1), 1e-13, "of the second input twice as much");
    for (int k = 0; k < places; k++)
        for (int j = 0; j < N_IN; j++) {
            CHECK_NEAR(other[k][j], one[k][j], 1e-13, "and the others as far from it as it is from 0, and 1");
            low[k % 3][j] = fmin(low[k % 3][j], one[k][j]);
            high[k % 3][j] = fmax(high[k % 3][j], one[k][j]);
        }
    for (int s = 0; s < 3; s++)
        for (int j = 0; j < N_IN; j++)
            CHECK(low[s][j] >= -bound[s] && high[s][j] <= bound[s] && low[s][j] < 0 && high[s][j] > 0 &&
                      high[s][j] - low[s][j] > bound[s] / 2,
                  "input %d on both sides, from %g to %g, by at most %g", j, low[s][j], high[s][j], bound[s]);
}

int main(void)
{
    test_doubts();
    test_places();
    return tap_done();
}
