// SPDX-License-Identifier: MIT
#include "base/casadi_map.h"

#include <stdlib.h>

// Walks over the entries of a matrix of blocks, row by row of blocks, whose columns are those of all arguments.
typedef void visit(struct casadi_map *m, int row, int col, const double *value, int at);

static int walk(struct casadi_map *m, struct casadi_function *f, int block_rows, int block_cols, bool lower,
                visit *put_one)
{
    int n = 0, top = 0;
    for (int i = 0; i < block_rows; i++) {
        int left = 0, height = 0;
        for (int j = 0; j < block_cols; j++) {
            const struct casadi_block *block = &f->out[i * (f->n_out / block_rows) + j];
            height = block->rows;
            for (int k = 0; k < block->nnz; k++) {
                const int row = top + block->position[k] % block->rows, e = left + block->position[k] / block->rows;
                const int col = m->place[e];
                if (lower && m->place[row] < col)
                    continue;
                if (put_one)
                    put_one(m, lower ? m->place[row] : row, col, block->value + k, n);
                n++;
            }
            left += block->cols;
        }
        top += height;
    }
    return n;
}

static void put_slope(struct casadi_map *m, int row, int col, const double *value, int at)
{
    m->jac.row[at] = row;
    m->jac.col[at] = col;
    m->jac_from[at] = value;
}

static void put_bend(struct casadi_map *m, int row, int col, const double *value, int at)
{
    m->hess.row[at] = row;
    m->hess.col[at] = col;
    m->hess_from[at] = value;
}

// The shape of every block, told by the function itself: `down` results or arguments by its arguments.
static moray_status check_blocks(const struct casadi_map *m, const struct casadi_function *f,
                                 const struct casadi_block *down, int n_down, int per_row)
{
    for (int i = 0; i < n_down; i++)
        for (int j = 0; j < m->value.n_in; j++) {
            const struct casadi_block *block = &f->out[i * per_row + j];
            const int rows = down[i].rows * down[i].cols, cols = m->value.in[j].rows * m->value.in[j].cols;
            if (block->rows == rows && block->cols == cols)
                continue;
            if (block->rows * block->cols == 0)
                return moray_error(MORAY_INPUT, "result %d of %s is empty: must be %d by %d, of no nonzeros",
                                   i * per_row + j, f->name, rows, cols);
            return moray_error(MORAY_INPUT, "result %d of %s is %d by %d: must be %d by %d", i * per_row + j, f->name,
                               block->rows, block->cols, rows, cols);
        }
    return moray_ok();
}

// Arguments of the function, its results, and of an adjoint their weights: of its shapes, or left out by no nonzeros.
// Results are handed on as they are, with all their nonzeros.
static moray_status check_arguments(const struct casadi_map *m, const struct casadi_function *f, int least)
{
    const int n_in = m->value.n_in, n_out = m->value.n_out;
    if (f->n_in < least)
        return moray_error(MORAY_INPUT, "%s has %d arguments: must be at least %d", f->name, f->n_in, least);
    for (int k = 0; k < least; k++) {
        const struct casadi_block *block = &f->in[k];
        const struct casadi_block *like = k < n_in ? &m->value.in[k] : &m->value.out[(k - n_in) % n_out];
        if (block->nnz > 0 && (block->rows != like->rows || block->cols != like->cols))
            return moray_error(MORAY_INPUT, "argument %d of %s is %d by %d: must be %d by %d, as of %s", k, f->name,
                               block->rows, block->cols, like->rows, like->cols, m->value.name);
        if (k >= n_in && k < n_in + n_out && block->nnz > 0 && block->nnz != like->nnz)
            return moray_error(MORAY_INPUT, "argument %d of %s has %d nonzeros: must have %d, as of %s, or none", k,
                               f->name, block->nnz, like->nnz, m->value.name);
    }
    return moray_ok();
}

moray_status moray_casadi_open_jacobian(struct casadi_map *m, const char *name)
{
    struct casadi_function *f = &m->jacobian;
    MORAY_TRY(moray_casadi_open(f, m->object, name));
    MORAY_TRY(check_arguments(m, f, m->value.n_in + m->value.n_out));
    const bool whole = f->n_out == 1;
    if (whole && (f->out->rows != m->n_out || f->out->cols != m->entries))
        return moray_error(MORAY_INPUT, "the result of %s is %d by %d: must be %d by %d", name, f->out->rows,
                           f->out->cols, m->n_out, m->entries);
    if (!whole && f->n_out != m->value.n_in * m->value.n_out)
        return moray_error(MORAY_INPUT, "%s has %d results: must be %d, or one", name, f->n_out,
                           m->value.n_in * m->value.n_out);
    if (!whole)
        MORAY_TRY(check_blocks(m, f, m->value.out, m->value.n_out, m->value.n_in));
    const int down = whole ? 1 : m->value.n_out, across = whole ? 1 : m->value.n_in;
    MORAY_TRY(moray_pattern_new(&m->jac, walk(m, f, down, across, false, NULL)));
    m->jac_from = calloc((size_t)m->jac.nnz + 1, sizeof *m->jac_from);
    if (!m->jac_from)
        return moray_error(MORAY_MEMORY, "no memory for %s", name);
    walk(m, f, down, across, false, put_slope);
    return moray_ok();
}

moray_status moray_casadi_open_adjoint(struct casadi_map *m, const char *name)
{
    struct casadi_function *f = &m->adjoint;
    MORAY_TRY(moray_casadi_open(f, m->object, name));
    MORAY_TRY(check_arguments(m, f, m->value.n_in + 2 * m->value.n_out));
    const int per_row = m->value.n_in + 2 * m->value.n_out;
    if (f->n_out != m->value.n_in * per_row)
        return moray_error(MORAY_INPUT, "%s has %d results: must be %d", name, f->n_out, m->value.n_in * per_row);
    MORAY_TRY(check_blocks(m, f, m->value.in, m->value.n_in, per_row));
    MORAY_TRY(moray_pattern_new(&m->hess, walk(m, f, m->value.n_in, m->value.n_in, true, NULL)));
    m->hess_from = calloc((size_t)m->hess.nnz + 1, sizeof *m->hess_from);
    if (!m->hess_from)
        return moray_error(MORAY_MEMORY, "no memory for %s", name);
    walk(m, f, m->value.n_in, m->value.n_in, true, put_bend);
    return moray_ok();
}

// Without a Hessian: any two inputs that one output depends on may meet.
moray_status moray_casadi_plan_differences(struct casadi_map *m)
{
    const int n = m->n_in;
    int nnz = 0;
    m->slot = calloc((size_t)n * n + 1, sizeof *m->slot);
    m->in = calloc((size_t)n + 2 * (size_t)m->jac.nnz + 1, sizeof *m->in);
    if (!m->slot || !m->in)
        return moray_error(MORAY_MEMORY, "no memory for differences of %s", m->jacobian.name);
    m->slopes[0] = m->in + n;
    m->slopes[1] = m->slopes[0] + m->jac.nnz;
    for (int k = 0; k < m->jac.nnz; k++)
        for (int l = 0; l < m->jac.nnz; l++)
            if (m->jac.row[k] == m->jac.row[l] && m->jac.col[k] >= m->jac.col[l])
                m->slot[m->jac.col[k] * n + m->jac.col[l]] = 1;
    for (int k = 0; k < n * n; k++)
        m->slot[k] = m->slot[k] ? nnz++ : -1;
    MORAY_TRY(moray_pattern_new(&m->hess, nnz));
    for (int k = 0; k < n * n; k++)
        if (m->slot[k] >= 0) {
            m->hess.row[m->slot[k]] = k / n;
            m->hess.col[m->slot[k]] = k % n;
        }
    return moray_ok();
}
