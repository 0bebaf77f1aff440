// SPDX-License-Identifier: MIT
//
// Receding horizon (model predictive control): a controller that makes a new plan from the measured state every so
// often and carries it out until the next.
#ifndef MORAY_CONTROL_RECEDING_HORIZON_H
#define MORAY_CONTROL_RECEDING_HORIZON_H

#include "moray/export.h"
#include "moray/control/closed_loop.h"
#include "moray/ocp.h"

MORAY_BEGIN

// What is planned: problems of one phase that begins at t in state x[nx], with nu controls and ns parameters.
typedef struct moray_replanner {
    int nx, nu, ns;
    // Makes the problem; the plan keeps it, and what *ocp points to, until `free`. Error: any; nothing is left then.
    moray_status (*make)(void *self, double t, const double *x, void **problem, const moray_ocp **ocp);
    void (*free)(void *problem);
    // Whether what the last problem was made of has changed by t, so that a plan is due at once; NULL: it never does.
    bool (*changed)(const void *self, double t);
    void *self;
} moray_replanner;

// Either a replanner or `ocp`: any problem of one phase, stated once, whose start (moray_ocp_restart) is set anew for
// every plan, which then starts from the last one moved on in time, multipliers included. It must outlive the receding
// horizon, which changes it.
typedef struct moray_receding_horizon_spec {
    moray_replanner replanner;
    moray_ocp *ocp;              // NULL: by the replanner
    moray_settings settings;     // of each solve; at least 1 interval
    double horizon, interval;    // length of a plan; between two plans
    double watch;                // between two looks for a change; 0: only when a plan is due
    const double *s;             // [ns] the guess of the parameters; NULL: those of the last plan, or from their bounds
    const moray_solution *first; // where the first plan starts from; NULL: from resting in the state, u = 0
} moray_receding_horizon_spec;

typedef struct moray_receding_horizon moray_receding_horizon;

// Copies the spec, not what it points to. Error: MORAY_INPUT (sizes, times, `first` of other sizes), MORAY_MEMORY. Free
// with moray_receding_horizon_free.
MORAY_API moray_status moray_receding_horizon_new(moray_receding_horizon **receding,
                                                  const moray_receding_horizon_spec *spec);
MORAY_API void moray_receding_horizon_free(moray_receding_horizon *receding);

// Shows the state x[nx] at t: a plan is made when one is due, or has to be because of a change. Each solve starts from
// the last plan, moved on in time. Where it fails, or no problem can be made, the last plan stays in force, its last
// control held beyond its end. Error: MORAY_INPUT for a problem of other sizes, MORAY_MEMORY.
MORAY_API moray_status moray_receding_horizon_measure(moray_receding_horizon *receding, double t, const double *x);

// The control u[nu] of the plan in force at t, 0 without any.
MORAY_API void moray_receding_horizon_control(const moray_receding_horizon *receding, double t, double *u);

// Both as a controller of a plant whose state is the plans', of period `watch`, or else `interval`.
MORAY_API moray_controller moray_receding_horizon_controller(moray_receding_horizon *receding);

// The plan in force, NULL before the first; of the receding horizon, until the next plan.
MORAY_API const moray_solution *moray_receding_horizon_plan(const moray_receding_horizon *receding);

// Plans made so far, and what they cost of the processor, set-up included.
typedef struct moray_receding_horizon_record {
    int plans, failures, iterations;
    double seconds, longest; // of all plans, of the longest after the first
    char first_failure[200];
} moray_receding_horizon_record;
MORAY_API const moray_receding_horizon_record *moray_receding_horizon_record_of(const moray_receding_horizon *receding);

// Each of them, in order of time: [record.plans], of the receding horizon, until the next plan.
typedef struct moray_replan {
    double t, seconds; // when, and processor time
    int iterations;
    bool failed;
} moray_replan;
MORAY_API const moray_replan *moray_receding_horizon_replans(const moray_receding_horizon *receding);

MORAY_END

#endif
