// SPDX-License-Identifier: MIT
#include "sweep/sweep.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/results.h"

typedef struct run {
    const moray_sweep_spec *spec;
    struct grid grid;
    struct store store;
    struct plan plan;
    struct journal journal;
    struct crew crew;
    moray_ticker ticker;
    moray_sweep_result *result;
    double begun, saved, saving; // clock; of the last saving; what that took
    double paged, paging;        // the same of the page
    long fresh, refused;         // attempts of this run; of all, those that were bad input
    bool all_refused;
} run;

static moray_status save(run *r, bool finished)
{
    const double begun = moray_clock();
    const moray_status status = moray_store_write(&r->store, finished);
    r->saved = moray_clock();
    r->saving = r->saved - begun;
    r->result->saving += r->saving;
    return status;
}

// Often enough to be looked at, and never so often that it costs more than a few percent.
static moray_status save_at_times(run *r)
{
    const double least = r->spec->save_seconds > 0 ? r->spec->save_seconds : 30;
    return moray_clock() - r->saved > fmax(least, 50 * r->saving) ? save(r, false) : moray_ok();
}

static void progress(const run *r, char *text, size_t size)
{
    const double seconds = moray_clock() - r->begun, rate = (double)r->fresh / seconds;
    const long left = r->plan.expected - r->plan.answered;
    snprintf(text, size, "%ld of %ld, %ld failed", r->plan.answered, r->plan.expected, r->result->failed);
    if (r->fresh > 0 && left > 0)
        moray_text_add(text, size, ", %.3g a second, %.0f s left", rate, (double)left / rate);
    if (r->crew.lost > 0)
        moray_text_add(text, size, ", %d ranks lost", r->crew.lost);
}

// On the terminal at once; on the page, which takes time where points are many, every few seconds.
static moray_status tell(run *r, bool ended)
{
    char text[200];
    const double begun = moray_clock();
    progress(r, text, sizeof text);
    if (r->fresh > 0)
        moray_ticker_show(&r->ticker, "sweep: %s", text);
    if (!r->spec->page || (!ended && begun - r->paged < fmax(2, 50 * r->paging)))
        return moray_ok();
    const moray_status status = moray_page_write(&r->store, text, ended);
    r->paged = moray_clock();
    r->paging = r->paged - begun;
    return status;
}

// A key that the program has not is no matter of a point, and refusals are quick.
enum { enough_refused = 1000 };

static moray_status take(run *r, const struct record *record)
{
    bool better;
    const signed char before = r->store.state[record->task.point];
    MORAY_TRY(moray_plan_answer(&r->plan, record, &better));
    const signed char now = r->store.state[record->task.point];
    r->result->failed += (now == POINT_FAILED) - (before == POINT_FAILED);
    r->result->solved += (now == POINT_SOLVED) - (before == POINT_SOLVED);
    r->refused += record->code == MORAY_INPUT;
    r->all_refused = r->refused == r->plan.answered && (r->refused >= enough_refused || r->refused >= r->grid.points);
    return r->all_refused ? moray_error(MORAY_INPUT, "every point so far is refused: %s", record->reason) : moray_ok();
}

static moray_status keep_and_take(run *r, const struct record *record)
{
    const double begun = moray_clock();
    MORAY_TRY(moray_journal_add(&r->journal, record));
    r->result->saving += moray_clock() - begun;
    r->result->busy += record->seconds;
    r->fresh++;
    return take(r, record);
}

static moray_status wait_for_one(run *r)
{
    struct record record = {0};
    bool found = false;
    const double used = moray_processor_clock();
    moray_status status = moray_crew_wait(&r->crew, 0.5, &record, &found);
    if (!moray_failed(status) && found)
        status = keep_and_take(r, &record);
    r->result->handing += moray_processor_clock() - used;
    moray_record_free(&record);
    MORAY_TRY(status);
    MORAY_TRY(tell(r, false));
    return save_at_times(r);
}

static moray_status begin_or_recall(run *r, const struct task *task)
{
    struct record old;
    bool found;
    MORAY_TRY(moray_journal_find(&r->journal, task, &old, &found));
    if (!found)
        return moray_crew_begin(&r->crew, task);
    r->result->before++;
    const moray_status status = take(r, &old);
    moray_record_free(&old);
    return status;
}

static moray_status solve_all(run *r)
{
    struct task task;
    for (;;) {
        while (moray_crew_idle(&r->crew) && moray_plan_next(&r->plan, &task))
            MORAY_TRY(begin_or_recall(r, &task));
        if (r->plan.pending == 0)
            return moray_ok();
        if (r->spec->stop && r->spec->stop())
            return moray_error(MORAY_INTERRUPTED, "interrupted with %ld of %ld attempts made; the same command goes on",
                               r->plan.answered, r->plan.expected);
        MORAY_TRY(wait_for_one(r));
    }
}

static moray_status finish(run *r, moray_status status)
{
    if (r->all_refused && r->journal.made) {
        moray_files_remove_all(r->spec);
        return status;
    }
    const bool finished = !moray_failed(status);
    const moray_status saved = save(r, finished), told = tell(r, true);
    if (finished)
        status = moray_failed(saved) ? saved : told;
    if (!moray_failed(status) && !r->journal.finished)
        status = moray_journal_add(&r->journal, NULL);
    if (!moray_failed(status))
        moray_files_remove_solutions(r->spec);
    return status;
}

static moray_status lead(run *r)
{
    MORAY_TRY(moray_files_check(r->spec));
    char path[BESIDE_SIZE], *identity = moray_identity_line(&r->grid);
    moray_files_beside(r->spec, "journal", path);
    moray_status status = identity ? moray_journal_open(&r->journal, path, identity)
                                   : moray_error(MORAY_MEMORY, "no memory for a journal");
    free(identity);
    MORAY_TRY(status);
    status = moray_files_begin(r->spec);
    if (!moray_failed(status))
        status = tell(r, false);
    if (!moray_failed(status))
        status = save(r, false); // before hours of work: whether it can be written at all
    if (!moray_failed(status))
        status = finish(r, solve_all(r));
    r->result->lost = r->crew.lost;
    r->result->warm = r->plan.warm;
    r->result->held = r->plan.held;
    r->result->improved = r->plan.improved;
    moray_journal_close(&r->journal);
    return status;
}

static moray_status work(run *r)
{
    r->result->points = r->grid.points;
    r->result->ranks = r->crew.ranks;
    r->result->jobs = r->crew.n_workers;
    if (r->crew.rank > 0)
        return moray_crew_serve(&r->crew);
    MORAY_TRY(moray_store_new(&r->store, &r->grid));
    moray_status status = moray_plan_new(&r->plan, &r->grid, &r->store);
    if (!moray_failed(status)) {
        r->ticker = moray_ticker_start(stderr, r->spec->quiet);
        status = lead(r);
        moray_ticker_end(&r->ticker);
    }
    moray_plan_free(&r->plan);
    moray_store_free(&r->store);
    return status;
}

moray_status moray_sweep(const moray_sweep_spec *spec, moray_sweep_result *result)
{
    *result = (moray_sweep_result){0};
    run r = {.spec = spec, .result = result, .begun = moray_clock(), .journal = {.fd = -1}};
    if (!spec->file || !*spec->file || strlen(spec->file) > 4000)
        return moray_error(MORAY_INPUT, "file of a sweep: must be a path of at most 4000 characters");
    MORAY_TRY(moray_grid_new(spec, &r.grid));
    MORAY_TRY(moray_crew_new(&r.crew, &r.grid));
    struct sigaction before; // a file that grows beyond a limit is told, as a disk that is full is
    sigaction(SIGXFSZ, &(struct sigaction){.sa_handler = SIG_IGN}, &before);
    const moray_status status = work(&r);
    sigaction(SIGXFSZ, &before, NULL);
    moray_crew_free(&r.crew);
    result->seconds = moray_clock() - r.begun;
    return status;
}
