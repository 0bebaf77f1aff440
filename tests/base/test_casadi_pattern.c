// SPDX-License-Identifier: MIT
//
// Derivatives after CasADi's convention: their patterns against dense matrices cut into blocks, and what is refused.
// The functions are this program's own.
#include "tap.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "base/casadi_map.h"

#define EXPORT __attribute__((visibility("default")))

enum { MOST = 20, ARGUMENTS = 5, RESULTS = 8, INPUTS = 7 }; // functions' arguments and results; entries of all
typedef long long shape[64];                                // compressed columns

static struct made {
    int n_in, n_out;
    shape in[MOST], out[MOST];
} value_made, jac_made, adjoint_made;

#define FUNCTION(name, made)                                                                                           \
    EXPORT long long name##_n_in(void);                                                                                \
    EXPORT long long name##_n_in(void)                                                                                 \
    {                                                                                                                  \
        return (made).n_in;                                                                                            \
    }                                                                                                                  \
    EXPORT long long name##_n_out(void);                                                                               \
    EXPORT long long name##_n_out(void)                                                                                \
    {                                                                                                                  \
        return (made).n_out;                                                                                           \
    }                                                                                                                  \
    EXPORT const long long *name##_sparsity_in(long long i);                                                           \
    EXPORT const long long *name##_sparsity_in(long long i)                                                            \
    {                                                                                                                  \
        return (made).in[i];                                                                                           \
    }                                                                                                                  \
    EXPORT const long long *name##_sparsity_out(long long i);                                                          \
    EXPORT const long long *name##_sparsity_out(long long i)                                                           \
    {                                                                                                                  \
        return (made).out[i];                                                                                          \
    }                                                                                                                  \
    EXPORT int name(const double **arg, double **res, long long *iw, double *w, int memory);                           \
    EXPORT int name(const double **arg, double **res, long long *iw, double *w, int memory)                            \
    {                                                                                                                  \
        return (void)arg, (void)res, (void)iw, (void)w, memory;                                                        \
    }

FUNCTION(value, value_made)
FUNCTION(jac_value, jac_made)
FUNCTION(jac_adj1_value, adjoint_made)

// ---- Derivatives as they should be ----

static const int rows_in[] = {2, 3}, rows_out[] = {2, 2, 1}, cols_out[] = {2, 1, 2}, top[] = {0, 4, 6}; // of columns
static const int place[] = {5, 0, 3, 6, 1}; // of their entries among the inputs
static bool slopes[RESULTS][ARGUMENTS], bends[ARGUMENTS][ARGUMENTS];

// The part of a dense matrix of `stride` columns from an entry on; NULL: without a nonzero.
static void cut(long long *s, const bool *from, int stride, int rows, int cols)
{
    long long *start = s + 2, *row = start + cols + 1, n = 0;
    s[0] = rows, s[1] = cols, start[0] = 0;
    for (int c = 0; c < cols; c++) {
        for (int r = 0; r < rows; r++)
            if (from && from[r * stride + c])
                row[n++] = r;
        start[c + 1] = n;
    }
}

static void dense(long long *s, int rows, int cols)
{
    memcpy(s, (long long[]){rows, cols, 1}, 3 * sizeof *s);
}

static void describe_arguments(struct made *made, int n_in)
{
    made->n_in = n_in;
    for (int k = 0; k < n_in; k++) {
        if (k < 2)
            dense(made->in[k], rows_in[k], 1);
        else
            dense(made->in[k], rows_out[(k - 2) % 3], cols_out[(k - 2) % 3]);
    }
}

static void describe(void)
{
    describe_arguments(&value_made, 2);
    describe_arguments(&jac_made, 5);
    describe_arguments(&adjoint_made, 8);
    value_made.n_out = 3, jac_made.n_out = 6, adjoint_made.n_out = 16;
    for (int i = 0; i < 3; i++) {
        dense(value_made.out[i], rows_out[i], cols_out[i]);
        for (int j = 0; j < 2; j++)
            cut(jac_made.out[2 * i + j], &slopes[top[i]][2 * j], ARGUMENTS, rows_out[i] * cols_out[i], rows_in[j]);
    }
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 8; j++) {
            if (j < 2)
                cut(adjoint_made.out[8 * i + j], &bends[2 * i][2 * j], ARGUMENTS, rows_in[i], rows_in[j]);
            else // by results and weights: which may be anything
                dense(adjoint_made.out[8 * i + j], 3, 7);
        }
}

// One entry in four, two, ...; second derivatives are symmetric.
static void fill(unsigned seed, unsigned of_four)
{
    for (int k = 0; k < RESULTS * ARGUMENTS; k++) {
        const int row = k / ARGUMENTS, col = k % ARGUMENTS;
        seed = 1664525 * seed + 1013904223;
        slopes[row][col] = seed >> 30 < of_four;
        if (col <= row && row < ARGUMENTS)
            bends[row][col] = bends[col][row] = (seed >> 28 & 3) < of_four;
    }
}

// ---- The map of them ----

static void *program;

static struct casadi_map begin(void)
{
    struct casadi_map m = {.object = program, .n_in = INPUTS, .n_out = RESULTS, .entries = ARGUMENTS};
    m.place = calloc(ARGUMENTS, sizeof *m.place);
    memcpy(m.place, place, sizeof place);
    CHECK_OK(moray_casadi_open(&m.value, program, "value"), "value");
    return m;
}

static void end(struct casadi_map *m)
{
    moray_casadi_close(&m->value);
    moray_casadi_close(&m->jacobian);
    moray_casadi_close(&m->adjoint);
    moray_pattern_free(&m->jac);
    moray_pattern_free(&m->hess);
    free(m->place);
    free((void *)m->jac_from);
    free((void *)m->hess_from);
    free(m->in);
    free(m->slot);
}

// Every nonzero is where it is in the dense matrix.
static void mark(const struct casadi_function *f, int above, int left, int k)
{
    const struct casadi_block *block = &f->out[k];
    for (int e = 0; e < block->nnz; e++)
        block->value[e] = 100 * (above + block->position[e] % block->rows) + left + block->position[e] / block->rows;
}

// Entries are those wanted, each once, and come from their place. values: NULL where they come from nowhere.
static void check_pattern(const moray_pattern *found, const double **values, const int *wanted, int rows,
                          const char *what)
{
    int left[RESULTS * INPUTS], missing = 0, wrong = 0;
    memcpy(left, wanted, (size_t)rows * INPUTS * sizeof *left);
    for (int k = 0; k < found->nnz; k++) {
        int *entry = &left[found->row[k] * INPUTS + found->col[k]];
        wrong += *entry == 0 || (values && *values[k] != *entry - 1);
        *entry = 0;
    }
    for (int k = 0; k < rows * INPUTS; k++)
        missing += left[k] != 0;
    CHECK(missing == 0 && wrong == 0, "%s: of %d entries %d are wrong and %d are missing", what, found->nnz, wrong,
          missing);
}

// wanted: 1 and the mark of an entry, 0 where there is none.
static void test_jacobian(bool whole)
{
    int wanted[RESULTS][INPUTS] = {0};
    if (whole) {
        jac_made.n_out = 1;
        cut(jac_made.out[0], slopes[0], ARGUMENTS, RESULTS, ARGUMENTS);
    }
    struct casadi_map m = begin();
    CHECK_OK(moray_casadi_open_jacobian(&m, "jac_value"), "Jacobian");
    for (int k = 0; k < (whole ? 1 : 6); k++)
        mark(&m.jacobian, top[k / 2], 2 * (k % 2), k);
    for (int r = 0; r < RESULTS; r++)
        for (int e = 0; e < ARGUMENTS; e++)
            wanted[r][place[e]] = slopes[r][e] ? 1 + 100 * r + e : 0;
    check_pattern(&m.jac, m.jac_from, wanted[0], RESULTS, whole ? "a Jacobian in one" : "a Jacobian of blocks");
    CHECK_OK(moray_casadi_plan_differences(&m), "differences");
    int meet[INPUTS][INPUTS] = {0};
    for (int r = 0; r < RESULTS; r++)
        for (int a = 0; a < INPUTS; a++)
            for (int b = 0; b <= a; b++)
                meet[a][b] = meet[a][b] || (wanted[r][a] && wanted[r][b]);
    check_pattern(&m.hess, NULL, meet[0], INPUTS, "inputs that meet in an output");
    for (int k = 0; k < INPUTS * INPUTS; k++) {
        const int slot = m.slot[k];
        CHECK(meet[k / INPUTS][k % INPUTS] ? slot >= 0 && m.hess.row[slot] * INPUTS + m.hess.col[slot] == k
                                           : slot == -1,
              "entry %d of the Hessian in slot %d", k, slot);
    }
    end(&m);
    describe();
}

static void test_hessian(void)
{
    int wanted[INPUTS][INPUTS] = {0};
    struct casadi_map m = begin();
    CHECK_OK(moray_casadi_open_adjoint(&m, "jac_adj1_value"), "Hessian");
    for (int k = 0; k < 4; k++)
        mark(&m.adjoint, 2 * (k / 2), 2 * (k % 2), 8 * (k / 2) + k % 2);
    for (int a = 0; a < ARGUMENTS; a++)
        for (int b = 0; b < ARGUMENTS; b++)
            if (place[a] >= place[b])
                wanted[place[a]][place[b]] = bends[a][b] ? 1 + 100 * a + b : 0;
    check_pattern(&m.hess, m.hess_from, wanted[0], INPUTS, "the lower half of a Hessian");
    end(&m);
}

// ---- What is refused ----

static void check_refusal(bool adjoint, const char *text)
{
    struct casadi_map m = begin();
    const moray_status status =
        adjoint ? moray_casadi_open_adjoint(&m, "jac_adj1_value") : moray_casadi_open_jacobian(&m, "jac_value");
    if (text)
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, text) == 0, "refused: %s", status.text);
    else
        CHECK_OK(status, "taken");
    end(&m);
    describe();
}

static void test_arguments(void)
{
    static const struct {
        int argument, rows, cols;
        const char *must;
    } odd[] = {{0, 3, 1, "2 by 1"}, {0, 2, 2, "2 by 1"}, {1, 2, 1, "3 by 1"}, {1, 3, 2, "3 by 1"}, {2, 2, 1, "2 by 2"},
               {2, 1, 2, "2 by 2"}, {3, 1, 1, "2 by 1"}, {3, 2, 2, "2 by 1"}, {4, 2, 2, "1 by 2"}, {4, 1, 1, "1 by 2"},
               {5, 2, 3, "2 by 2"}, {6, 3, 1, "2 by 1"}, {7, 2, 2, "1 by 2"}};
    char text[200];
    for (size_t k = 0; k < sizeof odd / sizeof *odd; k++)
        for (int adjoint = odd[k].argument > 4; adjoint < 2; adjoint++) {
            long long *of = (adjoint ? &adjoint_made : &jac_made)->in[odd[k].argument];
            dense(of, odd[k].rows, odd[k].cols);
            snprintf(text, sizeof text, "argument %d of %s is %d by %d: must be %s, as of value", odd[k].argument,
                     adjoint ? "jac_adj1_value" : "jac_value", odd[k].rows, odd[k].cols, odd[k].must);
            check_refusal(adjoint, text);
            cut(of, NULL, 0, odd[k].rows, odd[k].cols); // not there, of whatever shape
            check_refusal(adjoint, NULL);
        }
    const bool one[] = {true, false, false};
    cut(jac_made.in[3], one, 1, 2, 1);
    check_refusal(false, "argument 3 of jac_value has 1 nonzeros: must have 2, as of value, or none");
    cut(adjoint_made.in[2], (bool[]){true, true, false, true}, 2, 2, 2);
    check_refusal(true, "argument 2 of jac_adj1_value has 3 nonzeros: must have 4, as of value, or none");
    cut(jac_made.in[1], (bool[]){true, false, true}, 1, 3, 1);
    check_refusal(false, NULL);
    for (int weight = 5; weight < 8; weight++) {
        cut(adjoint_made.in[weight], one, 0, rows_out[weight - 5], cols_out[weight - 5]);
        check_refusal(true, NULL);
    }
}

static void test_counts(void)
{
    jac_made.n_in = 4;
    check_refusal(false, "jac_value has 4 arguments: must be at least 5");
    adjoint_made.n_in = 7;
    check_refusal(true, "jac_adj1_value has 7 arguments: must be at least 8");
    jac_made.n_in = 6, dense(jac_made.in[5], 9, 9);
    check_refusal(false, NULL);
    adjoint_made.n_in = 9, dense(adjoint_made.in[8], 9, 9);
    check_refusal(true, NULL);
    jac_made.n_out = 5;
    check_refusal(false, "jac_value has 5 results: must be 6, or one");
    jac_made.n_out = 7, dense(jac_made.out[6], 4, 2);
    check_refusal(false, "jac_value has 7 results: must be 6, or one");
    adjoint_made.n_out = 15;
    check_refusal(true, "jac_adj1_value has 15 results: must be 16");
    adjoint_made.n_out = 17, dense(adjoint_made.out[16], 1, 1);
    check_refusal(true, "jac_adj1_value has 17 results: must be 16");
    for (int k = 0; k < 3; k++) {
        const int rows = k == 1 ? 7 : 8, cols = k == 2 ? 4 : 5;
        jac_made.n_out = 1, dense(jac_made.out[0], rows, cols);
        check_refusal(false, k == 0   ? NULL
                             : k == 1 ? "the result of jac_value is 7 by 5: must be 8 by 5"
                                      : "the result of jac_value is 8 by 4: must be 8 by 5");
    }
}

// A row too few, one too many, a column too many, none.
static void test_block(bool adjoint, int i, int j, int wrong)
{
    char text[200];
    const int down = adjoint ? rows_in[i] : rows_out[i] * cols_out[i], across = rows_in[j];
    const int rows = wrong == 0 ? down - 1 : wrong == 1 ? down + 1 : down, number = (adjoint ? 8 : 2) * i + j;
    const int cols = wrong == 2 ? across + 1 : wrong == 3 ? 0 : across;
    const char *name = adjoint ? "jac_adj1_value" : "jac_value";
    cut((adjoint ? &adjoint_made : &jac_made)->out[number], NULL, 0, rows, cols);
    if (cols == 0)
        snprintf(text, sizeof text, "result %d of %s is empty: must be %d by %d, of no nonzeros", number, name, down,
                 across);
    else
        snprintf(text, sizeof text, "result %d of %s is %d by %d: must be %d by %d", number, name, rows, cols, down,
                 across);
    check_refusal(adjoint, text);
}

int main(void)
{
    program = dlopen(NULL, RTLD_NOW);
    for (unsigned seed = 1; seed <= 12; seed++) {
        fill(seed, seed % 5);
        describe();
        test_jacobian(false);
        test_jacobian(true);
        test_hessian();
    }
    test_arguments();
    test_counts();
    for (int wrong = 0; wrong < 4; wrong++)
        for (int j = 0; j < 2; j++) {
            for (int i = 0; i < 3; i++)
                test_block(false, i, j, wrong);
            for (int i = 0; i < 2; i++)
                test_block(true, i, j, wrong);
        }
    dlclose(program);
    return tap_done();
}
