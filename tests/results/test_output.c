// SPDX-License-Identifier: MIT
#include "folder.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

static void test_commit(void)
{
    moray_output *output = open_in("a/b/c");
    CHECK(entries("") == 0, "opening leaves nothing behind");
    FILE *first = start(output, "first.txt"), *second = start(output, "second.txt");
    fprintf(first, "one %d", 1);
    fprintf(second, "two");
    fflush(NULL);
    CHECK(access(in_root("a/b/c/first.txt"), F_OK) != 0, "no file is in place before the commit");
    CHECK_OK(moray_output_commit(output), "commit");
    CHECK(holds("a/b/c/first.txt", "one 1") && holds("a/b/c/second.txt", "two"), "both files are in place");
    CHECK(entries("a/b/c") == 2, "and nothing else: %d", entries("a/b/c"));
    fprintf(start(output, "third.txt"), "three");
    CHECK_OK(moray_output_commit(output), "a second commit");
    moray_output_free(output);
    CHECK(holds("a/b/c/third.txt", "three") && entries("a/b/c") == 3, "adds to the first");
    output = open_in("a/b/c");
    fprintf(start(output, "first.txt"), "new");
    CHECK(holds("a/b/c/first.txt", "one 1"), "an earlier file stays until the commit");
    CHECK_OK(moray_output_commit(output), "commit over it");
    moray_output_free(output);
    struct stat about;
    CHECK(holds("a/b/c/first.txt", "new") && entries("a/b/c") == 3, "it is replaced");
    output = open_in("a/b/c");
    fprintf(start(output, "fourth.txt"), "four");
    fprintf(start(output, "third.txt"), "newer");
    fprintf(start(output, "fifth.txt"), "five");
    CHECK_OK(moray_output_commit(output), "one over an earlier one, between new ones");
    moray_output_free(output);
    CHECK(holds("a/b/c/third.txt", "newer") && holds("a/b/c/fourth.txt", "four") && entries("a/b/c") == 5,
          "nothing is left of what was replaced: %d", entries("a/b/c"));
    const mode_t mask = umask(0);
    umask(mask);
    CHECK(stat(in_root("a/b/c/first.txt"), &about) == 0 && (about.st_mode & 0777) == (0666 & ~mask),
          "with the usual permissions %o", about.st_mode & 0777);
}

static void test_abandoned(void)
{
    moray_output *output = open_in("new/deep");
    fprintf(start(output, "x"), "x");
    moray_output_free(output);
    CHECK(entries("new") == -1, "directories made for an abandoned output are removed");
    mkdir(in_root("old"), 0777);
    put("old/x", "kept");
    output = open_in("old/");
    fprintf(start(output, "x"), "lost");
    moray_output_free(output);
    CHECK(holds("old/x", "kept") && entries("old") == 1, "an earlier file survives an abandoned output");
    moray_output_free(NULL);
}

// What a killed run has left goes with the next one, what it had set aside goes back; a run under way keeps its own.
static void test_killed(void)
{
    mkdir(in_root("killed"), 0777);
    const pid_t child = fork();
    if (child == 0) {
        moray_output *output;
        FILE *file;
        if (!moray_failed(moray_output_open(&output, in_root("killed"))) &&
            !moray_failed(moray_output_file(output, "x", &file)))
            raise(SIGKILL);
        _exit(0);
    }
    int ended = 0;
    waitpid(child, &ended, 0);
    CHECK(WIFSIGNALED(ended) && entries("killed") == 1, "a killed run leaves its folder: %d", entries("killed"));
    moray_output *output = open_in("killed");
    CHECK(entries("killed") == 0, "which the next one removes: %d", entries("killed"));
    mkdir(in_root("killed/.moray-abcdef"), 0777);
    put("killed/.moray-abcdef/old.y", "kept");
    put("killed/.moray-abcdef/new.z", "lost");
    fprintf(start(output, "x"), "mine");
    moray_output *other = open_in("killed");
    CHECK(holds("killed/y", "kept") && entries("killed") == 2, "killed while it put files in place: %d",
          entries("killed"));
    moray_output_free(other);
    CHECK_OK(moray_output_commit(output), "a run under way keeps its own");
    CHECK(holds("killed/x", "mine") && entries("killed") == 2, "and ends as ever");
    moray_output_free(output);
}

// The second of three files cannot be put in place: the first goes back to what it was, the third never comes.
static void test_failed_commit(void)
{
    mkdir(in_root("half"), 0777);
    put("half/1", "kept");
    mkdir(in_root("half/2"), 0777);
    moray_output *output = open_in("half");
    for (const char *const *name = (const char *const[]){"0", "1", "2", "3", NULL}; *name; name++)
        fprintf(start(output, *name), "lost");
    const moray_status status = moray_output_commit(output);
    CHECK(status.code == MORAY_IO && strstr(status.text, "output file 2: is a directory"), "commit fails: %s",
          status.text);
    CHECK(holds("half/1", "kept") && entries("half") == 2, "all is as it was before");
    moray_output_free(output);
    CHECK(entries("half") == 2, "and stays so");
}

// Removes old/.moray-*/new.NAME, as somebody else might.
static void lose(const char *folder, const char *name)
{
    DIR *directory = opendir(in_root(folder));
    for (const struct dirent *entry; directory && (entry = readdir(directory));)
        if (strncmp(entry->d_name, ".moray-", 7) == 0) {
            char path[700];
            snprintf(path, sizeof path, "%s/%s/new.%s", in_root(folder), entry->d_name, name);
            unlink(path);
        }
    if (directory)
        closedir(directory);
}

// One that is gone cannot be put in place; what it was to replace had been put aside by then.
static void test_lost(void)
{
    mkdir(in_root("gone"), 0777);
    put("gone/first", "kept");
    put("gone/last", "kept too");
    moray_output *output = open_in("gone");
    fprintf(start(output, "first"), "lost");
    fprintf(start(output, "between"), "lost");
    fprintf(start(output, "last"), "lost");
    lose("gone", "last");
    const moray_status status = moray_output_commit(output);
    CHECK(status.code == MORAY_IO &&
              strcmp(status.text, "output file last: cannot be put in place: No such file or directory") == 0,
          "%s", status.text);
    CHECK(holds("gone/first", "kept") && holds("gone/last", "kept too") && entries("gone") == 2, "all is as before");
    moray_output_free(output);
}

static void test_full_disk(void)
{
    struct rlimit limit, was;
    put("old/x", "kept");
    moray_output *output = open_in("old");
    FILE *x = start(output, "x"), *y = start(output, "y");
    getrlimit(RLIMIT_FSIZE, &was);
    limit = was;
    limit.rlim_cur = 8192;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    fprintf(x, "lost");
    for (int i = 0; i < 20000; i++)
        fputc('y', y);
    const moray_status status = moray_output_commit(output);
    setrlimit(RLIMIT_FSIZE, &was);
    CHECK(status.code == MORAY_IO && strstr(status.text, "output file y: cannot be written"), "%s", status.text);
    moray_output_free(output);
    CHECK(holds("old/x", "kept") && entries("old") == 1, "a full disk leaves the earlier files");
}

static void test_unwritable(void)
{
    put("file", "in the way");
    const char *const bad[] = {"/proc/moray/x", in_root("file"), in_root("file/x"), ""};
    for (unsigned i = 0; i < sizeof bad / sizeof *bad; i++) {
        moray_output *output = NULL;
        const moray_status status = moray_output_open(&output, bad[i]);
        CHECK(status.code == MORAY_IO && strstr(status.text, "output directory") && !output, "%s", status.text);
    }
    char lengthy[6000];
    memset(lengthy, 'x', sizeof lengthy - 1);
    lengthy[sizeof lengthy - 1] = 0;
    moray_output *output = NULL;
    CHECK(moray_output_open(&output, lengthy).code == MORAY_IO && !output, "a name too long");
    memcpy(lengthy, root, strlen(root));
    memcpy(lengthy + strlen(root), "/made/", 6);
    lengthy[1000] = 0;
    CHECK(moray_output_open(&output, lengthy).code == MORAY_IO && entries("made") == -1,
          "what was made on the way to a failure is removed");
    output = open_in("names");
    FILE *file;
    const char *const names[] = {"", "a/b", "..", ".hidden", lengthy};
    for (unsigned i = 0; i < sizeof names / sizeof *names; i++)
        CHECK(moray_output_file(output, names[i], &file).code == MORAY_INPUT, "file name %.20s is refused", names[i]);
    start(output, "twice");
    CHECK(moray_output_file(output, "twice", &file).code == MORAY_INPUT, "a name taken is refused");
    moray_output_free(output);
    unlink(in_root("file"));
}

// Two runs with one folder, each of which leaves that of the other alone.
static void test_side_by_side(void)
{
    moray_output *one = open_in("both"), *other = open_in("both");
    fprintf(start(one, "one"), "1");
    fprintf(start(other, "other"), "2");
    CHECK_OK(moray_output_commit(one), "one");
    CHECK_OK(moray_output_commit(other), "the other");
    moray_output_free(one);
    moray_output_free(other);
    CHECK(holds("both/one", "1") && holds("both/other", "2") && entries("both") == 2, "both have what they wrote");
}

int main(void)
{
    if (!enter())
        return 1;
    const int open = handles();
    test_commit();
    test_abandoned();
    test_killed();
    test_failed_commit();
    test_lost();
    test_full_disk();
    test_unwritable();
    test_side_by_side();
    CHECK(handles() == open, "no file stays open");
    leave();
    return tap_done();
}
