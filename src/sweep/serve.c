// SPDX-License-Identifier: MIT
//
// A rank other than the first: one process after the other for what the first one asks.
#include "sweep/sweep.h"

#include <stdlib.h>
#include <string.h>

static moray_status answer(const struct record *record)
{
    char *line = moray_record_line(record);
    if (!line)
        return moray_error(MORAY_MEMORY, "no memory for a record");
    moray_ranks_send(0, line);
    free(line);
    return moray_ok();
}

// What the first rank says, if anything: a task, or that this one is to go home, whatever it has in hand.
static moray_status obey(struct crew *crew, bool *home)
{
    int from;
    struct task task;
    enum { patience = 10 };
    char *text = moray_ranks_receive(&from);
    const double now = moray_clock();
    if (!text && now - crew->other[0].heard < patience * moray_crew_silence(crew))
        return moray_ok();
    crew->leaves = !text || strcmp(text, "leave") == 0;
    if (!text)
        return moray_error(MORAY_INTERRUPTED, "the first rank has been silent for %.3g s; the same command goes on",
                           now - crew->other[0].heard);
    crew->other[0].heard = now;
    *home = crew->leaves || strcmp(text, "home") == 0;
    const int read = sscanf(text, "task %ld %ld %d %d", &task.point, &task.start, &task.round, &task.start_round);
    free(text);
    return read == 4 ? moray_worker_begin(&crew->worker[0], crew->grid, &task) : moray_ok();
}

moray_status moray_crew_serve(struct crew *crew)
{
    for (bool home = false;;) {
        struct record record;
        bool found = false;
        MORAY_TRY(obey(crew, &home));
        if (home)
            return moray_ok();
        moray_crew_show_life(crew);
        moray_crew_sleep(crew, 1);
        MORAY_TRY(moray_crew_answer_of_worker(crew, &record, &found));
        if (!found)
            continue;
        const moray_status status = answer(&record);
        moray_record_free(&record);
        MORAY_TRY(status);
    }
}
