// SPDX-License-Identifier: MIT
//
// Shooting interval by interval and in one go, in closed form, from states at the nodes that are off by random amounts.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/certificate/certify.h"
#include "rk4.h"

enum { NX = 2, INTERVALS = 5 };
static const int steps = 4; // of polynomials that they integrate exactly
static const moray_integrator rk4 = {rk4_run, &steps};
static const double START = 7, SPAN = 3;
static bool defined = true;
static double farthest = INFINITY; // first state, beyond which functions end

static void glide(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = (defined || creal(at->t) < START + SPAN / 2) && creal(at->x[0]) < farthest ? 2 : NAN;
    out->f[1] = at->t;
    out->c[0] = 777 + at->x[1];
    out->g[0] = at->x[0];
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[1].q[0] + at->phase[1].xf[0] * at->phase[1].xf[1];
}

static double exact(int i, double t)
{
    return i == 0 ? 1 + 2 * (t - START) : t * t / 2;
}

// What the second phase's states are off by at the edges of intervals, and its integral.
struct off {
    double x[INTERVALS + 1][NX], q;
};

static void set_iterate(const moray_solution *solution, const struct off *off)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[1];
    for (int k = 0; k < INTERVALS; k++)
        for (int n = 0; n < layout->interval[k].scheme->points; n++) {
            const struct node *node = &layout->node[layout->interval[k].first + n];
            const bool last = n == layout->interval[k].scheme->points - 1;
            for (int i = 0; i < NX; i++)
                solution->iterate.x[node->x + i] = exact(i, START + SPAN * node->tau) + off->x[k + last][i];
        }
    solution->iterate.x[layout->q] = SPAN + SPAN * SPAN + off->q;
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
}

struct expected {
    double shooting, time, composed;
};

static void note(double *worst, double value, double *time, double when)
{
    if (time && value > *worst)
        *time = when;
    *worst = fmax(*worst, value);
}

static struct expected expect(const struct phase_layout *layout, const struct off *off, const double *size)
{
    struct expected e = {0};
    double by_intervals = 0; // what the states' starts add to the integral
    for (int k = 0; k < INTERVALS; k++) {
        const double when = START + SPAN * layout->mesh.edge[k + 1];
        by_intervals += off->x[k][0] * SPAN * (layout->mesh.edge[k + 1] - layout->mesh.edge[k]);
        for (int i = 0; i < NX; i++) {
            note(&e.shooting, fabs(off->x[k][i] - off->x[k + 1][i]) / size[i], &e.time, when);
            note(&e.composed, fabs(off->x[0][i] - off->x[k + 1][i]) / size[i], NULL, 0);
        }
    }
    note(&e.shooting, fabs(by_intervals - off->q) / size[NX], &e.time, START + SPAN);
    note(&e.composed, fabs(off->x[0][0] * SPAN - off->q) / size[NX], NULL, 0);
    return e;
}

static void test_off(const moray_solution *solution, const struct off *off)
{
    struct witness w;
    struct examiner e;
    struct finding shooting = {0}, worse = {1e3, 0, -5};
    double composed = 0, more = 1e3;
    set_iterate(solution, off);
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    CHECK_OK(moray_examiner_new(&e, &w, 1), "examiner");
    const struct expected expected = expect(&solution->transcription->layout.phase[1], off, e.size);
    CHECK_OK(moray_resimulate(&e, &rk4, &shooting, &composed), "resimulated");
    CHECK_RELATIVE(shooting.value, expected.shooting, 1e-10, "shooting");
    CHECK(shooting.p == 1 && fabs(shooting.time - expected.time) < 1e-9, "in phase %d at %g, expected %g", shooting.p,
          shooting.time, expected.time);
    CHECK_RELATIVE(composed, expected.composed, 1e-10, "in one go");
    CHECK_OK(moray_resimulate(&e, &rk4, &worse, &more), "resimulated");
    CHECK(worse.value == 1e3 && worse.time == -5 && more == 1e3, "findings are raised, never lowered");
    defined = false;
    CHECK_OK(moray_resimulate(&e, &rk4, &shooting, &composed), "where functions are not defined");
    CHECK(isinf(shooting.value) && shooting.time == START && isinf(composed), "nothing is near: %g and %g",
          shooting.value, composed);
    defined = true;
    moray_examiner_free(&e);
    moray_witness_free(&w);
}

// In one go the states lead out of where functions are defined, from their starts they do not.
static void test_out(const moray_solution *solution)
{
    const struct off off = {.x = {{5, 0}}};
    struct witness w;
    struct examiner e;
    struct finding shooting = {0};
    double composed = 0;
    set_iterate(solution, &off);
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    CHECK_OK(moray_examiner_new(&e, &w, 1), "examiner");
    farthest = 9; // of 1 to 7, and of 6 to 12
    CHECK_OK(moray_resimulate(&e, &rk4, &shooting, &composed), "which is no error");
    CHECK(isfinite(shooting.value) && shooting.value > 0 && isinf(composed), "%g, in one go %g", shooting.value,
          composed);
    farthest = INFINITY;
    moray_examiner_free(&e);
    moray_witness_free(&w);
}

int main(void)
{
    const moray_phase_spec phase = {.name = "glide",
                                    .nx = NX,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = glide,
                                    .t0 = moray_fixed(START),
                                    .tf = moray_fixed(START + SPAN),
                                    .c = MORAY_BOUNDS(moray_free())};
    moray_phase_spec phases[] = {phase, phase};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    unsigned long long seed = 5;
    phases[0].name = "before";
    settings.max_iterations = 0;
    settings.intervals = INTERVALS;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2, .phase = phases, .endpoint = total}), "two phases");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    for (int trial = 0; trial < 12; trial++) {
        struct off off = {.q = trial % 4 == 3 ? tap_random(&seed, -40, 40) : tap_random(&seed, -0.1, 0.1)};
        for (int k = 0; k <= INTERVALS; k++)
            for (int i = 0; i < NX; i++)
                off.x[k][i] = tap_random(&seed, -1, 1) * (trial % 4 == 2 - i ? 9 : 0.1);
        test_off(solution, &off);
    }
    test_out(solution);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return tap_done();
}
