// SPDX-License-Identifier: MIT
//
// What is asked of observations, with the texts of all that is refused; what they make of the times and events of their
// phase.
#include "tap.h"

#include <string.h>

#include "ocp/observe/observed.h"

// ---- What is asked ----

static void see(const moray_node *at, moray_num *y, const void *data)
{
    (void)at, (void)data;
    y[0] = 0;
}

// Of three times and two channels; a fourth time, a seventh value and a third weight are not of it, and not right.
static const double times[] = {5, 1, 2, 99}, values[] = {1, NAN, -3, 4, 5, 6, INFINITY}, weights[] = {0, 2, -1};
static const moray_observations good = {
    .n = 3, .ny = 2, .time = times, .value = values, .weight = weights, .observe = see, .threshold = -1};

static struct phase wire(void)
{
    return (struct phase){
        .name = "wire", .nx = 2, .nu = 1, .ns = 3, .t0 = moray_between(1, 2), .tf = moray_between(4, 5)};
}

static void refuse(const moray_observations *given, const char *expected)
{
    const struct phase phase = wire();
    char text[200];
    snprintf(text, sizeof text, "observations of phase wire: %s", expected);
    const moray_status status = moray_check_observations(&phase, given);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, text) == 0, "\"%s\" is told: \"%s\"", text, status.text);
}

static void test_counts(void)
{
    const struct phase phase = wire();
    moray_observations given = good;
    CHECK_OK(moray_check_observations(&phase, &given), "as it should be");
    given.weight = NULL;
    CHECK_OK(moray_check_observations(&phase, &given), "without weights");
    given.ny = 1;
    CHECK_OK(moray_check_observations(&phase, &given), "one channel");
    given = good, given.n = 0;
    CHECK_OK(moray_check_observations(&phase, &given), "no times");
    given.n = -1;
    refuse(&given, "n -1, ny 2; need times, values and a channel");
    given = good, given.ny = 0;
    refuse(&given, "n 3, ny 0; need times, values and a channel");
    given = good, given.time = NULL;
    refuse(&given, "n 3, ny 2; need times, values and a channel");
    given = good, given.value = NULL;
    refuse(&given, "n 3, ny 2; need times, values and a channel");
}

static void test_function(void)
{
    const struct phase phase = wire();
    const moray_map right = {.n_in = 7, .n_out = 2}, narrow = {.n_in = 6, .n_out = 2}, tall = {.n_in = 7, .n_out = 3};
    moray_observations given = good;
    given.observe = NULL;
    refuse(&given, "need a function or a map, and only one");
    given.map = &right;
    CHECK_OK(moray_check_observations(&phase, &given), "a map");
    given.map = &narrow;
    refuse(&given, "the map has 6 inputs and 2 outputs, needs 7 and 2");
    given.map = &tall;
    refuse(&given, "the map has 7 inputs and 3 outputs, needs 7 and 2");
    given = good, given.map = &right;
    refuse(&given, "need a function or a map, and only one");
    given = good, given.loss = MORAY_HUBER;
    refuse(&given, "the threshold of Huber's loss is -1, must be > 0");
    given.threshold = 0;
    refuse(&given, "the threshold of Huber's loss is 0, must be > 0");
    given.threshold = INFINITY;
    refuse(&given, "the threshold of Huber's loss is inf, must be > 0");
    given.threshold = NAN;
    refuse(&given, "the threshold of Huber's loss is nan, must be > 0");
    given.threshold = 1e-3;
    CHECK_OK(moray_check_observations(&phase, &given), "a threshold");
}

static void test_data(void)
{
    const double early[] = {5, 1, 0.75}, late[] = {5, 5.25, 1}, none[] = {NAN, 1, 2};
    const double first[] = {-INFINITY, 1, 2, 3, 4, 5}, fourth[] = {0, 1, 2, INFINITY, 4, 5},
                 fifth[] = {0, 1, 2, 3, INFINITY, 5}, last[] = {0, 1, 2, 3, 4, -INFINITY};
    const double minus[] = {1, -0.5}, endless[] = {INFINITY, 1}, no_number[] = {NAN, 1};
    const struct {
        const double *time, *value, *weight;
        const char *told;
    } wrong[] = {{early, values, weights, "time[2] = 0.75 is not within [1, 5]"},
                 {late, values, weights, "time[1] = 5.25 is not within [1, 5]"},
                 {none, values, weights, "time[0] = nan is not within [1, 5]"},
                 {times, first, weights, "value[0][0] is infinite"},
                 {times, fourth, weights, "value[1][1] is infinite"},
                 {times, fifth, weights, "value[2][0] is infinite"},
                 {times, last, weights, "value[2][1] is infinite"},
                 {times, values, minus, "weight[1] = -0.5, must not be negative"},
                 {times, values, endless, "weight[0] = inf, must not be negative"},
                 {times, values, no_number, "weight[0] = nan, must not be negative"}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        moray_observations given = good;
        given.time = wrong[k].time, given.value = wrong[k].value, given.weight = wrong[k].weight;
        refuse(&given, wrong[k].told);
    }
}

// ---- What they make of a phase ----

static void test_hold(void)
{
    struct phase phase = {.t0 = moray_between(-1, 4), .tf = moray_between(2, 9)};
    const double in[] = {3, 6, 2.5, 5, -7, 20};
    moray_hold_observations(&phase, &(moray_observations){.n = 4, .time = in});
    CHECK(phase.t0.lower == -1 && phase.t0.upper == 2.5 && phase.tf.lower == 6 && phase.tf.upper == 9,
          "it begins before the first, within [%g, %g], and ends after the last, within [%g, %g]", phase.t0.lower,
          phase.t0.upper, phase.tf.lower, phase.tf.upper);
    struct phase both = {.t0 = moray_between(-1, 4), .tf = moray_between(2, 9)};
    moray_hold_observations(&both, &(moray_observations){.n = 5, .time = in});
    CHECK(both.t0.upper == -7 && both.tf.lower == 6, "the first may come last");
    moray_hold_observations(&both, &(moray_observations){.n = 6, .time = in});
    CHECK(both.t0.upper == -7 && both.tf.lower == 20, "and so may the last");
    moray_hold_observations(&phase, &(moray_observations){.n = 1, .time = in});
    CHECK(phase.t0.upper == 2.5 && phase.tf.lower == 6, "which data in between leave");
    phase.observed.n = 1;
    CHECK(moray_data_move(&phase), "they move where both times are free");
    phase.t0 = moray_fixed(2);
    CHECK(moray_data_move(&phase), "or one, the last");
    phase.tf = moray_fixed(6);
    CHECK(!moray_data_move(&phase), "and not where none is");
    phase.t0 = moray_between(1, 2);
    CHECK(moray_data_move(&phase), "or the first");
    phase.observed.n = 0;
    CHECK(!moray_data_move(&phase), "nor where there are none");
}

static void test_events(void)
{
    enum { n = 2, ny = 3, all = 4 };
    double value[] = {7, NAN, 8, 9, 1, NAN, 5, 5, 5};
    moray_bounds residual[] = {moray_between(-1, 2), moray_between(-3, 4), moray_between(-5, 6)};
    const int time_of[all + 1] = {0, 0, 1, 1, n}, channel_of[all] = {0, 2, 0, 1};
    struct observed o = {.n = n, .ny = ny, .value = value, .residual = residual, .sum = moray_at_most(11)};
    CHECK(moray_observed_events(&o) == all, "an event for each value that is there, and nothing asked of the sum");
    o.has_sum = true;
    CHECK(moray_observed_events(&o) == all + 1, "and one of the sum");
    for (int i = 0, k, j; i <= all; i++) {
        const moray_bounds got = moray_observed_event(&o, i, &k, &j), want = i < all ? residual[channel_of[i]] : o.sum;
        CHECK(k == time_of[i] && (i == all || j == channel_of[i]) && got.lower == want.lower && got.upper == want.upper,
              "event %d: time %d, channel %d, within [%g, %g]", i, k, j, got.lower, got.upper);
    }
    for (int k = 0; k < n; k++)
        for (int j = 0; j < ny; j++)
            CHECK(moray_has_residual_event(&o, k, j) == !isnan(value[k * ny + j]), "value %d, %d", k, j);
    o.residual = NULL;
    CHECK(moray_observed_events(&o) == 1 && !moray_has_residual_event(&o, 0, 0), "the sum alone");
}

int main(void)
{
    test_counts();
    test_function();
    test_data();
    test_hold();
    test_events();
    return tap_done();
}
