// SPDX-License-Identifier: MIT
//
// Multipliers carried from one mesh and scheme to another: densities that are linear in time arrive as they were, and a
// costate that is linear gives the defects what a solution on the new mesh has.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"

#include "ocp/solution.h"

// ---- x'' = u from rest at 0 to rest at 1 with the least integral of u^2 / 2: u = 6 - 12 t ----

static void push(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->c[0] = at->x[0] + at->u[1];
    out->c[1] = at->x[1];
    out->g[0] = at->u[0] * at->u[0] / 2 + at->u[1] * at->u[1];
}

static void effort(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->s[0] * at->s[0] + at->s[1] * at->s[1] + at->phase[0].t0 * at->phase[0].t0;
    out->e[0] = at->phase[0].xf[0];
    out->e[1] = at->phase[0].xf[1];
    out->e[2] = at->s[0] - at->s[1];
}

static moray_ocp *double_integrator(void)
{
    const moray_bounds wide = moray_between(-100, 100);
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 2,
                                    .nc = 2,
                                    .nq = 1,
                                    .continuous = push,
                                    .t0 = moray_between(-1, 1),
                                    .tf = moray_between(0, 2),
                                    .duration = moray_fixed(1),
                                    .x = MORAY_BOUNDS(wide, wide),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .u = MORAY_BOUNDS(wide, wide),
                                    .c = MORAY_BOUNDS(wide, wide)};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "push",
                                                   .phases = 1,
                                                   .phase = &phase,
                                                   .endpoint = effort,
                                                   .ns = 2,
                                                   .s = MORAY_BOUNDS(wide, wide),
                                                   .ne = 3,
                                                   .e = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0), wide)}),
             "double integrator");
    return ocp;
}

static moray_solution *solve(const moray_ocp *ocp, const char *scheme, int intervals)
{
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme;
    settings.intervals = intervals;
    settings.max_refinements = 0;
    settings.tolerance = 1e-10;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), scheme);
    return solution;
}

// ---- What bounds and rows have ----

enum { LOWER, UPPER, PATH };
static const char *const names[] = {"lower bounds", "upper bounds", "path rows"};

static double density(int what, int i, double slope, double tau)
{
    return 1 + 10 * what + i + (2 + what + 3 * i) * slope * tau;
}

static double *multipliers_of(moray_solution *solution, const struct node *node, int what)
{
    moray_iterate *at = &solution->iterate;
    return what == PATH ? at->lambda + node->path : (what == LOWER ? at->z_lower : at->z_upper) + node->x;
}

// Of every state, control and path row density times weight; numbers of their own for the states at the ends and for
// what belongs to no node.
static void set_multipliers(moray_solution *solution, double slope)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[0];
    moray_iterate *at = &solution->iterate;
    const int alone[] = {layout->t0, layout->tf, layout->q, t->layout.s, t->layout.s + 1};
    for (int n = 0; n < layout->nodes; n++)
        for (int what = LOWER; what <= PATH && layout->node[n].collocated; what++)
            for (int i = 0; i < (what == PATH ? 2 : 4); i++)
                multipliers_of(solution, &layout->node[n], what)[i] =
                    layout->node[n].weight * density(what, i, slope, layout->node[n].tau);
    for (int what = LOWER; what <= UPPER; what++)
        for (int i = 0; i < 2; i++) {
            multipliers_of(solution, &layout->node[0], what)[i] = 1000 + 10 * what + i;
            multipliers_of(solution, &layout->node[layout->nodes - 1], what)[i] = 2000 + 10 * what + i;
        }
    for (int k = 0; k < 5; k++) {
        at->z_lower[alone[k]] = 3000 + k;
        at->z_upper[alone[k]] = 4000 + k;
    }
    at->lambda[layout->length_row] = 5000;
    at->lambda[t->layout.events + 2] = 6000;
}

static void check_alone(const moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[0];
    const moray_iterate *at = &solution->iterate;
    const int alone[] = {layout->t0, layout->tf, layout->q, t->layout.s, t->layout.s + 1};
    for (int k = 0; k < 5; k++)
        CHECK(at->z_lower[alone[k]] == 3000 + k && at->z_upper[alone[k]] == 4000 + k,
              "bounds of times, integral and parameters have what they had: %g, %g", at->z_lower[alone[k]],
              at->z_upper[alone[k]]);
    CHECK(at->lambda[layout->length_row] == 5000 && at->lambda[t->layout.events + 2] == 6000,
          "the duration and an event likewise");
    CHECK_NEAR(at->lambda[layout->integral_row], -1, 1e-8, "the integral's is the price of the objective");
}

// The density's time ends where nodes of the old mesh were that had it: inside for the states, which have numbers of
// their own at the ends.
static double had(const struct phase_layout *old, double tau, bool state)
{
    const double first = old->node[state || !old->node[0].collocated].tau, last = old->node[old->nodes - 1 - state].tau;
    return fmin(fmax(first, tau), last);
}

static void check_densities(moray_solution *solution, const struct phase_layout *old, double slope, const char *scheme)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[0];
    for (int what = LOWER; what <= PATH; what++) {
        double worst = 0;
        for (int n = 0; n < layout->nodes; n++)
            for (int i = 0; i < (what == PATH ? 2 : 4) && layout->node[n].collocated; i++) {
                const bool left = n == 0, end = left || n == layout->nodes - 1;
                const double told =
                    end && what != PATH && i < 2
                        ? (left ? 1000 : 2000) + 10 * what + i
                        : layout->node[n].weight *
                              density(what, i, slope, had(old, layout->node[n].tau, what != PATH && i < 2));
                worst = tap_worse(worst, fabs(multipliers_of(solution, &layout->node[n], what)[i] - told));
            }
        CHECK(worst < 1e-12, "%s: %s keep their density: off by %.1e", scheme, names[what], worst);
    }
}

// ---- What the defects have ----

static double defect_error(const moray_solution *carried, const double *solved)
{
    const struct phase_layout *layout = &carried->transcription->layout.phase[0];
    double worst = 0;
    for (int k = 0; k < layout->mesh.intervals; k++)
        for (int i = 0; i < 2 * (layout->interval[k].scheme->points - 1); i++)
            worst = tap_worse(worst, fabs(carried->iterate.lambda[layout->interval[k].defect + i] -
                                          solved[layout->interval[k].defect + i]));
    return worst;
}

static void test_carried(const moray_ocp *ocp, const char *from, const char *to, double slope)
{
    moray_solution *old = solve(ocp, from, 5), *new = solve(ocp, to, 7);
    const struct transcription *t = new->transcription;
    const struct phase_layout *layout = &old->transcription->layout.phase[0];
    double *solved = calloc((size_t)t->nlp.m, sizeof *solved);
    memcpy(solved, new->iterate.lambda, (size_t)t->nlp.m * sizeof *solved);
    memset(new->iterate.lambda, 0, (size_t)t->nlp.m * sizeof *solved);
    memset(new->iterate.z_lower, 0, (size_t)t->nlp.n * sizeof *solved);
    memset(new->iterate.z_upper, 0, (size_t)t->nlp.n * sizeof *solved);
    set_multipliers(old, slope);
    CHECK_OK(moray_carry_multipliers(&(moray_guess){.from = old}, new), "carried");
    check_densities(new, layout, slope, to);
    check_alone(new);
    const double error = defect_error(new, solved);
    CHECK(error < 1e-6, "from %s to %s: defects have what they have when solved: off by %.1e", from, to, error);
    free(solved);
    moray_solution_free(old);
    moray_solution_free(new);
}

// From before times became fixed, on the same mesh and on another: what is left has what it had, and nothing else is
// touched.
static void test_restarted(void)
{
    static const double start[] = {0, 0};
    for (int k = 0; k < 2; k++) {
        moray_ocp *ocp = double_integrator();
        moray_solution *old = solve(ocp, "radau3", 5);
        set_multipliers(old, 1);
        CHECK_OK(moray_ocp_restart(ocp, 0.25, 1, start), "with fixed times");
        moray_solution *new = solve(ocp, "radau3", 5 + k);
        const struct transcription *t = new->transcription;
        const int s = t->layout.s, q = t->layout.phase[0].q;
        double *before = calloc((size_t)(t->nlp.n + t->nlp.m), sizeof *before);
        memcpy(before, new->iterate.x, (size_t)t->nlp.n * sizeof *before);
        memcpy(before + t->nlp.n, new->iterate.g, (size_t)t->nlp.m * sizeof *before);
        CHECK_OK(moray_carry_multipliers(&(moray_guess){.from = old}, new), "carried");
        const moray_iterate *at = &new->iterate;
        CHECK(at->z_lower[q] == 3002 && at->z_upper[q] == 4002 && at->z_lower[s] == 3003 && at->z_upper[s + 1] == 4004,
              "bounds of the integral and of parameters");
        CHECK(at->lambda[t->layout.events + 2] == 6000, "an event");
        check_densities(new, &old->transcription->layout.phase[0], 1, "after a restart");
        CHECK(memcmp(before, at->x, (size_t)t->nlp.n * sizeof *before) == 0 &&
                  memcmp(before + t->nlp.n, at->g, (size_t)t->nlp.m * sizeof *before) == 0,
              "the point stays");
        free(before);
        moray_solution_free(old);
        moray_solution_free(new);
        moray_ocp_free(ocp);
    }
}

int main(void)
{
    static const char *const schemes[] = {"lobatto3", "lobatto4", "radau3", "gauss3"};
    moray_ocp *ocp = double_integrator();
    for (int k = 0; k < 16; k++)
        test_carried(ocp, schemes[k / 4], schemes[k % 4], k < 12);
    moray_ocp_free(ocp);
    test_restarted();
    return tap_done();
}
