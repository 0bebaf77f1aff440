// SPDX-License-Identifier: MIT
//
// The plan of a sweep against its rules, step by step, over points whose answers are drawn at random.
#include "tap.h"

#include <string.h>

#include "sweep/sweep.h"

enum { most = 60 };
// What is known by the rules, beside the plan's own store.
typedef struct world {
    const struct grid *grid;
    double failing; // share
    unsigned long long seed;
    int state[most], round[most], tried[most];
    double objective[most];
    long answered, warm, held, improved;
} world;

static moray_status none(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point, (void)summary, (void)self;
    return moray_ok();
}

// The nearest solved one of the eight above.
static long above(const world *w, long point)
{
    for (int level = 0; level < 8; level++) {
        point = moray_grid_parent(w->grid, point);
        if (point < 0 || w->state[point] == POINT_SOLVED)
            return point;
    }
    return -1;
}

static bool has_number(const world *w, long point)
{
    return point >= 0 && w->state[point] == POINT_SOLVED && isfinite(w->objective[point]);
}

// By how much a point's own value is above what a line through its neighbour promises, less what that may be wrong by.
static double lead(const world *w, long point, long near, long behind, int axis)
{
    double rise = 0;
    if (has_number(w, behind)) {
        const double x = moray_grid_coordinate(w->grid, point, axis),
                     x_near = moray_grid_coordinate(w->grid, near, axis),
                     x_behind = moray_grid_coordinate(w->grid, behind, axis);
        rise = (w->objective[near] - w->objective[behind]) / (x_near - x_behind) * (x - x_near);
    }
    const double wrong = 0.5 * fabs(rise) + fabs(w->objective[near]) / 10000;
    return w->state[point] == POINT_SOLVED ? w->objective[point] - (w->objective[near] + rise) - wrong : INFINITY;
}

// The neighbour that a round begins with, or -1.
static long neighbour(const world *w, long point, int round)
{
    long best = -1;
    double most_lead = 0;
    for (int axis = 0; axis < w->grid->axes; axis++)
        for (int side = -1; moray_grid_numeric(w->grid, axis) && side <= 1; side += 2) {
            const long near = moray_grid_step(w->grid, point, axis, side);
            if (!has_number(w, near) || (round == 1 ? near == above(w, point) : w->round[near] != round - 1))
                continue;
            const double by = lead(w, point, near, moray_grid_step(w->grid, point, axis, 2 * side), axis);
            if (by > most_lead) {
                most_lead = by;
                best = near;
            }
        }
    return best;
}

static void answer(world *w, struct plan *plan, const struct task *task)
{
    char text[80];
    const bool solves = tap_random(&w->seed, 0, 1) >= w->failing;
    // Half of them so near to each other that what counts is the ten thousandth part of a value.
    static const double close[] = {-1.5, -1.49995, -1.4999, -1.4995, 1.2, 1.20005};
    const double any = tap_random(&w->seed, -2, 1), which = tap_random(&w->seed, 0, 12);
    const double value = which < 6 ? close[(int)which] : any;
    struct record record = {.task = *task, .code = solves ? MORAY_OK : MORAY_NOT_SOLVED};
    bool better = false;
    if (tap_random(&w->seed, 0, 1) < 0.9) { // else it does not say
        snprintf(text, sizeof text, "{\"cost\": %.17g}", value);
        CHECK_OK(moray_json_on_one_line(text, &record.found, &record.read), "an answer");
    }
    const double objective = record.read ? value : NAN, had = w->objective[task->point];
    const int before = w->state[task->point];
    const bool wins = before == POINT_UNTRIED ||
                      (solves && (before == POINT_FAILED || objective < had || (isnan(had) && !isnan(objective))));
    if (wins) {
        w->state[task->point] = solves ? POINT_SOLVED : POINT_FAILED;
        w->objective[task->point] = objective;
        w->round[task->point] = task->round;
    }
    w->tried[task->point]++;
    w->answered++;
    w->warm += task->round == 0 && task->start >= 0;
    w->held += task->round == 0 && task->start >= 0 && solves;
    w->improved += task->round > 0 && wins;
    CHECK_OK(moray_plan_answer(plan, &record, &better), "is taken");
    CHECK(better == wins, "and is what the point has now or not");
    moray_record_free(&record);
}

// The first round: every point once, begun with the nearest that is solved above it, and with the default if that
// fails.
static void first_round(world *w, struct plan *plan, struct task *task)
{
    bool again[most] = {false};
    while (moray_plan_next(plan, task) && task->round == 0) {
        const long start = again[task->point] || !w->grid->spec->warm ? -1 : above(w, task->point);
        CHECK(task->start == start && task->start_round == 0 && w->tried[task->point] == again[task->point],
              "point %ld begins with %ld", task->point, task->start);
        CHECK(plan->pending == 1, "one is out");
        const int before = w->tried[task->point];
        answer(w, plan, task);
        again[task->point] = before > 0 || (task->start >= 0 && w->state[task->point] != POINT_SOLVED);
    }
    for (long k = 0; k < w->grid->points; k++)
        CHECK(w->tried[k] == 1 + again[k], "point %ld is tried %d times", k, w->tried[k]);
}

// All that a round has, before any of it is answered.
static int later_round(world *w, struct plan *plan, struct task *task, int round)
{
    struct task all[most];
    int n = 0, round_at[most];
    memcpy(round_at, w->round, sizeof round_at);
    do {
        all[n++] = *task;
    } while (n < most && moray_plan_next(plan, task));
    CHECK(plan->pending == n && plan->n == 0, "%d of round %d", n, round);
    int k = 0;
    for (long point = 0; point < w->grid->points; point++) {
        const long start = neighbour(w, point, round);
        if (start < 0)
            continue;
        CHECK(k < n && all[k].point == point && all[k].start == start && all[k].round == round &&
                  all[k].start_round == round_at[start],
              "round %d: point %ld from %ld", round, point, start);
        k++;
    }
    CHECK(k == n, "and no more");
    CHECK(plan->expected == w->answered + n, "that many are expected");
    for (k = 0; k < n; k++)
        answer(w, plan, &all[k]);
    return n;
}

static int run(const moray_sweep_spec *spec, double failing, unsigned long long seed)
{
    struct grid grid;
    struct store store;
    struct plan plan;
    struct task task = {0};
    int later = 0;
    CHECK_OK(moray_grid_new(spec, &grid), "a grid");
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    CHECK_OK(moray_plan_new(&plan, &grid, &store), "a plan");
    world w = {.grid = &grid, .failing = failing, .seed = seed};
    for (int k = 0; k < most; k++)
        w.objective[k] = NAN;
    CHECK(plan.expected == grid.points, "every point is expected once");
    first_round(&w, &plan, &task);
    int rounds = 0;
    while (task.round == rounds + 1) {
        later += later_round(&w, &plan, &task, ++rounds);
        task.round = 0;
        moray_plan_next(&plan, &task);
    }
    CHECK(!moray_plan_next(&plan, &task) && plan.pending == 0 && rounds <= 3, "after %d rounds all is done", rounds);
    bool more = false;
    for (long point = 0; point < grid.points && spec->warm && spec->objective && rounds < 3; point++)
        more = more || neighbour(&w, point, rounds + 1) >= 0;
    CHECK(!more, "as no neighbour promises more");
    CHECK(plan.answered == w.answered && plan.expected == w.answered && plan.warm == w.warm && plan.held == w.held &&
              plan.improved == w.improved,
          "counted: %ld answers, %ld of %ld from above, %ld bettered", plan.answered, plan.held, plan.warm,
          plan.improved);
    moray_plan_free(&plan);
    moray_store_free(&store);
    return later;
}

static const double uneven[] = {-3, -2.5, 0, 1, 1.25, 4}, falling[] = {7, 3, 2, -4},
                    steps[] = {0, 1, 3, 4, 6, 9, 10, 11, 15, 16, 18, 20, 21, 22, 25, 27, 28, 29, 31, 35, 36, 37};
static const char *const words[] = {"left", "right"};
static const moray_sweep_axis grid_axes[] = {{.key = "x", .value = uneven, .n = 6},
                                             {.key = "w", .word = words, .n = 2},
                                             {.key = "y", .value = falling, .n = 4}},
                              line[] = {{.key = "x", .value = steps, .n = 22}};

int main(void)
{
    moray_sweep_spec spec = {.axis = grid_axes, .axes = 3, .solve = none, .objective = "cost", .warm = true};
    int later = 0;
    for (unsigned seed = 1; seed <= 12; seed++) {
        spec.axis = grid_axes, spec.axes = 3;
        later += run(&spec, 0.1 * (seed % 4), seed);
        spec.axis = line, spec.axes = 1;
        later += run(&spec, 0.3 * (seed % 4), 100 + seed);
    }
    CHECK(later > 100, "%d attempts of later rounds", later);
    spec.objective = NULL;
    CHECK(run(&spec, 0.2, 7) == 0, "without an objective there is one round");
    spec.objective = "cost", spec.warm = false;
    CHECK(run(&spec, 0.2, 7) == 0, "nor is there another where every point begins by itself");
    return tap_done();
}
