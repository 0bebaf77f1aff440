// SPDX-License-Identifier: MIT
//
// Dependence of constraints and violations that cannot be removed, on planted cases and against dense least squares.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "nlp/rank.h"

enum { m = 7, n = 12 };

// A dense Jacobian as a programme's; rows 2 and 5 span row 6, row 3 has nothing in the columns that are taken.
struct planted {
    double J[m][n], jac[m * n];
    int row[m * n], col[m * n];
    bool rows[m], cols[n];
    moray_nlp nlp;
};

static void plant(struct planted *p, unsigned long long seed)
{
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++) {
            const bool taken = j % 5 != 4;
            p->J[i][j] = i == 3 && taken ? 0 : tap_random(&seed, -1, 1);
            if (i == 6)
                p->J[i][j] = taken ? 3 * p->J[2][j] - 100 * p->J[5][j] : 8;
            p->row[i * n + j] = i;
            p->col[i * n + j] = j;
            p->jac[i * n + j] = p->J[i][j];
            p->rows[i] = true;
            p->cols[j] = taken;
        }
    p->nlp = (moray_nlp){.n = n, .m = m, .nnz_jac = m * n, .jac_row = p->row, .jac_col = p->col};
}

static void test_dependence(void)
{
    struct planted p;
    double weight[m], norm;
    plant(&p, 3);
    const struct selection all = {&p.nlp, p.jac, p.rows, p.cols};
    CHECK_OK(moray_nlp_dependent_rows(&all, weight, &norm), "all rows");
    CHECK(norm < 1e-10 && fabs(fabs(weight[3]) - 1) < 1e-6, "the empty row comes first, alone: %g, part %g", norm,
          weight[3]);
    p.rows[3] = false;
    CHECK_OK(moray_nlp_dependent_rows(&all, weight, &norm), "without it");
    double size[m] = {0}, other = 0;
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++)
            size[i] = hypot(size[i], p.cols[j] ? p.J[i][j] : 0);
    CHECK(norm < 1e-10, "three dependent rows: %.1e", norm);
    CHECK_NEAR(weight[2] / weight[6], -3 * size[2] / size[6], 1e-8, "part of the first");
    CHECK_NEAR(weight[5] / weight[6], 100 * size[5] / size[6], 1e-8, "part of the second");
    for (int i = 0; i < m; i++)
        other = tap_worse(other, i == 2 || i == 5 || i == 6 ? 0 : fabs(weight[i]));
    CHECK(other < 1e-8, "no part of others: %.1e", other);
    p.rows[5] = false;
    CHECK_OK(moray_nlp_dependent_rows(&all, weight, &norm), "five independent rows");
    CHECK(norm > 1e-3, "come to something: %.1e", norm);
}

// v without its part in the span of the columns, by Gram and Schmidt, twice for its rounding.
static void residual_of(const struct planted *p, const double *v, double *residual)
{
    double basis[n + 1][m];
    int found = 0;
    for (int j = 0; j <= n; j++) {
        double *here = basis[found], size = 0;
        for (int i = 0; i < m; i++)
            here[i] = p->rows[i] ? (j < n ? p->cols[j] * p->J[i][j] : v[i]) : 0;
        for (int k = 0; k < 2 * found; k++) {
            double part = 0;
            for (int i = 0; i < m; i++)
                part += basis[k % found][i] * here[i];
            for (int i = 0; i < m; i++)
                here[i] -= part * basis[k % found][i];
        }
        for (int i = 0; i < m; i++)
            size = hypot(size, here[i]);
        if (j == n)
            memcpy(residual, here, sizeof basis[0]);
        for (int i = 0; i < m && size > 1e-8; i++)
            here[i] /= size;
        found += size > 1e-8;
    }
}

static void test_unremovable(void)
{
    struct planted p;
    double violation[m], expected[m], worst = 0;
    unsigned long long seed = 9;
    plant(&p, 4);
    p.rows[1] = false;
    const struct selection selection = {&p.nlp, p.jac, p.rows, p.cols};
    for (int i = 0; i < m; i++)
        violation[i] = tap_random(&seed, -1, 1);
    residual_of(&p, violation, expected);
    CHECK_OK(moray_nlp_unremovable(&selection, violation), "least squares");
    for (int i = 0; i < m; i++)
        worst = tap_worse(worst, fabs(violation[i] - expected[i]));
    CHECK(worst < 1e-6 && fabs(expected[3]) > 0.01, "against orthogonal columns: %.1e", worst);
    for (int i = 0; i < m; i++) // J dx for some dx
        violation[i] = p.J[i][0] - 2 * p.J[i][6];
    CHECK_OK(moray_nlp_unremovable(&selection, violation), "what the columns can do");
    for (int i = 0; i < m; i++)
        worst = i ? fmax(worst, fabs(violation[i])) : fabs(violation[i]);
    CHECK(worst < 1e-6, "can be removed: %.1e", worst);
}

// Rows of norm 1 of which two depend on others: what comes out is what nothing removes of the row that has the most of
// it, of a start with a part in everything.
static void test_most_involved(void)
{
    int negative = 0, rows[m] = {0};
    double worst = 0;
    for (unsigned long long seed = 20; seed < 60; seed++) {
        struct planted p;
        unsigned long long random = seed;
        double start[m], left[m], alone[m] = {0}, expected[m], weight[m], size = 0, norm;
        int most = 0;
        plant(&p, seed);
        const double part[] = {tap_random(&random, -2, 2), tap_random(&random, -2, 2), tap_random(&random, -2, 2),
                               tap_random(&random, -2, 2)};
        for (int j = 0; j < n; j++) {
            p.J[3][j] = part[0] * p.J[1][j] + part[1] * p.J[2][j];
            p.J[6][j] = part[2] * p.J[2][j] + part[3] * p.J[5][j];
        }
        for (int i = 0; i < m; i++) {
            double length = 0;
            for (int j = 0; j < n; j++)
                length = hypot(length, p.cols[j] ? p.J[i][j] : 0);
            for (int j = 0; j < n; j++)
                p.jac[i * n + j] = p.J[i][j] /= length;
            start[i] = 1 + 0.5 * sin(12.9898 * i);
        }
        residual_of(&p, start, left);
        for (int i = 0; i < m; i++)
            most = fabs(left[i]) > fabs(left[most]) ? i : most;
        alone[most] = 1;
        residual_of(&p, alone, expected);
        for (int i = 0; i < m; i++)
            size = hypot(size, expected[i]);
        CHECK_OK(moray_nlp_dependent_rows(&(struct selection){&p.nlp, p.jac, p.rows, p.cols}, weight, &norm), "rows");
        for (int i = 0; i < m; i++)
            worst = tap_worse(worst, fabs(weight[i] - expected[i] / size));
        worst = tap_worse(worst, norm);
        negative += left[most] < 0;
        rows[most]++;
    }
    CHECK(worst < 1e-6, "from the row most involved: %.1e", worst);
    CHECK(negative > 4 && negative < 36 && rows[0] == 0 && rows[4] == 0 && rows[2] > 0 && rows[6] > 0,
          "which %d times has a negative part", negative);
}

static void test_nothing(void)
{
    struct planted p;
    double weight[m], norm;
    plant(&p, 3);
    memset(p.rows, 0, sizeof p.rows);
    const moray_status status =
        moray_nlp_dependent_rows(&(struct selection){&p.nlp, p.jac, p.rows, p.cols}, weight, &norm);
    CHECK(status.code == MORAY_NUMERIC && strcmp(status.text, "no dependence can be computed") == 0, "of no rows: %s",
          status.text);
}

int main(void)
{
    test_nothing();
    test_dependence();
    test_most_involved();
    test_unremovable();
    return tap_done();
}
