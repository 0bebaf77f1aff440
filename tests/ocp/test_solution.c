// SPDX-License-Identifier: MIT
//
// What a solution tells, of two unlike phases with numbers of all kinds: found where the layout has them, and by
// polynomials taken through the nodes here.
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"
#include "ocp/solution.h"

enum { phases = 2, most_x = 2, most_u = 2, intervals = 3 };
static const int nx[phases] = {2, 1}, nu[phases] = {2, 1}, nq[phases] = {1, 2};
static const double edges[phases][intervals + 1] = {{0, 0.2, 0.7, 1}, {0, 0.5, 0.6, 1}};
static const moray_bounds u_bounds[phases][most_u] = {{{-0.5, 0.8}, {-2, 0.3}}, {{-0.25, 0.1}}};

static void rise(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1] * at->u[0] + at->s[0];
    out->f[1] = at->u[1] * at->t - at->x[0];
    out->g[0] = at->u[0];
}

static void fall(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->s[1] * at->x[0] + at->u[0] * at->u[0] - at->t;
    out->g[0] = at->x[0];
    out->g[1] = at->u[0];
}

static void rate(int p, const double *x, const double *u, const double *s, double t, double *f)
{
    if (p == 0) {
        f[0] = x[1] * u[0] + s[0];
        f[1] = u[1] * t - x[0];
    } else {
        f[0] = s[1] * x[0] + u[0] * u[0] - t;
    }
}

static void sum_up(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + 2 * at->phase[1].q[1];
    for (int k = 0; k < 3; k++)
        out->e[k] = at->phase[1].xf[0] * at->s[k % 2];
}

static moray_solution *begin(moray_ocp **ocp, const char *scheme)
{
    const moray_bounds any[3] = {moray_free(), moray_free(), moray_free()};
    moray_phase_spec phase[phases];
    for (int p = 0; p < phases; p++)
        phase[p] = (moray_phase_spec){.nx = nx[p],
                                      .nu = nu[p],
                                      .nq = nq[p],
                                      .continuous = p ? fall : rise,
                                      .t0 = p ? moray_fixed(2.25) : moray_between(-9, 9),
                                      .tf = moray_between(-9, 9),
                                      .intervals = intervals,
                                      .mesh = edges[p],
                                      .u = {u_bounds[p], nu[p]}};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.scheme = scheme;
    settings.max_iterations = 0;
    CHECK_OK(moray_ocp_new(ocp,
                           &(moray_ocp_spec){
                               .phases = phases, .phase = phase, .ns = 2, .ne = 3, .e = {any, 3}, .endpoint = sum_up}),
             "a problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    return solution;
}

// Numbers of all kinds, beyond the bounds of the controls too, from 1.5 to 3.5 and from 2.25 to 2.75.
static void fill(moray_solution *solution)
{
    unsigned long long seed = 5;
    struct transcription *t = solution->transcription;
    for (int j = 0; j < t->nlp.n; j++)
        solution->iterate.x[j] = tap_random(&seed, -1, 1);
    for (int i = 0; i < t->nlp.m; i++)
        solution->iterate.lambda[i] = i + 1;
    solution->iterate.x[t->layout.phase[0].t0] = 1.5;
    solution->iterate.x[t->layout.phase[0].tf] = 3.5;
    solution->iterate.x[t->layout.phase[1].tf] = 2.75;
    CHECK(moray_transcription_values(t, solution->iterate.x), "the caches are of this point");
}

// ---- Numbers ----

static void test_numbers(const moray_solution *solution)
{
    static const double begins[phases] = {1.5, 2.25}, ends[phases] = {3.5, 2.75};
    const struct transcription *t = solution->transcription;
    const double *x = solution->iterate.x;
    const moray_nlp_size size = moray_solution_size(solution);
    CHECK(size.variables == t->nlp.n && size.constraints == t->nlp.m && size.nnz_jac == t->nlp.nnz_jac &&
              size.nnz_hess == t->nlp.nnz_hess,
          "sizes");
    CHECK(moray_solution_info(solution) == &solution->info &&
              moray_solution_objective(solution) == solution->iterate.objective,
          "what the solver told");
    CHECK(moray_solution_parameters(solution) == x + t->layout.s, "parameters");
    const double *events = moray_solution_event_multipliers(solution);
    CHECK(events[0] == t->nlp.m - 2 && events[2] == t->nlp.m, "events stand last");
    for (int p = 0; p < phases; p++) {
        double t0, tf, edge[intervals + 1];
        moray_solution_times(solution, p, &t0, &tf);
        CHECK(t0 == begins[p] && tf == ends[p], "phase %d from %g to %g", p, t0, tf);
        CHECK(moray_solution_integrals(solution, p) == x + t->layout.phase[p].q, "integrals");
        CHECK(moray_solution_intervals(solution, p, NULL) == intervals &&
                  moray_solution_intervals(solution, p, edge) == intervals,
              "intervals");
        for (int k = 0; k <= intervals; k++)
            CHECK_NEAR(edge[k], t0 + (tf - t0) * edges[p][k], 1e-15, "edge");
    }
    int meshes = 0;
    const moray_mesh_record *history = moray_solution_history(solution, &meshes);
    CHECK(meshes == 1 && history[0].variables == size.variables, "one mesh");
}

// ---- Polynomials ----

// Values at the collocated points of an interval: of every rate, then of every control.
struct stages {
    int n;
    double at[4], value[4][most_x + most_u];
};

static struct stages stages_of(const moray_solution *solution, int p, int k)
{
    const struct transcription *t = solution->transcription;
    const struct interval *interval = &t->layout.phase[p].interval[k];
    const double T = p ? 0.5 : 2, t0 = p ? 2.25 : 1.5;
    struct stages found = {0};
    for (int j = interval->scheme->first; j <= interval->scheme->last; j++) {
        const struct node *node = &t->layout.phase[p].node[interval->first + j];
        const double *x = solution->iterate.x + node->x;
        rate(p, x, x + nx[p], solution->iterate.x + t->layout.s, t0 + T * node->tau, found.value[found.n]);
        for (int r = 0; r < nu[p]; r++)
            found.value[found.n][nx[p] + r] = x[nx[p] + r];
        found.at[found.n++] = node->tau;
    }
    return found;
}

static double through(const struct stages *stages, int i, double tau)
{
    double sum = 0;
    for (int j = 0; j < stages->n; j++) {
        double product = stages->value[j][i];
        for (int l = 0; l < stages->n; l++)
            product *= l == j ? 1 : (tau - stages->at[l]) / (stages->at[j] - stages->at[l]);
        sum += product;
    }
    return sum;
}

// State and control on the polynomials of interval k, which Simpson's rule integrates exactly.
static void expect(const moray_solution *solution, int p, int k, double tau, double *x, double *u)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    const struct stages stages = stages_of(solution, p, k);
    const double left = edges[p][k], T = p ? 0.5 : 2;
    for (int r = 0; r < nx[p]; r++)
        x[r] = solution->iterate.x[layout->node[layout->interval[k].first].x + r] +
               T * (tau - left) / 6 *
                   (through(&stages, r, left) + 4 * through(&stages, r, (left + tau) / 2) + through(&stages, r, tau));
    for (int r = 0; r < nu[p]; r++) {
        const double free = through(&stages, nx[p] + r, tau);
        u[r] = free < u_bounds[p][r].lower   ? u_bounds[p][r].lower
               : free > u_bounds[p][r].upper ? u_bounds[p][r].upper
                                             : free;
    }
}

static double distance(int p, const double *x, const double *u, const double *want_x, const double *want_u)
{
    double worst = 0;
    for (int r = 0; r < nx[p] && x; r++)
        worst = tap_worse(worst, fabs(x[r] - want_x[r]));
    for (int r = 0; r < nu[p] && u; r++)
        worst = tap_worse(worst, fabs(u[r] - want_u[r]));
    return worst;
}

static void test_polynomials(const moray_solution *solution, int p, const char *scheme)
{
    const double T = p ? 0.5 : 2, t0 = p ? 2.25 : 1.5;
    double worst = 0, x[most_x], u[most_u], want_x[most_x], want_u[most_u];
    int limited = 0, inside = 0;
    for (int i = -2; i <= 42; i++) {
        const double tau = i / 40.0, kept = i < 0 ? 0 : i > 40 ? 1 : tau;
        int k = 0; // before an edge
        while (k + 1 < intervals && kept > edges[p][k + 1] + 1e-9)
            k++;
        expect(solution, p, k, kept, want_x, want_u);
        moray_solution_at(solution, p, t0 + T * tau, x, u);
        worst = tap_worse(worst, distance(p, x, u, want_x, want_u));
        moray_solution_at(solution, p, t0 + T * tau, x, NULL);
        moray_solution_at(solution, p, t0 + T * tau, NULL, u);
        worst = tap_worse(worst, distance(p, x, u, want_x, want_u));
        for (int r = 0; r < nu[p]; r++)
            *(u[r] == u_bounds[p][r].lower || u[r] == u_bounds[p][r].upper ? &limited : &inside) += 1;
    }
    CHECK(worst < 1e-12, "%s, phase %d: states and controls within %.1e", scheme, p, worst);
    CHECK(limited > 5 && inside > 5, "at bounds %d times, %d times between", limited, inside);
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    expect(solution, p, 2, edges[p][2], want_x, want_u);
    moray_solution_at_tau(solution, p, &layout->interval[2], edges[p][2], x, u);
    CHECK(distance(p, x, u, want_x, want_u) < 1e-12, "after an edge, where its interval is given");
}

static void test_phase_of_no_length(moray_solution *solution)
{
    double x[most_x];
    const struct phase_layout *layout = &solution->transcription->layout.phase[0];
    solution->iterate.x[layout->tf] = solution->iterate.x[layout->t0];
    CHECK(moray_transcription_values(solution->transcription, solution->iterate.x), "a phase of no length");
    moray_solution_at(solution, 0, 7, x, NULL);
    CHECK(x[0] == solution->iterate.x[layout->node[0].x] && x[1] == solution->iterate.x[layout->node[0].x + 1],
          "is its start");
}

// ---- A diagnosis as an error ----

static void check_failure(moray_solution *solution, const char *diagnosis, const char *expected)
{
    snprintf(solution->diagnosis, sizeof solution->diagnosis, "%s", diagnosis);
    const moray_status failure = moray_solution_failure(solution);
    CHECK(failure.code == MORAY_NOT_SOLVED && strcmp(failure.text, expected) == 0, "\"%s\", expected \"%s\"",
          failure.text, expected);
}

static void test_failure(moray_solution *solution)
{
    check_failure(solution, "", "");
    check_failure(solution, "Stopped.\n", "Stopped.");
    check_failure(solution, "Stopped.\nActive: u.\nTry: more.  \n", "Stopped. Active: u. Try: more.");
    char text[600], filler[400];
    memset(filler, 'a', sizeof filler - 1);
    filler[sizeof filler - 1] = 0;
    snprintf(text, sizeof text, "Stopped.\n%s\nLargest violation: 3.\nTry: more.\nTrying %s", filler, "nothing.");
    check_failure(solution, text, "Stopped. Largest violation: 3. Try: more.");
    snprintf(text, sizeof text, "Stopped.\n%s\nTry: less", filler);
    check_failure(solution, text, "Stopped. Try: less");
}

// ---- Errors of intervals: x' = exp(t) u, u = 1, where u^2 costs ----

static void grow(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] * exp(at->t);
    out->g[0] = at->u[0] * at->u[0];
}

static void first_integral(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0];
}

static void test_interval_errors(void)
{
    static const moray_bounds zero = {0, 0}, one = {1, 1};
    moray_phase_spec phase[2];
    for (int p = 0; p < 2; p++)
        phase[p] = (moray_phase_spec){.nx = 1,
                                      .nu = 1,
                                      .nq = 1,
                                      .continuous = grow,
                                      .intervals = 3 + p,
                                      .t0 = moray_fixed(0),
                                      .tf = moray_fixed(p ? 8 : 1),
                                      .x0 = {&zero, 1},
                                      .u = {&one, 1}};
    moray_ocp *ocp;
    moray_solution *solution;
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2, .phase = phase, .endpoint = first_integral}), "growth");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    double largest = 0;
    for (int p = 0; p < 2; p++) {
        double error[5] = {-1, -1, -1, -1, -1};
        CHECK_OK(moray_solution_interval_errors(solution, p, error), "errors");
        for (int k = 1; k < 3 + p; k++) // as the solution grows: of equal parts, the third derivative by exp(T / n)
            CHECK_RELATIVE(error[k] / error[k - 1], exp((p ? 8. : 1.) / (3 + p)), 1e-6, "of an interval to the next");
        CHECK(error[3 + p] == -1, "no more than there are");
        largest = tap_worse(largest, error[2 + p]);
    }
    CHECK_RELATIVE(largest, solution->history[0].error, 1e-12, "the largest is that of the mesh");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    static const char *const schemes[] = {"radau3", "gauss2", "lobatto3", "gauss3,lobatto2"};
    for (int k = 0; k < 4; k++) {
        moray_ocp *ocp;
        moray_solution *solution = begin(&ocp, schemes[k]);
        if (!solution)
            return 1;
        fill(solution);
        test_numbers(solution);
        for (int p = 0; p < phases; p++)
            test_polynomials(solution, p, schemes[k]);
        test_phase_of_no_length(solution);
        test_failure(solution);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    test_interval_errors();
    return tap_done();
}
