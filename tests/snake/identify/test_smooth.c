// SPDX-License-Identifier: MIT
//
// Regression splines: quintics are reproduced, and of noisy values the residuals and the number of pieces are those of
// dense least squares on truncated powers, which share nothing with B-splines.
#include "tap.h"

#include "snake/identify/motion.h"

enum { N = 48, STRIDE = 2, DEGREE = 5, MOST = 32 };
static const double from = 3, length = 4;

static bool is_missing(int k)
{
    return k == 11 || k == 12 || k == 30;
}

// ---- Quintics ------------------------------------------------------------------------------------------------------

static double quintic(double t, int derivative)
{
    static const double c[] = {0.3, -1, 0.5, 0.2, -0.3, 0.07};
    double value = 0;
    for (int k = DEGREE; k >= derivative; k--) {
        double factor = c[k];
        for (int d = 0; d < derivative; d++)
            factor *= k - d;
        value = value * (t - 5) + factor;
    }
    return value;
}

// With values missing, beside others that are not its own, and beyond both ends, as exactly as the weight of third
// differences, 1e-12, lets through.
static void test_quintic(void)
{
    double t[N], y[N * STRIDE], d[3];
    struct smooth s;
    for (int k = 0; k < N; k++) {
        t[k] = from + length * k / (N - 1);
        y[k * STRIDE] = is_missing(k) ? NAN : quintic(t[k], 0);
        y[k * STRIDE + 1] = 1e3;
    }
    CHECK_OK(moray_smooth_fit(&s, N, t, y, STRIDE), "fit");
    CHECK_NEAR(s.noise, 0, 1e-8, "without noise");
    for (double at = from - 0.1; at < from + length + 0.11; at += 0.15) {
        moray_smooth_at(&s, at, d);
        CHECK_NEAR(d[0], quintic(at, 0), 1e-6, "value");
        CHECK_NEAR(d[1], quintic(at, 1), 2e-5, "slope");
        CHECK_NEAR(d[2], quintic(at, 2), 5e-4, "second derivative");
    }
    moray_smooth_free(&s);
}

// ---- Noise ---------------------------------------------------------------------------------------------------------

static double dot(const double *a, const double *b)
{
    double sum = 0;
    for (int k = 0; k < N; k++)
        sum += a[k] * b[k];
    return sum;
}

// Takes away from v, twice against rounding, what lies along the n orthonormal ones.
static void project_out(double (*basis)[N], int n, double *v)
{
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < n; i++) {
            const double part = dot(basis[i], v);
            for (int k = 0; k < N; k++)
                v[k] -= part * basis[i][k];
        }
}

// Sum of squares that splines of so many equal pieces leave of the values that there are.
static double left_over(int pieces, const double *t, const double *y)
{
    double basis[MOST][N], rest[N];
    for (int i = 0; i < pieces + DEGREE; i++) {
        for (int k = 0; k < N; k++) {
            const double at = (t[k] - from) / length, beyond = at - (double)(i - DEGREE) / pieces;
            basis[i][k] = is_missing(k) ? 0 : i <= DEGREE ? pow(at - 0.5, i) : pow(fmax(beyond, 0), DEGREE);
        }
        project_out(basis, i, basis[i]);
        const double size = sqrt(dot(basis[i], basis[i]));
        for (int k = 0; k < N; k++)
            basis[i][k] /= size;
    }
    for (int k = 0; k < N; k++)
        rest[k] = is_missing(k) ? 0 : y[k];
    project_out(basis, pieces + DEGREE, rest);
    return dot(rest, rest);
}

// The number of pieces with the least n RSS / (n - p)^2 of those that leave every coefficient two values.
static int best_pieces(int used, const double *t, const double *y)
{
    double best = INFINITY;
    int chosen = 0;
    for (int pieces = 2; pieces + DEGREE <= used / 2; pieces += 1 + pieces / 5) {
        const double score = left_over(pieces, t, y) / pow(used - pieces - DEGREE, 2);
        if (score < best)
            best = score, chosen = pieces;
    }
    return chosen;
}

// How many pieces are chosen for a wave with noise.
static int check_wave(double frequency, double noise)
{
    double t[N], y[N];
    struct smooth s;
    int used = 0;
    for (int k = 0; k < N; k++) {
        t[k] = from + length * k / (N - 1);
        y[k] = is_missing(k) ? NAN : sin(frequency * t[k]) + noise * remainder(4e4 * sin(13 * k), 1);
        used += !is_missing(k);
    }
    CHECK_OK(moray_smooth_fit(&s, N, t, y, 1), "fit");
    const int pieces = best_pieces(used, t, y), freedom = used - pieces - DEGREE;
    CHECK(s.pieces == pieces, "%d pieces, by brute force %d", s.pieces, pieces);
    CHECK_NEAR(s.width, length / pieces, 1e-12, "of this width");
    CHECK(s.freedom == freedom, "%d degrees of freedom, by count %d", s.freedom, freedom);
    CHECK_RELATIVE(s.noise, sqrt(left_over(pieces, t, y) / freedom), 1e-6, "noise");
    moray_smooth_free(&s);
    return pieces;
}

static void test_waves(void)
{
    int waves = 0, with_more = 0;
    for (double frequency = 0.5; frequency < 9; frequency += 1.5, waves++)
        with_more += check_wave(frequency, 0.002) > 4;
    CHECK(check_wave(14, 0.02) == 2 && with_more > 0 && with_more < waves, "%d of %d waves want many pieces", with_more,
          waves);
}

// ---- Too few -------------------------------------------------------------------------------------------------------

// Two pieces have seven coefficients, each of which wants two values.
static void test_few(void)
{
    double t[15], y[15];
    struct smooth s;
    for (int k = 0; k < 15; k++) {
        t[k] = k;
        y[k] = k == 4 ? NAN : (double)k;
    }
    CHECK_OK(moray_smooth_fit(&s, 15, t, y, 1), "fourteen values are enough");
    CHECK(s.pieces == 2 && s.freedom == 14 - 7, "%d pieces, %d degrees of freedom", s.pieces, s.freedom);
    moray_smooth_free(&s);
    y[5] = NAN;
    CHECK(moray_smooth_fit(&s, 15, t, y, 1).code == MORAY_INPUT, "thirteen are not");
    moray_smooth_free(&s);
}

// Of values that are nothing every number of pieces leaves nothing: the fewest are taken.
static void test_nothing(void)
{
    double t[N], y[N] = {0};
    struct smooth s;
    for (int k = 0; k < N; k++)
        t[k] = from + length * k / (N - 1);
    CHECK_OK(moray_smooth_fit(&s, N, t, y, 1), "fit");
    CHECK(s.pieces == 2 && s.noise == 0, "%d pieces, noise %g", s.pieces, s.noise);
    moray_smooth_free(&s);
}

int main(void)
{
    test_quintic();
    test_waves();
    test_few();
    test_nothing();
    return tap_done();
}
