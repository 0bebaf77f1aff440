// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_SOLUTION_H
#define SRC_OCP_SOLUTION_H

#include "ocp/transcription.h"

#define MORAY_SOLUTION_MARK "moray-solution" // what files of solutions begin with

enum { diagnosis_size = 4000 };

// What the solver tells of its iterations, kept and handed on to the user.
struct iterations {
    moray_progress *at; // [room], owned
    int n, room;
    moray_progress_fn *progress; // the user's, or NULL
    void *observer;
};

struct moray_solution {
    struct transcription *transcription;
    moray_settings settings;
    moray_nlp_info info;
    moray_iterate iterate;      // all in one block, owned, with
    double *guess;              // [columns] where the solver started
    moray_mesh_record *history; // [meshes], owned
    int meshes;
    struct iterations *iterations; // owned where the history is; NULL: none
    char diagnosis[diagnosis_size];
};

// Makes room for the iterations of one more solve. Error: MORAY_MEMORY.
moray_status moray_iterations_room(struct iterations *iterations, int max_iterations);
bool moray_iterations_keep(void *iterations, const moray_progress *progress); // a moray_progress_fn
void moray_iterations_free(struct iterations *iterations);                    // NULL is allowed

// Fills x[columns] from the guess; integrals are those of the guess itself. Error: MORAY_INPUT, MORAY_NUMERIC,
// MORAY_MEMORY.
moray_status moray_fill_guess(struct transcription *t, const moray_guess *guess, double *x);

// What a point is by which sizes are told: a guess, the solution on this mesh, that on another.
enum sized_by { by_guess, by_solution, by_other_mesh };

// Chooses x_scale and g_scale of the programme from bounds and x; durations and integrals as found on this mesh. Error:
// MORAY_MEMORY, MORAY_NUMERIC.
moray_status moray_choose_scales(struct transcription *t, const double *x, enum sized_by point);

// How long phase p must last for its states to come from one end to the other, by the slopes at the guess x, in whose
// caches they are, and by what is known of sizes; 0: nothing tells. size[n]: scratch for states and controls.
double moray_needed_duration(struct transcription *t, int p, const double *x, double *size);

// State x and control u (either NULL) on the polynomials of an interval where its scheme's basis is ell, integral.
void moray_solution_by_basis(const moray_solution *solution, int p, const struct interval *interval, const double *ell,
                             const double *integral, double *x, double *u);

// moray_solution_at by the time in the phase, 0..1, on the polynomials of one interval; NULL: of the one at tau, before
// an edge.
void moray_solution_at_tau(const moray_solution *solution, int p, const struct interval *interval, double tau,
                           double *x, double *u);

// Where the start of phase p, at t0 to tf, finds itself in a solution, at tau: shift + stretch tau there, clamped.
struct alignment {
    double shift, stretch;
};
struct alignment moray_align(const moray_guess *guess, int p, double t0, double tf);

// Fills the multipliers of `to` with those of guess->from, a solution of the same problem on any mesh. Error:
// MORAY_MEMORY.
moray_status moray_carry_multipliers(const moray_guess *guess, moray_solution *to);

// As moray_solution_at, from the polynomials of one interval, at its ends too, where the control may jump.
void solution_on_interval(const moray_solution *solution, int p, const struct interval *interval, double time,
                          double *x, double *u);

// Writes the diagnosis text; the history ends with the last mesh that was tried.
void moray_diagnose(moray_solution *solution);

bool moray_is_solved(const moray_solution *solution); // to the tolerance or a looser one

// Zeroed vectors for the programme of solution->transcription. Error: MORAY_MEMORY.
moray_status moray_allocate_iterate(moray_solution *solution);

// Caches, history and diagnosis of an iterate that no solver has left here. Error: MORAY_NUMERIC, MORAY_MEMORY.
moray_status moray_complete_solution(moray_solution *solution);

moray_mesh_record moray_record_of(const moray_solution *solution, double mesh_error);

#endif
