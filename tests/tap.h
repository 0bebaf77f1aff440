// SPDX-License-Identifier: MIT
//
// Test Anything Protocol in a header: CHECK states one thing; main ends with `return tap_done();`.
#ifndef TESTS_TAP_H
#define TESTS_TAP_H

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static int tap_run, tap_failed;

__attribute__((format(printf, 4, 5))) static inline bool tap_check(bool ok, const char *file, int line,
                                                                   const char *format, ...)
{
    char text[2000];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    for (char *c = text; *c; c++)
        *c = *c == '\n' ? ' ' : *c; // a test is one line
    printf("%s %d - %s", ok ? "ok" : "not ok", ++tap_run, text);
    if (!ok)
        printf(" (%s:%d)", file, line);
    printf("\n");
    tap_failed += !ok;
    return ok;
}

static inline int tap_done(void)
{
    printf("1..%d\n", tap_run);
    fflush(stdout);
    return tap_failed != 0;
}

// CHECK(condition, "what is claimed %g", ...)
#define CHECK(condition, ...) tap_check((condition), __FILE__, __LINE__, __VA_ARGS__)

static inline bool tap_near(double got, double want, double tolerance, const char *what, const char *file, int line)
{
    return tap_check(fabs(got - want) <= tolerance, file, line, "%s: %.10g, expected %.10g", what, got, want);
}

static inline bool tap_relative(double got, double want, double tolerance, const char *what, const char *file, int line)
{
    return tap_check(fabs(got - want) <= tolerance * (1 + fabs(want)), file, line, "%s: %.12g, expected %.12g", what,
                     got, want);
}

// |got - want| <= tolerance, with both numbers in the text; a NaN fails.
#define CHECK_NEAR(got, want, tolerance, what) tap_near((got), (want), (tolerance), (what), __FILE__, __LINE__)

// |got - want| <= tolerance (1 + |want|)
#define CHECK_RELATIVE(got, want, tolerance, what) tap_relative((got), (want), (tolerance), (what), __FILE__, __LINE__)

// The larger of both; a NaN, which fmax passes over, is the worst.
static inline double tap_worse(double worst, double error)
{
    return isnan(error) ? INFINITY : fmax(worst, error);
}

// A failed status shows its text.
#define CHECK_OK(status, what)                                                                                         \
    do {                                                                                                               \
        moray_status tap_status_ = (status);                                                                           \
        tap_check(!moray_failed(tap_status_), __FILE__, __LINE__, "%s: %s", (what), tap_status_.text);                 \
    } while (0)

// False in the sanitizers' half of tests/run.sh, for long checks of what shorter ones reach too.
static inline bool tap_thorough(void)
{
    return !getenv("MORAY_TESTS_BRIEF");
}

// Repeatable uniform random number in [low, high) (SplitMix64).
static inline double tap_random(unsigned long long *seed, double low, double high)
{
    unsigned long long z = (*seed += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    z ^= z >> 31;
    return low + (high - low) * (double)(z >> 11) * 0x1.0p-53;
}

#endif
