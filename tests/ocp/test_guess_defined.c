// SPDX-License-Identifier: MIT
//
// What a guess defines: integrals, controls at ends without a node and what moving data see are those of the guessed
// trajectory, within bounds; and what of a solution is taken over, on its mesh, on another, along time.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "ocp/solution.h"

enum { nx = 2, nu = 2, nq = 2, data = 3, samples = 4 };
static const double data_at[data] = {3.25, 1.5, 4.75}, data_values[data] = {0};

static void go(const moray_node *at, moray_rates *out, const void *unused)
{
    (void)unused;
    out->f[0] = at->x[1] + at->u[0] * at->s[0];
    out->f[1] = at->u[1] - at->x[0] * at->t;
    out->g[0] = at->x[0] * at->x[0] + at->s[1];
    out->g[1] = at->u[0] * at->u[1];
}

static void go_on(const moray_node *at, moray_rates *out, const void *unused)
{
    (void)unused;
    out->f[0] = at->x[1] + at->u[0];
    out->f[1] = at->u[1] - at->x[0] * at->t;
}

static void watch(const moray_node *at, moray_num *y, const void *unused)
{
    (void)unused;
    y[0] = at->x[0] + at->u[1];
}

static void verdict(const moray_ends *at, moray_end_values *out, const void *unused)
{
    (void)unused;
    out->objective = at->phase[0].xf[0];
}

static moray_status transcribe(struct transcription **t, moray_ocp **ocp, const moray_phase_spec *phase, int phases,
                               int intervals)
{
    struct mesh mesh[2];
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = phases,
                                                  .phase = phase,
                                                  .ns = 2,
                                                  .s = MORAY_BOUNDS(moray_between(2, 4), moray_between(-1, 0)),
                                                  .endpoint = verdict}),
             "problem");
    for (int p = 0; p < phases; p++) {
        CHECK_OK(moray_mesh_uniform(&mesh[p], intervals + p, (struct method){MORAY_GAUSS, 2}), "mesh");
        mesh[p].t0 = 1, mesh[p].tf = 5;
    }
    const moray_status status = moray_transcription_new(t, *ocp, mesh);
    for (int p = 0; p < phases; p++)
        moray_mesh_free(&mesh[p]);
    return status;
}

// What stood there before has no part in a guess, least of all where it is no number.
static double *nonsense(const struct transcription *t)
{
    double *x = calloc((size_t)t->nlp.n, sizeof *x);
    for (int j = 0; j < t->nlp.n; j++)
        x[j] = NAN;
    return x;
}

static const double when[samples] = {1, 2, 4, 5}, where[] = {1, -1, 3, -2, -8, 4, 0.5, 2},
                    pushed[] = {0.5, -1, 1.5, 2, -0.25, 1, 0.75, -3};
static const moray_samples table = {samples, when, where, pushed};

static void check_rows(const double *g, int first, int n, const char *what)
{
    for (int i = 0; i < n; i++)
        CHECK(fabs(g[first + i]) < 1e-12, "%s %d holds to %.1e", what, i, g[first + i]);
}

static moray_phase_spec seen(void)
{
    static const moray_bounds x[] = {{-5, 2.5}, {-MORAY_INFINITY, MORAY_INFINITY}};
    return (moray_phase_spec){
        .nx = nx,
        .nu = nu,
        .nq = nq,
        .continuous = go,
        .t0 = moray_between(0, 1.5),
        .tf = moray_between(4.75, 9),
        .x = {x, nx},
        .end_controls = true,
        .observed = {.n = data, .ny = 1, .time = data_at, .value = data_values, .observe = watch}};
}

// A state leaves its bounds among the samples: all is of what is left of them.
static void test_defined(bool sampled)
{
    const moray_phase_spec phase = seen();
    struct transcription *t;
    moray_ocp *ocp;
    CHECK_OK(transcribe(&t, &ocp, &phase, 1, 3), "transcribed");
    const struct phase_layout *layout = &t->layout.phase[0];
    double *x = nonsense(t), *g = calloc((size_t)t->nlp.m, sizeof *g);
    const moray_guess guess = {.phase = sampled ? &table : NULL, .s = (double[]){3, -0.5}};
    CHECK_OK(moray_fill_guess(t, &guess, x), "from samples");
    CHECK(t->nlp.constraints(t->nlp.self, x, true, g), "values");
    check_rows(g, layout->integral_row, nq, "integral");
    for (int end = 0; end < 2; end++)
        check_rows(g, layout->u_row[end], nu, "control at an end");
    for (int k = 0; k < data; k++)
        check_rows(g, layout->sight[k].row, nx + nu, "what is seen");
    double least = INFINITY, most = -INFINITY;
    for (int n = 0; n < layout->nodes; n++)
        least = fmin(least, x[layout->node[n].x]), most = fmax(most, x[layout->node[n].x]);
    CHECK(!sampled || (least == -5 && most == 2.5), "states from %g to %g", least, most);
    CHECK(x[t->layout.s] == 3 && x[t->layout.s + 1] == -0.5, "parameters");
    free(x), free(g);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

// They have bounds, too.
static void test_within(void)
{
    moray_phase_spec phase = seen();
    const moray_bounds u0[] = {{0.6, 0.7}, moray_free()}, uf[] = {moray_free(), {-0.5, -0.25}},
                       q[] = {{0, 1}, {-2, -1.75}};
    phase.u0 = (moray_bounds_list){u0, nu}, phase.uf = (moray_bounds_list){uf, nu},
    phase.q = (moray_bounds_list){q, nq};
    struct transcription *t;
    moray_ocp *ocp;
    CHECK_OK(transcribe(&t, &ocp, &phase, 1, 3), "transcribed");
    const struct phase_layout *layout = &t->layout.phase[0];
    double *x = nonsense(t);
    CHECK_OK(moray_fill_guess(t, &(moray_guess){.phase = &table, .s = (double[]){3, -0.5}}, x), "from samples");
    CHECK(x[layout->u_end[0]] == 0.6 && x[layout->u_end[1] + 1] == -0.5, "controls at ends: %g, %g",
          x[layout->u_end[0]], x[layout->u_end[1] + 1]);
    CHECK(x[layout->q] == 1 && x[layout->q + 1] == -1.75, "integrals: %g, %g", x[layout->q], x[layout->q + 1]);
    free(x);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

// ---- Nothing is written beside a node without controls ----

static void test_last_node(bool sampled)
{
    const moray_phase_spec phase = {.nx = nx,
                                    .nu = nu,
                                    .continuous = go_on,
                                    .t0 = moray_between(0.5, 1.5),
                                    .tf = moray_between(4, 6),
                                    .u = MORAY_BOUNDS(moray_between(-10, -8), moray_between(20, 22))};
    const moray_phase_spec still = {
        .nx = nx, .nu = nu, .continuous = go_on, .tf = moray_fixed(2), .end_controls = true};
    struct transcription *t;
    moray_ocp *ocp;
    CHECK_OK(transcribe(&t, &ocp, &phase, 1, 2), "transcribed");
    double *x = nonsense(t);
    const moray_guess guess = {.phase = sampled ? &table : NULL};
    CHECK_OK(moray_fill_guess(t, &guess, x), "free times");
    CHECK(x[t->layout.phase[0].t0] == 1 && x[t->layout.phase[0].tf] == 5, "from %g to %g", x[t->layout.phase[0].t0],
          x[t->layout.phase[0].tf]);
    CHECK(x[t->layout.s] == 3 && x[t->layout.s + 1] == -0.5, "parameters in the middle of their bounds");
    free(x);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
    CHECK_OK(transcribe(&t, &ocp, &still, 1, 2), "transcribed");
    x = nonsense(t);
    CHECK_OK(moray_fill_guess(t, &guess, x), "fixed times");
    CHECK(x[t->layout.s] == 3 && x[t->layout.s + 1] == -0.5, "%g and %g", x[t->layout.s], x[t->layout.s + 1]);
    free(x);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

// One sample stands alone, whatever lies behind it.
static void test_one_sample(void)
{
    const moray_phase_spec phase = {.nx = nx, .nu = nu, .continuous = go_on, .tf = moray_fixed(2)};
    const moray_samples one = {1, (double[]){4, -5}, (double[]){2, 3, INFINITY, NAN}, (double[]){6, 7, NAN, INFINITY}};
    struct transcription *t;
    moray_ocp *ocp;
    CHECK_OK(transcribe(&t, &ocp, &phase, 1, 2), "transcribed");
    double *x = nonsense(t);
    CHECK_OK(moray_fill_guess(t, &(moray_guess){.phase = &one}, x), "from one sample");
    for (int j = 0; j < t->layout.s; j++)
        CHECK(x[j] == 2 || x[j] == 3 || x[j] == 6 || x[j] == 7, "column %d: %g", j, x[j]);
    free(x);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

// A node at a jump has what is before it.
static void test_at_a_jump(void)
{
    const moray_phase_spec phase = {.nx = nx, .nu = nu, .continuous = go_on, .tf = moray_fixed(2)};
    const moray_samples jump = {4, (double[]){0, 1, 1, 2}, (double[]){0, 1, 2, 3, 50, 60, 70, 80}, pushed};
    struct transcription *t;
    moray_ocp *ocp;
    CHECK_OK(transcribe(&t, &ocp, &phase, 1, 2), "transcribed");
    const struct phase_layout *layout = &t->layout.phase[0];
    double *x = nonsense(t);
    CHECK_OK(moray_fill_guess(t, &(moray_guess){.phase = &jump}, x), "a jump in the middle");
    const double *middle = x + layout->node[layout->interval[1].first].x;
    CHECK(middle[0] == 2 && middle[1] == 3, "there it is %g and %g", middle[0], middle[1]);
    free(x);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

// ---- From a solution ----

static moray_solution *solution_of(const moray_ocp *ocp, int intervals)
{
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    settings.scheme = "gauss2";
    settings.intervals = intervals;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    for (int j = 0; j < solution->transcription->nlp.n; j++)
        solution->iterate.x[j] = 1 + 1 / (3. + j * j % 23);
    for (int p = 0; p < moray_ocp_phases(ocp); p++) {
        const struct phase_layout *layout = &solution->transcription->layout.phase[p];
        if (layout->t0 != absent)
            solution->iterate.x[layout->t0] = 2 + p, solution->iterate.x[layout->tf] = 4.5 + p;
    }
    CHECK(moray_transcription_values(solution->transcription, solution->iterate.x), "values");
    return solution;
}

static void check_nodes(const struct transcription *t, int p, const double *x, const moray_solution *from, double shift,
                        double stretch)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    for (int n = 0; n < layout->nodes; n++) {
        const double tau = fmin(fmax(shift + stretch * layout->node[n].tau, 0), 1), *at = x + layout->node[n].x;
        double state[nx], control[nu];
        moray_solution_at_tau(from, p, NULL, tau, state, control);
        for (int r = 0; r < nx; r++)
            CHECK(fabs(at[r] - state[r]) < 1e-12, "state %d of phase %d at %g", r, p, tau);
        for (int r = 0; r < nu && layout->node[n].collocated; r++)
            CHECK(fabs(at[nx + r] - control[r]) < 1e-12, "control %d of phase %d at %g", r, p, tau);
    }
}

static void test_from_solution(void)
{
    moray_phase_spec phase[2] = {
        {.nx = nx, .nu = nu, .continuous = go_on, .t0 = moray_between(0, 4), .tf = moray_between(3, 9)},
        {.nx = nx, .nu = nu, .nq = nq, .continuous = go, .tf = moray_fixed(2)}};
    phase[1].t0 = phase[0].t0, phase[1].tf = phase[0].tf, phase[1].intervals = 4;
    struct transcription *finer;
    moray_ocp *ocp, *other;
    moray_solution *same;
    CHECK_OK(transcribe(&finer, &other, phase, 2, 5), "transcribed");
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2, .phase = phase, .ns = 2, .endpoint = verdict}),
             "problem");
    moray_solution *from = solution_of(ocp, 3);
    same = solution_of(ocp, 3);
    double *x = nonsense(same->transcription), *of_finer = nonsense(finer);
    CHECK_OK(moray_fill_guess(same->transcription, &(moray_guess){.from = from}, x), "on the same mesh");
    for (int p = 0; p < 2; p++) {
        const struct phase_layout *layout = &from->transcription->layout.phase[p];
        for (int j = layout->node[0].x; j < layout->q; j++)
            CHECK(x[j] == from->iterate.x[j], "column %d is taken over", j);
        CHECK(x[layout->t0] == 2 + p && x[layout->tf] == 4.5 + p, "times of phase %d", p);
    }
    CHECK(memcmp(x + from->transcription->layout.s, moray_solution_parameters(from), 2 * sizeof *x) == 0, "parameters");
    CHECK_OK(moray_fill_guess(same->transcription, &(moray_guess){.from = from, .along_time = true}, x), "along time");
    for (int p = 0; p < 2; p++)
        check_nodes(same->transcription, p, x, from, 0, 1);
    CHECK_OK(moray_fill_guess(finer, &(moray_guess){.from = from}, of_finer), "on a finer mesh");
    for (int p = 0; p < 2; p++)
        check_nodes(finer, p, of_finer, from, 0, 1);
    free(x), free(of_finer);
    moray_transcription_free(finer);
    moray_solution_free(from);
    moray_solution_free(same);
    moray_ocp_free(ocp);
    moray_ocp_free(other);
}

// The phase has moved on: what lies behind its end then is as at that end.
static void test_moved(void)
{
    const moray_phase_spec phase = {
        .nx = nx, .nu = nu, .nq = nq, .continuous = go, .t0 = moray_fixed(2), .tf = moray_fixed(4)};
    struct transcription *t;
    moray_ocp *ocp;
    CHECK_OK(transcribe(&t, &ocp, &phase, 1, 3), "transcribed");
    moray_solution *from = solution_of(ocp, 3);
    const moray_guess guess = {.from = from, .along_time = true}, still = {.from = from};
    double *x = nonsense(t);
    CHECK_OK(moray_ocp_restart(ocp, 2.5, 3, (double[]){0, 0}), "begun anew");
    CHECK_OK(moray_fill_guess(t, &guess, x), "along time");
    moray_guess end = guess;
    const struct alignment a = moray_align(&guess, 0, 2.5, 5.5), none = moray_align(&still, 0, 2.5, 5.5);
    CHECK(fabs(a.shift - 0.25) < 1e-15 && fabs(a.stretch - 1.5) < 1e-15, "%g on, of %g the length", a.shift, a.stretch);
    CHECK(none.shift == 0 && none.stretch == 1, "not where parts of phases are alike");
    for (int n = 1; n < t->layout.phase[0].nodes; n++) { // the first has bounds
        const struct node *node = &t->layout.phase[0].node[n];
        double state[nx];
        moray_solution_at_tau(from, 0, NULL, fmin(0.25 + 1.5 * node->tau, 1), state, NULL);
        for (int r = 0; r < nx; r++)
            CHECK(fabs(x[node->x + r] - state[r]) < 1e-12, "state %d at %g", r, node->tau);
    }
    for (int k = 0; k < 2; k++) {
        from->transcription->phase[0].tf = k ? 2 : 1;
        const struct alignment of_none = moray_align(&end, 0, 2.5, 5.5);
        CHECK(of_none.shift == 0 && of_none.stretch == 1, "nor of what has no length");
    }
    free(x);
    moray_transcription_free(t);
    moray_solution_free(from);
    moray_ocp_free(ocp);
}

// ---- Of other sizes ----

static void bare(const moray_node *at, moray_rates *out, const void *states)
{
    for (int i = 0; i < *(const int *)states; i++)
        out->f[i] = at->t;
}

static void test_sizes(void)
{
    static const struct {
        int nx, nu, ns;
        const char *text;
    } cases[] = {{2, 1, 2, NULL},
                 {1, 1, 2, "guess of phase way: the solution has 1 states and 1 controls, the problem 2 and 1"},
                 {2, 0, 2, "guess of phase way: the solution has 2 states and 0 controls, the problem 2 and 1"},
                 {2, 1, 1, "guess: the solution has 1 phases and 1 parameters, the problem 1 and 2"}};
    moray_ocp *ocp[4];
    moray_solution *solution[4];
    for (int k = 0; k < 4; k++) {
        const moray_phase_spec phase = {
            .name = "way", .nx = cases[k].nx, .nu = cases[k].nu, .continuous = bare, .tf = moray_fixed(1)};
        CHECK_OK(moray_ocp_new(
                     &ocp[k],
                     &(moray_ocp_spec){
                         .phases = 1, .phase = &phase, .ns = cases[k].ns, .endpoint = verdict, .data = &cases[k].nx}),
                 "problem");
        solution[k] = solution_of(ocp[k], 2);
    }
    for (int k = 0; k < 4; k++) {
        double *x = nonsense(solution[0]->transcription);
        const moray_status status =
            moray_fill_guess(solution[0]->transcription, &(moray_guess){.from = solution[k]}, x);
        CHECK(cases[k].text ? status.code == MORAY_INPUT && strcmp(status.text, cases[k].text) == 0
                            : !moray_failed(status),
              "%s", status.text);
        free(x);
    }
    for (int k = 0; k < 4; k++) {
        moray_solution_free(solution[k]);
        moray_ocp_free(ocp[k]);
    }
}

int main(void)
{
    for (int sampled = 0; sampled < 2; sampled++) {
        test_defined(sampled);
        test_last_node(sampled);
    }
    test_within();
    test_one_sample();
    test_at_a_jump();
    test_from_solution();
    test_moved();
    test_sizes();
    return tap_done();
}
