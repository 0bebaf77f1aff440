// SPDX-License-Identifier: MIT
//
// Data from files, and all that is told of what is wrong in them.
#include "tap.h"

#include <string.h>
#include <unistd.h>

#include "moray/fit.h"

enum { ny = 3 };
static const char *const names[ny] = {"a", "b", "c"};
static char path[] = "/tmp/moray_data_XXXXXX";

static moray_status read_text(const char *text, double t0, double tf, moray_data *data)
{
    FILE *file = fopen(path, "w");
    fputs(text, file);
    fclose(file);
    return moray_data_read(data, names, ny, t0, tf, path);
}

static void test_read(void)
{
    moray_data data;
    static const double time[] = {-1, 0.5, 2.5, 4}, value[] = {1, 2, 3, 4, NAN, 6, NAN, 8, 9, NAN, -11, NAN};
    int right = 0;
    CHECK_OK(read_text("c [m/s],other,t [s],a,b\n"
                       "3,x,-1,1,2\n"
                       "6,x,0.5,4,nan\n"
                       "9,x,2.5,,8\n"
                       "NaN,x,4,NAN,-11\n",
                       -1, 4, &data),
             "four times, the first and last on the ends");
    CHECK(data.n == 4 && data.ny == ny, "%d times, %d channels", data.n, data.ny);
    for (int k = 0; k < 4; k++)
        right += data.time[k] == time[k];
    for (int k = 0; k < 4 * ny; k++)
        right += isnan(value[k]) ? !!isnan(data.value[k]) : data.value[k] == value[k];
    CHECK(right == 4 + 4 * ny, "%d numbers as in the file", right);
    moray_data_free(&data);
    CHECK(data.n == 0 && data.time == NULL && data.value == NULL, "and nothing when freed");
}

static void refuse(const char *text, const char *told)
{
    moray_data data;
    char expected[300];
    const moray_status status = read_text(text, 0, 10, &data);
    snprintf(expected, sizeof expected, "%s%s", path, told);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, expected) == 0, "\"%s\": told \"%s\"", expected,
          status.text);
    moray_data_free(&data);
}

static void test_refusals(void)
{
    refuse("t,a,b,c\n1,1,1,1\n10.25,1,1,1\n", ":3: t = 10.25 is not within the phase, [0, 10]");
    refuse("t,a,b,c\n-0.5,1,1,1\n1,1,1,1\n", ":2: t = -0.5 is not within the phase, [0, 10]");
    refuse("t,a,b,c\n1,1,1,1\n2.5,1,1,1\n\n2.5,1,1,1\n",
           ":5: t = 2.5 stands twice, here and in the line before, at 2.5");
    refuse("t,a,b,c\n1,1,1,1\n2.5,1,1,1\n2.25,1,1,1\n", ":4: t = 2.25 comes before the line before, at 2.5");
    refuse("t,a,b,c\n1,1,1,1\n2.5,1,1,1\n1,1,1,1\n", ":4: t = 1 comes before the line before, at 2.5");
    moray_data data;
    moray_status status = read_text("t,a,b,c\n1,1,1,1\nnan,1,1,1\n", 0, 10, &data);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, ":3: t = nan"), "a time is there: %s", status.text);
    moray_data_free(&data);
    status = read_text("t,a,b,c\n1,1,nan(2),1\n", 0, 10, &data);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, ":2: b = nan(2)"), "no number: %s", status.text);
    moray_data_free(&data);
    status = read_text("t,a,b\n1,1,1\n", 0, 10, &data);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "no column c"), "a channel is missing: %s", status.text);
    moray_data_free(&data);
    status = read_text("a,b,c\n1,1,1\n", 0, 10, &data);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "no column t"), "times are missing: %s", status.text);
    moray_data_free(&data);
    status = moray_data_read(&data, names, ny, 0, 10, "/nonexistent/data.csv");
    CHECK(status.code == MORAY_IO && data.n == 0 && data.ny == ny && data.time == NULL, "no file: %s", status.text);
    moray_data_free(&data);
}

int main(void)
{
    close(mkstemp(path));
    test_read();
    test_refusals();
    unlink(path);
    return tap_done();
}
