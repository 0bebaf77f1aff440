// SPDX-License-Identifier: MIT
//
// Every allocation of solves, checks of optimality, sensitivities, ranks and searches fails once, each by itself; and
// the factors of the sensitivities, whose memory is KLU's.
#include "allocations.h"
#include "programme.h"

#include "moray/search.h"
#include "nlp/rank.h"
#include "nlp/sensitivity.h"

moray_status __real_moray_sparse_lu_factor(sparse_lu *lu, const double *values);
moray_status __wrap_moray_sparse_lu_factor(sparse_lu *lu, const double *values);

moray_status __wrap_moray_sparse_lu_factor(sparse_lu *lu, const double *values)
{
    return fails() ? moray_error(MORAY_MEMORY, "no memory for factors") : __real_moray_sparse_lu_factor(lu, values);
}

// At its solution for a sum of 1.
static struct dense solved(void)
{
    return (struct dense){.facts = weighted_squares,
                          .g_lower = {1},
                          .g_upper = {1},
                          .x = {6 / 11.0, 3 / 11.0, 2 / 11.0},
                          .g = {1},
                          .lambda = {-12 / 11.0}};
}

static moray_status by_ipopt(void)
{
    struct dense d = solved();
    moray_nlp_info info;
    const moray_nlp_settings settings = moray_nlp_settings_default();
    dense_new(&d, 3, 1);
    d.x[0] = 3;
    return moray_ipopt_solve(&d.nlp, &settings, &d.at, &info);
}

static moray_status sensitivities(void)
{
    struct dense d = solved();
    struct slope room;
    moray_iterate slope = slope_in(&room);
    moray_nlp_sensitivity *s;
    dense_new(&d, 3, 1);
    const moray_status status = moray_nlp_sensitivity_new(&s, &d.nlp, &d.at);
    if (moray_failed(status)) {
        CHECK(!s, "nothing is left to be freed: %s", status.text);
        return status;
    }
    MORAY_TRY(moray_nlp_sensitivity_solve(s, &(moray_nlp_shift){.g_lower = (double[]){1}}, &slope));
    moray_nlp_sensitivity_free(s);
    return moray_ok();
}

static const double slopes[] = {1, 1, 1};
static const bool taken[] = {true, true, true};

static moray_status dependence(void)
{
    struct dense d = solved();
    double weight[1], norm;
    dense_new(&d, 3, 1);
    return moray_nlp_dependent_rows(&(struct selection){&d.nlp, slopes, taken, taken}, weight, &norm);
}

static moray_status removal(void)
{
    struct dense d = solved();
    double violation[] = {0.5};
    dense_new(&d, 3, 1);
    return moray_nlp_unremovable(&(struct selection){&d.nlp, slopes, taken, taken}, violation);
}

static bool bowl(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    (void)self, (void)c, (void)jacobian;
    *f = x[0] * x[0];
    if (gradient)
        gradient[0] = 2 * x[0];
    return true;
}

// x0^2 + x1^2 + x2^2 = -1: Ipopt turns to its restoration.
static void round_one(const double *x, const double *p, struct facts *f)
{
    weighted_squares(x, p, f);
    f->g[0] = 0;
    for (int j = 0; j < 3; j++) {
        f->g[0] += x[j] * x[j];
        f->jac[0][j] = 2 * x[j];
        f->hess_g[0][j][j] = 2;
    }
}

static moray_status infeasible(void)
{
    struct dense d = {.facts = round_one, .g_lower = {-1}, .g_upper = {-1}, .x = {3, 1, 2}};
    moray_nlp_info info = {.outcome = MORAY_NLP_SOLVED};
    const moray_nlp_settings settings = moray_nlp_settings_default();
    dense_new(&d, 3, 1);
    MORAY_TRY(moray_ipopt_solve(&d.nlp, &settings, &d.at, &info));
    CHECK(info.outcome == MORAY_NLP_INFEASIBLE, "%s", moray_nlp_outcome_text(info.outcome));
    return moray_ok();
}

// A search, and how optimal a point is: one allocation each.
static moray_status small_ones(void)
{
    struct dense d = solved();
    moray_kkt kkt;
    const double lower[] = {-1}, upper[] = {2};
    const moray_search_problem problem = {1, 0, lower, upper, true, NULL, bowl};
    const moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    double x[] = {1};
    dense_new(&d, 3, 1);
    MORAY_TRY(moray_kkt_error(&d.nlp, &d.at, &kkt));
    return moray_search(&problem, &settings, x, &info);
}

int main(void)
{
    fail_each("a solve", false, by_ipopt);
    fail_each("a solve with a restoration", false, infeasible);
    fail_each("sensitivities", false, sensitivities);
    fail_each("dependence", false, dependence);
    fail_each("what cannot be removed", false, removal);
    fail_each("optimality and a search", false, small_ones);
    CHECK(uneven == 0, "what a run takes it frees, but for %ld", uneven);
    return tap_done();
}
