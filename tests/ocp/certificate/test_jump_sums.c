// SPDX-License-Identifier: MIT
//
// Jumps with a state, summed over a phase in closed form: of the control that shows them most, each where it is passed.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/certificate/unseen.h"

enum { NX = 2, NU = 1, NC = 1, NQ = 1, OUT = NX + NC + NQ, INTERVALS = 3, JUMPS = 5 };
static const double mesh[] = {0, 0.25, 0.6, 1}, start = 3, T = 2, middle = 0.1;

// Where the first state passes, and by how much the second rate and the integrand then jump, in parts of the control.
struct jump {
    double tau, f, g;
};
static const struct jump jumps[JUMPS] = {
    {1e-4, 9, 9},                          // before the first point
    {0.1234, 3, -2}, {0.2501, -1.5, 0},    // just behind an edge, before its first point
    {0.7123, 0, 4},  {0.9071, -0.7, -1.3}, // in the same interval
};

struct curve {
    double square, cube, ramp, broad; // of the second rate, smooth; a ramp that is `broad` in tau
    bool undefined;                   // with the largest control
};
static bool begun; // before that all is defined

static double state_at(double tau)
{
    return 5 * tau - 1;
}

static void stairs(const moray_node *at, moray_rates *out, const void *data)
{
    const struct curve *curve = data;
    const moray_num u = at->u[0] - middle, x = at->x[0];
    const double far = (creal(x) - state_at(0.45)) / 5 / fmax(curve->broad, 1e-300);
    moray_num f = curve->square * x * x + curve->cube * x * x * x + curve->ramp * fmin(fmax(far, 0), 1), g = 0;
    for (int k = 0; k < JUMPS; k++)
        if (creal(x) > state_at(jumps[k].tau)) {
            f += jumps[k].f;
            g += jumps[k].g;
        }
    out->f[0] = 5 / T + (curve->undefined && begun && creal(u) > 0.01 ? NAN : 0);
    out->f[1] = u * f;
    out->c[0] = begun && creal(x) > 0 && fabs(creal(u)) > 1e-9 ? NAN : 0; // which has no price
    out->g[0] = u * g;
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[0].xf[1];
}

static void set_iterate(moray_solution *solution, unsigned long long *seed)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[0];
    memset(solution->iterate.x, 0, (size_t)(4 * t->nlp.n + 2 * t->nlp.m) * sizeof(double));
    for (int n = 0; n < layout->nodes; n++) {
        solution->iterate.x[layout->node[n].x] = state_at(layout->node[n].tau);
        solution->iterate.x[layout->node[n].x + 1] = -8;
        if (layout->node[n].collocated)
            solution->iterate.x[layout->node[n].x + NX] = middle;
    }
    for (int i = 0; i < t->nlp.m; i++)
        solution->iterate.lambda[i] = tap_random(seed, -2, 0.5);
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
}

// By the larger of both controls' distances to where nothing jumps; of an interval, by its prices.
static double expect(const struct unseen *u, int k, double objective, bool undefined)
{
    const double behind = fabs(u->control[0][0] - middle), ahead = fabs(u->control[1][0] - middle);
    double sum = 0;
    for (int j = 1; j < JUMPS; j++)
        if (jumps[j].tau > mesh[k] && jumps[j].tau <= mesh[k + 1])
            sum += u->price[1] * fabs(jumps[j].f) + u->price[NX + NC] * fabs(jumps[j].g);
    return sum * (undefined ? behind : fmax(behind, ahead)) * T / objective;
}

static void test_stairs(const struct curve *curve, moray_bounds control, double within)
{
    static const double objective = 0.4;
    const moray_bounds none = moray_free();
    const moray_phase_spec phase = {.nx = NX,
                                    .nu = NU,
                                    .nc = NC,
                                    .nq = NQ,
                                    .continuous = stairs,
                                    .t0 = moray_fixed(start),
                                    .tf = moray_fixed(start + T),
                                    .mesh = mesh,
                                    .intervals = INTERVALS,
                                    .u = MORAY_BOUNDS(control),
                                    .c = MORAY_BOUNDS(none)};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    struct witness w;
    struct examiner e;
    struct unseen u;
    unsigned long long seed = 3;
    begun = false;
    settings.max_iterations = 0;
    settings.scheme = "radau3";
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = total, .data = curve}),
             "stairs");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    begun = true;
    set_iterate(solution, &seed);
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    w.phase[0].size[NX] = 3;
    CHECK_OK(moray_examiner_new(&e, &w, 0), "examiner");
    CHECK_OK(moray_unseen_new(&u, &e), "effects");
    for (int k = 0; k < INTERVALS; k++) {
        double found = -1, where;
        moray_unseen_interval(&u, &solution->transcription->layout.phase[0].interval[k], objective, &found, &where);
        CHECK_RELATIVE(found, expect(&u, k, objective, curve->undefined), within, "the jumps of an interval");
    }
    moray_unseen_free(&u);
    moray_examiner_free(&e);
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    const moray_bounds up = moray_between(-0.4, 9), down = moray_between(-9, 0.3);
    test_stairs(&(struct curve){0}, up, 1e-9);
    test_stairs(&(struct curve){0}, down, 1e-9);
    test_stairs(&(struct curve){.undefined = true}, down, 1e-9);
    test_stairs(&(struct curve){.undefined = true}, up, 1e-9);
    test_stairs(&(struct curve){.square = 40}, up, 1e-8); // slopes at both ends tell what a parabola makes
    test_stairs(&(struct curve){.square = -40, .cube = 10}, up, 5e-4);
    for (int sign = -1; sign <= 1; sign += 2) { // steep, but no jump
        test_stairs(&(struct curve){.ramp = 6 * sign, .broad = 1e-4}, up, 0.02);
        test_stairs(&(struct curve){.ramp = 6 * sign, .broad = 1e-3}, down, 0.02);
    }
    return tap_done();
}
