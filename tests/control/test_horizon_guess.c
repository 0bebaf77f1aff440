// SPDX-License-Identifier: MIT
//
// Where the plans of a receding horizon start from, as the functions of the problem are asked: the plan before, the
// first one told, or rest.
#include "tap.h"

#include <string.h>

#include "moray/control/receding_horizon.h"

enum { INTERVALS = 4, NODES = 2 * INTERVALS + 1, LOG = 100000 };
static const double horizon = 2, interval = 0.3;

typedef struct asked {
    double t, x[2], u, s;
} asked;

static asked seen[LOG];
static int n_seen, n_problems; // the latter of those not yet freed

// Real points of a nonlinear spring with a parameter, which is drawn to 0.3.
static void spring(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0] + at->s[0] - at->x[0] * at->x[0] * at->x[0];
    out->g[0] = at->x[0] * at->x[0] + at->u[0] * at->u[0] + (at->s[0] - 0.3) * (at->s[0] - 0.3);
    const double imaginary = fabs(cimag(at->x[0])) + fabs(cimag(at->x[1])) + fabs(cimag(at->u[0])) +
                             fabs(cimag(at->s[0])) + fabs(cimag(at->t));
    if (imaginary == 0 && n_seen < LOG)
        seen[n_seen++] = (asked){creal(at->t), {creal(at->x[0]), creal(at->x[1])}, creal(at->u[0]), creal(at->s[0])};
}

static void integral(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase->q[0];
}

static moray_status make(void *self, double t, const double *x, void **problem, const moray_ocp **ocp)
{
    (void)self;
    moray_ocp *made;
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = spring,
                                    .t0 = moray_fixed(t),
                                    .tf = moray_fixed(t + horizon),
                                    .x0 = MORAY_BOUNDS(moray_fixed(x[0]), moray_fixed(x[1]))};
    MORAY_TRY(moray_ocp_new(&made, &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = 1, .endpoint = integral}));
    n_problems++;
    *problem = made;
    *ocp = made;
    return moray_ok();
}

static void release(void *problem)
{
    n_problems--;
    moray_ocp_free(problem);
}

static bool was_asked(const asked *want)
{
    for (int k = 0; k < n_seen; k++)
        if (fabs(seen[k].t - want->t) < 1e-9 && fabs(seen[k].x[0] - want->x[0]) < 1e-9 &&
            fabs(seen[k].x[1] - want->x[1]) < 1e-9 && fabs(seen[k].u - want->u) < 1e-9 &&
            fabs(seen[k].s - want->s) < 1e-9)
            return true;
    return false;
}

typedef struct guess {
    asked node[NODES];
} guess;

// At the nodes of a plan from t on: `plan` moved on, its gap to x closed in even steps, or else rest in x without
// control.
static guess guess_of(const moray_solution *plan, double t, const double *x, double s)
{
    guess g = {0};
    double from[2] = {x[0], x[1]};
    if (plan)
        moray_solution_at(plan, 0, t, from, NULL);
    for (int k = 0; k < NODES; k++) {
        asked *node = &g.node[k];
        *node = (asked){.t = t + horizon * k / (NODES - 1), .x = {x[0], x[1]}, .s = s};
        if (plan)
            moray_solution_at(plan, 0, node->t, node->x, &node->u);
        for (int i = 0; i < 2 && plan; i++)
            node->x[i] += (x[i] - from[i]) * (NODES - 1 - k) / (NODES - 1);
    }
    return g;
}

// Its first node is left out, where the state is given.
static void plans(moray_receding_horizon *receding, double t, const double *x, const guess *from, const char *name)
{
    n_seen = 0;
    CHECK_OK(moray_receding_horizon_measure(receding, t, x), name);
    CHECK(n_seen < LOG && moray_receding_horizon_record_of(receding)->failures == 0, "planned: %d", n_seen);
    int found = 0;
    for (int k = 1; k < NODES; k++)
        found += was_asked(&from->node[k]);
    CHECK(found == NODES - 1, "%s: %d of %d nodes", name, found, NODES - 1);
}

static void test_guess(const double *s)
{
    moray_receding_horizon_spec spec = {
        .replanner = {.nx = 2, .nu = 1, .ns = 1, .make = make, .free = release},
        .settings = moray_settings_default(),
        .horizon = horizon,
        .interval = interval,
        .s = s,
    };
    spec.settings.scheme = "hermite-simpson";
    spec.settings.intervals = INTERVALS;
    const double x[2] = {1, 0.4}, pushed[2] = {1.3, -0.2};
    moray_receding_horizon *one, *other;
    CHECK_OK(moray_receding_horizon_new(&one, &spec), "a receding horizon");
    guess from = guess_of(NULL, 5, x, s ? *s : 0);
    plans(one, 5, x, &from, "at first from rest");
    const moray_solution *plan = moray_receding_horizon_plan(one);
    const double parameter = moray_solution_parameters(plan)[0];
    CHECK(fabs(parameter) > 0.01 && (!s || fabs(parameter - *s) > 0.01), "the plan has a parameter of its own: %g",
          parameter);
    spec.first = plan;
    CHECK_OK(moray_receding_horizon_new(&other, &spec), "another from its plan");
    from = guess_of(plan, 5.2, pushed, s ? *s : parameter);
    plans(other, 5.2, pushed, &from, "from the first plan told");
    moray_receding_horizon_free(other);
    from = guess_of(plan, 5 + interval, pushed, s ? *s : parameter);
    plans(one, 5 + interval, pushed, &from, "then from its own");
    moray_receding_horizon_free(one);
}

// Sizes and phases of what is planned, one by one.
static moray_status make_odd(void *self, double t, const double *x, void **problem, const moray_ocp **ocp)
{
    (void)x;
    const int *size = self; // phases, states, controls, parameters
    moray_ocp *made;
    moray_phase_spec phase[2] = {
        {.nx = size[1], .nu = size[2], .nq = 1, .continuous = spring, .t0 = moray_fixed(t), .tf = moray_fixed(t + 1)}};
    phase[1] = phase[0];
    phase[1].t0 = moray_fixed(t + 1), phase[1].tf = moray_fixed(t + 2);
    MORAY_TRY(moray_ocp_new(&made,
                            &(moray_ocp_spec){.phases = size[0], .phase = phase, .ns = size[3], .endpoint = integral}));
    *problem = made;
    *ocp = made;
    return moray_ok();
}

static void test_sizes(void)
{
    static int sizes[][4] = {{2, 2, 1, 1}, {1, 3, 1, 1}, {1, 2, 2, 1}, {1, 2, 1, 2}};
    static const char *const words[] = {"2 phases", "3 states", "2 controls", "2 parameters"};
    for (int k = 0; k < 4; k++) {
        moray_receding_horizon *receding;
        const moray_receding_horizon_spec spec = {
            .replanner = {.nx = 2, .nu = 1, .ns = 1, .make = make_odd, .free = release, .self = sizes[k]},
            .settings = moray_settings_default(),
            .horizon = horizon,
            .interval = interval};
        CHECK_OK(moray_receding_horizon_new(&receding, &spec), "a receding horizon");
        const moray_status status = moray_receding_horizon_measure(receding, 0, (double[]){1, 0});
        CHECK(status.code == MORAY_INPUT && strstr(status.text, words[k]), "refused: %s", status.text);
        moray_receding_horizon_free(receding);
    }
}

static void test_bounds(void)
{
    const moray_receding_horizon_spec good = {
        .replanner = {.nx = 2, .nu = 1, .ns = 1, .make = make, .free = release},
        .settings = moray_settings_default(),
        .horizon = 1,
        .interval = 1,
        .watch = 1,
    };
    moray_receding_horizon_spec bad[8];
    for (int k = 0; k < 8; k++)
        bad[k] = good;
    bad[0].replanner.nx = 0;
    bad[1].replanner.nu = -1;
    bad[2].replanner.ns = -1;
    bad[3].watch = -0.1;
    bad[4].watch = 1.1;
    bad[5].horizon = INFINITY;
    bad[6].interval = 0;
    bad[7].settings.intervals = 0;
    moray_receding_horizon *receding;
    for (int k = 0; k < 8; k++)
        CHECK(moray_receding_horizon_new(&receding, &bad[k]).code == MORAY_INPUT && !receding, "refused: %d", k);
    CHECK_OK(moray_receding_horizon_new(&receding, &good), "a plan no longer than between two, looked at as often");
    const moray_controller controller = moray_receding_horizon_controller(receding);
    CHECK(controller.nu == 1 && controller.period == 1, "every %g", controller.period);
    moray_receding_horizon_free(receding);
    moray_receding_horizon_spec least = good;
    least.replanner.nx = 1, least.replanner.nu = least.replanner.ns = 0, least.settings.intervals = 1, least.watch = 0;
    CHECK_OK(moray_receding_horizon_new(&receding, &least), "a plan of one state alone, in one interval");
    moray_receding_horizon_free(receding);
}

// What plans cost, the first one aside where the longest is told.
static void test_record(void)
{
    const moray_receding_horizon_spec spec = {
        .replanner = {.nx = 2, .nu = 1, .ns = 1, .make = make, .free = release},
        .settings = moray_settings_default(),
        .horizon = horizon,
        .interval = interval,
    };
    moray_receding_horizon *receding;
    CHECK_OK(moray_receding_horizon_new(&receding, &spec), "a receding horizon");
    const moray_receding_horizon_record *record = moray_receding_horizon_record_of(receding);
    double longest = 0, seconds = 0;
    for (int k = 0; k < 6; k++) {
        CHECK_OK(moray_receding_horizon_measure(receding, k * interval, (double[]){1, 0.1 * k}), "planned");
        const double took = moray_receding_horizon_replans(receding)[k].seconds;
        seconds += took;
        longest = k > 0 && took > longest ? took : longest;
        CHECK(record->plans == k + 1 && took > 0 && record->longest == longest, "the longest of %d: %g s", k + 1,
              record->longest);
        CHECK_NEAR(record->seconds, seconds, 1e-12, "all together [s]");
        CHECK(n_problems == 1, "%d problems kept", n_problems);
    }
    moray_receding_horizon_free(receding);
    CHECK(n_problems == 0, "and none in the end");
}

int main(void)
{
    test_record();
    test_guess(NULL);
    test_guess(&(double){0.7});
    test_sizes();
    test_bounds();
    return tap_done();
}
