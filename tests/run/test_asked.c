// SPDX-License-Identifier: MIT
//
// What a run asks of the solver, by its defaults and by its options, and what it says of each kind of certificate. The
// linker leads the solver's and the certificate's calls to the test's.
#include "tap.h"

#include <signal.h>
#include <string.h>
#include <unistd.h>

#include "moray/app/program.h"
#include "moray/app/run.h"
#include "moray/sim.h"

moray_status __wrap_moray_solve(const moray_ocp *ocp, const moray_settings *settings, const moray_guess *guess,
                                moray_solution **solution);
moray_status __real_moray_solve(const moray_ocp *ocp, const moray_settings *settings, const moray_guess *guess,
                                moray_solution **solution);
moray_status __wrap_moray_certify(const moray_solution *solution, const moray_integrator *integrator,
                                  moray_certificate *certificate);
moray_status __wrap_moray_solution_load(moray_solution **solution, const moray_ocp *ocp, const moray_settings *settings,
                                        const char *path);

static moray_settings asked;
static char scheme[40], ipopt[80];
static const moray_guess *begun;
static bool answers;         // interruptions, while it solves
static bool solves;          // else it fails at once
static int loads_intervals;  // of what is to be gone on with
static moray_status verdict; // of the certificate
static moray_certificate certificate;

moray_status __wrap_moray_solve(const moray_ocp *ocp, const moray_settings *settings, const moray_guess *guess,
                                moray_solution **solution)
{
    struct sigaction now;
    sigaction(SIGINT, NULL, &now);
    answers = now.sa_handler != SIG_DFL;
    asked = *settings;
    begun = guess;
    snprintf(scheme, sizeof scheme, "%s", settings->scheme);
    ipopt[0] = 0;
    for (int i = 0; i < settings->n_ipopt; i++)
        snprintf(ipopt + strlen(ipopt), sizeof ipopt - strlen(ipopt), "%s=%s;", settings->ipopt[i].key,
                 settings->ipopt[i].value);
    return solves ? __real_moray_solve(ocp, settings, guess, solution) : moray_error(MORAY_NOT_SOLVED, "not today");
}

moray_status __wrap_moray_certify(const moray_solution *solution, const moray_integrator *integrator,
                                  moray_certificate *result)
{
    (void)solution, (void)integrator;
    *result = certificate;
    return verdict;
}

moray_status __wrap_moray_solution_load(moray_solution **solution, const moray_ocp *ocp, const moray_settings *settings,
                                        const char *path)
{
    (void)solution, (void)ocp, (void)path;
    loads_intervals = settings->intervals;
    return moray_error(MORAY_IO, "nothing there");
}

// ---- A run ---------------------------------------------------------------------------------------------------------

static void slide(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void arrive(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase->q[0];
}

static int n_constants;     // of the problem
static char said[1000];     // on standard error
static bool answered_since; // interruptions, behind the solve

// Its exit code; what it prints is left out.
static int run(const moray_settings *settings, const moray_guess *guess, const char *const *words)
{
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = slide,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(1))};
    const moray_ocp_spec spec = {.name = "slide", .phases = 1, .phase = &phase, .endpoint = arrive};
    char text[30][60], *argv[31] = {text[0]};
    int argc = 1;
    snprintf(text[0], sizeof text[0], "slide");
    for (; words[argc - 1]; argc++) {
        snprintf(text[argc], sizeof text[argc], "%s", words[argc - 1]);
        argv[argc] = text[argc];
    }
    fflush(NULL);
    const int out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO);
    FILE *told = tmpfile();
    dup2(fileno(told), STDERR_FILENO);
    if (!freopen("/dev/null", "w", stdout))
        return -1;
    double value[MORAY_APP_CONSTANTS + 1];
    char key[MORAY_APP_CONSTANTS + 1][16];
    moray_app_constant constants[MORAY_APP_CONSTANTS + 1];
    for (int i = 0; i < n_constants; i++) {
        snprintf(key[i], sizeof key[i], "k%d", i);
        value[i] = i;
        constants[i] = (moray_app_constant){.key = key[i], .value = &value[i], .max = 100};
    }
    const int code = moray_app_run(
        &(moray_app){
            .spec = &spec, .settings = settings, .guess = guess, .constants = constants, .n_constants = n_constants},
        argc, argv);
    struct sigaction now;
    sigaction(SIGINT, NULL, &now);
    answered_since = now.sa_handler != SIG_DFL;
    fflush(NULL);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    close(out), close(err);
    rewind(told);
    said[fread(said, 1, sizeof said - 1, told)] = 0;
    fclose(told);
    return code;
}
#define RUN(settings, guess, ...) run((settings), (guess), (const char *const[]){__VA_ARGS__, NULL})

// ---- What is asked -------------------------------------------------------------------------------------------------

static moray_settings odd_settings(void)
{
    moray_settings s = moray_settings_default();
    s.scheme = "radau5";
    s.intervals = 13;
    s.tolerance = 1e-6;
    s.mesh_tolerance = 2e-4;
    s.max_refinements = 4;
    s.max_iterations = 123;
    s.max_variables = 4567;
    s.max_cpu_seconds = 8.5;
    s.barrier = 0.03;
    s.gauss_newton = true;
    s.linear_solver = MORAY_LINEAR_MUMPS;
    return s;
}

static void check_asked(const moray_settings *want, const char *want_ipopt)
{
    CHECK(answers && !answered_since, "interruptions are answered while it solves");
    CHECK(strcmp(scheme, want->scheme) == 0 && asked.intervals == want->intervals, "%s, %d intervals", scheme,
          asked.intervals);
    CHECK(asked.tolerance == want->tolerance && asked.mesh_tolerance == want->mesh_tolerance, "to %g, mesh to %g",
          asked.tolerance, asked.mesh_tolerance);
    CHECK(asked.max_refinements == want->max_refinements && asked.max_iterations == want->max_iterations &&
              asked.max_variables == want->max_variables && asked.max_cpu_seconds == want->max_cpu_seconds,
          "at most %d meshes, %d iterations, %d variables, %g s", asked.max_refinements, asked.max_iterations,
          asked.max_variables, asked.max_cpu_seconds);
    CHECK(asked.barrier == want->barrier && asked.gauss_newton == want->gauss_newton &&
              asked.linear_solver == want->linear_solver,
          "barrier %g, Gauss and Newton %d, factorisation %d", asked.barrier, asked.gauss_newton,
          (int)asked.linear_solver);
    CHECK(strcmp(ipopt, want_ipopt) == 0 && asked.progress && asked.observer, "Ipopt's: %s", ipopt);
}

static void test_asked(void)
{
    const moray_settings usual = moray_settings_default(), odd = odd_settings();
    const moray_guess guess = {.along_time = true};
    solves = false;
    CHECK(RUN(NULL, NULL, "--quiet") == MORAY_EXIT_NOT_SOLVED, "not solved");
    check_asked(&usual, "");
    CHECK(!begun && strcmp(said, "slide: not today\n") == 0, "%s", said);
    CHECK(RUN(&odd, &guess, "--quiet") == MORAY_EXIT_NOT_SOLVED && begun == &guess,
          "by settings and a guess of its own");
    check_asked(&odd, "");
    moray_settings want = {.scheme = "gauss3",
                           .intervals = 21,
                           .tolerance = 1e-5,
                           .mesh_tolerance = 3e-3,
                           .max_refinements = 7,
                           .max_iterations = 99,
                           .max_variables = 888,
                           .max_cpu_seconds = 7.5,
                           .barrier = 0.25,
                           .gauss_newton = false,
                           .linear_solver = MORAY_LINEAR_MA57};
    CHECK(RUN(&odd, NULL, "--quiet", "--scheme", "gauss3", "--intervals", "21", "--tol", "1e-5", "--set",
              "mesh_tol=3e-3", "--set", "refinements=7", "--set", "max_iterations=99", "--set", "max_variables=888",
              "--set", "max_cpu_seconds=7.5", "--set", "barrier=0.25", "--set", "gauss_newton=no", "--set",
              "linear_solver=ma57", "--set=ipopt.mu_init=1", "--set=ipopt.sb=yes") == MORAY_EXIT_NOT_SOLVED,
          "by options");
    check_asked(&want, "mu_init=1;sb=yes;");
}

// On the mesh of the file unless the options name another, by the number of its intervals or its scheme.
static void test_continued(void)
{
    const moray_settings odd = odd_settings();
    loads_intervals = -1;
    CHECK(RUN(&odd, NULL, "--continue", "f") == MORAY_EXIT_USAGE && loads_intervals == 0, "as in the file");
    CHECK(RUN(&odd, NULL, "--continue", "f", "--intervals", "13") == MORAY_EXIT_USAGE && loads_intervals == 0,
          "as usual");
    CHECK(RUN(&odd, NULL, "--continue", "f", "--intervals", "14") == MORAY_EXIT_USAGE && loads_intervals == 14,
          "by intervals");
    CHECK(RUN(&odd, NULL, "--continue", "f", "--scheme", "radau4") == MORAY_EXIT_USAGE && loads_intervals == 13,
          "by a scheme");
    CHECK(RUN(NULL, NULL, "--continue", "f", "--scheme", "radau4") == MORAY_EXIT_USAGE &&
              loads_intervals == moray_settings_default().intervals,
          "of the usual intervals");
    CHECK(strcmp(said, "slide: nothing there\n") == 0, "%s", said);
}

// ---- What is said --------------------------------------------------------------------------------------------------

static const double over = 1 + 1e-9;
static const moray_settings coarse = {.scheme = "trapezoid",
                                      .intervals = 3,
                                      .tolerance = 1e-8,
                                      .mesh_tolerance = 1e-4,
                                      .max_iterations = 100,
                                      .barrier = 0.1};

static void check_advice(const char *what, const char *advice)
{
    char want[300];
    verdict = moray_ok();
    CHECK(RUN(&coarse, NULL, "--quiet") == MORAY_EXIT_CERTIFICATE, "%s", what);
    snprintf(want, sizeof want, "slide: certificate failed: of this. %s\n", advice);
    CHECK(strcmp(said, want) == 0, "%s: %s, not %s", what, said, want);
    certificate = (moray_certificate){.why = "of this"};
}

static void test_advice(void)
{
    static const char *const
        derivatives = "the derivatives are wrong at the solution, or it lies on a kink of a function: see --check",
        *const short_of = "the solver stopped short of an optimum: try a smaller tol, or bounds and guesses of the "
                          "sizes that occur",
        *const mesh = "the mesh is too coarse: try more refinements, intervals or stages";
    solves = true;
    certificate = (moray_certificate){.why = "of this"};
    check_advice("nothing of these", "try more intervals or refinements");
    certificate.mesh_error = NAN;
    check_advice("no length", "bound its duration from below, or give a guess of its times: see --guess");
    certificate.derivatives = MORAY_LIMIT_DERIVATIVES * over;
    check_advice("derivatives", derivatives);
    certificate.derivatives = NAN;
    check_advice("none", derivatives);
    certificate.directions = MORAY_LIMIT_DIRECTIONS * over;
    check_advice("directions", derivatives);
    certificate.derivatives = MORAY_LIMIT_DERIVATIVES, certificate.directions = MORAY_LIMIT_DIRECTIONS;
    certificate.kkt = MORAY_LIMIT_KKT * over;
    check_advice("optimality", short_of);
    certificate.kkt = NAN, certificate.mesh_error = 0.99;
    check_advice("none, on a coarse mesh", short_of);
    certificate.kkt = INFINITY, certificate.derivatives = INFINITY, certificate.mesh_error = 1;
    check_advice("dynamics that leave nothing to be judged", mesh);
    certificate.kkt = MORAY_LIMIT_KKT, certificate.gap = MORAY_LIMIT_GAP * over;
    check_advice("slacks", "try a smaller tol");
    certificate.gap = MORAY_LIMIT_GAP, certificate.curvature = MORAY_LIMIT_CURVATURE * over;
    check_advice("a saddle", "try another guess");
    certificate.curvature = MORAY_LIMIT_CURVATURE, certificate.mesh_error = 1e-4 * over;
    check_advice("the mesh", mesh);
    certificate.mesh_error = 1e-4, certificate.unseen = MORAY_LIMIT_UNSEEN * over;
    check_advice("what no node tells", "try more refinements, or a phase for each side of a jump");
    certificate.unseen = MORAY_LIMIT_UNSEEN, certificate.curvature = NAN;
    check_advice("all of it just right", "try more intervals or refinements");
}

// As many constants as there may be, and one more.
static void test_constants(void)
{
    certificate = (moray_certificate){.pass = true};
    verdict = moray_ok();
    n_constants = MORAY_APP_CONSTANTS;
    CHECK(RUN(&coarse, NULL, "--quiet", "--set", "k31=7") == MORAY_EXIT_SOLVED && !*said, "%s", said);
    n_constants++;
    CHECK(RUN(&coarse, NULL, "--quiet") == MORAY_EXIT_USAGE && strcmp(said, "slide: 33 constants: at most 32\n") == 0,
          "%s", said);
    n_constants = 0;
}

// A certificate that cannot be made of numbers fails; one for which there is no memory ends the run.
static void test_certified(void)
{
    certificate = (moray_certificate){.pass = true};
    verdict = moray_ok();
    CHECK(RUN(&coarse, NULL, "--quiet") == MORAY_EXIT_SOLVED && !*said, "%s", said);
    verdict = moray_error(MORAY_NUMERIC, "left its domain");
    CHECK(RUN(&coarse, NULL, "--quiet") == MORAY_EXIT_CERTIFICATE && strstr(said, "certificate failed"), "%s", said);
    verdict = moray_error(MORAY_MEMORY, "no memory");
    CHECK(RUN(&coarse, NULL, "--quiet") == MORAY_EXIT_NOT_SOLVED && strcmp(said, "slide: no memory\n") == 0, "%s",
          said);
}

int main(void)
{
    test_asked();
    test_continued();
    test_advice();
    test_constants();
    test_certified();
    return tap_done();
}
