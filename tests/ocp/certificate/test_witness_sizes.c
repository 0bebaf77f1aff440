// SPDX-License-Identifier: MIT
//
// Sizes of everything that functions depend on and of what they make of it, in closed form at an iterate set by hand.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/certificate/sizes.h"

enum { NX = 6, NU = 3, NC = 4, NQ = 2, NS = 2, T_SPAN = 2, TIME = NX + NU + NS, OUT = NX + NC + NQ };

// Of a phase from 1 to 3, or back; the second is longer.
static void drive(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num *x = at->x, *u = at->u, *s = at->s;
    (void)data;
    out->f[0] = 2 * u[1] - x[2] / 4;
    out->f[1] = -10 * u[1];
    out->f[2] = (at->t - 4) * u[2];
    out->f[3] = 0;
    out->f[4] = 0;
    out->f[5] = 0;
    out->c[0] = -u[0] * u[0];
    out->c[1] = 3 * x[0] - 0.125 * x[1] + s[0];
    out->c[2] = at->t * 7 - s[0] * 2;
    out->c[3] = 5;
    out->g[0] = 2 * x[0] - 3;
    out->g[1] = 0;
}

static void wait(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->s[1] / 100;
}

static void goal(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].x0[0] - 9 * at->phase[0].xf[0] + at->s[0];
    out->e[0] = 4 * at->phase[1].xf[0] - at->phase[0].q[0] / 2;
}

static double state(int i, double tau)
{
    return i == 0   ? -4 + 3 * tau
           : i == 1 ? tau / 10 - 500
           : i == 3 ? 6 * tau - 3
           : i == 4 ? 0.2 + tau
           : i == 5 ? 1e-9 * tau
                    : 0;
}

static double control(int i, double tau)
{
    return i == 0 ? 2 - 6 * tau : i == 1 ? -0.3 : 1 - 3 * tau;
}

struct reach { // of tau at the nodes that are collocated
    double least, most;
};

// Multipliers: of the last state's defects, with either sign, and of the integral that is 0.
static void set_multipliers(const moray_solution *solution)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[0];
    for (int k = 0; k < layout->mesh.intervals; k++)
        for (int i = 0; i < layout->interval[k].scheme->points - 1; i++)
            solution->iterate.lambda[layout->interval[k].defect + i * NX + NX - 1] = (k % 2 ? -3 : 7) * (100.0 + k);
    solution->iterate.lambda[layout->integral_row + 1] = -1e3;
}

static struct reach set_iterate(moray_solution *solution, bool backwards)
{
    struct transcription *t = solution->transcription;
    struct reach reach = {1, 0};
    memset(solution->iterate.x, 0, (size_t)(4 * t->nlp.n + 2 * t->nlp.m) * sizeof(double));
    for (int p = 0; p < 2; p++)
        for (int n = 0; n < t->layout.phase[p].nodes; n++) {
            const struct node *node = &t->layout.phase[p].node[n];
            double *x = solution->iterate.x + node->x;
            if (p == 1)
                x[0] = 8 - 2 * node->tau;
            for (int i = 0; i < NX && p == 0; i++) // far off where nothing is asked
                x[i] = node->collocated ? state(i, node->tau) : i % 2 ? 1e5 : -1e5;
            for (int i = 0; i < NU && p == 0 && node->collocated; i++)
                x[NX + i] = control(i, node->tau);
            if (p == 0 && node->collocated)
                reach = (struct reach){fmin(reach.least, node->tau), fmax(reach.most, node->tau)};
        }
    solution->iterate.x[t->layout.s] = -2;
    solution->iterate.x[t->layout.s + 1] = 0;
    solution->iterate.x[t->layout.phase[0].t0] = backwards ? 1 + T_SPAN : 1;
    solution->iterate.x[t->layout.phase[0].tf] = backwards ? 1 : 1 + T_SPAN;
    set_multipliers(solution);
    CHECK(moray_transcription_jacobians(t, solution->iterate.x), "finite");
    return reach;
}

static double slope_of(const struct witness *w, int in, int out)
{
    return w->phase[0].slope[in * OUT + out];
}

static double largest_costate(const struct witness *w)
{
    double costate[100 * NX], largest = 0;
    const int nodes = moray_solution_nodes(w->solution, 0, NULL, costate);
    for (int n = 0; n < nodes; n++)
        largest = fmax(largest, fabs(costate[n * NX + NX - 1]));
    CHECK(largest > moray_witness_objective(w), "which is large: %g", largest);
    return largest;
}

static void check_inputs(const struct witness *w, struct reach reach, bool backwards, double near)
{
    const double *size = w->phase[0].size, range = reach.most - reach.least;
    CHECK_RELATIVE(size[0], 3 * range, near, "the range of the first state");
    CHECK_RELATIVE(size[1], 0.5 - 1e-4 * reach.least, near, "a thousandth of one that hardly moves from -500");
    CHECK_RELATIVE(size[2], 0.1 * (3 * range) / (0.25 * T_SPAN), near, "a tenth of what moves the first state");
    CHECK_RELATIVE(size[3], 1.5, near, "no more than its bounds are apart");
    CHECK_RELATIVE(size[4], range, near, "less than its bounds are apart");
    CHECK_RELATIVE(size[5] / 1e-3, fmin(1, moray_witness_objective(w) / largest_costate(w)), near,
                   "a part of what matters by its costate");
    CHECK_RELATIVE(size[NX], 6 * range, near, "the range of the first control");
    CHECK_RELATIVE(size[NX + 1], 0.1 * fmin(3 * range / (2 * T_SPAN), size[1] / (10 * T_SPAN)), near,
                   "a tenth of what moves the state that is moved most easily");
    CHECK_RELATIVE(size[NX + 2], 3 * range, near, "the range of the last control");
    CHECK_RELATIVE(size[NX + NU], 2, near, "a parameter, whatever its sign");
    CHECK_RELATIVE(size[TIME], T_SPAN, near, "the duration");
    CHECK_RELATIVE(w->phase[1].size[3], 5, near, "of the second phase");
    CHECK_RELATIVE(w->duration, 5, near, "of the longest");
    CHECK_RELATIVE(slope_of(w, NX + 1, 0), 2, near, "a slope");
    CHECK_RELATIVE(slope_of(w, NX + 1, 1), 10, near, "one that is negative");
    CHECK_RELATIVE(slope_of(w, 2, 0), 0.25, near, "another");
    CHECK_RELATIVE(slope_of(w, NX + 2, 2), backwards ? 1 + T_SPAN * reach.most : 3 - T_SPAN * reach.least, near,
                   "the largest along the phase");
}

static void check_outputs(const struct witness *w, struct reach reach, double near)
{
    const double *size = w->phase[0].size, *out = w->phase[0].out_size, u = 6 * reach.most - 2;
    const double width = 6 * (reach.most - reach.least), parabola = fmax(u, 2 - 6 * reach.least);
    CHECK_RELATIVE(out[0], fmax(2 * size[NX + 1], size[2] / 4), near, "the larger of two effects");
    CHECK_RELATIVE(out[1], 10 * size[NX + 1], near, "one that is negative");
    CHECK_RELATIVE(out[NX], 2 * parabola * width + 0.1 * width * width, near,
                   "the square to the side where it is steep");
    CHECK_RELATIVE(out[NX + 1], fmax(3 * size[0], size[NX + NU]), near, "the largest of three");
    CHECK_RELATIVE(out[NX + 2], 14, near, "the time moves it more than the parameter");
    CHECK(out[NX + 3] == 0, "nothing moves a constant: %g", out[NX + 3]);
    CHECK_RELATIVE(w->phase[0].integral[0], T_SPAN * (2 * 2.5 + 3) + T_SPAN * 2 * size[0], near,
                   "the integral of |g|, and of what moves it");
    CHECK_RELATIVE(w->phase[0].integral[1] * 1e6, moray_witness_objective(w), near, "what matters by its multiplier");
    CHECK_RELATIVE(moray_witness_objective(w), 9 * size[0], near, "the state at the end moves the objective most");
    CHECK_RELATIVE(w->end_out_size[1], fmax(4 * w->phase[1].size[0], w->phase[0].integral[0] / 2), near, "an event");
}

static void test_sizes(bool differences, bool backwards)
{
    const moray_bounds none = moray_free(), narrow = moray_between(-0.5, 1), fits = moray_between(-4, 2.5);
    const moray_phase_spec phases[] = {{.nx = NX,
                                        .nu = NU,
                                        .nc = NC,
                                        .nq = NQ,
                                        .continuous = drive,
                                        .t0 = moray_between(0, 9),
                                        .tf = moray_between(0, 9),
                                        .x = MORAY_BOUNDS(none, none, none, narrow, fits, none),
                                        .c = MORAY_BOUNDS(none, none, none, none)},
                                       {.nx = 1, .continuous = wait, .t0 = moray_fixed(3), .tf = moray_fixed(8)}};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    struct witness w;
    settings.max_iterations = 0;
    settings.intervals = 6;
    CHECK_OK(
        moray_ocp_new(&ocp,
                      &(moray_ocp_spec){
                          .phases = 2, .phase = phases, .ns = NS, .ne = 1, .e = MORAY_BOUNDS(none), .endpoint = goal}),
        "problem");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    const struct reach reach = set_iterate(solution, backwards);
    CHECK_OK(differences ? moray_witness_new(&w, solution) : moray_witness_of_sizes(&w, solution), "sizes");
    check_inputs(&w, reach, backwards, 1e-7);
    check_outputs(&w, reach, 1e-7);
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    for (int k = 0; k < 4; k++)
        test_sizes(k % 2, k / 2);
    return tap_done();
}
