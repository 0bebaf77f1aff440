// SPDX-License-Identifier: MIT
//
// Bad input to the collocation core: every refusal names the thing, its value and what is allowed.
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"
#include "moray/scheme.h"
#include "rk4.h"

static const int rk4_steps = 20;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

static void check_status(moray_status status, moray_code code, const char *expected)
{
    CHECK(status.code == code && strstr(status.text, expected), "%s", status.text[0] ? status.text : expected);
}

static void refused(moray_status status, const char *expected)
{
    check_status(status, MORAY_INPUT, expected);
}

// ---- Problems ----

static void push(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void energy(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static const moray_bounds nought[] = {{0, 0}, {0, 0}}, one[] = {{1, 1}, {0, 0}}, huge_goal[] = {{9, 9}, {0, 0}},
                          narrow[] = {{-2, 2}, {-1e20, 1e20}}, undefined[] = {{0, NAN}, {0, 1}};

static moray_phase_spec cart(void)
{
    return (moray_phase_spec){.name = "cart",
                              .nx = 2,
                              .nu = 1,
                              .nq = 1,
                              .continuous = push,
                              .t0 = moray_fixed(0),
                              .tf = moray_fixed(1),
                              .x0 = {nought, 2},
                              .xf = {one, 2}};
}

static moray_ocp_spec task(const moray_phase_spec *phase)
{
    return (moray_ocp_spec){.name = "task", .phases = 1, .phase = phase, .endpoint = energy};
}

static void problem_refused(const moray_ocp_spec *spec, const char *expected)
{
    moray_ocp *ocp;
    refused(moray_ocp_new(&ocp, spec), expected);
    CHECK(!ocp, "and there is no problem");
}

static void phase_refused(moray_phase_spec phase, const char *expected)
{
    const moray_ocp_spec spec = task(&phase);
    problem_refused(&spec, expected);
}

static void test_phases(void)
{
    const moray_map narrow_map = {.n_in = 3, .n_out = 3};
    moray_phase_spec phase = cart();
    phase.nx = 0;
    phase_refused(phase, "phase cart: nx 0, nu 1, nc 0, nq 1; nx must be positive, none negative");
    phase = cart();
    phase.nc = -1;
    phase_refused(phase, "nc -1, nq 1; nx must be positive, none negative");
    phase = cart();
    phase.map = &narrow_map;
    phase_refused(phase, "phase cart: needs a continuous function or a map, and only one");
    phase.continuous = NULL;
    phase_refused(phase, "phase cart: the map has 3 inputs and 3 outputs, the phase 4 and 3");
    phase = cart();
    phase.t0 = moray_fixed(2);
    phase_refused(phase, "phase cart: ends by 1, before it may begin at 2");
    phase = cart();
    phase.t0 = moray_between(1, 0);
    phase_refused(phase, "t0[0] of cart: lower bound 1 is above upper bound 0");
    phase = cart();
    phase.u = (moray_bounds_list){undefined, 1};
    phase_refused(phase, "u[0] of cart: a bound is not a number");
    phase = cart();
    phase.x = (moray_bounds_list){narrow, 2};
    phase.xf = (moray_bounds_list){huge_goal, 2};
    phase_refused(phase, "xf[0] of cart: [9, 9] does not meet the bounds [-2, 2] of x");
    phase = cart();
    phase.nc = 1;
    phase_refused(phase, "c of cart: 0 bounds given, 1 needed");
}

static void test_problems(void)
{
    const moray_map narrow_map = {.n_in = 3, .n_out = 1};
    const moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&phase);
    spec.phases = 0;
    problem_refused(&spec, "problem task: 0 phases, ns 0, ne 0; there must be a phase, none negative");
    spec = task(&phase);
    spec.ne = -2;
    problem_refused(&spec, "ne -2; there must be a phase, none negative");
    spec = task(&phase);
    spec.endpoint = NULL;
    problem_refused(&spec, "problem task: needs an endpoint function or a map, and only one");
    spec.endpoint_map = &narrow_map;
    problem_refused(&spec, "problem task: the endpoint map has 3 inputs and 1 outputs, needs 7 and 1");
    spec = task(&phase);
    spec.ne = 1;
    problem_refused(&spec, "e of task: 0 bounds given, 1 needed");
}

static const char *names_of[3];
static const char *const alike[] = {"x", "v", "v"}, *const empty[] = {"x", ""}, *const broken[] = {"x", "v\nw"},
                         *const united[] = {"x", "v [m/s]"}, *const blank[] = {"x", " v"},
                         *const time_like[] = {"x", "t"}, *const other[] = {"u[0]", "v"},
                         *const fine[] = {"x, \"ahead\"", "v"};

static void test_names(void)
{
    static char endless[200];
    memset(endless, 'v', sizeof endless - 1);
    names_of[0] = "x", names_of[1] = endless;
    const struct {
        const char *const *names;
        const char *expected;
    } cases[] = {{alike + 1, "states 0 and 1 of phase cart are both named v"},
                 {empty, "state 1 of phase cart: its name is empty"},
                 {broken, "state 1 of phase cart: its name holds a control character, byte 2"},
                 {united, "state 1 of phase cart: its name \"v [m/s]\" holds \" [\", which begins a unit"},
                 {blank, "state 1 of phase cart: its name \" v\" begins or ends with a blank"},
                 {time_like, "state 1 of phase cart is named t, as is the column of the time in files"},
                 {other, "state 0 and control 0 of phase cart are both named u[0]"},
                 {names_of, "is longer than 100 bytes"}};
    moray_phase_spec phase = cart();
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        phase.x_names = cases[i].names;
        phase_refused(phase, cases[i].expected);
    }
    phase = cart();
    phase.u_names = alike + 1;
    phase.x_names = alike;
    phase_refused(phase, "state 1 and control 0 of phase cart are both named v");
    phase.u_names = NULL;
    phase.nc = 2;
    phase.c = (moray_bounds_list){nought, 2};
    phase.c_names = alike + 1;
    phase_refused(phase, "path constraints 0 and 1 of phase cart are both named v");
    phase = cart();
    phase.name = "a\tb";
    phase_refused(phase, "phase 0 of problem task: its name holds a control character");
}

static void test_names_of_problems(void)
{
    moray_phase_spec phase[] = {cart(), cart()};
    moray_ocp_spec spec = task(phase);
    spec.phases = 2;
    problem_refused(&spec, "phases 0 and 1 of problem task are both named cart");
    phase[0].name = phase[1].name = NULL;
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &spec), "phases without names");
    moray_ocp_free(ocp);
    spec.ns = 2, spec.s_names = alike + 1;
    problem_refused(&spec, "parameters 0 and 1 of problem task are both named v");
    spec.ns = 0, spec.ne = 2, spec.e_names = alike + 1, spec.e = (moray_bounds_list){nought, 2};
    problem_refused(&spec, "events 0 and 1 of problem task are both named v");
    spec = task(phase);
    spec.name = "";
    problem_refused(&spec, "its name is empty");
    spec.name = "task";
    phase[0].x_names = fine;
    CHECK_OK(moray_ocp_new(&ocp, &spec), "commas and quotes, which files can hold");
    moray_ocp_free(ocp);
}

// ---- Observations ----

static void watch(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0];
}

static void test_observations(void)
{
    const moray_map narrow_map = {.n_in = 3, .n_out = 1};
    const double time[] = {0.25, 0.75}, value[] = {0.1, -INFINITY}, undefined_time[] = {0.25, NAN}, weight[] = {-1};
    const moray_observations good = {.n = 2, .ny = 1, .time = time, .value = time, .observe = watch};
    moray_phase_spec phase = cart();
    phase.observed = good, phase.observed.ny = 0;
    phase_refused(phase, "observations of phase cart: n 2, ny 0; need times, values and a channel");
    phase.observed = good, phase.observed.value = NULL;
    phase_refused(phase, "need times, values and a channel");
    phase.observed = good, phase.observed.observe = NULL;
    phase_refused(phase, "observations of phase cart: need a function or a map, and only one");
    phase.observed = good, phase.observed.map = &narrow_map;
    phase_refused(phase, "need a function or a map, and only one");
    phase.observed.observe = NULL;
    phase_refused(phase, "observations of phase cart: the map has 3 inputs and 1 outputs, needs 4 and 1");
    phase.observed = good, phase.observed.loss = MORAY_HUBER;
    phase_refused(phase, "threshold");
    phase.observed = good, phase.observed.value = value;
    phase_refused(phase, "observations of phase cart: value[1][0] is infinite");
    phase.observed = good, phase.observed.time = undefined_time;
    phase_refused(phase, "time[1]");
    phase.observed = good, phase.observed.weight = weight;
    phase_refused(phase, "weight[0]");
}

static moray_ocp *make(const moray_ocp_spec *spec)
{
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, spec), "a good problem");
    return ocp;
}

// ---- Settings and schemes ----

static const double nought_at[] = {0, 0};

static void test_settings(void)
{
    const moray_phase_spec phase = cart();
    const moray_ocp_spec spec = task(&phase);
    moray_ocp *ocp = make(&spec);
    const moray_settings good = moray_settings_default();
    moray_settings settings = good;
    moray_solution *solution;
    settings.intervals = -3;
    refused(moray_solve(ocp, &settings, NULL, &solution), "intervals = -3: must be at least 1");
    settings = good, settings.tolerance = 1;
    refused(moray_solve(ocp, &settings, NULL, &solution), "tolerance = 1: must lie between 0 and 1");
    settings = good, settings.mesh_tolerance = 0;
    refused(moray_solve(ocp, &settings, NULL, &solution), "mesh_tolerance = 0: must be positive");
    settings = good, settings.max_iterations = -1;
    refused(moray_solve(ocp, &settings, NULL, &solution), "max_iterations = -1: must not be negative");
    settings = good, settings.max_refinements = -1;
    refused(moray_solve(ocp, &settings, NULL, &solution), "max_refinements = -1: must not be negative");
    settings = good, settings.print_level = 99;
    refused(moray_solve(ocp, &settings, NULL, &solution), "print level 99: must lie between 0 and 12");
    settings = good, settings.scheme = "radau3,gauss2";
    refused(moray_solve(ocp, &settings, NULL, &solution), "scheme = radau3,gauss2: 2 names for 1 phases");
    CHECK(!solution, "and there is no solution");
    const double nowhere[] = {0, NAN};
    refused(moray_ocp_restart(ocp, NAN, 1, nought_at), "start at nan, length 1: must be finite");
    refused(moray_ocp_restart(ocp, 0, -1, nought_at), "length -1: must be finite, the length not negative");
    refused(moray_ocp_restart(ocp, 0, 1, nowhere), "start of x[1] is not finite");
    moray_ocp_free(ocp);

    moray_scheme scheme;
    refused(moray_scheme_new(&scheme, MORAY_LOBATTO, 1), "1 stages: this family has 2 to 64");
    refused(moray_scheme_new(&scheme, MORAY_GAUSS, 65), "65 stages: this family has 1 to 64");
}

// ---- Guesses ----

static void guess_refused(const moray_ocp *ocp, const moray_guess *guess, const char *expected)
{
    const moray_settings settings = moray_settings_default();
    moray_solution *solution;
    refused(moray_solve(ocp, &settings, guess, &solution), expected);
}

static void test_guesses(void)
{
    const moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&phase);
    spec.ns = 1;
    moray_ocp *ocp = make(&spec);
    double s[] = {1}, time[] = {0, 1}, x[] = {0, 0, 1, 0}, u[] = {0, 0};
    moray_samples samples = {2, time, x, NULL};
    const moray_guess guess = {.phase = &samples, .s = s};
    guess_refused(ocp, &guess, "guess of phase cart: times, states or controls are missing");
    samples.u = u;
    x[2] = INFINITY;
    guess_refused(ocp, &guess, "guess of phase cart: sample 1 is not finite");
    x[2] = 1;
    time[1] = -1;
    guess_refused(ocp, &guess, "guess of phase cart: time -1 of sample 1 is before the one of sample 0");
    time[1] = 1;
    s[0] = NAN;
    guess_refused(ocp, &guess, "guess: parameter 0 is not finite");
    moray_ocp_free(ocp);
}

// A solution of one phase is no guess for two; two cannot be begun anew as one.
static void test_other_phases(void)
{
    moray_phase_spec phase[] = {cart(), cart()};
    phase[1].name = "again";
    moray_ocp_spec spec = task(phase);
    moray_ocp *ocp = make(&spec);
    spec.phases = 2;
    moray_ocp *two = make(&spec);
    moray_settings settings = moray_settings_default();
    moray_solution *solution;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    const moray_guess guess = moray_guess_from_solution(solution);
    guess_refused(two, &guess, "guess: the solution has 1 phases");
    settings.intervals = 0;
    moray_solution *none;
    refused(moray_solve(two, &settings, &guess, &none), "guess: the solution has 1 phases");
    refused(moray_ocp_restart(two, 0, 1, nought_at), "problem task: has 2 phases: must be 1");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    moray_ocp_free(two);
}

// Files of a guess.
static void test_guess_files(void)
{
    static const struct {
        const char *text, *expected;
    } cases[] = {
        {"t,x[0],x[1],u[0]\n0,0,0,0\n1,1,0,0\n0.5,1,0,0\n", ":4: t = 0.5 comes after 1: times must ascend"},
        {"phase,t,x[0],x[1],u[0]\n1,0,0,0,0\n2.5,1,1,0,0\n", ":3: phase = 2.5: must be a whole number from 1 to 2"},
        {"t,x[0],x[1],u[0]\n0,0,zero,0\n", ":2: "},
        {"t,x[0],u[0]\n0,0,0\n", "x[1]"}};
    moray_phase_spec phase[] = {cart(), cart()};
    phase[1].name = "again";
    moray_ocp_spec spec = task(phase);
    moray_ocp *single = make(&spec);
    spec.phases = 2;
    moray_ocp *two = make(&spec);
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        char path[] = "/tmp/moray-guess-XXXXXX";
        moray_guess guess;
        FILE *file = fdopen(mkstemp(path), "w");
        fputs(cases[k].text, file);
        fclose(file);
        refused(moray_guess_read(&guess, *cases[k].text == 'p' ? two : single, path), cases[k].expected);
        remove(path);
    }
    moray_ocp_free(single);
    moray_ocp_free(two);
}

static void test_simulated_guesses(void)
{
    const moray_phase_spec phase = cart();
    const moray_ocp_spec spec = task(&phase);
    moray_ocp *ocp = make(&spec);
    const double x0[] = {0, 0};
    moray_guess guess;
    moray_drive drive = {.t0 = 1, .tf = 0, .x0 = x0};
    refused(moray_guess_simulate(&guess, ocp, &drive, NULL, NULL, NULL, &rk4), "guess of phase cart: from t = 1 to 0");
    drive = (moray_drive){.tf = 1, .x0 = x0, .samples = 1};
    refused(moray_guess_simulate(&guess, ocp, &drive, NULL, NULL, NULL, &rk4),
            "guess of phase cart: samples = 1: must be 0 or at least 2");
    drive = (moray_drive){.tf = 1};
    refused(moray_guess_simulate(&guess, ocp, &drive, NULL, NULL, NULL, &rk4),
            "guess of phase cart: needs x0, for it is the first");
    moray_ocp_free(ocp);
}

// x1' = 1 / x1 at x1 = 0.
static void pole(const moray_node *at, moray_rates *out, const void *data)
{
    push(at, out, data);
    out->f[0] = 1 / at->x[0];
}

static void test_outside_the_domain(void)
{
    moray_phase_spec phase = cart();
    phase.continuous = pole;
    phase.xf = phase.x0;
    const moray_ocp_spec spec = task(&phase);
    moray_ocp *ocp = make(&spec);
    const moray_settings settings = moray_settings_default();
    moray_solution *solution;
    check_status(moray_solve(ocp, &settings, NULL, &solution), MORAY_NUMERIC,
                 "at the guess, dynamics of state x[0] of phase cart is not finite at t = 0");
    moray_ocp_free(ocp);
}

// ---- Files ----

static void test_files(void)
{
    static char path[5000];
    const moray_phase_spec phase = cart();
    const moray_ocp_spec spec = task(&phase);
    moray_ocp *ocp = make(&spec);
    const moray_settings settings = moray_settings_default();
    moray_solution *solution;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    memset(path, 'a', sizeof path - 1);
    refused(moray_solution_save(solution, path), "aaa... is too long");
    check_status(moray_solution_save(solution, "no/such/directory/file"), MORAY_IO, "no/such/directory/file.part: ");
    moray_solution_free(solution);
    check_status(moray_solution_load(&solution, ocp, &settings, "no/such/file"), MORAY_IO, "no/such/file: ");
    moray_ocp_free(ocp);
}

int main(void)
{
    test_phases();
    test_problems();
    test_names();
    test_names_of_problems();
    test_observations();
    test_settings();
    test_guesses();
    test_other_phases();
    test_guess_files();
    test_simulated_guesses();
    test_outside_the_domain();
    test_files();
    return tap_done();
}
