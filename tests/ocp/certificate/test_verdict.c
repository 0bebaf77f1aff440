// SPDX-License-Identifier: MIT
//
// Which of several numbers the certificate goes by, and what it says of it.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"
#include "ocp/certificate/columns.h"
#include "ocp/solution.h"
#include "rk4.h"

static const int rk4_steps = 40;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

static moray_certificate certify(const moray_solution *solution)
{
    moray_certificate c;
    CHECK_OK(moray_certify(solution, &rk4, &c), "certificate");
    return c;
}

static void end(moray_solution *solution, moray_ocp *ocp)
{
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Phases without length, beside the longest, whichever way that runs ----

enum { PHASES = 3 };

static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void nothing(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static void check_lengths(moray_solution *solution, const double length[PHASES], const char *why)
{
    const struct transcription *t = solution->transcription;
    for (int p = 0; p < PHASES; p++) {
        solution->iterate.x[t->layout.phase[p].t0] = 1;
        solution->iterate.x[t->layout.phase[p].tf] = 1 + length[p];
    }
    const moray_certificate c = certify(solution);
    if (!why) {
        CHECK(!strstr(c.why, "has no length"), "%g, %g and %g are lengths: %s", length[0], length[1], length[2], c.why);
        return;
    }
    CHECK(!c.pass && !strcmp(c.why, why), "%s", c.why);
    CHECK(isnan(c.kkt) && isnan(c.mesh_error) && isnan(c.between_nodes) && isnan(c.resimulation) &&
              isnan(c.derivatives) && isnan(c.directions) && isnan(c.hamiltonian) && isnan(c.composed) &&
              isnan(c.gap) && isnan(c.curvature) && isnan(c.untold) && isnan(c.unseen),
          "and nothing else is told");
    CHECK(c.mesh_limit == solution->settings.mesh_tolerance, "but the limit is");
}

static void test_lengths(void)
{
    const moray_bounds any = moray_between(-99, 99);
    moray_phase_spec phases[PHASES];
    static const char *const names[] = {"one", "two", "three"};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    for (int p = 0; p < PHASES; p++)
        phases[p] =
            (moray_phase_spec){.name = names[p], .nx = 1, .nu = 1, .nq = 1, .continuous = drift, .t0 = any, .tf = any};
    settings.max_iterations = 0;
    settings.intervals = 3;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = PHASES, .phase = phases, .endpoint = nothing}), "phases");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    check_lengths(solution, (double[]){1, 2e-5, 1}, NULL);
    check_lengths(solution, (double[]){1, 0.5e-5, 1}, "phase two has no length: it goes from t = 1 to 1.000005");
    check_lengths(solution, (double[]){1e-6, 3e-6, 2e-6}, NULL);
    check_lengths(solution, (double[]){2e-5, 1, 9}, "phase one has no length: it goes from t = 1 to 1.00002");
    check_lengths(solution, (double[]){2e-5, 1e-3, -9}, "phase one has no length: it goes from t = 1 to 1.00002");
    check_lengths(solution, (double[]){1, -1, 0}, "phase two has no length: it goes from t = 1 to 0");
    check_lengths(solution, (double[]){1, 1, 0}, "phase three has no length: it goes from t = 1 to 1");
    end(solution, ocp);
}

// ---- A mesh so coarse that the Hamiltonian drifts, where all else is allowed ----

struct fall {
    const char *scheme;
    double decay, price;
    bool judged;
};

static void fall(const moray_node *at, moray_rates *out, const void *data)
{
    const struct fall *of = data;
    out->f[0] = at->u[0] - of->decay * at->x[0];
    out->g[0] = at->u[0] * at->u[0] + of->price * at->x[0];
}

static void test_coarse(const struct fall *of)
{
    const moray_phase_spec phase = {.name = "fall",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = fall,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1))};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    settings.scheme = of->scheme;
    settings.intervals = 1;
    settings.mesh_tolerance = 10;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = nothing, .data = of}),
             of->scheme);
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    const moray_certificate c = certify(solution);
    CHECK(c.hamiltonian > MORAY_LIMIT_HAMILTONIAN, "%s: the Hamiltonian drifts by %g", of->scheme, c.hamiltonian);
    CHECK(c.pass != of->judged, "%s is%s judged by it: %s", of->scheme, of->judged ? "" : " not", c.why);
    if (of->judged)
        CHECK(strstr(c.why, "drift of the Hamiltonian: ") &&
                  strstr(c.why, "where 0.01 is allowed; phase fall near t ="),
              "which is told: %s", c.why);
    end(solution, ocp);
}

// ---- What moving data see, one of them beside the trajectory ----

static void see(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0];
}

static void fit(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + 1e-3 * at->phase[0].tf * at->phase[0].tf;
}

static void test_seen(void)
{
    static const double time[] = {0.2, 0.5, 0.9}, value[] = {1, 2, 1.5};
    const moray_phase_spec phase = {.name = "seen",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = drift,
                                    .tf = moray_between(1, 3),
                                    .observed = {.n = 3, .ny = 1, .time = time, .value = value, .observe = see}};
    const moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = fit}), "data");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    const struct sight *sight = solution->transcription->layout.phase[0].sight;
    CHECK(sight != NULL, "times are free, so data move");
    for (int k = 0; k < 3 && sight; k++) {
        double *seen = &solution->iterate.x[sight[k].x];
        *seen += 1e3;
        CHECK(certify(solution).kkt > 1, "what the datum at %g sees is not the trajectory", time[k]);
        *seen -= 1e3;
    }
    end(solution, ocp);
}

// ---- Differences do not depend on what their room held before ----

static void waves(void *self, const double *in, double *out)
{
    (void)self;
    out[0] = sin(3 * in[0]) + in[1];
    out[1] = fabs(in[1]) * in[0];
}

static void test_room(void)
{
    enum { IN = 2, OUT = 2, BLOCK = IN * OUT };
    const double in[IN] = {0.3, 0}, size[IN] = {1, 2};
    const moray_map map = {.n_in = IN, .n_out = OUT, .value = waves};
    double told[2][3][BLOCK + 1];
    for (int used = 0; used < 2; used++) {
        for (int which = 0; which < 3; which++)
            for (int k = 0; k <= BLOCK; k++)
                told[used][which][k] = used ? INFINITY : 0;
        CHECK_OK(moray_difference_columns(&map, in, size, NULL, told[used][0], told[used][1], told[used][2]),
                 "columns");
    }
    for (int which = 0; which < 3; which++)
        CHECK(!memcmp(told[0][which], told[1][which], BLOCK * sizeof(double)), "the same in used room");
}

// How exact an output is does not hang on how large another is.
static void grow(void *self, const double *in, double *out)
{
    const int *large = self;
    out[*large] = 1e8;
    out[!*large] = exp(9 * in[0]);
}

static void test_beside_large(void)
{
    for (int large = 0; large < 2; large++) {
        const double in = 0.1, size = 1;
        const moray_map map = {.n_in = 1, .n_out = 2, .value = grow, .self = &large};
        double jac[2], doubt[2], kink[2];
        CHECK_OK(moray_difference_columns(&map, &in, &size, NULL, jac, doubt, kink), "columns");
        CHECK(fabs(jac[!large] - 9 * exp(0.9)) < 1e-9 && doubt[!large] < 1e-8, "of an exponential: off by %.1e",
              jac[!large] - 9 * exp(0.9));
    }
}

int main(void)
{
    test_lengths();
    test_coarse(&(struct fall){"radau3", 3, 200, true});
    test_coarse(&(struct fall){"hermite-simpson", 3, 20, false});
    test_coarse(&(struct fall){"trapezoid", 1, 20, false});
    test_seen();
    test_room();
    test_beside_large();
    return tap_done();
}
