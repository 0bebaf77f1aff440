// SPDX-License-Identifier: MIT
//
// Pieces of a sweep: the grid of points, what a point left (record), all that is known (store), its journal on disk and
// its NetCDF file, the plan of what is solved next from what, and the crew that solves it.
#ifndef SRC_SWEEP_SWEEP_H
#define SRC_SWEEP_SWEEP_H

#include <poll.h>
#include <stddef.h>
#include <sys/types.h>

#include "moray/app/sweep.h"
#include "moray/clock.h"

// ---- Grid ----------------------------------------------------------------------------------------------------------

// Axes of the points, the slowest first; with draws, theirs is axis 0 and the spec's follow.
enum { GRID_AXES = MORAY_SWEEP_AXES + 1 };
struct grid {
    const moray_sweep_spec *spec;
    int axes, first; // first: of the spec's axes, 1 with draws
    long shape[GRID_AXES], points;
};

moray_status moray_grid_new(const moray_sweep_spec *spec, struct grid *grid); // Error: MORAY_INPUT
void moray_grid_place(const struct grid *grid, long point, long at[GRID_AXES]);
bool moray_grid_numeric(const struct grid *grid, int axis); // its values are numbers, so that its neighbours are near
double moray_grid_coordinate(const struct grid *grid, long point, int axis); // of a numeric axis

// Where a point begins unless it is the first of its kind: a point nearer to the middle of the numeric axes, or an
// earlier draw near it. -1: nowhere.
long moray_grid_parent(const struct grid *grid, long point);

// The point `steps` further along an axis, or -1.
long moray_grid_step(const struct grid *grid, long point, int axis, long steps);

// Value of range r in a draw: of (seed, draw, r) alone.
double moray_grid_draw(const moray_sweep_spec *spec, long draw, int r);

// Settings of a point: texts into text[32 n]; n = axes + ranges of the spec.
void moray_grid_settings(const struct grid *grid, long point, moray_key_value *setting, double *value,
                         char (*text)[32]);

// ---- Memory --------------------------------------------------------------------------------------------------------

// Zeroed memory that the processes of points do not have: to make one would take the longer the more points there are.
// NULL: none is left.
void *moray_apart_new(size_t n, size_t size);
void moray_apart_free(void *memory, size_t n, size_t size); // NULL is allowed

// ---- Records -------------------------------------------------------------------------------------------------------

// One attempt at a point.
struct task {
    long point, start; // start: the point whose solution it begins with, -1: the default
    int round;         // 0: from its parent; 1...: from neighbours whose branch is better
    int start_round;   // in which the solution at `start` was found
};

struct record {
    struct task task;
    moray_code code;
    double seconds;
    char *reason, *found; // owned; found: a JSON object on one line, or NULL
    struct cJSON *read;   // the same, read; owned
};

void moray_record_free(struct record *record);
char *moray_record_line(const struct record *record);                    // to be freed; NULL: no memory
moray_status moray_record_read(const char *line, struct record *record); // Error: MORAY_INPUT, MORAY_MEMORY
bool moray_record_task(const char *line, struct task *task);             // no more than what it was an attempt at
// The object that a text holds, on one line, and read unless `read` is NULL, both to be freed; NULL where it holds
// none. Error: MORAY_MEMORY.
moray_status moray_json_on_one_line(const char *text, char **line, struct cJSON **read);

// ---- Store ---------------------------------------------------------------------------------------------------------

enum { POINT_UNTRIED, POINT_SOLVED, POINT_FAILED };
struct store {
    const struct grid *grid;
    int n, room; // columns
    char **name;
    double **value;                    // [n][points], NaN where there is none
    signed char *state, *code, *round; // [points]; round: in which what it has was found
    long *start;
    double *seconds, *objective, *other; // other: the objective of a branch that was given up, NaN: none
    char **reason;
};

moray_status moray_store_new(struct store *store, const struct grid *grid); // Error: MORAY_MEMORY
void moray_store_free(struct store *store);

// Takes an attempt in: the point keeps the better of two solutions, and any solution before a failure. *better tells
// whether the attempt is now what the point has. Error: MORAY_MEMORY.
moray_status moray_store_add(struct store *store, const struct record *record, bool *better);

// ---- Identity ------------------------------------------------------------------------------------------------------

// What has to be the same for a file to be gone on with, a JSON object on one line, to be freed; NULL: no memory.
char *moray_identity_line(const struct grid *grid);
// MORAY_INPUT, with the first thing in which two of them differ. path: for the text.
moray_status moray_identity_refuse(const char *path, const char *there, const char *asked);

// ---- Files ---------------------------------------------------------------------------------------------------------

enum { BESIDE_SIZE = 4200 };
void moray_files_beside(const moray_sweep_spec *spec, const char *end, char path[BESIDE_SIZE]); // FILE.end
// A file that is there and is not this sweep's is not written over. Error: MORAY_INPUT.
moray_status moray_files_check(const moray_sweep_spec *spec);
// The folder in which points leave their solutions, where they are to. Error: MORAY_IO.
moray_status moray_files_begin(const moray_sweep_spec *spec);
void moray_files_remove_solutions(const moray_sweep_spec *spec);
// Of a sweep whose every point was refused nothing is worth going on with.
void moray_files_remove_all(const moray_sweep_spec *spec);

// ---- Journal -------------------------------------------------------------------------------------------------------

// Lines of records behind a first line that says of which sweep they are; every line with its checksum. A line that is
// damaged is as if it were not there, and a torn end is cut off. What was there is kept as places in the file, since
// the texts of a million points have no room in memory.
struct entry {
    struct task task;
    long at, length; // of its text
};
struct journal {
    int fd;
    FILE *file;        // of fd, to read it; closing it would end the lock
    double synced;     // clock of the last one
    struct entry *old; // what was there when it was opened, by (point, round, start)
    long n_old, room;
    bool finished, made; // when it was opened: by the line at its end; it was not there
};

// Opens or makes it, locks it, reads what is there. Error: MORAY_INPUT (another sweep's, or no journal; another process
// has it), MORAY_IO, MORAY_MEMORY.
moray_status moray_journal_open(struct journal *journal, const char *path, const char *identity);
void moray_journal_close(struct journal *journal);
// Of the old ones, to be freed; *found: whether there is one. Error: MORAY_IO, MORAY_MEMORY.
moray_status moray_journal_find(const struct journal *journal, const struct task *task, struct record *record,
                                bool *found);
moray_status moray_journal_add(struct journal *journal, const struct record *record); // Error: MORAY_IO, MORAY_MEMORY

// ---- NetCDF --------------------------------------------------------------------------------------------------------

// Writes all that is known to spec->file, at once. Error: MORAY_IO.
moray_status moray_store_write(const struct store *store, bool finished);

enum { NETCDF_NAME = 257 };                                                   // of the longest name and its end
void moray_netcdf_name(const char *path, char name[NETCDF_NAME]);             // of a number, in the file
int moray_netcdf_content(int file, const struct store *store, bool finished); // all of it; an error of NetCDF, or 0

// ---- Page ----------------------------------------------------------------------------------------------------------

// Writes the page spec->page, at once; `progress` is a line above the map. Error: MORAY_IO.
moray_status moray_page_write(const struct store *store, const char *progress, bool ended);

// ---- Plan ----------------------------------------------------------------------------------------------------------

// What is to be done next, from what is known. The same answers give the same plan, in whatever order they come.
struct plan {
    const struct grid *grid;
    struct store *store;
    struct task *ready; // a ring of `room`
    long room, head, n;
    long *child, *sibling; // trees of parents, -1: none
    long pending;          // handed out, not answered
    int round;
    long answered, expected; // attempts, of those known so far
    long warm, held, improved;
};

moray_status moray_plan_new(struct plan *plan, const struct grid *grid, struct store *store); // Error: MORAY_MEMORY
void moray_plan_free(struct plan *plan);
bool moray_plan_next(struct plan *plan, struct task *next); // false: none now (all done where nothing is pending)
moray_status moray_plan_answer(struct plan *plan, const struct record *record, bool *better);

// ---- Processes -----------------------------------------------------------------------------------------------------

// In the process of a point: solves it, leaves its summary in the one pipe and what else it says in the other, and
// ends. The text of its status stands behind a REASON_MARK. Ends with its parent.
enum { REASON_MARK = 036 };
_Noreturn void moray_child_run(const struct grid *grid, const struct task *task, const int summary[2],
                               const int errors[2], pid_t parent);

// A point being solved in a process of its own.
struct worker {
    pid_t pid; // 0: idle
    int ends;  // readable once it has ended; -1: the system has no such thing
    struct task task;
    int killed;  // how often it was from outside, and begun again
    int pipe[2]; // to read from: the summary; what it says besides; -1: at its end
    char *text[2];
    size_t length[2];
    double begun, deadline;
    bool late;
    int wait_status;
};

moray_status moray_worker_begin(struct worker *worker, const struct grid *grid,
                                const struct task *task);           // Error: MORAY_IO
moray_status moray_worker_read(struct worker *worker, bool *ended); // Error: MORAY_MEMORY
// Once ended: neither by itself nor for being late, so that it may well be solved by another attempt.
bool moray_worker_was_killed(const struct worker *worker);
moray_status moray_worker_again(struct worker *worker, const struct grid *grid); // Error: MORAY_IO
moray_status moray_worker_record(struct worker *worker, const struct grid *grid,
                                 struct record *record); // once ended; then idle
void moray_worker_kill(struct worker *worker);

// Where a point leaves its solution, into path[size].
void moray_solution_path(const moray_sweep_spec *spec, long point, int round, char *path, size_t size);

// A rank other than this one: all of them, as the first one knows them; of the first one, when others last heard of it.
struct other {
    bool busy, lost; // has a task; has been silent for too long
    bool given_away; // its task, when it was lost: what it finds is no longer wanted
    double heard;    // clock
    struct task task;
};

// Everybody who solves points: processes of this machine or ranks.
struct crew {
    const struct grid *grid;
    int n_workers;
    struct worker *worker;
    struct pollfd *poll; // [3 n_workers]
    int ranks, rank;
    int lost;            // ranks, at present
    bool leaves;         // without waiting for the others at its end: one of them is lost
    struct other *other; // [ranks]
    struct task *orphan; // [ranks], orphans of them: tasks of those who are lost
    int orphans;
    double shown; // clock; when this rank last showed that it is alive
};

moray_status moray_crew_new(struct crew *crew, const struct grid *grid);
void moray_crew_free(struct crew *crew);       // kills what runs, sends the ranks home
bool moray_crew_idle(const struct crew *crew); // somebody waits for a task
moray_status moray_crew_begin(struct crew *crew, const struct task *task);
// Waits at most `seconds` for a record. Error: MORAY_MEMORY, MORAY_IO.
moray_status moray_crew_wait(struct crew *crew, double seconds, struct record *record, bool *found);
moray_status moray_crew_serve(struct crew *crew); // on other ranks: works until it is sent home

// Parts of both sides. The silence [s] by which a rank is lost.
double moray_crew_silence(const struct crew *crew);
// Now and then: of the first rank to all others, of these to the first one.
void moray_crew_show_life(struct crew *crew);
// Until a process says something or is late, or `seconds` are over; of ranks' messages not for long.
void moray_crew_sleep(struct crew *crew, double seconds);
// A process that somebody killed says nothing of its point, which is tried again; one that is killed each time, as by a
// system out of memory, does.
moray_status moray_crew_answer_of_worker(struct crew *crew, struct record *record, bool *found);

// MPI, whatever its library: sizes and messages of one text.
struct ranks {
    int size, rank;
};
struct ranks moray_ranks_begin(void); // {1, 0} where nobody started several; ends with the process
void moray_ranks_leave(void);         // at the end of the process nobody waits for the others
void moray_ranks_send(int to, const char *text);
char *moray_ranks_receive(int *from); // a text that has come, to be freed, or NULL

#endif
