// SPDX-License-Identifier: MIT
//
// Held controls. A double integrator goes from rest at 0 to rest at 1 in time 1 with the least integral of a^2, its
// acceleration a held: a quadratic programme of one number a hold, beside which nothing is approximate. A third state,
// which a control that is free and a short pulse move, makes refinement cut the holds.
#include "tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "rk4.h"

enum { most_holds = 4 };
static const double pulse = 20, pulse_time = 0.3, pulse_width = 0.02;

static void plant(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num z = (at->t - pulse_time) / pulse_width;
    out->f[0] = at->x[1];
    out->f[1] = at->u[1];
    out->f[2] = at->u[0] + pulse * cexp(-z * z);
    out->g[0] = at->u[0] * at->u[0] + at->u[1] * at->u[1];
}

static void effort(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static moray_status build(moray_ocp **ocp, const double *mesh, int intervals, double limit)
{
    const bool held[] = {false, true};
    const moray_bounds start[] = {moray_fixed(0), moray_fixed(0), moray_fixed(0)};
    const moray_bounds end[] = {moray_fixed(1), moray_fixed(0), moray_fixed(1)};
    const moray_bounds u[] = {moray_free(), moray_between(-limit, limit)};
    const moray_phase_spec phase = {.nx = 3,
                                    .nu = 2,
                                    .nq = 1,
                                    .continuous = plant,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x0 = {start, 3},
                                    .xf = {end, 3},
                                    .u = {u, 2},
                                    .mesh = mesh,
                                    .intervals = intervals,
                                    .held = held};
    return moray_ocp_new(ocp, &(moray_ocp_spec){.name = "held", .phases = 1, .phase = &phase, .endpoint = effort});
}

// Least sum of h a^2 with sum h a = 0 and sum h m a = 1, m the time from the middle of a hold to the end: a = p + q m.
static double least_effort(const double *mesh, int holds, double *a)
{
    double one = 0, two = 0, effort_of_all = 0;
    for (int k = 0; k < holds; k++) {
        const double h = mesh[k + 1] - mesh[k], m = 1 - (mesh[k + 1] + mesh[k]) / 2;
        one += h * m;
        two += h * m * m;
    }
    for (int k = 0; k < holds; k++) {
        a[k] = (1 - (mesh[k + 1] + mesh[k]) / 2 - one) / (two - one * one);
        effort_of_all += (mesh[k + 1] - mesh[k]) * a[k] * a[k];
    }
    return effort_of_all;
}

// What the free control, which is constant, costs.
static double cost_beside(void)
{
    return pow(1 - pulse * pulse_width * sqrt(acos(-1)), 2);
}

static void check_held(const moray_solution *solution, const double *mesh, int holds, const double *a)
{
    enum { samples = 7 };
    for (int k = 0; k < holds; k++)
        for (int i = 1; i <= samples; i++) {
            double u[2];
            moray_solution_at(solution, 0, mesh[k] + (mesh[k + 1] - mesh[k]) * i / samples, NULL, u);
            CHECK_NEAR(u[1], a[k], 1e-5, "a held control");
        }
}

static void check_solution(const moray_solution *solution, const char *scheme, double objective)
{
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED, "%s: %s", scheme,
          moray_solution_diagnosis(solution));
    CHECK_RELATIVE(moray_solution_objective(solution), objective, 1e-6, scheme);
    moray_certificate certificate;
    const int steps = 40;
    const moray_integrator rk4 = {rk4_run, &steps};
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.pass, "%s passes: %s", scheme, certificate.why);
}

static void solve_held(const moray_ocp *ocp, const char *scheme, const double *mesh, int holds, const double *a,
                       double objective)
{
    moray_settings settings = moray_settings_default();
    moray_solution *solution, *again;
    int meshes;
    settings.scheme = scheme;
    settings.max_refinements = 15;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
    check_solution(solution, scheme, objective);
    check_held(solution, mesh, holds, a);
    const moray_mesh_record *record = moray_solution_history(solution, &meshes);
    CHECK(record[meshes - 1].nodes > record[0].nodes, "refined from %d nodes to %d", record[0].nodes,
          record[meshes - 1].nodes);
    CHECK_OK(moray_solution_save(solution, "test_hold.moray"), "saved");
    CHECK_OK(moray_solution_load(&again, ocp, &settings, "test_hold.moray"), "loaded");
    check_solution(again, "from a file", objective);
    remove("test_hold.moray");
    moray_solution_free(again);
    settings.max_refinements = 0;
    settings.intervals = 0;
    const moray_guess guess = moray_guess_from_solution(solution);
    CHECK_OK(moray_solve(ocp, &settings, &guess, &again), "solved again on its mesh");
    check_solution(again, "again", objective);
    moray_solution_free(again);
    moray_solution_free(solution);
}

static void test_holds(void)
{
    static const double even[] = {0, 0.25, 0.5, 0.75, 1}, uneven[] = {0, 0.1, 0.45, 1};
    static const char *const schemes[] = {"radau3", "gauss3", "gauss2"};
    double a[most_holds];
    for (int k = 0; k < 3; k++) {
        moray_ocp *ocp;
        const double of_even = least_effort(even, 4, a);
        CHECK_OK(build(&ocp, NULL, 4, 100), "holds of equal length");
        solve_held(ocp, schemes[k], even, 4, a, of_even + cost_beside());
        moray_ocp_free(ocp);
        const double of_uneven = least_effort(uneven, 3, a);
        CHECK_OK(build(&ocp, uneven, 3, 100), "holds of a mesh");
        solve_held(ocp, schemes[k], uneven, 3, a, of_uneven + cost_beside());
        moray_ocp_free(ocp);
    }
}

// By symmetry a = (L, w, -w, -L) at the limit L, and the way is (3 L + w) / 16.
static void test_limit(void)
{
    static const double even[] = {0, 0.25, 0.5, 0.75, 1};
    const double L = 4.4, w = 16 - 3 * L, a[] = {L, w, -w, -L};
    moray_ocp *ocp;
    CHECK_OK(build(&ocp, NULL, 4, L), "limits");
    solve_held(ocp, "radau3", even, 4, a, (L * L + w * w) / 2 + cost_beside());
    moray_ocp_free(ocp);
}

static void test_refusals(void)
{
    static const double other[] = {0, 0.4, 1};
    moray_ocp *ocp, *finer;
    moray_solution *solution = NULL, *none;
    moray_settings settings = moray_settings_default();
    moray_status status = build(&ocp, NULL, 0, 1);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "gives neither intervals nor a mesh"), "%s", status.text);
    CHECK_OK(build(&ocp, NULL, 2, 100), "two holds");
    status = moray_solve(ocp, &settings, NULL, &solution);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "must be radau<s> or gauss<s>"), "%s", status.text);
    settings.scheme = "radau2";
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
    CHECK_OK(build(&finer, other, 2, 100), "two other holds");
    const moray_guess guess = moray_guess_from_solution(solution);
    settings.intervals = 0;
    status = moray_solve(finer, &settings, &guess, &none);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "until 0.4 of its length, where the mesh has no edge"),
          "%s", status.text);
    moray_solution_free(solution);
    moray_ocp_free(finer);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_holds();
    test_limit();
    test_refusals();
    return tap_done();
}
