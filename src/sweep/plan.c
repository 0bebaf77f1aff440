// SPDX-License-Identifier: MIT
//
// Round 0 goes down the trees of parents: a point begins with the solution of the nearest solved point above it, and
// from the default where that fails or is not there. The rounds behind it look for branches: where a line through two
// neighbours promises a better value than a point has, the point is solved once more from the nearer of the two; from
// the second of these rounds on only where the round before has bettered that one, so that no attempt is made twice.
// All decisions of a round rest on what the round before left, so that they do not depend on who was first.
#include "sweep/sweep.h"

#include <math.h>
#include <stdlib.h>

enum { ROUNDS = 3, TREE_LEVELS = 8 };

static moray_status make_trees(struct plan *plan)
{
    const size_t n = (size_t)plan->grid->points;
    plan->child = moray_apart_new(n, sizeof *plan->child);
    plan->sibling = moray_apart_new(n, sizeof *plan->sibling);
    if (!plan->child || !plan->sibling)
        return moray_error(MORAY_MEMORY, "no memory for a plan of %ld points", plan->grid->points);
    for (long k = 0; k < plan->grid->points; k++)
        plan->child[k] = plan->sibling[k] = -1;
    return moray_ok();
}

// The ring has room for all: every point waits at most once in a round, and once more for its default start.
static void add(struct plan *plan, struct task task)
{
    if (task.start >= 0)
        task.start_round = plan->store->round[task.start];
    plan->ready[(plan->head + plan->n) % plan->room] = task;
    plan->n++;
}

moray_status moray_plan_new(struct plan *plan, const struct grid *grid, struct store *store)
{
    *plan = (struct plan){.grid = grid, .store = store, .expected = grid->points, .room = 2 * grid->points};
    plan->ready = moray_apart_new((size_t)plan->room, sizeof *plan->ready);
    moray_status status =
        plan->ready ? make_trees(plan) : moray_error(MORAY_MEMORY, "no memory for a plan of %ld points", grid->points);
    for (long k = grid->points - 1; !moray_failed(status) && k >= 0; k--) {
        const long parent = grid->spec->warm ? moray_grid_parent(grid, k) : -1;
        if (parent < 0)
            continue;
        plan->sibling[k] = plan->child[parent];
        plan->child[parent] = k;
    }
    for (long k = 0; !moray_failed(status) && k < grid->points; k++)
        if (!grid->spec->warm || moray_grid_parent(grid, k) < 0)
            add(plan, (struct task){.point = k, .start = -1});
    if (moray_failed(status))
        moray_plan_free(plan);
    return status;
}

void moray_plan_free(struct plan *plan)
{
    const size_t n = plan->grid ? (size_t)plan->grid->points : 0;
    moray_apart_free(plan->ready, (size_t)plan->room, sizeof *plan->ready);
    moray_apart_free(plan->child, n, sizeof *plan->child);
    moray_apart_free(plan->sibling, n, sizeof *plan->sibling);
    *plan = (struct plan){0};
}

static long solved_above(const struct plan *plan, long point)
{
    for (int level = 0; level < TREE_LEVELS && point >= 0; level++) {
        point = moray_grid_parent(plan->grid, point);
        if (point >= 0 && plan->store->state[point] == POINT_SOLVED)
            return point;
    }
    return -1;
}

static void add_children(struct plan *plan, long point)
{
    for (long k = plan->child[point]; k >= 0; k = plan->sibling[k])
        add(plan, (struct task){.point = k, .start = solved_above(plan, k)});
}

// The step from the neighbour to the point, over the one from behind it to the neighbour.
static double further(const struct grid *grid, long point, long near, long behind, int axis)
{
    const double at_near = moray_grid_coordinate(grid, near, axis);
    return (moray_grid_coordinate(grid, point, axis) - at_near) / (at_near - moray_grid_coordinate(grid, behind, axis));
}

// Whether what the neighbour has is new to the point.
static bool is_new(const struct plan *plan, long point, long near)
{
    return plan->round == 1 ? near != solved_above(plan, point) : plan->store->round[near] == plan->round - 1;
}

// What the line through the neighbour and the point behind it promises, and how sure that is.
static bool promises(const struct plan *plan, long point, int axis, int side, long *neighbour, double *lead)
{
    const struct store *store = plan->store;
    const long near = moray_grid_step(plan->grid, point, axis, side),
               behind = moray_grid_step(plan->grid, point, axis, 2 * side);
    if (near < 0 || store->state[near] != POINT_SOLVED || !isfinite(store->objective[near]) ||
        !is_new(plan, point, near))
        return false;
    const double at_near = store->objective[near];
    const bool line = behind >= 0 && store->state[behind] == POINT_SOLVED && isfinite(store->objective[behind]);
    const double rise =
        line ? (at_near - store->objective[behind]) * further(plan->grid, point, near, behind, axis) : 0;
    const double promised = at_near + rise, margin = fabs(rise) / 2 + 1e-4 * fabs(at_near);
    *neighbour = near;
    *lead = store->state[point] == POINT_SOLVED ? store->objective[point] - promised - margin : INFINITY;
    return *lead > 0;
}

static void add_branches(struct plan *plan)
{
    for (long point = 0; point < plan->grid->points; point++) {
        long best = -1;
        double most = 0;
        for (int axis = 0; axis < plan->grid->axes; axis++)
            for (int side = -1; side <= 1 && moray_grid_numeric(plan->grid, axis); side += 2) {
                long near;
                double lead;
                if (promises(plan, point, axis, side, &near, &lead) && lead > most) {
                    most = lead;
                    best = near;
                }
            }
        if (best >= 0)
            add(plan, (struct task){.point = point, .start = best, .round = plan->round});
    }
    plan->expected += plan->n;
}

bool moray_plan_next(struct plan *plan, struct task *next)
{
    while (plan->n == 0 && plan->pending == 0 && plan->grid->spec->warm && plan->grid->spec->objective &&
           plan->round < ROUNDS) {
        plan->round++;
        add_branches(plan);
        if (plan->n == 0)
            plan->round = ROUNDS;
    }
    if (plan->n == 0)
        return false;
    *next = plan->ready[plan->head];
    plan->head = (plan->head + 1) % plan->room;
    plan->n--;
    plan->pending++;
    return true;
}

moray_status moray_plan_answer(struct plan *plan, const struct record *record, bool *better)
{
    const struct task *task = &record->task;
    const bool solved = record->code == MORAY_OK;
    plan->pending--;
    plan->answered++;
    plan->warm += task->start >= 0 && task->round == 0;
    plan->held += task->start >= 0 && task->round == 0 && solved;
    MORAY_TRY(moray_store_add(plan->store, record, better));
    plan->improved += task->round > 0 && *better; // than what it was tried with before
    if (task->round == 0 && task->start >= 0 && !solved) {
        plan->expected++;
        add(plan, (struct task){.point = task->point, .start = -1});
    } else if (task->round == 0) {
        add_children(plan, task->point);
    }
    return moray_ok();
}
