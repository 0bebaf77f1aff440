// SPDX-License-Identifier: MIT
//
// Substitution, front by front: the part of the right-hand side that a front sees is gathered, worked on in full, and
// put back.
#include "linear/parts.h"

struct part {
    const double *P, *D;
    const int *index, *rows; // positions of the front's columns, of its rows
    int height, width, pivots;
    double *x; // [height]
};

static struct part gather(moray_ldl *ldl, int s)
{
    const struct node *node = &ldl->plan.node[s];
    const struct front *f = &ldl->front[s];
    const struct part part = {ldl->panel + f->panel,
                              ldl->pivot + 2 * f->index,
                              ldl->index + f->index,
                              ldl->plan.rows + node->structure,
                              f->height,
                              f->width,
                              f->pivots,
                              ldl->local};
    for (int k = 0; k < f->width; k++)
        part.x[k] = ldl->permuted[part.index[k]];
    for (int k = 0; k < node->rows; k++)
        part.x[f->width + k] = ldl->permuted[part.rows[k]];
    return part;
}

static void forward(moray_ldl *ldl, int s)
{
    const struct part p = gather(ldl, s);
    for (int k = 0; k + 1 < p.pivots; k++)
        moray_ldl_kernel_subtract(p.pivots - k - 1, 1, p.P + (size_t)k * (size_t)p.height + k + 1, p.height, p.x + k,
                                  p.x + k + 1);
    moray_ldl_kernel_subtract(p.height - p.pivots, p.pivots, p.P + p.pivots, p.height, p.x, p.x + p.pivots);
    for (int k = 0; k < p.pivots; k++)
        ldl->permuted[p.index[k]] = p.x[k];
    for (int k = p.pivots; k < p.width; k++)
        ldl->permuted[p.index[k]] = p.x[k];
    for (int k = p.width; k < p.height; k++)
        ldl->permuted[p.rows[k - p.width]] = p.x[k];
}

static void divide(const struct part *p)
{
    for (int k = 0; k < p->pivots; k++) {
        const double coupling = p->D[2 * k + 1], here = p->x[k];
        p->x[k] *= p->D[2 * k];
        if (coupling == 0)
            continue;
        p->x[k] += coupling * p->x[k + 1];
        p->x[k + 1] = coupling * here + p->D[2 * k + 2] * p->x[k + 1];
        k++;
    }
}

static void backward(moray_ldl *ldl, int s)
{
    const struct part p = gather(ldl, s);
    divide(&p);
    moray_ldl_kernel_subtract_transposed(p.height - p.pivots, p.pivots, p.P + p.pivots, p.height, p.x + p.pivots, p.x);
    for (int k = p.pivots - 2; k >= 0; k--)
        moray_ldl_kernel_subtract_transposed(p.pivots - k - 1, 1, p.P + (size_t)k * (size_t)p.height + k + 1, p.height,
                                             p.x + k + 1, p.x + k);
    for (int k = 0; k < p.pivots; k++)
        ldl->permuted[p.index[k]] = p.x[k];
}

static void solve_one(moray_ldl *ldl, double *b)
{
    const struct plan *plan = &ldl->plan;
    for (int c = 0; c < plan->n; c++)
        ldl->permuted[c] = b[plan->order[c]] * ldl->scale[c];
    for (int s = 0; s < plan->nodes; s++)
        forward(ldl, s);
    for (int s = plan->nodes - 1; s >= 0; s--)
        backward(ldl, s);
    for (int c = 0; c < plan->n; c++)
        b[plan->order[c]] = ldl->permuted[c] * ldl->scale[c];
}

moray_status moray_ldl_solve(moray_ldl *ldl, int columns, double *B)
{
    if (!ldl->factored)
        return moray_error(MORAY_NUMERIC, "a sparse matrix of %d rows has no factors to solve with", ldl->n);
    const double start = moray_ldl_clock();
    for (int j = 0; j < columns; j++)
        solve_one(ldl, B + (size_t)j * (size_t)ldl->n);
    ldl->statistics.solves += columns;
    ldl->statistics.solve_seconds += moray_ldl_clock() - start;
    return moray_ok();
}
