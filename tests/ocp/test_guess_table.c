// SPDX-License-Identifier: MIT
//
// Tables of guesses: of two phases of different widths whose lines alternate and whose columns stand in any order, cell
// by cell; and whole texts of what is wrong with one.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

enum { phases = 2 };
static const int nx[phases] = {2, 3}, nu[phases] = {3, 1};
static const char *const path = "test_guess_table.csv";

static void rest(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->f[1] = at->t;
}

static void rest_on(const moray_node *at, moray_rates *out, const void *data)
{
    rest(at, out, data);
    out->f[2] = at->x[0];
}

static void verdict(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

static moray_ocp *problem(int n, bool named)
{
    static const char *const x[] = {"way", "speed", "heat"}, *const u[] = {"push", "turn", "lift"};
    moray_phase_spec phase[phases];
    for (int p = 0; p < phases; p++)
        phase[p] = (moray_phase_spec){.name = p ? "back" : "out",
                                      .nx = nx[p],
                                      .nu = nu[p],
                                      .continuous = p ? rest_on : rest,
                                      .tf = moray_fixed(1),
                                      .x_names = named ? x : NULL,
                                      .u_names = named ? u : NULL};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = n, .phase = phase, .endpoint = verdict}), "problem");
    return ocp;
}

static void write_file(const char *text)
{
    FILE *file = fopen(path, "w");
    if (file) {
        fputs(text, file);
        fclose(file);
    }
}

// Of column c in line k, as the table has it.
static double cell(int c, int k)
{
    return 100 * (c + 1) + k + 0.5;
}

// Columns: u[1], t, x[2], phase, u[0], x[0], u[2], x[1]; times go on from line to line.
enum { of_u1, of_t, of_x2, of_phase, of_u0, of_x0, of_u2, of_x1, columns };
static const int phase_of_line[] = {2, 1, 1, 2, 1, 2, 2};
enum { lines = 7 };

static void write_table(const char *names)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return;
    fprintf(file, "%s\n", names);
    for (int k = 0; k < lines; k++)
        for (int c = 0; c < columns; c++)
            fprintf(file, "%.17g%s", c == of_phase ? phase_of_line[k] : cell(c, k), c < columns - 1 ? "," : "\n");
    fclose(file);
}

static void test_cells(bool named)
{
    static const int x[] = {of_x0, of_x1, of_x2}, u[] = {of_u0, of_u1, of_u2};
    moray_ocp *ocp = problem(phases, named);
    moray_guess guess;
    write_table(named ? "turn [rad],t [s],heat,phase,push [N],way [m],lift,speed"
                      : "u[1] [rad],t [s],x[2],phase,u[0] [N],x[0] [m],u[2],x[1]");
    CHECK_OK(moray_guess_read(&guess, ocp, path), "a table");
    CHECK(!guess.s && !guess.from && guess.owned, "without parameters");
    int rows[phases] = {0};
    for (int k = 0; k < lines; k++) {
        const int p = phase_of_line[k] - 1, row = rows[p]++;
        const moray_samples *of = &guess.phase[p];
        CHECK(of->time[row] == cell(of_t, k), "time of line %d", k);
        for (int i = 0; i < nx[p]; i++)
            CHECK(of->x[row * nx[p] + i] == cell(x[i], k), "state %d of line %d", i, k);
        for (int i = 0; i < nu[p]; i++)
            CHECK(of->u[row * nu[p] + i] == cell(u[i], k), "control %d of line %d", i, k);
    }
    CHECK(guess.phase[0].n == rows[0] && guess.phase[1].n == rows[1] && rows[0] == 3, "lines of each phase");
    moray_guess_free(&guess);
    CHECK(!guess.owned && !guess.phase, "freed");
    moray_ocp_free(ocp);
}

// One phase asks for no column of phases, and reads none.
static void test_single(void)
{
    moray_ocp *ocp = problem(1, false);
    moray_guess guess;
    write_file("phase,x[1],t,x[0],u[2],u[0],u[1]\n9,1,2,3,4,5,6\nx,7,2,9,10,11,12\n");
    CHECK_OK(moray_guess_read(&guess, ocp, path), "a table of one phase");
    CHECK(guess.phase[0].n == 2 && guess.phase[0].time[1] == 2 && guess.phase[0].x[2] == 9 &&
              guess.phase[0].x[3] == 7 && guess.phase[0].u[3] == 11 && guess.phase[0].u[4] == 12 &&
              guess.phase[0].u[5] == 10,
          "times may be the same");
    moray_guess_free(&guess);
    moray_ocp_free(ocp);
}

static void check_refused(int n, const char *text, const char *expected)
{
    moray_ocp *ocp = problem(n, false);
    moray_guess guess;
    write_file(text);
    const moray_status status = moray_guess_read(&guess, ocp, path);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, expected) == 0, "%s", status.text);
    CHECK(!guess.owned && !guess.phase && !guess.from, "and there is no guess");
    moray_ocp_free(ocp);
}

#define NAMES "phase,t,x[0],x[1],x[2],u[0],u[1],u[2]\n"

static void test_refused(void)
{
    check_refused(2, "t,x[0],x[1],x[2],u[0],u[1],u[2]\n0,0,0,0,0,0,0\n",
                  "test_guess_table.csv: no column phase, which a problem of 2 phases needs");
    check_refused(2, "phase,t,x[0],x[1],u[0],u[1],u[2]\n1,0,0,0,0,0,0\n2,0,0,0,0,0,0\n",
                  "test_guess_table.csv: no column x[2], which phase back needs");
    check_refused(2, "phase,t,x[0],x[1],x[2],u[0],u[1]\n1,0,0,0,0,0,0\n2,0,0,0,0,0,0\n",
                  "test_guess_table.csv: no column u[2], which phase out needs");
    check_refused(1, "time,x[0],x[1],u[0],u[1],u[2]\n0,0,0,0,0,0\n",
                  "test_guess_table.csv: no column t, which phase out needs");
    check_refused(2, NAMES "1,0,0,0,0,0,0,0\n1,0,0,0,0,0,0,0\n", "test_guess_table.csv: no line of phase 2, back");
    check_refused(2, NAMES "2,0,0,0,0,0,0,0\n", "test_guess_table.csv: no line of phase 1, out");
    static const char *const wrong[] = {"0", "3", "1.5", "-1"};
    for (int k = 0; k < 4; k++) {
        char text[200], expected[200];
        snprintf(text, sizeof text, NAMES "1,0,0,0,0,0,0,0\n%s,0,0,0,0,0,0,0\n", wrong[k]);
        snprintf(expected, sizeof expected, "test_guess_table.csv:3: phase = %s: must be a whole number from 1 to 2",
                 wrong[k]);
        check_refused(2, text, expected);
    }
    check_refused(2, NAMES "1,5,0,0,0,0,0,0\n2,1,0,0,0,0,0,0\n1,6,0,0,0,0,0,0\n2,0.5,0,0,0,0,0,0\n",
                  "test_guess_table.csv:5: t = 0.5 comes after 1: times must ascend");
    check_refused(2, NAMES "1,0,0,0,0,0,0,0\n2,0,0,0,0,u,0,0\n",
                  "test_guess_table.csv:3: u[0] = u: not a finite number");
    check_refused(2, NAMES "1,0,0,0,0,0,0,0\n2,0,0,0,x,0,0,0\n",
                  "test_guess_table.csv:3: x[2] = x: not a finite number");
    check_refused(2, NAMES "1,t,0,0,0,0,0,0\n2,0,0,0,0,0,0,0\n", "test_guess_table.csv:2: t = t: not a finite number");
    check_refused(2, NAMES "1,0,0,0,0,0,0,0\np,0,0,0,0,0,0,0\n",
                  "test_guess_table.csv:3: phase = p: not a finite number");
}

// What need not be a number in a column that no phase of the line has.
static void test_unused(void)
{
    moray_ocp *ocp = problem(phases, false);
    moray_guess guess;
    write_file("more,phase,t,x[0],x[1],x[2],u[0],u[1],u[2]\n-,1,0,0,0,-,0,0,0\n-,2,0,0,0,0,0,-,-\n");
    CHECK_OK(moray_guess_read(&guess, ocp, path), "of what a phase does not have");
    moray_guess_free(&guess);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_cells(false);
    test_cells(true);
    test_single();
    test_refused();
    test_unused();
    remove(path);
    return tap_done();
}
