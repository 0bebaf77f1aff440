// SPDX-License-Identifier: MIT
//
// What is kept of a solver's iterations: as many as there is room for, each of them told to the user.
#include "tap.h"

#include "moray/ocp.h"
#include "ocp/solution.h"

static bool tell(void *observer, const moray_progress *progress)
{
    int *told = observer;
    *told += progress->iteration;
    return progress->iteration != 7;
}

static bool keep(struct iterations *kept, int iteration)
{
    return moray_iterations_keep(kept, &(moray_progress){.iteration = iteration});
}

static void test_room(void)
{
    struct iterations *kept = calloc(1, sizeof *kept);
    int told = 0;
    if (!kept)
        exit(1);
    CHECK_OK(moray_iterations_room(kept, 2), "room");
    CHECK(kept->room == 3 && kept->n == 0, "the start and two iterations");
    for (int k = 1; k <= 3; k++)
        CHECK(keep(kept, k) && kept->n == k && kept->at[k - 1].iteration == k, "iteration %d is kept", k);
    CHECK(keep(kept, 4) && kept->n == 3 && kept->at[2].iteration == 3, "one more has no room");
    CHECK_OK(moray_iterations_room(kept, 1), "of a second solve");
    CHECK(kept->room == 5 && kept->n == 3 && kept->at[0].iteration == 1, "beside those of the first");
    kept->progress = tell, kept->observer = &told;
    CHECK(keep(kept, 6) && !keep(kept, 7) && kept->n == 5, "the user has the last word");
    CHECK(told == 13, "and is told of each");
    CHECK_OK(moray_iterations_room(kept, MORAY_KEPT_ITERATIONS + 9), "of very many");
    CHECK(kept->room == 5 + 1 + MORAY_KEPT_ITERATIONS, "so many are kept");
    const moray_solution solution = {.iterations = kept}, none = {.iterations = NULL};
    int n = -1;
    CHECK(moray_solution_iterations(&solution, &n) == kept->at && n == 5, "of a solution");
    CHECK(!moray_solution_iterations(&none, &n) && n == 0, "of one without");
    moray_iterations_free(kept);
    moray_iterations_free(NULL);
}

int main(void)
{
    test_room();
    return tap_done();
}
