// SPDX-License-Identifier: MIT
//
// What normal equations of known eigenvalues say: rank, errors and covariance against their inverse.
#include "tap.h"

#include <string.h>

#include "moray/dense.h"
#include "moray/snake/identify.h"

enum { N = 4 };
static const double scale[N] = {2, 0.1, 30, 1};

// M = V' diag(value) V of a rotation V by planes, on the unknowns that are not held; those that are have what they
// have.
static void compose(const double *value, const bool *held, double M[N][N])
{
    double V[N][N] = {{0}};
    for (int i = 0; i < N; i++)
        V[i][i] = 1;
    for (int p = 0; p < N; p++)
        for (int q = 0; q < p; q++) {
            const double c = cos(0.4 + p + 2 * q), s = sin(0.4 + p + 2 * q);
            for (int j = 0; j < N && !held[p] && !held[q]; j++) {
                const double one = V[p][j], other = V[q][j];
                V[p][j] = c * one - s * other;
                V[q][j] = s * one + c * other;
            }
        }
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            M[i][j] = held[i] != held[j] ? 7 : 0;
            for (int k = 0; k < N && held[i] == held[j]; k++)
                M[i][j] += V[k][i] * value[k] * V[k][j];
        }
}

static moray_information examined(const double *value, const bool *held)
{
    moray_information info = {.n = N};
    double M[N][N];
    compose(value, held, M);
    memcpy(info.scale, scale, sizeof scale);
    memcpy(info.matrix, M, sizeof M);
    memcpy(info.held, held, N * sizeof *held);
    CHECK_OK(moray_information_examine(&info), "examined");
    return info;
}

// Covariance and errors are the inverse of the matrix of what varies, in units.
static void check_inverse(const moray_information *info, const char *what)
{
    double M[N * N], inverse[N * N] = {0};
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            M[i * N + j] = info->held[i] || info->held[j] ? i == j : info->matrix[i * N + j];
    for (int i = 0; i < N; i++)
        inverse[i * N + i] = 1;
    CHECK(moray_dense_solve(N, M, N, inverse), "%s: regular", what);
    for (int i = 0; i < N; i++) {
        const double variance = info->held[i] ? 0 : inverse[i * N + i];
        CHECK_RELATIVE(info->error[i] / scale[i], sqrt(variance), 1e-9, "standard error over scale");
        for (int j = 0; j < N; j++)
            CHECK_RELATIVE(info->covariance[i * N + j] / (scale[i] * scale[j]),
                           info->held[i] || info->held[j] ? 0 : inverse[i * N + j], 1e-9, "covariance over scales");
    }
}

static void test_known(void)
{
    static const bool none[N] = {false}, second[N] = {false, true};
    const double value[N] = {1e4, 300, 20, 5};
    moray_information info = examined(value, none);
    CHECK(info.rank == 4, "all four are known: %d", info.rank);
    for (int k = 0; k < N; k++)
        CHECK_RELATIVE(info.value[k] / value[k], 1, 1e-10, "an eigenvalue, the largest first");
    check_inverse(&info, "all");
    info = examined(value, second);
    CHECK(info.rank == 3, "three of them where one is held: %d", info.rank);
    CHECK(info.error[1] == 0, "which has no error");
    check_inverse(&info, "three");
    moray_information again = examined((const double[N]){9, 8, 7, 6}, none);
    memcpy(again.matrix, info.matrix, sizeof info.matrix);
    memcpy(again.held, info.held, sizeof info.held);
    CHECK_OK(moray_information_examine(&again), "examined again");
    CHECK(memcmp(&again, &info, sizeof info) == 0, "what was there before has no part in it");
}

// A direction is known where its standard error is below its scale and its eigenvalue is no rounding of the largest.
static void test_rank(void)
{
    static const bool none[N] = {false};
    static const struct {
        double value[N];
        int rank, open; // open: directions of no information at all
    } cases[] = {{{100, 10, 1.2, 0.8}, 3, 0},     {{1.2, 0.8, 0.5, 0.1}, 1, 0}, {{0.9, 0.8, 0.5, 0.1}, 0, 0},
                 {{1e14, 1e5, 1e2, 2}, 2, 2},     {{1e14, 1e2, 50, 0.5}, 1, 3}, {{1e14, 1e13, 1e12, 2e3}, 4, 0},
                 {{1e14, 1e13, 1e12, 5e2}, 3, 1}, {{1e6, 0.5, 0.4, 1e-8}, 1, 1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const moray_information info = examined(cases[k].value, none);
        CHECK(info.rank == cases[k].rank, "%g, %g, %g, %g: %d are known", cases[k].value[0], cases[k].value[1],
              cases[k].value[2], cases[k].value[3], info.rank);
        double trace = 0, told = 0;
        for (int i = 0; i < N && cases[k].open > 0; i++)
            CHECK(isinf(info.error[i]), "with a part in what is open an unknown has no error: %g", info.error[i]);
        for (int i = 0; i < N; i++)
            trace += info.covariance[i * N + i] / (scale[i] * scale[i]);
        for (int i = 0; i < N - cases[k].open; i++)
            told += 1 / cases[k].value[i];
        CHECK(fabs(trace / told - 1) < 0.05, "the covariance is that of what is no rounding: %g, %g", trace, told);
    }
}

// Of one unknown apart from the others the error is told by itself, however little is known of them.
static void test_apart(void)
{
    static const double known[] = {4, 1.1, 1, 0.9};
    for (int k = 0; k < 4; k++) {
        moray_information info = {.n = 2, .scale = {3, 1}, .matrix = {known[k], 0, 0, 1e-20}};
        CHECK_OK(moray_information_examine(&info), "examined");
        const double error = known[k] > 1 ? 3 / sqrt(known[k]) : INFINITY;
        CHECK(info.error[0] == error || fabs(info.error[0] - error) < 1e-12, "an error is %g, or beyond its scale",
              info.error[0]);
        CHECK(isinf(info.error[1]) && info.rank == (known[k] > 1), "what nothing tells of has none: %g", info.error[1]);
    }
}

static void told(double first, double second, const char *says)
{
    const double c = first / hypot(first, second), s = second / hypot(first, second), much = 100, little = 0.01;
    const int unknown[] = {moray_unknown_named("c_n"), moray_unknown_named("c_t")};
    char text[400];
    moray_information info = {.n = 2,
                              .scale = {1, 1},
                              .matrix = {much * s * s + little * c * c, (little - much) * c * s,
                                         (little - much) * c * s, much * c * c + little * s * s}};
    CHECK_OK(moray_information_examine(&info), "examined");
    moray_information_open(&info, unknown, text, sizeof text);
    CHECK(strstr(text, says), "open along (%g, %g): %s", first, second, text);
}

int main(void)
{
    test_known();
    test_rank();
    test_apart();
    told(1, 1, "difference or ratio");
    told(1, -1, "sum");
    told(1, -0.5, "0.50 of their scales at once");
    return tap_done();
}
