// SPDX-License-Identifier: MIT
//
// Ranks that fall silent, come back, and answer too late, as the first one hears them; and a rank that is sent home
// while it works. What ranks say goes through this test in place of MPI. What they send: records that are none of ours.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "sweep/sweep.h"

// ---- In place of ranks.c -------------------------------------------------------------------------------------------

typedef struct message {
    int rank; // from or to
    char text[200];
} message;

static struct ranks here = {3, 0};
static message said[16], sent[16];       // by others; by us
static int n_said, heard, n_sent, shown; // shown: how often we said that we are alive
static bool left;

struct ranks moray_ranks_begin(void)
{
    return here;
}

void moray_ranks_leave(void)
{
    left = true;
}

void moray_ranks_send(int to, const char *text)
{
    if (strcmp(text, "alive") == 0) {
        shown++;
        return;
    }
    sent[n_sent].rank = to;
    snprintf(sent[n_sent].text, sizeof sent[n_sent].text, "%s", text);
    n_sent += n_sent + 1 < 16;
}

char *moray_ranks_receive(int *from)
{
    if (heard == n_said)
        return NULL;
    *from = said[heard].rank;
    return strdup(said[heard++].text);
}

static void say(int rank, const char *text)
{
    said[n_said].rank = rank;
    snprintf(said[n_said++].text, sizeof said->text, "%s", text);
}

static void say_answer(int rank, const struct task *task)
{
    struct record record = {.task = *task, .code = MORAY_OK};
    char *line = moray_record_line(&record);
    say(rank, line ? line : "");
    free(line);
}

// ---- Tests ---------------------------------------------------------------------------------------------------------

static const double silence = 0.05;
static const double values[] = {1, 2, 3};
static const moray_sweep_axis axis = {.key = "x", .value = values, .n = 3};

static moray_status sleep_long(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point, (void)summary, (void)self;
    sleep(60);
    return moray_ok();
}

static const moray_sweep_spec spec = {
    .file = "crew.nc", .axis = &axis, .axes = 1, .solve = sleep_long, .silent_seconds = silence};
static struct grid grid;

static struct crew begin(int rank)
{
    struct crew crew = {0};
    here.rank = rank;
    n_said = heard = n_sent = shown = 0;
    left = false;
    CHECK_OK(moray_crew_new(&crew, &grid), "a crew of three ranks");
    if (rank == 0)
        crew.n_workers = 0; // the first one solves nothing, so that all goes to the others
    return crew;
}

// Hears what has been said; whether an answer was among it.
static bool listen(struct crew *crew)
{
    struct record record = {0};
    bool found = false;
    CHECK_OK(moray_crew_wait(crew, 0, &record, &found), "listening");
    moray_record_free(&record);
    return found;
}

static void be_silent(void)
{
    nanosleep(&(struct timespec){.tv_nsec = (long)(1.5e9 * silence)}, NULL);
}

static bool has_sent(int to, const char *text)
{
    return n_sent > 0 && sent[n_sent - 1].rank == to && strcmp(sent[n_sent - 1].text, text) == 0;
}

static void test_idle(void)
{
    const struct task one = {.point = 1, .start = -1};
    struct crew crew = begin(0);
    be_silent();
    listen(&crew);
    CHECK(shown == 2, "the first one shows both others that it is alive: %d", shown);
    CHECK(crew.lost == 2 && !moray_crew_idle(&crew), "ranks that are silent are lost: %d", crew.lost);
    say(2, "alive");
    listen(&crew);
    CHECK(crew.lost == 1 && moray_crew_idle(&crew), "an idle one that is heard again is lost no longer: %d", crew.lost);
    CHECK_OK(moray_crew_begin(&crew, &one), "a task");
    CHECK(has_sent(2, "task 1 -1 0 0"), "is for it");
    say_answer(2, &one);
    CHECK(listen(&crew), "and its answer counts");
    moray_crew_free(&crew);
    CHECK(has_sent(2, "leave") && left, "at the end nobody waits for the other one");
}

static void test_busy(void)
{
    const struct task one = {.point = 1, .start = -1}, two = {.point = 2, .start = 0, .round = 1, .start_round = 3};
    struct crew crew = begin(0);
    CHECK_OK(moray_crew_begin(&crew, &one), "a task for the first");
    be_silent();
    say(2, "alive");
    listen(&crew);
    CHECK(crew.lost == 1 && has_sent(2, "task 1 -1 0 0"), "what a lost one had in hand is another's");
    say(1, "alive");
    listen(&crew);
    CHECK(crew.lost == 0 && !moray_crew_idle(&crew), "heard again it is not lost, but works on what is not wanted");
    be_silent();
    say(2, "alive");
    const int before = n_sent;
    listen(&crew);
    CHECK(crew.lost == 1 && crew.orphans == 0 && n_sent == before, "silent again, its task is not given away again");
    say_answer(1, &one);
    CHECK(!listen(&crew) && crew.lost == 0, "its late answer does not count");
    CHECK(moray_crew_idle(&crew), "and it is free");
    say_answer(2, &one);
    CHECK(listen(&crew), "that of the other one does");
    CHECK_OK(moray_crew_begin(&crew, &two), "the next task");
    CHECK(has_sent(1, "task 2 0 1 3"), "is for whoever is free");
    moray_crew_free(&crew);
    CHECK(has_sent(2, "home") && !left, "at the end all are sent home");
}

static void test_waiting(void)
{
    const struct task one = {.point = 0, .start = -1}, two = {.point = 1, .start = -1};
    struct crew crew = begin(0);
    CHECK_OK(moray_crew_begin(&crew, &one), "one task each");
    CHECK_OK(moray_crew_begin(&crew, &two), "one task each");
    be_silent();
    listen(&crew);
    CHECK(crew.lost == 2 && crew.orphans == 2, "where all are lost their tasks wait: %d", crew.orphans);
    say_answer(1, &one);
    CHECK(!listen(&crew) && crew.orphans == 1 && crew.other[1].busy, "for the first who comes back");
    moray_crew_free(&crew);
}

static void test_sent_home(void)
{
    struct crew crew = begin(1);
    say(0, "task 2 1 3 4");
    say(0, "home");
    const time_t begun = time(NULL);
    CHECK_OK(moray_crew_serve(&crew), "a rank that is sent home");
    CHECK(crew.worker[0].pid > 0 && time(NULL) - begun < 30, "goes at once, whatever it has in hand");
    const struct task *task = &crew.worker[0].task;
    CHECK(task->point == 2 && task->start == 1 && task->round == 3 && task->start_round == 4,
          "which is what was asked");
    CHECK(!crew.leaves, "the others wait for it");
    moray_crew_free(&crew);
}

static void test_first_is_gone(void)
{
    struct crew crew = begin(1);
    say(0, "task 2 -1 0 0");
    const double begun = moray_clock();
    const moray_status status = moray_crew_serve(&crew);
    CHECK(status.code == MORAY_INTERRUPTED && strstr(status.text, "silent"), "where the first one is gone: %s",
          status.text);
    CHECK(moray_clock() - begun > 5 * silence && moray_clock() - begun < 30, "the others go, but not soon");
    CHECK(shown > 2, "having shown that they are alive: %d times", shown);
    moray_crew_free(&crew);
    CHECK(left, "and wait for nobody");
}

static moray_status solve_at_once(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)self;
    fprintf(summary, "{\"x\": %g}", point->value[0]);
    return moray_ok();
}

// A rank answers with the record of its task, and is free for the next.
static void test_answers(void)
{
    moray_sweep_spec quick = spec;
    struct grid own = grid;
    struct record record;
    quick.solve = solve_at_once, own.spec = &quick;
    struct crew crew = begin(1);
    crew.grid = &own;
    say(0, "task 2 -1 1 0");
    CHECK(moray_crew_serve(&crew).code == MORAY_INTERRUPTED, "until the first one is missed");
    CHECK(n_sent == 1 && sent[0].rank == 0, "it has answered once");
    CHECK_OK(moray_record_read(sent[0].text, &record), "with a record");
    CHECK(record.task.point == 2 && record.task.start == -1 && record.task.round == 1 && record.code == MORAY_OK &&
              record.found && strcmp(record.found, "{\"x\":3}") == 0,
          "of what it found: %s", sent[0].text);
    CHECK(crew.worker[0].pid == 0, "and is idle");
    moray_record_free(&record);
    moray_crew_free(&crew);
}

// Sent away as one of others is lost, it waits for nobody; the first of sixteen at least solves nothing itself.
static void test_sizes(void)
{
    struct crew crew = begin(1);
    say(0, "leave");
    CHECK_OK(moray_crew_serve(&crew), "a rank that is to leave");
    CHECK(crew.leaves, "goes");
    moray_crew_free(&crew);
    CHECK(left, "without the others");
    for (int size = 16; size <= 17; size++)
        for (int rank = 0; rank < 2; rank++) {
            here.size = size, here.rank = rank;
            CHECK_OK(moray_crew_new(&crew, &grid), "ranks");
            CHECK(crew.n_workers == !(size == 17 && rank == 0), "rank %d of %d has %d processes", rank, size,
                  crew.n_workers);
            moray_crew_free(&crew);
        }
    here.size = 3;
}

// A rank that hears something waits for as long again.
static void test_first_is_heard(void)
{
    struct crew crew = begin(1);
    const double begun = moray_clock();
    crew.other[0].heard = begun - 9.5 * silence;
    say(0, "alive");
    CHECK(moray_crew_serve(&crew).code == MORAY_INTERRUPTED && moray_clock() - begun > 9 * silence,
          "heard once, the first one is missed later: %g s", moray_clock() - begun);
    moray_crew_free(&crew);
}

// What a point has found is kept as it stands, which takes it where our writer leaves it.
static void test_records(void)
{
    static const char head[] =
        "{\"point\":3,\"start\":1,\"round\":0,\"start_round\":0,\"code\":0,\"seconds\":1,\"reason\":\"\"";
    static const char *const found[] = {",\"found\":{\"gain\":1}}", ",\t\"found\":{\"gain\":1}}", ",\"found\" :{}}",
                                        ",\"found\":3}", "}"};
    for (int k = 0; k < 5; k++) {
        struct record record;
        char line[200];
        snprintf(line, sizeof line, "%s%s", head, found[k]);
        const moray_status status = moray_record_read(line, &record);
        CHECK(status.code == (k == 0 || k == 4 ? MORAY_OK : MORAY_INPUT), "record%s: %s", found[k], status.text);
        CHECK(!record.found == (k > 0) && (k > 0 || strcmp(record.found, "{\"gain\":1}") == 0), "what it found");
        moray_record_free(&record);
    }
}

// A summary without what its program said behind it, which would make the record unreadable.
static void test_summary(void)
{
    char *line = NULL;
    CHECK_OK(moray_json_on_one_line("{\"x\":\n 4}\nand more\n", &line, NULL), "a summary and a word");
    CHECK(line && strcmp(line, "{\"x\":4}") == 0, "kept: %s", line ? line : "nothing");
    free(line);
    CHECK_OK(moray_json_on_one_line("and more", &line, NULL), "a word");
    CHECK(!line, "is no summary");
}

// Until a process says something, or is late; where its end wakes nobody it is looked at again at once.
static void test_sleep(void)
{
    int pipes[2];
    struct worker worker = {.pid = getpid(), .pipe = {-1, -1}};
    struct pollfd room[3];
    struct crew crew = {.n_workers = 1, .worker = &worker, .poll = room, .ranks = 1};
    for (int k = 0; k < 4; k++) {
        const bool told = k == 1, late = k == 2, idle = k == 3;
        CHECK(pipe(pipes) == 0 && (!told || write(pipes[1], "x", 1) == 1), "a pipe");
        worker.ends = k == 0 ? -1 : pipes[0];
        worker.deadline = moray_clock() + (late ? 0.02 : 1000);
        worker.pid = idle ? 0 : getpid();
        const double begun = moray_clock();
        moray_crew_sleep(&crew, idle ? 0.03 : 20);
        const double slept = moray_clock() - begun;
        CHECK(slept < 10 && (!late || slept > 0.015) && (!idle || slept > 0.025), "case %d: slept %g s", k, slept);
        close(pipes[0]), close(pipes[1]);
    }
}

int main(void)
{
    test_sleep();
    setvbuf(stdout, NULL, _IOLBF, 0); // processes that are made here have nothing of it to write
    CHECK_OK(moray_grid_new(&spec, &grid), "a grid");
    test_idle();
    test_busy();
    test_waiting();
    test_sent_home();
    test_first_is_gone();
    test_first_is_heard();
    test_answers();
    test_sizes();
    test_records();
    test_summary();
    return tap_done();
}
