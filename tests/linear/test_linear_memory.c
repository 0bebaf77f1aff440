// SPDX-License-Identifier: MIT
//
// Every allocation of ordering, factors and solutions fails once, each by itself.
#include "allocations.h"
#include "sample.h"

#include "linear/kkt_factors.h"
#include "linear/klu.h"
#include "linear/ldl.h"
#include "linear/null_space.h"

static sample regular, constrained;
static double weak[ROOM];

static moray_status by_ldl(void)
{
    moray_ldl *ldl;
    double b[MOST] = {1, 2, 3};
    MORAY_TRY(moray_ldl_new(&ldl, regular.n, &regular.pattern));
    moray_status status = moray_ldl_factor(ldl, regular.value, 0.1);
    if (!moray_failed(status))
        status = moray_ldl_factor(ldl, weak, 0.1); // whose delayed pivots need more room
    if (!moray_failed(status))
        status = moray_ldl_solve(ldl, 1, b);
    moray_ldl_free(ldl);
    return status;
}

static moray_status in_null_space(void)
{
    null_space *ns;
    double b[MOST] = {1, 2, 3}, error;
    bool fits = false;
    MORAY_TRY(moray_null_space_new(&ns, constrained.n, &constrained.pattern));
    moray_status status = moray_null_space_factor(ns, constrained.value, &fits);
    if (!moray_failed(status))
        status = moray_null_space_solve(ns, b, &error);
    moray_null_space_free(ns);
    return status;
}

static moray_status by_either(void)
{
    kkt_factors *kkt;
    double b[MOST] = {1, 2, 3};
    MORAY_TRY(moray_kkt_factors_new(&kkt, constrained.n, &constrained.pattern));
    moray_status status = moray_kkt_factors_factor(kkt, constrained.value, 1e-4);
    if (!moray_failed(status))
        status = moray_kkt_factors_solve(kkt, 1, b);
    moray_kkt_factors_free(kkt);
    return status;
}

static moray_status by_lu(void)
{
    static int row[] = {0, 1, 2, 2, 0}, col[] = {0, 1, 2, 0, 1};
    sparse_lu *lu;
    double b[] = {1, 2, 3};
    MORAY_TRY(moray_sparse_lu_new(&lu, 3, &(moray_pattern){5, row, col}));
    moray_status status = moray_sparse_lu_factor(lu, (double[]){1, 2, 3, 4, 5});
    if (!moray_failed(status))
        status = moray_sparse_lu_solve(lu, 1, b);
    moray_sparse_lu_free(lu);
    return status;
}

// What a factorisation needed is there for the next.
static void test_again(void)
{
    moray_ldl *ldl;
    CHECK_OK(moray_ldl_new(&ldl, regular.n, &regular.pattern), "factors");
    for (int k = 0; k < 2; k++) {
        CHECK_OK(moray_ldl_factor(ldl, k ? weak : regular.value, 0.1), "factored");
        const long before = calls;
        CHECK_OK(moray_ldl_factor(ldl, k ? weak : regular.value, 0.1), "and again");
        CHECK(calls == before, "by %ld allocations", calls - before);
    }
    moray_ldl_free(ldl);
}

int main(void)
{
    start(&regular, MOST);
    for (int i = 0; i < MOST; i++) {
        put(&regular, i, i, 9);
        if (i > 0)
            put(&regular, i, (i - 1) / 2, 1);
    }
    for (int k = 0; k < regular.pattern.nnz; k++)
        weak[k] = regular.row[k] == regular.col[k] ? 1e-3 : 1;
    start(&constrained, 9);
    for (int i = 0; i < 5; i++)
        put(&constrained, i, i, 1 + i);
    for (int c = 0; c < 4; c++)
        put(&constrained, 5 + c, c, 2), put(&constrained, 5 + c, 4, 1), put(&constrained, 5 + c, (c + 1) % 4, 0.5);
    test_again();
    fail_each("LDL'", false, by_ldl);
    fail_each("the null space", false, in_null_space);
    fail_each("the form that suits", false, by_either);
    fail_each("LU", false, by_lu);
    CHECK(uneven == 0, "what a run takes it frees, but for %ld", uneven);
    return tap_done();
}
