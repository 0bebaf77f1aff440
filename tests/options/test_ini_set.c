// SPDX-License-Identifier: MIT
#include "tap.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "moray/app/options.h"

static char directory[] = "/tmp/ini_set_XXXXXX";

static void put(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    if (file) {
        fputs(text, file);
        fclose(file);
    }
}

static bool holds(const char *path, const char *wanted)
{
    char text[2000] = "";
    FILE *file = fopen(path, "r");
    if (file) {
        text[fread(text, 1, sizeof text - 1, file)] = 0;
        fclose(file);
    }
    if (strcmp(text, wanted) != 0)
        printf("# got\n# %s\n", text);
    return strcmp(text, wanted) == 0;
}

static const moray_ini_entry two[] = {{"rot_damping", "1.3"}, {"rot_gain", "41  ; fitted"}};

// Sets both entries in [robot] of a file that says `before`.
static void check(const char *what, const char *before, const char *after)
{
    put("robot.ini", before);
    CHECK_OK(moray_ini_set("robot.ini", "robot", two, 2), what);
    CHECK(holds("robot.ini", after), "%s", what);
}

static void test_texts(void)
{
    check("in their places", "; mine\n[robot]\nlinks = 10 ; many\n  rot_damping=1.15 ; old\nrot_gain : 40\nk_p = 200\n",
          "; mine\n[robot]\nlinks = 10 ; many\nrot_damping = 1.3\nrot_gain = 41  ; fitted\nk_p = 200\n");
    check("one there, one at the section's end",
          "[robot]\nrot_gain = 40\nlinks = 3\n\n; of the solver\n[solver]\nrot_damping = 7\n",
          "[robot]\nrot_gain = 41  ; fitted\nlinks = 3\nrot_damping = 1.3\n\n; of the solver\n[solver]\nrot_damping = "
          "7\n");
    check("no such section, no newline at the end", "[solver]\ntol = 1",
          "[solver]\ntol = 1\n\n[robot]\nrot_damping = 1.3\nrot_gain = 41  ; fitted\n");
    check("an empty section", "[robot]\n", "[robot]\nrot_damping = 1.3\nrot_gain = 41  ; fitted\n");
    check(
        "names that only begin alike and comments", "[robots]\nrot_gain = 1\n[robot]\nrot_gain_2 = 5\n;rot_gain = 6\n",
        "[robots]\nrot_gain = 1\n[robot]\nrot_gain_2 = 5\nrot_damping = 1.3\nrot_gain = 41  ; fitted\n;rot_gain = 6\n");
    check("an empty file", "", "[robot]\nrot_damping = 1.3\nrot_gain = 41  ; fitted\n");
}

static void test_files(void)
{
    struct stat about;
    CHECK_OK(moray_ini_set("fresh.ini", "robot", two, 1), "no file yet");
    CHECK(holds("fresh.ini", "[robot]\nrot_damping = 1.3\n"), "is made");
    put("kept.ini", "[robot]\n");
    chmod("kept.ini", 0640);
    CHECK(symlink("kept.ini", "link.ini") == 0, "a link");
    CHECK_OK(moray_ini_set("link.ini", "robot", two, 1), "through a link");
    CHECK(holds("kept.ini", "[robot]\nrot_damping = 1.3\n"), "to the file itself");
    CHECK(stat("kept.ini", &about) == 0 && (about.st_mode & 0777) == 0640, "which keeps its permissions");
    CHECK(lstat("link.ini", &about) == 0 && S_ISLNK(about.st_mode), "and the link its nature");
    const moray_status absent = moray_ini_set("absent/robot.ini", "robot", two, 2);
    CHECK(absent.code == MORAY_IO && strstr(absent.text, "absent/robot.ini"), "%s", absent.text);
    CHECK(moray_ini_set(".", "robot", two, 2).code == MORAY_IO, "a directory");
}

// A disk that is full in the middle of the text, or almost at its start.
static void test_full_disk(void)
{
    struct rlimit was, limit;
    getrlimit(RLIMIT_FSIZE, &was);
    signal(SIGXFSZ, SIG_IGN);
    for (int k = 0; k < 2; k++) {
        char text[1500], last[600];
        memset(text, 'x', sizeof text);
        memcpy(text, "[robot]\n;", 9);
        strcpy(text + sizeof text - 2, "\n");
        memset(last, 'y', sizeof last);
        last[sizeof last - 1] = 0;
        const moray_ini_entry large[] = {{"rot_gain", last}};
        put("full.ini", text);
        limit = was;
        limit.rlim_cur = k ? 16 : 1024;
        setrlimit(RLIMIT_FSIZE, &limit);
        const moray_status status = moray_ini_set("full.ini", "robot", large, 1);
        setrlimit(RLIMIT_FSIZE, &was);
        CHECK(status.code == MORAY_IO && strstr(status.text, "full.ini: cannot be written"), "%s", status.text);
        CHECK(holds("full.ini", text), "what was there stays");
    }
}

int main(void)
{
    if (!mkdtemp(directory) || chdir(directory) != 0)
        return 1;
    test_texts();
    test_files();
    test_full_disk();
    CHECK(system("rm robot.ini fresh.ini kept.ini link.ini full.ini") == 0 && chdir("/") == 0 && rmdir(directory) == 0,
          "nothing else is left behind");
    return tap_done();
}
