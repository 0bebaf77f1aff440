// SPDX-License-Identifier: MIT
//
// A folder for files on their way, which another run clears away before it is locked: the linker leads its making to
// the test, which does that.
#define _GNU_SOURCE // mkdtemp
#include "tap.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "results/staging.h"

static int cleared, made; // those that are to be cleared away; made so far
char *__real_mkdtemp(char *path);
char *__wrap_mkdtemp(char *path);

char *__wrap_mkdtemp(char *path)
{
    char *result = __real_mkdtemp(path);
    if (result && made++ < cleared)
        rmdir(result);
    return result;
}

static int lowest_free(void)
{
    const int descriptor = dup(STDIN_FILENO);
    close(descriptor);
    return descriptor;
}

int main(void)
{
    char folder[] = "/tmp/moray-staging-XXXXXX";
    if (!__real_mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    const int before = lowest_free();
    for (cleared = 0; cleared <= 10; cleared++) {
        char path[] = "./.moray-XXXXXX\0behind";
        int held = -1;
        made = 0;
        errno = 0;
        const int error = moray_staging_new(path, &held);
        CHECK(made == (cleared < 10 ? cleared + 1 : 10), "%d are cleared away: %d are made", cleared, made);
        CHECK(strlen(path) == 15 && strcmp(path + 16, "behind") == 0, "its name is as long as it was: %s", path);
        if (cleared == 10) {
            CHECK(error == EAGAIN && lowest_free() == before, "ten times are enough: %s", strerror(error));
            break;
        }
        CHECK(error == 0 && held == before && access(path, F_OK) == 0, "the last one stays, and is held");
        moray_staging_end(path, held);
        CHECK(access(path, F_OK) != 0 && lowest_free() == before, "then it goes");
    }
    char nowhere[] = "nowhere/.moray-XXXXXX";
    int held = -1;
    CHECK(moray_staging_new(nowhere, &held) == ENOENT && held == -1, "there is no place for it");
    CHECK(chdir("/") == 0 && rmdir(folder) == 0, "nothing is left behind");
    return tap_done();
}
