// SPDX-License-Identifier: MIT
//
// Multipliers of bounds, path constraints and ends, costates and Hamiltonian of a problem in which all are known: what
// a price that changes with time pushes against a limit has that price for its multiplier.
#include "tap.h"

#include <stdlib.h>

#include "moray/ocp.h"
#include "ocp/solution.h"

enum { most_nodes = 99 };
enum { nx = 4, nu = 7, nc = 2, held = 6 };

// Prices of two bounded controls, two controls under path constraints, a bounded state, by time.
static double price(int k, double t)
{
    static const double at[] = {1, 2, 3, 1.5, 0.7}, slope[] = {0.5, -0.3, 0.2, 0.4, 0.1};
    return at[k] + slope[k] * t;
}

// States 0 and 1 are driven against limits at their ends, 2 is held at its limit, 3 stays.
static void plant(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *u = at->u, t = at->t;
    out->f[0] = u[4];
    out->f[1] = u[5];
    out->f[2] = u[held];
    out->f[3] = 0 * u[0];
    for (int k = 0; k < nc; k++)
        out->c[k] = u[2 + k];
    out->g[0] = (1 + 0.5 * t) * u[0] - (2 - 0.3 * t) * u[1] - (3 + 0.2 * t) * u[2] - (1.5 + 0.4 * t) * u[3] -
                (0.7 + 0.1 * t) * at->x[2];
    out->g[1] = (u[4] * u[4] + u[5] * u[5]) / 2;
}

static const double begin = 0.5, end = 2.5, twice = 2; // the weight of the second integral
static const double bring[2] = {-9, -11}, fetch[2] = {12, 14}, from[2] = {-1, 0.5}, to[2] = {3, 2.5};

static void verdict(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_phase_ends *phase = &at->phase[1];
    out->objective = phase->q[0] + twice * phase->q[1];
    for (int r = 0; r < 2; r++)
        out->objective -= bring[r] * phase->x0[r] + fetch[r] * phase->xf[r];
}

static void idle(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->x[0];
}

// Before it there is a phase that does nothing, so that no column or row is the first. own: one control has bounds of
// its own at the end, which where an end is no node would take part of the multipliers beside it.
static moray_solution *solve(moray_ocp **ocp, const char *scheme, bool own)
{
    const moray_bounds free = moray_free(), fixed = moray_fixed(1), most = moray_at_most(1);
    const moray_bounds last[nu] = {{-1, 2}, {-3, 1}, free, free, free, {-100, 100}, {-9, 9}};
    const moray_phase_spec phase[2] = {
        {.nx = 1, .continuous = idle, .tf = moray_fixed(0.5), .x0 = MORAY_BOUNDS(fixed)},
        {.nx = nx,
         .nu = nu,
         .nc = nc,
         .nq = 2,
         .continuous = plant,
         .t0 = moray_fixed(begin),
         .tf = moray_fixed(end),
         .x = MORAY_BOUNDS(free, free, most, free),
         .x0 = MORAY_BOUNDS(moray_between(from[0], 8), moray_between(from[1], 8), fixed, fixed),
         .xf = MORAY_BOUNDS(moray_between(-8, to[0]), moray_between(-8, to[1]), fixed, free),
         .u = MORAY_BOUNDS(moray_between(-1, 2), moray_between(-3, 1), free, free, free, free, moray_between(-9, 9)),
         .uf = {last, own ? nu : 0},
         .c = MORAY_BOUNDS(moray_at_most(0.5), moray_at_most(0.25))}};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.scheme = scheme;
    settings.intervals = 8;
    settings.max_refinements = 0;
    settings.tolerance = 1e-10;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2, .phase = phase, .endpoint = verdict}), "problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "solve");
    CHECK(moray_is_solved(solution), "%s: solved", scheme);
    return solution;
}

static double worse(double worst, double found, double expected)
{
    return tap_worse(worst, fabs(found - expected));
}

// apart: nodes that are not collocated.
static void check_along(const moray_solution *solution, const char *scheme, int apart)
{
    double time[most_nodes], costate[most_nodes * nx], c[most_nodes * nc], x[most_nodes * nx], u[most_nodes * nu],
        H[most_nodes];
    double limits = 0, costates = 0, drift = 0;
    int none = 0, held_back = 0;
    const int nodes = moray_solution_nodes(solution, 1, time, costate);
    CHECK(moray_solution_multipliers(solution, 1, c, x, u) == nodes &&
              moray_solution_hamiltonian(solution, 1, H) == nodes,
          "as many as nodes");
    for (int n = 0; n < nodes; n++) {
        const double t = time[n];
        double level = price(0, t) * -1 - price(1, t) - price(2, t) * 0.5 - price(3, t) * 0.25 - price(4, t);
        for (int r = 0; r < 2; r++) {
            const double rate = (to[r] - from[r]) / (end - begin); // of the least effort
            costates = worse(costates, costate[n * nx + r], -twice * rate);
            level += twice * rate * rate / 2 - twice * rate * rate;
        }
        costates = worse(costates, costate[n * nx + 3], 0);
        if (isnan(u[n * nu])) {
            none += isnan(H[n]) && isnan(c[n * nc + 1]);
            continue;
        }
        drift = worse(drift, H[n], level);
        for (int k = 0; k < 2; k++) {
            limits = worse(limits, u[n * nu + k], k ? price(1, t) : -price(0, t));
            limits = worse(limits, c[n * nc + k], price(2 + k, t));
            if (n < nodes - 1)
                limits = worse(limits, u[n * nu + 4 + k], 0);
        }
    }
    CHECK(limits < 1e-5, "%s: multipliers of limits to %.1e", scheme, limits);
    CHECK(costates < 1e-5, "%s: costates to %.1e", scheme, costates);
    CHECK(drift < 1e-4, "%s: Hamiltonian to %.1e", scheme, drift);
    const double *ending = u + (nodes - 1) * nu;
    CHECK(apart > 0 || (isnan(ending[5]) && !isnan(ending[4])), "%s: none of a control of own bounds at the end",
          scheme);
    CHECK(none == apart, "%s: none at %d nodes", scheme, none);
    for (int n = 1; n < nodes - 1; n++)
        held_back += x[n * nx + 2] > 0 && fabs(x[n * nx]) < 1e-6;
    CHECK(held_back >= nodes - 1 - apart - 1 && isnan(x[2]) && isnan(x[(nodes - 1) * nx + 2]),
          "%s: the state's bound pushes between the ends, at %d of %d nodes", scheme, held_back, nodes);
}

// At an end the costate, the price and the multiplier of the bound balance.
static void check_ends(const moray_solution *solution, const char *scheme)
{
    double x0[nx], xf[nx];
    moray_solution_end_multipliers(solution, 1, x0, xf);
    for (int r = 0; r < 2; r++) {
        const double costate = -twice * (to[r] - from[r]) / (end - begin);
        CHECK(fabs(x0[r] - (bring[r] - costate)) < 1e-5, "%s: start of state %d: %g", scheme, r, x0[r]);
        CHECK(fabs(xf[r] - (fetch[r] + costate)) < 1e-5, "%s: end of state %d: %g", scheme, r, xf[r]);
    }
    CHECK(isnan(x0[2]) && isnan(x0[3]) && isnan(xf[2]), "%s: none where a state is fixed", scheme);
    CHECK(fabs(xf[3]) < 1e-6, "%s: nor where it is free", scheme);
    double other[nx];
    moray_solution_end_multipliers(solution, 1, NULL, other);
    CHECK(other[1] == xf[1], "one end alone");
    moray_solution_end_multipliers(solution, 1, other, NULL);
    CHECK(other[1] == x0[1], "the other");
}

int main(void)
{
    static const char *const schemes[] = {"lobatto4", "radau3", "gauss3", "hermite-simpson"};
    static const int apart[] = {0, 1, 9, 0};
    for (int k = 0; k < 4; k++) {
        moray_ocp *ocp = NULL;
        moray_solution *solution = solve(&ocp, schemes[k], apart[k] == 0);
        check_along(solution, schemes[k], apart[k]);
        check_ends(solution, schemes[k]);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    return tap_done();
}
