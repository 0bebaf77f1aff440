// SPDX-License-Identifier: MIT
//
// Where functions are looked at first: sizes, points within bounds, points over whole boxes, and the boxes, entry by
// entry of two phases of which all bounds differ.
#include "tap.h"

#include "ocp/probe.h"

#define ENDLESS MORAY_INFINITY
enum { most = 64, points = moray_probe_points, parts = points - 1 };

static moray_bounds first_x[] = {{-3, 9}, {-5000, 5000}, {-ENDLESS, ENDLESS}},
                    first_x0[] = {{-3, -0.5}, {7, 7}, {-ENDLESS, ENDLESS}},
                    first_xf[] = {{2, 8}, {-40, 20}, {-ENDLESS, -0.25}}, first_u[] = {{-0.4, 0.2}, {3, ENDLESS}},
                    second_x[] = {{-0.125, 0.0625}}, second_x0[] = {{-0.125, -0.125}}, second_xf[] = {{0, 0.0625}},
                    second_u[] = {{-2, 6}}, second_u0[] = {{-2, 1}}, second_uf[] = {{4, 5}},
                    second_q[] = {{0, ENDLESS}, {-0.3, 0.1}}, parameters[] = {{0.5, 0.75}, {-ENDLESS, -6}};
static struct phase phases[] = {{.nx = 3,
                                 .nu = 2,
                                 .ns = 2,
                                 .t0 = {-0.25, 0.125},
                                 .tf = {3, 4},
                                 .x = first_x,
                                 .x0 = first_x0,
                                 .xf = first_xf,
                                 .u = first_u,
                                 .u0 = first_u,
                                 .uf = first_u},
                                {.nx = 1,
                                 .nu = 1,
                                 .nq = 2,
                                 .ns = 2,
                                 .t0 = {3, 5},
                                 .tf = {0.5, 0.5},
                                 .x = second_x,
                                 .x0 = second_x0,
                                 .xf = second_xf,
                                 .u = second_u,
                                 .u0 = second_u0,
                                 .uf = second_uf,
                                 .q = second_q,
                                 .end_controls = true}};
static const moray_ocp ocp = {.phases = 2, .ns = 2, .phase = phases, .s = parameters};

static void check_list(const double *got, const double *want, int n, const char *what)
{
    for (int i = 0; i < n; i++)
        CHECK(fabs(got[i] - want[i]) <= 1e-12 * fabs(want[i]), "%s %d: %.15g, expected %.15g", what, i, got[i],
              want[i]);
}

static void check_all(const double *got, const double *want, int n, const char *what)
{
    check_list(got, want, n, what);
    CHECK(isnan(got[n]), "%s: no more than %d", what, n);
}

static double *unset(void)
{
    static double list[points * most];
    for (int i = 0; i < points * most; i++)
        list[i] = NAN;
    return list;
}

// ---- Sizes ----

static const struct sized {
    moray_bounds bounds;
    double size;
} sizes[] = {{{-3, 2}, 1},
             {{-0.3, 0.2}, 0.3},
             {{0.2, 0.5}, 0.5},
             {{-0.5, -0.2}, 0.5},
             {{-ENDLESS, 0.25}, 0.25},
             {{-0.25, ENDLESS}, 0.25},
             {{-0.25, INFINITY}, 0.25},
             {{-2, ENDLESS}, 1},
             {{-ENDLESS, 0}, 1},
             {{-ENDLESS, ENDLESS}, 1},
             {{0, 0}, 1},
             {{1e-9, 1e-9}, 1},
             {{-1e-9, -1e-9}, 1},
             {{1e-8, 1e-8}, 1e-8},
             {{-1e-9, 2e-9}, 2e-9}};
enum { sized = sizeof sizes / sizeof *sizes };

static void test_sizes(void)
{
    moray_bounds s[sized];
    double want[sized + 1];
    for (int i = 0; i < sized; i++)
        s[i] = sizes[i].bounds, want[i] = sizes[i].size;
    want[sized] = 0.375;
    struct phase still = {.t0 = {-0.375, 0}, .tf = {2, 3}};
    const moray_ocp flat = {.phases = 1, .ns = sized, .s = s, .phase = &still};
    double *size = unset();
    moray_phase_sizes(&flat, &still, size);
    check_all(size, want, sized + 1, "size");
}

static void test_lists_of_sizes(void)
{
    double *size = unset();
    moray_phase_sizes(&ocp, &phases[0], size);
    check_all(size, (double[]){1, 1, 0.25, 0.4, 1, 0.75, 1, 0.25}, 8, "size in a phase");
    size = unset();
    moray_phase_sizes(&ocp, &phases[1], size);
    check_all(size, (double[]){0.0625, 1, 0.75, 1, 0.5}, 5, "size in another");
    size = unset();
    moray_endpoint_sizes(&ocp, size);
    check_all(size, (double[]){1, 1, 0.25, 0.25, 1, 1, 0.25, 0.25, 0.0625, 0.5, 0.0625, 0.5, 1, 0.3, 1, 1, 0.75, 1}, 18,
              "size at the ends");
    CHECK(moray_phase_inputs(&phases[0]) == 8 && moray_phase_inputs(&phases[1]) == 5, "inputs of the phases");
    CHECK(moray_end_inputs(&phases[0]) == 8 && moray_end_inputs(&phases[1]) == 8 && moray_endpoint_inputs(&ocp) == 18,
          "inputs of the endpoint");
}

// ---- One point: off the middle by less than a tenth of the width, by golden parts of it ----

static double golden_part(double steps)
{
    const double turns = steps * (sqrt(5) - 1) / 2;
    return turns - floor(turns);
}

static double off_middle(int i, int trial)
{
    const double turns = golden_part(i + 1) + 0.37 * trial;
    return 0.2 * (turns - floor(turns)) - 0.1;
}

static double in_box(moray_bounds b, int i, int trial)
{
    return (b.lower + b.upper) / 2 + (b.upper - b.lower) * off_middle(i, trial);
}

// Above a lower bound, or around 0.
static double above(double lower, double size, int i, int trial)
{
    return lower + (size + fabs(lower)) * (0.3 + off_middle(i, trial));
}

static double of_ends(double x0, double xf, double size)
{
    const double middle = 0.55 * x0 + 0.45 * xf;
    return middle + 0.05 * (size + fabs(middle));
}

static void test_probe(int trial)
{
    double *in = unset();
    moray_phase_probe(&ocp, &phases[0], trial, in);
    check_all(in,
              (double[]){of_ends(in_box(first_x0[0], 0, trial), in_box(first_xf[0], 7, trial), 1),
                         of_ends(7, in_box(first_xf[1], 8, trial), 1), of_ends(above(0, 0.25, 2, trial), -0.25, 0.25),
                         in_box(first_u[0], 0, trial), above(3, 1, 1, trial), in_box(parameters[0], 0, trial), -6,
                         0.6 * in_box(phases[0].t0, 0, trial) + 0.4 * in_box(phases[0].tf, 1, trial)},
              8, "point of a phase, input");
    in = unset();
    moray_endpoint_probe(&ocp, trial, in);
    check_all(in,
              (double[]){in_box(first_x0[0], 0, trial), 7, above(0, 1, 2, trial), in_box(phases[0].t0, 0, trial),
                         in_box(first_xf[0], 0, trial), in_box(first_xf[1], 1, trial), -0.25,
                         in_box(phases[0].tf, 0, trial + 1), -0.125, in_box(phases[1].t0, 0, trial),
                         in_box(second_xf[0], 0, trial), 0.5, above(0, 1, 0, trial), in_box(second_q[1], 1, trial),
                         in_box(second_u0[0], 0, trial), in_box(second_uf[0], 0, trial + 1),
                         in_box(parameters[0], 0, trial), -6},
              18, "point of the ends, input");
}

// Beside both ends, but not beyond the bounds.
static void test_probe_at_bound(void)
{
    moray_bounds x[] = {{-1, 3}}, end[] = {{3, 3}};
    struct phase still = {.nx = 1, .x = x, .x0 = end, .xf = end};
    const moray_ocp one = {.phases = 1, .phase = &still};
    double in[2];
    moray_phase_probe(&one, &still, 0, in);
    CHECK(in[0] == 3 && in[1] == 0, "at the bound: %g", in[0]);
}

// ---- Points over the whole box ----

// Input i of point k: each part of the box once, never at its edges.
static double part_of(int i, int k)
{
    const int stride = 1 + (7 * i) % (parts - 1), part = (k * stride + 11 * i) % parts;
    return (part + 0.1 + 0.8 * golden_part(i + k)) / parts;
}

static double over(moray_bounds b, int i, int k)
{
    return b.lower + part_of(i, k) * (b.upper - b.lower);
}

// At distances of several magnitudes on both sides of a centre, what is beyond a bound reflected.
static double around(double centre, double distance, moray_bounds b, int i, int k)
{
    const double side = 2 * part_of(i, k) - 1, step = distance * pow(10, 3 * fabs(side) - 2);
    double value = side < 0 ? centre - step : centre + step;
    if (value < b.lower)
        value = b.lower + (b.lower - value);
    if (value > b.upper)
        value = b.upper - (value - b.upper);
    return value < b.lower ? b.lower : value > b.upper ? b.upper : value;
}

static const struct box {
    const char *what;
    moray_bounds bounds;
    double size, centre;
    bool even, odd; // whether points of that number are over the box, not around a centre
} boxes[] = {
    {"a box", {-3, 2}, 1, 0, true, true},
    {"a small one", {0.01, 0.04}, 0.04, 0, true, true},
    {"the widest that is not wide", {-400, 600}, 1, 0, true, true},
    {"a wide one", {-400, 601}, 1, 100.5, false, true},
    {"one far from 0", {10000, 12000}, 1, 11000, false, true},
    {"one far below 0", {-12000, -10000}, 1, -11000, false, true},
    {"the widest that is a box", {-0.9e9, 1e9}, 1, 0.05e9, false, true},
    {"one that is none", {-1e9, 1e9}, 1, 0, false, false},
    {"one below", {-1.1e9, 5}, 1, 5, false, false},
    {"one above", {-5, 1.1e9}, 1, -5, false, false},
    {"a lower bound", {0.5, ENDLESS}, 0.5, 0.5, false, false},
    {"an upper bound", {-ENDLESS, -7}, 1, -7, false, false},
    {"nothing", {-ENDLESS, ENDLESS}, 1, 0, false, false},
};
enum { boxed = sizeof boxes / sizeof *boxes };

static moray_bounds without_endless(moray_bounds b)
{
    return (moray_bounds){b.lower < -1e9 ? -ENDLESS : b.lower, b.upper > 1e9 ? ENDLESS : b.upper};
}

static double box_wanted(int i, int k)
{
    const struct box *b = &boxes[i];
    return (k % 2 ? b->odd : b->even) ? over(b->bounds, i, k)
                                      : around(b->centre, b->size + fabs(b->centre), without_endless(b->bounds), i, k);
}

static void test_boxes(void)
{
    moray_bounds s[boxed];
    for (int i = 0; i < boxed; i++)
        s[i] = boxes[i].bounds;
    struct phase still = {.ns = boxed, .t0 = {-1, 0}, .tf = {1, 7}};
    const moray_ocp flat = {.phases = 1, .ns = boxed, .s = s, .phase = &still};
    double *in = unset();
    moray_phase_points(&flat, &still, 3, in);
    for (int i = 0; i < boxed; i++) {
        bool seen[parts] = {false};
        for (int k = 1; k < points; k++) {
            const double got = in[k * (boxed + 1) + i], want = box_wanted(i, k);
            CHECK(fabs(got - want) <= 1e-12 * (1 + fabs(want)), "%s at point %d: %.15g, expected %.15g", boxes[i].what,
                  k, got, want);
            CHECK(got >= boxes[i].bounds.lower && got <= boxes[i].bounds.upper, "%s: within the bounds", boxes[i].what);
            const double width = boxes[i].bounds.upper - boxes[i].bounds.lower;
            if (boxes[i].even)
                seen[(int)(parts * (got - boxes[i].bounds.lower) / width)] = true;
        }
        for (int part = 0; part < parts && boxes[i].even; part++)
            CHECK(seen[part], "part %d of input %d is looked at", part, i);
    }
    for (int k = 1; k < points; k++)
        CHECK_NEAR(in[k * (boxed + 1) + boxed], over((moray_bounds){-1, 7}, boxed, k), 1e-12,
                   "time from the first beginning to the last end");
    double first[boxed + 1];
    moray_phase_probe(&flat, &still, 3, first);
    for (int i = 0; i <= boxed; i++)
        CHECK(in[i] == first[i], "the first is that of the trial");
}

static void test_lists_of_points(void)
{
    double *in = unset();
    moray_phase_points(&ocp, &phases[0], 1, in);
    for (int k = 1; k < points; k++)
        check_list(in + 8 * k,
                   (double[]){over(first_x[0], 0, k),
                              k % 2 ? over(first_x[1], 1, k) : around(-1.5, 17 + 1 + 1.5, first_x[1], 1, k),
                              around(-0.125, 0.25 + 0.25 + 0.125, first_x[2], 2, k), over(first_u[0], 3, k),
                              around(3, 1 + 3, first_u[1], 4, k), over(parameters[0], 5, k),
                              around(-6, 1 + 6, parameters[1], 6, k), over((moray_bounds){-0.25, 4}, 7, k)},
                   8, "point of a phase, input");
    CHECK(isnan(in[8 * points]), "so many points");
    in = unset();
    moray_endpoint_points(&ocp, 1, in);
    for (int k = 1; k < points; k++)
        check_list(in + 18 * k,
                   (double[]){over(first_x0[0], 0, k), 7, around(0, 1, first_x0[2], 2, k), over(phases[0].t0, 3, k),
                              over(first_xf[0], 4, k), over(first_xf[1], 5, k), around(-0.25, 0.5, first_xf[2], 6, k),
                              over(phases[0].tf, 7, k), -0.125, over(phases[1].t0, 9, k), over(second_xf[0], 10, k),
                              0.5, around(0, 1, second_q[0], 12, k), over(second_q[1], 13, k),
                              over(second_u0[0], 14, k), over(second_uf[0], 15, k), over(parameters[0], 16, k),
                              around(-6, 1 + 6, parameters[1], 17, k)},
                   18, "point of the ends, input");
    CHECK(isnan(in[18 * points]), "so many points");
    double first[18];
    moray_endpoint_probe(&ocp, 1, first);
    check_list(in, first, 18, "the first is that of the trial");
}

// ---- The boxes ----

static void check_box(const moray_bounds *box, const moray_bounds *const *want, int n)
{
    for (int i = 0; i < n; i++)
        CHECK(box[i].lower == want[i]->lower && box[i].upper == want[i]->upper, "input %d of %d: [%g, %g]", i, n,
              box[i].lower, box[i].upper);
    CHECK(box[n].lower == 77, "no more than %d", n);
}

static void test_box(void)
{
    moray_bounds box[20];
    const moray_bounds time = {-0.25, 4}, *t[] = {&phases[0].t0, &phases[0].tf, &phases[1].t0, &phases[1].tf};
    for (int i = 0; i < 20; i++)
        box[i] = moray_fixed(77);
    moray_phase_box(&ocp, &phases[0], box);
    check_box(box,
              (const moray_bounds *[]){first_x, first_x + 1, first_x + 2, first_u, first_u + 1, parameters,
                                       parameters + 1, &time},
              8);
    moray_endpoint_box(&ocp, box);
    check_box(box,
              (const moray_bounds *[]){first_x, first_x + 1, first_x + 2, t[0], first_x, first_x + 1, first_x + 2, t[1],
                                       second_x, t[2], second_x, t[3], second_q, second_q + 1, second_u, second_u,
                                       parameters, parameters + 1},
              18);
}

int main(void)
{
    test_sizes();
    test_lists_of_sizes();
    for (int trial = 0; trial < 4; trial++)
        test_probe(trial);
    test_probe_at_bound();
    test_boxes();
    test_lists_of_points();
    test_box();
    return tap_done();
}
