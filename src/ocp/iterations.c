// SPDX-License-Identifier: MIT
#include "ocp/solution.h"

#include <stdlib.h>

bool moray_iterations_keep(void *observer, const moray_progress *progress)
{
    struct iterations *kept = observer;
    if (kept->n < kept->room)
        kept->at[kept->n++] = *progress;
    return !kept->progress || kept->progress(kept->observer, progress);
}

moray_status moray_iterations_room(struct iterations *kept, int max_iterations)
{
    const int room = kept->n + 1 + (max_iterations < MORAY_KEPT_ITERATIONS ? max_iterations : MORAY_KEPT_ITERATIONS);
    moray_progress *at = realloc(kept->at, (size_t)room * sizeof *at);
    if (!at)
        return moray_error(MORAY_MEMORY, "no memory for %d iterations", room);
    kept->at = at;
    kept->room = room;
    return moray_ok();
}

void moray_iterations_free(struct iterations *iterations)
{
    if (iterations)
        free(iterations->at);
    free(iterations);
}

const moray_progress *moray_solution_iterations(const moray_solution *solution, int *n)
{
    *n = solution->iterations ? solution->iterations->n : 0;
    return solution->iterations ? solution->iterations->at : NULL;
}
