// SPDX-License-Identifier: MIT
//
// Mutated files and command lines through every reader: none may crash or hang, what is refused is refused in one line,
// and what is read is the same when it is read again. A run of seed and count is the same everywhere:
//   fuzz CORPUS [COUNT [SEED]]
// Short under `meson test --suite fuzz`; a long one by name, best in the sanitizers' build:
//   build-san/tests/fuzz tests/fuzz/corpus 1000000 7
#include "readers.h"

#include <dirent.h>
#include <string.h>
#include <unistd.h>

#include "moray/fit.h"
#include "moray/table.h"
#include "sweep/sweep.h"

// ---- More readers --------------------------------------------------------------------------------------------------

static moray_status read_solution(double *sum)
{
    moray_solution *solution = NULL;
    const moray_status status = moray_solution_load(&solution, ocp, NULL, file_name);
    if (!moray_failed(status))
        *sum = moray_solution_objective(solution);
    moray_solution_free(solution);
    return status;
}

static moray_status read_spline(double *sum)
{
    moray_spline *spline = NULL;
    const moray_status status = moray_spline_read(&spline, file_name, "x", "y", MORAY_NATURAL, MORAY_LINEAR);
    const double value = moray_failed(status) ? 0 : moray_spline_real(spline, 0.3, NULL);
    *sum = isnan(value) ? 0 : value; // between numbers near the largest there is
    moray_spline_free(spline);
    return status;
}

static moray_status read_surface(double *sum)
{
    moray_surface *surface = NULL;
    const moray_status status = moray_surface_read(&surface, file_name, "x", "y", "z", MORAY_NATURAL, MORAY_LINEAR);
    const double value = moray_failed(status) ? 0 : moray_surface_real(surface, 0.3, 0.4, NULL);
    *sum = isnan(value) ? 0 : value; // between numbers near the largest there is
    moray_surface_free(surface);
    return status;
}

static moray_status read_data(double *sum)
{
    static const char *const names[] = {"y", "z"};
    moray_data data;
    const moray_status status = moray_data_read(&data, names, 2, 0, 1, file_name);
    for (int k = 0; !moray_failed(status) && k < data.n; k++)
        *sum = 3 * *sum + data.time[k];
    moray_data_free(&data);
    return status;
}

// The file's text; free it.
static char *whole_file(void)
{
    char *text = NULL;
    size_t room = 0;
    FILE *file = fopen(file_name, "r");
    if (!file || getdelim(&text, &room, 0, file) < 0) {
        free(text);
        text = strdup("");
    }
    if (file)
        fclose(file);
    return text;
}

static moray_status read_record(double *sum)
{
    struct record record = {0};
    char *text = whole_file();
    const moray_status status = moray_record_read(text, &record);
    if (!moray_failed(status))
        *sum = (double)record.task.point;
    moray_record_free(&record);
    free(text);
    return status;
}

static moray_status read_journal(double *sum)
{
    struct journal journal;
    const moray_status status = moray_journal_open(&journal, file_name, "the grid");
    if (!moray_failed(status)) {
        *sum = (double)journal.n_old;
        moray_journal_close(&journal);
    }
    return status;
}

// A word a line.
static moray_status read_command_line(double *sum)
{
    static const moray_option rows[] = {
        {.section = "test", .key = "aa", .flag = "aa", .type = MORAY_OPTION_REAL, MORAY_AT(settings, a)},
        {.section = "test", .key = "bb", .type = MORAY_OPTION_REAL, MORAY_AT(settings, b)}};
    const moray_program program = {.name = "fuzz", .summary = "", .options = rows, .n_options = 2};
    settings s = {.common = moray_common_default()};
    command_line line;
    moray_request request;
    char *text = whole_file(), *rest = NULL;
    command_set(&line, "fuzz", NULL, 0);
    for (char *word = strtok_r(text, "\n", &rest); word && line.argc < 10; word = strtok_r(NULL, "\n", &rest))
        command_add(&line, word);
    const moray_status status = moray_app_parse(&program, line.argc, line.argv, &s, &request);
    *sum = 3 * s.a + s.b + s.common.intervals;
    free(text);
    return status;
}

static const struct {
    const char *name; // and of its corpus
    moray_status (*read)(double *sum);
} kinds[] = {{"guess", read_guess},   {"schedule", read_schedule}, {"reference", read_reference},
             {"path", read_path},     {"ini", read_ini},           {"solution", read_solution},
             {"spline", read_spline}, {"surface", read_surface},   {"data", read_data},
             {"record", read_record}, {"journal", read_journal},   {"command", read_command_line}};
enum { n_kinds = sizeof kinds / sizeof *kinds };

// ---- Mutation ------------------------------------------------------------------------------------------------------

enum { LONGEST = 1 << 14 };

typedef struct {
    char text[LONGEST];
    int n;
} bytes;

static unsigned long long seed = 1;

static int below(int n)
{
    const int k = (int)tap_random(&seed, 0, n);
    return k < n ? k : n - 1;
}

// Puts `with` in the place of text[at .. at + cut).
static void splice(bytes *b, int at, int cut, const char *with, int n)
{
    if (b->n - cut + n > LONGEST)
        return;
    memmove(b->text + at + n, b->text + at + cut, (size_t)(b->n - at - cut));
    if (n > 0)
        memcpy(b->text + at, with, (size_t)n);
    b->n += n - cut;
}

// A number somewhere becomes one at the edge of what a type holds.
static void change_number(bytes *b)
{
    static const char *const edges[] = {
        "0",  "-1", "2147483648",          "-2147483649", "1e999",      "-1e300", "1e-320", "nan", "inf",  "0x10",
        "1e", "",   "9999999999999999999", "1e308",       "4294967297", "-0.0",   "1,5",    "+",   "1e19", "0.1.2"};
    const int start = below(b->n + 1);
    int at = start, end;
    while (at < b->n && !strchr("0123456789", b->text[at]))
        at++;
    for (end = at; end < b->n && strchr("0123456789.eE+-", b->text[end]) && b->text[end]; end++)
        ;
    const char *edge = edges[below(sizeof edges / sizeof *edges)];
    splice(b, at, end - at, edge, (int)strlen(edge));
}

static void mutate(bytes *b, const bytes *other)
{
    static const char odd[] = "\0\n\r\t ,;#\"'=[]{}:-+.eE%\\\x7f\x80\xff\xef\xbb\xbf"
                              "0129xX";
    const int at = below(b->n + 1), left = b->n - at, few = below(left < 12 ? left + 1 : 12);
    char one;
    switch (below(8)) {
    case 0:
        change_number(b);
        break;
    case 1:
        if (left > 0)
            b->text[at] = (char)(b->text[at] ^ 1 << below(8));
        break;
    case 2:
        one = odd[below(sizeof odd)];
        splice(b, at, below(2) && left, &one, 1);
        break;
    case 3:
        splice(b, at, few, NULL, 0);
        break;
    case 4: { // a piece once more
        char piece[12];
        memcpy(piece, b->text + at, (size_t)few);
        splice(b, below(b->n + 1), 0, piece, few);
        break;
    }
    case 5:
        b->n = at;
        break;
    case 6: { // from another file on
        const int from = below(other->n + 1);
        splice(b, at, left, other->text + from, other->n - from);
        break;
    }
    default: { // a line once more
        const char *end = memchr(b->text + at, '\n', (size_t)left);
        char line[200];
        const int n = end && end - b->text - at + 1 < 200 ? (int)(end - b->text) - at + 1 : 0;
        memcpy(line, b->text + at, (size_t)n);
        splice(b, at, 0, line, n);
    }
    }
}

// ---- A run ---------------------------------------------------------------------------------------------------------

static bytes corpus[n_kinds], now;

static void load(const char *folder)
{
    for (int k = 0; k < n_kinds; k++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s.txt", folder, kinds[k].name);
        FILE *file = fopen(path, "r");
        CHECK(file, "%s", path);
        corpus[k].n = file ? (int)fread(corpus[k].text, 1, LONGEST, file) : 0;
        if (file)
            fclose(file);
    }
}

static void put(const bytes *b)
{
    FILE *file = fopen(file_name, "w");
    if (!file || (int)fwrite(b->text, 1, (size_t)b->n, file) != b->n || fclose(file) != 0)
        exit(1);
}

static bool one_line(const moray_status *status)
{
    return status->text[0] && !strpbrk(status->text, "\n\r");
}

// Leaves the culprit where it can be read again.
static void keep(int k, int round)
{
    char name[80];
    snprintf(name, sizeof name, "/tmp/moray-fuzz-%s-%d.txt", kinds[k].name, round);
    FILE *file = fopen(name, "w");
    if (file) {
        fwrite(now.text, 1, (size_t)now.n, file);
        fclose(file);
    }
    printf("# %s\n", name);
}

// What its reader says of it, twice; a journal grows when it is opened.
static bool try(int k, int round)
{
    double sum[2] = {0, 0};
    moray_status status[2];
    for (int again = 0; again < 2; again++) {
        put(&now);
        alarm(20);
        status[again] = kinds[k].read(&sum[again]);
        alarm(0);
    }
    const bool good = moray_failed(*status) ? one_line(status) && status->code != MORAY_MEMORY
                                            : !isnan(sum[0]) && memcmp(&sum[0], &sum[1], sizeof *sum) == 0;
    if (!good || status[0].code != status[1].code) {
        printf("# %s: code %d, %g, %g: %s\n", kinds[k].name, (int)status->code, sum[0], sum[1], status->text);
        keep(k, round);
    }
    return good && status[0].code == status[1].code;
}

int main(int argc, char **argv)
{
    const int count = argc > 2 ? atoi(argv[2]) : 6000;
    // Some ten thousand small files: in memory, where there is such a place.
    char directory[40], command[100];
    snprintf(directory, sizeof directory, "%s/moray-fuzz-XXXXXX", access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
    int bad = 0, read[n_kinds] = {0}, tried[n_kinds] = {0};
    seed = argc > 3 ? strtoull(argv[3], NULL, 10) : 1;
    load(argc > 1 ? argv[1] : "tests/fuzz/corpus");
    if (!mkdtemp(directory) || chdir(directory) != 0)
        return 1;
    make_problem();
    for (int k = 0; k < n_kinds; k++) {
        double sum = 0;
        put(&corpus[k]);
        CHECK_OK(kinds[k].read(&sum), kinds[k].name);
    }
    for (int round = 0; round < count; round++) {
        const int k = round % n_kinds;
        double sum;
        now = corpus[k];
        for (int changes = 1 + below(4); changes > 0; changes--)
            mutate(&now, &corpus[below(n_kinds)]);
        bad += !try(k, round);
        tried[k]++;
        read[k] += !moray_failed(kinds[k].read(&sum));
    }
    for (int k = 0; k < n_kinds; k++)
        CHECK(read[k] < tried[k], "%s: %d of %d mutants are still read", kinds[k].name, read[k], tried[k]);
    CHECK(bad == 0, "%d of %d mutants are read or refused in order, seed %s", count - bad, count,
          argc > 3 ? argv[3] : "1");
    moray_ocp_free(ocp);
    snprintf(command, sizeof command, "rm -r %s", directory);
    CHECK(chdir("/") == 0 && system(command) == 0, "nothing is left");
    return tap_done();
}
