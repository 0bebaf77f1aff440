// SPDX-License-Identifier: MIT
//
// Periodic orbits of any plant x' = f(x, s, t): found by Newton's method on a collocation of one period, with their
// derivatives and their stability.
#ifndef MORAY_CONTROL_PERIODIC_ORBIT_H
#define MORAY_CONTROL_PERIODIC_ORBIT_H

#include "moray/export.h"
#include "moray/num.h"
#include "moray/map.h"

MORAY_BEGIN

// Parameters p = [s, T] of an orbit: those of the plant, ns, and behind them the period T. Some of them may be unknown,
// and so may be further quantities w, nw, that only the closing conditions know (an angle by which the orbit turns):
//     closing(x(0), x(T), s, T, w) = 0,
// nx conditions and one more for each unknown: n_found + nw. An autonomous plant has its period found and one condition
// that says where on the orbit t = 0 is.
typedef struct moray_periodic_orbit_spec {
    int nx, ns, nw;
    const moray_map *plant;   // in = [x (nx), s (ns), t], out = [f (nx), further outputs]; must outlive the orbit
    const moray_map *closing; // in = [x(0), x(T), s, T, w], out [nx + n_found + nw]; must outlive the orbit
    const int *found;         // [n_found] entries of p that are unknown, ascending; ns is the period
    int n_found;
    const double *scale; // [nx] typical sizes of the states, in which defects are measured; NULL: 1
    const char *scheme;  // "lobatto5", ...
    int intervals;       // of equal length, 1 to 10000
} moray_periodic_orbit_spec;

// Closing conditions of the simple kind.
typedef enum {
    MORAY_CLOSE_RETURNS, // x(T) - x(0) = value: 0, or what the state advances by in a period
    MORAY_CLOSE_STARTS   // x(0) = value: an anchor, as of a state that advances by whatever it does
} moray_closing_kind;
typedef struct moray_closing_condition {
    moray_closing_kind kind;
    int state;
    double value;
} moray_closing_condition;

// The map of n such conditions for nx states, ns parameters and no w; release with moray_map_release. Error:
// MORAY_INPUT for a state out of range, MORAY_MEMORY.
MORAY_API moray_status moray_closing_map(moray_map *map, int nx, int ns, const moray_closing_condition *condition,
                                         int n);

typedef struct moray_periodic_orbit moray_periodic_orbit; // the last orbit found; not for two threads at once

// Copies the spec, not the maps. Error: MORAY_INPUT for sizes that do not agree, a scheme or mesh that is not allowed,
// conditions that no values could make determine the orbit; MORAY_MEMORY. Free with moray_periodic_orbit_free.
MORAY_API moray_status moray_periodic_orbit_new(moray_periodic_orbit **orbit, const moray_periodic_orbit_spec *spec);
MORAY_API void moray_periodic_orbit_free(moray_periodic_orbit *orbit);

// Where a search begins: the state x[nx] at times 0 <= t <= T, and w.
typedef struct moray_periodic_orbit_guess {
    void (*state)(double t, double *x, const void *self);
    const void *self;
    const double *w; // [nw]; NULL where there are none
} moray_periodic_orbit_guess;

typedef struct moray_periodic_orbit_info {
    int iterations;  // of Newton's method, by slopes of its own or, where these do, of a point before
    int slopes;      // how many had their own
    double residual; // largest defect that is left, in units of the states' scale, or condition
} moray_periodic_orbit_info;

// Finds the orbit with parameters p[ns + 1], of which those unknown are where the search begins; guess NULL: begins
// from the last orbit found, unknowns included. Defects and conditions are brought below 1e-11. *info is filled in
// every case. Error: MORAY_INPUT (p, no orbit to begin from), MORAY_MEMORY, MORAY_NUMERIC; MORAY_NOT_SOLVED when no
// orbit is found: there is then no last orbit.
MORAY_API moray_status moray_periodic_orbit_solve(moray_periodic_orbit *orbit, const double *p,
                                                  const moray_periodic_orbit_guess *guess,
                                                  moray_periodic_orbit_info *info);

// ---- The last orbit found ------------------------------------------------------------------------------------------
//
// Without one these give NULL or NaN, and status MORAY_INPUT.

// p[ns + 1], with what was found.
MORAY_API const double *moray_periodic_orbit_parameters(const moray_periodic_orbit *orbit);
MORAY_API const double *moray_periodic_orbit_unknowns(const moray_periodic_orbit *orbit); // w[nw]

// State x[nx] at 0 <= t <= T, and the integral of output `row` of the plant from 0 to t, from the collocation
// polynomials.
MORAY_API void moray_periodic_orbit_state(moray_periodic_orbit *orbit, double t, double *x);
MORAY_API double moray_periodic_orbit_integral(moray_periodic_orbit *orbit, int row, double t);

// Derivatives dq/dp[ns + 1] of a quantity by the parameters, at constant phase t/T, by the implicit function theorem:
// one solve with the transposed factors each. Those by what is found are 0. Error: MORAY_INPUT also for a row or time
// out of range; MORAY_MEMORY, MORAY_NUMERIC.
//
// q(x(0), x(T), p, w), given its own derivatives `slope` by these, in this order.
MORAY_API moray_status moray_periodic_orbit_ends_gradient(moray_periodic_orbit *orbit, const double *slope, double *by);
// Mean over the period of output `row` of the plant.
MORAY_API moray_status moray_periodic_orbit_mean_gradient(moray_periodic_orbit *orbit, int row, double *by);
// q(x(t), s, t) at the phase of 0 <= t <= T, given its own derivatives `slope`[nx + ns + 1] by these.
MORAY_API moray_status moray_periodic_orbit_point_gradient(moray_periodic_orbit *orbit, const double *slope, double t,
                                                           double *by);
// Output `row` at the phase of 0 <= t <= T.
MORAY_API moray_status moray_periodic_orbit_output_gradient(moray_periodic_orbit *orbit, int row, double t, double *by);

// The monodromy matrix M[nx][nx] = d x(T) / d x(0), and its eigenvalues, the Floquet multipliers lambda[nx], the
// largest in modulus first: how a small deviation has grown after a period. An autonomous plant has one that is 1.
// Error: MORAY_MEMORY, MORAY_NUMERIC.
MORAY_API moray_status moray_periodic_orbit_monodromy(moray_periodic_orbit *orbit, double *M);
MORAY_API moray_status moray_periodic_orbit_multipliers(moray_periodic_orbit *orbit, moray_num *lambda);

MORAY_END

#endif
