// SPDX-License-Identifier: MIT
//
// Dependences that hide behind a branch: whatever decides the branch, the optimum is that of the same problem whose
// functions show every dependence everywhere.
#include "tap.h"

#include <stdlib.h>

#include "moray/num.h"
#include "moray/ocp.h"
#include "moray/sim.h"
#include "ocp/probe.h"
#include "ocp/problem.h"

enum { by_time, by_state, by_control, by_parameter, by_time_curved, by_place, by_place_curved, kinds };
static const char *const kind_names[kinds] = {"time",
                                              "a state",
                                              "a control",
                                              "a parameter",
                                              "time, in the Hessian alone",
                                              "a place that no point of the box is near to",
                                              "such a place, in the Hessian alone"};

struct branch {
    int kind;
    bool shown; // everywhere, too weakly to matter
};

// x' = u + help by the cheap control w, beside clocks that the place is told by.
static moray_num help(const moray_node *at, const struct branch *branch)
{
    const moray_num x = at->x[0], u = at->u[0], w = at->u[1];
    const double time = creal(at->t), early = creal(at->x[1]), late = creal(at->x[2]);
    const bool near = fabs(early - 3) < 0.12 && fabs(late - 3) < 0.12;
    const moray_num weak = 1e-13 * (branch->shown ? w * w + w + u * w : 0);
    switch (branch->kind) {
    case by_time:
        return weak + (time > 4 ? 3 * w : 0);
    case by_state:
        return weak + (creal(x) > 3 ? 3 * w * (x - 3) * (x - 3) : 0);
    case by_control:
        return weak + (creal(u) > 0.25 ? 4 * w * (u - 0.25) * (u - 0.25) : 0);
    case by_parameter:
        return weak + (creal(at->s[0]) > 0.7 ? 2 * w * (at->s[0] - 0.7) : 0);
    case by_time_curved:
        return weak + (time > 4 ? 2 * w - 0.3 * w * w : 0.1 * w);
    case by_place:
        return weak + (near ? 30 * w : 0);
    default:
        return weak + (near ? 20 * w - 2 * w * w : 0.1 * w);
    }
}

static void swim(const moray_node *at, moray_rates *out, const void *data)
{
    out->f[0] = at->u[0] + help(at, data);
    out->f[1] = 1;
    out->f[2] = 1;
    out->g[0] = at->u[0] * at->u[0] + 0.05 * at->u[1] * at->u[1];
}

static void effort(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static moray_ocp *problem(const struct branch *branch)
{
    moray_ocp *ocp = NULL;
    const moray_phase_spec phase = {
        .name = "swim",
        .nx = 3,
        .nu = 2,
        .nq = 1,
        .continuous = swim,
        .t0 = moray_fixed(0),
        .tf = moray_fixed(5),
        .x = MORAY_BOUNDS(moray_between(-10, 10), moray_between(-20, 20), moray_between(-20, 20)),
        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), moray_fixed(0)),
        .xf = MORAY_BOUNDS(moray_fixed(5), moray_free(), moray_free()),
        .u = MORAY_BOUNDS(moray_between(-5, 5), moray_between(-5, 5))};
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "branch",
                                                   .phases = 1,
                                                   .phase = &phase,
                                                   .endpoint = effort,
                                                   .ns = 1,
                                                   .s = MORAY_BOUNDS(moray_between(0.6, 1)),
                                                   .data = branch}),
             kind_names[branch->kind]);
    return ocp;
}

static moray_solution *solve(const moray_ocp *ocp)
{
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.intervals = 50;
    settings.tolerance = 1e-10;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED, "%s",
          moray_nlp_outcome_text(moray_solution_info(solution)->outcome));
    return solution;
}

static moray_nlp_size size_from(const moray_ocp *ocp, const moray_solution *start, int *fresh)
{
    const moray_guess guess = moray_guess_from_solution(start);
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    int meshes;
    settings.intervals = 50;
    settings.max_refinements = 0;
    CHECK_OK(moray_solve(ocp, &settings, &guess, &solution), "from a solution");
    const moray_nlp_size size = moray_solution_size(solution);
    *fresh = moray_solution_history(solution, &meshes)->dependences;
    moray_solution_free(solution);
    return size;
}

// What the guess shows is in the first programme.
static void check_guess(const struct branch *hidden, const moray_ocp *known, const moray_solution *start)
{
    int fresh, none;
    moray_ocp *unknown = problem(hidden);
    const moray_nlp_size got = size_from(unknown, start, &fresh), want = size_from(known, start, &none);
    CHECK(got.nnz_jac == want.nnz_jac && got.nnz_hess == want.nnz_hess && fresh == 0,
          "%s: in the guess: %d and %d entries for %d and %d", kind_names[hidden->kind], got.nnz_jac, got.nnz_hess,
          want.nnz_jac, want.nnz_hess);
    moray_ocp_free(unknown);
}

static void check_kind(int kind)
{
    const struct branch hidden = {kind, false}, shown = {kind, true};
    moray_ocp *one = problem(&hidden), *other = problem(&shown);
    moray_solution *found = solve(one), *reference = solve(other);
    int meshes, fresh = 0;
    const moray_mesh_record *mesh = moray_solution_history(found, &meshes);
    for (int k = 0; k < meshes; k++)
        fresh += mesh[k].dependences;
    CHECK_RELATIVE(moray_solution_objective(found), moray_solution_objective(reference), 1e-6, kind_names[kind]);
    CHECK(moray_solution_objective(found) < 4.9, "%s: the branch is used: %.6g for 5", kind_names[kind],
          moray_solution_objective(found));
    const moray_nlp_size size = moray_solution_size(found);
    const moray_nlp_size whole = moray_solution_size(reference);
    CHECK(size.nnz_jac <= whole.nnz_jac && size.nnz_hess <= whole.nnz_hess, "%s: and no entry is made up: %d, %d",
          kind_names[kind], size.nnz_jac, size.nnz_hess);
    printf("# %s: %.8g, %d meshes, %d dependences found at solutions\n", kind_names[kind],
           moray_solution_objective(found), meshes, fresh);
    check_guess(&hidden, one, found);
    moray_solution_free(found);
    moray_solution_free(reference);
    moray_ocp_free(one);
    moray_ocp_free(other);
}

// ---- Where functions are looked at first ----

static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
}

static void rest(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

static double looked_at(double place)
{
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .continuous = drift,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(place)),
                                    .xf = MORAY_BOUNDS(moray_fixed(place))};
    double in[3] = {0};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = rest}), "fixed ends");
    moray_phase_probe(ocp, &ocp->phase[0], 0, in);
    moray_ocp_free(ocp);
    return in[0];
}

// Of a state that is fixed at both ends, beside these, whose value may be a special one.
static void test_probe(void)
{
    for (int k = 0; k < 2; k++) {
        const double place = k ? 200 : 3, above = looked_at(place) - place, below = looked_at(-place) + place;
        CHECK(above >= 0.05 * place && fabs(below - above) < 1e-12 * place, "%g: beside it by %g and %g", place, above,
              below);
    }
}

// ---- A start that is rounding ----

static void cubic(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num stretch = at->x[1] - at->x[0];
    out->f[0] = at->u[0];
    out->f[1] = stretch * stretch * stretch;
    out->g[0] = at->u[0] * at->u[0];
}

static moray_ocp *starting_at(double second)
{
    moray_ocp *ocp = NULL;
    const moray_phase_spec phase = {.name = "spring",
                                    .nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = cubic,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0.5), moray_fixed(second))};
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "spring", .phases = 1, .phase = &phase, .endpoint = effort}),
             "a spring");
    return ocp;
}

static void test_tiny_start(void)
{
    moray_ocp *zero = starting_at(0), *rounding = starting_at(0.5 * sin(M_PI));
    const moray_map *map = rounding->phase[0].map;
    const int entries = zero->phase[0].map->hess.nnz;
    const double in[] = {0.5, 0.1, 0, 0}, weight[] = {0, 1, 0}, bend = 6 * (in[1] - in[0]);
    double values[16] = {0};
    CHECK(map->hess.nnz == entries && entries == 4, "sin pi for 0 hides no dependence: %d entries, %d", map->hess.nnz,
          entries);
    map->hessian(map->self, in, weight, values);
    for (int k = 0; k < map->hess.nnz && k < 16; k++) {
        const int r = map->hess.row[k], c = map->hess.col[k];
        const double expected = r > 1 ? 0 : r == c ? bend : -bend;
        CHECK(fabs(values[k] - expected) < 1e-8, "entry %d, %d: %.9g, expected %.9g", r, c, values[k], expected);
    }
    moray_ocp_free(zero);
    moray_ocp_free(rounding);
}

int main(void)
{
    test_probe();
    test_tiny_start();
    for (int kind = 0; kind < kinds; kind++)
        check_kind(kind);
    return tap_done();
}
