// SPDX-License-Identifier: MIT
//
// The multipliers of a solution as a start on another mesh and scheme, against those that a solve there finds.
#include "tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "ocp/solution.h"

// x' = v, v' = u, y' = w of least integral of u^2 + y + w^2 + p^2 + r^2 + z^2, where z = x + v, y >= 0 and p >= 1 are
// at their limits throughout: multipliers have smooth densities. Where the endpoint reads controls, two have a price
// there: r, which r >= 0 holds, and u.
enum { phases = 3, states = 3, controls = 5, U = 0, Z = 1, P = 3, R = 4 };

static void plant(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *x = at->x, *u = at->u;
    out->f[0] = x[1];
    out->f[1] = u[U];
    out->f[2] = u[2];
    out->c[0] = u[Z] - x[0] - x[1];
    out->g[0] = u[U] * u[U] + x[2] + u[Z] * u[Z] + u[2] * u[2] + u[P] * u[P] + u[R] * u[R];
    out->g[1] = u[Z];
}

// Each phase is to last long and to begin soon; one parameter is to be small, the other large.
static void verdict(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = 3 * at->s[0] - 2 * at->s[1];
    for (int p = 0; p < phases; p++) {
        const moray_phase_ends *end = &at->phase[p];
        out->objective += (p + 1) * end->q[0] + (p + 1) * end->t0 - 20 * (end->tf - end->t0);
        if (end->u0)
            out->objective += end->u0[R] - 1e-4 * end->uf[U];
        out->e[p] = end->xf[0];
    }
}

static moray_ocp *build(void)
{
    const moray_bounds free = moray_free(), above[controls] = {free, free, free, free, moray_at_least(0)},
                       tight[controls] = {free, free, free, moray_between(1, 5), free};
    const moray_phase_spec base = {.nx = states,
                                   .nu = controls,
                                   .nc = 1,
                                   .nq = 2,
                                   .continuous = plant,
                                   .t0 = moray_between(0.2, 1),
                                   .tf = moray_between(0.5, 4),
                                   .duration = moray_between(0.5, 1.5),
                                   .x = MORAY_BOUNDS(free, free, moray_at_least(0)),
                                   .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0.3), moray_fixed(0)),
                                   .c = MORAY_BOUNDS(moray_fixed(0)),
                                   .q = MORAY_BOUNDS(free, moray_at_most(5))};
    moray_phase_spec phase[phases] = {base, base, base};
    phase[0].u = (moray_bounds_list){above, controls}, phase[0].end_controls = true;
    phase[1].u = (moray_bounds_list){tight, controls}, phase[1].tf = moray_between(0.5, 1.2);
    phase[2].u0 = (moray_bounds_list){above, controls}, phase[2].end_controls = true;
    moray_ocp *ocp = NULL;
    CHECK_OK(
        moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "carried",
                                              .phases = phases,
                                              .phase = phase,
                                              .endpoint = verdict,
                                              .ns = 2,
                                              .s = MORAY_BOUNDS(moray_between(0.5, 2), moray_between(0.5, 2)),
                                              .ne = phases,
                                              .e = MORAY_BOUNDS(moray_fixed(3), moray_at_least(4), moray_fixed(2))}),
        "a problem with multipliers of every kind");
    return ocp;
}

static moray_solution *solve(moray_ocp *ocp, const char *scheme, int intervals)
{
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.scheme = scheme;
    settings.intervals = intervals;
    settings.max_refinements = 0;
    settings.tolerance = 1e-10;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), scheme);
    CHECK(moray_is_solved(solution), "solved with %s on %d intervals", scheme, intervals);
    return solution;
}

enum { z_lower, z_upper, rows, kinds };
struct multipliers {
    double *of[kinds];
};

static struct multipliers multipliers_of(const moray_solution *solution)
{
    const moray_iterate *at = &solution->iterate;
    return (struct multipliers){{at->z_lower, at->z_upper, at->lambda}};
}

static void copy(const moray_solution *solution, struct multipliers to, struct multipliers from)
{
    const struct layout *layout = &solution->transcription->layout;
    for (int kind = 0; kind < kinds; kind++)
        memcpy(to.of[kind], from.of[kind], (size_t)(kind == rows ? layout->rows : layout->columns) * sizeof(double));
}

static struct multipliers blank(const moray_solution *solution)
{
    const struct layout *layout = &solution->transcription->layout;
    return (struct multipliers){{calloc((size_t)layout->columns, sizeof(double)),
                                 calloc((size_t)layout->columns, sizeof(double)),
                                 calloc((size_t)layout->rows, sizeof(double))}};
}

static void drop(struct multipliers all)
{
    for (int kind = 0; kind < kinds; kind++)
        free(all.of[kind]);
}

static const double left = 3e-6; // by which an interior point misses of a multiplier

// Entries from..to - 1 are those wanted, within a part of the largest of these; or with NULL, 0.
static void check(const double *got, const double *want, int from, int to, double part, const char *what)
{
    double worst = 0, largest = 0;
    for (int i = from; i < to; i++) {
        const double miss = fabs(got[i] - (want ? want[i] : 0));
        worst = tap_worse(worst, miss);
        largest = fmax(largest, want ? fabs(want[i]) : 0);
    }
    if (!(worst <= part * largest + left)) // there are thousands
        CHECK(false, "%s: %.1e away, of %.1e", what, worst, largest);
}

// What the endpoint asks of controls at an end: of a node, or of columns of their own.
static void check_end(const struct phase_layout *old, const struct phase_layout *new, int p, int end,
                      struct multipliers got, struct multipliers want)
{
    const int row = new->u_row[end], column = new->u_end[end];
    const bool both = row != absent && old->u_row[end] != absent;
    if (row != absent)
        check(got.of[rows], both ? want.of[rows] : NULL, row, row + controls, 1e-3, "what defines a control at an end");
    if (both || p == 2)
        check(got.of[z_lower], want.of[z_lower], column, column + controls, 1e-3, "bounds of a control at an end");
}

// Bounds of controls, and between the ends, of the state that is held, where the solver's own are smooth.
static void check_nodes(const struct phase_layout *new, const double *got, const double *want, bool smooth)
{
    for (int n = 0; n < new->nodes; n++) {
        const int x = new->node[n].x;
        if (smooth && n > 0 && n < new->nodes - 1)
            check(got, want, x, x + states, 0.05, "bounds of states");
        if (new->node[n].collocated)
            check(got, want, x + states, x + states + controls, 1e-3, "bounds of controls");
    }
}

static void check_phase(const struct phase_layout *old, const struct phase_layout *new, int p, struct multipliers got,
                        struct multipliers want, bool smooth)
{
    const double *lambda = want.of[rows];
    check(got.of[rows], lambda, new->node[0].path, new->interval[0].defect, 5e-3, "path constraints");
    check(got.of[rows], lambda, new->interval[0].defect, new->integral_row, 1e-3, "the dynamics");
    check(got.of[rows], lambda, new->integral_row, new->integral_row + 2, 1e-6, "integrals");
    check(got.of[rows], lambda, new->length_row, new->length_row + 1, 1e-6, "the duration");
    for (int end = 0; end < 2; end++)
        check_end(old, new, p, end, got, want);
    for (int side = z_lower; side <= z_upper; side++) {
        if (p == 1) // at the ends of the others a price disturbs the densities
            check_nodes(new, got.of[side], want.of[side], smooth);
        for (int r = 0; r < 2; r++) // where the third is held, two bounds share
            check(got.of[side], want.of[side], new->node[0].x + r, new->node[0].x + r + 1, 1e-3, "states at the start");
        check(got.of[side], want.of[side], new->q, new->q + 2, 1e-6, "bounds of integrals");
        check(got.of[side], want.of[side], new->t0, new->t0 + 1, 1e-6, "those of the start");
        check(got.of[side], want.of[side], new->tf, new->tf + 1, 1e-6, "those of the end");
    }
}

static void check_carried(const moray_solution *from, moray_solution *to, bool smooth)
{
    const struct layout *old = &from->transcription->layout, *new = &to->transcription->layout;
    const moray_guess guess = moray_guess_from_solution(from);
    const struct multipliers got = multipliers_of(to), want = blank(to), none = blank(to);
    copy(to, want, got);
    copy(to, got, none);
    CHECK_OK(moray_carry_multipliers(&guess, to), to->settings.scheme);
    for (int p = 0; p < phases; p++)
        check_phase(&old->phase[p], &new->phase[p], p, got, want, smooth);
    check(got.of[rows], want.of[rows], new->events, new->rows, 1e-6, "events");
    for (int side = z_lower; side <= z_upper; side++)
        check(got.of[side], want.of[side], new->s, new->s + 2, 1e-6, "bounds of parameters");
    copy(to, got, want);
    drop(want);
    drop(none);
}

// By time, where the new phases begin later: densities are those of the old at the same times, by what the problem
// says, 2 p of the bound of p and -2 z of the constraint on z, times the weight of the phase in the objective.
static void check_along_time(const moray_solution *from, moray_solution *to)
{
    const struct layout *layout = &to->transcription->layout;
    const moray_guess guess = {.from = from, .along_time = true};
    for (int p = 1; p < phases; p++) {
        const struct phase_layout *phase = &layout->phase[p];
        double *begin = &to->iterate.x[phase->t0], first, last;
        moray_solution_times(from, p, &first, &last);
        const double old = *begin, start = first + 0.4 * (last - first);
        *begin = start;
        CHECK_OK(moray_carry_multipliers(&guess, to), "by time");
        *begin = old;
        double worst = 0;
        for (int n = 1; n < phase->nodes; n++) {
            const struct node *node = &phase->node[n];
            const double weight = (p + 1) * node->weight * (last - start);
            double x[states], u[controls];
            moray_solution_at(from, p, start + (last - start) * node->tau, x, u);
            const double off = p == 1 ? to->iterate.z_lower[node->x + states + P] / weight - 2 * u[P]
                                      : to->iterate.lambda[node->path] / weight + 2 * u[Z];
            worst = tap_worse(worst, isnan(off) ? INFINITY : fabs(off));
        }
        CHECK(worst < 2e-3, "densities at the times of phase %d are %.1e away", p, worst);
    }
}

int main(void)
{
    enum { n = 4 };
    static const char *const scheme[n] = {"hermite-simpson", "lobatto4", "radau3", "gauss3"};
    static const bool smooth[n] = {false, true, true, false}; // else multipliers of a held state alternate
    moray_ocp *ocp = build();
    moray_solution *coarse[n], *fine[n];
    for (int k = 0; k < n; k++) {
        coarse[k] = solve(ocp, scheme[k], 30);
        fine[k] = solve(ocp, scheme[k], 41);
    }
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            check_carried(coarse[i], fine[k], smooth[i] && smooth[k]);
        }
    moray_solution *same = solve(ocp, scheme[2], 30);
    check_along_time(coarse[2], fine[2]);
    check_along_time(coarse[2], same);
    moray_solution_free(same);
    for (int k = 0; k < n; k++) {
        moray_solution_free(coarse[k]);
        moray_solution_free(fine[k]);
    }
    moray_ocp_free(ocp);
    return tap_done();
}
