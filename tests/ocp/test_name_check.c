// SPDX-License-Identifier: MIT
//
// Names of a problem and its parts: what each may be, and which may not be the same.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"
#include "ocp/names.h"
#include "ocp/problem.h"

enum { phases = 2, of_each = 3, longest = 100 };

// One name of a kind changed in a problem whose names are all in order; x and u, c, y of the second phase.
enum kind { problem, phase, x, u, c, y, s, e, kinds };

struct named {
    const char *of[kinds][of_each];
};

static struct named in_order(void)
{
    return (struct named){{[problem] = {"task"},
                           [phase] = {"out", "back"},
                           [x] = {"x0", "x1", "x2"},
                           [u] = {"u0", "u1", "u2"},
                           [c] = {"x0", "c1", "c2"}, // as a state, which may be
                           [y] = {"x0", "y1", "y2"},
                           [s] = {"x0", "s1", "s2"},
                           [e] = {"x0", "e1", "t"}}};
}

static moray_status check(struct named *names, int count)
{
    struct phase part[phases] = {{.name = names->of[phase][0], .nx = 1, .nu = 1, .nc = 1},
                                 {.name = names->of[phase][1], .nx = of_each, .nu = of_each, .nc = of_each}};
    struct phase *last = &part[count - 1];
    if (count == 1)
        *last = part[1], last->name = names->of[phase][0];
    last->x_names = names->of[x];
    last->u_names = names->of[u];
    last->c_names = names->of[c];
    last->observed.names = names->of[y];
    last->observed.ny = of_each;
    const moray_ocp ocp = {.name = names->of[problem][0],
                           .phases = count,
                           .phase = part,
                           .ns = of_each,
                           .ne = of_each,
                           .s_names = names->of[s],
                           .e_names = names->of[e]};
    return moray_check_names(&ocp);
}

static void check_refused(enum kind kind, int i, const char *name, const char *expected)
{
    struct named names = in_order();
    names.of[kind][i] = name;
    const moray_status status = check(&names, phases);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, expected) == 0, "%s", status.text);
}

static void check_allowed(enum kind kind, int i, const char *name, int count)
{
    struct named names = in_order();
    names.of[kind][i] = name;
    CHECK_OK(check(&names, count), name);
}

static void test_one(void)
{
    check_refused(problem, 0, "", "problem 0 of moray_ocp_new: its name is empty");
    check_refused(problem, 0, "a ", "problem 0 of moray_ocp_new: its name \"a \" begins or ends with a blank");
    check_refused(phase, 1, "", "phase 1 of problem task: its name is empty");
    check_refused(x, 2, "", "state 2 of phase back: its name is empty");
    check_refused(u, 1, " v", "control 1 of phase back: its name \" v\" begins or ends with a blank");
    check_refused(u, 1, "v ", "control 1 of phase back: its name \"v \" begins or ends with a blank");
    check_refused(c, 0, "v [m]",
                  "path constraint 0 of phase back: its name \"v [m]\" holds \" [\", which begins a unit");
    check_refused(y, 2, "ab\n", "observation 2 of phase back: its name holds a control character, byte 3");
    check_refused(s, 2, "\ta", "parameter 2 of problem task: its name holds a control character, byte 1");
    check_refused(e, 1, "a\x7f", "event 1 of problem task: its name holds a control character, byte 2");
    check_allowed(x, 0, "v[m] of a, \"b\" (\xc3\xa4)", phases);
    check_allowed(x, 1, "v", phases);
}

static void test_length(void)
{
    char at_most[longest + 1], beyond[longest + 2], expected[200];
    memset(at_most, 'a', longest);
    memset(beyond, 'a', longest + 1);
    at_most[longest] = beyond[longest + 1] = 0;
    check_allowed(e, 2, at_most, phases);
    snprintf(expected, sizeof expected, "event 2 of problem task: its name %.40s... is longer than 100 bytes", beyond);
    check_refused(e, 2, beyond, expected);
    char other[longest + 1]; // but for the last byte
    memcpy(other, at_most, sizeof other);
    other[longest - 1] = 'b';
    struct named names = in_order();
    names.of[x][1] = at_most, names.of[x][2] = other;
    CHECK_OK(check(&names, phases), "names of 100 bytes that differ in the last");
    names.of[x][2] = names.of[u][0] = at_most;
    snprintf(expected, sizeof expected, "states 1 and 2 of phase back are both named %s", at_most);
    const moray_status status = check(&names, phases);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, expected) == 0, "%s", status.text);
}

static void test_two(void)
{
    check_refused(phase, 1, "out", "phases 0 and 1 of problem task are both named out");
    check_refused(x, 2, "x1", "states 1 and 2 of phase back are both named x1");
    check_refused(u, 2, "u0", "controls 0 and 2 of phase back are both named u0");
    check_refused(u, 1, "x2", "state 2 and control 1 of phase back are both named x2");
    check_refused(c, 2, "c1", "path constraints 1 and 2 of phase back are both named c1");
    check_refused(y, 1, "y2", "observations 1 and 2 of phase back are both named y2");
    check_refused(s, 1, "x0", "parameters 0 and 1 of problem task are both named x0");
    check_refused(e, 2, "e1", "events 1 and 2 of problem task are both named e1");
    check_allowed(c, 1, "u1", phases);
    check_allowed(y, 0, "c1", phases);
    check_allowed(s, 0, "e1", phases);
}

static void test_later_phases(void)
{
    struct phase three[] = {{.name = "out", .nx = 1}, {.name = "home", .nx = 1}, {.name = "home", .nx = 1}};
    const moray_ocp ocp = {.name = "task", .phases = 3, .phase = three};
    const moray_status status = moray_check_names(&ocp);
    CHECK(status.code == MORAY_INPUT && !strcmp(status.text, "phases 1 and 2 of problem task are both named home"),
          "%s", status.text);
    three[2].name = "away";
    CHECK_OK(moray_check_names(&ocp), "three phases of three names");
}

// Columns of files.
static void test_reserved(void)
{
    check_refused(x, 1, "t", "state 1 of phase back is named t, as is the column of the time in files");
    check_refused(u, 2, "t", "control 2 of phase back is named t, as is the column of the time in files");
    check_refused(x, 2, "phase", "state 2 of phase back is named phase, as is the column of the phases in files");
    check_refused(u, 1, "phase", "control 1 of phase back is named phase, as is the column of the phases in files");
    check_allowed(x, 2, "phase", 1);
    check_allowed(u, 0, "phase", 1);
    check_allowed(c, 1, "t", phases);
    check_allowed(y, 1, "t", phases);
}

// What has no names is called by its place, which what has names must not be.
static void test_places(void)
{
    struct named names = in_order();
    struct phase part = {.name = "out", .nx = 3, .nu = 2, .u_names = names.of[u]};
    const moray_ocp ocp = {.name = "task", .phases = 1, .phase = &part};
    names.of[u][1] = "x[3]";
    CHECK_OK(moray_check_names(&ocp), "a state that is not there");
    names.of[u][1] = "x[2]";
    const moray_status status = moray_check_names(&ocp);
    CHECK(strcmp(status.text, "state 2 and control 1 of phase out are both named x[2]") == 0, "%s", status.text);
}

int main(void)
{
    for (int count = 1; count <= phases; count++)
        check_allowed(problem, 0, "task", count);
    test_one();
    test_length();
    test_two();
    test_later_phases();
    test_reserved();
    test_places();
    return tap_done();
}
