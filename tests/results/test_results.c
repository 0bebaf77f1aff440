// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // pseudo-terminals
#include "tap.h"

#include <cjson/cJSON.h>
#include <fcntl.h>
#include <poll.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "moray/app/results.h"

static void test_numbers(void)
{
    unsigned long long seed = 1;
    char text[32], shorter[32];
    int changed = 0, longer = 0;
    for (int i = 0; i < 20000; i++) {
        union {
            uint64_t bits;
            double value;
        } any = {.bits = (uint64_t)tap_random(&seed, 0, 0x1p32) << 32 | (uint64_t)tap_random(&seed, 0, 0x1p32)};
        if (!isfinite(any.value) || fpclassify(any.value) == FP_SUBNORMAL)
            continue;
        moray_number_text(any.value, text);
        changed += strtod(text, NULL) != any.value;
        int digits = 1; // the shortest, by trying all
        do
            snprintf(shorter, sizeof shorter, "%.*g", digits, any.value);
        while (strtod(shorter, NULL) != any.value && ++digits <= 17);
        longer += strlen(text) > strlen(shorter);
    }
    CHECK(changed == 0, "random doubles read back as themselves: %d do not", changed);
    CHECK(longer == 0, "none could be shorter: %d could", longer);
    CHECK(strcmp(moray_number_text(0.1, text), "0.1") == 0, "0.1 is %s", text);
    CHECK(strcmp(moray_number_text(0.1 + 0.2, text), "0.30000000000000004") == 0, "0.1 + 0.2 is %s", text);
    CHECK(strtod(moray_number_text(5e-324, text), NULL) == 5e-324, "the smallest double is %s", text);
    CHECK(strcmp(moray_number_text(NAN, text), "nan") == 0, "NaN is %s", text);
    CHECK(strcmp(moray_number_text(-NAN, text), "nan") == 0, "-NaN is %s", text);
    CHECK(strcmp(moray_number_text(-INFINITY, text), "-inf") == 0, "-infinity is %s", text);
}

// What the builder writes, in memory of the caller's.
static char *written(const moray_json *json, moray_status *status)
{
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    *status = moray_json_write(json, file);
    fclose(file);
    return text;
}

static moray_json *some_summary(void)
{
    static const double pair[] = {0.1, NAN};
    moray_json *json = moray_json_new();
    moray_json_number(json, "third", 1.0 / 3);
    moray_json_number(json, "nan", NAN);
    moray_json_number(json, "inf", -INFINITY);
    moray_json_open(json, "solver");
    moray_json_text(json, "status", "a \"quoted\"\nline");
    moray_json_text(json, "none", NULL);
    moray_json_bool(json, "pass", true);
    moray_json_close(json);
    moray_json_numbers(json, "pair", pair, 2);
    moray_json_open_list(json, "runs");
    for (int i = 0; i < 2; i++) {
        moray_json_open(json, NULL);
        moray_json_number(json, "run", i);
        moray_json_close(json);
    }
    moray_json_close(json);
    moray_json_text(json, "last", "θ");
    return json;
}

static void test_json(void)
{
    moray_status status;
    moray_json *json = some_summary();
    char *text = written(json, &status);
    CHECK_OK(status, "a summary is written");
    const char *end = NULL;
    cJSON *read = cJSON_ParseWithOpts(text, &end, false);
    CHECK(read && strcmp(end, "\n") == 0, "it is one object and a newline");
    const cJSON *solver = cJSON_GetObjectItem(read, "solver"), *pair = cJSON_GetObjectItem(read, "pair");
    CHECK(cJSON_GetNumberValue(cJSON_GetObjectItem(read, "third")) == 1.0 / 3, "a number round-trips");
    CHECK(cJSON_IsNull(cJSON_GetObjectItem(read, "nan")) && cJSON_IsNull(cJSON_GetObjectItem(read, "inf")),
          "NaN and infinity are null");
    CHECK(strcmp(cJSON_GetStringValue(cJSON_GetObjectItem(solver, "status")), "a \"quoted\"\nline") == 0,
          "text is escaped");
    CHECK(cJSON_IsNull(cJSON_GetObjectItem(solver, "none")) && cJSON_IsTrue(cJSON_GetObjectItem(solver, "pass")),
          "no text is null, true is true");
    CHECK(cJSON_GetArraySize(pair) == 2 && cJSON_GetNumberValue(cJSON_GetArrayItem(pair, 0)) == 0.1 &&
              cJSON_IsNull(cJSON_GetArrayItem(pair, 1)),
          "numbers in a list");
    const cJSON *second = cJSON_GetArrayItem(cJSON_GetObjectItem(read, "runs"), 1);
    CHECK(cJSON_GetNumberValue(cJSON_GetObjectItem(second, "run")) == 1, "objects in a list");
    CHECK(strcmp(cJSON_GetStringValue(cJSON_GetObjectItem(read, "last")), "θ") == 0, "closing leads back to the root");
    cJSON_Delete(read);
    free(text);
    moray_json_free(json);
}

static void test_json_depth(void)
{
    moray_json *json = moray_json_new();
    CHECK(moray_json_depth(json) == 0, "nothing is open inside");
    moray_json_open(json, "object");
    moray_json_open_list(json, "list");
    moray_json_numbers(json, NULL, (const double[]){1, 2}, 2);
    CHECK(moray_json_depth(json) == 2, "an object and a list in it: %d", moray_json_depth(json));
    moray_json_close(json);
    CHECK(moray_json_depth(json) == 1, "the list is closed: %d", moray_json_depth(json));
    moray_json_free(json);
    CHECK(moray_json_depth(NULL) == 0, "no builder, no depth");
    json = moray_json_new();
    moray_json_close(json);
    moray_json_number(json, "x", 1);
    moray_status status;
    char *text = written(json, &status);
    CHECK(!moray_failed(status) && strcmp(text, "{\n\t\"x\":\t1\n}\n") == 0, "the root stays open: %s", text);
    free(text);
    moray_json_free(json);
}

static void test_json_errors(void)
{
    moray_status status;
    moray_json *json = moray_json_new();
    for (int i = 0; i < 20; i++)
        moray_json_open(json, "deeper");
    moray_json_number(json, "x", 1);
    free(written(json, &status));
    CHECK(status.code == MORAY_MEMORY, "nesting too deep is reported: %s", status.text);
    moray_json_free(json);
    moray_json_number(NULL, "x", 1);
    moray_json_numbers(NULL, "x", (double[]){1}, 1);
    moray_json_close(NULL);
    free(written(NULL, &status));
    CHECK(status.code == MORAY_MEMORY, "a NULL builder is reported: %s", status.text);
    moray_json_free(NULL);
    json = some_summary();
    FILE *full = fopen("/dev/full", "w");
    CHECK(moray_json_write(json, full).code == MORAY_IO, "a full disk is reported");
    fclose(full);
    moray_json_free(json);
}

static int allocations_left;

static void *failing_malloc(size_t size)
{
    return allocations_left-- > 0 ? malloc(size) : NULL;
}

// Each allocation fails in its turn: the write says so, and nothing leaks (run under the address sanitizer).
static void test_json_memory(void)
{
    int silent = 0, most = 0;
    moray_status status;
    moray_json *whole = some_summary();
    char *all = written(whole, &status);
    moray_json_free(whole);
    status.code = MORAY_MEMORY;
    cJSON_InitHooks(&(cJSON_Hooks){failing_malloc, free});
    for (; most < 1000 && moray_failed(status); most++) {
        allocations_left = most;
        moray_json *json = some_summary();
        char *text = written(json, &status);
        silent += strcmp(text, moray_failed(status) ? "" : all) != 0;
        free(text);
        moray_json_free(json);
    }
    cJSON_InitHooks(NULL);
    free(all);
    CHECK(most > 20 && most < 1000 && silent == 0, "each of %d allocations may fail, and all or nothing is written",
          most - 1);
}

static void test_csv(void)
{
    const double t[] = {0, 0.1, NAN}, xy[] = {1, 1.0 / 3, 2, -INFINITY, 3, 1e-300};
    const moray_column columns[] = {{"t", "s", t, 0}, {"y, \"up\"", "m", xy + 1, 2}, {"x", NULL, xy, 2}};
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    moray_csv_write(file, columns, 3, 3);
    fclose(file);
    CHECK(strcmp(text, "t [s],\"y, \"\"up\"\" [m]\",x\n0,0.3333333333333333,1\n0.1,-inf,2\nnan,1e-300,3\n") == 0,
          "CSV with names, units, strides and full precision");
    free(text);
}

static void test_table(void)
{
    const moray_table_row rows[] = {
        {"speed", {0.257412, 0.2293, NAN}, "m/s", NULL},
        {"theta", {20, -0.0, 12345}, "deg", NULL},
        {"Δ", {1e12, 1.5e-7, 0}, NULL, NULL},
        {"below", {-1e12, -999999999, -1e9}, NULL, NULL},
        {"scheme", {0}, NULL, "hermite-simpson"},
    };
    moray_table table = {
        .title = "Gait", .columns = {"predicted", "validated", NULL}, .n_columns = 3, .rows = rows, .n_rows = 5};
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    moray_table_print(&table, file);
    fclose(file);
    CHECK(strcmp(text, "Gait\n"
                       "              predicted   validated\n"
                       "speed            0.2574      0.2293          m/s\n"
                       "theta                20           0   12345  deg\n"
                       "Δ                 1e+12     1.5e-07       0\n"
                       "below            -1e+12  -999999999  -1e+09\n"
                       "scheme  hermite-simpson\n") == 0,
          "columns are aligned: %s", text);
    free(text);
}

// A pseudo-terminal's two ends.
static FILE *open_terminal(int *reader)
{
    *reader = posix_openpt(O_RDWR | O_NOCTTY);
    if (*reader < 0 || grantpt(*reader) || unlockpt(*reader))
        return NULL;
    return fopen(ptsname(*reader), "w");
}

// Reads until `size` bytes have come, or none for ten seconds.
static void read_all(int reader, char *seen, size_t size)
{
    struct pollfd waiting = {.fd = reader, .events = POLLIN};
    while (size > 0 && poll(&waiting, 1, 10000) > 0) {
        const ssize_t n = read(reader, seen, size);
        if (n <= 0)
            return;
        seen += n;
        size -= (size_t)n;
    }
}

static void test_progress(void)
{
    const char expected[] = "\riteration 7\033[K\ra line longer than t\033[K\r\033[Kfound 3\r\n\rfront, 1 of 4\033[K"
                            "\rf, 3 of 4, less than\033[K\r\033[K";
    char seen[sizeof expected] = "";
    int reader;
    FILE *terminal = open_terminal(&reader);
    if (!terminal) { // a container may have none
        printf("# no pseudo-terminal here: progress on a terminal is not tested\n");
        return;
    }
    const struct winsize narrow = {.ws_row = 10, .ws_col = 21};
    ioctl(reader, TIOCSWINSZ, &narrow);
    moray_ticker ticker = moray_ticker_start(terminal, false);
    moray_ticker_show(&ticker, "iteration %d", 7);
    moray_ticker_show(&ticker, "%s", "a line longer than the terminal is wide");
    moray_ticker_note(&ticker, "found %d", 3);
    moray_ticker_count(&ticker, 0, 4, "%s", "front");
    moray_ticker_count(&ticker, 2, 4, "%s", "f");
    moray_ticker_end(&ticker);
    read_all(reader, seen, sizeof seen - 1);
    CHECK(strcmp(seen, expected) == 0, "a terminal shows one line, cut to its width, a note that stays, then none");
    ticker = moray_ticker_start(terminal, true);
    CHECK(!ticker.live && !ticker.plain, "quiet is silent on a terminal");
    fclose(terminal);
    close(reader);
    FILE *plain = tmpfile();
    ticker = moray_ticker_start(plain, false);
    moray_ticker_show(&ticker, "iteration %d", 7);
    moray_ticker_note(&ticker, "found %d", 3);
    moray_ticker_end(&ticker);
    CHECK(ticker.plain && !ticker.live, "but is told by lines");
    CHECK(ftell(plain) == 0, "a file gets none in the first minute");
    fclose(plain);
}

// Numbers and texts by their places; nothing stands where a list is asked for what is no number.
static void test_json_places(void)
{
    static const char *const bad[] = {"", "{\"a\": ", "no", "{\"a\": 1} x", "{\"a\": 1}{}"},
                             *const why[] = {"it is empty", "is not JSON", "is not JSON", "is not JSON", "is not JSON"};
    char path[] = "/tmp/moray-json-XXXXXX";
    moray_json_file *json;
    FILE *file = fdopen(mkstemp(path), "w");
    fputs(
        "{\"list\": [{\"a\": 1.5}, {\"a\": 2.5, \"name\": \"two\"}], \"deep\": {\"er\": {\"x\": -3}}, \"none\": null}",
        file);
    fclose(file);
    CHECK_OK(moray_json_read(&json, path), "a file");
    CHECK(moray_json_number_at(json, "list.1.a") == 2.5 && moray_json_number_at(json, "deep.er.x") == -3, "numbers");
    CHECK(!strcmp(moray_json_text_at(json, "list.1.name"), "two"), "a text");
    CHECK(moray_json_count_at(json, "") == 3 && moray_json_count_at(json, "list") == 2 &&
              moray_json_count_at(json, "list.1") == 2 && moray_json_count_at(json, "list.0.a") == -1,
          "members and items");
    static const char *const absent[] = {"list.2.a", "list.-1.a", "list.a", "list.a.a",   "list.1x.a",
                                         "deep.x",   "none",      "deep",   "list.1.name"};
    for (unsigned k = 0; k < sizeof absent / sizeof *absent; k++)
        CHECK(isnan(moray_json_number_at(json, absent[k])), "no number at %s", absent[k]);
    CHECK(!moray_json_text_at(json, "list.1.a") && !moray_json_text_at(json, "list.name"), "nor a text");
    moray_json_file_free(json);
    for (unsigned k = 0; k < sizeof bad / sizeof *bad; k++) {
        file = fopen(path, "w");
        fputs(bad[k], file);
        fclose(file);
        const moray_status status = moray_json_read(&json, path);
        CHECK(moray_failed(status) && !json && strstr(status.text, why[k]), "%s", status.text);
    }
    remove(path);
    const moray_status status = moray_json_read(&json, path);
    CHECK(status.code == MORAY_IO && !json && strstr(status.text, "No such file"), "%s", status.text);
    moray_json_file_free(NULL);
}

// A name in a place is of at most 127 bytes.
static void test_json_keys(void)
{
    char path[] = "/tmp/moray-json-XXXXXX", key[129];
    moray_json_file *json;
    memset(key, 'k', sizeof key);
    key[128] = 0;
    FILE *file = fdopen(mkstemp(path), "w");
    fprintf(file, "{\"%s\": 2, \"%s\": 1}", key, key + 1);
    fclose(file);
    CHECK_OK(moray_json_read(&json, path), "a file");
    CHECK(moray_json_number_at(json, key + 1) == 1, "127 bytes");
    CHECK(isnan(moray_json_number_at(json, key)), "one more is no name");
    moray_json_file_free(json);
    remove(path);
}

int main(void)
{
    test_json_places();
    test_json_keys();
    test_numbers();
    test_json();
    test_json_depth();
    test_json_errors();
    test_json_memory();
    test_csv();
    test_table();
    test_progress();
    return tap_done();
}
