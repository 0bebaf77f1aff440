// SPDX-License-Identifier: MIT
//
// The simulator on SUNDIALS ARKODE; the only file that knows of it.
#include "moray/sim.h"

#include <arkode/arkode_arkstep.h>
#include <float.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "sim/prince_dormand.h"

struct moray_sim {
    moray_ode ode;
    moray_sim_settings settings;
    double t, *x;     // last accepted step
    bool outside;     // the right-hand side has failed since that step
    double outside_t; // where it did
    double retreat;   // the step then taken instead, 0 if none since that step
    char why[160];    // SUNDIALS' last message
    moray_sim_statistics statistics;
    SUNContext context;
    void *ark;
    N_Vector y; // ARKODE writes trial values here
    SUNMatrix jacobian;
    SUNLinearSolver solver;
};

static void keep_message(int code, const char *module, const char *function, char *message, void *self)
{
    (void)code, (void)module, (void)function;
    moray_sim *sim = self;
    snprintf(sim->why, sizeof sim->why, "%s", message);
}

static int rhs(double t, N_Vector y, N_Vector dy, void *self)
{
    moray_sim *sim = self;
    double *dx = N_VGetArrayPointer(dy);
    sim->statistics.rhs_evaluations++;
    bool inside = sim->ode.rhs(t, N_VGetArrayPointer(y), dx, sim->ode.self);
    for (int i = 0; inside && i < sim->ode.n; i++)
        inside = isfinite(dx[i]);
    if (inside)
        return 0;
    sim->outside = true;
    sim->outside_t = t;
    return 1; // recoverable, in SUNDIALS' terms
}

static bool use_explicit(moray_sim *sim)
{
    double a[PD_STAGES * PD_STAGES], b[PD_STAGES], c[PD_STAGES], embedded[PD_STAGES];
    memcpy(a, pd_a, sizeof a); // SUNDIALS takes no const
    memcpy(b, pd_b, sizeof b);
    memcpy(c, pd_c, sizeof c);
    memcpy(embedded, pd_embedded, sizeof embedded);
    ARKodeButcherTable table = ARKodeButcherTable_Create(PD_STAGES, PD_ORDER, PD_EMBEDDED_ORDER, c, a, b, embedded);
    const bool done = table && ARKStepSetTables(sim->ark, PD_ORDER, PD_EMBEDDED_ORDER, NULL, table) == ARK_SUCCESS;
    ARKodeButcherTable_Free(table);
    return done;
}

static bool use_tr_bdf2(moray_sim *sim)
{
    sim->jacobian = SUNDenseMatrix(sim->ode.n, sim->ode.n, sim->context);
    sim->solver = sim->jacobian ? SUNLinSol_Dense(sim->y, sim->jacobian, sim->context) : NULL;
    return sim->solver && ARKStepSetTableNum(sim->ark, ARKODE_TRBDF2_3_3_2, ARKODE_ERK_NONE) == ARK_SUCCESS &&
           ARKStepSetLinearSolver(sim->ark, sim->solver, sim->jacobian) == ARK_SUCCESS;
}

static bool configure(moray_sim *sim)
{
    const moray_sim_settings *settings = &sim->settings;
    return ARKStepSetErrHandlerFn(sim->ark, keep_message, sim) == ARK_SUCCESS &&
           ARKStepSetUserData(sim->ark, sim) == ARK_SUCCESS &&
           ARKStepSStolerances(sim->ark, settings->rtol, settings->atol) == ARK_SUCCESS &&
           ARKStepSetMaxStep(sim->ark, settings->max_step) == ARK_SUCCESS &&
           ARKStepSetMaxErrTestFails(sim->ark, 40) == ARK_SUCCESS && // down to a jump of the right-hand side; usually 7
           // The interpolant serves only at the ends of steps; a higher degree would ask for more derivatives.
           ARKStepSetInterpolantDegree(sim->ark, 3) == ARK_SUCCESS &&
           (settings->method == MORAY_SIM_EXPLICIT ? use_explicit(sim) : use_tr_bdf2(sim));
}

static bool build(moray_sim *sim)
{
    const bool is_explicit = sim->settings.method == MORAY_SIM_EXPLICIT;
    sim->x = calloc((size_t)sim->ode.n, sizeof *sim->x);
    if (!sim->x || SUNContext_Create(NULL, &sim->context))
        return false;
    sim->y = N_VNew_Serial(sim->ode.n, sim->context);
    if (!sim->y)
        return false;
    N_VConst(0, sim->y);
    sim->ark = ARKStepCreate(is_explicit ? rhs : NULL, is_explicit ? NULL : rhs, 0, sim->y, sim->context);
    return sim->ark && configure(sim);
}

moray_status moray_sim_new(moray_sim **out, const moray_ode *ode, const moray_sim_settings *settings)
{
    *out = NULL;
    if (ode->n < 1)
        return moray_error(MORAY_INPUT, "n = %d: an equation to simulate has at least 1 state", ode->n);
    MORAY_TRY(moray_sim_settings_check(settings));
    moray_sim *sim = calloc(1, sizeof *sim);
    if (sim) {
        *sim = (moray_sim){.ode = *ode, .settings = *settings, .why = "out of memory"};
        if (build(sim)) {
            *out = sim;
            return moray_ok();
        }
    }
    moray_status status =
        moray_error(MORAY_MEMORY, "cannot make a simulator of %d states: %s", ode->n, sim ? sim->why : "out of memory");
    moray_sim_free(sim);
    return status;
}

void moray_sim_free(moray_sim *sim)
{
    if (!sim)
        return;
    ARKStepFree(&sim->ark);
    if (sim->solver)
        SUNLinSolFree(sim->solver);
    SUNMatDestroy(sim->jacobian);
    N_VDestroy(sim->y);
    SUNContext_Free(&sim->context);
    free(sim->x);
    free(sim);
}

// Starts ARKODE anew at the accepted state; step 0 lets it choose the first one.
static moray_status restart(moray_sim *sim, double step, double growth)
{
    const bool is_explicit = sim->settings.method == MORAY_SIM_EXPLICIT;
    memcpy(N_VGetArrayPointer(sim->y), sim->x, (size_t)sim->ode.n * sizeof *sim->x);
    if (ARKStepReInit(sim->ark, is_explicit ? rhs : NULL, is_explicit ? NULL : rhs, sim->t, sim->y) == ARK_SUCCESS &&
        ARKStepSetInitStep(sim->ark, step) == ARK_SUCCESS && ARKStepSetMaxFirstGrowth(sim->ark, growth) == ARK_SUCCESS)
        return moray_ok();
    return moray_error(MORAY_NUMERIC, "simulation cannot start at t = %g: %s", sim->t, sim->why);
}

moray_status moray_sim_start(moray_sim *sim, double t, const double *x)
{
    for (int i = 0; i < sim->ode.n; i++) {
        if (!isfinite(x[i]))
            return moray_error(MORAY_NUMERIC, "simulation cannot start at t = %g: x[%d] = %g", t, i, x[i]);
    }
    memmove(sim->x, x, (size_t)sim->ode.n * sizeof *sim->x);
    sim->t = t;
    return restart(sim, 0, 0);
}

static moray_status explain(const moray_sim *sim, int flag, double stop)
{
    if (sim->outside)
        return moray_error(
            MORAY_NUMERIC,
            "simulation stopped at t = %.10g on its way to %g: the right-hand side is outside its domain "
            "or not finite at t = %.10g",
            sim->t, stop, sim->outside_t);
    const char *why = sim->why;
    if (flag == ARK_ERR_FAILURE || flag == ARK_TOO_MUCH_ACC)
        why = "the error test fails with ever shorter steps (rtol or atol too small, or a singular right-hand side)";
    if (flag == ARK_CONV_FAILURE)
        why = "the stage equations do not converge with ever shorter steps (singular right-hand side?)";
    return moray_error(MORAY_NUMERIC, "simulation stopped at t = %.10g on its way to %g: %s", sim->t, stop, why);
}

// A shorter step from the accepted state, after the right-hand side has failed on the last attempt.
static moray_status retreat(moray_sim *sim, int flag, double stop)
{
    const double longest = stop - sim->t;
    double tried = sim->retreat;
    if (tried == 0)
        ARKStepGetCurrentStep(sim->ark, &tried);
    sim->retreat = 0.25 * (tried > 0 ? fmin(tried, longest) : longest);
    if (sim->retreat < 1e3 * DBL_EPSILON * fmax(fabs(sim->t), longest))
        return explain(sim, flag, stop);
    return restart(sim, sim->retreat, 2);
}

static void accept(moray_sim *sim, double t)
{
    sim->t = t;
    memcpy(sim->x, N_VGetArrayPointer(sim->y), (size_t)sim->ode.n * sizeof *sim->x);
    sim->outside = false;
    sim->retreat = 0;
    sim->statistics.steps++;
}

// One accepted step towards the stop, or an error.
static moray_status step_towards(moray_sim *sim, double stop)
{
    for (;;) {
        double t = sim->t;
        ARKStepSetStopTime(sim->ark, stop); // each time: a restart forgets it
        const int flag = ARKStepEvolve(sim->ark, stop, sim->y, &t, ARK_ONE_STEP);
        if (flag == ARK_TSTOP_RETURN || (flag == ARK_SUCCESS && t > sim->t)) {
            accept(sim, flag == ARK_TSTOP_RETURN ? stop : t);
            return moray_ok();
        }
        if (flag == ARK_SUCCESS) // t + h == t
            return explain(sim, ARK_ERR_FAILURE, stop);
        if (!sim->outside)
            return explain(sim, flag, stop);
        MORAY_TRY(retreat(sim, flag, stop));
    }
}

moray_status moray_sim_advance(moray_sim *sim, double t)
{
    if (!(t >= sim->t && isfinite(t)))
        return moray_error(MORAY_INPUT, "simulation to t = %.10g: must be finite and not before the present t = %.10g",
                           t, sim->t);
    if (t - sim->t <= 100 * DBL_EPSILON * fmax(fabs(t), fabs(sim->t))) { // too short a way for ARKODE
        sim->t = t;
        return moray_ok();
    }
    sim->outside = false;
    sim->retreat = 0;
    for (long steps = 0; sim->t < t; steps++) {
        if (steps >= sim->settings.max_steps)
            return moray_error(MORAY_NUMERIC, "simulation stopped at t = %.10g on its way to %g: %ld steps (max_steps)",
                               sim->t, t, steps);
        MORAY_TRY(step_towards(sim, t));
    }
    return moray_ok();
}

double moray_sim_time(const moray_sim *sim)
{
    return sim->t;
}

const double *moray_sim_state(const moray_sim *sim)
{
    return sim->x;
}

moray_sim_statistics moray_sim_get_statistics(const moray_sim *sim)
{
    return sim->statistics;
}
