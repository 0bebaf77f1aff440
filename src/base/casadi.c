// SPDX-License-Identifier: MIT
#include "base/casadi.h"

#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void any_function(void);

static any_function *find(void *object, const char *name, const char *suffix)
{
    char full[160];
    any_function *found;
    snprintf(full, sizeof full, "%s%s", name, suffix);
    void *symbol = dlsym(object, full);
    memcpy(&found, &symbol, sizeof found); // ISO C has no cast from one to the other, POSIX their equal size
    return found;
}

bool moray_casadi_has(void *object, const char *name)
{
    return find(object, name, "") != NULL;
}

static moray_status count(void *object, const char *name, const char *suffix, int *n)
{
    long long (*get)(void) = (long long (*)(void))find(object, name, suffix);
    const long long found = get ? get() : 1;
    *n = (int)found;
    return found >= 0 && found < 10000
               ? moray_ok()
               : moray_error(MORAY_INPUT, "%s%s is %lld: must be from 0 to 9999", name, suffix, found);
}

// Compressed columns: rows, columns, the start of every column and its end, the row of every nonzero. A 1 in place of
// the first start: dense.
static bool is_sound(const long long *s)
{
    const long long rows = s[0], cols = s[1];
    if (rows < 0 || cols < 0 || rows > 1000000 || cols > 1000000 || rows * cols > 1000000000)
        return false;
    if (s[2] == 1)
        return true;
    const long long *start = s + 2, *row = start + cols + 1;
    bool sound = start[0] == 0;
    for (long long c = 0; c < cols; c++)
        sound = sound && start[c] <= start[c + 1];
    sound = sound && start[cols] <= rows * cols;
    for (long long c = 0; sound && c < cols; c++)
        for (long long k = start[c]; k < start[c + 1]; k++)
            sound = sound && row[k] >= 0 && row[k] < rows && (k == start[c] || row[k] > row[k - 1]);
    return sound;
}

static moray_status read_block(struct casadi_block *block, const long long *s)
{
    static const long long scalar[] = {1, 1, 1};
    s = s ? s : scalar;
    block->rows = (int)s[0];
    block->cols = (int)s[1];
    const bool dense = s[2] == 1;
    const long long *start = s + 2, *row = start + block->cols + 1;
    block->nnz = dense ? block->rows * block->cols : (int)start[block->cols];
    block->position = calloc((size_t)block->nnz + 1, sizeof *block->position);
    block->value = calloc((size_t)block->nnz + 1, sizeof *block->value);
    if (!block->position || !block->value)
        return moray_error(MORAY_MEMORY, "no memory for %d numbers", block->nnz);
    for (int c = 0, k = 0; c < block->cols; c++)
        for (const int end = dense ? (c + 1) * block->rows : (int)start[c + 1]; k < end; k++)
            block->position[k] = c * block->rows + (dense ? k - c * block->rows : (int)row[k]);
    return moray_ok();
}

static moray_status read_blocks(struct casadi_block **block, int n, void *object, const char *name, const char *suffix)
{
    const long long *(*get)(long long) = (const long long *(*)(long long))find(object, name, suffix);
    *block = calloc((size_t)n + 1, sizeof **block);
    if (!*block)
        return moray_error(MORAY_MEMORY, "no memory for the arguments of %s", name);
    for (int k = 0; k < n; k++) {
        const long long *s = get ? get(k) : NULL;
        if (get && (!s || !is_sound(s)))
            return moray_error(MORAY_INPUT, "%s%s(%d): is no matrix in compressed columns", name, suffix, k);
        MORAY_TRY(read_block(&(*block)[k], s));
    }
    return moray_ok();
}

static moray_status make_room(struct casadi_function *f, void *object)
{
    int (*get)(long long *, long long *, long long *, long long *) =
        (int (*)(long long *, long long *, long long *, long long *))find(object, f->name, "_work");
    long long args = f->n_in, results = f->n_out, integers = 0, numbers = 0;
    if (get && get(&args, &results, &integers, &numbers) != 0)
        return moray_error(MORAY_INPUT, "%s_work fails", f->name);
    if (args < f->n_in || results < f->n_out || integers < 0 || numbers < 0)
        return moray_error(MORAY_INPUT, "%s_work asks for less than its %d arguments and %d results", f->name, f->n_in,
                           f->n_out);
    f->arg = calloc((size_t)args + 1, sizeof *f->arg);
    f->res = calloc((size_t)results + 1, sizeof *f->res);
    f->iw = calloc((size_t)integers + 1, sizeof *f->iw);
    f->w = calloc((size_t)numbers + 1, sizeof *f->w);
    return f->arg && f->res && f->iw && f->w ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %s", f->name);
}

static moray_status take_memory(struct casadi_function *f, void *object)
{
    const bool checkout = find(object, f->name, "_checkout") != NULL;
    int (*take)(void) = (int (*)(void))find(object, f->name, checkout ? "_checkout" : "_alloc_mem");
    int (*begin)(int) = checkout ? NULL : (int (*)(int))find(object, f->name, "_init_mem");
    f->mem = take ? take() : 0;
    if (take && f->mem >= 0)
        f->give_back = (void (*)(int))find(object, f->name, checkout ? "_release" : "_free_mem");
    return f->mem >= 0 && (!begin || begin(f->mem) == 0)
               ? moray_ok()
               : moray_error(MORAY_INPUT, "%s gives no memory to work in", f->name);
}

moray_status moray_casadi_open(struct casadi_function *f, void *object, const char *name)
{
    *f = (struct casadi_function){0};
    if (strlen(name) >= sizeof f->name)
        return moray_error(MORAY_INPUT, "function %.60s...: must be a name of less than %zu bytes", name,
                           sizeof f->name);
    strcpy(f->name, name);
    f->evaluate = (int (*)(const double **, double **, long long *, double *, int))find(object, name, "");
    if (!f->evaluate)
        return moray_error(MORAY_INPUT, "there is no function %s in the shared object", name);
    any_function *incref = find(object, name, "_incref");
    if (incref)
        incref();
    f->decref = find(object, name, "_decref");
    MORAY_TRY(count(object, name, "_n_in", &f->n_in));
    MORAY_TRY(count(object, name, "_n_out", &f->n_out));
    MORAY_TRY(read_blocks(&f->in, f->n_in, object, name, "_sparsity_in"));
    MORAY_TRY(read_blocks(&f->out, f->n_out, object, name, "_sparsity_out"));
    MORAY_TRY(make_room(f, object));
    return take_memory(f, object);
}

static void free_blocks(struct casadi_block *block, int n)
{
    for (int k = 0; block && k < n; k++) {
        free(block[k].position);
        free(block[k].value);
    }
    free(block);
}

void moray_casadi_close(struct casadi_function *f)
{
    if (f->give_back)
        f->give_back(f->mem);
    if (f->decref)
        f->decref();
    free_blocks(f->in, f->n_in);
    free_blocks(f->out, f->n_out);
    free((void *)f->arg);
    free(f->res);
    free(f->iw);
    free(f->w);
    *f = (struct casadi_function){0};
}

bool moray_casadi_evaluate(struct casadi_function *f)
{
    for (int k = 0; k < f->n_in; k++) // which a function may overwrite: they are room for its own calls, too
        f->arg[k] = f->in[k].value;
    for (int k = 0; k < f->n_out; k++)
        f->res[k] = f->out[k].value;
    const bool good = f->evaluate(f->arg, f->res, f->iw, f->w, f->mem) == 0;
    for (int k = 0; !good && k < f->n_out; k++)
        for (int i = 0; i < f->out[k].nnz; i++)
            f->out[k].value[i] = NAN;
    return good;
}

int moray_casadi_entries(const struct casadi_block *block, int n)
{
    int sum = 0;
    for (int k = 0; k < n; k++)
        sum += block[k].rows * block[k].cols;
    return sum;
}
