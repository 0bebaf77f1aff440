// SPDX-License-Identifier: MIT
//
// The one file that calls Ipopt. Written for 3.11 (char * options) and kept valid for 3.14.
#include "moray/nlp.h"

#include <IpStdCInterface.h> // the folder (coin or coin-or) is the package's business
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/clock.h"
#include "nlp/ipopt_linear.h"
#include "nlp/ipopt_log.h"
#include "nlp/ipopt_options.h"
#include "nlp/ipopt_user.h"
#include "nlp/mumps_lock.h"

struct session {
    const moray_nlp *nlp;
    const moray_nlp_settings *settings;
    moray_nlp_info *info;
    double (*clock)(void); // of the parts
    double *last;   // [n] where the Jacobian was last asked for, or without rows the gradient: the iterate, when an
                    // iteration is reported
    double *best;   // [n] the iterate of the least violation, then objective
    double *bounds; // [2 n + 2 m] as Ipopt gets them
    double best_violation, best_objective;
};

static const double give = 1e-8; // of a bound, relative to its size: Ipopt's own
static const double as_good_as_feasible = 1e-6;

enum { eval_objective, eval_gradient, eval_constraints, eval_jacobian, eval_hessian };

static Bool account(struct session *session, int which, double start, bool ok)
{
    const double spent = session->clock() - start;
    session->info->evaluation_seconds += spent;
    session->info->evaluation_by[which] += spent;
    session->info->evaluations[which]++;
    return ok;
}

// n may be 0 and `from` NULL, as of a linear programme's Hessian.
static void copy_places(const int *from, Index n, Index *to)
{
    for (Index k = 0; k < n; k++)
        to[k] = from[k];
}

static Bool on_objective(Index n, Number *x, Bool fresh, Number *f, UserDataPtr data)
{
    (void)n;
    struct session *session = data;
    const double start = session->clock();
    return account(session, eval_objective, start, session->nlp->objective(session->nlp->self, x, fresh, f));
}

static Bool on_gradient(Index n, Number *x, Bool fresh, Number *gradient, UserDataPtr data)
{
    struct session *session = data;
    if (session->nlp->m == 0)
        memcpy(session->last, x, (size_t)n * sizeof *x);
    const double start = session->clock();
    return account(session, eval_gradient, start, session->nlp->gradient(session->nlp->self, x, fresh, gradient));
}

static Bool on_constraints(Index n, Number *x, Bool fresh, Index m, Number *g, UserDataPtr data)
{
    (void)n;
    (void)m;
    struct session *session = data;
    const double start = session->clock();
    return account(session, eval_constraints, start, session->nlp->constraints(session->nlp->self, x, fresh, g));
}

static Bool on_jacobian(Index n, Number *x, Bool fresh, Index m, Index nnz, Index *row, Index *col, Number *values,
                        UserDataPtr data)
{
    (void)m;
    struct session *session = data;
    const moray_nlp *nlp = session->nlp;
    if (!values) {
        copy_places(nlp->jac_row, nnz, row);
        copy_places(nlp->jac_col, nnz, col);
        return TRUE;
    }
    memcpy(session->last, x, (size_t)n * sizeof *x);
    const double start = session->clock();
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
        copy_places(nlp->hess_row, nnz, row);
        copy_places(nlp->hess_col, nnz, col);
        return TRUE;
    }
    const double start = session->clock();
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
    (void)alpha_du;
    (void)alpha_pr;
    (void)trials;
    struct session *session = data;
    session->info->iterations = iteration;
    session->info->regularisation = iteration > 0 ? regularisation : NAN;
    if (mode == 0 && iteration > 0) // the restoration's iterates have another violation; the start is no progress
        keep_best(session, objective, inf_pr);
    if (!session->settings->progress)
        return TRUE;
    const moray_progress progress = {iteration, objective, inf_pr, inf_du, mode != 0};
    return session->settings->progress(session->settings->observer, &progress);
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

static moray_status set_up(IpoptProblem problem, const struct session *session, struct ipopt_logs *logs)
{
    const moray_nlp_settings *settings = session->settings;
    int level;
    MORAY_TRY(moray_ipopt_print_level(settings, &level));
    if (!moray_ipopt_set_options(problem, session->nlp, settings, session->info->linear_solver, session->last) ||
        !SetIntermediateCallback(problem, on_iteration))
        return moray_error(MORAY_INPUT, "Ipopt refuses the settings: tolerance %g, %d iterations", settings->tolerance,
                           settings->max_iterations);
    MORAY_TRY(moray_ipopt_set_user(problem, settings));
    moray_ipopt_logs_open(problem, level, settings->timing && session->info->linear_solver != MORAY_LINEAR_MORAY, logs);
    return moray_ok();
}

// What is no outcome of an optimisation.
static moray_status judge(enum ApplicationReturnStatus code, const struct session *session,
                          const struct ipopt_logs *logs)
{
    const moray_nlp *nlp = session->nlp;
    if (code == Insufficient_Memory ||
        (stopped_early(session->info->outcome) && moray_ipopt_log_lacked_memory(&logs->errors)))
        return moray_error(MORAY_MEMORY, "no memory to solve for %d variables and %d constraints, after %d iterations",
                           nlp->n, nlp->m, session->info->iterations);
    if (code == Invalid_Option)
        return moray_error(MORAY_INPUT, "Ipopt refuses an option when it starts: is its linear solver there?");
    return moray_ok();
}

// Back within the bounds as they were given.
static void restore(const moray_nlp *nlp, moray_iterate *iterate)
{
    bool moved = false;
    for (int j = 0; j < nlp->n; j++) {
        const double x = iterate->x[j];
        iterate->x[j] = fmin(fmax(x, nlp->x_lower[j]), nlp->x_upper[j]);
        moved = moved || iterate->x[j] != x;
    }
    if (!moved)
        return;
    nlp->constraints(nlp->self, iterate->x, true, iterate->g);
    nlp->objective(nlp->self, iterate->x, false, &iterate->objective);
}

static moray_status run(IpoptProblem problem, struct session *session, moray_iterate *iterate, struct ipopt_logs *logs,
                        enum ApplicationReturnStatus *code)
{
    MORAY_TRY(set_up(problem, session, logs));
    *code = IpoptSolve(problem, iterate->x, iterate->g, &iterate->objective, iterate->lambda, iterate->z_lower,
                       iterate->z_upper, session);
    session->info->outcome = outcome_of(*code);
    take_best(session, iterate);
    restore(session->nlp, iterate);
    return moray_ok();
}

// Bounds give way as in Ipopt, but in their own size where that is less than 1: in small units, 1 is another problem.
// Fixed ones stay.
static void relax(const double *lower, const double *upper, const double *scale, int n, double *low, double *high)
{
    for (int j = 0; j < n; j++) {
        const double size = scale ? fmin(1 / scale[j], 1) : 1;
        const bool fixed = lower[j] == upper[j];
        low[j] = fixed || lower[j] <= -MORAY_INFINITY ? lower[j] : lower[j] - give * fmax(size, fabs(lower[j]));
        high[j] = fixed || upper[j] >= MORAY_INFINITY ? upper[j] : upper[j] + give * fmax(size, fabs(upper[j]));
    }
}

// Whether there is memory for what Ipopt copies before it begins to watch for a shortage, which would end the program.
static bool can_begin(const moray_nlp *nlp)
{
    const size_t usual = 1 << 20, vectors = 8;
    void *trial = malloc(usual + vectors * ((size_t)nlp->n + (size_t)nlp->m) * sizeof(double));
    free(trial);
    return trial != NULL;
}

// bounds: [2 n + 2 m], filled.
static IpoptProblem create(const moray_nlp *nlp, double *bounds)
{
    const int n = nlp->n, m = nlp->m;
    double *low = bounds, *high = low + n, *g_low = high + n, *g_high = g_low + m;
    relax(nlp->x_lower, nlp->x_upper, nlp->x_scale, n, low, high);
    relax(nlp->g_lower, nlp->g_upper, nlp->g_scale, m, g_low, g_high);
    return CreateIpoptProblem(n, low, high, m, g_low, g_high, nlp->nnz_jac, nlp->nnz_hess, 0, on_objective,
                              on_constraints, on_gradient, on_jacobian, on_hessian); // which copies the bounds
}

// With the linear solver that session->info names.
static moray_status solve_with(struct session *session, moray_iterate *iterate)
{
    const moray_nlp *nlp = session->nlp;
    const bool alone = session->info->linear_solver != MORAY_LINEAR_MORAY;
    struct ipopt_logs logs = {0};
    enum ApplicationReturnStatus code = Internal_Error;
    moray_status status =
        moray_error(MORAY_INPUT, "Ipopt refuses a problem of %d variables and %d constraints", nlp->n, nlp->m);
    if (!can_begin(nlp))
        return moray_error(MORAY_MEMORY, "no memory to solve for %d variables and %d constraints", nlp->n, nlp->m);
    if (alone)
        moray_mumps_lock();
    IpoptProblem problem = create(nlp, session->bounds);
    if (problem) {
        status = run(problem, session, iterate, &logs, &code);
        FreeIpoptProblem(problem); // writes the rest of the logs
        if (!moray_failed(status))
            status = judge(code, session, &logs);
    }
    if (alone)
        moray_mumps_unlock();
    session->info->linear_seconds = moray_ipopt_log_linear_seconds(&logs.timing);
    moray_ipopt_logs_close(&logs);
    return status;
}

static moray_status solve_own(struct session *session, moray_iterate *iterate, moray_status *verdict)
{
    struct ipopt_linear linear;
    moray_ipopt_linear_open(&linear, session->clock);
    moray_status status = solve_with(session, iterate);
    moray_ipopt_linear_close(&linear);
    session->info->linear_seconds = linear.seconds;
    const moray_nlp_outcome outcome = session->info->outcome;
    *verdict = moray_ipopt_linear_verdict(&linear, stopped_early(outcome) && outcome != MORAY_NLP_INTERRUPTED);
    return status;
}

static void copy_iterate(const moray_nlp *nlp, const moray_iterate *from, moray_iterate *to)
{
    const size_t n = (size_t)nlp->n * sizeof *from->x, m = (size_t)nlp->m * sizeof *from->x;
    memcpy(to->x, from->x, n);
    memcpy(to->z_lower, from->z_lower, n);
    memcpy(to->z_upper, from->z_upper, n);
    memcpy(to->lambda, from->lambda, m);
}

// With our own factorisation, and from the start once more with MUMPS where that was the trouble.
static moray_status solve(struct session *session, moray_iterate *iterate, const moray_iterate *start)
{
    const moray_nlp_settings *settings = session->settings;
    moray_nlp_info *info = session->info;
    info->linear_solver = settings->linear_solver;
    if (info->linear_solver == MORAY_LINEAR_MORAY && !moray_ipopt_linear_available())
        info->linear_solver = MORAY_LINEAR_MUMPS;
    if (info->linear_solver == MORAY_LINEAR_MA57)
        moray_ipopt_linear_stand_back();
    if (info->linear_solver != MORAY_LINEAR_MORAY)
        return solve_with(session, iterate);
    MORAY_TRY(solve_own(session, iterate, &info->linear_fallback));
    if (info->linear_fallback.code != MORAY_NOT_SOLVED)
        return info->linear_fallback;
    copy_iterate(session->nlp, start, iterate);
    session->best_violation = session->best_objective = INFINITY;
    info->linear_solver = MORAY_LINEAR_MUMPS;
    return solve_with(session, iterate);
}

moray_status moray_ipopt_solve(const moray_nlp *nlp, const moray_nlp_settings *settings, moray_iterate *iterate,
                               moray_nlp_info *info)
{
    const size_t n = (size_t)nlp->n, m = (size_t)nlp->m;
    *info = (moray_nlp_info){0};
    if (!(settings->tolerance > 0 && settings->tolerance < 1)) // Ipopt would print its own complaint
        return moray_error(MORAY_INPUT, "tolerance = %g: must lie between 0 and 1", settings->tolerance);
    if (settings->max_iterations < 0)
        return moray_error(MORAY_INPUT, "max_iterations = %d: must not be negative", settings->max_iterations);
    const double wall_start = moray_clock(), cpu_start = moray_processor_clock();
    double *block = calloc(7 * n + 3 * m + 1, sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for %d variables", nlp->n);
    struct session session = {.nlp = nlp,
                              .settings = settings,
                              .info = info,
                              .clock = settings->timing ? moray_processor_clock : moray_clock,
                              .last = block,
                              .best = block + n,
                              .bounds = block + 5 * n + m,
                              .best_violation = INFINITY,
                              .best_objective = INFINITY};
    moray_iterate start = {
        .x = block + 2 * n, .z_lower = block + 3 * n, .z_upper = block + 4 * n, .lambda = block + 5 * n};
    copy_iterate(nlp, iterate, &start);
    if (nlp->hold)
        nlp->hold(nlp->self, true);
    const moray_status status = solve(&session, iterate, &start);
    if (nlp->hold)
        nlp->hold(nlp->self, false);
    free(block);
    info->seconds = moray_clock() - wall_start;
    info->cpu_seconds = moray_processor_clock() - cpu_start;
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

const char *moray_linear_solver_text(moray_linear_solver solver)
{
    static const char *const texts[] = {"moray", "mumps", "ma57"};
    return (unsigned)solver < sizeof texts / sizeof *texts ? texts[solver] : "unknown";
}
