// SPDX-License-Identifier: MIT
//
// Which variables change places in a basis, against the same rule on a full matrix: the entry of Z = [-B^-1 N; I] that
// weighs most, while it is above a thousand; and how often a solution is refined.
#include "sample.h"

#include "linear/null_space_parts.h"
#include "moray/dense.h"

// Constraints in which two columns are much larger than the others, variables of curvatures far apart.
static void make(sample *s, unsigned long long seed, double distance)
{
    s->seed = seed;
    s->m = 2 + pick(s, 6);
    const int variables = s->m + 1 + pick(s, 6), one = pick(s, variables), other = pick(s, variables);
    start(s, variables + s->m);
    for (int i = 0; i < variables; i++) {
        put(s, i, i, (pick(s, 2) ? 1 : -1) * pow(10, tap_random(&s->seed, -2, 2) + 8 * pick(s, 2)));
        if (i > 0)
            put(s, i, i - 1, tap_random(&s->seed, -1e3, 1e3));
    }
    put_constraints(s, one, other, distance);
}

// Z[variable][column] of the basis that place tells; false where it is singular.
static bool find_Z(const sample *s, const int *place, double Z[MOST][MOST])
{
    const int m = s->m, variables = s->n - m, f = variables - m;
    double B[MOST * MOST], N[MOST * MOST];
    for (int c = 0; c < m; c++)
        for (int j = 0; j < variables; j++)
            if (place[j] >= 0)
                B[c * m + place[j]] = s->A[(variables + c) * s->n + j];
            else
                N[c * f - 1 - place[j]] = s->A[(variables + c) * s->n + j];
    if (!moray_dense_solve(m, B, f, N))
        return false;
    for (int j = 0; j < variables; j++)
        for (int k = 0; k < f; k++)
            Z[j][k] = place[j] >= 0 ? -N[place[j] * f + k] : k == -1 - place[j];
    return true;
}

static double weight_of(const sample *s, int j)
{
    return fmax(1, sqrt(fabs(s->A[j * s->n + j])));
}

// Returns how many exchanges were made; -1 where the rule cannot be followed.
static int follow_rule(const sample *s, int *place)
{
    const int variables = s->n - s->m, f = variables - s->m;
    double Z[MOST][MOST];
    for (int exchanges = 0; exchanges < 8 * f; exchanges++) {
        int other[MOST], variable = 0, column = 0;
        double most = 0;
        if (!find_Z(s, place, Z))
            return -1;
        for (int j = 0; j < variables; j++)
            if (place[j] < 0)
                other[-1 - place[j]] = j;
        for (int j = 0; j < variables; j++)
            for (int k = 0; k < f && place[j] >= 0; k++) {
                const double moved = fabs(Z[j][k]) * weight_of(s, j) / weight_of(s, other[k]);
                if (moved > most)
                    most = moved, variable = j, column = k;
            }
        if (most <= 1e3)
            return exchanges;
        place[other[column]] = place[variable];
        place[variable] = -1 - column;
    }
    return -1;
}

static void test_exchanges(void)
{
    static sample s;
    int wrong = 0, failed = 0, several = 0, all = 0;
    enum { samples = 1500 };
    for (int trial = 0; trial < samples; trial++) {
        struct basis basis;
        null_space *ns;
        int place[MOST];
        bool found = false, fits;
        make(&s, 300 + (unsigned long long)trial, trial % 3 ? 1e-5 : 1);
        const int variables = s.n - s.m;
        for (int view = 0; view < MORAY_BASIS_VIEWS && !found; view++)
            CHECK_OK(moray_basis_choose(&basis, variables, s.m, &s.pattern, s.value, view, &found), "looked for");
        memcpy(place, basis.place, (size_t)variables * sizeof *place);
        moray_basis_free(&basis);
        const int exchanges = follow_rule(&s, place);
        failed += exchanges < 0 || moray_failed(moray_null_space_new(&ns, s.n, &s.pattern)) || !ns;
        failed += moray_failed(moray_null_space_factor(ns, s.value, &fits)) || !fits;
        wrong += memcmp(place, ns->basis.place, (size_t)variables * sizeof *place) != 0;
        several += exchanges > 2;
        all += exchanges;
        moray_null_space_free(ns);
    }
    CHECK(failed == 0, "%d failed", failed);
    CHECK(wrong == 0 && all > samples && several > samples / 30, "the same basis, but for %d; %d exchanges, %d times 3",
          wrong, all, several);
}

// Variables that leave one after the other, each of which the last of the constraints needs twice as much of as the one
// after it: once twelve have left, that lets go of its own and takes the first one back.
static void test_return(void)
{
    enum { m = 13, f = 12, variables = m + f };
    static sample s;
    const double near = 0.97;
    null_space *ns;
    bool fits;
    int place[MOST];
    s.m = m;
    start(&s, variables + m);
    for (int i = 0; i < variables; i++) {
        const double weight = i < m ? 2.9e4 : pow(1.25, i - m);
        put(&s, i, i, weight * weight);
        place[i] = i < m ? i : -1 - (i - m);
    }
    for (int c = 0; c < m; c++) {
        put(&s, variables + c, c, 1);
        for (int j = 0; j < f && j <= c; j++)
            put(&s, variables + c, m + j, j == c ? -1 : near);
    }
    CHECK(follow_rule(&s, place) == f + 1 && place[0] == f && place[m - 1] < 0, "13 exchanges, and the first is back");
    CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
    CHECK_OK(moray_null_space_factor(ns, s.value, &fits), "factored");
    CHECK(fits && memcmp(place, ns->basis.place, variables * sizeof *place) == 0, "the same basis");
    moray_null_space_free(ns);
}

// [1 a; 1 a] of two variables that weigh most and one that does not: the limit of a thousand is no reason to change, a
// little more is; of two that are as good a reason the first one leaves.
static void test_limit(void)
{
    for (int k = 0; k < 2; k++) {
        static sample s;
        null_space *ns;
        bool fits;
        s.seed = 3;
        s.m = 2;
        start(&s, 5);
        for (int i = 0; i < 3; i++)
            put(&s, i, i, i < 2 ? 16 : 1); // whose roots weigh
        for (int c = 0; c < 2; c++) {
            put(&s, 3 + c, c, 0.5);
            put(&s, 3 + c, 2, k ? 125.5 : 125); // 250 or 251 of the first and of the second
        }
        CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
        CHECK_OK(moray_null_space_factor(ns, s.value, &fits), "factored");
        CHECK(fits && (ns->basis.place[2] < 0) == !k && (ns->basis.place[0] < 0) == k && ns->basis.place[1] >= 0,
              "%s a thousand: places %d, %d, %d", k ? "beyond" : "just", ns->basis.place[0], ns->basis.place[1],
              ns->basis.place[2]);
        moray_null_space_free(ns);
    }
}

// ---- Refinement ----------------------------------------------------------------------------------------------------

// A residual of nothing calls for no other solution; one that is too large for at least a second, and four at most.
static void test_refinement(void)
{
    static sample s;
    int wrong = 0, refined = 0;
    for (int trial = 0; trial < 400; trial++) {
        null_space *ns;
        double b[MOST], error;
        bool fits;
        make(&s, 900 + (unsigned long long)trial, 1);
        CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
        CHECK_OK(moray_null_space_factor(ns, s.value, &fits), "factored");
        for (int i = 0; i < s.n; i++)
            b[i] = tap_random(&s.seed, -1, 1);
        CHECK_OK(moray_null_space_solve(ns, b, &error), "solved");
        const int solves = moray_ldl_statistics_of(ns->reduced).solves;
        wrong += solves < (error > 1e-14 ? 2 : 1) || solves > 4;
        refined += solves > 1;
        memset(b, 0, sizeof b);
        CHECK_OK(moray_null_space_solve(ns, b, &error), "solved for nothing");
        wrong += moray_ldl_statistics_of(ns->reduced).solves != solves + 1 || error != 0;
        moray_null_space_free(ns);
    }
    CHECK(wrong == 0 && refined > 0, "%d times refined, as it must be but for %d", refined, wrong);
}

int main(void)
{
    test_exchanges();
    test_return();
    test_limit();
    test_refinement();
    return tap_done();
}
