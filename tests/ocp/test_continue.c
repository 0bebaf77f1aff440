// SPDX-License-Identifier: MIT
//
// Settings of a solve: what is refused, the schemes that phases get, and the meshes of a solution that is gone on from.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"
#include "ocp/solution.h"

enum { phases = 2 };

static void go(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void pay(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0];
}

static void pay_for_one(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

// Of which the second phase may have a scheme and a number of intervals of its own.
static moray_ocp *make(const char *scheme, int intervals)
{
    static const moray_bounds x0 = {0, 0}, xf = {1, 1};
    moray_phase_spec phase[phases];
    for (int p = 0; p < phases; p++)
        phase[p] = (moray_phase_spec){
            .nx = 1, .nu = 1, .nq = 1, .continuous = go, .tf = moray_fixed(1), .x0 = {&x0, 1}, .xf = {&xf, 1}};
    phase[1].scheme = scheme;
    phase[1].intervals = intervals;
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = phases, .phase = phase, .endpoint = pay}), "a problem");
    return ocp;
}

static moray_settings settings_of(const char *scheme, int intervals)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme;
    settings.intervals = intervals;
    return settings;
}

static void check_refused(const moray_ocp *ocp, const moray_settings *settings, const moray_guess *guess,
                          const char *expected)
{
    moray_solution *none;
    const moray_status status = moray_solve(ocp, settings, guess, &none);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, expected) == 0 && !none, "%s", status.text);
}

// ---- Numbers ----

static void test_numbers(void)
{
    static const char intervals[] = "intervals = 0: must be at least 1 (0 with a guess from a solution)";
    moray_ocp *ocp = make(NULL, 0);
    moray_settings settings = settings_of("radau2", 0);
    check_refused(ocp, &settings, NULL, intervals);
    check_refused(ocp, &settings, &(moray_guess){.s = NULL}, intervals);
    settings.intervals = 1;
    moray_solution *solution = NULL;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "one interval");
    moray_solution_free(solution);
    settings.mesh_tolerance = NAN;
    check_refused(ocp, &settings, NULL, "mesh_tolerance = nan: must be positive");
    settings = settings_of("radau2", 1), settings.max_cpu_seconds = -1;
    check_refused(ocp, &settings, NULL, "max_cpu_seconds = -1: must not be negative");
    settings.max_cpu_seconds = NAN;
    check_refused(ocp, &settings, NULL, "max_cpu_seconds = nan: must not be negative");
    settings = settings_of("radau2", 1), settings.max_variables = -1;
    check_refused(ocp, &settings, NULL, "max_variables = -1: must not be negative");
    settings = settings_of("radau2", 1), settings.max_refinements = -1;
    check_refused(ocp, &settings, NULL, "max_refinements = -1: must not be negative");
    settings = settings_of("radau2", 1), settings.max_iterations = -1;
    check_refused(ocp, &settings, NULL, "max_iterations = -1: must not be negative");
    moray_ocp_free(ocp);
}

// ---- Schemes ----

static void check_mesh(const moray_solution *solution, int p, moray_family family, int stages, int intervals)
{
    const struct mesh *mesh = &solution->transcription->layout.phase[p].mesh;
    CHECK(mesh->method.family == family && mesh->method.stages == stages && mesh->intervals == intervals,
          "phase %d: family %d, %d stages, %d intervals", p, mesh->method.family, mesh->method.stages, mesh->intervals);
    for (int k = 0; k < intervals; k++)
        CHECK(mesh->stages[k] == stages, "of all intervals");
}

static void test_schemes(void)
{
    static const struct {
        const char *own, *asked;
        int intervals;
        struct method method[phases];
    } cases[] = {{NULL, "radau3", 0, {{MORAY_RADAU, 3}, {MORAY_RADAU, 3}}},
                 {"gauss2", "radau3", 7, {{MORAY_RADAU, 3}, {MORAY_GAUSS, 2}}},
                 {"gauss2", "radau3,lobatto4", 0, {{MORAY_RADAU, 3}, {MORAY_LOBATTO, 4}}},
                 {NULL, "trapezoid,gauss1", 2, {{MORAY_LOBATTO, 2}, {MORAY_GAUSS, 1}}}};
    for (int k = 0; k < 4; k++) {
        moray_ocp *ocp = make(cases[k].own, cases[k].intervals);
        moray_solution *solution;
        const moray_settings settings = settings_of(cases[k].asked, 5);
        CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), cases[k].asked);
        for (int p = 0; p < phases; p++)
            check_mesh(solution, p, cases[k].method[p].family, cases[k].method[p].stages,
                       p && cases[k].intervals ? cases[k].intervals : 5);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

static void test_wrong_schemes(void)
{
    moray_ocp *ocp = make(NULL, 0);
    moray_settings settings = settings_of("radau3,gauss2,radau2", 5);
    check_refused(ocp, &settings, NULL, "scheme = radau3,gauss2,radau2: 3 names for 2 phases");
    settings.scheme = "radau3,";
    check_refused(ocp, &settings, NULL,
                  "scheme = : must be trapezoid, hermite-simpson, lobatto<s> (s = 2..64), radau<s> or gauss<s> (s = "
                  "1..64)");
    settings.scheme = "radau3,euler";
    check_refused(ocp, &settings, NULL,
                  "scheme = euler: must be trapezoid, hermite-simpson, lobatto<s> (s = 2..64), radau<s> or gauss<s> (s "
                  "= 1..64)");
    moray_ocp_free(ocp);
}

// ---- Meshes of a solution ----

// Intervals and family are those of the solution, what new ones would have that of the settings.
static void test_continued(void)
{
    static const struct {
        const char *own, *before, *asked;
        struct method method[phases];
    } cases[] = {{NULL, "radau3", "radau2", {{MORAY_RADAU, 2}, {MORAY_RADAU, 2}}},
                 {NULL, "lobatto4", "gauss1", {{MORAY_LOBATTO, 2}, {MORAY_LOBATTO, 2}}},
                 {NULL, "lobatto4", "lobatto3", {{MORAY_LOBATTO, 3}, {MORAY_LOBATTO, 3}}},
                 {NULL, "radau3", "gauss1", {{MORAY_RADAU, 1}, {MORAY_RADAU, 1}}},
                 {"gauss4", "radau3", "radau2", {{MORAY_RADAU, 2}, {MORAY_GAUSS, 4}}},
                 {NULL, "radau3,lobatto4", "gauss2,gauss1", {{MORAY_RADAU, 2}, {MORAY_LOBATTO, 2}}}};
    for (int k = 0; k < 6; k++) {
        moray_ocp *ocp = make(cases[k].own, 3);
        moray_solution *first, *second;
        const moray_settings before = settings_of(cases[k].before, 4), after = settings_of(cases[k].asked, 0);
        CHECK_OK(moray_solve(ocp, &before, NULL, &first), cases[k].before);
        const moray_guess guess = moray_guess_from_solution(first);
        CHECK_OK(moray_solve(ocp, &after, &guess, &second), cases[k].asked);
        for (int p = 0; p < phases; p++) {
            const struct mesh *old = &first->transcription->layout.phase[p].mesh,
                              *mesh = &second->transcription->layout.phase[p].mesh;
            CHECK(moray_mesh_equal(old, mesh) && mesh->intervals == (p ? 3 : 4), "the mesh of phase %d", p);
            CHECK(mesh->method.family == cases[k].method[p].family && mesh->method.stages == cases[k].method[p].stages,
                  "%s after %s: phase %d has family %d, %d stages for new intervals", cases[k].asked, cases[k].before,
                  p, mesh->method.family, mesh->method.stages);
        }
        moray_solution_free(first);
        moray_solution_free(second);
        moray_ocp_free(ocp);
    }
}

static void test_fewer_phases(void)
{
    static const moray_bounds x0 = {0, 0};
    const moray_phase_spec phase = {.nx = 1, .nu = 1, .nq = 1, .continuous = go, .tf = moray_fixed(1), .x0 = {&x0, 1}};
    moray_ocp *two = make(NULL, 0), *one;
    moray_solution *solution;
    const moray_settings settings = settings_of("radau2", 2), none = settings_of("radau2", 0);
    CHECK_OK(moray_ocp_new(&one, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = pay_for_one}),
             "one phase");
    CHECK_OK(moray_solve(one, &settings, NULL, &solution), "solved");
    const moray_guess guess = moray_guess_from_solution(solution);
    check_refused(two, &none, &guess, "guess: the solution has 1 phases, the problem 2");
    moray_solution_free(solution);
    moray_ocp_free(one);
    moray_ocp_free(two);
}

// Least integral of (1 - u^2)^2 + x^2, x' = u, x = 0 at both ends: no control is best but one that goes to and fro ever
// faster.
static void flutter(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num off = 1 - at->u[0] * at->u[0];
    out->f[0] = at->u[0];
    out->g[0] = off * off + at->x[0] * at->x[0];
}

// The scheme that is gone on with may change as another, unless it is the phase's own.
static void test_changes(const char *own)
{
    static const moray_bounds zero = {0, 0}, u = {-1.5, 1.5};
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = flutter,
                                    .tf = moray_fixed(1),
                                    .x0 = {&zero, 1},
                                    .xf = {&zero, 1},
                                    .u = {&u, 1},
                                    .scheme = own};
    moray_ocp *ocp;
    moray_solution *first, *second;
    int meshes, changed = 0;
    const moray_settings settings = settings_of("gauss2", 8);
    moray_settings more = settings_of("radau2", 0); // which is not the family of the mesh
    more.max_refinements = 3;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = pay_for_one}), "flutter");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &first), "begun");
    const moray_guess guess = moray_guess_from_solution(first);
    CHECK_OK(moray_solve(ocp, &more, &guess, &second), "gone on with");
    const moray_mesh_record *history = moray_solution_history(second, &meshes);
    for (int k = 0; k < meshes; k++)
        changed += history[k].changed_to && strcmp(history[k].changed_to, "radau3") == 0;
    CHECK((changed > 0) == !own, "the scheme changed to radau3 %d times", changed);
    moray_solution_free(first);
    moray_solution_free(second);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_numbers();
    test_schemes();
    test_wrong_schemes();
    test_continued();
    test_fewer_phases();
    test_changes(NULL);
    test_changes("gauss2");
    return tap_done();
}
