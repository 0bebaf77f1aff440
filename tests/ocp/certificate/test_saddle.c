// SPDX-License-Identifier: MIT
//
// The step away from a saddle: where there is one, along what bends down most, within bounds.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/certificate/curvature.h"
#include "ocp/certificate/saddle.h"
#include "symmetric_line.h"

enum { NS = 3 };
static const double bend[NS] = {-3, -1, 4};
static bool defined;

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->x[0];
}

// Turned over by the sign.
static void saddle(const moray_ends *at, moray_end_values *out, const void *data)
{
    const double sign = *(const double *)data;
    out->objective = defined ? 0.5 * at->s[0] * at->s[1] : NAN;
    for (int k = 0; k < NS; k++)
        out->objective += (sign == 0 ? fabs(bend[k]) : sign * bend[k]) * at->s[k] * at->s[k] / 2;
}

static moray_solution *begin(moray_ocp **ocp, const double *sign, double reach, const double *x)
{
    const moray_bounds box = moray_between(-reach, reach);
    const moray_phase_spec phases[] = {
        {.nx = 1, .continuous = still, .tf = moray_between(0, 9), .x0 = MORAY_BOUNDS(moray_fixed(0))},
        {.nx = 1, .continuous = still, .tf = moray_between(0, 9), .x0 = MORAY_BOUNDS(moray_fixed(0))}};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.max_iterations = 0;
    settings.intervals = 3;
    defined = true;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2,
                                                  .phase = phases,
                                                  .ns = NS,
                                                  .s = MORAY_BOUNDS(box, box, box),
                                                  .endpoint = saddle,
                                                  .data = sign}),
             "a saddle");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    const struct transcription *t = solution->transcription;
    memset(solution->iterate.x, 0, (size_t)(4 * t->nlp.n + 2 * t->nlp.m) * sizeof(double));
    memcpy(solution->iterate.x + t->layout.s, x, NS * sizeof *x);
    for (int p = 0; p < 2; p++)
        solution->iterate.x[t->layout.phase[p].tf] = 2;
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
    return solution;
}

static void check_still(moray_solution *solution, const char *what)
{
    double kept[200], before[200];
    const size_t size = (size_t)solution->transcription->nlp.n * sizeof *kept;
    bool moved = true;
    memcpy(before, solution->iterate.x, size);
    CHECK_OK(moray_leave_saddle(solution, kept, &moved), what);
    CHECK(!moved && !memcmp(before, solution->iterate.x, size), "%s is not left", what);
}

static void test_left(double sign, double reach)
{
    const double x[NS] = {0.02, -0.02, 0.02};
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, &sign, reach, x);
    const moray_nlp *nlp = &solution->transcription->nlp;
    double direction[200], curvature = 0, kept[200], before[200], farthest = 0;
    struct witness w;
    bool moved = false, at_bound = false;
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    CHECK_OK(moray_measure_curvature(&w, &curvature, direction), "curvature");
    moray_witness_free(&w);
    memcpy(before, solution->iterate.x, (size_t)nlp->n * sizeof *before);
    CHECK_OK(moray_leave_saddle(solution, kept, &moved), "left");
    CHECK(moved && curvature > MORAY_LIMIT_CURVATURE, "it bends down by %g and is left", curvature);
    CHECK(!memcmp(before, kept, (size_t)nlp->n * sizeof *kept), "where it stood is kept");
    for (int j = 0; j < nlp->n; j++) {
        const double to = before[j] + 0.3 * direction[j], at = solution->iterate.x[j];
        const double within = to < nlp->x_lower[j] ? nlp->x_lower[j] : to > nlp->x_upper[j] ? nlp->x_upper[j] : to;
        CHECK(at == within, "column %d goes to %g, expected %g", j, at, within);
        farthest = tap_worse(farthest, fabs(at - before[j]));
        at_bound = at_bound || to != within;
    }
    CHECK(farthest > 0 && at_bound == (reach < 1), "as far as there is room: %g", farthest);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void test_not_left(void)
{
    const double x[NS] = {0}, sign = 0;
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, &sign, 2, x);
    check_still(solution, "a minimum");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    const double up = 1;
    solution = begin(&ocp, &up, 2, x);
    const struct transcription *t = solution->transcription;
    for (int p = 0; p < 2; p++) {
        for (int n = 0; n < 2; n++)
            solution->iterate.x[t->layout.phase[n].tf] = n == p ? 0 : 2;
        moray_transcription_jacobians(solution->transcription, solution->iterate.x);
        check_still(solution, "a phase without length");
    }
    solution->iterate.x[t->layout.phase[1].tf] = 2;
    moray_transcription_jacobians(solution->transcription, solution->iterate.x);
    defined = false;
    solution->iterate.x[t->layout.s] += 1e-3; // so that nothing is known of it
    check_still(solution, "what is not defined");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Where the solve from beside it fails, the saddle is the result, as it was ----

static bool stop_second(void *observer, const moray_progress *progress)
{
    int *solves = observer;
    *solves += progress->iteration == 0;
    return *solves < 2;
}

static void test_back_on_it(void)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    int solves = 0, meshes;
    settings.progress = stop_second;
    settings.observer = &solves;
    CHECK_OK(symmetric_line_new(&ocp), "a maximum");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    const struct transcription *t = solution->transcription;
    moray_solution_history(solution, &meshes);
    double largest = 0;
    for (int j = 0; j < t->nlp.n; j++)
        largest = tap_worse(largest, fabs(solution->iterate.x[j]));
    CHECK(solves == 2 && moray_solution_info(solution)->outcome == MORAY_NLP_INTERRUPTED, "the second is interrupted");
    CHECK(largest < 1e-9 && fabs(moray_solution_objective(solution)) < 1e-9, "back where nothing moves: %g", largest);
    CHECK(!memcmp(t->x, solution->iterate.x, (size_t)t->nlp.n * sizeof(double)) && fabs(t->end_out[0]) < 1e-9,
          "and so is what accessors read: %g", t->end_out[0]);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- The direction ----

// A slope, and a bend down along one way at s = 1, by not quite a tenth of what the slope makes of a size.
struct ridge {
    double way[NS];
};

static void ridge(const moray_ends *at, moray_end_values *out, const void *data)
{
    const struct ridge *of = data;
    moray_num along = 0;
    for (int k = 0; k < NS; k++)
        along += of->way[k] * (at->s[k] - 1);
    out->objective = 1000 * at->s[0] - 0.09 * 1000 * along * along / 2;
}

// The way itself, its largest part of the size of its parameter, whichever its sign. Returns whether that is negative.
static bool test_direction(unsigned long long *seed)
{
    struct ridge of;
    double direction[200], size[200], curvature = 0, length = 0, largest = 0;
    for (int k = 0; k < NS; k++)
        of.way[k] = tap_random(seed, -1, 1), length = hypot(length, of.way[k]);
    for (int k = 0; k < NS; k++) {
        of.way[k] /= length;
        largest = fabs(of.way[k]) > fabs(largest) ? of.way[k] : largest;
    }
    const moray_phase_spec phase = {
        .nx = 1, .continuous = still, .tf = moray_fixed(1), .x0 = MORAY_BOUNDS(moray_fixed(0))};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    struct witness w;
    settings.max_iterations = 0;
    settings.intervals = 3;
    CHECK_OK(
        moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = NS, .endpoint = ridge, .data = &of}),
        "a ridge");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    const int first = solution->transcription->layout.s;
    for (int k = 0; k < NS; k++)
        solution->iterate.x[first + k] = 1;
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    moray_witness_columns(&w, size);
    CHECK_OK(moray_measure_curvature(&w, &curvature, direction), "curvature");
    double worst = 0;
    const double sign = direction[first] * of.way[0] > 0 ? 1 : -1;
    for (int k = 0; k < NS; k++)
        worst = tap_worse(worst, fabs(direction[first + k] / size[first + k] - sign * of.way[k] / fabs(largest)));
    CHECK(fabs(curvature - 0.09) < 2e-3 && worst < 1e-2, "it bends down by %g along a way that is off by %.1e",
          curvature, worst);
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return sign * largest < 0;
}

static void test_directions(void)
{
    unsigned long long seed = 23;
    int negative = 0;
    for (int k = 0; k < 40; k++)
        negative += test_direction(&seed);
    CHECK(negative > 3 && negative < 37, "%d of 40 are largest where they are negative", negative);
}

int main(void)
{
    test_back_on_it();
    test_directions();
    for (int sign = -1; sign <= 1; sign += 2) {
        test_left(sign, 8);
        test_left(sign, 0.0201);
    }
    test_not_left();
    return tap_done();
}
