// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // uselocale
#include "tap.h"

#include <limits.h>
#include <locale.h>

#include "base/number.h"
#include "moray/clock.h"

static void test_texts(void)
{
    static const struct {
        const char *text;
        double number;
    } good[] = {{"1", 1}, {" -2.5e-1\t\n", -0.25}, {".5", 0.5}, {"+3.", 3}};
    static const char *const wrong[] = {NULL, "", " ", "1x", "0x10", "nan", "inf", "1e999", "1 2", "1,5", "--1", "e5"};
    double number;
    for (unsigned k = 0; k < sizeof good / sizeof *good; k++)
        CHECK(moray_number_read(good[k].text, &number) && number == good[k].number, "\"%s\" is %g", good[k].text,
              number);
    for (unsigned k = 0; k < sizeof wrong / sizeof *wrong; k++)
        CHECK(!moray_number_read(wrong[k], &number), "\"%s\" is no number", wrong[k] ? wrong[k] : "NULL");
    if (setlocale(LC_NUMERIC, "de_DE.UTF-8") || setlocale(LC_NUMERIC, "de_DE"))
        CHECK(moray_number_read("0.5", &number) && number == 0.5, "whatever the locale");
    setlocale(LC_NUMERIC, "C");
}

static void test_quantiles(void)
{
    double odd[] = {5, 1, 3}, even[] = {4, 1, 3, 2, NAN}, single[] = {7, NAN};
    CHECK(moray_quantile(odd, 3, 0.5) == 3 && odd[0] == 1 && odd[2] == 5, "the middle one of three, which are sorted");
    CHECK(moray_quantile(even, 4, 0.5) == 2.5, "half-way between the middle ones of four");
    CHECK(moray_quantile(even, 4, 0) == 1 && moray_quantile(even, 4, 1) == 4, "the ends");
    CHECK_NEAR(moray_quantile(even, 4, 0.9), 3.7, 1e-15, "between the two nearest");
    CHECK(moray_quantile(single, 1, 0.9) == 7, "of one");
    CHECK(isnan(moray_quantile(single, 0, 0.5)), "of none");
}

static void test_clocks(void)
{
    const double clock = moray_clock(), processor = moray_processor_clock();
    volatile double sum = 0;
    while (moray_processor_clock() - processor < 0.02)
        sum += 1;
    CHECK(sum > 0 && moray_clock() - clock >= 0.019, "what takes the processor takes time: %g s",
          moray_clock() - clock);
}

static void test_counts(void)
{
    static const double counts[] = {-1, NAN, 0, 0.1, 1, 1.5, INT_MAX, 1e18, INFINITY};
    static const int want[] = {0, 0, 0, 1, 1, 2, INT_MAX, INT_MAX, INT_MAX};
    for (int k = 0; k < 9; k++)
        CHECK(moray_count_up(counts[k]) == want[k], "%g is counted as %d", counts[k], moray_count_up(counts[k]));
    const double values[] = {1, INFINITY, 2, NAN, -INFINITY};
    for (int k = 0; k < 5; k++)
        CHECK(moray_all_finite(values + k, 1) == (k % 2 == 0 && k < 4), "%g", values[k]);
    CHECK(moray_all_finite(values + 1, 0) && !moray_all_finite(values, 2) && !moray_all_finite(values + 2, 2),
          "of none and of two");
}

// Numbers have points in between, and what they had before behind.
static void test_locale(void)
{
    const locale_t own = newlocale(LC_ALL_MASK, "C.UTF-8", (locale_t)0), usual = uselocale(own);
    CHECK(own && uselocale((locale_t)0) == own, "a locale of its own");
    const locale_t before = moray_c_locale_begin();
    CHECK(before == own && uselocale((locale_t)0) != own, "is left");
    moray_c_locale_end(before);
    CHECK(uselocale((locale_t)0) == own, "and comes back");
    uselocale(usual);
    freelocale(own);
}

int main(void)
{
    test_locale();
    test_counts();
    test_texts();
    test_quantiles();
    test_clocks();
    return tap_done();
}
