// SPDX-License-Identifier: MIT
//
// Along an optimum whose functions change with time the Hamiltonian follows dH/dt: of dynamics, an active path
// constraint and an integrand, each of which moves it by itself.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/certificate/certify.h"

// Parts of H that depend on time.
struct part {
    const char *what;
    double f, c, g, h;
};
static const struct part parts[] = {{"nothing", 0, 0, 0, 0},
                                    {"the dynamics", 1, 0, 0, 0},
                                    {"a path constraint", 0, 1, 0, 0},
                                    {"an integrand", 0, 0, 1, 0},
                                    {"the last integrand alone", 0, 0, 0, 1},
                                    {"all", 1, 1, 1, 1}};

// u[0] is free, u[1] pushes against a limit all along.
static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    const struct part *part = data;
    const moray_num t = at->t, *x = at->x, *u = at->u;
    out->f[0] = u[0] + part->f * t * x[1];
    out->f[1] = u[1] - x[1];
    out->c[0] = u[1] - 1 - part->c * t * t;
    out->c[1] = x[0];
    out->g[0] = (1 + part->g * t * t) * u[0] * u[0] + x[0] * x[0] + (u[1] - 8) * (u[1] - 8);
    out->g[1] = (1 + part->h * t * t) * (x[1] - 3) * (x[1] - 3);
}

static void cost(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + 2 * at->phase[0].q[1];
}

static moray_solution *solve(moray_ocp **ocp, const struct part *part)
{
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 2,
                                    .nc = 2,
                                    .nq = 2,
                                    .continuous = drift,
                                    .t0 = moray_fixed(-0.5),
                                    .tf = moray_fixed(1.5),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0.5)),
                                    .c = MORAY_BOUNDS(moray_at_most(0), moray_between(-50, 50))};
    settings.scheme = "radau4";
    settings.intervals = 10;
    settings.tolerance = 1e-10;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = cost, .data = part}),
             "problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "solved");
    return solution;
}

static struct finding drift_of(const moray_solution *solution, bool *autonomous)
{
    struct witness w;
    struct finding found = {0};
    CHECK_OK(moray_witness_new(&w, solution), "witness");
    CHECK_OK(moray_hamiltonian_drift(&w, 0, &found, autonomous), "drift");
    moray_witness_free(&w);
    return found;
}

static void test_part(const struct part *part)
{
    moray_ocp *ocp = NULL;
    bool autonomous;
    moray_solution *solution = solve(&ocp, part);
    const struct finding found = drift_of(solution, &autonomous);
    CHECK(found.value < 1e-6, "%s changes with time: H is where its slope leads, but for %.1e", part->what,
          found.value);
    CHECK(autonomous == (part == parts), "which is %snoticed", autonomous ? "not " : "");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// With another multiplier of an integral H is not constant: what is told is its mean departure from its mean.
static void test_size(void)
{
    moray_ocp *ocp = NULL;
    bool autonomous;
    moray_solution *solution = solve(&ocp, &parts[0]);
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[0];
    const int nodes = layout->nodes;
    double *H = calloc((size_t)nodes, sizeof *H), mean = 0, off = 0, worst = 0, when = 0;
    solution->iterate.lambda[layout->integral_row] *= 1.5;
    moray_solution_hamiltonian(solution, 0, H);
    for (int n = 0; n < nodes; n++)
        mean += layout->node[n].collocated ? layout->node[n].weight * H[n] : 0;
    for (int n = 0; n < nodes; n++) {
        const double far = layout->node[n].collocated ? fabs(H[n] - mean) : 0;
        off += layout->node[n].weight * far;
        when = far > worst ? -0.5 + 2 * layout->node[n].tau : when;
        worst = tap_worse(worst, far);
    }
    double *costate = calloc(2 * (size_t)nodes, sizeof *costate), size = 0;
    moray_solution_nodes(solution, 0, NULL, costate);
    for (int n = 0; n < nodes; n++) {
        const double *out = t->phase[0].out + n * t->phase[0].map->n_out;
        if (layout->node[n].collocated)
            size = fmax(size, fabs(costate[2 * n] * out[0]) + fabs(costate[2 * n + 1] * out[1]) +
                                  fabs(solution->iterate.lambda[layout->integral_row] * out[4]) +
                                  fabs(solution->iterate.lambda[layout->integral_row + 1] * out[5]));
    }
    const struct finding found = drift_of(solution, &autonomous);
    CHECK(fabs(found.value * size / off - 1) < 1e-9 && off > 1e-3 * size,
          "the mean departure is told relative to the largest sum of terms: %g of %g", found.value * size, off);
    CHECK_NEAR(found.time, when, 1e-12, "when it is largest");
    free(costate);
    free(H);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// Without any multiplier there is no H, and nothing that departs from it.
static void test_none(void)
{
    moray_ocp *ocp = NULL;
    bool autonomous;
    moray_solution *solution = solve(&ocp, &parts[0]);
    memset(solution->iterate.lambda, 0, (size_t)solution->transcription->nlp.m * sizeof(double));
    const struct finding found = drift_of(solution, &autonomous);
    CHECK(found.value == 0, "no H, no drift: %g", found.value);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        test_part(&parts[k]);
    test_size();
    test_none();
    return tap_done();
}
