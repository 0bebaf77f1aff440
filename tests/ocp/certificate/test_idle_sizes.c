// SPDX-License-Identifier: MIT
//
// Sizes of controls that stand still and of parameters near 0: ten times a part of what they are, and so on, until an
// output moves by a hundredth of the most that it is; by hand for each.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/certificate/sizes.h"
#include "ocp/probe.h"

enum { NX = 2, NU = 6, NC = 3, NS = 6, FIRST_NU = 1 };
static const double controls[NU] = {1, -4, 1, 2, 2, 3}, parameters[NS] = {0.5, -0.01, 0.02, 0.02, 0.03, 1e-3};

static void first(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 1000;
    out->c[0] = 9 + 0.2 * (at->u[0] - 7) + 3 * (at->s[2] - parameters[2]);
}

// Ahead alone, behind alone, at the end alone, or not defined.
static void second(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num *u = at->u;
    const double t = creal(at->t), past = fmax(creal(u[0]) - 1.004, 0), behind = fmin(creal(u[3]) - 2, 0);
    (void)data;
    out->f[0] = 1 + 5 * past;
    out->f[1] = 0.0025 * (at->s[5] - parameters[5]);
    out->c[0] = -8 - 3 * (t - 2) + 0.8 * (u[1] + 4);
    out->c[1] = 6 + (t > 3.999 ? 7 * behind : 0) + 0.5 * (at->s[3] - parameters[3]);
    out->c[2] = creal(u[5]) > 3.2 ? NAN : 2;
}

static void ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[1].xf[0];
    out->e[0] = -100 + 2 * (at->s[1] - parameters[1]);
}

static void set_iterate(moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    for (int p = 0; p < 2; p++)
        for (int n = 0; n < t->layout.phase[p].nodes; n++) {
            const struct node *node = &t->layout.phase[p].node[n];
            double *x = solution->iterate.x + node->x;
            x[0] = p ? 2 * node->tau : 1000 * node->tau;
            if (p)
                x[1] = -3;
            for (int i = 0; i < (p ? NU : FIRST_NU) && node->collocated; i++)
                x[p ? NX + i : 1] = p ? controls[i] : 7;
        }
    memcpy(solution->iterate.x + t->layout.s, parameters, sizeof parameters);
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
}

static void check_sizes(const struct witness *w)
{
    const double *one = w->phase[0].size + 1, *two = w->phase[1].size + NX;
    CHECK_RELATIVE(one[0], 0.7, 1e-12, "a control of the first phase");
    CHECK_RELATIVE(two[0], 0.01, 1e-12, "what is told ahead alone, by a rate");
    CHECK_RELATIVE(two[1], 0.4, 1e-12, "a negative one with little room behind, by an output that is negative");
    CHECK_RELATIVE(two[2], 1e-3, 1e-12, "one of a narrow box stays");
    CHECK_RELATIVE(two[3], 0.02, 1e-12, "what is told behind alone, at the end alone");
    CHECK_RELATIVE(two[4], 33, 1e-12, "of what tells nothing, its box");
    CHECK_RELATIVE(two[5], 0.3, 1e-12, "where a function is not defined that tells");
    for (int p = 0; p < 2; p++) {
        const double *s = p ? two + NU : one + FIRST_NU;
        CHECK_RELATIVE(s[0], 0.5, 1e-12, "a parameter that is large in its box stays");
        CHECK_RELATIVE(s[1], 1, 1e-12, "one that the endpoint tells");
        CHECK_RELATIVE(s[2], 0.2, 1e-12, "one that the first phase tells");
        CHECK_RELATIVE(s[3], 0.2, 1e-12, "one that the second tells");
        CHECK_RELATIVE(s[4], 90, 1e-12, "one that nothing tells");
        CHECK_RELATIVE(s[5], p ? 0.1 * 3e-3 / (2 * 0.0025) : 1e-3, 1e-9, "one that moves a state where it does");
    }
    for (int k = 0; k < NS; k++)
        CHECK(w->end_size[moray_endpoint_inputs(w->solution->transcription->ocp) - NS + k] == one[FIRST_NU + k],
              "at the end, those of the first phase");
}

int main(void)
{
    const moray_bounds none = moray_free();
    const moray_phase_spec phases[] = {
        {.nx = 1,
         .nu = FIRST_NU,
         .nc = 1,
         .continuous = first,
         .tf = moray_fixed(1),
         .u = MORAY_BOUNDS(moray_between(-1e4, 1e4)),
         .c = MORAY_BOUNDS(none)},
        {.nx = NX,
         .nu = NU,
         .nc = NC,
         .continuous = second,
         .t0 = moray_fixed(2),
         .tf = moray_fixed(4),
         .u = MORAY_BOUNDS(moray_between(-99, 101), moray_between(-4.05, 50), moray_between(0.98, 1.03),
                           moray_between(-20, 20), moray_between(-3, 30), moray_between(-100, 100)),
         .c = MORAY_BOUNDS(none, none, none)}};
    const moray_ocp_spec spec = {.phases = 2,
                                 .phase = phases,
                                 .ns = NS,
                                 .s = MORAY_BOUNDS(moray_between(-20, 20), moray_between(-1e3, 1e3),
                                                   moray_between(-50, 50), moray_between(-50, 50),
                                                   moray_between(-40, 50), moray_between(-1, 1)),
                                 .ne = 1,
                                 .e = MORAY_BOUNDS(none),
                                 .endpoint = ends};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    struct witness w;
    settings.max_iterations = 0;
    settings.scheme = "radau3";
    CHECK_OK(moray_ocp_new(&ocp, &spec), "two phases");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    set_iterate(solution);
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    check_sizes(&w);
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return tap_done();
}
