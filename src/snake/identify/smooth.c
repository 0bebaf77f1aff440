// SPDX-License-Identifier: MIT
//
// Regression splines: B-splines of degree 5 on equal pieces, normal equations of bandwidth 6, and the number of pieces
// by generalised cross-validation (Craven & Wahba 1979), n RSS / (n - p)^2.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "snake/identify/motion.h"

enum { DEGREE = 5, BAND = DEGREE + 1, LEAST_PIECES = 2 };
static const double regular = 1e-12; // of third differences: what the data leave open in a gap stays smooth

// ---- B-splines -----------------------------------------------------------------------------------------------------

// Those of a degree on [0, 1] of equal pieces: w[degree + 1].
static void basis(int degree, double u, double *w)
{
    w[0] = 1;
    for (int j = 1; j <= degree; j++) {
        double saved = 0;
        for (int r = 0; r < j; r++) {
            const double part = w[r] / j;
            w[r] = saved + (r + 1 - u) * part;
            saved = (u + j - r - 1) * part;
        }
        w[j] = saved;
    }
}

static int place(const struct smooth *s, double t, double *u)
{
    const double at = (t - s->from) / s->width;
    int piece = (int)floor(at);
    piece = piece < 0 ? 0 : piece >= s->pieces ? s->pieces - 1 : piece;
    *u = at - piece;
    return piece;
}

void moray_smooth_at(const struct smooth *s, double t, double d[3])
{
    double u, w[BAND], slope[BAND] = {0}, bend[BAND] = {0};
    const double *c = s->c + place(s, t, &u);
    basis(DEGREE, u, w);
    basis(DEGREE - 1, u, slope);
    basis(DEGREE - 2, u, bend);
    d[0] = d[1] = d[2] = 0;
    for (int j = 0; j < BAND; j++)
        d[0] += c[j] * w[j];
    for (int j = 0; j < DEGREE; j++)
        d[1] += (c[j + 1] - c[j]) * slope[j] / s->width;
    for (int j = 0; j < DEGREE - 1; j++)
        d[2] += (c[j + 2] - 2 * c[j + 1] + c[j]) * bend[j] / (s->width * s->width);
}

// ---- Least squares -------------------------------------------------------------------------------------------------

// Banded Cholesky: a[i][k] is entry (i, i - k). False where it is not definite.
static bool factor(int n, double (*a)[BAND])
{
    for (int i = 0; i < n; i++)
        for (int k = i < DEGREE ? i : DEGREE; k >= 0; k--) {
            double sum = a[i][k];
            for (int q = k + 1; q < BAND && q <= i; q++)
                sum -= a[i][q] * a[i - k][q - k];
            if (k == 0 && !(sum > 0))
                return false;
            a[i][k] = k == 0 ? sqrt(sum) : sum / a[i - k][0];
        }
    return true;
}

static void solve(int n, double (*a)[BAND], double *x)
{
    for (int i = 0; i < n; i++) {
        for (int k = 1; k < BAND && k <= i; k++)
            x[i] -= a[i][k] * x[i - k];
        x[i] /= a[i][0];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = 1; k < BAND && i + k < n; k++)
            x[i] -= a[i + k][k] * x[i + k];
        x[i] /= a[i][0];
    }
}

static void add_regularity(int n, double (*a)[BAND], double weight)
{
    static const double third[4] = {-1, 3, -3, 1};
    for (int i = 0; i + 3 < n; i++)
        for (int p = 0; p < 4; p++)
            for (int q = 0; q <= p; q++)
                a[i + p][p - q] += weight * third[p] * third[q];
}

static moray_status fit_pieces(struct smooth *s, double (*a)[BAND], int n, const double *t, const double *y, int stride)
{
    const int p = s->pieces + DEGREE;
    double u, w[BAND], sum = 0, d[3];
    int used = 0;
    memset(a, 0, (size_t)p * sizeof *a);
    memset(s->c, 0, (size_t)p * sizeof *s->c);
    for (int k = 0; k < n; k++) {
        if (isnan(y[k * stride]))
            continue;
        const int first = place(s, t[k], &u);
        basis(DEGREE, u, w);
        for (int i = 0; i < BAND; i++) {
            s->c[first + i] += w[i] * y[k * stride];
            for (int j = 0; j <= i; j++)
                a[first + i][i - j] += w[i] * w[j];
        }
        used++;
    }
    add_regularity(p, a, regular * used);
    if (!factor(p, a))
        return moray_error(MORAY_NUMERIC, "a spline of %d pieces through %d values is not determined", s->pieces, used);
    solve(p, a, s->c);
    for (int k = 0; k < n; k++) {
        if (isnan(y[k * stride]))
            continue;
        moray_smooth_at(s, t[k], d);
        sum += (y[k * stride] - d[0]) * (y[k * stride] - d[0]);
    }
    s->freedom = used - p;
    s->noise = sqrt(sum / s->freedom);
    return moray_ok();
}

static moray_status choose_pieces(struct smooth *s, double (*a)[BAND], int used, int n, const double *t,
                                  const double *y, int stride)
{
    const double length = t[n - 1] - t[0];
    double best = INFINITY;
    int chosen = LEAST_PIECES;
    for (int pieces = LEAST_PIECES; pieces + DEGREE <= used / 2; pieces += 1 + pieces / 5) {
        s->pieces = pieces;
        s->width = length / pieces;
        if (moray_failed(fit_pieces(s, a, n, t, y, stride)))
            continue;
        const double score = s->noise * s->noise * used / s->freedom;
        if (score < best)
            best = score, chosen = pieces;
    }
    s->pieces = chosen;
    s->width = length / chosen;
    return fit_pieces(s, a, n, t, y, stride);
}

moray_status moray_smooth_fit(struct smooth *s, int n, const double *t, const double *y, int stride)
{
    int used = 0;
    for (int k = 0; k < n; k++)
        used += !isnan(y[k * stride]);
    *s = (struct smooth){.from = t[0]};
    if (used < 2 * (LEAST_PIECES + DEGREE))
        return moray_error(MORAY_INPUT, "%d values are too few for a spline", used);
    s->c = calloc((size_t)used, sizeof *s->c);
    double(*a)[BAND] = calloc((size_t)used, sizeof *a);
    moray_status status = moray_error(MORAY_MEMORY, "no memory for a spline through %d values", used);
    if (s->c && a)
        status = choose_pieces(s, a, used, n, t, y, stride);
    free(a);
    return status;
}

void moray_smooth_free(struct smooth *s)
{
    free(s->c);
    *s = (struct smooth){0};
}
