// SPDX-License-Identifier: MIT
#include "run/fit.h"

#include <math.h>
#include <string.h>

#include "moray/sim.h"
#include "ocp/solution.h"

// ---- Options -------------------------------------------------------------------------------------------------------

_Static_assert(MORAY_LINEAR_MORAY == 0 && MORAY_LINEAR_MUMPS == 1 && MORAY_LINEAR_MA57 == 2,
               "the choices of linear_solver in this order");

static const moray_option own_rows[] = {
    MORAY_ROW(REAL, app_run, mesh_tol, "solver", "mesh_tol", .max = INFINITY, .open = true,
              .help = "largest relative error between nodes that the certificate accepts"),
    MORAY_ROW(INT, app_run, refinements, "solver", "refinements", .max = 100,
              .help = "finer meshes tried while the error between nodes is above mesh_tol"),
    MORAY_ROW(INT, app_run, max_iterations, "solver", "max_iterations", .max = 1000000,
              .help = "limit of the solver's iterations"),
    MORAY_ROW(REAL, app_run, max_cpu_seconds, "solver", "max_cpu_seconds", .max = INFINITY, .unit = "s",
              .help = "limit of the processor time of all meshes, after which the best so far stays; 0: none"),
    MORAY_ROW(INT, app_run, max_variables, "solver", "max_variables", .max = 1000000000,
              .help = "limit of the variables of a finer mesh; 0: none"),
    MORAY_ROW(REAL, app_run, barrier, "solver", "barrier", .max = INFINITY, .open = true,
              .help = "barrier parameter to start with; less when the guess is nearly feasible and nearly right"),
    MORAY_ROW(BOOL, app_run, gauss_newton, "solver", "gauss_newton",
              .help = "second derivatives of a fit without the curvature of constraints and of what is observed"),
    MORAY_CONTINUE(app_run, from_file),
    MORAY_GUESS(app_run, guess_file),
    MORAY_LEAVE(app_run, solution_file),
    {.flag = "check",
     .type = MORAY_OPTION_BOOL,
     MORAY_AT(app_run, check),
     .help = "only compare the derivatives in use with differences of the functions, and say where they disagree most"},
};
enum { own_count = sizeof own_rows / sizeof *own_rows };

static moray_option constant_row(const moray_app_constant *constant, int i)
{
    return (moray_option){.section = "problem",
                          .key = constant->key,
                          .type = MORAY_OPTION_REAL,
                          .offset = offsetof(app_run, constant) + (size_t)i * sizeof(double),
                          .size = sizeof(double),
                          .min = constant->min,
                          .max = constant->max,
                          .unit = constant->unit,
                          .help = constant->help ? constant->help : "a constant of the problem"};
}

static void start_from_defaults(app_run *run)
{
    const moray_app *app = run->app;
    const moray_settings settings = app->settings ? *app->settings : moray_settings_default();
    run->common = moray_common_default();
    snprintf(run->common.scheme, sizeof run->common.scheme, "%s", settings.scheme);
    run->common.intervals = settings.intervals;
    run->common.tol = settings.tolerance;
    run->common.linear_solver = settings.linear_solver;
    run->mesh_tol = settings.mesh_tolerance;
    run->refinements = settings.max_refinements;
    run->max_iterations = settings.max_iterations;
    run->max_variables = settings.max_variables;
    run->max_cpu_seconds = settings.max_cpu_seconds;
    run->barrier = settings.barrier;
    run->gauss_newton = settings.gauss_newton;
    for (int i = 0; i < app->n_constants; i++)
        run->constant[i] = *app->constants[i].value;
}

// ---- Solving -------------------------------------------------------------------------------------------------------

static bool show_iteration(void *observer, const moray_progress *at)
{
    const app_run *run = observer;
    moray_ticker_show(&run->ticker, "%s: iteration %d, objective %.6g, violation %.1e%s", run->name, at->iteration,
                      at->objective, at->infeasibility, at->restoring ? " (restoring feasibility)" : "");
    return !moray_interrupted();
}

static moray_settings settings_of(app_run *run)
{
    moray_settings settings = run->app->settings ? *run->app->settings : moray_settings_default();
    settings.scheme = run->common.scheme;
    settings.intervals = run->common.intervals;
    settings.tolerance = run->common.tol;
    settings.linear_solver = run->common.linear_solver;
    settings.ipopt = run->common.ipopt.at;
    settings.n_ipopt = run->common.ipopt.n;
    settings.mesh_tolerance = run->mesh_tol;
    settings.max_refinements = run->refinements;
    settings.max_iterations = run->max_iterations;
    settings.max_variables = run->max_variables;
    settings.max_cpu_seconds = run->max_cpu_seconds;
    settings.barrier = run->barrier;
    settings.gauss_newton = run->gauss_newton;
    settings.progress = show_iteration;
    settings.observer = run;
    return settings;
}

// An unstable equation may leave its domain when it is integrated again: a failed certificate, no failed program.
static moray_status certify(app_run *run)
{
    const moray_sim_settings sim = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&sim);
    moray_ticker_show(&run->ticker, "%s: certifying", run->name);
    moray_status status = moray_certify(run->solution, &integrator, &run->certificate);
    if (status.code == MORAY_NUMERIC) {
        run->certificate.resimulation = INFINITY;
        run->certificate.pass = false;
        status = moray_ok();
    }
    run->certified = !moray_failed(status);
    return status;
}

// Reads what --guess names, or goes on from --continue, on the mesh of the file unless the options name another than by
// default.
static moray_status load(app_run *run, moray_settings *settings)
{
    app_run usual = {.app = run->app};
    MORAY_TRY(moray_check_starts(run->from_file, run->guess_file));
    if (run->guess_file[0])
        return moray_guess_read(&run->read, run->ocp, run->guess_file);
    if (!run->from_file[0])
        return moray_ok();
    start_from_defaults(&usual);
    if (run->common.intervals == usual.common.intervals && strcmp(run->common.scheme, usual.common.scheme) == 0)
        settings->intervals = 0;
    return moray_solution_load(&run->from, run->ocp, settings, run->from_file);
}

static moray_status solve(app_run *run)
{
    moray_settings settings = settings_of(run);
    MORAY_TRY(load(run, &settings));
    const moray_guess from = moray_guess_from_solution(run->from), *guess = run->from            ? &from
                                                                            : run->guess_file[0] ? &run->read
                                                                                                 : run->app->guess;
    run->ticker = moray_ticker_start(stderr, run->common.quiet);
    moray_interrupt_begin();
    moray_status status = moray_solve(run->ocp, &settings, guess, &run->solution);
    moray_interrupt_end();
    if (!moray_failed(status) && moray_is_solved(run->solution))
        status = certify(run);
    moray_ticker_end(&run->ticker);
    if (settings.intervals == 0) { // for the results
        run->common.intervals = 0;
        strcpy(run->common.scheme, "continued");
    }
    return status;
}

// ---- Ends ----------------------------------------------------------------------------------------------------------

// What is worst about the solution, in one line.
static moray_status judge(const app_run *run)
{
    const moray_nlp_info *info = moray_solution_info(run->solution);
    if (moray_is_solved(run->solution))
        return moray_ok();
    if (info->outcome == MORAY_NLP_INTERRUPTED)
        return moray_interruption(run->solution, run->kept);
    return moray_solution_failure(run->solution);
}

static const double doubtful = 1e-4; // difference that rounding does not explain

static const double nonsense = 1; // an error of the dynamics that leaves nothing else to be judged

// What to do about the first number that failed.
static const char *advice_on(const app_run *run)
{
    const moray_certificate *c = &run->certificate;
    if (isnan(c->mesh_error))
        return "bound its duration from below, or give a guess of its times: see --guess";
    if (!(c->derivatives <= MORAY_LIMIT_DERIVATIVES && c->directions <= MORAY_LIMIT_DIRECTIONS) &&
        c->mesh_error < nonsense)
        return "the derivatives are wrong at the solution, or it lies on a kink of a function: see --check";
    if (!(c->kkt <= MORAY_LIMIT_KKT) && c->mesh_error < nonsense)
        return "the solver stopped short of an optimum: try a smaller tol, or bounds and guesses of the sizes that "
               "occur";
    if (!(c->gap <= MORAY_LIMIT_GAP))
        return "try a smaller tol";
    if (c->curvature > MORAY_LIMIT_CURVATURE)
        return "try another guess";
    if (!(c->mesh_error <= run->mesh_tol))
        return "the mesh is too coarse: try more refinements, intervals or stages";
    return c->unseen > MORAY_LIMIT_UNSEEN ? "try more refinements, or a phase for each side of a jump"
                                          : "try more intervals or refinements";
}

static void say_failure(const app_run *run)
{
    fprintf(stderr, "%s: certificate failed: %s. %s\n", run->name, run->certificate.why, advice_on(run));
}

static moray_status check(const app_run *run)
{
    moray_ocp_derivative_report report;
    MORAY_TRY(moray_ocp_check_derivatives(run->ocp, &report));
    printf("first derivatives differ by at most %.1e%s%s\n", report.jacobian_error, *report.jacobian ? ": " : "",
           report.jacobian);
    printf("second derivatives differ by at most %.1e%s%s\n", report.hessian_error, *report.hessian ? ": " : "",
           report.hessian);
    if (report.jacobian_error > doubtful || report.hessian_error > doubtful)
        return moray_error(MORAY_NUMERIC, "derivatives are wrong, or the functions are not smooth");
    return moray_ok();
}

static moray_status work(app_run *run)
{
    for (int i = 0; i < run->app->n_constants; i++)
        *run->app->constants[i].value = run->constant[i];
    MORAY_TRY(moray_ocp_new(&run->ocp, run->app->spec));
    if (run->check)
        return check(run);
    MORAY_TRY(solve(run));
    if (run->solution_file[0])
        MORAY_TRY(moray_solution_save(run->solution, run->solution_file));
    MORAY_TRY(moray_run_fit(run));
    MORAY_TRY(moray_run_show(run));
    return judge(run);
}

int moray_app_run(const moray_app *app, int argc, char **argv)
{
    moray_option rows[own_count + MORAY_APP_CONSTANTS];
    app_run run = {.app = app, .name = app->spec->name ? app->spec->name : "problem"};
    const moray_program program = {.name = run.name,
                                   .summary = app->summary ? app->summary : "Solves an optimal-control problem.",
                                   .options = rows,
                                   .n_options = own_count + app->n_constants};
    int exit_code;
    if (app->n_constants > MORAY_APP_CONSTANTS)
        return moray_app_end(
            &program, &run,
            moray_error(MORAY_INPUT, "%d constants: at most %d", app->n_constants, (int)MORAY_APP_CONSTANTS));
    memcpy(rows, own_rows, sizeof own_rows);
    for (int i = 0; i < app->n_constants; i++)
        rows[own_count + i] = constant_row(&app->constants[i], i);
    start_from_defaults(&run);
    if (!moray_app_start(&program, argc, argv, &run, &exit_code))
        return exit_code;
    exit_code = moray_app_end(&program, &run, work(&run));
    if (exit_code == MORAY_EXIT_SOLVED && !run.check && !run.certificate.pass) {
        say_failure(&run);
        exit_code = MORAY_EXIT_CERTIFICATE;
    }
    moray_fit_free(&run.fit);
    moray_solution_free(run.solution);
    moray_solution_free(run.from);
    moray_guess_free(&run.read);
    moray_ocp_free(run.ocp);
    return exit_code;
}
