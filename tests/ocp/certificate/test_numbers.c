// SPDX-License-Identifier: MIT
//
// The numbers of a certificate are the worst over phases and intervals of what its parts tell, and so are its words.
#include "everything.h"

#include <string.h>

#include "ocp/certificate/certify.h"
#include "ocp/certificate/curvature.h"
#include "ocp/certificate/differences.h"
#include "ocp/certificate/bends.h"
#include "ocp/certificate/optimality.h"
#include "ocp/certificate/unseen.h"
#include "ocp/names.h"
#include "rk4.h"

static const int rk4_steps = 20;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

enum told { of_mesh, of_limits, of_shooting, of_nodes, of_jumps, FINDINGS };

static void raise(struct finding *most, double value, int p, double time)
{
    if (value > most->value)
        *most = (struct finding){value, p, time};
}

static void find_phase(const struct witness *w, int p, struct finding *most, double *composed)
{
    const struct transcription *t = w->solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[p];
    const double t0 = t->phase[p].t0, T = t->phase[p].tf - t0;
    struct finding effect = {.value = -1}, jump = {.value = -1};
    struct examiner e;
    struct unseen u;
    double effects = 0, jumps = 0;
    CHECK_OK(moray_examiner_new(&e, w, p), "examiner");
    CHECK_OK(moray_unseen_new(&u, &e), "effects");
    for (int k = 0; k < layout->mesh.intervals; k++) {
        const double from = layout->mesh.edge[k], to = layout->mesh.edge[k + 1], middle = t0 + T * (from + to) / 2;
        double outside = 0, where, jumped;
        raise(&most[of_mesh], moray_examiner_interval(&e, &layout->interval[k], &outside), p, middle);
        raise(&most[of_limits], outside, p, middle);
        const double here =
            moray_unseen_interval(&u, &layout->interval[k], moray_witness_objective(w), &jumped, &where);
        effects += here, jumps += jumped;
        raise(&effect, here, p, t0 + T * (from + where * (to - from)));
        raise(&jump, jumped, p, t0 + T * from);
    }
    raise(&most[of_nodes], effects, p, effect.time);
    raise(&most[of_jumps], jumps, p, jump.time);
    CHECK_OK(moray_resimulate(&e, &rk4, &most[of_shooting], composed), "simulated again");
    moray_unseen_free(&u);
    moray_examiner_free(&e);
}

static moray_certificate check_numbers(const moray_solution *solution, struct finding most[FINDINGS])
{
    const struct transcription *t = solution->transcription;
    struct witness w;
    struct optimality o;
    moray_certificate c;
    double derivatives, untold, directions, curvature, composed = 0;
    char where[400] = "";
    memset(most, 0, FINDINGS * sizeof *most);
    CHECK_OK(moray_certify(solution, &rk4, &c), "certificate");
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
    CHECK_OK(moray_witness_new(&w, solution), "witness");
    CHECK_OK(moray_compare_columns(&w, &derivatives, &untold, where, sizeof where), "derivatives");
    CHECK_OK(moray_measure_optimality(&w, &o), "optimality");
    CHECK_OK(moray_measure_curvature(&w, &curvature, NULL), "curvature");
    CHECK_OK(moray_difference_solution(&w, &directions), "directions");
    CHECK_OK(moray_difference_bends(&w, &directions, where, sizeof where), "second derivatives");
    struct finding drift = {.value = -1};
    for (int p = 0; p < 2; p++) {
        bool autonomous;
        find_phase(&w, p, most, &composed);
        if (t->ocp->phase[p].observed.n == 0 && t->ocp->phase[p].n_held == 0)
            CHECK_OK(moray_hamiltonian_drift(&w, p, &drift, &autonomous), "Hamiltonian");
    }
    moray_witness_free(&w);
    CHECK(c.derivatives == derivatives && c.untold == untold && c.directions == directions,
          "derivatives: %g, %g and %g", c.derivatives, c.untold, c.directions);
    const double worst = o.told > o.improvement ? o.told : o.improvement;
    CHECK(c.kkt == (worst > o.feasibility ? worst : o.feasibility) && c.gap == o.gap && c.curvature == curvature,
          "optimality: %g, %g and %g", c.kkt, c.gap, c.curvature);
    CHECK(c.hamiltonian == drift.value && c.composed == composed, "Hamiltonian %g, and in one go %g", c.hamiltonian,
          c.composed);
    CHECK(c.mesh_error == most[of_mesh].value && c.between_nodes == most[of_limits].value &&
              c.resimulation == most[of_shooting].value,
          "between nodes: %g, %g and %g", c.mesh_error, c.between_nodes, c.resimulation);
    CHECK(c.unseen == fmax(most[of_nodes].value, most[of_jumps].value), "what nodes do not tell: %g", c.unseen);
    return c;
}

static void check_words(const moray_solution *solution, const char *what, double value, double limit, const char *where)
{
    char text[500];
    moray_certificate c;
    CHECK_OK(moray_certify(solution, &rk4, &c), "certificate");
    snprintf(text, sizeof text, "%s: %.2g, where %.2g is allowed%s%s", what, value, limit, *where ? "; " : "", where);
    CHECK(!c.pass && !strcmp(c.why, text), "%s; expected %s", c.why, text);
}

// First what is told of the objective; where that is right the constraint that is violated most.
static void check_violation(moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[1];
    struct witness w;
    struct optimality o;
    char name[200];
    for (int told = 0; told < 2; told++) {
        CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
        CHECK_OK(moray_witness_new(&w, solution), "witness");
        CHECK_OK(moray_measure_optimality(&w, &o), "optimality");
        moray_witness_free(&w);
        if (!told)
            check_words(solution,
                        "the objective that is told differs from that of the trajectory, relative to its size", o.told,
                        MORAY_LIMIT_KKT, "");
        for (int k = 0; k < DATA && !told; k++) { // as seen from the trajectory
            double *seen = solution->iterate.x + layout->sight[k].x;
            moray_solution_at(solution, 1, t->ocp->phase[1].observed.time[k], seen, seen + NX1);
        }
        CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
        solution->iterate.objective = t->end_out[0];
    }
    CHECK(o.row >= 0 && o.row < t->nlp.m, "a constraint, %d", o.row);
    moray_layout_row_name(&t->layout, t->ocp, solution->iterate.x, o.row, name, sizeof name);
    check_words(solution, "constraints are violated, relative to their size", o.feasibility, MORAY_LIMIT_KKT, name);
}

static void test_violations(void)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, "radau3");
    unsigned long long seed = 77;
    for (int trial = 0; trial < 2; trial++) {
        scatter(solution, &seed);
        check_violation(solution);
    }
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void test_anywhere(const char *scheme)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, scheme);
    unsigned long long seed = 19;
    for (int trial = 0; trial < 2; trial++) {
        struct finding most[FINDINGS];
        scatter(solution, &seed);
        const moray_certificate c = check_numbers(solution, most);
        CHECK(!c.pass && c.why[0], "which is no optimum: %s", c.why);
    }
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Its words, of optima on meshes that are too coarse ----

// What each phase has too much of.
struct wave {
    double drift, effect, step;
};

static void wavy(const moray_node *at, moray_rates *out, const struct wave *wave)
{
    const double t = creal(at->t), far = (t - 0.2) / 3e-3, further = (t - 2.2) / 3e-3;
    const moray_num u = at->u[0], v = at->u[1];
    out->f[0] = u * (1 + wave->effect * (exp(-far * far) + exp(-further * further))) + wave->drift * sin(5 * t);
    out->f[1] = 1;
    out->g[0] = u * u + v * v;
    if (creal(v) > 0 && creal(at->x[1]) > 0.77)
        out->g[0] += wave->step * v * v * v;
}

static void before(const moray_node *at, moray_rates *out, const void *data)
{
    wavy(at, out, data);
}

static void after(const moray_node *at, moray_rates *out, const void *data)
{
    wavy(at, out, (const struct wave *)data + 1);
}

static void joined(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0];
    out->e[0] = at->phase[1].x0[0] - at->phase[0].xf[0];
}

// With multipliers that are no longer those of the optimum.
static void check_gain(moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    struct witness w;
    struct optimality o;
    char name[200], where[300];
    for (int i = 0; i < t->nlp.m; i++)
        solution->iterate.lambda[i] *= 1 + 1e-2 * (i % 5 - 1);
    CHECK_OK(moray_witness_new(&w, solution), "witness");
    CHECK_OK(moray_measure_optimality(&w, &o), "optimality");
    moray_witness_free(&w);
    moray_layout_column_name(&t->layout, t->ocp, solution->iterate.x, o.column, name, sizeof name);
    snprintf(where, sizeof where, "most by %s", name);
    check_words(solution, "the objective could still improve, relative to its size", o.improvement, MORAY_LIMIT_KKT,
                where);
}

// A control beyond its bound at the end of an interval, where it costs little.
static void check_bound(moray_solution *solution, int phase)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[phase];
    const int column = layout->node[layout->interval[1].first + 3].x + 3;
    struct witness w;
    struct optimality o;
    char name[200];
    solution->iterate.x[column] = 1.5;
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
    CHECK_OK(moray_witness_new(&w, solution), "witness");
    CHECK_OK(moray_measure_optimality(&w, &o), "optimality");
    moray_witness_free(&w);
    CHECK(o.row == t->nlp.m + column, "which is violated most: %d, expected %d", o.row, t->nlp.m + column);
    moray_layout_column_name(&t->layout, t->ocp, solution->iterate.x, column, name, sizeof name);
    check_words(solution, "constraints are violated, relative to their size", o.feasibility, MORAY_LIMIT_KKT, name);
}

static void test_words(const struct wave wave[2], double tolerance, enum told told, int phase)
{
    static const char *const what[] = {
        "error of the dynamics between the nodes", "violation of limits between the nodes",
        "difference to a re-simulation of an interval", "effects between the nodes that none of them tells",
        "functions jump with a state, which no derivative tells (give each side a phase)"};
    const double limit[] = {tolerance, 100 * tolerance, 100 * tolerance, MORAY_LIMIT_UNSEEN, MORAY_LIMIT_UNSEEN};
    const moray_phase_spec phases[] = {{.name = "before",
                                        .nx = 2,
                                        .nu = 2,
                                        .nq = 1,
                                        .continuous = before,
                                        .tf = moray_fixed(1),
                                        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                        .u = MORAY_BOUNDS(moray_between(-5, 5), moray_between(-1, 1))},
                                       {.name = "after",
                                        .nx = 2,
                                        .nu = 2,
                                        .nq = 1,
                                        .continuous = after,
                                        .t0 = moray_fixed(1),
                                        .tf = moray_fixed(2.5),
                                        .x0 = MORAY_BOUNDS(moray_free(), moray_fixed(0)),
                                        .xf = MORAY_BOUNDS(moray_fixed(0.5), moray_free()),
                                        .u = MORAY_BOUNDS(moray_between(-5, 5), moray_between(-1, 1))}};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    struct finding most[FINDINGS];
    char text[400];
    settings.scheme = "radau3";
    settings.intervals = 4;
    settings.mesh_tolerance = tolerance;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2,
                                                   .phase = phases,
                                                   .ne = 1,
                                                   .e = MORAY_BOUNDS(moray_fixed(0)),
                                                   .endpoint = joined,
                                                   .data = wave}),
             what[told]);
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    const moray_certificate c = check_numbers(solution, most);
    snprintf(text, sizeof text, "%s: %.2g, where %.2g is allowed; phase %s near t = %.6g", what[told], most[told].value,
             limit[told], phases[most[told].p].name, most[told].time);
    CHECK(!c.pass && !strcmp(c.why, text), "%s; expected %s", c.why, text);
    CHECK(most[told].p == phase, "of phase %s", phases[phase].name);
    check_gain(solution);
    check_bound(solution, phase);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_violations();
    test_anywhere("radau3");
    test_anywhere("gauss2");
    for (int p = 0; p < 2; p++) {
        struct wave wave[2] = {{.drift = 0}};
        wave[p].drift = 1;
        test_words(wave, 1e-6, of_mesh, p);
        wave[p] = (struct wave){.effect = 50};
        test_words(wave, 10, of_nodes, p);
        wave[p] = (struct wave){.step = 0.2};
        test_words(wave, 10, of_jumps, p);
    }
    return tap_done();
}
