// SPDX-License-Identifier: MIT
//
// Guesses from files and from simulations, and solutions kept in files.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>
#include <unistd.h>

#include "moray/ocp.h"
#include "rk4.h"

static const int rk4_steps = 20;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

// ---- Two legs of a cart: x' = v, v' = p u, up to the middle and on to rest, with least u^2 ----

static void push(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->s[0] * at->u[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void join(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0];
    for (int i = 0; i < 2; i++)
        out->e[i] = at->phase[1].x0[i] - at->phase[0].xf[i];
}

static const char *const x_names[] = {"x", "speed, forward"}, *const u_names[] = {"u"};
static const moray_bounds at_rest[] = {{0, 0}, {0, 0}}, there[] = {{1, 1}, {0, 0}}, joined[] = {{0, 0}, {0, 0}},
                          mass[] = {{2, 2}}, limit[] = {{-3.2, 2.4}};

static moray_ocp *legs(void)
{
    const moray_phase_spec phase[] = {{.name = "out",
                                       .nx = 2,
                                       .nu = 1,
                                       .nq = 1,
                                       .continuous = push,
                                       .t0 = moray_fixed(0),
                                       .tf = moray_fixed(0.5),
                                       .x0 = {at_rest, 2},
                                       .u = {limit, 1},
                                       .x_names = x_names,
                                       .u_names = u_names},
                                      {.name = "in",
                                       .nx = 2,
                                       .nu = 1,
                                       .nq = 1,
                                       .continuous = push,
                                       .t0 = moray_fixed(0.5),
                                       .tf = moray_fixed(1),
                                       .xf = {there, 2},
                                       .u = {limit, 1},
                                       .x_names = x_names,
                                       .u_names = u_names}};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "legs",
                                                   .phases = 2,
                                                   .phase = phase,
                                                   .ns = 1,
                                                   .s = {mass, 1},
                                                   .ne = 2,
                                                   .e = {joined, 2},
                                                   .endpoint = join}),
             "two legs");
    return ocp;
}

static moray_solution *solve(const moray_ocp *ocp, const moray_settings *settings, const moray_guess *guess)
{
    moray_solution *solution = NULL;
    moray_status status = moray_solve(ocp, settings, guess, &solution);
    if (!CHECK(!moray_failed(status), "runs: %s", status.text))
        exit(1);
    return solution;
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    if (!file || fputs(text, file) < 0 || fclose(file) != 0)
        exit(1);
}

static const char *const path = "test_guess.csv", *const kept = "test_guess.solution";

static void check_refused(const moray_ocp *ocp, const char *text, const char *expected)
{
    moray_guess guess;
    write_file(path, text);
    moray_status status = moray_guess_read(&guess, ocp, path);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, expected), "%s", status.text);
    CHECK(!guess.owned, "nothing is owned after an error");
}

static void test_read(void)
{
    moray_ocp *ocp = legs();
    moray_guess guess;
    write_file(path, "phase,t [s],u [N],other,\"speed, forward [m/s]\",x [m]\r\n"
                     "1,0,1.5,nan,0.25,0\r\n1,0.4,-1,,2,0.125\r\n\r\n"
                     "2,0.4,0.5,nan,2,0.125\r\n2,0.7,1e-3,nan,1,0.5\r\n2,1,0,nan,0,1\r\n");
    CHECK_OK(moray_guess_read(&guess, ocp, path), "a table");
    CHECK(guess.phase[0].n == 2 && guess.phase[1].n == 3, "samples of both phases");
    CHECK(guess.phase[0].time[1] == 0.4 && guess.phase[0].x[2] == 0.125 && guess.phase[0].x[3] == 2 &&
              guess.phase[0].u[0] == 1.5 && guess.phase[1].x[5] == 0 && guess.phase[1].x[4] == 1 &&
              guess.phase[1].u[1] == 1e-3,
          "by their names, whatever their order and units");
    const moray_settings settings = moray_settings_default();
    moray_solution *solution = solve(ocp, &settings, &guess), *cold = solve(ocp, &settings, NULL);
    CHECK_RELATIVE(moray_solution_objective(solution), moray_solution_objective(cold), 1e-7, "it can be solved from");
    moray_solution_free(solution);
    moray_solution_free(cold);
    moray_guess_free(&guess);
    moray_guess_free(&guess);
    check_refused(ocp, "t,x,\"speed, forward\",u\n0,0,0,0\n", "no column phase, which a problem of 2 phases needs");
    check_refused(ocp, "phase,t,x,u\n1,0,0,0\n2,0,0,0\n", "no column speed, forward, which phase out needs");
    check_refused(ocp, "phase,t,x,\"speed, forward\",u\n1,0,0,0,0\n", "no line of phase 2, in");
    check_refused(ocp, "phase,t,x,\"speed, forward\",u\n1,0,0,0\n",
                  "test_guess.csv:2: 4 fields, but line 1 names 5 columns");
    check_refused(ocp, "phase,t,x,\"speed, forward\",u\n1,0,0,0,0\n\n2,0,zero,0,0\n",
                  "test_guess.csv:4: x = zero: not a finite number");
    check_refused(ocp, "phase,t\n", "needs a line of names and a line of values");
    remove(path);
    moray_status status = moray_guess_read(&guess, ocp, path);
    CHECK(status.code == MORAY_IO && strstr(status.text, path), "%s", status.text);
    moray_ocp_free(ocp);
}

// ---- Simulated ----

static void forward_then_back(int phase, double t, const double *x, double *u, void *self)
{
    (void)t;
    (void)x;
    u[0] = (phase == 0 ? 1 : -1) * *(const double *)self;
}

static void test_simulated(void)
{
    moray_ocp *ocp = legs();
    moray_guess guess;
    double force = 2;
    const double x0[] = {0, 0}, s[] = {2};
    moray_drive drive[] = {{.t0 = 0, .tf = 0.5, .x0 = x0}, {.t0 = 0.5, .tf = 1, .samples = 6}};
    CHECK_OK(moray_guess_simulate(&guess, ocp, drive, s, forward_then_back, &force, &rk4), "out and in");
    CHECK(guess.phase[0].n == 100 && guess.phase[1].n == 6, "as many samples as asked for, or 100");
    CHECK_NEAR(guess.phase[0].x[2 * 99], 0.5, 1e-12, "half way at constant acceleration 4");
    CHECK_NEAR(guess.phase[1].x[2 * 5], 1, 1e-12, "the second leg goes on from there");
    CHECK_NEAR(guess.phase[1].x[2 * 5 + 1], 0, 1e-12, "to rest");
    CHECK(guess.phase[1].u[5] == -2 && guess.s[0] == 2, "controls and parameters are part of the guess");
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    moray_solution *solution = solve(ocp, &settings, &guess);
    double x[2];
    moray_solution_at(solution, 0, 0.5, x, NULL);
    CHECK_NEAR(x[0], 0.5, 1e-3, "and reach the solver");
    moray_solution_free(solution);
    solution = solve(ocp, &settings, NULL);
    moray_solution_at(solution, 1, 0.5, x, NULL);
    CHECK_NEAR(x[0], 1, 1e-6, "without a guess, a state known at one end is that at the other");
    moray_solution_free(solution);
    moray_guess_free(&guess);
    CHECK_OK(moray_guess_simulate(&guess, ocp, drive, s, NULL, NULL, &rk4), "without a control");
    CHECK_NEAR(guess.phase[0].u[0], -0.4, 1e-15, "the middle of its bounds");
    moray_guess_free(&guess);
    drive[0].x0 = NULL;
    moray_status status = moray_guess_simulate(&guess, ocp, drive, s, NULL, NULL, &rk4);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "phase out: needs x0"), "%s", status.text);
    drive[0] = (moray_drive){.t0 = 1, .tf = 0, .x0 = x0};
    status = moray_guess_simulate(&guess, ocp, drive, s, NULL, NULL, &rk4);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "from t = 1 to 0"), "%s", status.text);
    drive[0] = (moray_drive){.t0 = 0, .tf = 1, .x0 = x0, .samples = 1};
    status = moray_guess_simulate(&guess, ocp, drive, s, NULL, NULL, &rk4);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "samples = 1"), "%s", status.text);
    force = INFINITY;
    drive[0].samples = 0;
    status = moray_guess_simulate(&guess, ocp, drive, s, forward_then_back, &force, &rk4);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "guess of phase out") && !guess.owned, "%s", status.text);
    moray_ocp_free(ocp);
}

// ---- Kept in a file ----

static void check_same(const moray_solution *one, const moray_solution *other, const char *what)
{
    double time[2][200], costate[2][400];
    bool same = moray_solution_objective(one) == moray_solution_objective(other) &&
                moray_solution_info(one)->outcome == moray_solution_info(other)->outcome;
    for (int p = 0; p < 2; p++) {
        const int nodes = moray_solution_nodes(one, p, time[0], costate[0]);
        same = same && nodes == moray_solution_nodes(other, p, time[1], costate[1]) &&
               memcmp(time[0], time[1], (size_t)nodes * sizeof(double)) == 0 &&
               memcmp(costate[0], costate[1], 2 * (size_t)nodes * sizeof(double)) == 0;
        for (int k = 0; same && k <= 50; k++) {
            double a[3], b[3];
            const double t = time[0][0] + (time[0][nodes - 1] - time[0][0]) * k / 50;
            moray_solution_at(one, p, t, a, a + 2);
            moray_solution_at(other, p, t, b, b + 2);
            same = memcmp(a, b, sizeof a) == 0;
        }
    }
    CHECK(same, "%s: to the last bit", what);
}

static bool stop_late(void *observer, const moray_progress *progress)
{
    (void)observer;
    return progress->iteration < 8;
}

static void test_kept(void)
{
    moray_ocp *ocp = legs();
    moray_settings settings = moray_settings_default();
    settings.scheme = "radau3";
    settings.intervals = 5;
    settings.max_refinements = 10;
    moray_solution *solution = solve(ocp, &settings, NULL), *loaded;
    CHECK_OK(moray_solution_save(solution, kept), "saved");
    CHECK_OK(moray_solution_load(&loaded, ocp, NULL, kept), "loaded");
    check_same(solution, loaded, "a refined solution");
    int meshes, known;
    const moray_mesh_record *history = moray_solution_history(solution, &known),
                            *last = moray_solution_history(loaded, &meshes);
    const moray_mesh_record *was = &history[known - 1];
    CHECK(known > 1 && meshes == 1 && was->nodes == last->nodes && was->error == last->error &&
              was->iterations == last->iterations && was->seconds == last->seconds,
          "with its last mesh");
    moray_certificate certificate;
    CHECK_OK(moray_certify(loaded, &rk4, &certificate), "certificate");
    CHECK(certificate.pass, "which passes: %.1e %.1e %.1e %.1e", certificate.kkt, certificate.mesh_error,
          certificate.between_nodes, certificate.resimulation);
    const moray_guess guess = moray_guess_from_solution(loaded);
    settings.intervals = 0;
    moray_solution *again = solve(ocp, &settings, &guess);
    CHECK(moray_solution_info(again)->iterations <= 4, "and solves in %d iterations",
          moray_solution_info(again)->iterations);
    moray_solution_free(again);
    moray_solution_free(loaded);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void test_continued(void)
{
    moray_ocp *ocp = legs();
    moray_settings settings = moray_settings_default();
    moray_solution *whole = solve(ocp, &settings, NULL), *loaded;
    settings.progress = stop_late;
    moray_solution *part = solve(ocp, &settings, NULL);
    CHECK(moray_solution_info(part)->outcome == MORAY_NLP_INTERRUPTED, "interrupted");
    CHECK_OK(moray_solution_save(part, kept), "saved");
    CHECK_OK(moray_solution_load(&loaded, ocp, &settings, kept), "loaded");
    check_same(part, loaded, "an interrupted solution");
    settings.progress = NULL;
    settings.intervals = 0;
    const moray_guess guess = moray_guess_from_solution(loaded);
    moray_solution *rest = solve(ocp, &settings, &guess);
    CHECK(moray_solution_info(rest)->outcome == MORAY_NLP_SOLVED &&
              moray_solution_info(rest)->iterations <= moray_solution_info(whole)->iterations,
          "solved from there: %d iterations, %d from the start", moray_solution_info(rest)->iterations,
          moray_solution_info(whole)->iterations);
    CHECK_RELATIVE(moray_solution_objective(rest), moray_solution_objective(whole), 1e-7, "to the same optimum");
    moray_solution_free(rest);
    moray_solution_free(loaded);
    moray_solution_free(part);
    moray_solution_free(whole);
    moray_ocp_free(ocp);
}

// Copies the kept file with line `line` (from 1) put in the place of its own, or the rest cut where it is NULL.
static void damage(int number, const char *line)
{
    char text[400];
    FILE *from = fopen(kept, "r"), *to = fopen(path, "w");
    if (!from || !to)
        exit(1);
    for (int i = 1; fgets(text, sizeof text, from) && (line || i < number); i++)
        fputs(i == number ? line : text, to);
    fclose(from);
    fclose(to);
}

// A solution file as a guess for another mesh and scheme: warm, with its multipliers.
static void test_read_solution(void)
{
    moray_ocp *ocp = legs();
    moray_settings settings = moray_settings_default();
    moray_solution *solution = solve(ocp, &settings, NULL);
    CHECK_OK(moray_solution_save(solution, kept), "saved");
    moray_guess guess;
    CHECK_OK(moray_guess_read(&guess, ocp, kept), "read as a guess");
    settings.scheme = "radau4";
    settings.intervals = 9;
    moray_solution *warm = solve(ocp, &settings, &guess), *cold = solve(ocp, &settings, NULL);
    CHECK(moray_solution_info(warm)->iterations < moray_solution_info(cold)->iterations, "%d iterations in place of %d",
          moray_solution_info(warm)->iterations, moray_solution_info(cold)->iterations);
    CHECK_RELATIVE(moray_solution_objective(warm), moray_solution_objective(cold), 1e-7, "to the same optimum");
    moray_guess_free(&guess);
    CHECK(!guess.from && !guess.owned, "freed");
    damage(12, "1 x 2\n");
    moray_status status = moray_guess_read(&guess, ocp, path);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "line 12: a finite number"), "%s", status.text);
    moray_solution_free(warm);
    moray_solution_free(cold);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// The fewest stages and the most.
static void test_stages(void)
{
    static const char *const scheme[] = {"gauss1", "radau64"};
    moray_ocp *ocp = legs();
    for (int k = 0; k < 2; k++) {
        moray_settings settings = moray_settings_default();
        moray_solution *loaded = NULL;
        settings.scheme = scheme[k];
        settings.intervals = 2;
        settings.max_refinements = 0;
        moray_solution *solution = solve(ocp, &settings, NULL);
        CHECK_OK(moray_solution_save(solution, kept), "saved");
        CHECK_OK(moray_solution_load(&loaded, ocp, NULL, kept), scheme[k]);
        CHECK(loaded && moray_solution_objective(loaded) == moray_solution_objective(solution), "%s is read again",
              scheme[k]);
        moray_solution_free(loaded);
        moray_solution_free(solution);
    }
    moray_ocp_free(ocp);
}

static void check_damaged(const moray_ocp *ocp, int number, const char *line, const char *expected)
{
    moray_solution *solution;
    damage(number, line);
    moray_status status = moray_solution_load(&solution, ocp, NULL, path);
    CHECK(status.code == MORAY_INPUT && !solution && strstr(status.text, expected), "%s", status.text);
}

static void test_damaged(void)
{
    moray_ocp *ocp = legs();
    moray_settings settings = moray_settings_default();
    settings.intervals = 2;
    moray_solution *solution = solve(ocp, &settings, NULL);
    CHECK_OK(moray_solution_save(solution, kept), "saved");
    check_damaged(ocp, 1, "other\n", "line 1: moray-solution 1 expected");
    check_damaged(ocp, 1, "moray-solution 1 arms\n", "is of problem arms, not of legs");
    check_damaged(ocp, 2, "scheme gauss phases 1 parameters 1 events 2\n",
                  "has 1 phases, 1 parameters and 2 events; "
                  "problem legs has 2, 1 and 2");
    check_damaged(ocp, 2, "scheme euler phases 2 parameters 1 events 2\n", "line 2: scheme lobatto, radau or gauss");
    check_damaged(ocp, 2, "scheme\n", "line 2: scheme, phases");
    check_damaged(ocp, 3, "phase 3 1 0 1 intervals 2\n", "a phase of 3 states");
    check_damaged(ocp, 3, "phase\n", "line 3: phase nx nu");
    static const char *const stages[] = {"99 0.5\n", "65 0.5\n", "0 0.5\n", "-1 0.5\n", "2.5 0.5\n"};
    for (int k = 0; k < 5; k++)
        check_damaged(ocp, 4, stages[k], "line 4: stages and a later end");
    check_damaged(ocp, 5, "3 0.9\n", "line 5: 1 as the end of the last interval");
    check_damaged(ocp, 9, "outcome 17 iterations 1 seconds 0\n", "line 9: outcome");
    check_damaged(ocp, 9, "outcome 0 iterations 1 seconds inf\n", "line 9: outcome");
    check_damaged(ocp, 9, "outcome 0 iterations -1 seconds 0\n", "line 9: outcome");
    check_damaged(ocp, 10, "objective\n", "line 10: objective");
    check_damaged(ocp, 10, "objective nan variables 7 constraints 6\n", "line 10: objective");
    check_damaged(ocp, 5, "4 1\n", "variables and");
    check_damaged(ocp, 12, "1 2\n", "line 12: a finite number");
    check_damaged(ocp, 12, "1 nan 2\n", "line 12: a finite number");
    check_damaged(ocp, 20, NULL, "line 20: more expected");
    moray_status status = moray_solution_save(solution, "no/such/directory/file");
    CHECK(status.code == MORAY_IO && strstr(status.text, "no/such/directory"), "%s", status.text);
    status = moray_solution_save(solution, ".");
    CHECK(status.code == MORAY_IO && access("..part", F_OK) != 0, "%s; nothing is left", status.text);
    moray_solution_free(solution);
    status = moray_solution_load(&solution, ocp, NULL, "no/such/file");
    CHECK(status.code == MORAY_IO, "%s", status.text);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_read();
    test_simulated();
    test_kept();
    test_continued();
    test_read_solution();
    test_stages();
    test_damaged();
    remove(path);
    remove(kept);
    return tap_done();
}
