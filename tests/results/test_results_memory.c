// SPDX-License-Identifier: MIT
//
// Every allocation of summaries, outputs and JSON files fails once, each by itself.
#define _GNU_SOURCE // mkdtemp
#include "allocations.h"

#include <string.h>
#include <unistd.h>

#include "results/results.h"

static moray_status summarise(void)
{
    FILE *file = fopen("/dev/null", "w");
    moray_json *json = moray_json_new(), *second = moray_json_new();
    moray_json_open(json, "a");
    moray_json_number(json, "b", 3);
    moray_json_text(second, "c", "d");
    moray_status status = moray_json_write(json, file);
    if (!moray_failed(status))
        status = moray_json_write(second, file);
    moray_json_free(json);
    moray_json_free(second);
    fclose(file);
    return status;
}

static moray_status put_out(void)
{
    for (int k = 0; k < 2; k++) {
        moray_output *output;
        FILE *file;
        MORAY_TRY(moray_output_open(&output, "out"));
        moray_status status = moray_output_file(output, "a", &file);
        if (!moray_failed(status))
            status = moray_output_commit(output);
        moray_output_free(output);
        MORAY_TRY(status);
    }
    return moray_ok();
}

// The text that the library of C has allocated is freed here, so that blocks are not counted any more.

static moray_status read_json(void)
{
    for (int k = 0; k < 2; k++) {
        moray_json_file *json = NULL;
        const moray_status status = moray_json_read(&json, "in.json");
        if (moray_failed(status)) {
            CHECK(!json, "nothing is left to be freed");
            return status;
        }
        const double number = moray_json_number_at(json, "a");
        moray_json_file_free(json);
        if (number != 5)
            return moray_error(MORAY_NUMERIC, "%g", number);
    }
    return moray_ok();
}

int main(void)
{
    char folder[] = "/tmp/moray-memory-XXXXXX";
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    FILE *file = fopen("in.json", "w");
    fputs("{\"a\": 5}", file);
    fclose(file);
    fail_each("a summary", false, summarise);
    fail_each("an output", false, put_out);
    CHECK(uneven == 0, "what a run takes it frees, but for %ld", uneven);
    fail_each("a JSON file", false, read_json);
    unlink("in.json"), unlink("out/a"), rmdir("out");
    CHECK(chdir("/") == 0 && rmdir(folder) == 0, "nothing is left behind");
    return tap_done();
}
