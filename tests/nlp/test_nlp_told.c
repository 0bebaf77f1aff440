// SPDX-License-Identifier: MIT
//
// What a solve tells of its time, by a clock that counts its own calls; what it logs and leaves open; and which options
// it gives Ipopt. The linker leads clock and options to the test.
#include "programme.h"
#include "tap.h"

#include <unistd.h>

#include "moray/clock.h"
#include "nlp/ipopt_linear.h"
#include "nlp/ipopt_log.h"
#include "nlp/ipopt_options.h"

static double ticks;
double __wrap_moray_clock(void);
double __wrap_moray_clock(void)
{
    return ticks++;
}

// The options that were given last, "key=value" by blanks.
static char asked[2000];
Bool __real_AddIpoptNumOption(IpoptProblem problem, char *key, Number value);
Bool __real_AddIpoptIntOption(IpoptProblem problem, char *key, Index value);
Bool __wrap_AddIpoptNumOption(IpoptProblem problem, char *key, Number value);
Bool __wrap_AddIpoptIntOption(IpoptProblem problem, char *key, Index value);

static void note(const char *key, double value)
{
    const size_t used = strlen(asked);
    snprintf(asked + used, sizeof asked - used, "%s=%.10g ", key, value);
}

Bool __wrap_AddIpoptNumOption(IpoptProblem problem, char *key, Number value)
{
    note(key, value);
    return __real_AddIpoptNumOption(problem, key, value);
}

Bool __wrap_AddIpoptIntOption(IpoptProblem problem, char *key, Index value)
{
    note(key, value);
    return __real_AddIpoptIntOption(problem, key, value);
}

static moray_nlp_info solve(int print_level, moray_linear_solver solver)
{
    struct dense d = {.facts = weighted_squares, .g_lower = {1}, .g_upper = {1}};
    moray_nlp_info info;
    moray_nlp_settings settings = moray_nlp_settings_default();
    settings.print_level = print_level, settings.linear_solver = solver;
    dense_new(&d, 3, 1);
    CHECK_OK(moray_ipopt_solve(&d.nlp, &settings, &d.at, &info), "a solve");
    return info;
}

// ---- Log: the first solve of a process is where Ipopt would print its banner ----

static void test_log(void)
{
    char text[20000] = "";
    FILE *file = tmpfile();
    fflush(stderr);
    const int before = dup(STDERR_FILENO);
    CHECK(file && before >= 0 && dup2(fileno(file), STDERR_FILENO) >= 0, "standard error in a file");
    solve(5, MORAY_LINEAR_MORAY);
    fflush(NULL);
    dup2(before, STDERR_FILENO);
    close(before);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    CHECK(strstr(text, "Number of Iterations") && !strstr(text, "contains Ipopt"), "a log without a banner: %.200s",
          text);
}

static int lowest_free(void)
{
    const int descriptor = dup(STDIN_FILENO);
    close(descriptor);
    return descriptor;
}

static void test_descriptors(void)
{
    const int before = lowest_free();
    solve(0, MORAY_LINEAR_MORAY);
    solve(0, MORAY_LINEAR_MUMPS);
    CHECK(lowest_free() == before, "no descriptor stays open: %d, before %d", lowest_free(), before);
    struct ipopt_log log;
    CHECK(moray_ipopt_log_open(&log), "a log");
    moray_ipopt_log_close(&log);
    const int other = dup(STDIN_FILENO);
    moray_ipopt_log_close(&log);
    CHECK(other == log.file && lowest_free() != other, "a log is closed once: its descriptor %d is another's", other);
    close(other);
}

// ---- Time: of two calls the second is a tick later, and all others are of the start and the end ----

static void test_times(void)
{
    const double start = ticks;
    const moray_nlp_info info = solve(0, MORAY_LINEAR_MORAY);
    double evaluations = 0;
    for (int k = 0; k < 5; k++) {
        CHECK(info.evaluation_by[k] == info.evaluations[k] && info.evaluations[k] > 0, "function %d: %g ticks", k,
              info.evaluation_by[k]);
        evaluations += info.evaluations[k];
    }
    CHECK(info.evaluation_seconds == evaluations, "%g ticks of %g evaluations", info.evaluation_seconds, evaluations);
    const double linear = moray_ipopt_linear_available() ? info.linear_seconds : 0;
    CHECK(info.seconds == ticks - start - 1 && info.seconds == 2 * (evaluations + linear) + 1,
          "%g ticks, of the linear solver %g", info.seconds, linear);
}

// ---- What our own factorisation is blamed for: errors that Ipopt cannot refine, where it failed ----

static void test_verdict(void)
{
    static const struct {
        double error;
        bool failed, blamed;
    } cases[] = {{2e-7, true, true}, {2e-7, false, false}, {5e-8, true, false}, {NAN, true, true}, {0, true, false}};
    for (int k = 0; k < 5 && moray_ipopt_linear_available(); k++) {
        const struct ipopt_linear linear = {.error = cases[k].error};
        const moray_status status = moray_ipopt_linear_verdict(&linear, cases[k].failed);
        CHECK(status.code == (cases[k].blamed ? MORAY_NOT_SOLVED : MORAY_OK), "errors of %g: %s", cases[k].error,
              status.text);
    }
    const struct ipopt_linear lacking = {.error = 1, .failure = moray_error(MORAY_MEMORY, "none")};
    CHECK(!moray_ipopt_linear_available() || moray_ipopt_linear_verdict(&lacking, true).code == MORAY_MEMORY,
          "what it tells itself goes before");
}

// ---- Options ----

static Bool no_value(Index n, Number *x, Bool fresh, Number *value, UserDataPtr data)
{
    (void)n, (void)x, (void)fresh, (void)value, (void)data;
    return FALSE;
}

static Bool no_rows(Index n, Number *x, Bool fresh, Index m, Number *g, UserDataPtr data)
{
    (void)n, (void)x, (void)fresh, (void)m, (void)g, (void)data;
    return FALSE;
}

static Bool no_slopes(Index n, Number *x, Bool fresh, Index m, Index nnz, Index *row, Index *col, Number *values,
                      UserDataPtr data)
{
    (void)n, (void)x, (void)fresh, (void)m, (void)nnz, (void)row, (void)col, (void)values, (void)data;
    return FALSE;
}

static Bool no_curvature(Index n, Number *x, Bool fresh, Number sigma, Index m, Number *lambda, Bool fresh_lambda,
                         Index nnz, Index *row, Index *col, Number *values, UserDataPtr data)
{
    (void)n, (void)x, (void)fresh, (void)sigma, (void)m, (void)lambda, (void)fresh_lambda, (void)nnz;
    (void)row, (void)col, (void)values, (void)data;
    return FALSE;
}

static const int column[] = {0, 1, 2, 4, 2, 0, 4}; // 0, 2 and 4 twice
static const double small[] = {1e-2, 1e-7, 1e-3, 1, 1, 1, 1, 1, 1};

// The options of a programme of eight rows, with a place to work in that has been used before.
static void ask(int entries, const double *g_scale, moray_nlp_settings settings, moray_linear_solver solver,
                const char *wanted)
{
    const moray_nlp nlp = {
        .n = 6, .m = 8, .g_scale = g_scale, .nnz_jac = entries, .jac_row = column, .jac_col = column};
    double work[] = {7, 7, 1, 1, 7, 1}, lower = 0, upper = 1;
    IpoptProblem problem = CreateIpoptProblem(1, &lower, &upper, 0, NULL, NULL, 0, 0, 0, no_value, no_rows, no_value,
                                              no_slopes, no_curvature);
    asked[0] = 0;
    CHECK(problem && moray_ipopt_set_options(problem, &nlp, &settings, solver, work), "taken");
    CHECK(strcmp(asked, wanted) == 0, "asked for %s", asked);
    FreeIpoptProblem(problem);
}

static void test_options(void)
{
    moray_nlp_settings settings = moray_nlp_settings_default();
    ask(7, NULL, settings, MORAY_LINEAR_MUMPS,
        "tol=1e-08 max_iter=1000 print_level=0 mu_init=0.1 bound_relax_factor=0 mumps_permuting_scaling=0 "
        "mumps_pivot_order=6 ");
    ask(6, NULL, settings, MORAY_LINEAR_MUMPS,
        "tol=1e-08 max_iter=1000 print_level=0 mu_init=0.1 bound_relax_factor=0 mumps_permuting_scaling=0 ");
    settings.max_cpu_seconds = 5, settings.barrier = 0, settings.max_iterations = 3, settings.warm = true;
    ask(7, small, settings, MORAY_LINEAR_MORAY,
        "tol=1e-08 constr_viol_tol=0.1 acceptable_constr_viol_tol=10 max_iter=3 max_cpu_time=5 print_level=0 "
        "bound_relax_factor=0 min_refinement_steps=0 ma57_pivtolmax=0.1 ma57_pivtol=0.0001 "
        "warm_start_bound_push=1e-09 warm_start_bound_frac=1e-09 warm_start_slack_bound_push=1e-09 "
        "warm_start_slack_bound_frac=1e-09 warm_start_mult_bound_push=1e-09 ");
    settings.tolerance = 1e-10, settings.warm = false;
    ask(7, small + 1, settings, MORAY_LINEAR_MA57,
        "tol=1e-10 constr_viol_tol=0.001 acceptable_constr_viol_tol=0.1 max_iter=3 max_cpu_time=5 print_level=0 "
        "bound_relax_factor=0 ma57_pivtolmax=0.1 ma57_pivtol=0.0001 ");
    settings.tolerance = 1e-12;
    ask(7, small, settings, MORAY_LINEAR_MA57,
        "tol=1e-12 max_iter=3 max_cpu_time=5 print_level=0 bound_relax_factor=0 ma57_pivtolmax=0.1 "
        "ma57_pivtol=0.0001 ");
}

int main(void)
{
    test_log();
    test_descriptors();
    test_times();
    test_verdict();
    test_options();
    return tap_done();
}
