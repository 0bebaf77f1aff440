// SPDX-License-Identifier: MIT
//
// The choice of a basis, against sizes equilibrated here and matchings sought by augmenting paths: every variable that
// is taken for a constraint is strong in it, and one is taken for each where that can be. Its matrix against dense
// algebra.
#include "tap.h"

#include "linear/basis.h"
#include "sample.h"

static const struct {
    int sweeps;
    double strong;
} views[MORAY_BASIS_VIEWS] = {{0, 1e-2}, {5, 1e-2}, {5, 1e-6}};

typedef struct scaled {
    double size[MOST][MOST]; // [constraint][variable], of the largest entry there; -1: none
    bool strong[MOST][MOST];
} scaled;

static int variables_of(const sample *s)
{
    return s->n - s->m;
}

// Constraints of few variables each, rows and columns of scales far apart, some entries 0, some in two parts.
static void make(sample *s, unsigned long long seed)
{
    double scale[MOST];
    s->seed = seed;
    s->m = 1 + pick(s, 12);
    const int variables = s->m + pick(s, 4);
    start(s, variables + s->m);
    for (int i = 0; i < s->n; i++)
        scale[i] = pow(10, tap_random(&s->seed, -4, 4));
    for (int i = 0; i < variables; i++)
        put(s, i, i, 1);
    for (int c = 0; c < s->m; c++)
        for (int j = 0; j < variables; j++)
            for (int parts = pick(s, 4) == 0 ? 1 + pick(s, 2) : 0; parts > 0; parts--)
                put(s, variables + c, j,
                    pick(s, 5) ? scale[variables + c] * scale[j] * pow(10, tap_random(&s->seed, -3, 0)) : 0);
}

static void measure(const sample *s, scaled *to)
{
    const int variables = variables_of(s);
    for (int c = 0; c < s->m; c++)
        for (int j = 0; j < variables; j++)
            to->size[c][j] = -1;
    for (int k = 0; k < s->pattern.nnz; k++) {
        const int i = s->row[k] > s->col[k] ? s->row[k] : s->col[k], j = s->row[k] + s->col[k] - i;
        if (i >= variables)
            to->size[i - variables][j] = fmax(to->size[i - variables][j], fabs(s->value[k]));
    }
}

// Each sweep divides rows and columns by the roots of their largest entries, both as they were before it (Ruiz 2001).
static void equilibrate(const sample *s, scaled *to, int sweeps)
{
    const int variables = variables_of(s);
    while (sweeps-- > 0) {
        double row[MOST] = {0}, column[MOST] = {0};
        for (int c = 0; c < s->m; c++)
            for (int j = 0; j < variables; j++) {
                row[c] = fmax(row[c], to->size[c][j]);
                column[j] = fmax(column[j], to->size[c][j]);
            }
        for (int c = 0; c < s->m; c++)
            for (int j = 0; j < variables; j++)
                to->size[c][j] /= to->size[c][j] > 0 ? sqrt(row[c] * column[j]) : 1;
    }
}

static void find_strong(const sample *s, scaled *to, double strong)
{
    for (int c = 0; c < s->m; c++) {
        double largest = 0;
        for (int j = 0; j < variables_of(s); j++)
            largest = fmax(largest, to->size[c][j]);
        for (int j = 0; j < variables_of(s); j++)
            to->strong[c][j] = to->size[c][j] > 0 && to->size[c][j] >= strong * largest;
    }
}

// A variable for constraint c, where need be by giving others to those that have them.
static bool augment(const sample *s, const scaled *at, int c, int *owner, bool *seen)
{
    for (int j = 0; j < variables_of(s); j++) {
        if (!at->strong[c][j] || seen[j])
            continue;
        seen[j] = true;
        if (owner[j] < 0 || augment(s, at, owner[j], owner, seen)) {
            owner[j] = c;
            return true;
        }
    }
    return false;
}

static bool can_match(const sample *s, const scaled *at)
{
    int owner[MOST], matched = 0;
    for (int j = 0; j < MOST; j++)
        owner[j] = -1;
    for (int c = 0; c < s->m; c++) {
        bool seen[MOST] = {false};
        matched += augment(s, at, c, owner, seen);
    }
    return matched == s->m;
}

// Of the variables taken: those that are strong in the constraint that they are taken for, each for another.
static int strong_ones(const sample *s, const scaled *at, const struct basis *basis)
{
    bool served[MOST] = {false};
    int good = 0;
    for (int j = 0; j < variables_of(s); j++) {
        const int c = basis->place[j];
        if (c >= 0 && c < s->m && !served[c] && at->strong[c][j]) {
            served[c] = true;
            good++;
        }
    }
    return good;
}

static void test_choice(int view)
{
    static sample s;
    static scaled at;
    int wrong = 0, weak = 0, found_ones = 0, failed = 0;
    enum { samples = 2000 };
    for (int k = 0; k < samples; k++) {
        struct basis basis;
        bool found;
        make(&s, 1000 + (unsigned long long)k);
        measure(&s, &at);
        equilibrate(&s, &at, views[view].sweeps);
        find_strong(&s, &at, views[view].strong);
        failed += moray_failed(moray_basis_choose(&basis, variables_of(&s), s.m, &s.pattern, s.value, view, &found));
        found_ones += found;
        wrong += found != can_match(&s, &at) || (!found && (basis.place || basis.lu));
        weak += found && strong_ones(&s, &at, &basis) != s.m;
        moray_basis_free(&basis);
    }
    printf("# view %d: %d of %d found\n", view, found_ones, samples);
    CHECK(failed == 0, "view %d: chosen", view);
    CHECK(found_ones > samples / 10 && found_ones < samples * 9 / 10, "some can be, some not: %d of %d", found_ones,
          samples);
    CHECK(wrong == 0, "one for each constraint where that can be, but for %d of %d", wrong, samples);
    CHECK(weak == 0, "each strong where it is, but for %d", weak);
}

// A variable of one constraint alone is taken rather than one that others have, too, however strong that is.
static void test_own(void)
{
    static sample s;
    int wrong = 0;
    enum { samples = 300 };
    for (int k = 0; k < samples; k++) {
        struct basis basis;
        bool found;
        int own[MOST];
        s.seed = 77 + (unsigned long long)k;
        s.m = 2 + pick(&s, 8);
        const int shared = 1 + pick(&s, 4), variables = s.m + shared, turn = pick(&s, variables);
        start(&s, variables + s.m);
        for (int c = 0; c < s.m; c++) {
            own[c] = (turn + c) % variables;
            put(&s, variables + c, own[c], tap_random(&s.seed, 0.1, 1));
            for (int j = 0; j < shared; j++)
                put(&s, variables + c, (turn + s.m + j) % variables, tap_random(&s.seed, 1, 2));
        }
        CHECK_OK(moray_basis_choose(&basis, variables, s.m, &s.pattern, s.value, 0, &found), "chosen");
        for (int c = 0; found && c < s.m; c++)
            wrong += basis.place[own[c]] != c;
        wrong += !found;
        moray_basis_free(&basis);
    }
    CHECK(wrong == 0, "each its own, but for %d", wrong);
}

// One of one entry rather than one of two, if it is just strong enough: a hundredth of the largest.
static void test_just_strong(void)
{
    static sample s;
    for (int k = 0; k < 4; k++) {
        const bool strong = k % 2 == 0, first = k < 2;
        struct basis basis;
        bool found;
        s.m = 1;
        start(&s, 3);
        for (int part = 0; part < 3; part++)
            if (part == (first ? 0 : 2))
                put(&s, 2, 0, strong ? 1e-2 : nextafter(1e-2, 0));
            else
                put(&s, 2, 1, 1);
        CHECK_OK(moray_basis_choose(&basis, 2, 1, &s.pattern, s.value, 0, &found), "chosen");
        CHECK(found && basis.place[strong ? 0 : 1] == 0 && basis.place[strong ? 1 : 0] == -1, "%s strong enough",
              strong ? "just" : "hardly not");
        moray_basis_free(&basis);
    }
}

// The columns of the basis and the others are those of the matrix, in their places; new values are factored anew, the
// same ones again need not be.
static void test_matrix(void)
{
    static sample s;
    double worst = 0;
    int regular = 0, wrong = 0;
    for (int k = 0; k < 400; k++) {
        struct basis basis;
        bool found;
        double columns[MOST * MOST], x[MOST], b[MOST];
        make(&s, 5000 + (unsigned long long)k);
        const int variables = variables_of(&s), m = s.m;
        CHECK_OK(moray_basis_choose(&basis, variables, m, &s.pattern, s.value, 2, &found), "chosen");
        for (int turn = 0; turn < 3 && found; turn++) { // the second time the same
            const double factor = turn < 2 ? 1 : 0.5;
            for (int e = 0; e < s.pattern.nnz; e++)
                s.value[e] *= factor;
            const double now = turn < 2 ? 1 : factor;
            if (moray_failed(moray_basis_factor(&basis, s.value)))
                break;
            wrong += memcmp(basis.values, basis.values + basis.slots, (size_t)basis.slots * sizeof *basis.values) != 0;
            moray_basis_others(&basis, s.value, columns);
            for (int c = 0; c < m; c++)
                x[c] = b[c] = 1 + 0.1 * c;
            CHECK_OK(moray_sparse_lu_solve(basis.lu, 1, x), "solved");
            for (int c = 0; c < m; c++) {
                double left = -b[c], size = b[c];
                for (int j = 0; j < variables; j++) {
                    const double a = now * s.A[(variables + c) * s.n + j];
                    const int at = basis.place[j];
                    if (at < 0)
                        wrong += !(fabs(columns[(-1 - at) * m + c] - a) <= 1e-14 * fabs(a));
                    left += at < 0 ? 0 : a * x[at];
                    size += at < 0 ? 0 : fabs(a * x[at]);
                }
                worst = tap_worse(worst, fabs(left) / size);
            }
            regular++;
        }
        moray_basis_free(&basis);
    }
    CHECK(regular > 50 && worst < 1e-11, "%d times the basis is solved, to %.1e", regular, worst);
    CHECK(wrong == 0, "the other columns are those of the matrix, and what is factored is kept, but for %d", wrong);
}

// Values that are wrong on purpose are so by a share of 1e-14 at most, each by another.
static void test_nearly(void)
{
    static sample s;
    double most = 0;
    int outside = 0, alike = 0, all = 0;
    for (int k = 0; k < 200; k++) {
        struct basis basis;
        bool found;
        double before[MOST * MOST], last = 0;
        make(&s, 9000 + (unsigned long long)k);
        CHECK_OK(moray_basis_choose(&basis, variables_of(&s), s.m, &s.pattern, s.value, 2, &found), "chosen");
        if (found && moray_basis_factor(&basis, s.value).code != MORAY_MEMORY) {
            memcpy(before, basis.values, (size_t)basis.slots * sizeof *before);
            CHECK(moray_basis_factor_nearly(&basis, s.value).code != MORAY_MEMORY, "nearly");
            for (int e = 0; e < basis.slots; e++) {
                const double share = before[e] != 0 ? basis.values[e] / before[e] - 1 : 0;
                outside += !(share >= 0 && share <= 1.03e-14);
                alike += before[e] != 0 && share == last;
                most = fmax(most, share);
                last = share;
                all++;
            }
        }
        moray_basis_free(&basis);
    }
    CHECK(outside == 0 && most > 0.9e-14, "by 1e-14 at most, %.2g, but for %d of %d", most, outside, all);
    CHECK(alike < all / 10, "and not alike, but for %d", alike);
}

// [1 2; 2 v], one variable over: what is singular stays so, asked again; what is factored is not factored again, which
// shows where the factors are of another matrix by now.
static void test_factored(void)
{
    static sample s;
    struct basis basis;
    bool found;
    const double other[] = {4, 0, 0, 8};
    double x[] = {4, 8};
    s.m = 2;
    start(&s, 5);
    for (int c = 0; c < 2; c++)
        for (int j = 0; j < 2; j++)
            put(&s, 3 + c, j, c + j == 0 ? 1 : c + j == 1 ? 2 : 5);
    CHECK_OK(moray_basis_choose(&basis, 3, 2, &s.pattern, s.value, 0, &found), "chosen");
    CHECK(found && basis.place[2] == -1, "what is in no constraint is over");
    CHECK_OK(moray_basis_factor(&basis, s.value), "regular");
    CHECK_OK(moray_sparse_lu_factor(basis.lu, other), "another in its place");
    CHECK_OK(moray_basis_factor(&basis, s.value), "the same once more");
    CHECK_OK(moray_sparse_lu_solve(basis.lu, 1, x), "solved");
    CHECK(x[0] == 1 && x[1] == 1, "by the factors that there were: %g, %g", x[0], x[1]);
    s.value[3] = 4;
    for (int again = 0; again < 2; again++)
        CHECK(moray_basis_factor(&basis, s.value).code == MORAY_NUMERIC, "singular, time %d", again);
    s.value[3] = 5;
    CHECK_OK(moray_basis_factor(&basis, s.value), "regular again");
    moray_basis_free(&basis);
}

int main(void)
{
    test_factored();
    test_nearly();
    test_own();
    test_just_strong();
    test_matrix();
    for (int view = 0; view < MORAY_BASIS_VIEWS; view++)
        test_choice(view);
    return tap_done();
}
