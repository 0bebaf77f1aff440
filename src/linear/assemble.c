// SPDX-License-Identifier: MIT
//
// A front is filled from the matrix and from what its children leave: contribution blocks of rows that were planned,
// and delayed columns, which stand between the front's own columns and its rows.
#include <stdlib.h>
#include <string.h>

#include "linear/parts.h"

static bool grow(void **block, size_t *room, size_t need, size_t size)
{
    if (need <= *room)
        return true;
    const size_t more = need + need / 2;
    void *grown = realloc(*block, more * size);
    if (!grown)
        return false;
    *block = grown;
    *room = more;
    return true;
}

static bool reserve(moray_ldl *ldl, const struct front *f)
{
    size_t pivots = 2 * ldl->index_room;
    return grow((void **)&ldl->panel, &ldl->panel_room, ldl->panel_used, sizeof *ldl->panel) &&
           grow((void **)&ldl->pivot, &pivots, 2 * ldl->index_used, sizeof *ldl->pivot) &&
           grow((void **)&ldl->index, &ldl->index_room, ldl->index_used, sizeof *ldl->index) &&
           grow((void **)&ldl->kept, &ldl->kept_room, (size_t)f->height * (size_t)f->width, sizeof *ldl->kept) &&
           grow((void **)&ldl->local, &ldl->local_room, (size_t)f->height, sizeof *ldl->local);
}

static void lay_out(moray_ldl *ldl, int s)
{
    const struct node *node = &ldl->plan.node[s];
    struct front *f = &ldl->front[s];
    int delayed = 0;
    for (int c = node->child; c >= 0; c = ldl->plan.node[c].sibling)
        delayed += ldl->front[c].width - ldl->front[c].pivots;
    f->columns = node->columns;
    f->width = node->columns + delayed;
    f->height = f->width + node->rows;
    f->panel = ldl->panel_used;
    f->index = ldl->index_used;
    ldl->panel_used += (size_t)f->height * (size_t)f->width;
    ldl->index_used += (size_t)f->width;
    ldl->statistics.delayed += delayed;
}

static void add_matrix(moray_ldl *ldl, int s)
{
    const struct plan *plan = &ldl->plan;
    const struct node *node = &plan->node[s];
    const struct front *f = &ldl->front[s];
    double *P = ldl->panel + f->panel;
    const int shift = f->width - f->columns, planned = f->height - shift;
    for (int c = node->first; c < node->first + node->columns; c++)
        for (int k = plan->start[c]; k < plan->start[c + 1]; k++) {
            const double value = ldl->scaled[k];
            int place = plan->place[k];
            if (shift > 0) {
                const int row = place % planned;
                place = place / planned * f->height + row + (row < f->columns ? 0 : shift);
            }
            P[place] += value;
        }
}

// to[into[i]] += from[i]; rows are mostly the parent's, one after the other.
static void add_rows(double *to, const int *into, const double *from, int begin, int end)
{
    if (begin < end && into[end - 1] - into[begin] == end - 1 - begin) {
        to += into[begin];
        for (int i = begin; i < end; i++)
            to[i - begin] += from[i];
    } else
        for (int i = begin; i < end; i++)
            to[into[i]] += from[i];
}

static void add_update(moray_ldl *ldl, int s, int c)
{
    const struct node *node = &ldl->plan.node[s], *child = &ldl->plan.node[c];
    const struct front *f = &ldl->front[s];
    const int *into = ldl->plan.into + child->structure;
    const double *from = ldl->update + child->update;
    double *P = ldl->panel + f->panel, *C = ldl->update + node->update - f->columns;
    for (int j = 0; j < child->own; j++, from += child->rows) {
        double *to = P + (size_t)into[j] * (size_t)f->height;
        add_rows(to, into, from, j, child->own);
        add_rows(to + f->width - f->columns, into, from, child->own, child->rows);
    }
    for (int j = child->own; j < child->rows; j++, from += child->rows)
        add_rows(C + (size_t)(into[j] - f->columns) * (size_t)node->rows, into, from, j, child->rows);
}

// to: where the child's first delayed column stands in the front.
static void add_delayed(moray_ldl *ldl, int s, int c, int to)
{
    const struct node *child = &ldl->plan.node[c];
    const struct front *f = &ldl->front[s], *g = &ldl->front[c];
    const int *into = ldl->plan.into + child->structure, shift = f->width - f->columns;
    double *P = ldl->panel + f->panel;
    for (int t = g->pivots; t < g->width; t++) {
        const double *from = ldl->panel + g->panel + (size_t)t * (size_t)g->height;
        const int at = to + t - g->pivots;
        double *column = P + (size_t)at * (size_t)f->height;
        for (int i = t; i < g->width; i++)
            column[to + i - g->pivots] = from[i];
        for (int i = 0; i < child->own; i++)
            P[(size_t)into[i] * (size_t)f->height + at] = from[g->width + i];
        for (int i = child->own; i < child->rows; i++)
            column[into[i] + shift] = from[g->width + i];
        ldl->index[f->index + at] = ldl->index[g->index + t];
    }
}

moray_status moray_ldl_front_assemble(moray_ldl *ldl, int s)
{
    const struct node *node = &ldl->plan.node[s];
    const struct front *f = &ldl->front[s];
    lay_out(ldl, s);
    if ((double)ldl->panel_used > ldl->most_entries)
        return moray_error(MORAY_NOT_SOLVED,
                           "delayed pivots fill the factors of a sparse matrix of %d rows: %.3g entries and more, "
                           "%.3g at first",
                           ldl->n, (double)ldl->panel_used, (double)ldl->plan.panel_room);
    if (!reserve(ldl, f))
        return moray_error(MORAY_MEMORY, "no memory for the factors of a sparse matrix of %d rows", ldl->n);
    memset(ldl->panel + f->panel, 0, (size_t)f->height * (size_t)f->width * sizeof *ldl->panel);
    memset(ldl->update + node->update, 0, (size_t)node->rows * (size_t)node->rows * sizeof *ldl->update);
    for (int k = 0; k < node->columns; k++)
        ldl->index[f->index + k] = node->first + k;
    add_matrix(ldl, s);
    int delayed = node->columns;
    for (int c = node->child; c >= 0; c = ldl->plan.node[c].sibling) {
        add_update(ldl, s, c);
        add_delayed(ldl, s, c, delayed);
        delayed += ldl->front[c].width - ldl->front[c].pivots;
    }
    return moray_ok();
}
