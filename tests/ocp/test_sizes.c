// SPDX-License-Identifier: MIT
//
// Sizes do not know signs: of slopes, of rates, of integrands, of the direction of a phase.
#include "tap.h"

#include <stdlib.h>

#include "moray/ocp.h"
#include "ocp/guess_sizes.h"

enum { nx = 3, nu = 2, n_size = nx + nu };

// Signs of the slopes, by which nothing that has a size may change.
struct signs {
    double state, control, integrand;
};

static void plant(const moray_node *at, moray_rates *out, const void *data)
{
    const struct signs *sign = data;
    out->f[0] = sign->state * (4 * at->x[1] + at->x[2] * at->t / 5);
    out->f[1] = sign->control * at->u[0] / 2;
    out->f[2] = sign->control * 3 * at->u[1];
    out->c[0] = at->x[0];
    out->g[0] = sign->integrand * 10;
    out->g[1] = sign->integrand * (7 + 3 * at->u[0] * at->u[0]);
    out->g[2] = sign->integrand * at->t;
    out->g[3] = sign->integrand * (4 + at->u[1]);
    out->g[4] = 0;
}

static void nowhere(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

static moray_solution *begin(moray_ocp **ocp, const moray_phase_spec *phase, const struct signs *sign)
{
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    settings.scheme = "radau2";
    settings.intervals = 5;
    const moray_ocp_spec spec = {.phases = 1, .phase = phase, .endpoint = nowhere, .data = sign};
    CHECK_OK(moray_ocp_new(ocp, &spec), "problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    return solution;
}

// Of states that controls of -3..1 and -1..2 move over a time of 2, from 3 to 5 or back.
static void test_signs(const struct signs *sign, bool backwards)
{
    const moray_phase_spec phase = {.nx = nx,
                                    .nu = nu,
                                    .nc = 1,
                                    .nq = 5,
                                    .continuous = plant,
                                    .t0 = moray_between(2, 9),
                                    .tf = moray_between(2, 9),
                                    .u = MORAY_BOUNDS(moray_between(-3, 1), moray_between(-1, 2)),
                                    .c = MORAY_BOUNDS(moray_between(-1, 1))};
    moray_ocp *ocp;
    moray_solution *solution = begin(&ocp, &phase, sign);
    struct transcription *t = solution->transcription;
    double size[n_size], work[100], *x = solution->iterate.x;
    for (int j = 0; j < t->nlp.n; j++)
        x[j] = 0;
    x[t->layout.phase[0].t0] = backwards ? 5 : 3, x[t->layout.phase[0].tf] = backwards ? 3 : 5;
    CHECK_OK(moray_choose_scales(t, x, false), "the caches are of this point");
    moray_size_inputs(t, 0, x, false, size);
    const double want[n_size] = {4 * 3 * 2, 3. / 2 * 2, 3 * 2 * 2, 3, 2}; // x[0] by x[1], its strongest cause
    for (int i = 0; i < n_size; i++)
        CHECK(fabs(size[i] - want[i]) < 1e-12 * want[i], "%g %g: size %d is %g, not %g", sign->state, sign->control, i,
              size[i], want[i]);
    const double flat = moray_size_of_integral(t, 0, 0, 0, size, work);
    const double bent = moray_size_of_integral(t, 0, 1, 0, size, work);
    CHECK_NEAR(flat, 10 * 2, 1e-12, "an integral of what is constant");
    CHECK_NEAR(bent, (7 + 3 * 9) * 2, 1e-12, "one with a control that moves within its box, downwards");
    // The last node that is looked at is the end, the first the end of the first fifth.
    CHECK_NEAR(moray_size_of_integral(t, 0, 2, 0, size, work), (backwards ? 5 - 0.4 : 5) * 2, 1e-12, "one of time");
    CHECK_NEAR(moray_size_of_integral(t, 0, 3, 0, size, work), (4 + 2) * 2, 1e-12, "one of a control up to its bound");
    CHECK(moray_size_of_integral(t, 0, 4, 0, size, work) == 1, "one of nothing");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- How long it takes where the guess itself moves ----

static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    const struct signs *sign = data;
    out->f[0] = sign->state * (2 * at->t + 0 * at->u[0]);
    out->f[1] = at->x[0];
}

static void test_drift(const struct signs *sign)
{
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .continuous = drift,
                                    .t0 = moray_fixed(-1),
                                    .tf = moray_fixed(3),
                                    .x0 = MORAY_BOUNDS(moray_fixed(5), moray_free()),
                                    .xf = MORAY_BOUNDS(moray_fixed(-15), moray_free())};
    moray_ocp *ocp;
    moray_solution *solution = begin(&ocp, &phase, sign);
    struct transcription *t = solution->transcription;
    double size[3], *x = solution->iterate.x;
    for (int j = 0; j < t->nlp.n; j++)
        x[j] = 0;
    CHECK_OK(moray_choose_scales(t, x, false), "the caches are of this point");
    // 20 away at a speed of up to 6: the first of the fourth roots of powers of ten that is 20 / 6 or more.
    CHECK_NEAR(moray_needed_duration(t, 0, x, size), pow(10, 0.75), 1e-12, "at a speed of either sign");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Of the guess ----

static void test_guess(void)
{
    static const struct {
        double start, at, size; // the state is fixed to at its start, is in the guess, and that is its size
    } cases[] = {{1, -7, 7}, {1, 1e-9, 1e-9}, {1e-13, 1e-9, 24}, {1.1e-13, 1e-9, 1e-9}, {1, 1e19, 1e19}, {1, 1e20, 24}};
    const struct signs sign = {1, 1, 1};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const moray_phase_spec phase = {.nx = nx,
                                        .nu = nu,
                                        .nc = 1,
                                        .nq = 5,
                                        .continuous = plant,
                                        .t0 = moray_fixed(3),
                                        .tf = moray_fixed(5),
                                        .x0 = MORAY_BOUNDS(moray_fixed(cases[k].start), moray_free(), moray_free()),
                                        .u = MORAY_BOUNDS(moray_between(-3, 1), moray_between(-1, 2)),
                                        .c = MORAY_BOUNDS(moray_between(-1, 1))};
        moray_ocp *ocp;
        moray_solution *solution = begin(&ocp, &phase, &sign);
        struct transcription *t = solution->transcription;
        const struct phase_layout *layout = &t->layout.phase[0];
        double size[n_size], *x = solution->iterate.x;
        for (int j = 0; j < t->nlp.n; j++)
            x[j] = 0;
        CHECK_OK(moray_choose_scales(t, x, false), "the caches are of this point");
        x[layout->node[4].x] = cases[k].at;
        moray_size_inputs(t, 0, x, true, size); // as found, it is not doubted
        CHECK(fabs(size[0] - cases[k].size) <= 1e-12 * cases[k].size, "%g, %g: size is %g, not %g", cases[k].start,
              cases[k].at, size[0], cases[k].size);
        x[layout->node[4].x] = 0, x[layout->node[0].x + 1] = -9;
        for (int r = 0; r < nx; r++)
            CHECK(moray_largest_in_phase(layout, x, r) == (r == 1 ? 9 : 0), "state %d", r);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    CHECK(moray_known_size(moray_free(), 1e-8) == 0 && !moray_is_far_below(1e-6, 1) && !moray_is_far_below(1, 1000),
          "at the edge of what is no size");
}

int main(void)
{
    static const struct signs signs[] = {{1, 1, 1}, {-1, 1, -1}, {1, -1, 1}, {-1, -1, -1}};
    for (int k = 0; k < 4; k++) {
        test_signs(&signs[k], false);
        test_signs(&signs[k], true);
        test_drift(&signs[k]);
    }
    test_guess();
    return tap_done();
}
