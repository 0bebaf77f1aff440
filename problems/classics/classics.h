// SPDX-License-Identifier: MIT
//
// Textbook problems whose optimum is published: one a file, each with its equations, data, source and value.
#ifndef PROBLEMS_CLASSICS_CLASSICS_H
#define PROBLEMS_CLASSICS_CLASSICS_H

#include "moray/ocp.h"

// The textbook's start: x and u of a phase at tau in [0, 1] of its guessed duration. Returns the time. Asked phase
// after phase at tau = 0, 1 / CLASSIC_PARTS, ..., 1; x arrives as it was left the time before, so that it can be
// simulated.
enum { CLASSIC_PARTS = 128 };
typedef double classic_start_fn(int phase, double tau, double *x, double *u, const void *data);

struct classic {
    const char *name, *title, *source;
    const char *published; // optimum as it was printed; NULL where none is for this mesh
    const char *computed;  // what the stated data give where that is not what was printed (the file says why); or NULL
    double closed_form;    // to 1e-10; 0 where there is none
    bool maximised;        // what is published, so that it is minus the objective
    const void *data;      // of the variant; handed to build and start
    moray_status (*build)(moray_ocp **ocp, const void *data);
    classic_start_fn *start;          // NULL: the samples of `straight`
    const moray_samples *straight;    // two, from time 0 on; NULL: straight between the bounds
    const double *parameters;         // to begin with; NULL: from their bounds
    const char *scheme;               // recommended; NULL: gauss3
    int intervals;                    // to begin with; 0: 20
    bool fixed_mesh;                  // the published value belongs to that mesh: not to be refined
    double tolerance, mesh_tolerance; // 0: 1e-10 and 1e-6
};

// For `build` of a problem with no events and one phase, which begins at time 0 where it does not say otherwise.
moray_status classic_new(moray_ocp **ocp, const char *name, const moray_phase_spec *phase, moray_endpoint_fn *endpoint,
                         const void *data);

// Objectives of one phase: its end in time; its first integral; minus the end of its first state.
moray_endpoint_fn classic_final_time, classic_first_integral, classic_first_state;

// A start on the data of a fit, straight between them, and with the first of them before: x[ny]. Returns the time.
double classic_start_on_data(const moray_observations *data, double tf, double tau, double *x);

// Of a fit, whose objective is what its observations add: nothing.
moray_endpoint_fn classic_no_objective;

extern const struct classic *const classics[]; // ends with NULL
const struct classic *classic_find(const char *name);

enum { CLASSIC_MOST_MESHES = 101 };

struct classic_result {
    moray_nlp_outcome outcome;
    moray_mesh_record mesh[CLASSIC_MOST_MESHES]; // first to last
    int meshes, iterations;                      // iterations of all meshes
    double seconds;                              // of the processor, from building the problem to the solution
    double value, difference;                    // in the textbook's sign; difference from what was printed, or NaN
    bool agrees; // with `computed` where there is one, else with `published`, rounded or cut; and with the
                 // closed form to 1e-7
    bool better; // than what was printed, and certified
    moray_certificate certificate;
};

// "agrees", "better" (than what was printed), "by the data" (as they give it, which is worse than was printed),
// "solved" (where nothing was printed), "DIFFERS" or "NOT SOLVED".
const char *classic_agreement(const struct classic *classic, const struct classic_result *result);

// Builds the problem and solves it from its own start. Free both with moray_solution_free and moray_ocp_free, in this
// order; what an error leaves unmade is NULL.
moray_status classic_first_solution(const struct classic *classic, const moray_settings *settings, moray_ocp **ocp,
                                    moray_solution **solution);

// Recommended settings: the ones to start from.
moray_settings classic_settings(const struct classic *classic);

// Who is shown a solution that is solved before it is freed; an error ends classic_solve with it.
typedef struct classic_viewer {
    moray_status (*view)(const struct classic *classic, const moray_ocp *ocp, const moray_solution *solution,
                         void *self);
    void *self;
} classic_viewer;

// Solves one from its own start; max_refinements below CLASSIC_MOST_MESHES. diagnosis, unless NULL, receives up to
// `size` characters of why it did not converge. Errors: those of moray_solve and moray_certify.
moray_status classic_solve(const struct classic *classic, const moray_settings *settings,
                           const moray_integrator *integrator, struct classic_result *result, char *diagnosis,
                           int size);
// The same with a viewer, or NULL.
moray_status classic_solve_viewed(const struct classic *classic, const moray_settings *settings,
                                  const moray_integrator *integrator, const classic_viewer *viewer,
                                  struct classic_result *result, char *diagnosis, int size);

#endif
