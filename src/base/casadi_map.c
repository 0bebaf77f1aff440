// SPDX-License-Identifier: MIT
#include "moray/casadi.h"

#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/casadi_map.h"

static const double step = 6e-6; // of central differences: near the cube root of the rounding unit

// ---- Evaluation ----

static void put(const struct casadi_map *m, struct casadi_function *f, const double *in)
{
    for (int k = 0, first = 0; k < m->value.n_in; k++) {
        for (int i = 0; i < f->in[k].nnz; i++)
            f->in[k].value[i] = in[m->place[first + f->in[k].position[i]]];
        first += m->value.in[k].rows * m->value.in[k].cols;
    }
}

// Of a derivative: the results of the function, where it takes them.
static void put_results(struct casadi_map *m, struct casadi_function *f, const double *in)
{
    bool wanted = false;
    for (int k = 0; k < m->value.n_out; k++)
        wanted = wanted || f->in[m->value.n_in + k].nnz > 0;
    if (!wanted)
        return;
    put(m, &m->value, in);
    moray_casadi_evaluate(&m->value);
    for (int k = 0; k < m->value.n_out; k++) {
        const struct casadi_block *to = &f->in[m->value.n_in + k];
        memcpy(to->value, m->value.out[k].value, (size_t)to->nnz * sizeof *to->value);
    }
}

static void map_value(void *self, const double *in, double *out)
{
    struct casadi_map *m = self;
    put(m, &m->value, in);
    moray_casadi_evaluate(&m->value);
    memset(out, 0, (size_t)m->n_out * sizeof *out);
    for (int k = 0, first = 0; k < m->value.n_out; k++) {
        const struct casadi_block *block = &m->value.out[k];
        for (int i = 0; i < block->nnz; i++)
            out[first + block->position[i]] = block->value[i];
        first += block->rows * block->cols;
    }
}

static void map_jacobian(void *self, const double *in, double *values)
{
    struct casadi_map *m = self;
    put_results(m, &m->jacobian, in);
    put(m, &m->jacobian, in);
    moray_casadi_evaluate(&m->jacobian);
    for (int k = 0; k < m->jac.nnz; k++)
        values[k] = *m->jac_from[k];
}

static void put_weights(struct casadi_map *m, const double *weight)
{
    for (int k = 0, first = 0; k < m->value.n_out; k++) {
        const struct casadi_block *to = &m->adjoint.in[m->value.n_in + m->value.n_out + k];
        for (int i = 0; i < to->nnz; i++)
            to->value[i] = weight[first + to->position[i]];
        first += m->value.out[k].rows * m->value.out[k].cols;
    }
}

static void map_hessian(void *self, const double *in, const double *weight, double *values)
{
    struct casadi_map *m = self;
    put_results(m, &m->adjoint, in);
    put(m, &m->adjoint, in);
    put_weights(m, weight);
    moray_casadi_evaluate(&m->adjoint);
    for (int k = 0; k < m->hess.nnz; k++)
        values[k] = *m->hess_from[k];
}

static void map_differences(void *self, const double *in, const double *weight, double *values)
{
    struct casadi_map *m = self;
    memset(values, 0, (size_t)m->hess.nnz * sizeof *values);
    memcpy(m->in, in, (size_t)m->n_in * sizeof *in);
    for (int e = 0; e < m->entries; e++) {
        const int c = m->place[e];
        const double h = step * (1 + fabs(in[c]));
        for (int side = 0; side < 2; side++) {
            m->in[c] = in[c] + (side ? h : -h);
            map_jacobian(m, m->in, m->slopes[side]);
        }
        m->in[c] = in[c];
        for (int k = 0; k < m->jac.nnz; k++) {
            const int slot = m->slot[m->jac.col[k] * m->n_in + c];
            if (m->jac.col[k] >= c && slot >= 0)
                values[slot] += weight[m->jac.row[k]] * (m->slopes[1][k] - m->slopes[0][k]) / (2 * h);
        }
    }
}

// ---- Construction ----

static void free_self(void *self)
{
    struct casadi_map *m = self;
    moray_casadi_close(&m->adjoint);
    moray_casadi_close(&m->jacobian);
    moray_casadi_close(&m->value);
    if (m->object)
        dlclose(m->object);
    moray_pattern_free(&m->jac);
    moray_pattern_free(&m->hess);
    free(m->place);
    free((void *)m->jac_from);
    free((void *)m->hess_from);
    free(m->in);
    free(m->slot);
    free(m);
}

static void release(moray_map *map)
{
    free_self(map->self);
}

static moray_status set_places(struct casadi_map *m, const moray_casadi_spec *spec)
{
    m->entries = moray_casadi_entries(m->value.in, m->value.n_in);
    m->n_out = moray_casadi_entries(m->value.out, m->value.n_out);
    m->n_in = spec->n_in ? spec->n_in : m->entries;
    if (m->n_in < m->entries)
        return moray_error(MORAY_INPUT, "%s has %d inputs: the map must have as many, and has %d", spec->name,
                           m->entries, m->n_in);
    m->place = calloc((size_t)m->entries + 1, sizeof *m->place);
    if (!m->place)
        return moray_error(MORAY_MEMORY, "no memory for %d inputs", m->entries);
    for (int e = 0; e < m->entries; e++) {
        m->place[e] = spec->place ? spec->place[e] : e;
        bool good = m->place[e] >= 0 && m->place[e] < m->n_in;
        for (int other = 0; other < e; other++)
            good = good && m->place[other] != m->place[e];
        if (!good)
            return moray_error(MORAY_INPUT, "place %d of %s is %d: must be from 0 to %d, each once", e, spec->name,
                               m->place[e], m->n_in - 1);
    }
    return moray_ok();
}

static moray_status open_all(struct casadi_map *m, const moray_casadi_spec *spec)
{
    char name[200];
    m->object = dlopen(spec->path, RTLD_NOW | RTLD_LOCAL);
    if (!m->object) {
        const char *why = dlerror();
        return moray_error(MORAY_IO, "shared object %.100s: cannot be loaded: %.150s", spec->path, why ? why : "?");
    }
    MORAY_TRY(moray_casadi_open(&m->value, m->object, spec->name));
    MORAY_TRY(set_places(m, spec));
    snprintf(name, sizeof name, "jac_%s", spec->name);
    if (!moray_casadi_has(m->object, name))
        return moray_ok();
    MORAY_TRY(moray_casadi_open_jacobian(m, name));
    snprintf(name, sizeof name, "jac_adj1_%s", spec->name);
    return moray_casadi_has(m->object, name) ? moray_casadi_open_adjoint(m, name) : moray_casadi_plan_differences(m);
}

static moray_status without_jacobian(moray_map *map, struct casadi_map *m, const double *probe)
{
    double *zeros = calloc((size_t)m->n_in + 1, sizeof *zeros);
    moray_status status = moray_error(MORAY_MEMORY, "no memory for %d inputs", m->n_in);
    if (zeros)
        status = moray_map_from_real(map, m->n_in, m->n_out, map_value, m, free_self, probe ? probe : zeros);
    else
        free_self(m);
    free(zeros);
    return status;
}

moray_status moray_map_from_casadi(moray_map *map, const moray_casadi_spec *spec)
{
    struct casadi_map *m = calloc(1, sizeof *m);
    *map = (moray_map){0};
    if (!m)
        return moray_error(MORAY_MEMORY, "no memory for a map");
    const moray_status status = open_all(m, spec);
    if (moray_failed(status)) {
        free_self(m);
        return status;
    }
    if (!m->jacobian.evaluate)
        return without_jacobian(map, m, spec->probe);
    *map = (moray_map){.n_in = m->n_in,
                       .n_out = m->n_out,
                       .jac = m->jac,
                       .hess = m->hess,
                       .self = m,
                       .value = map_value,
                       .jacobian = map_jacobian,
                       .hessian = m->adjoint.evaluate ? map_hessian : map_differences,
                       .release = release};
    return moray_ok();
}
