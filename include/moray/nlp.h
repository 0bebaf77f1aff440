// SPDX-License-Identifier: MIT
//
// Sparse nonlinear programme: minimise f(x) subject to g_lower <= g(x) <= g_upper, x_lower <= x <= x_upper.
#ifndef MORAY_NLP_H
#define MORAY_NLP_H

#include "moray/export.h"
#include "moray/key_value.h"
#include "moray/status.h"

MORAY_BEGIN

#define MORAY_INFINITY 1e20 // bounds at or beyond this do not exist

// The callbacks return false where a function is not defined. `fresh` says that x differs from the last call's.
// Patterns are fixed, without repeated entries; the Hessian is that of sigma f + sum lambda_i g_i, lower triangle.
// `hold`, which may be NULL, is told when a solver begins (true) that has no use for entries of the Hessian by
// variables that their bounds fix, so that they may be left 0, and when it ends.
typedef struct moray_nlp {
    int n, m;
    const double *x_lower, *x_upper, *g_lower, *g_upper;
    const double *x_scale, *g_scale; // the solver sees x_scale x, g_scale g and f_scale f; NULL or 0 for its own choice
    double f_scale;
    int nnz_jac, nnz_hess;
    const int *jac_row, *jac_col, *hess_row, *hess_col;
    void *self;
    bool (*objective)(void *self, const double *x, bool fresh, double *f);
    bool (*gradient)(void *self, const double *x, bool fresh, double *gradient);
    bool (*constraints)(void *self, const double *x, bool fresh, double *g);
    bool (*jacobian)(void *self, const double *x, bool fresh, double *values);
    bool (*hessian)(void *self, const double *x, bool fresh, double sigma, const double *lambda, double *values);
    void (*hold)(void *self, bool begins);
} moray_nlp;

// A point with its multipliers, of L = f + lambda g - z_lower (x - x_lower) + z_upper (x - x_upper). The arrays are the
// caller's: x, z_lower, z_upper [n], g, lambda [m].
typedef struct moray_iterate {
    double *x, *z_lower, *z_upper, *g, *lambda;
    double objective;
} moray_iterate;

// One line of progress; return false to stop at this iteration.
typedef struct moray_progress {
    int iteration;
    double objective, infeasibility, dual_infeasibility;
    bool restoring; // in the solver's feasibility restoration
} moray_progress;
typedef bool moray_progress_fn(void *observer, const moray_progress *progress);

// Which factorisation Ipopt works with: our own, MUMPS, or an MA57 that it finds in libhsl.so (then no other thread may
// be solving with our own).
typedef enum { MORAY_LINEAR_MORAY, MORAY_LINEAR_MUMPS, MORAY_LINEAR_MA57 } moray_linear_solver;
MORAY_API const char *moray_linear_solver_text(moray_linear_solver solver); // "moray", "mumps", "ma57"

typedef struct moray_nlp_settings {
    double tolerance;       // 1e-8: scaled KKT error at which the solver stops
    int max_iterations;     // 1000
    double max_cpu_seconds; // 0, no limit: processor time of the solve
    double barrier;  // 0.1: barrier parameter to start with; less when the start is nearly feasible and nearly right
    bool warm;       // false: true starts from the multipliers of the iterate too, and close to its bounds
    int print_level; // 0: Ipopt's own log on standard error, 0..12
    moray_linear_solver linear_solver; // our own, which falls back on MUMPS
    bool timing; // false: parts are timed by the clock on the wall, which costs nothing; true: by the processor's, a
                 // call of the kernel each, MUMPS and MA57 too
    // Options of Ipopt by their names, {"mu_strategy", "adaptive"}, after all that moray sets; not option_file_name,
    // output_file, sb and linear_solver: no option file is ever read, and Ipopt never writes on standard output.
    const moray_key_value *ipopt; // [n_ipopt], borrowed
    int n_ipopt;                  // 0
    moray_progress_fn *progress;
    void *observer;
} moray_nlp_settings;

MORAY_API moray_nlp_settings moray_nlp_settings_default(void);

typedef enum {
    MORAY_NLP_SOLVED,
    MORAY_NLP_ACCEPTABLE, // to Ipopt's looser tolerance only
    MORAY_NLP_INFEASIBLE, // a stationary point of the constraint violation
    MORAY_NLP_ITERATION_LIMIT,
    MORAY_NLP_INTERRUPTED,
    MORAY_NLP_STALLED, // restoration failed, search direction too small, diverging, or a linear solve failed
    MORAY_NLP_INVALID  // not a number, or too few degrees of freedom
} moray_nlp_outcome;
MORAY_API const char *moray_nlp_outcome_text(moray_nlp_outcome outcome);

typedef struct moray_nlp_info {
    moray_nlp_outcome outcome;
    int iterations;
    double seconds;                    // whole solve, by the clock on the wall
    double cpu_seconds;                // whole solve, of the processor
    double evaluation_seconds;         // of seconds, in the callbacks; of cpu_seconds where timing is asked for
    double linear_seconds;             // likewise in the linear solver; of MUMPS and MA57 to 1e-3, NaN unless asked for
    int evaluations[5];                // of f, gradient, g, Jacobian, Hessian
    double evaluation_by[5];           // evaluation_seconds of each
    double regularisation;             // delta_w that the last step needed for a descent direction; NaN without a step
    moray_linear_solver linear_solver; // that the result is from
    moray_status linear_fallback;      // why MUMPS solved it from the start though our own was asked for; MORAY_OK: no
} moray_nlp_info;

// Solves with Ipopt from iterate->x (projected into its bounds), and leaves the last iterate there; where it was
// interrupted, reached a limit or stalled, the x, g and objective of the least violated iterate after the start, of
// those violated by less than 1e-6 the one of least objective. Returns MORAY_OK
// whenever Ipopt ran (read info->outcome); MORAY_MEMORY, also when Ipopt or its linear solver ran out of it;
// MORAY_INPUT when the problem cannot be set up, naming the option that Ipopt refuses. Threads may solve problems of
// their own at the same time: MUMPS can serve only one of them, so that the others wait. A callback may solve another
// problem.
MORAY_API moray_status moray_ipopt_solve(const moray_nlp *nlp, const moray_nlp_settings *settings,
                                         moray_iterate *iterate, moray_nlp_info *info);

// Optimality of an iterate, computed from the callbacks alone, in the user's units (nothing scaled).
typedef struct moray_kkt {
    double stationarity;    // largest |d L / d x_j| / dual_scale
    double feasibility;     // largest violation of a bound / (1 + |bound|), or of a constraint / (1 + |bound| + its
                            // largest |slope x_j|): metres of an orbit are not known to a micron
    double complementarity; // largest |multiplier x slack| / dual_scale
    double dual_scale;      // max(1, mean |multiplier|)
    double error;           // the largest of the three
    int worst_variable;     // of the stationarity
    int worst_constraint;   // of the feasibility; m + j for the bounds of x_j
} moray_kkt;

// Error: MORAY_MEMORY; MORAY_NUMERIC when a function is not finite at the iterate.
MORAY_API moray_status moray_kkt_error(const moray_nlp *nlp, const moray_iterate *iterate, moray_kkt *kkt);

// ---- Sensitivities -------------------------------------------------------------------------------------------------
//
// How a solution moves with a parameter p of the programme: the implicit function theorem on its optimality conditions,
// with the constraints that are active held so. The KKT matrix is factored once, each parameter is one more right-hand
// side. Asked for is a strict local minimum. Active constraints may depend on each other if they move together.

// What p does to the programme while x and the multipliers stand still. NULL: nothing.
typedef struct moray_nlp_shift {
    double objective;                                    // d f / d p
    const double *gradient;                              // [n] d/dp of the gradient of f + lambda g
    const double *g;                                     // [m]
    const double *x_lower, *x_upper, *g_lower, *g_upper; // 0 where there is no bound
} moray_nlp_shift;

// Where the set of active constraints changes if all goes on as it begins.
typedef struct moray_nlp_change {
    double step;    // of p, with its sign; infinite where nothing changes
    int constraint; // row, or m + j for a bound of x_j; -1: none
    bool upper;     // which of its bounds
    bool leaves;    // an active one that its multiplier would push away; else one that would be passed
} moray_nlp_change;

typedef struct moray_nlp_sensitivity moray_nlp_sensitivity;

// Of a solution; both must outlive the result. Error: MORAY_NUMERIC where a function is not finite or the minimum not
// strict, MORAY_MEMORY.
MORAY_API moray_status moray_nlp_sensitivity_new(moray_nlp_sensitivity **result, const moray_nlp *nlp,
                                                 const moray_iterate *solution);
MORAY_API void moray_nlp_sensitivity_free(moray_nlp_sensitivity *sensitivity);

// The constraints whose multiplier and slack are so small and so alike, in the scale of the solver, that it is not
// certain whether they are active (a solution to a tighter tolerance may tell); numbered as in moray_nlp_change.
// Returns how many; the first `most` stand in constraint[].
MORAY_API int moray_nlp_sensitivity_weak(const moray_nlp_sensitivity *sensitivity, int *constraint, int most);

// slope: the derivative by p of every entry of the solution, objective included; multipliers of constraints that depend
// on each other share evenly. Error: MORAY_NUMERIC where those cannot all follow, so that one lets go at once.
MORAY_API moray_status moray_nlp_sensitivity_solve(moray_nlp_sensitivity *sensitivity, const moray_nlp_shift *shift,
                                                   moray_iterate *slope);

// The first change as p rises (direction 1) or falls (-1).
MORAY_API moray_nlp_change moray_nlp_sensitivity_change(const moray_nlp_sensitivity *sensitivity,
                                                        const moray_nlp_shift *shift, const moray_iterate *slope,
                                                        int direction);

MORAY_END

#endif
