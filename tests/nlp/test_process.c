// SPDX-License-Identifier: MIT
//
// What the process around a solve has, and what must not change its result: files, threads, little memory, closed
// streams; and the options of Ipopt, which are given by name.
#define _GNU_SOURCE
#include "tap.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "moray/nlp.h"

// ---- minimise sum (x_i^4 - x_i), x_i x_(7919 i + 1 mod n) between 1 and 2: its factors are dense ----

typedef struct {
    int n, m, *row, *col;
    double *lower, *upper, *g_lower, *g_upper;
} chain;

static int partner(const chain *c, int i)
{
    return (i * 7919 + 1) % c->n;
}

static bool objective(void *self, const double *x, bool fresh, double *f)
{
    (void)fresh;
    const chain *c = self;
    *f = 0;
    for (int i = 0; i < c->n; i++)
        *f += x[i] * x[i] * x[i] * x[i] - x[i];
    return true;
}

static bool gradient(void *self, const double *x, bool fresh, double *slope)
{
    (void)fresh;
    const chain *c = self;
    for (int i = 0; i < c->n; i++)
        slope[i] = 4 * x[i] * x[i] * x[i] - 1;
    return true;
}

static bool constraints(void *self, const double *x, bool fresh, double *g)
{
    (void)fresh;
    const chain *c = self;
    for (int i = 0; i < c->m; i++)
        g[i] = x[i] * x[partner(c, i)];
    return true;
}

static bool jacobian(void *self, const double *x, bool fresh, double *values)
{
    (void)fresh;
    const chain *c = self;
    for (int i = 0; i < c->m; i++) {
        values[2 * i] = x[partner(c, i)];
        values[2 * i + 1] = x[i];
    }
    return true;
}

static bool hessian(void *self, const double *x, bool fresh, double sigma, const double *lambda, double *values)
{
    (void)fresh;
    const chain *c = self;
    for (int i = 0; i < c->n; i++)
        values[i] = 12 * sigma * x[i] * x[i];
    for (int i = 0; i < c->m; i++)
        values[c->n + i] = lambda[i];
    return true;
}

static void *need(void *block)
{
    if (!block)
        exit(1);
    return block;
}

static chain chain_new(int n)
{
    chain c = {.n = n, .m = n / 2};
    c.row = need(calloc(2 * (size_t)(2 * c.m + n + c.m), sizeof *c.row));
    c.col = c.row + 3 * c.m + n;
    c.lower = need(calloc(2 * (size_t)(n + c.m), sizeof *c.lower));
    c.upper = c.lower + n, c.g_lower = c.upper + n, c.g_upper = c.g_lower + c.m;
    for (int i = 0; i < n; i++) {
        c.lower[i] = -10, c.upper[i] = 10;
        c.row[2 * c.m + i] = c.col[2 * c.m + i] = i;
    }
    for (int i = 0; i < c.m; i++) {
        const int j = partner(&c, i);
        c.row[2 * i] = c.row[2 * i + 1] = i;
        c.col[2 * i] = i, c.col[2 * i + 1] = j;
        c.row[2 * c.m + n + i] = i > j ? i : j;
        c.col[2 * c.m + n + i] = i > j ? j : i;
        c.g_lower[i] = 1, c.g_upper[i] = 2;
    }
    return c;
}

static void chain_free(chain *c)
{
    free(c->row);
    free(c->lower);
}

// The objective, and the status of the solve.
static double solve(chain *c, const moray_nlp_settings *settings, moray_status *status, moray_nlp_info *info)
{
    const moray_nlp nlp = {.n = c->n,
                           .m = c->m,
                           .x_lower = c->lower,
                           .x_upper = c->upper,
                           .g_lower = c->g_lower,
                           .g_upper = c->g_upper,
                           .nnz_jac = 2 * c->m,
                           .nnz_hess = c->n + c->m,
                           .jac_row = c->row,
                           .jac_col = c->col,
                           .hess_row = c->row + 2 * c->m,
                           .hess_col = c->col + 2 * c->m,
                           .self = c,
                           .objective = objective,
                           .gradient = gradient,
                           .constraints = constraints,
                           .jacobian = jacobian,
                           .hessian = hessian};
    const size_t n = (size_t)c->n, m = (size_t)c->m;
    double *block = need(calloc(3 * n + 2 * m, sizeof *block));
    moray_iterate iterate = {
        .x = block, .z_lower = block + n, .z_upper = block + 2 * n, .g = block + 3 * n, .lambda = block + 3 * n + m};
    for (int i = 0; i < c->n; i++)
        iterate.x[i] = 1.5;
    *status = moray_ipopt_solve(&nlp, settings, &iterate, info);
    free(block);
    return iterate.objective;
}

static double solve_with(const char *key, const char *value, moray_status *status, moray_nlp_info *info)
{
    chain c = chain_new(40);
    const moray_key_value option = {key, value};
    moray_nlp_settings settings = moray_nlp_settings_default();
    settings.ipopt = &option;
    settings.n_ipopt = key != NULL;
    const double found = solve(&c, &settings, status, info);
    chain_free(&c);
    return found;
}

// ---- Options ----

static void test_options(void)
{
    moray_status status;
    moray_nlp_info info;
    solve_with("max_iter", "2", &status, &info);
    CHECK(!moray_failed(status) && info.outcome == MORAY_NLP_ITERATION_LIMIT && info.iterations == 2,
          "an integer: %d iterations", info.iterations);
    solve_with("tol", "1e-2", &status, &info);
    const int loose = info.iterations;
    solve_with("tol", "1", &status, &info);
    CHECK(!moray_failed(status) && info.iterations <= loose, "a number, also without a point: %s", status.text);
    solve_with("mu_strategy", "adaptive", &status, &info);
    const int adaptive = info.iterations;
    const double usual = solve_with(NULL, NULL, &status, &info);
    CHECK(!moray_failed(status) && info.iterations != adaptive && info.iterations > loose,
          "a text: %d iterations, %d without", adaptive, info.iterations);
    CHECK(isfinite(usual), "objective %g", usual);
}

static void check_refused(const char *key, const char *value, const char *expected)
{
    moray_status status;
    moray_nlp_info info;
    solve_with(key, value, &status, &info);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, expected), "%s", status.text);
}

// The option that is wrong is named, not the one before it.
static void test_second_option(void)
{
    chain c = chain_new(40);
    const moray_key_value options[] = {{"tol", "1e-6"}, {"print_level", "loud"}};
    moray_nlp_settings settings = moray_nlp_settings_default();
    moray_status status;
    moray_nlp_info info;
    settings.ipopt = options;
    settings.n_ipopt = 2;
    solve(&c, &settings, &status, &info);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "ipopt.print_level = loud: must be"), "%s", status.text);
    chain_free(&c);
}

static void test_refusals(void)
{
    test_second_option();
    check_refused("tolerance", "1", "ipopt.tolerance: Ipopt has no such option");
    check_refused("", "1", "ipopt.: Ipopt has no such option");
    check_refused("tol", "small", "ipopt.tol = small: not a value");
    check_refused("tol", "-1", "ipopt.tol = -1: not a value");
    check_refused("tol", "0,1", "ipopt.tol = 0,1: not a value");
    check_refused("max_iter", "1.5", "ipopt.max_iter = 1.5: not a value");
    check_refused("mu_strategy", "brave", "ipopt.mu_strategy = brave: not a value");
    check_refused("mu_strategy", "", "ipopt.mu_strategy = (empty): not a value");
    check_refused("option_file_name", "ipopt.opt", "ipopt.option_file_name cannot be set: no option file is read");
    check_refused("output_file", "/no/such", "ipopt.output_file cannot be set");
    check_refused("sb", "no", "ipopt.sb cannot be set");
    check_refused("print_level", "x", "ipopt.print_level = x: must be an integer from 0 to 12");
    check_refused("print_level", "13", "print level 13: must lie between 0 and 12");
    check_refused("linear_solver", "ma27", "ipopt.linear_solver cannot be set: it is a setting of moray's own");
}

// ---- Standard output, the working directory ----

// What the calls write on standard output, and how much on standard error.
static long written(int stream, void (*calls)(void))
{
    FILE *file = tmpfile();
    fflush(stdout);
    const int before = dup(stream);
    if (!file || before < 0 || dup2(fileno(file), stream) < 0)
        exit(1);
    calls();
    fflush(NULL);
    dup2(before, stream);
    close(before);
    const long bytes = lseek(fileno(file), 0, SEEK_END);
    fclose(file);
    return bytes;
}

static void refuse_and_log(void)
{
    static const char *const given[][2] = {{"tolerance", "1"},       {"tol", "-1"},
                                           {"print_level", "5"},     {"print_options_documentation", "yes"},
                                           {"print_level", "99"},    {"print_user_options", "yes"},
                                           {"mu_strategy", "brave"}, {"derivative_test", "first-order"}};
    for (unsigned i = 0; i < sizeof given / sizeof *given; i++) {
        moray_status status;
        moray_nlp_info info;
        solve_with(given[i][0], given[i][1], &status, &info);
    }
}

static void test_streams(void)
{
    CHECK(written(STDOUT_FILENO, refuse_and_log) == 0, "nothing of Ipopt stands on standard output");
    CHECK(written(STDERR_FILENO, refuse_and_log) > 1000, "its log stands on standard error");
}

static void test_option_file(void)
{
    char directory[] = "/tmp/moray-test-XXXXXX", *before = need(getcwd(NULL, 0));
    moray_status status;
    moray_nlp_info info[2];
    const double first = solve_with(NULL, NULL, &status, &info[0]);
    if (!mkdtemp(directory) || chdir(directory) != 0)
        exit(1);
    FILE *file = need(fopen("ipopt.opt", "w"));
    fputs("max_iter 3\ntol 1e-2\nprint_level 5\n", file);
    fclose(file);
    const double second = solve_with(NULL, NULL, &status, &info[1]);
    CHECK(first == second && info[0].iterations == info[1].iterations && info[1].iterations > 3,
          "ipopt.opt in the working directory changes nothing: %d iterations, %d without", info[1].iterations,
          info[0].iterations);
    unlink("ipopt.opt");
    if (chdir(before) != 0)
        exit(1);
    rmdir(directory);
    free(before);
}

// ---- Threads ----

enum { repetitions = 12, threads = 4 };

typedef struct {
    int n;
    moray_linear_solver solver;
    double found[repetitions];
    bool solved;
} work;

static void *repeat(void *self)
{
    work *w = self;
    w->solved = true;
    for (int k = 0; k < repetitions; k++) {
        chain c = chain_new(w->n);
        moray_nlp_settings settings = moray_nlp_settings_default();
        moray_status status;
        moray_nlp_info info;
        settings.linear_solver = w->solver;
        w->found[k] = solve(&c, &settings, &status, &info);
        w->solved = w->solved && !moray_failed(status) && info.outcome == MORAY_NLP_SOLVED;
        chain_free(&c);
    }
    return NULL;
}

static void test_threads(moray_linear_solver solver)
{
    static work alone[threads], together[threads];
    pthread_t thread[threads];
    for (int i = 0; i < threads; i++) {
        alone[i].n = together[i].n = 60 + 20 * i;
        alone[i].solver = together[i].solver = solver;
        repeat(&alone[i]);
    }
    for (int i = 0; i < threads; i++)
        if (pthread_create(&thread[i], NULL, repeat, &together[i]) != 0)
            exit(1);
    for (int i = 0; i < threads; i++) {
        pthread_join(thread[i], NULL);
        CHECK(alone[i].solved && together[i].solved &&
                  memcmp(alone[i].found, together[i].found, sizeof alone[i].found) == 0,
              "%s, thread %d of %d, %d variables: as alone, to the last bit", moray_linear_solver_text(solver), i + 1,
              (int)threads, alone[i].n);
    }
}

// ---- Memory ----

// The code of a solve that may take so many megabytes more than it has; in a process of its own.
static int code_within(int megabytes, int variables, moray_linear_solver solver)
{
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        chain c = chain_new(variables);
        long pages = 0;
        moray_status status;
        moray_nlp_info info;
        moray_nlp_settings settings = moray_nlp_settings_default();
        settings.max_iterations = 2;
        settings.linear_solver = solver;
        FILE *file = need(fopen("/proc/self/statm", "r"));
        if (fscanf(file, "%ld", &pages) != 1)
            exit(1);
        fclose(file);
        const rlim_t most = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) + ((rlim_t)megabytes << 20);
        setrlimit(RLIMIT_AS, &(struct rlimit){most, most});
        solve(&c, &settings, &status, &info);
        if (status.code == MORAY_MEMORY && !strstr(status.text, "no memory"))
            _exit(99);
        _exit((int)status.code);
    }
    int ended;
    waitpid(child, &ended, 0);
    return WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
}

static bool has_sanitizer(void)
{
#ifdef __SANITIZE_ADDRESS__
    return true;
#else
    return false;
#endif
}

static void test_memory(void)
{
    if (has_sanitizer()) {
        CHECK(true, "out of memory # SKIP the sanitizer needs the address space");
        return;
    }
    for (int megabytes = 1; megabytes <= 16; megabytes *= 2)
        for (int own = 0; own < 2; own++) {
            const moray_linear_solver solver = own ? MORAY_LINEAR_MORAY : MORAY_LINEAR_MUMPS;
            const int code = code_within(megabytes, 2500, solver);
            CHECK(code == MORAY_MEMORY || (megabytes >= 4 && code == MORAY_OK), "%s within %d MB: %s",
                  moray_linear_solver_text(solver), megabytes,
                  code >= 0 ? moray_code_text((moray_code)code) : "crashed");
        }
}

int main(void)
{
    test_memory(); // first: what the others free would be there to take
    test_options();
    test_refusals();
    test_streams();
    test_option_file();
    test_threads(MORAY_LINEAR_MUMPS);
    test_threads(MORAY_LINEAR_MORAY);
    return tap_done();
}
