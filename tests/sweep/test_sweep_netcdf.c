// SPDX-License-Identifier: MIT
//
// The file of a sweep, read with NetCDF alone: its dimensions, every variable with its unit and text, and its numbers.
#define _GNU_SOURCE // mkdtemp
#include "tap.h"

#include <errno.h>
#include <malloc.h>
#include <netcdf.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "moray/app/options.h"
#include "sweep/sweep.h"

// ---- A disk that takes a part of what it is given, is interrupted, and fails at the end; the linker leads here ----

static bool slow;
static int sync_error, close_error, writes;
ssize_t __real_write(int fd, const void *from, size_t size);
int __real_fsync(int fd);
int __real_close(int fd);
ssize_t __wrap_write(int fd, const void *from, size_t size);
int __wrap_fsync(int fd);
int __wrap_close(int fd);

ssize_t __wrap_write(int fd, const void *from, size_t size)
{
    if (!slow)
        return __real_write(fd, from, size);
    errno = EINTR;
    return ++writes % 2 ? -1 : __real_write(fd, from, size > 1000 ? 1000 : size);
}

int __wrap_fsync(int fd)
{
    const int result = __real_fsync(fd);
    errno = sync_error ? sync_error : EDOM;
    return sync_error ? -1 : result;
}

int __wrap_close(int fd)
{
    const int result = __real_close(fd);
    errno = close_error ? close_error : EDOM;
    return close_error ? -1 : result;
}

static moray_status none(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point, (void)summary, (void)self;
    return moray_ok();
}

static void test_names(void)
{
    static const char *const names[][2] = {{"speed", "speed"},
                                           {"a.b c", "a_b_c"},
                                           {"c_n+20", "c_n_plus20"},
                                           {"c_n-20", "c_n_minus20"},
                                           {"a-b", "a_b"},
                                           {"a+", "a_"},
                                           {"9x", "p9x"},
                                           {"-3", "p_minus3"},
                                           {"_x", "p_x"}};
    char name[NETCDF_NAME], path[300];
    for (unsigned k = 0; k < sizeof names / sizeof *names; k++) {
        moray_netcdf_name(names[k][0], name);
        CHECK(strcmp(name, names[k][1]) == 0, "%s is %s", names[k][0], name);
    }
    memset(path, 'x', 299);
    path[299] = 0;
    moray_netcdf_name(path, name);
    CHECK(strlen(name) == NC_MAX_NAME - 6, "a long one ends: %zu", strlen(name));
}

// Text of an attribute, or "-".
static const char *attribute(int file, int id, const char *name)
{
    static char text[400];
    size_t length = 0;
    memset(text, 0, sizeof text);
    if (nc_inq_attlen(file, id, name, &length) != NC_NOERR || length >= sizeof text ||
        nc_get_att_text(file, id, name, text) != NC_NOERR)
        strcpy(text, "-");
    return text;
}

static void check_text(int file, const char *variable, const char *name, const char *wanted)
{
    int id = NC_GLOBAL;
    const bool there = !variable || nc_inq_varid(file, variable, &id) == NC_NOERR;
    const char *text = there ? attribute(file, id, name) : "no variable";
    CHECK(strcmp(text, wanted) == 0, "%s of %s: %s", name, variable ? variable : "the file", text);
}

static void check_shape(int file, const char *variable, nc_type type, int n, const char *const *dimension)
{
    int id, axes = -1, of[NC_MAX_VAR_DIMS];
    nc_type is = NC_NAT;
    char name[NC_MAX_NAME + 1];
    if (!CHECK(nc_inq_varid(file, variable, &id) == NC_NOERR, "%s is there", variable))
        return;
    nc_inq_var(file, id, NULL, &is, &axes, of, NULL);
    CHECK(is == type && axes == n, "%s: its type and %d dimensions", variable, axes);
    for (int k = 0; k < n && k < axes; k++)
        CHECK(nc_inq_dimname(file, of[k], name) == NC_NOERR && strcmp(name, dimension[k]) == 0, "of which one is %s",
              name);
}

static void check_numbers(const char *path, const char *name, int n, const double *wanted)
{
    double *value = NULL;
    long count = 0;
    CHECK_OK(moray_sweep_numbers(path, name, &value, &count), name);
    bool same = value && count == n;
    for (int k = 0; same && k < n; k++)
        same = value[k] == wanted[k] || (isnan(wanted[k]) && isnan(value[k]));
    CHECK(same, "the numbers of %s", name);
    free(value);
}

static const char *const words[] = {"fin", "bare", "flap"};
static const moray_sweep_axis axes[] = {{.key = "speed_m_s", .value = (const double[]){-1, 2}, .n = 2},
                                        {.key = "kind", .word = words, .n = 3}};
static const moray_sweep_range ranges[] = {{"drag_N_m", 2, 3}, {"phase_deg", -9, 9}};
static const char *const all[] = {"draw", "speed_m_s", "kind"};
enum { points = 12 };

static void check_header(int file, const char *complete)
{
    check_text(file, NULL, "Conventions", "CF-1.8");
    check_text(file, NULL, "title", "T");
    check_text(file, NULL, "source", "moray");
    check_text(file, NULL, "version", moray_version());
    check_text(file, NULL, "command", "sweep it");
    check_text(file, NULL, "configuration", "-");
    check_text(file, NULL, "seed", "41");
    check_text(file, NULL, "complete", complete);
}

static void check_axes(int file, const moray_sweep_spec *spec)
{
    int id = -1;
    check_shape(file, "speed_m_s", NC_DOUBLE, 1, &all[1]);
    check_text(file, "speed_m_s", "units", "m s-1");
    check_text(file, "speed_m_s", "long_name", "speed_m_s");
    check_numbers("own.nc", "speed_m_s", 2, axes[0].value);
    check_shape(file, "kind", NC_STRING, 1, &all[2]);
    check_text(file, "kind", "units", "-");
    nc_inq_varid(file, "kind", &id);
    for (size_t k = 0; k < 3; k++) {
        char *word = NULL;
        CHECK(nc_get_var1_string(file, id, &k, &word) == NC_NOERR && strcmp(word, words[k]) == 0, "word %zu", k);
        nc_free_string(1, &word);
    }
    for (int r = 0; r < 2; r++) {
        const double drawn[] = {moray_grid_draw(spec, 0, r), moray_grid_draw(spec, 1, r)};
        check_shape(file, spec->range[r].key, NC_DOUBLE, 1, all);
        check_text(file, spec->range[r].key, "long_name", "drawn at random");
        check_text(file, spec->range[r].key, "units", r ? "degree" : "N m");
        check_numbers("own.nc", spec->range[r].key, 2, drawn);
    }
}

static void check_flags(int file, const char *name, int n, const char *meanings, const double *wanted)
{
    int id = -1;
    signed char values[16] = {0};
    size_t length = 0;
    check_shape(file, name, NC_BYTE, 3, all);
    check_text(file, name, "flag_meanings", meanings);
    check_text(file, name, "units", "-");
    nc_inq_varid(file, name, &id);
    CHECK(nc_inq_attlen(file, id, "flag_values", &length) == NC_NOERR && length == (size_t)n, "%zu flags", length);
    nc_get_att_schar(file, id, "flag_values", values);
    for (int k = 0; k < n; k++)
        CHECK(values[k] == k, "flag %d", k);
    check_numbers("own.nc", name, points, wanted);
}

static void check_reasons(int file)
{
    int id = -1;
    check_shape(file, "sweep_reason", NC_STRING, 3, all);
    check_text(file, "sweep_reason", "long_name", "why the point is not solved");
    char *reason[points] = {NULL};
    nc_inq_varid(file, "sweep_reason", &id);
    CHECK(nc_get_var_string(file, id, reason) == NC_NOERR, "reasons");
    for (int k = 0; k < points; k++)
        CHECK(reason[k] && strcmp(reason[k], k == 4    ? "why"
                                             : k == 11 ? "last"
                                                       : "") == 0,
              "of point %d: %s", k, reason[k]);
    nc_free_string(points, reason);
}

static const char *const found[][3] = {{"a.power_W", "a_power_W", "W"},
                                       {"b_J_m", "b_J_m", "J m-1"},
                                       {"c_deg_s", "c_deg_s", "degree s-1"},
                                       {"d_percent", "d_percent", "percent"},
                                       {"e_m", "e_m", "m"},
                                       {"f_s", "f_s", "s"},
                                       {"g_J", "g_J", "J"},
                                       {"ratio", "ratio", "1"},
                                       {"_m", "p_m", "1"},
                                       {"kind", "found_kind", "1"},
                                       {"found_kind", "found_found_kind", "1"}};
enum { numbers = sizeof found / sizeof *found };

static void fill(struct store *store, double number[numbers][points], double *per_point)
{
    static char *name[numbers];
    static double *value[numbers];
    for (int i = 0; i < numbers; i++) {
        name[i] = strdup(found[i][0]);
        value[i] = moray_apart_new(points, sizeof **value);
        for (int k = 0; k < points; k++)
            value[i][k] = number[i][k] = (k + 2 * i) % 7 == 3 ? NAN : 100. * i - k;
    }
    store->n = store->room = numbers;
    store->name = malloc(sizeof name);
    store->value = malloc(sizeof value);
    memcpy(store->name, name, sizeof name);
    memcpy(store->value, value, sizeof value);
    for (int k = 0; k < points; k++) {
        store->state[k] = (signed char)(k % 3);
        store->code[k] = (signed char)(k % 7);
        store->round[k] = (signed char)(k % 4);
        store->start[k] = 3 * k - 1;
        per_point[k] = 3 * k - 1;
        store->objective[k] = -k;
        store->other[k] = 0.5 + k;
        store->seconds[k] = 0.25 * k;
    }
    store->reason[4] = strdup("why"), store->reason[11] = strdup("last");
}

static void check_points(int file, double number[numbers][points], const double *starts)
{
    double state[points], code[points], round[points], objective[points], other[points], seconds[points];
    for (int k = 0; k < points; k++) {
        state[k] = k % 3, code[k] = k % 7, round[k] = k % 4;
        objective[k] = -k, other[k] = 0.5 + k, seconds[k] = 0.25 * k;
    }
    check_flags(file, "sweep_state", 3, "untried solved failed", state);
    check_flags(file, "sweep_code", 7,
                "none bad_input out_of_memory cannot_read_or_write numerical_failure not_solved interrupted", code);
    check_flags(file, "sweep_round", 4, "parent first second third", round);
    check_shape(file, "sweep_start", NC_INT64, 3, all);
    check_numbers("own.nc", "sweep_start", points, starts);
    check_numbers("own.nc", "sweep_objective", points, objective);
    check_numbers("own.nc", "sweep_other_objective", points, other);
    check_numbers("own.nc", "sweep_time_s", points, seconds);
    check_text(file, "sweep_time_s", "units", "s");
    check_text(file, "sweep_time_s", "long_name", "time on the clock for all attempts at the point");
    check_reasons(file);
    for (int i = 0; i < numbers; i++) {
        check_shape(file, found[i][1], NC_DOUBLE, 3, all);
        check_text(file, found[i][1], "long_name", found[i][0]);
        check_text(file, found[i][1], "units", found[i][2]);
        if (strcmp(found[i][0], "kind") != 0) // by that path the axis is found
            check_numbers("own.nc", found[i][0], points, number[i]);
    }
}

// NaN gives way to numbers; one of another shape, as an axis, is none of the points'.
static void check_extremes(double number[numbers][points])
{
    double *least = NULL, *most = NULL;
    long n = 0;
    CHECK_OK(moray_sweep_extremes("own.nc", "[aeg]*[_.]*", &least, &most, &n), "of three numbers");
    for (int k = 0; k < points && n == points; k++) {
        const double lower = fmin(fmin(number[0][k], number[4][k]), number[6][k]),
                     upper = fmax(fmax(number[0][k], number[4][k]), number[6][k]);
        CHECK(least[k] == lower && most[k] == upper, "point %d from %g to %g", k, least[k], most[k]);
    }
    CHECK(n == points, "all points");
    free(least);
    free(most);
    moray_status status = moray_sweep_extremes("own.nc", "z*", &least, &most, &n);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, "own.nc has no number z*") == 0, "%s", status.text);
    double *value = &(double){0};
    status = moray_sweep_numbers("own.nc", "zz", &value, &n);
    CHECK(status.code == MORAY_INPUT && !value && strcmp(status.text, "own.nc has no number zz") == 0, "%s",
          status.text);
    status = moray_sweep_numbers("no.nc", "zz", &value, &n);
    CHECK(status.code == MORAY_IO && strcmp(status.text, "no.nc: No such file or directory") == 0, "%s", status.text);
    CHECK(moray_sweep_extremes("no.nc", "*", &least, &most, &n).code == MORAY_IO && !least && !most, "nor are files");
}

static size_t in_use(void)
{
    const struct mallinfo2 memory = mallinfo2();
    return memory.uordblks + memory.hblkhd;
}

// Written ten times over, the file takes no memory of its size each time.
static void check_memory(const struct store *store)
{
    struct stat about;
    size_t before = 0;
    for (int k = 0; k < 20; k++) {
        CHECK_OK(moray_store_write(store, true), "a file");
        before = k == 9 ? in_use() : before; // of what NetCDF keeps for itself
    }
    const size_t after = in_use();
    CHECK(stat("own.nc", &about) == 0 && after < before + (size_t)about.st_size, "%zu bytes, then %zu", before, after);
}

static void test_file(void)
{
    moray_sweep_spec spec = {.file = "own.nc",
                             .title = "T",
                             .command = "sweep it",
                             .axis = axes,
                             .axes = 2,
                             .range = ranges,
                             .ranges = 2,
                             .draws = 2,
                             .seed = 41,
                             .solve = none};
    struct grid grid;
    struct store store;
    double number[numbers][points], starts[points];
    CHECK_OK(moray_grid_new(&spec, &grid), "a grid");
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    fill(&store, number, starts);
    for (int finished = 0; finished < 2; finished++) {
        int file = -1;
        CHECK_OK(moray_store_write(&store, finished), "a file");
        CHECK(access("own.nc.new", F_OK) != 0, "at once");
        if (!CHECK(nc_open("own.nc", NC_NOWRITE, &file) == NC_NOERR, "opened"))
            return;
        check_header(file, finished ? "yes" : "no");
        if (finished) {
            check_axes(file, &spec);
            check_points(file, number, starts);
        }
        nc_close(file);
    }
    check_extremes(number);
    check_memory(&store);
    spec.draws = 0, spec.configuration = "c";
    CHECK(mkdir("folder", 0777) == 0, "a folder");
    spec.file = "folder";
    moray_status status = moray_store_write(&store, true);
    CHECK(status.code == MORAY_IO && strcmp(status.text, "folder cannot be written: Is a directory") == 0, "%s",
          status.text);
    CHECK(access("folder.new", F_OK) != 0, "and nothing is left of it");
    spec.file = "nowhere/own.nc";
    status = moray_store_write(&store, true);
    CHECK(status.code == MORAY_IO &&
              strcmp(status.text, "nowhere/own.nc cannot be written: No such file or directory") == 0,
          "%s", status.text);
    moray_store_free(&store);
}

static void test_disk(void)
{
    static const struct {
        int sync, close;
        const char *told; // NULL: nothing
    } cases[] = {{0, 0, NULL},
                 {EINVAL, 0, NULL}, // of what is no file on a disk
                 {EIO, 0, "Input/output error"},
                 {EIO, ENOSPC, "Input/output error"},
                 {EINVAL, ENOSPC, "No space left on device"},
                 {0, ENOSPC, "No space left on device"}};
    const moray_sweep_spec spec = {
        .file = "disk.nc", .objective = "cost", .title = "T", .ranges = 1, .range = ranges, .draws = 3, .solve = none};
    struct grid grid;
    struct store store;
    int file;
    CHECK_OK(moray_grid_new(&spec, &grid), "a grid");
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    slow = true;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        unlink("disk.nc");
        sync_error = cases[k].sync, close_error = cases[k].close;
        const moray_status status = moray_store_write(&store, true);
        if (cases[k].told)
            CHECK(status.code == MORAY_IO && strstr(status.text, cases[k].told) && access("disk.nc", F_OK) != 0, "%s",
                  status.text);
        else
            CHECK(!moray_failed(status) && nc_open("disk.nc", NC_NOWRITE, &file) == NC_NOERR &&
                      nc_close(file) == NC_NOERR,
                  "a file, written in %d parts: %s", writes, status.text);
        CHECK(access("disk.nc.new", F_OK) != 0, "and nothing is left beside it");
    }
    slow = false, sync_error = close_error = 0;
    moray_store_free(&store);
}

int main(void)
{
    char folder[] = "/tmp/moray-netcdf-XXXXXX", command[100];
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    test_names();
    test_file();
    test_disk();
    snprintf(command, sizeof command, "rm -rf %s", folder);
    CHECK(chdir("/") == 0 && system(command) == 0, "nothing is left behind");
    return tap_done();
}
