// SPDX-License-Identifier: MIT
//
// The one file that knows Ipopt. Written for 3.11 (char * options) and kept valid for 3.14.
#include "moray/nlp.h"

#include <IpStdCInterface.h> // the folder (coin or coin-or) is the package's business
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "nlp/ipopt_log.h"
#include "nlp/ipopt_user.h"
#include "nlp/mumps_lock.h"

struct session {
    const moray_nlp *nlp;
    const moray_nlp_settings *settings;
    moray_nlp_info *info;
    double *last; // [n] where the Jacobian was last asked for: the iterate, when an iteration is reported
    double *best; // [n] the iterate of the least violation, then objective
    double best_violation, best_objective;
};

static const double as_good_as_feasible = 1e-6;

enum { eval_objective, eval_gradient, eval_constraints, eval_jacobian, eval_hessian };

static double now(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double cpu(void)
{
    return now(CLOCK_PROCESS_CPUTIME_ID);
}

static Bool account(struct session *session, int which, double start, bool ok)
{
    const double spent = cpu() - start;
    session->info->evaluation_seconds += spent;
    session->info->evaluation_by[which] += spent;
    session->info->evaluations[which]++;
    return ok;
}

static Bool on_objective(Index n, Number *x, Bool fresh, Number *f, UserDataPtr data)
{
    (void)n;
    struct session *session = data;
    const double start = cpu();
    return account(session, eval_objective, start, session->nlp->objective(session->nlp->self, x, fresh, f));
}

static Bool on_gradient(Index n, Number *x, Bool fresh, Number *gradient, UserDataPtr data)
{
    (void)n;
    struct session *session = data;
    const double start = cpu();
    return account(session, eval_gradient, start, session->nlp->gradient(session->nlp->self, x, fresh, gradient));
}

static Bool on_constraints(Index n, Number *x, Bool fresh, Index m, Number *g, UserDataPtr data)
{
    (void)n;
    (void)m;
    struct session *session = data;
    const double start = cpu();
    return account(session, eval_constraints, start, session->nlp->constraints(session->nlp->self, x, fresh, g));
}

static Bool on_jacobian(Index n, Number *x, Bool fresh, Index m, Index nnz, Index *row, Index *col, Number *values,
                        UserDataPtr data)
{
    (void)m;
    struct session *session = data;
    const moray_nlp *nlp = session->nlp;
    if (!values) {
        memcpy(row, nlp->jac_row, (size_t)nnz * sizeof *row);
        memcpy(col, nlp->jac_col, (size_t)nnz * sizeof *col);
        return TRUE;
    }
    memcpy(session->last, x, (size_t)n * sizeof *x);
    const double start = cpu();
    return account(session, eval_jacobian, start, nlp->jacobian(nlp->self, x, fresh, values));
}

static Bool on_hessian(Index n, Number *x, Bool fresh, Number sigma, Index m, Number *lambda, Bool fresh_lambda,
                       Index nnz, Index *row, Index *col, Number *values, UserDataPtr data)
{
    (void)n;
    (void)m;
    (void)fresh_lambda;
    struct session *session = data;
    const moray_nlp *nlp = session->nlp;
    if (!values) {
        memcpy(row, nlp->hess_row, (size_t)nnz * sizeof *row);
        memcpy(col, nlp->hess_col, (size_t)nnz * sizeof *col);
        return TRUE;
    }
    const double start = cpu();
    return account(session, eval_hessian, start, nlp->hessian(nlp->self, x, fresh, sigma, lambda, values));
}

static void keep_best(struct session *session, double objective, double violation)
{
    const double counted = fmax(violation, as_good_as_feasible);
    if (counted > session->best_violation ||
        (counted == session->best_violation && objective >= session->best_objective))
        return;
    session->best_violation = counted;
    session->best_objective = objective;
    memcpy(session->best, session->last, (size_t)session->nlp->n * sizeof *session->best);
}

static Bool on_iteration(Index mode, Index iteration, Number objective, Number inf_pr, Number inf_du, Number mu,
                         Number d_norm, Number regularisation, Number alpha_du, Number alpha_pr, Index trials,
                         UserDataPtr data)
{
    (void)mu;
    (void)d_norm;
    (void)regularisation;
    (void)alpha_du;
    (void)alpha_pr;
    (void)trials;
    struct session *session = data;
    session->info->iterations = iteration;
    if (mode == 0 && iteration > 0) // the restoration's iterates have another violation; the start is no progress
        keep_best(session, objective, inf_pr);
    if (!session->settings->progress)
        return TRUE;
    const moray_progress progress = {iteration, objective, inf_pr, inf_du, mode != 0};
    return session->settings->progress(session->settings->observer, &progress);
}

// Whether several variables stand in a quarter of all constraints or more, as parameters and end times do. work[n].
static bool has_dense_columns(const moray_nlp *nlp, double *work)
{
    enum { several = 3 };
    int dense = 0;
    memset(work, 0, (size_t)nlp->n * sizeof *work);
    for (int k = 0; k < nlp->nnz_jac; k++)
        dense += (int)++work[nlp->jac_col[k]] == nlp->m / 4;
    return dense >= several;
}

static bool set_options(IpoptProblem problem, const moray_nlp *nlp, const moray_nlp_settings *settings, double *work)
{
    // 3.11 declares its option texts as char * but only reads them.
    bool ok = AddIpoptNumOption(problem, (char *)"tol", settings->tolerance);
    ok = ok && AddIpoptIntOption(problem, (char *)"max_iter", settings->max_iterations);
    ok = ok && AddIpoptIntOption(problem, (char *)"print_level", 0);               // standard output is the caller's
    ok = ok && AddIpoptStrOption(problem, (char *)"option_file_name", (char *)""); // none, not even ./ipopt.opt
    ok = ok && AddIpoptStrOption(problem, (char *)"sb", (char *)"yes");            // no banner
    if (settings->barrier > 0)
        ok = ok && AddIpoptNumOption(problem, (char *)"mu_init", settings->barrier);
    ok = ok && AddIpoptStrOption(problem, (char *)"linear_solver", (char *)"mumps");
    // MUMPS's own choice moves large entries of long programmes to the diagonal and fills the factor: 60 times slower.
    ok = ok && AddIpoptIntOption(problem, (char *)"mumps_permuting_scaling", 0);
    // Its nested dissection cannot cut what a few variables hold together: 30 times slower than minimum degree that
    // sets dense rows apart.
    if (has_dense_columns(nlp, work))
        ok = ok && AddIpoptIntOption(problem, (char *)"mumps_pivot_order", 6);
    if (nlp->x_scale || nlp->g_scale || nlp->f_scale != 0) {
        ok = ok && AddIpoptStrOption(problem, (char *)"nlp_scaling_method", (char *)"user-scaling");
        ok = ok && SetIpoptProblemScaling(problem, nlp->f_scale != 0 ? nlp->f_scale : 1, (double *)nlp->x_scale,
                                          (double *)nlp->g_scale);
    }
    if (settings->warm) {
        static const char *const pushes[] = {"warm_start_bound_push", "warm_start_bound_frac",
                                             "warm_start_slack_bound_push", "warm_start_slack_bound_frac",
                                             "warm_start_mult_bound_push"};
        ok = ok && AddIpoptStrOption(problem, (char *)"warm_start_init_point", (char *)"yes");
        for (unsigned i = 0; i < sizeof pushes / sizeof *pushes; i++)
            ok = ok && AddIpoptNumOption(problem, (char *)pushes[i], 1e-9);
    }
    return ok && SetIntermediateCallback(problem, on_iteration);
}

static moray_nlp_outcome outcome_of(enum ApplicationReturnStatus code)
{
    switch (code) {
    case Solve_Succeeded:
    case Feasible_Point_Found:
        return MORAY_NLP_SOLVED;
    case Solved_To_Acceptable_Level:
        return MORAY_NLP_ACCEPTABLE;
    case Infeasible_Problem_Detected:
        return MORAY_NLP_INFEASIBLE;
    case Maximum_Iterations_Exceeded:
    case Maximum_CpuTime_Exceeded:
        return MORAY_NLP_ITERATION_LIMIT;
    case User_Requested_Stop:
        return MORAY_NLP_INTERRUPTED;
    case Search_Direction_Becomes_Too_Small:
    case Diverging_Iterates:
    case Restoration_Failed:
    case Error_In_Step_Computation:
        return MORAY_NLP_STALLED;
    default:
        return MORAY_NLP_INVALID;
    }
}

static bool stopped_early(moray_nlp_outcome outcome)
{
    return outcome == MORAY_NLP_ITERATION_LIMIT || outcome == MORAY_NLP_INTERRUPTED || outcome == MORAY_NLP_STALLED ||
           outcome == MORAY_NLP_INVALID;
}

static void take_best(const struct session *session, moray_iterate *iterate)
{
    const moray_nlp *nlp = session->nlp;
    if (!stopped_early(session->info->outcome) || !(session->best_violation < INFINITY))
        return;
    memcpy(iterate->x, session->best, (size_t)nlp->n * sizeof *iterate->x);
    iterate->objective = session->best_objective;
    nlp->constraints(nlp->self, iterate->x, true, iterate->g);
}

struct logs {
    struct ipopt_log errors, timing;
};

static void open_logs(IpoptProblem problem, const moray_nlp_settings *settings, int level, struct logs *logs)
{
    if (level > 0)
        OpenIpoptOutputFile(problem, (char *)"stderr", level);
    if (moray_ipopt_log_open(&logs->errors))
        OpenIpoptOutputFile(problem, logs->errors.path, ipopt_error_level);
    if (settings->timing && moray_ipopt_log_open(&logs->timing) &&
        OpenIpoptOutputFile(problem, logs->timing.path, ipopt_timing_level))
        AddIpoptStrOption(problem, (char *)"print_timing_statistics", (char *)"yes");
}

static moray_status set_up(IpoptProblem problem, const struct session *session, struct logs *logs)
{
    const moray_nlp_settings *settings = session->settings;
    int level;
    MORAY_TRY(moray_ipopt_print_level(settings, &level));
    if (!set_options(problem, session->nlp, settings, session->last))
        return moray_error(MORAY_INPUT, "Ipopt refuses the settings: tolerance %g, %d iterations", settings->tolerance,
                           settings->max_iterations);
    MORAY_TRY(moray_ipopt_set_user(problem, settings));
    open_logs(problem, settings, level, logs);
    return moray_ok();
}

// Ipopt takes a factorisation that fails for want of memory for a singular matrix and tries others; in the end its
// code is of many kinds, but MUMPS has told.
static bool lacked_memory(enum ApplicationReturnStatus code, moray_nlp_outcome outcome, const struct ipopt_log *errors)
{
    static const char *const told[] = {"INFO(1) =-13", "INFO(1) = -13", "Error=-7 ", "Error=-13 "};
    char line[200];
    bool lacked = code == Insufficient_Memory;
    for (unsigned i = 0; i < sizeof told / sizeof *told && stopped_early(outcome); i++)
        lacked = lacked || moray_ipopt_log_find(errors, told[i], line, sizeof line);
    return lacked;
}

// What is no outcome of an optimisation.
static moray_status judge(enum ApplicationReturnStatus code, const struct session *session, const struct logs *logs)
{
    const moray_nlp *nlp = session->nlp;
    if (lacked_memory(code, session->info->outcome, &logs->errors))
        return moray_error(MORAY_MEMORY, "no memory to solve for %d variables and %d constraints, after %d iterations",
                           nlp->n, nlp->m, session->info->iterations);
    if (code == Invalid_Option)
        return moray_error(MORAY_INPUT, "Ipopt refuses an option when it starts: is its linear solver there?");
    return moray_ok();
}

static moray_status run(IpoptProblem problem, struct session *session, moray_iterate *iterate, struct logs *logs,
                        enum ApplicationReturnStatus *code)
{
    MORAY_TRY(set_up(problem, session, logs));
    *code = IpoptSolve(problem, iterate->x, iterate->g, &iterate->objective, iterate->lambda, iterate->z_lower,
                       iterate->z_upper, session);
    session->info->outcome = outcome_of(*code);
    take_best(session, iterate);
    return moray_ok();
}

moray_status moray_ipopt_solve(const moray_nlp *nlp, const moray_nlp_settings *settings, moray_iterate *iterate,
                               moray_nlp_info *info)
{
    *info = (moray_nlp_info){0};
    if (!(settings->tolerance > 0 && settings->tolerance < 1)) // Ipopt would print its own complaint
        return moray_error(MORAY_INPUT, "tolerance = %g: must lie between 0 and 1", settings->tolerance);
    const double start = now(CLOCK_MONOTONIC), cpu_start = cpu();
    double *block = calloc(2 * (size_t)nlp->n + 1, sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for %d variables", nlp->n);
    struct session session = {nlp, settings, info, block, block + nlp->n, INFINITY, INFINITY};
    moray_mumps_lock();
    // Ipopt copies the bounds.
    IpoptProblem problem = CreateIpoptProblem(
        nlp->n, (double *)nlp->x_lower, (double *)nlp->x_upper, nlp->m, (double *)nlp->g_lower, (double *)nlp->g_upper,
        nlp->nnz_jac, nlp->nnz_hess, 0, on_objective, on_constraints, on_gradient, on_jacobian, on_hessian);
    struct logs logs = {0};
    enum ApplicationReturnStatus code = Internal_Error;
    moray_status status =
        moray_error(MORAY_INPUT, "Ipopt refuses a problem of %d variables and %d constraints", nlp->n, nlp->m);
    if (problem) {
        status = run(problem, &session, iterate, &logs, &code);
        FreeIpoptProblem(problem); // writes the rest of the logs
        if (!moray_failed(status))
            status = judge(code, &session, &logs);
    }
    moray_mumps_unlock();
    free(block);
    info->seconds = now(CLOCK_MONOTONIC) - start;
    info->cpu_seconds = cpu() - cpu_start;
    info->linear_seconds = moray_ipopt_log_linear_seconds(&logs.timing);
    moray_ipopt_log_close(&logs.errors);
    moray_ipopt_log_close(&logs.timing);
    return status;
}

moray_nlp_settings moray_nlp_settings_default(void)
{
    return (moray_nlp_settings){.tolerance = 1e-8, .max_iterations = 1000, .barrier = 0.1};
}

const char *moray_nlp_outcome_text(moray_nlp_outcome outcome)
{
    static const char *const texts[] = {"solved",
                                        "solved to a looser tolerance",
                                        "infeasible",
                                        "iteration limit",
                                        "interrupted",
                                        "stalled",
                                        "not a number, or too few degrees of freedom"};
    return (unsigned)outcome < sizeof texts / sizeof *texts ? texts[outcome] : "unknown";
}
