// SPDX-License-Identifier: MIT
//
// Optimal-control problems: form, transcription by direct collocation, solution, certificate.
//
//   minimise J(x0, t0, xf, tf, q of every phase, s)
//   with     x' = f(x, u, s, t), lower <= c(x, u, s, t) <= upper, q = integral of g(x, u, s, t) dt     on every phase
//            lower <= e(x0, t0, xf, tf, q of every phase, s) <= upper, and bounds on x, u, s, t0, tf, q
// Threads may each build, solve and read problems of their own at the same time (where MUMPS factors, the solves take
// turns). One problem, and what comes of it, belongs to one thread at a time: its functions are evaluated in scratch
// that the problem owns.
#ifndef MORAY_OCP_H
#define MORAY_OCP_H

#include <stdio.h>

#include "moray/export.h"
#include "moray/map.h"
#include "moray/nlp.h"
#include "moray/num.h"
#include "moray/ode.h"
#include "moray/scheme.h"

MORAY_BEGIN

// ---- Bounds --------------------------------------------------------------------------------------------------------

typedef struct moray_bounds {
    double lower, upper;
} moray_bounds;

static inline moray_bounds moray_fixed(double value)
{
    const moray_bounds bounds = {value, value};
    return bounds;
}
static inline moray_bounds moray_between(double lower, double upper)
{
    const moray_bounds bounds = {lower, upper};
    return bounds;
}
static inline moray_bounds moray_at_least(double lower)
{
    const moray_bounds bounds = {lower, MORAY_INFINITY};
    return bounds;
}
static inline moray_bounds moray_at_most(double upper)
{
    const moray_bounds bounds = {-MORAY_INFINITY, upper};
    return bounds;
}
static inline moray_bounds moray_free(void)
{
    const moray_bounds bounds = {-MORAY_INFINITY, MORAY_INFINITY};
    return bounds;
}

// Bounds of a vector; none (n = 0) leaves every entry free (path constraints and events must be bounded). In C
// initialise it with MORAY_BOUNDS(moray_fixed(0), moray_free()); in C and C++ take it from an array that lives on:
//   const moray_bounds x[] = {moray_fixed(0), moray_free()};  phase.x = MORAY_BOUNDS_OF(x);
typedef struct moray_bounds_list {
    const moray_bounds *at;
    int n;
} moray_bounds_list;
#define MORAY_BOUNDS(...)                                                                                              \
    {                                                                                                                  \
        (const moray_bounds[]){__VA_ARGS__}, (int)(sizeof((const moray_bounds[]){__VA_ARGS__}) / sizeof(moray_bounds)) \
    }
static inline moray_bounds_list moray_bounds_of(const moray_bounds *at, int n)
{
    const moray_bounds_list list = {at, n};
    return list;
}
#define MORAY_BOUNDS_OF(array) moray_bounds_of(array, (int)(sizeof(array) / sizeof(moray_bounds)))

// ---- Problem form --------------------------------------------------------------------------------------------------

// User functions are plain C99 on moray_num, see num.h; their derivatives come by complex step. Where the functions of
// a phase are evaluated, and what they give:
typedef struct moray_node {
    const moray_num *x, *u, *s; // [nx], [nu], [ns]
    moray_num t;
} moray_node;
typedef struct moray_rates {
    moray_num *f, *c, *g; // [nx] dynamics, [nc] path constraints, [nq] integrands
} moray_rates;
typedef void moray_continuous_fn(const moray_node *at, moray_rates *out, const void *data);

// The ends of the phases, and what they decide.
typedef struct moray_phase_ends {
    const moray_num *x0, *xf, *q; // [nx], [nx], [nq]
    moray_num t0, tf;
    const moray_num *u0, *uf; // [nu], NULL unless the phase has end_controls
} moray_phase_ends;
typedef struct moray_ends {
    const moray_phase_ends *phase;
    const moray_num *s;
} moray_ends;
typedef struct moray_end_values {
    moray_num objective; // minimised
    moray_num *e;        // [ne]
} moray_end_values;
typedef void moray_endpoint_fn(const moray_ends *at, moray_end_values *out, const void *data);

// The same for code that knows only double: derivatives by sparse differences, see moray_map_from_real.
typedef struct moray_real_node {
    const double *x, *u, *s;
    double t;
} moray_real_node;
typedef struct moray_real_rates {
    double *f, *c, *g;
} moray_real_rates;
typedef void moray_continuous_real_fn(const moray_real_node *at, moray_real_rates *out, const void *data);

typedef struct moray_real_phase_ends {
    const double *x0, *xf, *q;
    double t0, tf;
    const double *u0, *uf;
} moray_real_phase_ends;
typedef struct moray_real_ends {
    const moray_real_phase_ends *phase;
    const double *s;
} moray_real_ends;
typedef struct moray_real_end_values {
    double objective, *e;
} moray_real_end_values;
typedef void moray_endpoint_real_fn(const moray_real_ends *at, moray_real_end_values *out, const void *data);

// ---- Observations ----

// What is measured of a phase, predicted where its node is.
typedef void moray_observe_fn(const moray_node *at, moray_num *y, const void *data);

typedef enum moray_loss {
    MORAY_LEAST_SQUARES,
    MORAY_HUBER // squares up to a threshold, straight beyond
} moray_loss;

// Data of a phase: y_k = h(x, u, s, t_k) at any times, in any order, the same more than once too. With
// z = sqrt(weight) (h - value), the sum of z^2 is added to the objective; with Huber's loss of threshold d, that of
// 2 d |z| - d^2 where |z| > d. Costates jump at the times. See fit.h for what the data say of the parameters.
// The phase holds all its data: t0 is at most the first time, tf at least the last. Where both are fixed (by t0 and tf,
// or one of them and the duration), meshes have an edge at each time, beside those of `mesh`, where the state is a
// variable. Where one is free, the mesh moves under the data, and x and u of each time are variables of their own,
// equal to the polynomials of the interval that it falls into; a solve ends when each is where its time is.
typedef struct moray_observations {
    int n, ny;                 // times; channels
    const double *time;        // [n]
    const double *value;       // [n][ny]; NAN: missing
    const double *weight;      // [ny]; NULL: 1
    moray_observe_fn *observe; // complex step; or
    const moray_map *map;      // analytic: in = [x, u, s, t], out = [y]; must outlive the problem
    const char *const *names;  // [ny]; NULL: y[0], ...
    moray_loss loss;
    double threshold;           // of Huber's loss, positive
    moray_bounds_list residual; // [ny] of h - value at every time, as events beside those of the problem; none: free
    moray_bounds sum;           // of the sum that is added to the objective, as an event; left out (0, 0): any
    bool events_only;           // false; true adds nothing to the objective
} moray_observations;

// Of continuous, continuous_real and map, exactly one.
typedef struct moray_phase_spec {
    const char *name; // NULL: "phase", or the number of several
    int nx, nu, nc, nq;
    moray_continuous_fn *continuous;      // complex step
    const moray_map *map;                 // analytic: in = [x, u, s, t], out = [f, c, g]; must outlive the problem
    moray_bounds t0, tf;                  // t0 <= tf holds whatever they say
    moray_bounds duration;                // of tf - t0; left out (0, 0): any, 0 or more
    const double *mesh;                   // [intervals + 1] ascending from 0 to 1, in parts of the phase; NULL: equal
    int intervals;                        // of the first mesh of this phase; 0: those of the settings
    moray_bounds_list x, x0, xf, u, c, q; // x0 and xf narrow x at the ends
    const char *const *x_names, *const *u_names, *const *c_names; // NULL: x[0], ...
    moray_continuous_real_fn *continuous_real;                    // differences
    moray_observations observed;                                  // n = 0: none
    moray_bounds_list u0, uf; // narrow u at the ends: what its polynomials of the first and last interval are there
    bool end_controls;        // whether the endpoint reads u0 and uf
    const bool *held;         // [nu] controls that stay constant over each of this phase's own intervals, which it must
                              // then give; meshes may cut these. NULL: none. With schemes radau<s> and gauss<s> only
    const char *scheme;       // of this phase, which no ringing changes; NULL: that of the settings
} moray_phase_spec;

// Of endpoint, endpoint_real and endpoint_map, exactly one.
typedef struct moray_ocp_spec {
    const char *name;
    int phases, ns, ne;
    const moray_phase_spec *phase; // [phases]
    moray_endpoint_fn *endpoint;   // complex step
    const moray_map *endpoint_map; // analytic: in = [x0, t0, xf, tf, q of each phase in turn, s], out = [J, e];
                                   // u0, uf after the q of a phase that has end_controls
    moray_bounds_list s, e;
    const char *const *s_names, *const *e_names;
    const void *data;                      // handed to the functions
    moray_endpoint_real_fn *endpoint_real; // differences
} moray_ocp_spec;

typedef struct moray_ocp moray_ocp;

// Copies the spec (not the maps, nor data). Names of a kind differ from each other, as do states from controls within a
// phase; none is empty, longer than 100 bytes, holds a control character or " [", or begins or ends with a blank;
// states and controls are not named t, nor phase where there are several. Error: MORAY_INPUT naming what is missing, of
// the wrong length, contradictory, not a number or named like another; MORAY_MEMORY.
MORAY_API moray_status moray_ocp_new(moray_ocp **ocp, const moray_ocp_spec *spec);
MORAY_API void moray_ocp_free(moray_ocp *ocp);

// The worst disagreement, relative as in moray_derivative_report, between the derivatives in use and differences of the
// functions at points over the whole box of the bounds, with the names: "phase wire: d (dynamics of state v) / d
// (control u) is 0.2, by differences 0.3". Complex step and correct analytic derivatives come to about 1e-9,
// differences to 1e-6.
typedef struct moray_ocp_derivative_report {
    double jacobian_error, hessian_error;
    char jacobian[300], hessian[300];
} moray_ocp_derivative_report;

// Error: MORAY_MEMORY; MORAY_NUMERIC when a function is not finite at any of the points.
MORAY_API moray_status moray_ocp_check_derivatives(const moray_ocp *ocp, moray_ocp_derivative_report *report);

// The same problem from another start, for re-solving it as time goes on: its one phase begins at t in state x[nx], and
// where `length` is not 0, ends at t + length. Solutions from before keep their own start and ends. Error: MORAY_INPUT.
MORAY_API moray_status moray_ocp_restart(moray_ocp *ocp, double t, double length, const double *x);

// Number of phases; states and controls of one of them.
MORAY_API int moray_ocp_phases(const moray_ocp *ocp);
MORAY_API void moray_ocp_widths(const moray_ocp *ocp, int phase, int *nx, int *nu);

// ---- Trajectories, guesses -----------------------------------------------------------------------------------------

// Samples of one phase, row-major: time[n], x[n][nx], u[n][nu]; u is NULL where nu = 0. Borrowed by whoever takes it as
// input.
typedef struct moray_samples {
    int n;
    const double *time, *x, *u;
} moray_samples;

typedef struct moray_solution moray_solution;

// A guess: samples of each phase (piecewise linear, stretched to the phase's own first and last time), parameters
// s[ns]. A phase with n = 0, or no phases at all, is guessed from its bounds: straight from x0 to xf, or as at the one
// end that has bounds on both sides; u in the middle of its bounds. Fill it by hand, or by one of the functions below.
typedef struct moray_guess {
    const moray_samples *phase;
    const double *s;
    const moray_solution *from; // NULL; a solution of a problem of the same sizes on any mesh and scheme: all from it
    void *owned;                // what moray_guess_free frees
    bool along_time; // of `from` what it has at the same times, its end held beyond, not at equal parts of the phases
} moray_guess;

MORAY_API void moray_guess_free(moray_guess *guess); // of read and simulated guesses; harmless to others

MORAY_API moray_guess moray_guess_from_solution(const moray_solution *solution); // borrows

// Reads comma-separated values as in a trajectory.csv: first a line of names, "t" and those of the states and controls
// ("x[0]", "u[0]" where the problem has none), units in brackets after a name and other columns ignored; with several
// phases a column "phase", counted from 1. Times ascend; numbers are finite, with a decimal point in any locale. The
// parameters are guessed from their bounds: set guess->s for others. Or reads a solution file, see moray_solution_load:
// then all comes from it, multipliers too, on whatever mesh is asked for. Error: MORAY_IO; MORAY_INPUT naming the line,
// or the column that is missing; MORAY_MEMORY; MORAY_NUMERIC.
MORAY_API moray_status moray_guess_read(moray_guess *guess, const moray_ocp *ocp, const char *path);

// u[nu] of phase p at time t and state x[nx].
typedef void moray_control_fn(int phase, double t, const double *x, double *u, void *self);

// From where a phase is simulated to a guess. samples 0: 100, evenly in time.
typedef struct moray_drive {
    double t0, tf;
    const double *x0; // [nx]; NULL: the end of the phase before, which must have as many states
    int samples;
} moray_drive;

// Integrates the dynamics of every phase with parameters s[ns] and a control, NULL for the middle of its bounds.
// Error: MORAY_INPUT, MORAY_MEMORY, or what the integrator returned, with the name of the phase.
MORAY_API moray_status moray_guess_simulate(moray_guess *guess, const moray_ocp *ocp, const moray_drive *phase,
                                            const double *s, moray_control_fn *control, void *self,
                                            const moray_integrator *integrator);

// ---- Solving -------------------------------------------------------------------------------------------------------

typedef struct moray_settings {
    const char *scheme;     // "hermite-simpson", of phases that give none; or one for each phase: "radau3,lobatto4"
    int intervals;          // 20, of equal length, in every phase; 0: the meshes and the scheme of guess->from
    double tolerance;       // 1e-8: scaled KKT error, and what the certificate asks of the user's units (x 100)
    double mesh_tolerance;  // 1e-6: largest mesh error that the certificate accepts, and at which refinement ends
    int max_refinements;    // 0: finer meshes tried while the certificate would not accept what is between the nodes
    int max_iterations;     // 1000
    double max_cpu_seconds; // 0, no limit: processor time of all meshes, after which the best solution so far stays
    int max_variables;      // 0, no limit: of a finer mesh
    double barrier;         // 0.1: where the barrier starts; less when the guess is nearly feasible and nearly right
    bool barrier_shared;    // false; true: that of up to 1500 bounds, beyond which it is shared out among them
    bool rough;             // false; true: what the barrier leaves stays, though a certificate would not accept it
    bool own_scaling;       // true; false leaves scaling to Ipopt
    bool gauss_newton; // false; true leaves the curvature of constraints and of what is observed out of the Hessian
    int print_level;   // 0: Ipopt's log on standard error
    moray_linear_solver linear_solver; // our own, which falls back on MUMPS
    bool timing;                       // false; true has parts timed by the processor's clock, see moray_nlp_settings
    const moray_key_value *ipopt;      // [n_ipopt] further options of Ipopt, which must outlive the solution
    int n_ipopt;                       // 0
    moray_progress_fn *progress;
    void *observer;
} moray_settings;

MORAY_API moray_settings moray_settings_default(void);

// Transcribes and solves from `guess` (NULL: from the bounds, and where that leads nowhere from what the dynamics do
// with controls off the middle of theirs, then in scales of Ipopt's). Stopped early, the solution is the best iterate,
// see moray_ipopt_solve. The solution keeps what it needs of the problem but must not outlive it; free with
// moray_solution_free. A refined mesh starts from the interpolated solution of the last; when one is not solved, the
// solution is that of the last solved (with the outcome of the failed where interrupted). Returns MORAY_OK with
// *solution set whenever the solver ran, converged or not: read moray_solution_info(...)->outcome and, when it is not
// MORAY_NLP_SOLVED, moray_solution_diagnosis. Errors: MORAY_INPUT (settings, guess), MORAY_MEMORY, MORAY_NUMERIC
// (functions not finite at the guess).
MORAY_API moray_status moray_solve(const moray_ocp *ocp, const moray_settings *settings, const moray_guess *guess,
                                   moray_solution **solution);
MORAY_API void moray_solution_free(moray_solution *solution);

// Keeps a solution, solved or not, in a text file, with its meshes and in full precision; the file is complete or not
// there. Error: MORAY_IO, MORAY_INPUT (path too long).
MORAY_API moray_status moray_solution_save(const moray_solution *solution, const char *path);
MORAY_API void moray_solution_write(const moray_solution *solution, FILE *file); // the same into an open file

// The solution of the same problem in such a file, as it was but for the history, of which the last mesh is left. To go
// on from it, solve with the guess moray_guess_from_solution, and intervals = 0 for its meshes. settings: what the
// certificate asks; NULL for the usual ones. Error: MORAY_IO, MORAY_MEMORY; MORAY_INPUT when the file is damaged or of
// another problem, naming the line; MORAY_NUMERIC.
MORAY_API moray_status moray_solution_load(moray_solution **solution, const moray_ocp *ocp,
                                           const moray_settings *settings, const char *path);

MORAY_API const moray_nlp_info *moray_solution_info(const moray_solution *solution);
MORAY_API double moray_solution_objective(const moray_solution *solution);
MORAY_API const double *moray_solution_parameters(const moray_solution *solution);           // s[ns]
MORAY_API const double *moray_solution_integrals(const moray_solution *solution, int phase); // q[nq]
MORAY_API void moray_solution_times(const moray_solution *solution, int phase, double *t0, double *tf);

// State x[nx] and control u[nu] at time t (clamped to the phase) from the collocation polynomials, the control kept
// within its bounds, which a polynomial leaves beside a jump; where the control jumps between intervals, its value
// before the jump. Either may be NULL.
MORAY_API void moray_solution_at(const moray_solution *solution, int phase, double t, double *x, double *u);

// The points where the state is a variable: how many, their times [count], and costates lambda[count][nx] such that the
// Hamiltonian is g + lambda f for a minimised integral, and dJ/dx(t) = lambda(t). Either array may be NULL. Where the
// dynamics are collocated they are stage values, of lower order than the optimum: 2 with trapezoid (1 at the ends of
// the phase) and hermite-simpson, s with radau, s + 1 with gauss, whose ends of intervals have the full 2s.
MORAY_API int moray_solution_nodes(const moray_solution *solution, int phase, double *time, double *costate);

// The Hamiltonian g + lambda f, with the integrands weighted by what they cost, at the nodes: hamiltonian[count], NaN
// where the dynamics are not collocated (start of a phase with Radau, ends of the intervals with Gauss). Returns the
// count. It is constant where the functions of the phase do not depend on time, 0 at a free final time that nothing
// else depends on.
MORAY_API int moray_solution_hamiltonian(const moray_solution *solution, int phase, double *hamiltonian);

// Multipliers [ne] of the events: minus dJ / d(bound) of those at a bound, positive at the upper, else 0. After them,
// of each phase in turn, those of its observations: residuals time by time, but for missing values, then the sum.
MORAY_API const double *moray_solution_event_multipliers(const moray_solution *solution);

// Multipliers of path constraints c[count][nc], and of the bounds on states x[count][nx] and controls u[count][nu], at
// the nodes, as densities in time: mu(t) dt is minus dJ of moving the active bound up for dt, so that it is positive at
// an upper bound, negative at a lower one, 0 between, and the Hamiltonian g + lambda f + mu c is stationary in u. NaN
// where c and u are not collocated, for states at both ends of the phase, whose bounds are of x0 and xf (see
// moray_solution_end_multipliers), for controls there that u0 or uf narrows, and for held ones. Where a state stays on
// a bound of its own, the density may hold single nodes with what jumps the costate: its integral by the quadrature of
// the mesh converges, its values there grow. Any array may be NULL. Returns the count, as moray_solution_nodes, whose
// times these are.
MORAY_API int moray_solution_multipliers(const moray_solution *solution, int phase, double *c, double *x, double *u);

// The same of the bounds on x0[nx] and xf[nx], which are no densities: minus dJ / d(bound). NaN where the state is
// fixed there: its costate tells. Either may be NULL.
MORAY_API void moray_solution_end_multipliers(const moray_solution *solution, int phase, double *x0, double *xf);

// Sizes of the programme that was solved.
typedef struct moray_nlp_size {
    int variables, constraints, nnz_jac, nnz_hess;
} moray_nlp_size;
MORAY_API moray_nlp_size moray_solution_size(const moray_solution *solution);

// One mesh that was tried.
typedef struct moray_mesh_record {
    int intervals, nodes, variables; // of all phases
    moray_nlp_outcome outcome;
    moray_linear_solver linear_solver; // that it was solved with
    int iterations;
    double seconds;
    double error; // largest of mesh_error, between_nodes / 100 and, where past its limit, unseen, see
                  // moray_certificate; NaN where not solved
    double objective;
    int seen;               // 0; 1 + the control, counted through the phases, that goes to and fro within a few nodes
    double swing;           // how far it does from turn to turn, of its range, as a mean over its phase
    int ringing;            // 0; that control where the mesh before showed it, too, and the scheme was changed
    const char *changed_to; // NULL; the scheme of later meshes, because of ringing, an equation or, back, because this
                            // did no better
    int dependences; // 0; of the functions on their inputs, found at this solution and new: solved again with them
    int equation; // 0; 1 + the path constraint, counted through the phases, that is an equation between states alone,
                  // where this mesh was not solved and the scheme was changed
} moray_mesh_record;

// What the solver told of its iterations, of all meshes that were tried one after another, each counted from 0; [*n],
// owned by the solution, none where it was read from a file. Of one solve the first MORAY_KEPT_ITERATIONS are kept.
enum { MORAY_KEPT_ITERATIONS = 10000 };
MORAY_API const moray_progress *moray_solution_iterations(const moray_solution *solution, int *n);

// Intervals of a phase's mesh: how many, and their ends in time, edge[count + 1] unless NULL.
MORAY_API int moray_solution_intervals(const moray_solution *solution, int phase, double *edge);

// Their errors, of each the larger of mesh_error and between_nodes / 100 (see moray_certificate):
// error[moray_solution_intervals]. Error: MORAY_MEMORY.
MORAY_API moray_status moray_solution_interval_errors(const moray_solution *solution, int phase, double *error);

// The meshes that were tried, first to last; [*meshes], owned by the solution.
MORAY_API const moray_mesh_record *moray_solution_history(const moray_solution *solution, int *meshes);

// One text of several lines that says what hurts: the largest scaled violation by name, phase and time, and the active
// bounds. Owned by the solution.
MORAY_API const char *moray_solution_diagnosis(const moray_solution *solution);

// The same as an error, MORAY_NOT_SOLVED, in one line: all of it, or where that does not fit, the outcome, the largest
// violation and what to try.
MORAY_API moray_status moray_solution_failure(const moray_solution *solution);

// ---- Certificate ---------------------------------------------------------------------------------------------------

// Of the numbers that no setting bounds; none of them has a unit.
#define MORAY_LIMIT_KKT 1e-5
#define MORAY_LIMIT_GAP 1e-4
#define MORAY_LIMIT_CURVATURE 1e-4
#define MORAY_LIMIT_DERIVATIVES 1e-5
#define MORAY_LIMIT_DIRECTIONS 1e-4
#define MORAY_LIMIT_HAMILTONIAN 1e-2
#define MORAY_LIMIT_UNSEEN 1e-2

// Computed apart from the solver: with derivatives of the user's functions differenced at the solution, and sizes of
// all that is measured taken from the trajectory, so that neither the derivatives, patterns and scales in use nor the
// units matter. Passes when every number is within its limit.
typedef struct moray_certificate {
    bool pass;
    double kkt;           // larger of: what the first-order conditions leave of the objective to gain, relative to what
                          // it moves by where all that it depends on moves by its size; the largest violation of a row
                          // or bound relative to its size; and what the solution's objective is from that of its
                          // trajectory. Limit MORAY_LIMIT_KKT
    double mesh_error;    // largest over intervals of integral |x~' - f(x~, u~)| / (size + max |x|), and of the same of
                          // integrands g and integrals q; limit mesh_tolerance
    double between_nodes; // largest violation of bounds and path constraints between nodes, / (size + |bound|); limit
                          // 100 x mesh_tolerance
    double resimulation;  // largest |x - x_simulated| / (size + max |x|) at the end of an interval that is integrated
                          // again from its start with the found controls, and |q - q_simulated| / (size + |q|); limit
                          // 100 x mesh_tolerance
    double derivatives;   // largest disagreement of a derivative of a phase or the endpoint, patterns included, with
                          // differences at a node, relative to what its function moves by; limit
                          // MORAY_LIMIT_DERIVATIVES
    double directions;    // of the programme's first and second derivatives along dense directions, as in
                          // moray_derivative_report with scaled rows; limit MORAY_LIMIT_DIRECTIONS
    double hamiltonian;   // mean departure of the Hamiltonian from H' = dH/dt over a phase, relative to the largest of
                          // the sums of its terms; NaN where they vanish. Limit MORAY_LIMIT_HAMILTONIAN of phases
                          // that do not depend on time, with radau, gauss, and lobatto of 4 stages and more; told only
                          // where costates are of low order or functions may jump with time
    double gap;           // what the slacks of active bounds and rows, times their multipliers, hold the objective from
                          // its optimum, relative as kkt. Limit MORAY_LIMIT_GAP
    double curvature;     // how far the Lagrangian bends down along what the active constraints leave free: relative,
                          // per square of sizes; 0 at a minimum, strict or not; NAN where no factorisation tells. Limit
                          // MORAY_LIMIT_CURVATURE
    double composed;      // as resimulation, each phase in one go from its start: for information, as unstable
                          // equations make it as large as they like
    double untold;        // share of the derivatives at nodes and at the endpoint that differences say nothing of,
                          // lost in rounding or on a kink, so that those in use are believed: for information
    double unseen;     // what controls that are moved, and states and parameters by a little, do between the nodes and
                       // at none of them, at their costs by the multipliers, as a part of the objective. And what
                       // functions jump by as states move on, over a whole phase: derivatives on either side know
                       // nothing of when that is. Looked for at 512 points of a phase or more. Limit
                       // MORAY_LIMIT_UNSEEN
    double mesh_limit; // mesh_tolerance of the solve
    char why[400];     // one sentence on the first number that fails, with its limit and where; empty if none does
} moray_certificate;

// Error: MORAY_MEMORY, or what the integrator returned.
MORAY_API moray_status moray_certify(const moray_solution *solution, const moray_integrator *integrator,
                                     moray_certificate *certificate);

MORAY_END

#endif
