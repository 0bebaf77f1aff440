// SPDX-License-Identifier: MIT
//
// Derivatives in use that are off by a known amount, one at a time, at an iterate set by hand with a kink.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/certificate/differences.h"

enum { X, U0, U1, TIME, IN, F = 0, C0, C1, OUT, ENTRIES = 7, BENT = 3, BY_TIME = 6 };
static int row[ENTRIES] = {F, F, F, C0, C0, C1, C1}, col[ENTRIES] = {X, U0, U1, U0, U1, X, TIME};
static double corner; // half the change of slope

static void value(void *self, const double *in, double *out)
{
    (void)self;
    out[F] = 2 * in[X] + 3 * in[U0] - in[U1];
    out[C0] = corner * fabs(in[U0]) - 2 * in[U1];
    out[C1] = in[TIME] * in[X];
}

static void jacobian(void *self, const double *in, double *values)
{
    const double *off = self, right[ENTRIES] = {2, 3, -1, 0, -2, in[TIME], in[X]};
    for (int k = 0; k < ENTRIES; k++)
        values[k] = right[k] + off[k];
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)self, (void)in, (void)weight;
    values[0] = weight[C1];
}

static void last(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = 3 * at->phase[0].xf[0];
}

// u[0] stays on its corner.
static void set_iterate(const moray_solution *solution)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[0];
    for (int n = 0; n < layout->nodes; n++) {
        double *x = solution->iterate.x + layout->node[n].x;
        x[0] = 4 - layout->node[n].tau;
        if (layout->node[n].collocated)
            x[U0] = 0, x[U1] = 1 + layout->node[n].tau;
    }
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
}

static double told(const moray_solution *solution, int k, double *untold, char *where, int size)
{
    struct witness w;
    double worst = 0;
    *untold = 0;
    CHECK_OK(moray_witness_new(&w, solution), "witness");
    CHECK_OK(moray_compare_columns(&w, &worst, untold, where, size), "compared");
    worst *= w.phase[0].out_size[row[k]] / w.phase[0].size[col[k]];
    moray_witness_free(&w);
    return worst;
}

static void test_entry(const moray_solution *solution, double *off, int k, double by, double distance, bool timeless)
{
    static const char *const names[] = {"dynamics of state x[0]", "path constraint c[0]", "path constraint c[1]"};
    static const char *const inputs[] = {"state x[0]", "control u[0]", "control u[1]", "time"};
    char where[400] = "";
    double untold;
    memset(off, 0, ENTRIES * sizeof *off);
    off[BENT] = corner; // the slope on one side
    off[k] = by;
    solution->iterate.x[solution->transcription->layout.phase[0].node[0].x] = 99; // elsewhere, so that nothing is kept
    moray_transcription_jacobians(solution->transcription, solution->iterate.x);
    set_iterate(solution);
    const double worst = told(solution, k, &untold, where, sizeof where);
    CHECK(fabs(worst - distance) < 1e-6, "entry %d off by %g: %.9g, expected %g; %s", k, by, worst, distance, where);
    if (distance > 0)
        CHECK(strstr(where, names[row[k]]) && strstr(where, inputs[col[k]]), "its names: %s", where);
    int nodes = 0;
    for (int n = 0; n < solution->transcription->layout.phase[0].nodes; n++)
        nodes += solution->transcription->layout.phase[0].node[n].collocated;
    const double all = nodes * (ENTRIES - 1 - timeless + (off[BENT] != 0)) + 1, silent = nodes * (off[BENT] != 0);
    CHECK_NEAR(untold, silent / all, 1e-12, "the share at the corner");
}

static void test_entries(moray_bounds tf)
{
    static int second_row[] = {TIME}, second_col[] = {X};
    double off[ENTRIES] = {0};
    const moray_map map = {.self = off,
                           .n_in = IN,
                           .n_out = OUT,
                           .jac = {ENTRIES, row, col},
                           .hess = {1, second_row, second_col},
                           .value = value,
                           .jacobian = jacobian,
                           .hessian = hessian};
    const moray_phase_spec phase = {.name = "bent",
                                    .nx = 1,
                                    .nu = 2,
                                    .nc = 2,
                                    .map = &map,
                                    .t0 = moray_fixed(1),
                                    .tf = tf,
                                    .c = MORAY_BOUNDS(moray_free(), moray_free())};
    const bool timeless = tf.lower == tf.upper;
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    settings.max_iterations = 0;
    settings.intervals = 3;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = last}), "problem");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    for (int k = 0; k < ENTRIES; k++)
        for (int sign = -1; sign <= 1 && k != BENT; sign += 2)
            test_entry(solution, off, k, 0.3 * sign, timeless && k == BY_TIME ? 0 : 0.3, timeless);
    for (int sign = -1; sign <= 1; sign += 2) { // from the nearer of both slopes
        test_entry(solution, off, BENT, sign * corner, 0, timeless);
        test_entry(solution, off, BENT, sign * (corner + copysign(2, corner)), 2, timeless);
        test_entry(solution, off, BENT, sign * (corner - copysign(1.5, corner)), 1.5, timeless);
    }
    test_entry(solution, off, BENT, 0, fabs(corner), timeless);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    for (corner = -5; corner <= 5; corner += 10) {
        test_entries(moray_fixed(2));
        test_entries(moray_between(2, 3));
    }
    return tap_done();
}
