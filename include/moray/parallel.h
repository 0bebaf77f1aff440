// SPDX-License-Identifier: MIT
//
// Independent tasks dealt to processes.
#ifndef MORAY_PARALLEL_H
#define MORAY_PARALLEL_H

#include <stddef.h>

#include "moray/export.h"
#include "moray/status.h"

MORAY_BEGIN

// Does task 0, 1, ... n - 1 once each: from the memory as it was when moray_parallel began, it fills *result, which is
// plain data: of what a pointer made there leads to, nothing is left. What a task changes besides may be gone, or be
// there for the next one; a result must not depend on it.
typedef void moray_task_fn(int task, void *result, void *self);

// How many processors this process may use: at least 1.
MORAY_API int moray_processors(void);

// Fills results[n], each of `size` bytes, by up to `jobs` processes, this one among them; jobs < 1: one a processor.
// The next task goes to whoever is free. Where processes or shared memory cannot be had, fewer do the same work, this
// one all of it if need be: results are those of one job. Error: MORAY_NUMERIC naming the task in which a process
// died. (A library's threads do not survive the making of a process: what a task calls must not wait for any.)
MORAY_API moray_status moray_parallel(int n, size_t size, void *results, moray_task_fn *task, void *self, int jobs);

// One task in a process of its own while this one goes on, for instance with what only it can do.
typedef struct moray_background moray_background;

// Begins it, likewise from the memory as it is now; its result, of `size` bytes, begins as it is given. Where no
// process can be had the task is done before this returns. End with moray_background_end. Error: MORAY_MEMORY, and
// *background is NULL.
MORAY_API moray_status moray_background_begin(moray_background **background, size_t size, const void *result,
                                              moray_task_fn *task, void *self);

// Waits for it, fills *result and frees it. Error: MORAY_NUMERIC when its process died.
MORAY_API moray_status moray_background_end(moray_background *background, void *result);

MORAY_END

#endif
