// SPDX-License-Identifier: MIT
#include "tap.h"

#include <string.h>

#include "moray/status.h"

static moray_status passes_on(void)
{
    MORAY_TRY(moray_error(MORAY_IO, "robot.ini: %s", "no such file"));
    return moray_ok();
}

int main(void)
{
    CHECK(!moray_failed(moray_ok()), "ok has not failed");
    moray_status status = passes_on();
    CHECK(status.code == MORAY_IO && strcmp(status.text, "robot.ini: no such file") == 0,
          "MORAY_TRY passes code and text on: %s", status.text);
    char lengthy[1000];
    memset(lengthy, 'x', sizeof lengthy - 1);
    lengthy[sizeof lengthy - 1] = 0;
    CHECK(strlen(moray_error(MORAY_INPUT, "%s", lengthy).text) == sizeof status.text - 1, "a long text is cut");
    for (int k = 3; k < 900; k += 4)
        lengthy[k] = ' ';
    const char *cut = moray_error(MORAY_INPUT, "%s", lengthy).text, *end = strrchr(cut, 'x');
    CHECK(strcmp(end + 1, " ...") == 0 && (end - cut) % 4 == 2 && strlen(cut) > sizeof status.text - 9,
          "behind a whole word, and says so: %s", end - 6);
    for (size_t length = sizeof status.text - 1; length <= sizeof status.text; length++) {
        const bool fits = length < sizeof status.text;
        status = moray_error(MORAY_INPUT, "%.*s", (int)length, lengthy);
        CHECK((strcmp(status.text + strlen(status.text) - 4, " ...") != 0) == fits, "a text of %zu bytes %s", length,
              fits ? "fits" : "is cut");
    }
    status = moray_error(MORAY_INPUT, "%s", "\"a\r\nb\tc\033d\177\303\251\"");
    CHECK(strcmp(status.text, "\"a  b c?d?\303\251\"") == 0, "a text is one line: %s", status.text);
    CHECK(strcmp(moray_code_text(MORAY_INTERRUPTED), "interrupted") == 0, "texts follow the codes");
    CHECK(strcmp(moray_code_text((moray_code)(MORAY_INTERRUPTED + 1)), "unknown code") == 0, "as far as they go");
    CHECK(strcmp(moray_code_text((moray_code)99), "unknown code") == 0, "an unknown code has a text");
    return tap_done();
}
