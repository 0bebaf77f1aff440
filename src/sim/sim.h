// SPDX-License-Identifier: MIT
//
// What a simulator is to its methods: each takes accepted steps towards a stop.
#ifndef SRC_SIM_SIM_H
#define SRC_SIM_SIM_H

#include "moray/sim.h"

typedef struct sim_method {
    bool (*build)(moray_sim *sim); // makes sim->method_self; false where there is no memory, or sim->why says more
    void (*release)(moray_sim *sim);
    moray_status (*restart)(moray_sim *sim);           // from sim->t, sim->x
    moray_status (*step)(moray_sim *sim, double stop); // one accepted step that does not pass `stop`, or an error
} sim_method;

extern const sim_method moray_sim_explicit, moray_sim_arkode, moray_sim_tr_bdf2;

struct moray_sim {
    moray_ode ode;
    moray_sim_settings settings;
    const sim_method *method;
    void *method_self;
    double t, *x;     // last accepted step
    bool outside;     // the right-hand side has failed since that step
    double outside_t; // where it did
    char why[160];    // what else the method has to say
    moray_sim_statistics statistics;
};

// dx[n] at t, x; false, and remembered, where the right-hand side is outside its domain or not finite.
bool moray_sim_rhs(moray_sim *sim, double t, const double *x, double *dx);

// Takes x[n] at t over as accepted.
void moray_sim_accept(moray_sim *sim, double t, const double *x);

// Why there is no way on to the stop: the right-hand side where it failed, else `why`.
moray_status moray_sim_stuck(const moray_sim *sim, double stop, const char *why);
#define SIM_ERROR_TEST                                                                                                 \
    "the error test fails with ever shorter steps (rtol or atol too small, or a singular right-hand side)"

#endif
