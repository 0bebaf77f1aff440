// SPDX-License-Identifier: MIT
//
// What a sweep keeps of a point: the better of two answers, and every number of it or MORAY_MEMORY.
#include "allocations.h"
#include "tap.h"

#include <string.h>
#include <sys/mman.h>

#include "sweep/sweep.h"

static size_t mapped; // bytes that are not given back yet
void *__real_mmap64(void *at, size_t size, int protection, int flags, int fd, off_t offset);
void *__wrap_mmap64(void *at, size_t size, int protection, int flags, int fd, off_t offset);
int __real_munmap(void *memory, size_t size);
int __wrap_munmap(void *memory, size_t size);

void *__wrap_mmap64(void *at, size_t size, int protection, int flags, int fd, off_t offset)
{
    if (fails())
        return MAP_FAILED;
    mapped += size;
    return __real_mmap64(at, size, protection, flags, fd, offset);
}

int __wrap_munmap(void *memory, size_t size)
{
    mapped -= size;
    return __real_munmap(memory, size);
}

static const moray_sweep_spec spec = {.objective = "cost"};
static const struct grid grid = {.spec = &spec, .points = 2};

static moray_status add(struct store *store, const char *found, bool *better)
{
    struct record record = {.task = {.point = 1, .start = -1}, .reason = NULL};
    moray_status status = moray_json_on_one_line(found, &record.found, &record.read);
    if (!moray_failed(status))
        status = moray_store_add(store, &record, better);
    moray_record_free(&record);
    return status;
}

// A summary of more numbers than a store has room for at first.
static moray_status keep_many(void)
{
    char text[2000] = "{\"cost\": 1";
    struct store store = {0};
    bool better;
    for (int k = 0; k < 80; k++)
        snprintf(text + strlen(text), sizeof text - strlen(text), ", \"of_%d\": %d", k, k);
    strcat(text, "}");
    moray_status status = moray_store_new(&store, &grid);
    if (!moray_failed(status))
        status = add(&store, text, &better);
    if (!moray_failed(status) && (store.n != 81 || store.value[80][1] != 79 || !isnan(store.value[80][0])))
        status = moray_error(MORAY_NUMERIC, "%d numbers, the last %g", store.n, store.value[store.n - 1][1]);
    moray_store_free(&store);
    if (mapped != 0)
        return moray_error(MORAY_NUMERIC, "%zu bytes are not given back", mapped);
    return status;
}

static moray_status none(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point, (void)summary, (void)self;
    return moray_ok();
}

static moray_status make_plan(void)
{
    static const double values[] = {1, 2, 3};
    static const moray_sweep_axis axis = {.key = "x", .value = values, .n = 3};
    static const moray_sweep_spec line = {.axis = &axis, .axes = 1, .solve = none, .warm = true, .objective = "cost"};
    struct grid points;
    struct store store;
    struct plan plan;
    struct task task;
    MORAY_TRY(moray_grid_new(&line, &points));
    moray_status status = moray_store_new(&store, &points);
    if (moray_failed(status))
        return mapped == 0 ? status : moray_error(MORAY_NUMERIC, "%zu bytes are not given back", mapped);
    status = moray_plan_new(&plan, &points, &store);
    if (!moray_failed(status) && !(moray_plan_next(&plan, &task) && task.point == 1 && task.start == -1))
        status = moray_error(MORAY_NUMERIC, "point %ld is first", task.point);
    if (!moray_failed(status))
        moray_plan_free(&plan);
    moray_store_free(&store);
    return mapped == 0 ? status : moray_error(MORAY_NUMERIC, "%zu bytes are not given back", mapped);
}

// Of two answers the one of the lower objective stays, whichever comes first; that of the other is told beside it.
static void test_better(void)
{
    static const char *const answers[] = {"{\"cost\": 2, \"way\": 5}", "{\"cost\": 1.5, \"way\": 7}"};
    for (int first = 0; first < 2; first++) {
        struct store store;
        bool better[2];
        CHECK_OK(moray_store_new(&store, &grid), "store");
        CHECK_OK(add(&store, answers[first], &better[0]), "an answer");
        CHECK_OK(add(&store, answers[1 - first], &better[1]), "another");
        CHECK(better[0] && better[1] == (first == 0), "the second is better where the first was the worse");
        CHECK(store.objective[1] == 1.5 && store.other[1] == 2 && store.state[1] == POINT_SOLVED &&
                  store.state[0] == POINT_UNTRIED,
              "%g is kept, %g beside it", store.objective[1], store.other[1]);
        CHECK(store.n == 2 && store.value[1][1] == 7, "with the numbers of the better one");
        moray_store_free(&store);
    }
}

int main(void)
{
    test_better();
    fail_each("numbers of a point", false, keep_many);
    fail_each("a plan", false, make_plan);
    return tap_done();
}
