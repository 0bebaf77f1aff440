// SPDX-License-Identifier: MIT
//
// Every way to fail, made on purpose: the diagnosis names what was planted.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"

// A cart x' = v, v' = u with one integral and up to two events of the final place.
enum plant { motor, clock_state, unreal, root, greedy, timid };

static void move(const moray_node *at, moray_rates *out, const void *data)
{
    const enum plant plant = *(const enum plant *)data;
    const moray_num x = at->x[0], v = at->x[1], u = at->u[0];
    out->f[0] = plant == clock_state ? 1 : v;
    out->f[1] = u;
    out->g[0] = u * u;
    if (plant == root)
        out->g[0] += sqrt(0.2 - v); // the mean speed must be 1
    if (plant == greedy)
        out->g[0] = -x;
    if (plant == timid)
        out->g[0] = x;
}

static void coast(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = 0;
    out->g[0] = at->x[1];
}

static void judge(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_num goal = at->phase[0].xf[0];
    out->objective = at->phase[0].q[0];
    out->e[0] = *(const enum plant *)data == unreal ? goal * goal + 1.0 : goal;
    out->e[1] = at->phase[0].x0[0] + at->phase[0].xf[0];
}

static void reach(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->e[0] = out->e[1] = at->phase[0].xf[0];
    out->objective = at->phase[0].q[0] - 10 * at->phase[0].xf[0];
}

static const char *const x_names[] = {"place", "speed"}, *const u_names[] = {"force"},
                         *const e_names[] = {"goal", "way"};
static const moray_bounds at_rest[] = {{0, 0}, {0, 0}}, arrived[] = {{1, 1}, {0, 0}},
                          free_end[] = {{-1e20, 1e20}, {0, 0}}, no_event[] = {{-1e20, 1e20}, {-1e20, 1e20}};

static moray_phase_spec cart(void)
{
    return (moray_phase_spec){.name = "cart",
                              .nx = 2,
                              .nu = 1,
                              .nq = 1,
                              .continuous = move,
                              .t0 = moray_fixed(0),
                              .tf = moray_fixed(1),
                              .x0 = {at_rest, 2},
                              .xf = {arrived, 2},
                              .x_names = x_names,
                              .u_names = u_names};
}

static moray_ocp_spec task(const enum plant *plant, const moray_phase_spec *phase)
{
    return (moray_ocp_spec){.name = "cart",
                            .phases = 1,
                            .phase = phase,
                            .ne = 2,
                            .e = {no_event, 2},
                            .e_names = e_names,
                            .endpoint = judge,
                            .data = plant};
}

static int lines_with(const char *text, const char *start)
{
    int count = 0;
    for (const char *line = text; line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL)
        count += strncmp(line, start, strlen(start)) == 0;
    return count;
}

static void check_says(const char *diagnosis, const char *expected)
{
    const char *found = strstr(diagnosis, expected);
    if (!CHECK(found != NULL, "%.*s", found ? (int)strcspn(found, "\n") : (int)strlen(expected),
               found ? found : expected))
        fprintf(stderr, "%s\n", diagnosis);
}

static moray_solution *solve(const moray_ocp_spec *spec, moray_settings settings)
{
    static moray_ocp *ocp; // the last one: solutions must not outlive it
    moray_ocp_free(ocp);
    moray_solution *solution = NULL;
    if (!spec) {
        ocp = NULL;
        return NULL;
    }
    CHECK_OK(moray_ocp_new(&ocp, spec), "problem");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "runs");
    return solution;
}

// One line, of all lines of the diagnosis, or where they are too many of the first, the violation and what to try.
static void check_failure(const moray_solution *solution)
{
    const moray_status failure = moray_solution_failure(solution);
    const char *diagnosis = moray_solution_diagnosis(solution);
    const bool all = strlen(diagnosis) < sizeof failure.text;
    CHECK(failure.code == MORAY_NOT_SOLVED && !strchr(failure.text, '\n') &&
              failure.text[strlen(failure.text) - 1] != ' ',
          "as an error it is one line: %s", failure.text);
    for (const char *line = diagnosis; *line; line += strcspn(line, "\n") + (line[strcspn(line, "\n")] == '\n')) {
        char text[1000];
        snprintf(text, sizeof text, "%.*s", (int)strcspn(line, "\n"), line);
        const bool needed =
            line == diagnosis || strncmp(line, "Largest violation: ", 19) == 0 || strncmp(line, "Try: ", 5) == 0;
        CHECK((strstr(failure.text, text) != NULL) == (all || needed), "which %s: %s",
              all || needed ? "has" : "leaves out", text);
    }
}

// Infeasible or stalled: which of them depends on the linear solver.
#define GAVE_UP MORAY_NLP_INFEASIBLE

static void check_suggestion(const moray_ocp_spec *spec, moray_settings settings, moray_nlp_outcome outcome,
                             const char *expected)
{
    moray_solution *solution = solve(spec, settings);
    if (!solution)
        exit(1);
    const moray_nlp_outcome found = moray_solution_info(solution)->outcome;
    if (outcome == GAVE_UP)
        CHECK(found == MORAY_NLP_INFEASIBLE || found == MORAY_NLP_STALLED, "%s", moray_nlp_outcome_text(found));
    else
        CHECK(found == outcome, "%s", moray_nlp_outcome_text(found));
    check_says(moray_solution_diagnosis(solution), expected);
    check_failure(solution);
    CHECK(lines_with(moray_solution_diagnosis(solution), "Try: ") == 1 &&
              lines_with(moray_solution_diagnosis(solution), "Furthest from the guess: ") == 1,
          "one thing to try");
    moray_solution_free(solution);
}

static const moray_settings *usual(void)
{
    static moray_settings settings;
    settings = moray_settings_default();
    return &settings;
}

static void test_bounds_in_the_way(void)
{
    static const moray_bounds weak[] = {{-1, 1}}, brake[] = {{-1, 1e20}}, // the mean speed must be 1
        slow[] = {{-10, 10}, {-1e20, 0.8}};
    enum plant plant = motor;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    phase.u = (moray_bounds_list){weak, 1};
    check_suggestion(&spec, *usual(), GAVE_UP, "Try: a looser upper bound for control force of phase cart");
    phase.u = (moray_bounds_list){brake, 1};
    check_suggestion(&spec, *usual(), GAVE_UP, "Try: a looser lower bound for control force of phase cart");
    phase.u = (moray_bounds_list){0};
    phase.x = (moray_bounds_list){slow, 2};
    check_suggestion(&spec, *usual(), GAVE_UP, "Try: a looser upper bound for state speed of phase cart");
}

static void test_dependent(void)
{
    static const moray_bounds both[] = {{1, 1}, {2, 2}}, fixed[] = {{-1e20, 1e20}, {3, 3}}, late[] = {{2, 2}, {0, 0}};
    enum plant plant = motor;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    phase.xf.at = free_end;
    spec.e.at = both;
    check_suggestion(
        &spec, *usual(), GAVE_UP,
        "Try: drop or loosen one of these constraints, which depend on each other: event goal; event way.");
    phase.xf.at = arrived;
    spec.e.at = fixed;
    check_suggestion(&spec, *usual(), GAVE_UP,
                     "Try: drop a constraint on which nothing free has an influence: event way.");
    spec.e.at = no_event;
    plant = clock_state;
    phase.xf.at = late;
    check_suggestion(&spec, *usual(), GAVE_UP,
                     "Try: free an end value or a time; the fixed ones leave no choice to: dynamics of state place");
    phase.nu = 0;
    phase.continuous = coast;
    check_suggestion(&spec, *usual(), GAVE_UP,
                     "Try: free an end value or a time, or add a control: there are 81 equations for 79 variables.");
}

enum { goals = 6 };

static void scatter(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
    for (int i = 0; i < goals; i++)
        out->e[i] = at->phase[0].xf[0];
}

static void test_many_dependent(void)
{
    static const char *const names[goals] = {"a", "b", "c", "d", "e", "f"};
    static moray_bounds apart[goals];
    enum plant plant = motor;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    for (int i = 0; i < goals; i++)
        apart[i] = moray_fixed(i);
    phase.xf.at = free_end;
    spec.endpoint = scatter;
    spec.ne = goals;
    spec.e = (moray_bounds_list){apart, goals};
    spec.e_names = names;
    check_suggestion(&spec, *usual(), GAVE_UP, "; and 2 more.");
}

static void test_another_guess(void)
{
    static const moray_bounds unreal_end[] = {{0, 0}, {-1e20, 1e20}};
    enum plant plant = unreal;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    phase.xf.at = free_end;
    spec.e.at = unreal_end;
    check_suggestion(&spec, *usual(), GAVE_UP, "Try: another guess; no bound stands in the way");
}

static void test_runs_away(void)
{
    enum plant plant = greedy;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    phase.xf.at = free_end;
    moray_settings settings = *usual();
    settings.max_iterations = 200;
    check_suggestion(&spec, settings, MORAY_NLP_ITERATION_LIMIT,
                     "Try: an upper bound for control force of phase cart, which went to ");
    plant = timid;
    check_suggestion(&spec, settings, MORAY_NLP_ITERATION_LIMIT,
                     "Try: a lower bound for control force of phase cart, which went to -");
}

static void test_leaves_domain(void)
{
    enum plant plant = root;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    moray_settings settings = *usual();
    settings.max_iterations = 200;
    check_suggestion(
        &spec, settings, GAVE_UP,
        "Try: bounds that keep the functions in their domain. Last, integrand g[0] of phase cart is not finite at ");
}

// ---- Stopped, or at the limit of what can be had ----

static bool stop_at_three(void *observer, const moray_progress *progress)
{
    (void)observer;
    return progress->iteration < 3;
}

static void test_stopped(void)
{
    static const moray_bounds limited[] = {{-6.5, 5}};
    enum plant plant = motor;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    moray_settings settings = *usual();
    phase.u = (moray_bounds_list){limited, 1};
    settings.max_iterations = 2;
    check_suggestion(&spec, settings, MORAY_NLP_ITERATION_LIMIT,
                     "Try: more than max_iterations = 2, from this solution as the guess.");
    settings = *usual();
    settings.progress = stop_at_three;
    check_suggestion(&spec, settings, MORAY_NLP_INTERRUPTED, "Try: go on, with this solution as the guess.");
}

// The cart in real numbers with the noise of, say, a table: 1e-9 of rounding.
static void rough(const moray_real_node *at, moray_real_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0] - 0.1 * rint(1e9 * at->x[1] * at->x[1]) / 1e9;
    out->g[0] = at->u[0] * at->u[0];
}

static void test_noise(void)
{
    enum plant plant = motor;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    moray_settings settings = *usual();
    settings.tolerance = 1e-11;
    phase.continuous = NULL;
    phase.continuous_real = rough;
    check_suggestion(&spec, settings, MORAY_NLP_ACCEPTABLE,
                     "Try: tolerance = 1e-06; rounding in the functions hides anything finer.");
}

// ---- Wrong derivatives ----

static enum { no_slip, first_slips, second_slips } slip;
static bool steep; // beyond all proportion where the check looks, as the density of air is underground

static double thickness(double place)
{
    return steep ? exp(-100 * (place - 1)) : 0;
}

static void value(void *self, const double *in, double *out)
{
    (void)self;
    out[0] = in[1] + thickness(in[0]);
    out[1] = in[2] - in[1] * in[1];
    out[2] = in[2] * in[2];
}
static void jacobian(void *self, const double *in, double *values)
{
    (void)self;
    values[0] = -100 * thickness(in[0]);
    values[1] = 1;
    values[2] = slip == first_slips ? 2 * in[1] : -2 * in[1];
    values[3] = 1;
    values[4] = 2 * in[2];
}
static void hessian(void *self, const double *in, const double *w, double *values)
{
    (void)self;
    values[0] = 1e4 * thickness(in[0]) * w[0];
    values[1] = slip == second_slips ? 2 * w[1] : -2 * w[1];
    values[2] = 2 * w[2];
}

static void test_derivatives(void)
{
    static int jr[] = {0, 0, 1, 1, 2}, jc[] = {0, 1, 1, 2, 2}, hr[] = {0, 1, 2}, hc[] = {0, 1, 2};
    const moray_map map = {.n_in = 4,
                           .n_out = 3,
                           .jac = {5, jr, jc},
                           .hess = {3, hr, hc},
                           .value = value,
                           .jacobian = jacobian,
                           .hessian = hessian};
    enum plant plant = motor;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    moray_settings settings = *usual();
    phase.continuous = NULL;
    phase.map = &map;
    settings.max_iterations = 1;
    for (int k = 0; k < 2; k++) {
        steep = k == 1;
        slip = first_slips;
        check_suggestion(&spec, settings, MORAY_NLP_ITERATION_LIMIT,
                         "Try: correct a derivative. phase cart: d (dynamics of state speed) / d (state speed) is ");
        slip = second_slips;
        check_suggestion(&spec, settings, MORAY_NLP_ITERATION_LIMIT,
                         "Try: correct a second derivative. phase cart: d2 (dynamics of state speed) / d (state speed) "
                         "d (state speed) is ");
        slip = no_slip;
        check_suggestion(&spec, settings, MORAY_NLP_ITERATION_LIMIT,
                         steep ? "Try: free an end value or a time" : "Try: more than max_iterations = 1");
    }
}

// ---- What is allowed, and lists cut short ----

static void many_controls(const moray_node *at, moray_rates *out, const void *data)
{
    move(at, out, data);
    for (int i = 1; i < 14; i++)
        out->g[0] += (at->u[i] - 2) * (at->u[i] - 2);
}

// Two units of place to go: with a constraint that stands in the way, of every form.
static void test_allowed(void)
{
    static const moray_bounds forms[][2] = {
        {{2, 2}, {-1e20, 1e20}}, {{2, 1e20}, {-1e20, 1e20}}, {{-1e20, 0.1}, {-1e20, 1e20}}, {{2, 3}, {-1e20, 1e20}}};
    static const char *const texts[] = {"event goal, 1 where 2 is allowed", "event goal, 1 where at least 2 is allowed",
                                        "event goal, 1 where at most 0.1 is allowed",
                                        "event goal, 1 where 2 to 3 is allowed"};
    enum plant plant = motor;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    for (int k = 0; k < 4; k++) {
        spec.e.at = forms[k];
        moray_solution *solution = solve(&spec, *usual());
        check_says(moray_solution_diagnosis(solution), texts[k]);
        moray_solution_free(solution);
    }
}

static void test_long_lists(void)
{
    static moray_bounds low[14];
    enum plant plant = motor;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    for (int i = 0; i < 14; i++)
        low[i] = i > 0 ? moray_between(0, 1) : moray_free();
    phase.nu = 14;
    phase.u = (moray_bounds_list){low, 14};
    phase.u_names = NULL;
    phase.continuous = many_controls;
    moray_solution *solution = solve(&spec, *usual());
    const char *text = moray_solution_diagnosis(solution);
    check_says(text, "solved after ");
    check_says(text, "No constraint is violated by more than 1.0e-08 (scaled).");
    check_says(text, "And 1 more at their bounds.");
    CHECK(lines_with(text, "Active: control u[") == 12, "after twelve that are listed");
    moray_solution_free(solution);
}

// ---- What is active ----

static void test_active(void)
{
    // of the force 6 - 12 t
    static const moray_bounds limited[] = {{-5, 4.5}}, two_sided[] = {{-1e20, 0.1}, {-1e20, 1e20}};
    enum plant plant = motor;
    moray_phase_spec phase = cart();
    moray_ocp_spec spec = task(&plant, &phase);
    moray_solution *solution = solve(&spec, *usual());
    check_says(moray_solution_diagnosis(solution), "No bound is active.");
    CHECK(lines_with(moray_solution_diagnosis(solution), "Try: ") == 0, "nothing to try where it is solved");
    moray_solution_free(solution);
    phase.u = (moray_bounds_list){limited, 1};
    solution = solve(&spec, *usual());
    const char *text = moray_solution_diagnosis(solution);
    const char *line = strstr(text, "Active: control force of phase cart at its upper bound 4.5 on ");
    int active = 0, nodes = 0;
    double from = -1, to = -1, u;
    CHECK(line && sscanf(line + strlen("Active: control force of phase cart at its upper bound 4.5 on "),
                         "%d of %d nodes, t = %lf .. %lf.", &active, &nodes, &from, &to) == 4,
          "one line for a bound: %.*s", line ? (int)strcspn(line, "\n") : 0, line ? line : "");
    moray_solution_at(solution, 0, to, NULL, &u);
    CHECK(nodes == 41 && from == 0 && active == (int)lrint(to * 40) + 1 && fabs(u - 4.5) < 1e-4,
          "from the first to the last of %d of %d nodes", active, nodes);
    CHECK(lines_with(text, "Active: ") == 2, "and one for the other");
    moray_solution_free(solution);
    phase.u = (moray_bounds_list){0};
    phase.xf.at = free_end;
    spec.e.at = two_sided;
    spec.endpoint = reach;
    solution = solve(&spec, *usual());
    check_says(moray_solution_diagnosis(solution), "Active: event goal at its upper bound 0.1.");
    moray_solution_free(solution);
}

int main(void)
{
    test_bounds_in_the_way();
    test_dependent();
    test_many_dependent();
    test_another_guess();
    test_runs_away();
    test_leaves_domain();
    test_stopped();
    test_noise();
    test_derivatives();
    test_allowed();
    test_long_lists();
    test_active();
    solve(NULL, moray_settings_default());
    return tap_done();
}
