// SPDX-License-Identifier: MIT
#include "tap.h"

#include <locale.h>

#include "moray/clock.h"
#include "moray/number.h"

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
    double odd[] = {5, 1, 3}, even[] = {4, 1, 3, 2}, single[] = {7};
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

int main(void)
{
    test_texts();
    test_quantiles();
    test_clocks();
    return tap_done();
}
