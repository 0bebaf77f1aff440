// SPDX-License-Identifier: MIT
//
// Lines of text files as other systems write them.
#include "tap.h"

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

int main(void)
{
    test_file("an empty file", "", 0);
    test_file("a byte-order mark alone", "\xEF\xBB\xBF", 0);
    test_file("a byte-order mark and a line", "\xEF\xBB\xBFone", 1);
    test_file("lines that end in LF", "one\ntwo\n", 2);
    test_file("in CR LF", "one\r\ntwo\r\n", 2);
    test_file("in CR", "one\rtwo\r", 2);
    test_file("the last in nothing", "one\n# two", 2);
    return tap_done();
}
