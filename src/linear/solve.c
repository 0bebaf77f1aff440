// SPDX-License-Identifier: MIT
//
// Substitution, front by front: the part of the right-hand side that a front sees is gathered, worked on in full, and
// put back.
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "linear/parts.h"

static const double accurate = 1e-14; // backward error that refinement would hardly better
enum { refinements = 5 };             // at most; one that does not halve the error is the last

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
    moray_ldl_kernel_forward(p.height, p.pivots, p.P, p.height, p.x);
    for (int k = 0; k < p.width; k++)
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
    moray_ldl_kernel_backward(p.height, p.pivots, p.P, p.height, p.x);
    for (int k = 0; k < p.pivots; k++)
        ldl->permuted[p.index[k]] = p.x[k];
}

static void substitute(moray_ldl *ldl)
{
    for (int s = 0; s < ldl->plan.nodes; s++)
        forward(ldl, s);
    for (int s = ldl->plan.nodes - 1; s >= 0; s--)
        backward(ldl, s);
}

// permuted <- rhs - A solution, all in the scale of the factors. Returns its largest entry over those of both sides.
static double find_residual(moray_ldl *ldl)
{
    const struct plan *plan = &ldl->plan;
    double *r = ldl->permuted, worst = 0, size = 0;
    const double *x = ldl->solution;
    memcpy(r, ldl->rhs, (size_t)plan->n * sizeof *r);
    for (int c = 0; c < plan->n; c++) {
        int k = plan->start[c];
        const int end = plan->start[c + 1];
        const double here = x[c];
        double sum = k < end && plan->row[k] == c ? ldl->scaled[k++] * here : 0; // the diagonal comes first
        for (; k < end; k++) {
            const int row = plan->row[k];
            const double value = ldl->scaled[k];
            sum += value * x[row];
            r[row] -= value * here;
        }
        r[c] -= sum;
    }
    for (int c = 0; c < plan->n; c++) {
        worst = moray_worse(worst, fabs(r[c]));
        size = fabs(x[c]) > size ? fabs(x[c]) : size;
        size = fabs(ldl->rhs[c]) > size ? fabs(ldl->rhs[c]) : size;
    }
    return size > 0 ? worst / size : worst;
}

static void add_solution(moray_ldl *ldl)
{
    for (int c = 0; c < ldl->n; c++)
        ldl->solution[c] += ldl->permuted[c];
}

// Small pivots that the threshold let pass may have cost digits, which the residual gives back.
static double solve_one(moray_ldl *ldl, double *b)
{
    const struct plan *plan = &ldl->plan;
    for (int c = 0; c < plan->n; c++) {
        ldl->permuted[c] = ldl->rhs[c] = b[plan->order[c]] * ldl->scale[c];
        ldl->solution[c] = 0;
    }
    substitute(ldl);
    add_solution(ldl);
    double error = find_residual(ldl), before = INFINITY;
    for (int k = 0; k < refinements && error > accurate && error < before / 2; k++) {
        substitute(ldl);
        add_solution(ldl);
        before = error;
        error = find_residual(ldl);
    }
    for (int c = 0; c < plan->n; c++)
        b[plan->order[c]] = ldl->solution[c] * ldl->scale[c];
    return error;
}

moray_status moray_ldl_solve(moray_ldl *ldl, int columns, double *B)
{
    if (!ldl->factored)
        return moray_error(MORAY_NUMERIC, "a sparse matrix of %d rows has no factors to solve with", ldl->n);
    double error = 0;
    for (int j = 0; j < columns && ldl->n > 0; j++)
        error = moray_worse(error, solve_one(ldl, B + (size_t)j * (size_t)ldl->n));
    ldl->statistics.error = error;
    ldl->statistics.solves += columns;
    return moray_ok();
}
