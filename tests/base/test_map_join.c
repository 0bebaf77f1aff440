// SPDX-License-Identifier: MIT
//
// Two maps as one, whose inputs and outputs are put in order: against the sum of their parts, and what is told to both.
#include "tap.h"

#include <string.h>

#include "moray/map.h"

enum { BASE_IN = 3, BASE_OUT = 3, IN = 5, EXTRA_OUT = 2, OUT = BASE_OUT + EXTRA_OUT };

// Linear in weights of their own and of second degree, with patterns that are not in order and entries in common.
static int base_row[] = {2, 0, 1, 0}, base_col[] = {1, 0, 2, 2}, base_bend_row[] = {2, 1, 0},
           base_bend_col[] = {0, 1, 0};
static int extra_row[] = {1, 0, 1, 0}, extra_col[] = {0, 4, 2, 1}, extra_bend_row[] = {4, 2, 1},
           extra_bend_col[] = {4, 0, 1};

static bool base_held[BASE_IN], extra_held[IN];
static int told[2], released;

// out_i = sum over its entries of c in + sum of bends: enough to tell each number from each other.
static void value_of(const int *row, const int *col, int n, int n_out, double factor, const double *in, double *out)
{
    for (int i = 0; i < n_out; i++)
        out[i] = factor * (i + 1);
    for (int k = 0; k < n; k++)
        out[row[k]] += factor * (k + 2) * in[col[k]];
}

static void base_value(void *self, const double *in, double *out)
{
    (void)self;
    value_of(base_row, base_col, 4, BASE_OUT, 1, in, out);
}

static void extra_value(void *self, const double *in, double *out)
{
    (void)self;
    value_of(extra_row, extra_col, 4, EXTRA_OUT, 10, in, out);
}

static void base_jacobian(void *self, const double *in, double *values)
{
    (void)self;
    for (int k = 0; k < 4; k++)
        values[k] = 1 + k + in[k % BASE_IN];
}

static void extra_jacobian(void *self, const double *in, double *values)
{
    (void)self;
    for (int k = 0; k < 4; k++)
        values[k] = 10 + k + in[k];
}

static void base_hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)self;
    for (int k = 0; k < 3; k++)
        values[k] = weight[k] * (k + 2) + in[k];
}

static void extra_hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)self;
    for (int k = 0; k < 3; k++)
        values[k] = weight[k % EXTRA_OUT] * (k + 7) + in[k + 2];
}

static void base_hold(void *self, const bool *held)
{
    (void)self;
    told[0] += held ? 1 : 100;
    if (held)
        memcpy(base_held, held, sizeof base_held);
}

static void extra_hold(void *self, const bool *held)
{
    (void)self;
    told[1] += held ? 1 : 100;
    if (held)
        memcpy(extra_held, held, sizeof extra_held);
}

static void release(moray_map *map)
{
    (void)map;
    released++;
}

static moray_map base_of(void)
{
    return (moray_map){.n_in = BASE_IN,
                       .n_out = BASE_OUT,
                       .jac = {4, base_row, base_col},
                       .hess = {3, base_bend_row, base_bend_col},
                       .value = base_value,
                       .jacobian = base_jacobian,
                       .hessian = base_hessian,
                       .hold = base_hold,
                       .release = release};
}

static moray_map extra_of(void)
{
    return (moray_map){.n_in = IN,
                       .n_out = EXTRA_OUT,
                       .jac = {4, extra_row, extra_col},
                       .hess = {3, extra_bend_row, extra_bend_col},
                       .value = extra_value,
                       .jacobian = extra_jacobian,
                       .hessian = extra_hessian,
                       .hold = extra_hold,
                       .release = release};
}

static void spread(const moray_pattern *pattern, const double *values, double dense[OUT][IN])
{
    memset(dense, 0, OUT * sizeof *dense);
    for (int k = 0; k < pattern->nnz; k++)
        dense[pattern->row[k]][pattern->col[k]] += values[k];
}

static bool same(double one[OUT][IN], double other[OUT][IN])
{
    bool all = true;
    for (int k = 0; k < OUT * IN; k++)
        all = all && fabs(one[k / IN][k % IN] - other[k / IN][k % IN]) < 1e-13;
    return all;
}

static void check_slopes(const moray_map *map, const int *place, int at, const double *in, const double *own)
{
    const double weight[OUT] = {1.5, -0.5, 2, 0.25, -3};
    double values[8], part[4], found[OUT][IN], want[OUT][IN] = {{0}}, base_weight[BASE_OUT];
    base_jacobian(NULL, own, part);
    for (int k = 0; k < 4; k++)
        want[base_row[k] < at ? base_row[k] : base_row[k] + EXTRA_OUT][place[base_col[k]]] += part[k];
    extra_jacobian(NULL, in, part);
    for (int k = 0; k < 4; k++)
        want[at + extra_row[k]][extra_col[k]] += part[k];
    map->jacobian(map->self, in, values);
    spread(&map->jac, values, found);
    CHECK(same(found, want), "at %d: slopes", at);
    memset(want, 0, sizeof want);
    for (int i = 0; i < BASE_OUT; i++)
        base_weight[i] = weight[i < at ? i : i + EXTRA_OUT];
    base_hessian(NULL, own, base_weight, part);
    for (int k = 0; k < 3; k++) {
        const int r = place[base_bend_row[k]], c = place[base_bend_col[k]];
        want[r > c ? r : c][r > c ? c : r] += part[k];
    }
    extra_hessian(NULL, in, weight + at, part);
    for (int k = 0; k < 3; k++)
        want[extra_bend_row[k]][extra_bend_col[k]] += part[k];
    map->hessian(map->self, in, weight, values);
    spread(&map->hess, values, found);
    for (int k = 0; k < OUT * IN; k++) // whichever side of the diagonal an entry stands on
        if (k / IN < k % IN) {
            found[k % IN][k / IN] += found[k / IN][k % IN];
            found[k / IN][k % IN] = 0;
        }
    CHECK(same(found, want), "at %d: bends", at);
}

static void check_join(const int *place, int at)
{
    moray_map base = base_of(), extra = extra_of(), map;
    const double in[IN] = {0.3, -1.2, 2.5, 0.7, -0.4};
    double own[BASE_IN], out[OUT], one[BASE_OUT], other[EXTRA_OUT];
    const bool held[IN] = {true, false, false, true, true};
    released = told[0] = told[1] = 0;
    CHECK_OK(moray_map_join(&map, &base, place, &extra, at), "joined");
    CHECK(map.n_in == IN && map.n_out == OUT && !base.value && !extra.value, "one map in the place of both");
    for (int k = 0; k < BASE_IN; k++)
        own[k] = in[place[k]];
    map.value(map.self, in, out);
    base_value(NULL, own, one);
    extra_value(NULL, in, other);
    for (int i = 0; i < OUT; i++)
        CHECK(out[i] == (i < at               ? one[i]
                         : i < at + EXTRA_OUT ? other[i - at]
                                              : one[i - EXTRA_OUT]),
              "output %d: %g", i, out[i]);
    check_slopes(&map, place, at, in, own);
    map.hold(map.self, held);
    for (int k = 0; k < BASE_IN; k++)
        CHECK(base_held[k] == held[place[k]], "input %d of the base is %sheld", k, held[place[k]] ? "" : "not ");
    CHECK(memcmp(extra_held, held, sizeof held) == 0 && told[0] == 1 && told[1] == 1, "the other is told all");
    map.hold(map.self, NULL);
    CHECK(told[0] == 101 && told[1] == 101, "and that nothing is held");
    moray_map_release(&map);
    CHECK(released == 2, "%d released", released);
}

// Of one that need not be told.
static void test_without_hold(void)
{
    const bool held[IN] = {true};
    moray_map base = base_of(), extra = extra_of(), map;
    base.hold = NULL;
    CHECK_OK(moray_map_join(&map, &base, (int[]){0, 1, 2}, &extra, 0), "joined");
    told[1] = 0;
    map.hold(map.self, held);
    CHECK(told[1] == 1, "the other is told");
    moray_map_release(&map);
    base = base_of(), extra = extra_of();
    extra.hold = NULL;
    CHECK_OK(moray_map_join(&map, &base, (int[]){0, 1, 2}, &extra, 0), "joined");
    told[0] = 0;
    map.hold(map.self, held);
    CHECK(told[0] == 1 && base_held[0] && !base_held[1], "the one is told");
    moray_map_release(&map);
}

int main(void)
{
    static const int places[][BASE_IN] = {{0, 1, 2}, {4, 2, 1}, {2, 0, 4}, {3, 4, 0}};
    for (int k = 0; k < 4; k++)
        for (int at = 0; at <= BASE_OUT; at++)
            check_join(places[k], at);
    test_without_hold();
    return tap_done();
}
