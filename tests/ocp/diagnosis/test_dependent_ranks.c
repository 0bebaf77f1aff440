// SPDX-License-Identifier: MIT
//
// Of events that depend on each other, those that have most part in it are named, most first, and no others.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/solution.h"

enum { NE = 7, NS = NE - 1 };
static double part[NE]; // of each event in a sum that is 0, the last not 0

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
}

static void ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
    out->e[NS] = 0;
    for (int k = 0; k < NS; k++) {
        out->e[k] = at->s[k];
        out->e[NS] -= part[k] / part[NS] * at->s[k];
    }
}

static void check(const double *parts, const char *told)
{
    static const char *const names[] = {"a", "b", "c", "d", "e", "f", "g"};
    const moray_bounds one = moray_fixed(1), none = moray_free();
    const moray_phase_spec phase = {
        .nx = 1, .nu = 1, .continuous = still, .tf = moray_fixed(1), .x0 = MORAY_BOUNDS(moray_fixed(0))};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    char text[300];
    settings.max_iterations = 0;
    settings.intervals = 2;
    settings.own_scaling = false;
    memcpy(part, parts, sizeof part);
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1,
                                                   .phase = &phase,
                                                   .ns = NS,
                                                   .s = MORAY_BOUNDS(none, none, none, none, none, none),
                                                   .ne = NE,
                                                   .e = MORAY_BOUNDS(one, one, one, one, one, one, one),
                                                   .e_names = names,
                                                   .endpoint = ends}),
             "events");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    solution->info.outcome = MORAY_NLP_INFEASIBLE;
    moray_diagnose(solution);
    const char *said = strstr(moray_solution_diagnosis(solution), "Try: ");
    snprintf(text, sizeof text, "Try: drop or loosen one of these constraints, which depend on each other: %s.\n",
             told);
    CHECK(said && !strcmp(said, text), "%s expected %s", said ? said : "nothing", text);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- As many equations as variables are not too many ----

static void rest(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->x[0];
}

static void test_count(int equations)
{
    const moray_phase_spec phase = {
        .nx = 1, .continuous = rest, .tf = moray_fixed(1), .x0 = MORAY_BOUNDS(moray_fixed(0))};
    moray_bounds e[NE], none = moray_free();
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    settings.max_iterations = 0;
    settings.intervals = 2;
    settings.scheme = "hermite-simpson";
    for (int k = 0; k < NE; k++)
        e[k] = k < equations ? moray_fixed(1) : none;
    memcpy(part, (double[]){1, 2, 3, 4, 5, 6, 7}, sizeof part);
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1,
                                                   .phase = &phase,
                                                   .ns = NS,
                                                   .s = MORAY_BOUNDS(none, none, none, none, none, none),
                                                   .ne = NE,
                                                   .e = moray_bounds_of(e, NE),
                                                   .endpoint = ends}),
             "parameters alone");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    solution->info.outcome = MORAY_NLP_INFEASIBLE;
    moray_diagnose(solution);
    const char *said =
        strstr(moray_solution_diagnosis(solution), "Try: free an end value or a time, or add a control: ");
    CHECK((said != NULL) == (equations > NS), "%d equations for six parameters: %s", equations,
          moray_solution_diagnosis(solution));
    CHECK(!said || !strcmp(strstr(said, "there are"), "there are 11 equations for 10 variables.\n"), "with numbers");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// The last row is as long as all others together make it, and counts by its length.
int main(void)
{
    check((double[]){1, 2, 3, 4, 5, 6, 7}, "event g; event f; event e; event d; and 3 more");
    check((double[]){7, 6, 5, 4, 3, 2, 1}, "event g; event a; event b; event c; and 3 more");
    check((double[]){-3, 7, -1, 5, 2, -6, 4}, "event g; event b; event f; event d; and 3 more");
    check((double[]){4, 0, -6, 0, 5, 0, 7}, "event g; event c; event e; event a");
    check((double[]){0, 0, -6, 3, 5, 1, 2}, "event g; event c; event e; event d; and 1 more");
    check((double[]){0, 2, 0, 0, -1, 0, -3}, "event g; event b; event e");
    check((double[]){0, 2, 1e-2, 0, -1, 0, -3}, "event g; event b; event e; event c");
    check((double[]){0, 2, 1e-3, 0, -1, 0, -3}, "event g; event b; event e");
    test_count(NS);
    test_count(NE);
    return tap_done();
}
