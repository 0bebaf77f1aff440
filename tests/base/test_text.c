// SPDX-License-Identifier: MIT
//
// Lines of text files as other systems write them.
#include "tap.h"

#include <malloc.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"

static void test_file(const char *what, const char *bytes, int lines)
{
    char path[] = "/tmp/moray_text_XXXXXX";
    FILE *file = fdopen(mkstemp(path), "w");
    moray_text text;
    fputs(bytes, file);
    fclose(file);
    CHECK_OK(moray_text_read(&text, path, "test file"), what);
    CHECK(text.n == lines, "%s: %d lines", what, text.n);
    if (lines > 0) {
        const char *first = moray_text_next(&text);
        CHECK(first && strcmp(first, "one") == 0, "%s: the first says %s", what, first ? first : "nothing");
    } else {
        CHECK(!moray_text_next(&text), "%s: says nothing", what);
    }
    moray_text_free(&text);
    unlink(path);
}

// ---- Sizes and refusals --------------------------------------------------------------------------------------------

static moray_status read_bytes(moray_text *text, const char *bytes, size_t n, char *path)
{
    strcpy(path, "/tmp/moray_text_XXXXXX");
    FILE *file = fdopen(mkstemp(path), "w");
    fwrite(bytes, 1, n, file);
    fclose(file);
    const moray_status status = moray_text_read(text, path, "test file");
    unlink(path);
    return status;
}

// About the sizes of the block that it is read into, with and without an end to its last line.
static void test_sizes(void)
{
    static const size_t sizes[] = {4094, 4095, 4096, 4097, 10000, 12286, 12287, 12288, 12289, 40000};
    static char bytes[40000];
    char path[30];
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        for (int ended = 0; ended < 2; ended++) {
            moray_text text;
            int lines = 0;
            for (size_t i = 0; i < sizes[k]; i++)
                bytes[i] = i % 10 == 9 ? '\n' : (char)('a' + i / 10 % 26);
            bytes[sizes[k] - 1] = ended ? '\n' : 'z';
            CHECK_OK(read_bytes(&text, bytes, sizes[k], path), "a file");
            for (int line = 0; line < text.n; line++)
                lines += text.line[line][0] == 'a' + line % 26 &&
                         strlen(text.line[line]) == (line + 1 < text.n ? 9 : strlen(text.line[text.n - 1]));
            CHECK(text.n == (int)(sizes[k] + 9) / 10 && lines == text.n, "of %zu bytes has %d lines", sizes[k], text.n);
            const char *last = text.line[text.n - 1];
            CHECK(ended || last[strlen(last) - 1] == 'z', "to its end: %s", last);
            moray_text_free(&text);
        }
}

static void test_refused(void)
{
    static char bytes[100010];
    char path[30], said[300];
    moray_text text;
    memset(bytes, 'x', sizeof bytes);
    bytes[3] = '\n';
    CHECK_OK(read_bytes(&text, bytes, 100004, path), "a line of 100000 bytes");
    CHECK(text.n == 2 && strlen(text.line[1]) == 100000, "is read");
    moray_text_free(&text);
    moray_status status = read_bytes(&text, bytes, 100005, path);
    snprintf(said, sizeof said, "%s:2: longer than 100000 bytes", path);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, said) == 0, "%s", status.text);
    moray_text_free(&text);
    for (int where = 4; where < 7; where++) {
        memcpy(bytes, "one\ntwo\n", 8);
        bytes[where] = 0;
        status = read_bytes(&text, bytes, 8, path);
        snprintf(said, sizeof said, "%s:2: a NUL byte: this is no text in one byte a character", path);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, said) == 0, "%s", status.text);
        moray_text_free(&text);
    }
    status = moray_text_read(&text, "/tmp", "folder");
    CHECK(status.code == MORAY_IO && strcmp(status.text, "folder /tmp: cannot be read: Is a directory") == 0, "%s",
          status.text);
    moray_text_free(&text);
    status = moray_text_read(&text, "/nowhere", "file");
    CHECK(status.code == MORAY_IO &&
              strcmp(status.text, "file /nowhere: cannot be opened: No such file or directory") == 0,
          "%s", status.text);
    moray_text_free(&text);
}

static void test_next(void)
{
    char path[30];
    static const char bytes[] = "  # no\n\t \n\n two # is\nthree\n#\n";
    moray_text text;
    CHECK_OK(read_bytes(&text, bytes, sizeof bytes - 1, path), "comments and blank lines");
    CHECK(strcmp(moray_text_next(&text), " two # is") == 0 && text.at == 4, "are passed over, to line %d", text.at);
    CHECK(strcmp(moray_text_next(&text), "three") == 0 && text.at == 5, "from line to line: %d", text.at);
    CHECK(!moray_text_next(&text) && !moray_text_next(&text) && text.at == 6, "to the end, which stays: %d", text.at);
    moray_text_free(&text);
}

static void test_tail(void)
{
    char path[152];
    for (int n = 98; n <= 150; n++) {
        for (int k = 0; k < n; k++)
            path[k] = (char)('a' + k % 26);
        path[n] = 0;
        CHECK(moray_path_tail(path) == path + (n > 100 ? n - 100 : 0), "of %d characters the last 100 at most", n);
    }
}

int main(void)
{
    mallopt(M_PERTURB, 0x55); // what is not set is no 0
    test_sizes();
    test_refused();
    test_next();
    test_tail();
    test_file("an empty file", "", 0);
    test_file("a byte-order mark alone", "\xEF\xBB\xBF", 0);
    test_file("a byte-order mark and a line", "\xEF\xBB\xBFone", 1);
    test_file("lines that end in LF", "one\ntwo\n", 2);
    test_file("in CR LF", "one\r\ntwo\r\n", 2);
    test_file("in CR", "one\rtwo\r", 2);
    test_file("the last in nothing", "one\n# two", 2);
    return tap_done();
}
