// SPDX-License-Identifier: MIT
//
// The values of an axis as a user writes them: every number of a range by its closed form, refusals by their whole
// text.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/app/sweep.h"

static moray_status read_values(const char *written, double **value, const char ***word, int *n)
{
    static char text[200]; // words point into it
    snprintf(text, sizeof text, "%s", written);
    return moray_sweep_values(text, value, word, n);
}

static void check_numbers(const char *written, const double *expected, int count)
{
    double *value;
    const char **word;
    int n;
    CHECK_OK(read_values(written, &value, &word, &n), written);
    CHECK(value && !word && n == count, "%s: %d numbers", written, n);
    for (int k = 0; value && k < n && k < count; k++)
        CHECK_NEAR(value[k], expected[k], 0, written);
    free(value);
}

static void test_numbers(void)
{
    check_numbers("1:9:5", (const double[]){1, 3, 5, 7, 9}, 5);
    check_numbers("6:-3:4", (const double[]){6, 3, 0, -3}, 4);
    check_numbers("3:5:2", (const double[]){3, 5}, 2);
    check_numbers("-4:-4:1", (const double[]){-4}, 1);
    check_numbers("2:2:3", (const double[]){2, 2, 2}, 3);
    check_numbers("4,1e1,-2,4", (const double[]){4, 10, -2, 4}, 4);
    check_numbers("-7", (const double[]){-7}, 1);
}

// A count exactly at its limit is taken; its middle is the middle of the range.
static void test_most(void)
{
    double *value;
    const char **word;
    int n;
    CHECK_OK(read_values("0:999999:1000000", &value, &word, &n), "a million values");
    CHECK(n == 1000000 && value[1] == 1 && value[500000] == 500000 && value[n - 1] == 999999, "a million integers");
    free(value);
}

static void test_words(void)
{
    static const char *const expected[] = {"5", "nanny", "low:high", "-info", "6"};
    double *value;
    const char **word;
    int n;
    CHECK_OK(read_values("5,nanny,low:high,-info,6", &value, &word, &n), "words");
    CHECK(n == 5 && word && !value, "%d words, numbers among them", n);
    for (int k = 0; word && k < n && k < 5; k++)
        CHECK(strcmp(word[k], expected[k]) == 0, "%s is %s", word[k], expected[k]);
    free(word);
}

static void test_refusals(void)
{
#define A_RANGE ": must be LOW:HIGH:COUNT, finite, with a count within 1:1000000, or V,V,..."
    static const struct {
        const char *written, *text;
    } cases[] = {
        {"1:2", "1:2" A_RANGE},
        {"x:2:3", "x:2:3" A_RANGE},
        {"1:y:3", "1:y:3" A_RANGE},
        {"1:2:z", "1:2:z" A_RANGE},
        {"1:2:0", "1:2:0" A_RANGE},
        {"1:2:-3", "1:2:-3" A_RANGE},
        {"1:2:2.5", "1:2:2.5" A_RANGE},
        {"1:2:3:4", "1:2:3:4" A_RANGE},
        {"0:1:1000001", "0:1:1000001" A_RANGE},
        {"-1:2:1", "-1:2:1: one value cannot be both -1 and 2: give it alone"},
        {"", "value 1 of the list is empty"},
        {",a", "value 1 of the list is empty"},
        {"1,,2", "value 2 of the list is empty"},
        {"1,2,", "value 3 of the list is empty"},
        {"a,b,NaN", "value 3 of the list, NaN: must be finite"},
        {"a,-Inf,b", "value 2 of the list, -Inf: must be finite"},
        {"+infinity,1", "value 1 of the list, +infinity: must be finite"},
    };
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        double *value;
        const char **word;
        int n;
        const moray_status status = read_values(cases[k].written, &value, &word, &n);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, cases[k].text) == 0, "\"%s\" is refused: %s",
              cases[k].written, status.text);
        CHECK(!value && !word, "and nothing is left of it");
    }
}

int main(void)
{
    test_numbers();
    test_most();
    test_words();
    test_refusals();
    return tap_done();
}
