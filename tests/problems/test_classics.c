// SPDX-License-Identifier: MIT
//
// The textbook problems that are solved in a second or two: optimum as published, and certificate.
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "classics/classics.h"
#include "moray/sim.h"
#include "rk4.h"

static const int rk4_steps = 40;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

// Robertson's reaction is too stiff for the explicit one.
static moray_integrator integrator_of(const struct classic *classic)
{
    static moray_sim_settings stiff;
    stiff = moray_sim_settings_default();
    return strcmp(classic->name, "robertson") == 0 ? moray_sim_integrator(&stiff) : rk4;
}

// Too long for here; problems/classics solves them.
static const char *const long_ones[] = {
    "hang-glider", "hang-glider-500", "hang-glider-1000", "low-thrust", "low-thrust-slack", "swimmer",
    "climb",       "launch"};

static bool is_long(const char *name)
{
    for (unsigned i = 0; i < sizeof long_ones / sizeof *long_ones; i++)
        if (strcmp(name, long_ones[i]) == 0)
            return true;
    return false;
}

static void test_one(const struct classic *classic)
{
    struct classic_result result;
    char diagnosis[600];
    const moray_settings settings = classic_settings(classic);
    const moray_integrator integrator = integrator_of(classic);
    const moray_status status =
        classic_solve(classic, &settings, &integrator, &result, diagnosis, (int)sizeof diagnosis);
    if (!CHECK(!moray_failed(status), "%s: %s", classic->name, status.text))
        return;
    if (!classic->published) {
        CHECK(strcmp(classic_agreement(classic, &result), "solved") == 0, "%s from its start: %.10g, %s", classic->name,
              result.value, moray_nlp_outcome_text(result.outcome));
        return;
    }
    CHECK(result.agrees, "%s: %.10g, published %s%s%s", classic->name, result.value, classic->published,
          classic->computed ? ", by the data " : "", classic->computed ? classic->computed : "");
    if (classic->fixed_mesh)
        CHECK(result.certificate.kkt <= MORAY_LIMIT_KKT && result.meshes == 1,
              "%s: optimal on the published mesh: KKT %.1e", classic->name, result.certificate.kkt);
    else
        CHECK(result.certificate.pass, "%s passes: %s", classic->name, result.certificate.why);
}

static void test_mesh_history(void)
{
    struct classic_result result;
    const struct classic *classic = classic_find("moon-lander");
    const moray_settings settings = classic_settings(classic);
    int iterations = 0;
    CHECK_OK(classic_solve(classic, &settings, &rk4, &result, NULL, 0), classic->name);
    for (int k = 0; k < result.meshes; k++)
        iterations += result.mesh[k].iterations;
    CHECK(result.meshes > 1 && result.mesh[0].intervals == settings.intervals &&
              result.mesh[result.meshes - 1].error <= settings.mesh_tolerance && iterations == result.iterations,
          "%d meshes, the first of %d intervals, the last with error %.1e", result.meshes, result.mesh[0].intervals,
          result.mesh[result.meshes - 1].error);
    CHECK(result.seconds > 0, "%.3f s of the processor", result.seconds);
}

// Hermite-Simpson's control rings on the singular arc, mesh after mesh.
static void test_ringing(void)
{
    struct classic_result result;
    char diagnosis[600];
    const struct classic *classic = classic_find("jackson");
    const moray_settings settings = classic_settings(classic);
    int changes = 0;
    CHECK_OK(classic_solve(classic, &settings, &rk4, &result, diagnosis, (int)sizeof diagnosis), classic->name);
    for (int k = 0; k < result.meshes; k++)
        changes += result.mesh[k].ringing == 1;
    CHECK(changes == 1 && result.mesh[1].ringing == 1, "the second mesh shows the first control to ring");
    CHECK(strstr(diagnosis, "this scheme rings; changed to radau3"), "which is told: %s", diagnosis);
    CHECK(result.mesh[result.meshes - 1].nodes < 200, "%d nodes resolve it", result.mesh[result.meshes - 1].nodes);
}

// x^2 + y^2 = 1 by x = cos a, y = sin a: the index-3 pendulum without its constraint and its tension.
static void swing(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num a = at->x[0], u = at->u[0];
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = -9.81 * cos(a) - u;
    out->g[0] = u * u;
}

static void test_pendulum_in_polar_coordinates(void)
{
    const moray_phase_spec phase = {.name = "swing",
                                    .nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = swing,
                                    .tf = moray_fixed(3),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(-M_PI / 2), moray_fixed(0))};
    const struct classic *classic = classic_find("pendulum");
    moray_settings settings = classic_settings(classic);
    moray_ocp *ocp;
    moray_solution *solution;
    settings.scheme = "radau5";
    settings.intervals = 40;
    CHECK_OK(classic_new(&ocp, "polar", &phase, classic_first_integral, NULL), "in polar coordinates");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    CHECK_NEAR(moray_solution_objective(solution), strtod(classic->computed, NULL), 1e-7, "the pendulum's optimum");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// Where one family rings or fails, another takes over: Gauss on a bioreactor's singular arc, Radau on a rocket's.
static void test_changes_of_family(void)
{
    static const struct {
        const char *name, *scheme, *changed_to;
    } cases[] = {{"bioreactor", "gauss3", "radau3"},
                 {"goddard", "radau3", "gauss3"},
                 {"goddard", "hermite-simpson", "radau3"},
                 {"robertson", "hermite-simpson", NULL},
                 {"goddard", "gauss3", NULL}};
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct classic_result result;
        const struct classic *classic = classic_find(cases[k].name);
        moray_settings settings = classic_settings(classic);
        const moray_integrator integrator = integrator_of(classic);
        settings.scheme = cases[k].scheme;
        CHECK_OK(classic_solve(classic, &settings, &integrator, &result, NULL, 0), classic->name);
        const char *changed_to = NULL;
        for (int m = 0; m < result.meshes && !changed_to; m++)
            changed_to = result.mesh[m].changed_to;
        CHECK(cases[k].changed_to ? changed_to && strcmp(changed_to, cases[k].changed_to) == 0 : !changed_to,
              "%s from %s: %s", classic->name, cases[k].scheme, changed_to ? changed_to : "stays");
        CHECK(result.agrees && result.certificate.pass, "%.10g, and passes: %s", result.value, result.certificate.why);
    }
}

// A swimmer's strokes go to and fro within a few nodes, too, but by less on finer meshes.
static void test_strokes_are_no_ringing(void)
{
    struct classic_result result;
    const struct classic *classic = classic_find("swimmer");
    moray_settings settings = classic_settings(classic);
    settings.max_refinements = 3;
    CHECK_OK(classic_solve(classic, &settings, &rk4, &result, NULL, 0), classic->name);
    for (int k = 0; k < result.meshes; k++)
        CHECK(!result.mesh[k].changed_to, "swimmer on %d intervals: swing %.3f", result.mesh[k].intervals,
              result.mesh[k].swing);
}

static void test_unsolved(void)
{
    struct classic_result result;
    char diagnosis[600];
    const struct classic *classic = classic_find("obstacle");
    moray_settings settings = classic_settings(classic);
    settings.max_iterations = 1;
    CHECK_OK(classic_solve(classic, &settings, &rk4, &result, diagnosis, (int)sizeof diagnosis), classic->name);
    CHECK(strcmp(classic_agreement(classic, &result), "NOT SOLVED") == 0 && diagnosis[0], "after one iteration: %s: %s",
          classic_agreement(classic, &result), diagnosis);
}

// A value agrees with what is printed when rounding it or cutting it gives the printed digits.
static void test_judgement(void)
{
    const struct {
        const char *published;
        bool agrees;
    } cases[] = {{"1.80160312", true},  {"1.8016", true}, {"1.802", true}, {"1.801", true},      {"1.8017", false},
                 {"1.80160311", false}, {"1.8", true},    {"2", true},     {"1.80160314", false}};
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct classic changed = *classic_find("brachistochrone");
        struct classic_result result;
        const moray_settings settings = classic_settings(&changed);
        changed.published = cases[k].published;
        CHECK_OK(classic_solve(&changed, &settings, &rk4, &result, NULL, 0), changed.published);
        CHECK(result.agrees == cases[k].agrees, "%.10f %s with %s", result.value,
              cases[k].agrees ? "agrees" : "does not agree", changed.published);
    }
    CHECK(!classic_find("no such problem"), "a problem that is not there");
}

int main(void)
{
    int n = 0;
    for (const struct classic *const *c = classics; *c; c++, n++)
        if (!is_long((*c)->name))
            test_one(*c);
    CHECK(n >= 20, "%d problems in the table", n);
    if (tap_thorough()) {
        test_mesh_history();
        test_ringing();
        test_changes_of_family();
        test_pendulum_in_polar_coordinates();
        test_strokes_are_no_ringing();
    }
    test_unsolved();
    test_judgement();
    return tap_done();
}
