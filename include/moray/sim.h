// SPDX-License-Identifier: MIT
//
// Forward simulation of ordinary differential equations: a lean explicit method, and SUNDIALS ARKODE.
#ifndef MORAY_SIM_H
#define MORAY_SIM_H

#include "moray/ode.h"

typedef enum {
    MORAY_SIM_EXPLICIT, // Runge-Kutta of order 8 with an error estimate of order 7 (Prince & Dormand 1981, RK8(7)13M)
    MORAY_SIM_ARKODE,   // the same method in ARKODE, several times slower: the check of the one above
    MORAY_SIM_TR_BDF2   // ARKODE; order 2, L-stable: MATLAB's ode23tb, with which the paper integrates
} moray_sim_method;

typedef struct moray_sim_settings {
    moray_sim_method method; // MORAY_SIM_EXPLICIT
    double rtol, atol;       // 1e-10, 1e-10; local error of a step against rtol |x_i| + atol
    double max_step;         // 0: no limit [unit of t]
    long max_steps;          // 1000000; limit between two stops
} moray_sim_settings;

moray_sim_settings moray_sim_settings_default(void); // the values in the comments above
moray_sim_settings moray_sim_settings_paper(void);   // TR-BDF2 at 1e-4 (Sec. V)

// Error: MORAY_INPUT naming the first setting that is not usable, its value and what is allowed.
moray_status moray_sim_settings_check(const moray_sim_settings *settings);

// One equation, its integrator and their memory; not for two threads at once.
typedef struct moray_sim moray_sim;

// Makes a simulator; copies *ode and *settings, ode->self stays the caller's. No state yet: moray_sim_start.
// Error: MORAY_INPUT, MORAY_MEMORY.
moray_status moray_sim_new(moray_sim **sim, const moray_ode *ode, const moray_sim_settings *settings);
void moray_sim_free(moray_sim *sim);

// Sets time and state x[n] and forgets the past. Call it too, with moray_sim_time and moray_sim_state, after anything
// has changed the right-hand side: the derivative at the last stop is otherwise used again. Error: MORAY_NUMERIC.
moray_status moray_sim_start(moray_sim *sim, double t, const double *x);

// Integrates to exactly t >= moray_sim_time: no step crosses t and the right-hand side is never asked beyond it, so
// that discontinuities belong at stops. (At t itself it is asked before the stop and after: let a jump be made by the
// caller between the two calls, not by a comparison of times.) A trial step on which the right-hand side returns false
// or is not finite is taken again with shorter ones. Errors: MORAY_INPUT (t in the past); MORAY_NUMERIC saying what
// failed and at which t. After an error the simulator stands at the last state reached; start it again before
// advancing.
moray_status moray_sim_advance(moray_sim *sim, double t);

double moray_sim_time(const moray_sim *sim);
const double *moray_sim_state(const moray_sim *sim); // x[n] at that time; the simulator's own, changes with it

// Since moray_sim_new.
typedef struct moray_sim_statistics {
    long steps, rhs_evaluations;
} moray_sim_statistics;
moray_sim_statistics moray_sim_get_statistics(const moray_sim *sim);

// An integrator for others to use, which makes a simulator for each run. It stops exactly at every observed time: the
// best of ARKODE's interpolants is wrong by 4e-6 where the steps are good to 1e-10 (harmonic oscillator, tolerances
// 1e-9). *settings stays the caller's and must outlive the integrator. When the observer stops the run, the status is
// ok and x the state last observed; after an error x is the state last reached.
moray_integrator moray_sim_integrator(const moray_sim_settings *settings);

#endif
