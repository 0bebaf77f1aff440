// SPDX-License-Identifier: MIT
//
// Sweeps of a function with a closed form, with points that misbehave, and with sweeps that are killed.
#define _GNU_SOURCE // mkdtemp, MAP_ANONYMOUS
#include "tap.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "moray/app/sweep.h"

static const double x_values[] = {-2, -1, 0, 1, 2, 3, 4}, y_values[] = {0.5, 1.5, 2.5};
static const moray_sweep_axis axes[] = {{.key = "x", .value = x_values, .n = 7},
                                        {.key = "y", .value = y_values, .n = 3}};
enum { points = 21 };

static void nap(double seconds)
{
    nanosleep(&(struct timespec){(time_t)seconds, (long)(1e9 * (seconds - (double)(time_t)seconds))}, NULL);
}

// Two branches, x^2 + y and (x - 3)^2 + y - 1: a default start finds the first, a neighbour's start its own or, where
// that ends, the other. Self: how long a point takes.
static double branch(int which, double x, double y)
{
    return which ? (x - 3) * (x - 3) + y - 1 : x * x + y;
}

static moray_status solve(const moray_sweep_point *point, FILE *summary, void *self)
{
    const double x = point->value[0], y = point->value[1], seconds = *(const double *)self;
    int which = x == 4; // by itself the second one is found here alone
    FILE *guess = point->guess ? fopen(point->guess, "r") : NULL;
    if (guess && fscanf(guess, "%d", &which) != 1)
        return moray_error(MORAY_INPUT, "%s holds no branch", point->guess);
    if (guess)
        fclose(guess);
    FILE *solution = fopen(point->solution, "w");
    if (solution) {
        fprintf(solution, "%d\n", which);
        fclose(solution);
    }
    nap(seconds);
    fprintf(summary,
            "{\"solver\": {\"objective\": %.17g}, \"branch\": %d, \"list\": [{\"model\": \"m\", \"twice\": %.17g}]}\n",
            branch(which, x, y), which, 2 * x);
    return moray_ok();
}

static double no_time = 0, some_time = 2e-3;

static moray_sweep_spec spec_of(const char *file, double *seconds)
{
    return (moray_sweep_spec){.file = file,
                              .axis = axes,
                              .axes = 2,
                              .solve = solve,
                              .self = seconds,
                              .objective = "solver.objective",
                              .warm = true,
                              .jobs = 2,
                              .quiet = true};
}

static double *numbers(const char *file, const char *name, long want)
{
    double *value;
    long n = 0;
    CHECK_OK(moray_sweep_numbers(file, name, &value, &n), name);
    CHECK(n == want, "%s has %ld numbers", name, n);
    return value;
}

static bool same(const char *file, const char *other, const char *name)
{
    double *a = numbers(file, name, points), *b = numbers(other, name, points);
    bool equal = a && b;
    for (int k = 0; equal && k < points; k++)
        equal = a[k] == b[k];
    free(a);
    free(b);
    return equal;
}

static bool all_same(const char *file, const char *other)
{
    return same(file, other, "solver.objective") && same(file, other, "branch") && same(file, other, "sweep_start") &&
           same(file, other, "sweep_state") && same(file, other, "list.m.twice");
}

static void remove_sweep(const char *file)
{
    char path[300];
    unlink(file);
    snprintf(path, sizeof path, "%s.journal", file);
    unlink(path);
}

static void test_values(void)
{
    char spread[] = "-0.2:0.2:5", list[] = "4,1e1,-2", words[] = "a,b:c", one[] = "7";
    const struct {
        char *text;
        int n;
        double first, last;
    } cases[] = {{spread, 5, -0.2, 0.2}, {list, 3, 4, -2}, {one, 1, 7, 7}};
    for (unsigned k = 0; k < 3; k++) {
        double *value;
        const char **word;
        int n;
        CHECK_OK(moray_sweep_values(cases[k].text, &value, &word, &n), "values");
        CHECK(n == cases[k].n && value && !word && value[0] == cases[k].first && value[n - 1] == cases[k].last,
              "%d numbers", n);
        CHECK(k > 0 || value[2] == 0, "the middle of a symmetric range is 0");
        free(value);
    }
    double *value;
    const char **word;
    int n;
    CHECK_OK(moray_sweep_values(words, &value, &word, &n), "words");
    CHECK(n == 2 && !value && strcmp(word[0], "a") == 0 && strcmp(word[1], "b:c") == 0, "two words");
    free(word);
    static const char *const wrong[] = {"1:2",     "1:2:0", "1:2:3x", "1:nan:3", "1:2:1", "1:2:1.5",
                                        "1:2:3:4", "1,,2",  "1,nan",  "-Inf,2",  ""};
    for (unsigned k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char text[20];
        snprintf(text, sizeof text, "%s", wrong[k]);
        const moray_status status = moray_sweep_values(text, &value, &word, &n);
        CHECK(status.code == MORAY_INPUT, "\"%s\" is refused: %s", wrong[k], status.text);
    }
}

static void test_closed_form(void)
{
    moray_sweep_spec spec = spec_of("closed.nc", &no_time);
    moray_sweep_result result;
    CHECK_OK(moray_sweep(&spec, &result), "sweep");
    CHECK(result.points == points && result.solved == points && result.failed == 0, "all %ld points", result.solved);
    CHECK(result.warm == points - 1 && result.held == result.warm, "all but the first begin from a neighbour: %ld",
          result.warm);
    double *objective = numbers("closed.nc", "solver.objective", points), *x = numbers("closed.nc", "x", 7);
    double worst = 0, gap = 0;
    for (int k = 0; objective && k < points; k++) {
        const double a = branch(0, x_values[k / 3], y_values[k % 3]), b = branch(1, x_values[k / 3], y_values[k % 3]);
        gap = tap_worse(gap, objective[k] - fmin(a, b));
        worst = tap_worse(worst, fmin(fabs(objective[k] - a), fabs(objective[k] - b)));
    }
    CHECK(worst == 0, "every point has the number of its function");
    CHECK(x && x[0] == -2 && x[6] == 4, "and its coordinates");
    CHECK(gap > 0, "a branch that no start finds is not found: %g", gap);
    free(objective);
    free(x);
    struct stat about;
    CHECK(stat("closed.nc.solutions", &about) != 0 && errno == ENOENT, "nothing of the neighbours' solutions is left");
}

// Without starts from neighbours x = 4 finds the second branch, and from there all that are better on it.
static moray_status solve_two(const moray_sweep_point *point, FILE *summary, void *self)
{
    if (point->guess && point->value[0] == 4)
        return moray_error(MORAY_NOT_SOLVED, "the start is too far away");
    return solve(point, summary, self);
}

static void test_branches(void)
{
    moray_sweep_spec spec = spec_of("two.nc", &no_time);
    moray_sweep_result result;
    spec.solve = solve_two;
    CHECK_OK(moray_sweep(&spec, &result), "sweep of two branches");
    CHECK(result.solved == points && result.held == points - 4,
          "where a neighbour's start fails, the default one is "
          "tried: %ld of %ld held",
          result.held, result.warm);
    CHECK(result.improved > 0, "%ld points are bettered from a neighbour's branch", result.improved);
    double *objective = numbers("two.nc", "solver.objective", points), worst = 0;
    for (int k = 0; objective && k < points; k++) {
        const double x = x_values[k / 3], y = y_values[k % 3];
        worst = tap_worse(worst, objective[k] - fmin(branch(0, x, y), branch(1, x, y)));
    }
    CHECK(worst == 0, "every point has the better branch: %g", worst);
    free(objective);
    spec.file = "two_by_one.nc";
    spec.jobs = 1;
    CHECK_OK(moray_sweep(&spec, &result), "by one job");
    CHECK(all_same("two.nc", "two_by_one.nc"), "the same, whoever solves it");
}

// A kink, across which lines promise what is not there: the solve from there differs by rounding.
static moray_status solve_kink(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)self;
    const double again = atof(strrchr(point->solution, '.') + 1); // round
    fprintf(summary, "{\"solver\": {\"objective\": %.17g}}\n", (1 + fabs(point->value[0])) * (1 - 1e-12 * again));
    return moray_ok();
}

static void test_rounding(void)
{
    moray_sweep_spec spec = spec_of("kink.nc", &no_time);
    moray_sweep_result result;
    spec.solve = solve_kink;
    CHECK_OK(moray_sweep(&spec, &result), "sweep over a kink");
    CHECK(result.solved == points && result.improved == 0, "%ld points are bettered by rounding", result.improved);
}

// Points at 0, 1, 2, 3, 4, or at 4 to 0, of which the last two are always on a branch of 1 + slope (x - 2) that the
// others, which have what is their own, only find from a neighbour.
struct two_ways {
    double own, slope;
    bool last_solved, mirrored;
    int bettered;
};

static moray_status solve_two_ways(const moray_sweep_point *point, FILE *summary, void *self)
{
    const struct two_ways *ways = self;
    const double x = ways->mirrored ? 4 - point->value[0] : point->value[0];
    FILE *guess = point->guess ? fopen(point->guess, "r") : NULL, *solution = fopen(point->solution, "w");
    int branch = 0;
    if (!solution || (guess && fscanf(guess, "%d", &branch) != 1) || (x == 4 && !ways->last_solved))
        return moray_error(MORAY_NOT_SOLVED, "nobody solves this");
    branch = branch || x >= 3;
    fprintf(solution, "%d\n", branch);
    fclose(solution);
    if (guess)
        fclose(guess);
    fprintf(summary, "{\"solver\": {\"objective\": %.17g}}\n", branch ? 1 + ways->slope * (x - 2) : ways->own);
    return moray_ok();
}

// A start from a neighbour is tried where the line through it and the point behind it promises more than it may be
// wrong by: half of its rise and the ten thousandth part; where nothing is solved behind, what the neighbour has.
static void test_lines(void)
{
    const struct two_ways cases[] = {{5, 0, false, false, 3},    {4, 4, true, false, 3},
                                     {2.9, 4, true, false, 0},   {1.00005, 0, true, false, 0},
                                     {1.001, 0, true, false, 3}, {0.5, 0, true, false, 0}};
    const double value[] = {0, 1, 2, 3, 4};
    const moray_sweep_axis axis = {.key = "x", .value = value, .n = 5};
    for (unsigned k = 0; k < 2 * sizeof cases / sizeof *cases; k++) {
        struct two_ways ways = cases[k / 2];
        moray_sweep_result result;
        ways.mirrored = k % 2;
        moray_sweep_spec spec = spec_of("lines.nc", &no_time);
        spec.axis = &axis, spec.axes = 1;
        spec.solve = solve_two_ways, spec.self = &ways;
        CHECK_OK(moray_sweep(&spec, &result), "two branches, one with a slope");
        CHECK(result.improved == ways.bettered, "%ld are bettered, of own values of %g", result.improved, ways.own);
        double *objective = numbers("lines.nc", "solver.objective", 5);
        CHECK(objective && objective[2] == (ways.bettered ? 1 : ways.own), "the middle has the better");
        free(objective);
        remove_sweep("lines.nc");
    }
}

// No start solves x = 1, and x = 4 only its own: every attempt is noted, by the point and what it began with.
static moray_status solve_some(const moray_sweep_point *point, FILE *summary, void *self)
{
    char line[100];
    const char *start = point->guess ? strrchr(point->guess, '/') : "default";
    const int n = snprintf(line, sizeof line, "%ld %s\n", point->index, start);
    const int file = open("attempts", O_WRONLY | O_CREAT | O_APPEND, 0666);
    const bool noted = write(file, line, (size_t)n) == n; // at once, by whoever it is
    close(file);
    if (!noted)
        return moray_error(MORAY_IO, "an attempt is not noted");
    if (point->value[0] == 1)
        return moray_error(MORAY_NOT_SOLVED, "nobody solves this");
    return solve_two(point, summary, self);
}

static void test_attempts(void)
{
    moray_sweep_spec spec = spec_of("some.nc", &no_time);
    moray_sweep_result result;
    static char line[400][100];
    int n = 0, twice = 0, hopeless = 0;
    spec.solve = solve_some;
    CHECK_OK(moray_sweep(&spec, &result), "points that nobody solves");
    CHECK(result.failed == 3 && result.solved == points - 3, "%ld of them", result.failed);
    CHECK(result.improved > 0, "among others that are bettered: %ld", result.improved);
    FILE *file = fopen("attempts", "r");
    while (file && n < 400 && fgets(line[n], sizeof line[n], file))
        n++;
    if (file)
        fclose(file);
    for (int k = 0; k < n; k++) {
        for (int other = 0; other < k; other++)
            twice += strcmp(line[k], line[other]) == 0;
        hopeless += strtol(line[k], NULL, 10) / 3 == 3; // x = 1
    }
    CHECK(n > points && twice == 0, "%d attempts, %d of them made before", n, twice);
    // From the parent, from its own start, and from what each of the three rounds behind may bring forth beside it.
    CHECK(hopeless <= 3 * 5, "%d at what nobody solves", hopeless);
}

static moray_status misbehave(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)self;
    const double x = point->value[0];
    fprintf(summary, "{\"x\": %g}\n", x);
    if (x == 0)
        raise(SIGKILL);
    if (x == 1)
        nap(60);
    if (x == 2)
        while (mmap(NULL, 1 << 26, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0) != MAP_FAILED)
            continue; // of address space, which costs no time
    if (x == 3)
        return moray_error(MORAY_NOT_SOLVED, "out of luck");
    if (x == 4)
        fprintf(summary, "and more");
    return x == 2 ? moray_error(MORAY_MEMORY, "no memory") : moray_ok();
}

static void test_misbehaviour(void)
{
    moray_sweep_spec spec = spec_of("bad.nc", NULL);
    moray_sweep_result result;
    spec.solve = misbehave;
    spec.axes = 1;
    spec.warm = false;
    spec.point_seconds = 2;
    spec.point_megabytes = tap_thorough() ? 500 : 0;
    // Sanitizers need all of the address space.
    const double modest[] = {-2, -1, 0, 1, 2.5, 3, 4};
    const moray_sweep_axis brief = {.key = "x", .value = modest, .n = 7};
    if (!tap_thorough())
        spec.axis = &brief;
    const double begun = (double)time(NULL);
    CHECK_OK(moray_sweep(&spec, &result), "points that misbehave");
    CHECK((double)time(NULL) - begun < 30, "cost the time that a point may take");
    CHECK(result.solved + result.failed == 7 && result.solved == (tap_thorough() ? 3 : 4),
          "%ld solved, those that are well", result.solved);
    double *state = numbers("bad.nc", "sweep_state", 7), *code = numbers("bad.nc", "sweep_code", 7);
    CHECK(state && state[0] == 1 && state[2] == 2 && state[3] == 2 && state[5] == 2, "each has its state");
    CHECK(code && code[5] == MORAY_NOT_SOLVED, "and its code");
    CHECK(!tap_thorough() || (state && state[4] == 2 && code[4] == MORAY_MEMORY), "memory is limited, too");
    free(state);
    free(code);
}

static int asked, stop_at;
static bool stop(void)
{
    return ++asked > stop_at;
}

static void test_going_on(void)
{
    moray_sweep_spec spec = spec_of("part.nc", &some_time);
    moray_sweep_result result;
    spec.solve = solve_two;
    spec.stop = stop;
    asked = 0;
    stop_at = 5;
    moray_status status = moray_sweep(&spec, &result);
    CHECK(status.code == MORAY_INTERRUPTED, "it can be stopped: %s", status.text);
    const long done = result.solved;
    CHECK(done > 0 && done < points, "after %ld points", done);
    double *state = numbers("part.nc", "sweep_state", points);
    int kept = 0;
    for (int k = 0; state && k < points; k++)
        kept += state[k] == 1;
    free(state);
    CHECK(kept == done, "which the file has: %d", kept);
    spec.stop = NULL;
    spec.range = &(const moray_sweep_range){"z", 0, 1};
    spec.ranges = 1;
    spec.draws = 2;
    status = moray_sweep(&spec, &result);
    CHECK(status.code == MORAY_INPUT, "another sweep may not have the file: %s", status.text);
    spec.ranges = 0;
    spec.draws = 0;
    CHECK_OK(moray_sweep(&spec, &result), "going on");
    CHECK(result.before >= done && result.solved == points, "%ld were there", result.before);
    CHECK(all_same("part.nc", "two.nc"), "and all is as in one go");
    CHECK_OK(moray_sweep(&spec, &result), "once more");
    CHECK(result.busy == 0, "when all is done nothing is done");
}

static void test_torn_journal(void)
{
    moray_sweep_spec spec = spec_of("torn.nc", &some_time);
    moray_sweep_result result;
    struct stat about;
    spec.solve = solve_two;
    spec.stop = stop;
    asked = 0;
    stop_at = 8;
    CHECK(moray_sweep(&spec, &result).code == MORAY_INTERRUPTED, "stopped");
    CHECK(stat("torn.nc.journal", &about) == 0 && truncate("torn.nc.journal", about.st_size - 20) == 0,
          "the end of the journal is lost");
    spec.stop = NULL;
    CHECK_OK(moray_sweep(&spec, &result), "going on from the rest");
    CHECK(result.before > 0 && result.busy > 0 && result.solved == points, "%ld were there", result.before);
    CHECK(all_same("torn.nc", "two.nc"), "and all is as in one go");
}

// Kills a sweep at random times, its processes with it or not, until it ends by itself; returns how often.
static int kill_and_go_on(moray_sweep_spec *spec, unsigned *seed, double longest, bool group)
{
    for (int killed = 0;; killed++) {
        const pid_t pid = fork();
        if (pid == 0) {
            moray_sweep_result result;
            setpgid(0, 0);
            _exit(moray_failed(moray_sweep(spec, &result)));
        }
        *seed = *seed * 1103515245u + 12345u;
        nap((1 + 0.3 * killed) * longest * (*seed >> 16 & 0x7fff) / 32768); // on a busy machine it ends, too
        kill(group ? -pid : pid, SIGKILL);
        int status;
        waitpid(pid, &status, 0);
        if (WIFEXITED(status)) {
            CHECK(WEXITSTATUS(status) == 0, "killed %d times, then it ended", killed);
            return killed;
        }
    }
}

static void test_killing(void)
{
    unsigned seed = 7;
    int killed = 0;
    for (int round = 0; round < 2; round++) {
        moray_sweep_spec spec = spec_of("killed.nc", &some_time);
        spec.solve = solve_two;
        remove_sweep("killed.nc");
        killed += kill_and_go_on(&spec, &seed, 0.1, round % 2);
        CHECK(all_same("killed.nc", "two.nc"), "the file is as if nothing had been");
    }
    CHECK(killed > 0, "sweeps were killed %d times", killed);
}

static void test_locks(void)
{
    int ready[2];
    if (pipe(ready) != 0)
        return;
    static double long_time = 0.2;
    moray_sweep_spec spec = spec_of("locked.nc", &long_time);
    moray_sweep_result result;
    const pid_t pid = fork();
    if (pid == 0)
        _exit(moray_failed(moray_sweep(&spec, &result)));
    nap(0.3);
    const moray_status status = moray_sweep(&spec, &result);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "another process"), "two at once are refused: %s",
          status.text);
    int ended;
    waitpid(pid, &ended, 0);
    CHECK(WIFEXITED(ended) && WEXITSTATUS(ended) == 0, "the first one is not disturbed");
    close(ready[0]);
    close(ready[1]);
}

static void test_full_disk(void)
{
    moray_sweep_spec spec = spec_of("nowhere/x.nc", &no_time);
    moray_sweep_result result;
    moray_status status = moray_sweep(&spec, &result);
    CHECK(status.code == MORAY_IO, "a folder that is not there is told before anything is solved: %s", status.text);
    spec.file = "full.nc";
    spec.solve = solve_two;
    struct rlimit before, little = {3000, 3000};
    getrlimit(RLIMIT_FSIZE, &before);
    little.rlim_max = before.rlim_max;
    setrlimit(RLIMIT_FSIZE, &little);
    status = moray_sweep(&spec, &result);
    setrlimit(RLIMIT_FSIZE, &before);
    CHECK(status.code == MORAY_IO, "a disk that is full: %s", status.text);
    CHECK_OK(moray_sweep(&spec, &result), "with room again it goes on");
    CHECK(all_same("full.nc", "two.nc"), "and all is as in one go");
}

static moray_status plain(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)self;
    const double first = point->value[0], second = point->n > 1 ? point->value[1] : 0;
    fprintf(summary, "{\"sum\": %.17g, \"one\": %.17g, \"other\": %.17g}\n", first + second, first, second);
    return moray_ok();
}

static void test_draws(void)
{
    const moray_sweep_range ranges[] = {{"a", 2, 3}, {"b", -1, 1}};
    enum { draws = 200 };
    moray_sweep_spec spec = {.file = "draws.nc",
                             .range = ranges,
                             .ranges = 2,
                             .draws = draws,
                             .seed = 5,
                             .solve = plain,
                             .warm = true,
                             .jobs = 2,
                             .quiet = true};
    moray_sweep_result result;
    CHECK_OK(moray_sweep(&spec, &result), "random draws");
    double *a = numbers("draws.nc", "a", draws), *b = numbers("draws.nc", "b", draws),
           *sum = numbers("draws.nc", "sum", draws);
    double mean[2] = {0, 0}, worst = 0;
    bool inside = true;
    for (int k = 0; a && b && sum && k < draws; k++) {
        inside = inside && a[k] >= 2 && a[k] <= 3 && b[k] >= -1 && b[k] <= 1;
        mean[0] += a[k] / draws;
        mean[1] += b[k] / draws;
        worst = tap_worse(worst, fabs(sum[k] - (a[k] + b[k])));
    }
    CHECK(inside && worst == 0, "lie within, and every point has its own");
    // Five standard errors of the mean of an even distribution, width / sqrt(12 draws).
    CHECK_NEAR(mean[0], 2.5, 5 / sqrt(12. * draws), "mean of a");
    CHECK_NEAR(mean[1], 0, 10 / sqrt(12. * draws), "mean of b");
    double *least, *most;
    long n;
    CHECK_OK(moray_sweep_extremes("draws.nc", "o*", &least, &most, &n), "of two numbers of each point");
    worst = n == draws ? 0 : INFINITY;
    for (int k = 0; a && b && k < draws && k < n; k++)
        worst = tap_worse(worst, fmax(fabs(least[k] - b[k]), fabs(most[k] - a[k])));
    CHECK(worst == 0, "the lesser and the greater, point by point");
    free(least);
    free(most);
    const moray_status none = moray_sweep_extremes("draws.nc", "c*", &least, &most, &n);
    CHECK(none.code == MORAY_INPUT && strstr(none.text, "c*") && !least && !most, "none of that name: %s", none.text);
    free(a);
    free(b);
    free(sum);
    spec.ranges = 0;
    CHECK(moray_sweep(&spec, &result).code == MORAY_INPUT, "draws of nothing are refused");
}

// The page of a sweep that has ended tells how many points there were, and of nothing that is left; nor does that of
// one that found all of them done.
static void test_page(void)
{
    moray_sweep_spec spec = spec_of("paged.nc", &no_time);
    spec.warm = false;
    spec.page = "paged.html";
    for (int again = 0; again < 2; again++) {
        char *text = NULL;
        size_t size = 0;
        moray_sweep_result result;
        unlink(spec.page);
        CHECK_OK(moray_sweep(&spec, &result), "a sweep with a page");
        CHECK(result.solved == points && result.before == (again ? points : 0), "%ld points of before", result.before);
        FILE *file = fopen(spec.page, "r");
        if (CHECK(file && getdelim(&text, &size, 0, file) > 0, "a page"))
            CHECK(strstr(text, "<p>21 of 21, 0 failed</p>"), "which says what was done, and no more");
        free(text);
        if (file)
            fclose(file);
    }
    remove_sweep("paged.nc");
}

// Draws, each at all values of an axis: numbers of the draws alone, of the axis alone, and of all points.
static void test_draws_and_values(void)
{
    enum { draws = 3, values = 4 };
    static const double c[values] = {10, 20, 40, 80};
    const moray_sweep_range range = {"a", 2, 3};
    const moray_sweep_axis axis = {.key = "c", .value = c, .n = values};
    const moray_sweep_spec spec = {.file = "both.nc",
                                   .axis = &axis,
                                   .axes = 1,
                                   .range = &range,
                                   .ranges = 1,
                                   .draws = draws,
                                   .seed = 7,
                                   .solve = plain,
                                   .jobs = 2,
                                   .quiet = true};
    moray_sweep_result result;
    CHECK_OK(moray_sweep(&spec, &result), "draws and values");
    double *a = numbers("both.nc", "a", draws), *axis_c = numbers("both.nc", "c", values),
           *sum = numbers("both.nc", "sum", draws * values), worst = 0;
    for (int k = 0; a && axis_c && sum && k < draws * values; k++)
        worst =
            fmax(worst, fabs(sum[k] - a[k / values] - axis_c[k % values]) + fabs(axis_c[k % values] - c[k % values]));
    CHECK(a && sum && worst == 0 && a[0] != a[1], "every draw meets every value");
    free(a);
    free(axis_c);
    free(sum);
}

int main(void)
{
    setvbuf(stdout, NULL, _IOLBF, 0); // processes that are made here have nothing of it to write
    char folder[] = "/tmp/moray-sweep-XXXXXX", command[100];
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    test_values();
    test_closed_form();
    test_branches();
    test_rounding();
    test_lines();
    test_attempts();
    test_misbehaviour();
    test_going_on();
    test_torn_journal();
    test_killing();
    test_locks();
    test_full_disk();
    test_draws();
    test_draws_and_values();
    test_page();
    snprintf(command, sizeof command, "rm -rf %s", folder);
    CHECK(chdir("/") == 0 && system(command) == 0, "nothing is left behind");
    return tap_done();
}
