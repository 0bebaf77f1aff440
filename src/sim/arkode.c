// SPDX-License-Identifier: MIT
//
// The methods of SUNDIALS ARKODE; the only file that knows of it.
#include "sim/sim.h"

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

struct arkode {
    double retreat; // the step taken since the right-hand side failed, 0 if it did not since the accepted step
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
    return moray_sim_rhs(self, t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy)) ? 0 : 1; // 1: recoverable
}

static bool use_explicit(struct arkode *a)
{
    double A[PD_STAGES * PD_STAGES], b[PD_STAGES], c[PD_STAGES], embedded[PD_STAGES];
    memcpy(A, pd_a, sizeof A); // SUNDIALS takes no const
    memcpy(b, pd_b, sizeof b);
    memcpy(c, pd_c, sizeof c);
    memcpy(embedded, pd_embedded, sizeof embedded);
    ARKodeButcherTable table = ARKodeButcherTable_Create(PD_STAGES, PD_ORDER, PD_EMBEDDED_ORDER, c, A, b, embedded);
    const bool done = table && ARKStepSetTables(a->ark, PD_ORDER, PD_EMBEDDED_ORDER, NULL, table) == ARK_SUCCESS;
    ARKodeButcherTable_Free(table);
    return done;
}

static bool use_tr_bdf2(struct arkode *a, int n)
{
    a->jacobian = SUNDenseMatrix(n, n, a->context);
    a->solver = a->jacobian ? SUNLinSol_Dense(a->y, a->jacobian, a->context) : NULL;
    return a->solver && ARKStepSetTableNum(a->ark, ARKODE_TRBDF2_3_3_2, ARKODE_ERK_NONE) == ARK_SUCCESS &&
           ARKStepSetLinearSolver(a->ark, a->solver, a->jacobian) == ARK_SUCCESS;
}

static bool configure(moray_sim *sim, struct arkode *a, bool is_explicit)
{
    const moray_sim_settings *settings = &sim->settings;
    return ARKStepSetErrHandlerFn(a->ark, keep_message, sim) == ARK_SUCCESS &&
           ARKStepSetUserData(a->ark, sim) == ARK_SUCCESS &&
           ARKStepSStolerances(a->ark, settings->rtol, settings->atol) == ARK_SUCCESS &&
           ARKStepSetMaxStep(a->ark, settings->max_step) == ARK_SUCCESS &&
           ARKStepSetMaxErrTestFails(a->ark, 40) == ARK_SUCCESS && // down to a jump of the right-hand side; usually 7
           // The interpolant serves only at the ends of steps; a higher degree would ask for more derivatives.
           ARKStepSetInterpolantDegree(a->ark, 3) == ARK_SUCCESS &&
           (is_explicit ? use_explicit(a) : use_tr_bdf2(a, sim->ode.n));
}

static bool build(moray_sim *sim, bool is_explicit)
{
    struct arkode *a = calloc(1, sizeof *a);
    sim->method_self = a;
    if (!a || SUNContext_Create(NULL, &a->context))
        return false;
    a->y = N_VNew_Serial(sim->ode.n, a->context);
    if (!a->y)
        return false;
    N_VConst(0, a->y);
    a->ark = ARKStepCreate(is_explicit ? rhs : NULL, is_explicit ? NULL : rhs, 0, a->y, a->context);
    return a->ark && configure(sim, a, is_explicit);
}

static bool build_explicit(moray_sim *sim)
{
    return build(sim, true);
}

static bool build_tr_bdf2(moray_sim *sim)
{
    return build(sim, false);
}

static void release(moray_sim *sim)
{
    struct arkode *a = sim->method_self;
    if (!a)
        return;
    ARKStepFree(&a->ark);
    if (a->solver)
        SUNLinSolFree(a->solver);
    SUNMatDestroy(a->jacobian);
    N_VDestroy(a->y);
    SUNContext_Free(&a->context);
    free(a);
}

// Starts ARKODE anew at the accepted state; step 0 lets it choose the first one.
static moray_status begin(moray_sim *sim, double step, double growth)
{
    struct arkode *a = sim->method_self;
    const bool is_explicit = sim->settings.method == MORAY_SIM_ARKODE;
    memcpy(N_VGetArrayPointer(a->y), sim->x, (size_t)sim->ode.n * sizeof *sim->x);
    if (ARKStepReInit(a->ark, is_explicit ? rhs : NULL, is_explicit ? NULL : rhs, sim->t, a->y) == ARK_SUCCESS &&
        ARKStepSetInitStep(a->ark, step) == ARK_SUCCESS && ARKStepSetMaxFirstGrowth(a->ark, growth) == ARK_SUCCESS)
        return moray_ok();
    return moray_error(MORAY_NUMERIC, "simulation cannot start at t = %g: %s", sim->t, sim->why);
}

static moray_status restart(moray_sim *sim)
{
    ((struct arkode *)sim->method_self)->retreat = 0;
    return begin(sim, 0, 0);
}

static moray_status explain(const moray_sim *sim, int flag, double stop)
{
    if (flag == ARK_ERR_FAILURE || flag == ARK_TOO_MUCH_ACC)
        return moray_sim_stuck(sim, stop, SIM_ERROR_TEST);
    if (flag == ARK_CONV_FAILURE)
        return moray_sim_stuck(
            sim, stop, "the stage equations do not converge with ever shorter steps (singular right-hand side?)");
    return moray_sim_stuck(sim, stop, sim->why);
}

// A shorter step from the accepted state, after the right-hand side has failed on the last attempt.
static moray_status retreat(moray_sim *sim, int flag, double stop)
{
    struct arkode *a = sim->method_self;
    const double longest = stop - sim->t;
    double tried = a->retreat;
    if (tried == 0)
        ARKStepGetCurrentStep(a->ark, &tried);
    a->retreat = 0.25 * (tried > 0 ? fmin(tried, longest) : longest);
    if (a->retreat < 1e3 * DBL_EPSILON * fmax(fabs(sim->t), longest))
        return explain(sim, flag, stop);
    return begin(sim, a->retreat, 2);
}

static moray_status step(moray_sim *sim, double stop)
{
    struct arkode *a = sim->method_self;
    for (;;) {
        double t = sim->t;
        ARKStepSetStopTime(a->ark, stop); // each time: a restart forgets it
        const int flag = ARKStepEvolve(a->ark, stop, a->y, &t, ARK_ONE_STEP);
        if (flag == ARK_TSTOP_RETURN || (flag == ARK_SUCCESS && t > sim->t)) {
            moray_sim_accept(sim, flag == ARK_TSTOP_RETURN ? stop : t, N_VGetArrayPointer(a->y));
            a->retreat = 0;
            return moray_ok();
        }
        if (flag == ARK_SUCCESS) // t + h == t
            return explain(sim, ARK_ERR_FAILURE, stop);
        if (!sim->outside)
            return explain(sim, flag, stop);
        MORAY_TRY(retreat(sim, flag, stop));
    }
}

const sim_method moray_sim_arkode = {build_explicit, release, restart, step};
const sim_method moray_sim_tr_bdf2 = {build_tr_bdf2, release, restart, step};
