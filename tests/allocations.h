// SPDX-License-Identifier: MIT
//
// Allocations that fail, each of a run once, and blocks that a run leaves behind. The linker leads the library's calls
// here (--wrap), those of its dependencies not. Included once by a test.
#ifndef TESTS_ALLOCATIONS_H
#define TESTS_ALLOCATIONS_H

#include "tap.h"

#include "moray/status.h"

static long calls, fatal; // allocations so far; the one that fails, 0 for none
static long blocks;       // that are not freed yet
static long uneven;       // runs that left more of them than there were, or fewer

static bool fails(void)
{
    return ++calls == fatal;
}

static void *counted(void *block)
{
    blocks += block != NULL;
    return block;
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__real_realloc(void *block, size_t size);
char *__real_strdup(const char *text);
void __real_free(void *block);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *block, size_t size);
char *__wrap_strdup(const char *text);
void __wrap_free(void *block);

void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : counted(__real_malloc(size));
}

void *__wrap_calloc(size_t n, size_t size)
{
    return fails() ? NULL : counted(__real_calloc(n, size));
}

void *__wrap_realloc(void *block, size_t size)
{
    if (fails())
        return NULL;
    return block ? __real_realloc(block, size) : counted(__real_realloc(NULL, size));
}

char *__wrap_strdup(const char *text)
{
    return fails() ? NULL : counted(__real_strdup(text));
}

void __wrap_free(void *block)
{
    blocks -= block != NULL;
    __real_free(block);
}

// may_do_without: a run may end well with less memory.
static void fail_each(const char *what, bool may_do_without, moray_status (*run)(void))
{
    const long step = tap_thorough() ? 1 : 3;
    long k = 0, wrong = 0, last = 0;
    moray_status status, odd = moray_ok();
    do {
        const long before = blocks;
        calls = 0;
        fatal = k += step;
        status = run();
        uneven += blocks != before;
        if (calls >= fatal && status.code != MORAY_MEMORY && !(may_do_without && status.code == MORAY_OK)) {
            wrong++;
            last = k;
            odd = status;
        }
    } while (calls >= fatal);
    fatal = 0;
    CHECK_OK(status, what);
    CHECK(k > 2, "%s: %ld allocations, every %ld.", what, k - 1, step);
    CHECK(wrong == 0, "%s: each reported as out of memory; %ld are not, the last, %ld, as '%s: %s'", what, wrong, last,
          moray_code_text(odd.code), odd.text);
}

#endif
