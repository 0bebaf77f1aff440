// SPDX-License-Identifier: MIT
//
// Heading references against what their texts say, and the number of intervals that suits them.
#include "degree.h"
#include "reference_text.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "moray/snake/heading.h"

static void check_at(const moray_reference *reference, double t, double heading, double rate)
{
    double got;
    CHECK_NEAR(moray_reference_at(reference, t, &got) / DEG, heading, 1e-12, "heading [deg]");
    CHECK_NEAR(got / DEG, rate, 1e-12, "its rate [deg/s]");
}

static void test_points(void)
{
    moray_reference steps = read_ok("steps: 2=30 , 5=-10"), ramps = read_ok("ramps:1=0,3=20,3=50,7=30");
    check_at(&steps, 0, 0, 0);
    check_at(&steps, 2, 0, 0); // jumps count as made after their time
    check_at(&steps, 2 + 1e-9, 30, 0);
    check_at(&steps, 100, -10, 0);
    check_at(&ramps, 0, 0, 0);
    check_at(&ramps, 2, 10, 10);
    check_at(&ramps, 3, 20, 10);
    check_at(&ramps, 3 + 1e-13, 50, -5);
    check_at(&ramps, 6, 35, -5);
    check_at(&ramps, 9, 30, 0);
    CHECK_NEAR(moray_reference_fastest(&ramps, 0, 10) / DEG, 10, 1e-12, "fastest, the jump aside [deg/s]");
    CHECK_NEAR(moray_reference_fastest(&ramps, 4, 10) / DEG, 5, 1e-12, "and from 4 s on");
    CHECK(moray_reference_fastest(&steps, 0, 10) == 0, "steps turn at no rate");
    moray_reference_free(&ramps);
    ramps = read_ok("ramps:0=0,2=-30,3=-20,5=0");
    CHECK_NEAR(moray_reference_fastest(&ramps, 1, 4) / DEG, 15, 1e-12, "fastest the other way [deg/s]");
    CHECK_NEAR(moray_reference_fastest(&ramps, 2, 5) / DEG, 10, 1e-12, "what ends where the time begins aside");
    CHECK_NEAR(moray_reference_fastest(&ramps, 2.5, 2.75) / DEG, 10, 1e-12, "within a line");
    moray_reference_free(&ramps);
    moray_reference_free(&steps);
    moray_reference_free(&steps);
    CHECK(steps.n == 0 && !steps.time, "freed twice");
}

static void test_sine(void)
{
    moray_reference sine = read_ok("sine:20,8");
    check_at(&sine, 2, 20, 0);
    check_at(&sine, 4, 0, -20 * 2 * M_PI / 8);
    check_at(&sine, 1, 20 * sqrt(0.5), 20 * sqrt(0.5) * 2 * M_PI / 8);
    CHECK_NEAR(moray_reference_fastest(&sine, 0, 100) / DEG, 20 * 2 * M_PI / 8, 1e-12, "fastest [deg/s]");
    moray_reference_free(&sine);
    sine = read_ok("sine:-20,8");
    check_at(&sine, 2, -20, 0);
    CHECK_NEAR(moray_reference_fastest(&sine, 0, 100) / DEG, 20 * 2 * M_PI / 8, 1e-12, "as fast the other way");
    moray_reference_free(&sine);
}

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    CHECK(file && fputs(text, file) >= 0 && fclose(file) == 0, "%s is written", name);
}

static void test_file(const char *folder)
{
    char name[200], text[6000] = "t_s,heading_deg\r\n";
    snprintf(name, sizeof name, "%s/reference.csv", folder);
    for (int k = 0; k < 100; k++) // more than the first room
        snprintf(text + strlen(text), sizeof text - strlen(text), "%d, %g\r\n%s", k, 0.5 * k, k == 7 ? "\n" : "");
    write_file(name, text);
    moray_reference reference = read_ok(name);
    CHECK(reference.n == 100, "%d points", reference.n);
    check_at(&reference, 60.5, 30.25, 0.5);
    moray_reference_free(&reference);
    unlink(name);
}

static void refuse(const char *text, moray_code code, const char *says)
{
    moray_reference reference;
    const moray_status status = moray_reference_read(&reference, text);
    CHECK(status.code == code && strstr(status.text, says), "'%s': %s", text, status.text);
    CHECK(reference.n == 0 && !reference.time, "leaves nothing");
}

static void test_refused(const char *folder)
{
    static const struct {
        const char *text, *says;
    } files[] = {{"time,heading\n0,1\n", "t_s,heading_deg"},  {"t_s,heading_deg\n0,1\n1;2\n", ":3:"},
                 {"t_s,heading_deg\n2,1\n1,2\n", "ascend"},   {"t_s,heading_deg\n0,1,2\n", ":2:"},
                 {"t_s,heading_deg\n\n", "a line of values"}, {"t_s,heading_deg\n0,nan\n", "finite"}};
    char name[200];
    refuse("steps:", MORAY_INPUT, "no points");
    refuse("steps:2", MORAY_INPUT, "'2'");
    refuse("steps:2=30;4=1", MORAY_INPUT, "T=H");
    refuse("steps:2=30 4=1", MORAY_INPUT, "T=H");
    refuse("steps:5=1,2=30", MORAY_INPUT, "ascend");
    refuse("ramps:0=inf", MORAY_INPUT, "finite");
    refuse("sine:20", MORAY_INPUT, "PERIOD");
    refuse("sine:20,0", MORAY_INPUT, "above 0");
    refuse("sine:20,3x", MORAY_INPUT, "PERIOD");
    refuse("no_such.csv", MORAY_IO, "no_such.csv");
    snprintf(name, sizeof name, "%s/bad.csv", folder);
    for (unsigned k = 0; k < sizeof files / sizeof *files; k++) {
        write_file(name, files[k].text);
        refuse(name, MORAY_INPUT, files[k].says);
    }
    unlink(name);
}

// Jumps at 4 and 9 of 12 s lie on the ends of k intervals when k is a multiple of 12.
static void test_intervals(void)
{
    moray_reference steps = read_ok("steps:4=30,9=0"), ramp = read_ok("ramps:0=0,9=5");
    CHECK(moray_reference_intervals(&steps, 0, 12, 19) == 24, "24 intervals fit where 19 are enough");
    CHECK(moray_reference_intervals(&steps, 0, 12, 24) == 24, "and 24 where 24 are");
    CHECK(moray_reference_intervals(&steps, 0, 3, 7) == 7, "before the jumps any number fits");
    CHECK(moray_reference_intervals(&ramp, 0, 12, 7) == 8, "a corner at 9 s of 12 s counts too");
    const int k = moray_reference_intervals(&steps, 0, 12, 13);
    CHECK(k >= 13 && k <= 16, "no more than 1.3 times as many: %d", k);
    moray_reference_free(&steps);
    moray_reference_free(&ramp);
}

// One corner at a third of the time, behind points before the time: it has a say among fifty points, not among more,
// and a jump always has. What lies before the time would be for ten intervals, which a corner at a third is not.
static void test_intervals_of_many(void)
{
    enum { most = 51 };
    double time[most], heading[most] = {0};
    moray_reference many = {.n = most, .time = time, .heading = heading};
    for (int k = 0; k < most; k++)
        time[k] = 5 - 0.9 * (most - k);
    time[most - 1] = 8;
    CHECK(moray_reference_intervals(&many, 5, 14, 10) == 10, "corners that are many have no say");
    time[most - 2] = 8;
    CHECK(moray_reference_intervals(&many, 5, 14, 10) == 12, "a jump among as many has");
    many.n = most - 1;
    CHECK(moray_reference_intervals(&many, 5, 14, 10) == 12, "and a corner of few");
}

int main(void)
{
    char folder[] = "/tmp/test_reference_XXXXXX";
    if (!CHECK(mkdtemp(folder) != NULL, "a folder"))
        return tap_done();
    test_points();
    test_sine();
    test_file(folder);
    test_refused(folder);
    test_intervals();
    test_intervals_of_many();
    rmdir(folder);
    return tap_done();
}
