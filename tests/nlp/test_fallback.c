// SPDX-License-Identifier: MIT
//
// A programme on which our own factors fill up, and MUMPS takes over: min |x|^2 / 2 + |y|^2 / 2, STEP x_i + w_i p =
// w_i, whose pivots can all but one be had only after the last unknown, p. Solved by x = 0, y = 0, p = 1. The y make it
// one of too many degrees of freedom for the null space, where it would be easy.
#include "tap.h"

#include <string.h>
#include <unistd.h>

#include "moray/nlp.h"
#include "nlp/ipopt_log.h"

enum { ROWS = 1100, FREE = 40, COLUMNS = ROWS + 1 + FREE }; // x, p, y
static const double step = 1e-3;

static double weight(int i)
{
    return (1.0 + i) / ROWS;
}

static bool objective(void *self, const double *x, bool fresh, double *f)
{
    (void)self, (void)fresh;
    *f = 0;
    for (int i = 0; i < COLUMNS; i++)
        *f += i == ROWS ? 0 : x[i] * x[i] / 2;
    return true;
}

static bool gradient(void *self, const double *x, bool fresh, double *g)
{
    (void)self, (void)fresh;
    memcpy(g, x, COLUMNS * sizeof *g);
    g[ROWS] = 0;
    return true;
}

static bool constraints(void *self, const double *x, bool fresh, double *g)
{
    (void)self, (void)fresh;
    for (int i = 0; i < ROWS; i++)
        g[i] = step * x[i] + weight(i) * x[ROWS];
    return true;
}

static bool jacobian(void *self, const double *x, bool fresh, double *v)
{
    (void)self, (void)x, (void)fresh;
    for (int i = 0; i < ROWS; i++) {
        v[2 * i] = step;
        v[2 * i + 1] = weight(i);
    }
    return true;
}

static bool hessian(void *self, const double *x, bool fresh, double sigma, const double *lambda, double *v)
{
    (void)self, (void)x, (void)fresh, (void)lambda;
    for (int i = 0; i < COLUMNS - 1; i++)
        v[i] = sigma;
    return true;
}

static moray_status solve(moray_linear_solver solver, double *p, moray_nlp_info *info)
{
    static double lower[COLUMNS], upper[COLUMNS], right[ROWS];
    static double x[COLUMNS], z_lower[COLUMNS], z_upper[COLUMNS], g[ROWS], lambda[ROWS];
    static int jac_row[2 * ROWS], jac_col[2 * ROWS], diagonal[COLUMNS - 1];
    const moray_nlp nlp = {.n = COLUMNS,
                           .m = ROWS,
                           .x_lower = lower,
                           .x_upper = upper,
                           .g_lower = right,
                           .g_upper = right,
                           .nnz_jac = 2 * ROWS,
                           .nnz_hess = COLUMNS - 1,
                           .jac_row = jac_row,
                           .jac_col = jac_col,
                           .hess_row = diagonal,
                           .hess_col = diagonal,
                           .objective = objective,
                           .gradient = gradient,
                           .constraints = constraints,
                           .jacobian = jacobian,
                           .hessian = hessian};
    moray_nlp_settings settings = moray_nlp_settings_default();
    settings.linear_solver = solver;
    for (int i = 0; i < COLUMNS; i++) {
        lower[i] = -MORAY_INFINITY;
        upper[i] = MORAY_INFINITY;
        x[i] = 2;
    }
    for (int i = 0; i < ROWS; i++) {
        jac_row[2 * i] = jac_row[2 * i + 1] = jac_col[2 * i] = diagonal[i] = i;
        jac_col[2 * i + 1] = ROWS;
        right[i] = weight(i);
    }
    for (int i = ROWS; i < COLUMNS - 1; i++)
        diagonal[i] = i + 1;
    const moray_status status =
        moray_ipopt_solve(&nlp, &settings, &(moray_iterate){x, z_lower, z_upper, g, lambda, 0}, info);
    *p = x[ROWS];
    return status;
}

// In a log in which nothing stands there is no line, and what is beside the room for it stays.
static void test_empty_log(void)
{
    enum { room = 200 };
    char line[room + 3];
    struct ipopt_log log;
    memset(line, 'x', room);
    memcpy(line + room, "\n?", 3);
    CHECK(moray_ipopt_log_open(&log), "a log");
    CHECK(!moray_ipopt_log_find(&log, "words", line, room) && line[0] == 0 && line[room] == '\n', "nothing is found");
    moray_ipopt_log_close(&log);
}

// A log may have any descriptor, the one of standard input where that is closed.
static void test_first_descriptor(void)
{
    struct ipopt_log log;
    char line[20];
    const int kept = dup(STDIN_FILENO);
    close(STDIN_FILENO);
    const bool opened = moray_ipopt_log_open(&log);
    CHECK(opened && log.file == 0 && write(log.file, "some words\n", 11) == 11, "a log in place of standard input");
    CHECK(moray_ipopt_log_find(&log, "words", line, sizeof line) && strcmp(line, "some words") == 0, "is read: %s",
          line);
    moray_ipopt_log_close(&log);
    if (kept >= 0) {
        dup2(kept, STDIN_FILENO);
        close(kept);
    }
}

// What Ipopt says of its linear systems: time of the processor, the system's beside it.
static void test_linear_seconds(void)
{
    static const struct {
        const char *text;
        double seconds;
    } cases[] = {
        {"Other....:  9.0 (sys: 9.0 wall: 9.0)\n  StdAugSystemSolverMultiSolve.....:  1.250 (sys:  0.500 wall:  "
         "1.900)\n",
         1.75},
        {"StdAugSystemSolverMultiSolve.....:  1.250\n", NAN},
        {"StdAugSystemSolverMultiSolve\n", NAN},
        {"nothing\n", NAN},
    };
    for (int k = 0; k < 4; k++) {
        struct ipopt_log log;
        const size_t length = strlen(cases[k].text);
        CHECK(moray_ipopt_log_open(&log), "a log");
        CHECK(write(log.file, cases[k].text, length) == (ssize_t)length, "written");
        const double seconds = moray_ipopt_log_linear_seconds(&log);
        CHECK(isnan(cases[k].seconds) ? isnan(seconds) : seconds == cases[k].seconds, "%g s", seconds);
        moray_ipopt_log_close(&log);
    }
}

int main(void)
{
    test_linear_seconds();
    test_empty_log();
    test_first_descriptor();
    moray_nlp_info info;
    double p;
    CHECK(moray_nlp_settings_default().linear_solver == MORAY_LINEAR_MORAY, "our own is the default");
    CHECK_OK(solve(MORAY_LINEAR_MUMPS, &p, &info), "MUMPS");
    CHECK(info.outcome == MORAY_NLP_SOLVED && fabs(p - 1) < 1e-6, "finds p = %.9g", p);
    CHECK(info.linear_solver == MORAY_LINEAR_MUMPS && !moray_failed(info.linear_fallback), "as it was asked to");
    CHECK_OK(solve(MORAY_LINEAR_MORAY, &p, &info), "our own");
    CHECK(info.outcome == MORAY_NLP_SOLVED && fabs(p - 1) < 1e-6, "p = %.9g is found", p);
    CHECK(info.linear_solver == MORAY_LINEAR_MUMPS && info.linear_fallback.code == MORAY_NOT_SOLVED &&
              strstr(info.linear_fallback.text, "fill the factors"),
          "by MUMPS, told: %s", info.linear_fallback.text);
    return tap_done();
}
