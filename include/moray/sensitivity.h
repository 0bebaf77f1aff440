// SPDX-License-Identifier: MIT
//
// How the solution of an optimal-control problem moves with a parameter of the problem, without solving again: to first
// order, with the constraints that are active held so, and how far that may be trusted.
#ifndef MORAY_SENSITIVITY_H
#define MORAY_SENSITIVITY_H

#include "moray/export.h"
#include "moray/ocp.h"

MORAY_BEGIN

typedef struct moray_sensitivity moray_sensitivity;

// Factors the KKT matrix of a solution, which must outlive the result. Error: MORAY_NOT_SOLVED where it is none,
// MORAY_NUMERIC where the matrix is singular, MORAY_MEMORY.
MORAY_API moray_status moray_sensitivity_new(moray_sensitivity **result, const moray_solution *solution);
MORAY_API void moray_sensitivity_free(moray_sensitivity *sensitivity);

// Names of the constraints of which it is not certain whether they are active, ""; the derivatives are then those of
// one side.
MORAY_API const char *moray_sensitivity_weak(const moray_sensitivity *sensitivity);

// Takes the derivatives by one parameter p, wherever it enters: functions, bounds, fixed times. displaced: the problem
// made with p - 2h, p - h, p + h, p + 2h, of the same sizes; their own exact derivatives are differenced to fourth
// order, so that h may be some 1e-3 of what p is measured by. Error: MORAY_INPUT (h, sizes), MORAY_NUMERIC,
// MORAY_MEMORY.
MORAY_API moray_status moray_sensitivity_by(moray_sensitivity *sensitivity, const moray_ocp *const displaced[4],
                                            double h);

// The rest is of the parameter last taken. Derivatives of what moray_solution_... give; of the states at the ends of a
// phase, x0[nx] and xf[nx].
MORAY_API double moray_sensitivity_objective(const moray_sensitivity *sensitivity);
MORAY_API const double *moray_sensitivity_parameters(const moray_sensitivity *sensitivity);
MORAY_API const double *moray_sensitivity_integrals(const moray_sensitivity *sensitivity, int phase);
MORAY_API void moray_sensitivity_times(const moray_sensitivity *sensitivity, int phase, double *t0, double *tf);
MORAY_API void moray_sensitivity_ends(const moray_sensitivity *sensitivity, int phase, double *x0, double *xf);

// The first change of the active set as p rises (direction 1) or falls (-1), by its tangent: beyond it the derivatives
// are others.
typedef struct moray_active_change {
    double step;    // of p, with its sign; infinite: none
    char what[240]; // "event power would leave its upper bound"; "": none
} moray_active_change;
MORAY_API moray_active_change moray_sensitivity_change(const moray_sensitivity *sensitivity, int direction);

// The solution that is expected of `problem`, which is the problem made with p + step: first order in x and
// multipliers, kept within its bounds. Nothing is solved, and the outcome says so (iteration limit, after none); it may
// be asked for everything that a solution may, and be a guess. Error: MORAY_INPUT (sizes), MORAY_NUMERIC, MORAY_MEMORY.
MORAY_API moray_status moray_sensitivity_predict(const moray_sensitivity *sensitivity, const moray_ocp *problem,
                                                 double step, moray_solution **predicted);

MORAY_END

#endif
