// SPDX-License-Identifier: MIT
//
// What factors refuse, with whole texts: entries outside of the matrix, values that are no numbers, matrices that are
// singular, solutions before there are factors.
#include "tap.h"

#include <string.h>

#include "linear/klu.h"
#include "linear/ldl.h"
#include "linear/null_space.h"

static void check_told(moray_status status, moray_code code, const char *text)
{
    CHECK(status.code == code && strcmp(status.text, text) == 0, "told: %s", status.text);
}

// One entry of four outside, on each side.
static void test_outside(void)
{
    static const int places[][2] = {{-1, 1}, {3, 1}, {1, -1}, {1, 3}, {3, 3}};
    for (size_t k = 0; k < sizeof places / sizeof *places; k++)
        for (int at = 0; at < 4; at++) {
            int row[] = {0, 1, 2, 2}, col[] = {0, 1, 2, 0};
            char text[100];
            moray_ldl *ldl;
            sparse_lu *lu;
            const moray_pattern pattern = {4, row, col};
            row[at] = places[k][0], col[at] = places[k][1];
            snprintf(text, sizeof text, "entry %d stands at (%d, %d): outside a matrix of 3 rows", at, row[at],
                     col[at]);
            check_told(moray_ldl_new(&ldl, 3, &pattern), MORAY_INPUT, text);
            check_told(moray_sparse_lu_new(&lu, 3, &pattern), MORAY_INPUT, text);
            CHECK(!ldl && !lu, "and nothing is made");
        }
}

static void test_lu(void)
{
    int row[] = {0, 0, 1, 1}, col[] = {0, 1, 0, 1}, flat[] = {0, 0, 0, 0};
    sparse_lu *lu;
    double b[] = {1, 2};
    check_told(moray_sparse_lu_new(&lu, 2, &(moray_pattern){2, flat, col}), MORAY_INPUT,
               "a sparse matrix of 2 rows is singular whatever its values: it has rank 1");
    CHECK_OK(moray_sparse_lu_new(&lu, 2, &(moray_pattern){4, row, col}), "a full one");
    check_told(moray_sparse_lu_solve(lu, 1, b), MORAY_NUMERIC,
               "a sparse matrix of 2 rows has no factors to solve with");
    check_told(moray_sparse_lu_solve_transposed(lu, 1, b), MORAY_NUMERIC,
               "a sparse matrix of 2 rows has no factors to solve with");
    for (int k = 0; k < 4; k++) {
        double value[] = {3, 1, 1, 2};
        CHECK_OK(moray_sparse_lu_factor(lu, value), "factored");
        CHECK(moray_sparse_lu_condition(lu) > 0, "of some condition");
        value[k] = k % 2 ? NAN : -INFINITY;
        check_told(moray_sparse_lu_factor(lu, value), MORAY_NUMERIC, "a sparse matrix of 2 rows is not finite");
        CHECK(moray_sparse_lu_condition(lu) == 0, "and of none without factors");
    }
    check_told(moray_sparse_lu_factor(lu, (double[]){1, 2, 2, 4}), MORAY_NUMERIC,
               "a sparse matrix of 2 rows is singular: it has rank 1");
    moray_sparse_lu_free(lu);
}

static void test_ldl(void)
{
    int row[] = {0, 1, 1}, col[] = {0, 0, 1};
    moray_ldl *ldl;
    double b[] = {1, 2};
    CHECK_OK(moray_ldl_new(&ldl, 2, &(moray_pattern){3, row, col}), "two rows");
    check_told(moray_ldl_solve(ldl, 1, b), MORAY_NUMERIC, "a sparse matrix of 2 rows has no factors to solve with");
    for (int k = 0; k < 3; k++) {
        double value[] = {3, 1, 2};
        CHECK_OK(moray_ldl_factor(ldl, value, 0.1), "factored");
        value[k] = k % 2 ? NAN : -INFINITY;
        check_told(moray_ldl_factor(ldl, value, 0.1), MORAY_NUMERIC, "a sparse matrix of 2 rows is not finite");
        check_told(moray_ldl_solve(ldl, 1, b), MORAY_NUMERIC, "a sparse matrix of 2 rows has no factors to solve with");
    }
    CHECK(moray_ldl_has_pattern(ldl, 2, &(moray_pattern){3, row, col}), "its pattern");
    CHECK(!moray_ldl_has_pattern(ldl, 3, &(moray_pattern){3, row, col}), "of another size");
    CHECK(!moray_ldl_has_pattern(ldl, 2, &(moray_pattern){2, row, col}), "of fewer entries");
    int other_row[] = {0, 1, 0}, other_col[] = {0, 0, 0};
    CHECK(!moray_ldl_has_pattern(ldl, 2, &(moray_pattern){3, other_row, col}), "another row");
    CHECK(!moray_ldl_has_pattern(ldl, 2, &(moray_pattern){3, row, other_col}), "another column");
    moray_ldl_free(ldl);
}

static void test_null_space(void)
{
    int row[] = {0, 1, 2, 2}, col[] = {0, 1, 0, 1};
    null_space *ns;
    double b[] = {1, 2, 3}, error;
    bool fits;
    CHECK_OK(moray_null_space_new(&ns, 3, &(moray_pattern){4, row, col}), "one constraint");
    check_told(moray_null_space_solve(ns, b, &error), MORAY_NUMERIC,
               "a sparse matrix of 3 rows has no factors to solve with");
    for (int k = 0; k < 4; k++) {
        double value[] = {1, 2, 3, 4};
        CHECK_OK(moray_null_space_factor(ns, value, &fits), "factored");
        CHECK(fits && moray_null_space_inertia(ns).negative == 1 && moray_null_space_inertia(ns).positive == 2,
              "and its inertia");
        value[k] = k % 2 ? NAN : -INFINITY;
        check_told(moray_null_space_factor(ns, value, &fits), MORAY_NUMERIC, "a sparse matrix of 3 rows is not finite");
        CHECK(!fits && moray_null_space_inertia(ns).positive == 0, "has none");
    }
    for (int k = 0; k < 2; k++) { // a constraint of nothing, to a basis of before
        CHECK_OK(moray_null_space_factor(ns, (double[]){1, 2, k ? 3 : 0, k ? 4 : 0}, &fits), "looked at");
        CHECK(fits == k, "and %s", k ? "factored" : "left");
    }
    moray_null_space_free(ns);
    int rows[] = {0, 1, 2, 3, 3, 4, 4, 4}, cols[] = {0, 1, 2, 0, 1, 0, 1, 2};
    CHECK_OK(moray_null_space_new(&ns, 5, &(moray_pattern){8, rows, cols}), "two constraints");
    for (int k = 0; k < 3; k++) { // regular, of nothing, regular again
        const double z = k % 2 ? 0 : 1;
        CHECK_OK(moray_null_space_factor(ns, (double[]){1, 2, 3, 4 * z, 5 * z, 6 * z, -7 * z, z}, &fits), "looked at");
        CHECK(fits == !(k % 2), "and %s", fits ? "factored" : "left");
    }
    moray_null_space_free(ns);
    CHECK_OK(moray_null_space_new(&ns, 0, &(moray_pattern){0, row, col}), "of no rows");
    CHECK(!ns, "there is no null space");
}

// Up to 24 degrees of freedom, and constraints that have nothing on the diagonal, the first of them and the last.
static void test_form(void)
{
    enum { most = 40 };
    for (int m = 1; m < 4; m++)
        for (int freedom = -1; freedom < 27; freedom++) {
            const int variables = m + freedom, n = variables + m;
            int row[4 * most], col[4 * most], k = 0;
            double value[4 * most];
            null_space *ns;
            bool fits;
            for (int j = 0; j < variables; j++)
                row[k] = col[k] = j, value[k++] = 1;
            for (int j = 1; j < variables; j++)
                row[k] = j, col[k] = j - 1, value[k++] = 0.1;
            for (int c = 0; c < m && variables > 0; c++) {
                row[k] = variables + c, col[k] = variables - 1 - c % variables, value[k++] = 1;
                row[k] = col[k] = variables + c, value[k++] = 0;
            }
            if (variables < 1)
                continue;
            CHECK_OK(moray_null_space_new(&ns, n, &(moray_pattern){k, row, col}), "looked at");
            CHECK(!ns == (freedom < 0 || freedom > 24), "%d constraints, %d degrees of freedom", m, freedom);
            if (ns) {
                CHECK_OK(moray_null_space_factor(ns, value, &fits), "factored");
                CHECK(fits, "with nothing on the diagonal");
                for (int c = 0; c<m; c += m> 1 ? m - 1 : 1) {
                    const int at = 2 * variables - 1 + 2 * c + 1;
                    value[at] = 1e-9;
                    CHECK_OK(moray_null_space_factor(ns, value, &fits), "looked at");
                    CHECK(!fits, "something on that of constraint %d", c);
                    value[at] = 0;
                }
            }
            moray_null_space_free(ns);
        }
}

int main(void)
{
    test_form();
    test_outside();
    test_lu();
    test_ldl();
    test_null_space();
    return tap_done();
}
