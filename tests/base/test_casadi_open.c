// SPDX-License-Identifier: MIT
//
// What a function after CasADi's C convention must have to be taken: numbers of arguments, matrices in compressed
// columns, room, memory. The functions are this program's own.
#include "tap.h"

#include <dlfcn.h>
#include <string.h>

#include "base/casadi.h"

#define EXPORT __attribute__((visibility("default")))

// ---- A function as a test wants it ----

static struct wish {
    long long n_in, n_out;
    const long long *first, *shape; // of the first argument and result, of all others
    int work_fails;
    long long work[4]; // arguments, results, integers, numbers
    int memory, init, fails;
} wish;
static int taken, holders; // memories
static void *program;

EXPORT long long made_n_in(void);
EXPORT long long made_n_in(void)
{
    return wish.n_in;
}

EXPORT long long made_n_out(void);
EXPORT long long made_n_out(void)
{
    return wish.n_out;
}

EXPORT const long long *made_sparsity_in(long long i);
EXPORT const long long *made_sparsity_in(long long i)
{
    return i >= wish.n_in ? NULL : i > 0 ? wish.shape : wish.first;
}

EXPORT const long long *made_sparsity_out(long long i);
EXPORT const long long *made_sparsity_out(long long i)
{
    return i >= wish.n_out ? NULL : i > 0 ? wish.shape : wish.first;
}

EXPORT int made_work(long long *args, long long *results, long long *integers, long long *numbers);
EXPORT int made_work(long long *args, long long *results, long long *integers, long long *numbers)
{
    *args = wish.work[0], *results = wish.work[1], *integers = wish.work[2], *numbers = wish.work[3];
    return wish.work_fails;
}

EXPORT void made_incref(void);
EXPORT void made_incref(void)
{
    holders++;
}

EXPORT void made_decref(void);
EXPORT void made_decref(void)
{
    holders--;
}

EXPORT int made_alloc_mem(void);
EXPORT int made_alloc_mem(void)
{
    taken += wish.memory >= 0;
    return wish.memory;
}

EXPORT int made_init_mem(int memory);
EXPORT int made_init_mem(int memory)
{
    return memory == wish.memory ? wish.init : 99;
}

EXPORT void made_free_mem(int memory);
EXPORT void made_free_mem(int memory)
{
    taken -= memory == wish.memory;
}

// Every result is twice the argument of its number, in all of the room that _work asked for.
EXPORT int made(const double **arg, double **res, long long *iw, double *w, int memory);
EXPORT int made(const double **arg, double **res, long long *iw, double *w, int memory)
{
    for (long long k = 0; k < wish.n_out; k++)
        for (long long i = 0; i < (k > 0 ? 2 : 3); i++)
            res[k][i] = memory == wish.memory ? 2 * arg[k][i] : 0;
    for (long long k = 0; k < wish.work[2]; k++)
        iw[k] = 7;
    for (long long k = 0; k < wish.work[3]; k++)
        w[k] = 7;
    for (long long k = wish.n_in; k < wish.work[0]; k++)
        arg[k] = NULL;
    for (long long k = wish.n_out; k < wish.work[1]; k++)
        res[k] = NULL;
    return wish.fails;
}

// Another one, of a scalar, that lends its memory.
EXPORT int lent(const double **arg, double **res, long long *iw, double *w, int memory);
EXPORT int lent(const double **arg, double **res, long long *iw, double *w, int memory)
{
    (void)iw, (void)w;
    res[0][0] = memory * arg[0][0];
    return 0;
}

EXPORT int lent_checkout(void);
EXPORT int lent_checkout(void)
{
    return made_alloc_mem();
}

EXPORT int lent_init_mem(int memory); // which is not asked where memory is lent
EXPORT int lent_init_mem(int memory)
{
    (void)memory;
    return 1;
}

EXPORT void lent_release(int memory);
EXPORT void lent_release(int memory)
{
    made_free_mem(memory);
}

// ---- What is taken and what is not ----

static const long long pair[] = {2, 1, 1}, triple[] = {3, 1, 1};

static struct wish usual(void)
{
    return (struct wish){.n_in = 2, .n_out = 2, .first = triple, .shape = pair, .work = {2, 2, 0, 0}, .memory = 3};
}

// text: NULL where it is taken. Whatever happens, no memory stays.
static void check_taken(const char *name, const char *text, const char *what)
{
    struct casadi_function f;
    const moray_status status = moray_casadi_open(&f, program, name);
    if (text)
        CHECK(status.code == MORAY_INPUT && strstr(status.text, text), "%s: refused: %s", what, status.text);
    else
        CHECK(!moray_failed(status), "%s: taken %s", what, status.text);
    CHECK(moray_failed(status) || strcmp(name, "made") != 0 || holders == 1, "and held");
    moray_casadi_close(&f);
    CHECK(taken == 0 && holders == 0, "and what was taken, or held, is given back");
    taken = holders = 0;
}

static void check_shape(const long long *shape, const int *position, int n, const char *what)
{
    struct casadi_function f;
    wish = usual();
    wish.shape = shape;
    const moray_status status = moray_casadi_open(&f, program, "made");
    CHECK(!moray_failed(status) && f.in[1].rows == shape[0] && f.in[1].cols == shape[1] && f.in[1].nnz == n,
          "%s: %d entries %s", what, f.in ? f.in[1].nnz : -1, status.text);
    for (int k = 0; k < n && !moray_failed(status); k++)
        CHECK(f.in[1].position[k] == position[k] && f.out[1].position[k] == position[k], "entry %d at %d", k,
              f.in[1].position[k]);
    if (!moray_failed(status))
        CHECK(moray_casadi_entries(f.in, 2) == 3 + shape[0] * shape[1], "in matrices of %d places together",
              moray_casadi_entries(f.in, 2));
    moray_casadi_close(&f);
}

static void test_shapes(void)
{
    static long long most_rows[] = {1000000, 1, 0, 0}, too_many_rows[] = {1000001, 1, 0, 0};
    static long long most_cols[1000004] = {1, 1000000}, too_many_cols[1000005] = {1, 1000001};
    static long long too_large[1004] = {1000000, 1001}, largest[1003] = {1000000, 1000};
    check_shape(pair, (int[]){0, 1}, 2, "dense in short");
    check_shape((long long[]){2, 3, 1}, (int[]){0, 1, 2, 3, 4, 5}, 6, "dense in short, of columns");
    check_shape((long long[]){2, 1, 0, 2, 0, 1}, (int[]){0, 1}, 2, "dense in full");
    check_shape((long long[]){3, 2, 0, 1, 3, 2, 0, 2}, (int[]){2, 3, 5}, 3, "each column begins anew");
    check_shape((long long[]){3, 3, 0, 0, 1, 1, 1}, (int[]){4}, 1, "columns without any");
    check_shape((long long[]){0, 0, 0}, NULL, 0, "nothing at all");
    check_shape(most_rows, NULL, 0, "a million rows");
    check_shape(most_cols, NULL, 0, "a million columns");
    check_shape(largest, NULL, 0, "a thousand million places");
    const struct {
        const long long *shape;
        const char *what;
    } unsound[] = {{(long long[]){-1, 1, 1}, "rows below 0"},
                   {(long long[]){1, -1, 0, 0}, "columns below 0"},
                   {too_many_rows, "more than a million rows"},
                   {too_many_cols, "more than a million columns"},
                   {too_large, "more than a thousand million places"},
                   {(long long[]){3, 2, 0, -1, 0, 0}, "a column that ends before 0"},
                   {(long long[]){3, 3, 0, 2, 1, 2, 0, 1, 0}, "columns that descend"},
                   {(long long[]){2, 1, 0, 3, 0, 1, 1}, "more entries than places"},
                   {(long long[]){3, 1, 0, 2, 1, 1}, "a row twice"},
                   {(long long[]){3, 1, 0, 2, 2, 1}, "rows that descend"},
                   {(long long[]){3, 1, 0, 1, -1}, "a row below 0"},
                   {(long long[]){3, 2, 0, 1, 2, 0, -1}, "in another column, too"},
                   {(long long[]){3, 1, 0, 1, 3}, "a row behind the last"},
                   {(long long[]){3, 2, 0, 1, 2, 0, 3}, "in another column, too"},
                   {(long long[]){3, 1, 2, 2, 0, 1}, "a first column that begins late"},
                   {NULL, "no matrix"}};
    for (size_t k = 0; k < sizeof unsound / sizeof *unsound; k++) {
        wish = usual();
        wish.shape = unsound[k].shape;
        check_taken("made", "made_sparsity_in(1): is no matrix", unsound[k].what);
    }
}

static void test_counts(void)
{
    static const struct {
        long long n_in, n_out;
        const char *text;
    } counts[] = {{0, 0, NULL},
                  {9999, 1, NULL},
                  {1, 9999, NULL},
                  {-1, 1, "made_n_in is -1"},
                  {1, -1, "made_n_out is -1"},
                  {10000, 1, "made_n_in is 10000"},
                  {1, 10000, "made_n_out is 10000"}};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        wish = usual();
        wish.n_in = wish.work[0] = counts[k].n_in;
        wish.n_out = wish.work[1] = counts[k].n_out;
        check_taken("made", counts[k].text, "arguments, results");
    }
    char name[200];
    memset(name, 'x', sizeof name);
    name[128] = 0;
    check_taken(name, "must be a name of less than 128 bytes", "a long name");
    name[127] = 0;
    check_taken(name, "there is no function", "one that fits");
}

static void test_room(void)
{
    static const struct {
        long long work[4];
        const char *text;
    } rooms[] = {{{2, 2, 0, 0}, NULL},
                 {{5, 4, 3, 2}, NULL},
                 {{1, 2, 0, 0}, "asks for less"},
                 {{2, 1, 0, 0}, "asks for less"},
                 {{2, 2, -1, 0}, "asks for less"},
                 {{2, 2, 0, -1}, "asks for less"}};
    for (size_t k = 0; k < sizeof rooms / sizeof *rooms; k++) {
        wish = usual();
        memcpy(wish.work, rooms[k].work, sizeof wish.work);
        check_taken("made", rooms[k].text, "room");
    }
    wish = usual();
    wish.work_fails = 1;
    check_taken("made", "made_work fails", "room that cannot be told");
}

static void test_memory(void)
{
    wish = usual();
    for (wish.memory = 0; wish.memory < 2; wish.memory++) {
        check_taken("made", NULL, "memory");
        check_taken("lent", NULL, "memory lent");
    }
    wish.memory = -1;
    check_taken("made", "made gives no memory", "no memory");
    check_taken("lent", "lent gives no memory", "none lent");
    wish.memory = 3, wish.init = 1;
    check_taken("made", "made gives no memory", "memory that does not begin");
}

static void test_evaluation(void)
{
    struct casadi_function f;
    wish = usual();
    wish.work[0] = 4, wish.work[1] = 5, wish.work[2] = 5, wish.work[3] = 6;
    CHECK_OK(moray_casadi_open(&f, program, "made"), "made");
    for (wish.fails = 0; wish.fails < 2; wish.fails++) {
        for (int k = 0; k < 5; k++)
            *(k < 3 ? &f.in[0].value[k] : &f.in[1].value[k - 3]) = 1.5 - k;
        const bool good = moray_casadi_evaluate(&f);
        CHECK(good == !wish.fails, "fails where it does");
        for (int k = 0; k < 5; k++) {
            const double got = k < 3 ? f.out[0].value[k] : f.out[1].value[k - 3];
            CHECK(good ? got == 3 - 2 * k : isnan(got), "evaluated in its memory: %g", got);
        }
    }
    moray_casadi_close(&f);
    CHECK(taken == 0 && !f.in && !f.arg, "nothing is left");
    moray_casadi_close(&f);
}

int main(void)
{
    program = dlopen(NULL, RTLD_NOW);
    CHECK(moray_casadi_has(program, "made") && !moray_casadi_has(program, "unmade"), "functions by their names");
    test_shapes();
    test_counts();
    test_room();
    test_memory();
    test_evaluation();
    dlclose(program);
    return tap_done();
}
