// SPDX-License-Identifier: MIT
//
// When a solution is solved again: scales that were wrong and room that the solver left, at solutions changed by hand.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "ocp/solve_again.h"

// ---- What the solver is asked ----

enum { variables = 1000, constraints = 40 };
static double x_lower[variables], x_upper[variables], g_lower[constraints], g_upper[constraints];

// 30 fixed, then 741 between bounds, 6 above one and 5 below one, the rest free or as good as; a row of each kind, of
// two bounds seven times more: 1500 bounds in all.
static void set_bounds(void)
{
    for (int j = 0; j < variables; j++) {
        x_lower[j] = j < 30 ? 2 : j < 777 ? -3 : j < 900 ? -1e15 : -MORAY_INFINITY;
        x_upper[j] = j < 30 ? 2 : j < 771 ? 4 : j < 777 || j >= 782 ? 1e15 : 5;
    }
    for (int i = 0; i < constraints; i++) {
        g_lower[i] = i == 0 ? 1 : i == 1 || i == 2 ? -1 : -MORAY_INFINITY;
        g_upper[i] = i == 0 ? 1 : i == 2 || i == 3 ? 7 : MORAY_INFINITY;
    }
    g_lower[constraints - 1] = -2;
    g_upper[constraints - 1] = -1;
    g_upper[constraints - 2] = 3;
}

static void test_settings(void)
{
    static const moray_key_value option = {"mu_strategy", "adaptive"};
    struct iterations kept = {0};
    struct transcription t = {.nlp = {.n = variables,
                                      .m = constraints,
                                      .x_lower = x_lower,
                                      .x_upper = x_upper,
                                      .g_lower = g_lower,
                                      .g_upper = g_upper}};
    moray_solution solution = {.transcription = &t,
                               .iterations = &kept,
                               .settings = {.tolerance = 1e-7,
                                            .max_iterations = 77,
                                            .max_cpu_seconds = 5,
                                            .barrier = 0.25,
                                            .print_level = 3,
                                            .linear_solver = MORAY_LINEAR_MUMPS,
                                            .timing = true,
                                            .ipopt = &option,
                                            .n_ipopt = 1}};
    set_bounds();
    const moray_nlp_settings cold = moray_solver_settings(&solution, false),
                             warm = moray_solver_settings(&solution, true);
    CHECK(cold.tolerance == 1e-7 && cold.max_iterations == 77 && cold.max_cpu_seconds == 5 && cold.print_level == 3 &&
              cold.linear_solver == MORAY_LINEAR_MUMPS && cold.timing && cold.ipopt == &option && cold.n_ipopt == 1 &&
              cold.observer == &kept && cold.progress == moray_iterations_keep,
          "settings go on to the solver");
    CHECK(!cold.warm && cold.barrier == 0.25 && warm.warm && warm.barrier == 1e-7,
          "the barrier of a warm start is the tolerance");
    solution.settings.barrier_shared = true;
    CHECK(moray_solver_settings(&solution, false).barrier == 0.25, "shared by as many bounds as are usual");
    CHECK(moray_solver_settings(&solution, true).barrier == 1e-7, "and not shared when warm");
    x_upper[999] = 1e9;
    CHECK_NEAR(moray_solver_settings(&solution, false).barrier, 0.25 * 1500 / 1501, 1e-15, "and by one more");
    x_upper[999] = 1e15, g_lower[3] = -1e9;
    CHECK_NEAR(moray_solver_settings(&solution, false).barrier, 0.25 * 1500 / 1501, 1e-15, "of a row");
    solution.settings.barrier_shared = false;
    CHECK(moray_solver_settings(&solution, false).barrier == 0.25, "where nothing is to be shared");
}

// ---- Two phases, each as short as their controls allow, of which the second is what is changed ----

static void go(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->f[1] = at->u[0] / 2;
    out->g[0] = at->u[0] * at->u[0] + 2;
    out->g[1] = at->x[0] + 1;
}

static void arrive(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0];
    out->e[0] = at->phase[1].xf[1];
}

struct made {
    moray_ocp *ocp;
    moray_solution *solution;
    struct transcription *t;
    struct phase_layout *layout; // of the second phase
    moray_iterate *at;
};

// Solved, then in scales of 1 and with a clean sheet of what it took.
static struct made make(void)
{
    static const moray_bounds x0[] = {{0, 0}, {0, 0}}, xf[] = {{0.5, 0.5}, {-9, 9}}, u[] = {{-1, 1}};
    moray_phase_spec phase[2];
    for (int p = 0; p < 2; p++)
        phase[p] = (moray_phase_spec){.nx = 2,
                                      .nu = 1,
                                      .nq = 2,
                                      .continuous = go,
                                      .t0 = moray_fixed(p),
                                      .tf = moray_between(p, p + 3),
                                      .intervals = 4,
                                      .x0 = {x0, 2},
                                      .xf = {xf, 2},
                                      .u = {u, 1}};
    struct made made = {0};
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_ocp_new(&made.ocp, &(moray_ocp_spec){.phases = 2,
                                                        .phase = phase,
                                                        .endpoint = arrive,
                                                        .ne = 1,
                                                        .e = MORAY_BOUNDS(moray_between(-9, 9))}),
             "a problem");
    CHECK_OK(moray_solve(made.ocp, &settings, NULL, &made.solution), "solved");
    made.t = made.solution->transcription;
    made.layout = &made.t->layout.phase[1];
    made.at = &made.solution->iterate;
    for (int j = 0; j < made.t->nlp.n + made.t->nlp.m; j++)
        made.t->scale[j] = 1;
    made.solution->info = (moray_nlp_info){.outcome = MORAY_NLP_SOLVED, .iterations = 100, .seconds = 1000};
    return made;
}

static void drop(struct made *made)
{
    moray_solution_free(made->solution);
    moray_ocp_free(made->ocp);
}

// Whether it was solved again, with what that took added to what had been; and its last iterations are known.
static bool again(struct made *made, const char *what)
{
    struct iterations *kept = made->solution->iterations;
    const int before = kept->n = kept->room = 3;
    CHECK_OK(moray_solve_again(made->solution), what);
    const moray_nlp_info *info = &made->solution->info;
    const bool ran = info->evaluations[0] > 0;
    const int iterations = info->iterations - 100;
    CHECK(info->seconds >= 1000 && info->seconds < 2000 && (ran || iterations == 0), "what it takes is added: %d, %g s",
          info->iterations, info->seconds);
    CHECK(ran ? kept->n > before + iterations : kept->n == before, "%d iterations are kept of %d", kept->n - before,
          iterations);
    return ran;
}

// ---- Scales ----

// A quantity of the second phase and its scale; defects of both states in the last rows, in the largest of the second.
struct changed {
    const char *what;
    enum { nothing, duration, integral, state } which;
    double value, scale, defect[2];
    bool again;
};
static const struct changed changes[] = {
    {"nothing", nothing, 0, 1, {0, 0}, false},
    {"a duration that is small in its scale", duration, 1, 0.9e-3, {0, 0}, true},
    {"one that is just not", duration, 1, 1e-3, {0, 0}, false},
    {"one that is nothing", duration, 1, 1e-12, {0, 0}, false},
    {"an integral that is small in its scale", integral, 0.5, 1e-3, {0, 0}, true},
    {"a negative one", integral, -0.5, 1e-3, {0, 0}, true},
    {"one that is not small", integral, -5, 1, {0, 0}, false},
    {"one that is nothing", integral, -5, 1e-12, {0, 0}, false},
    {"a state that is small in its scale, loose", state, 0.25, 1e-3, {0, -1.1e-6}, true},
    {"loose on the other side", state, 0.25, 1e-3, {0, 1.1e-6}, true},
    {"one that is not loose", state, 0.25, 1e-3, {0, 0.9e-6}, false},
    {"one that just is not", state, 0.25, 1e-3, {0, -1e-6}, false},
    {"where the other is loose", state, 0.25, 1e-3, {1e-3, 0}, false},
    {"one that is not small", state, 0.25, 1, {0, 1e-3}, false},
    {"one that is nothing", state, 0.25, 1e-9, {0, 1e-3}, false},
};

// Where nothing is to be done, an interval is longer than the last, whose rows it must not lengthen.
static void change_state(struct made *made, const struct changed *change, const moray_scheme *longer)
{
    const struct phase_layout *layout = made->layout;
    double largest = 0, *g = made->at->g;
    for (int n = 0; n < layout->nodes; n++)
        largest = fmax(largest, fabs(made->at->x[layout->node[n].x + 1]));
    made->t->scale[layout->node[0].x + 1] = change->scale;
    memset(g + layout->interval[0].defect, 0, 4 * 2 * 2 * sizeof(double));
    for (int r = 0; r < 2; r++) {
        g[layout->interval[3].defect + 2 + r] = change->defect[r] * largest;
        g[layout->integral_row + r] = 1; // no defect
    }
    if (!change->again)
        layout->interval[2].scheme = longer;
}

static void test_scale(const struct changed *change)
{
    moray_scheme longer;
    CHECK_OK(moray_scheme_new(&longer, MORAY_LOBATTO, 4), "a longer scheme");
    struct made made = make();
    double *x = made.at->x, *scale = made.t->scale;
    const struct phase_layout *layout = made.layout;
    const double was = change->which == duration ? change->scale : 1;
    if (change->which == duration) {
        x[layout->tf] = 1 + change->value;
        scale[layout->tf] = change->scale;
    } else if (change->which == integral) {
        x[layout->q + 1] = change->value;
        scale[layout->q + 1] = change->scale;
    } else if (change->which == state) {
        change_state(&made, change, &longer);
    }
    const bool ran = again(&made, change->what);
    CHECK(ran == change->again, "%s is %s again", change->what, ran ? "solved" : "not solved");
    CHECK((made.t->scale[layout->tf] != was) == ran, "in scales that are found anew");
    CHECK(!ran || fabs(x[layout->tf] - 1.5) < 1e-6, "and the optimum is found again: %g", x[layout->tf]);
    drop(&made);
    moray_scheme_free(&longer);
}

static void test_scales_of_others(void)
{
    struct made made = make();
    made.solution->settings.own_scaling = false;
    made.t->scale[made.layout->tf] = 1e-4;
    CHECK(!again(&made, "scales that are the solver's"), "are left to it");
    drop(&made);
}

// ---- Room ----

enum side { below, above, row_below, row_above };

// A multiplier and the slack of its bound.
static void set_pair(struct made *made, enum side side, int which, double multiplier, double slack)
{
    const moray_nlp *nlp = &made->t->nlp;
    if (side == below) {
        made->at->x[which] = nlp->x_lower[which] + slack;
        made->at->z_lower[which] = multiplier;
    } else if (side == above) {
        made->at->x[which] = nlp->x_upper[which] - slack;
        made->at->z_upper[which] = multiplier;
    } else {
        made->at->g[which] = side == row_below ? nlp->g_lower[which] + slack : nlp->g_upper[which] - slack;
        made->at->lambda[which] = side == row_below ? -multiplier : multiplier;
    }
}

static struct made make_without_multipliers(void)
{
    struct made made = make();
    memset(made.at->z_lower, 0, (size_t)made.t->nlp.n * sizeof(double));
    memset(made.at->z_upper, 0, (size_t)made.t->nlp.n * sizeof(double));
    memset(made.at->lambda, 0, (size_t)made.t->nlp.m * sizeof(double));
    made.at->objective = 2;
    return made;
}

static bool again_with(enum side side, double multiplier, double slack, double objective)
{
    struct made made = make_without_multipliers();
    const int control = made.layout->node[8].x + 2;
    made.at->objective = objective;
    set_pair(&made, side, side < row_below ? control : made.t->layout.events, multiplier, slack);
    const bool ran = again(&made, "room");
    drop(&made);
    return ran;
}

static void test_room(void)
{
    static const struct {
        double multiplier, slack, objective;
        bool again;
    } cases[] = {
        {1, 0.8e-4, 2, true},   {1, 0.8e-4, -2, true},  {1e-3, 0.08, 2, true},
        {1, 0.5e-4, 2, false},  {1, 1.9e-3, 2, true},   {1, 2.1e-3, 2, false},
        {-1, 0.8e-4, 2, false}, {1, -0.8e-4, 2, false}, {-1, -0.8e-4, 2, false},
    };
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++)
        for (int side = below; side <= row_above; side++)
            CHECK(again_with((enum side)side, cases[k].multiplier, cases[k].slack, cases[k].objective) ==
                      cases[k].again,
                  "side %d, multiplier %g times %g of an objective of %g", side, cases[k].multiplier, cases[k].slack,
                  cases[k].objective);
}

// Each of four bounds leaves half of what counts: any two do.
static void test_sum(void)
{
    for (int one = below; one <= row_above; one++)
        for (int other = one; other <= row_above; other++) {
            struct made made = make_without_multipliers();
            const int u = made.layout->node[8].x + 2, v = made.layout->node[0].x + 2;
            for (int k = 0; k < 2; k++) {
                const int side = k ? other : one;
                set_pair(&made, (enum side)side, side < row_below ? (k ? v : u) : made.t->layout.events, 1, 0.4e-4);
            }
            const bool same_row = one >= row_below;
            CHECK(again(&made, "room") == !same_row, "sides %d and %d add up", one, other);
            drop(&made);
        }
}

static void test_no_room(void)
{
    struct made made = make_without_multipliers();
    const int inside = made.layout->node[3].x;
    made.at->z_lower[inside] = made.at->z_upper[inside] = 0.8e-4 / 1e20; // there is no bound
    CHECK(!again(&made, "bounds that do not exist"), "leave no room");
    drop(&made);
    made = make_without_multipliers();
    const int start = made.layout->node[0].x; // fixed
    made.at->z_lower[start] = made.at->z_upper[start] = 1;
    made.at->x[start] = 0.8e-4;
    CHECK(!again(&made, "what is fixed"), "has no room");
    drop(&made);
    made = make_without_multipliers();
    made.solution->info.outcome = MORAY_NLP_STALLED;
    set_pair(&made, above, made.layout->node[8].x + 2, 1, 0.8e-4);
    CHECK(!again(&made, "what is not solved"), "is left");
    drop(&made);
}

// ---- Closer ----

static double room_of(const struct made *made)
{
    const moray_nlp *nlp = &made->t->nlp;
    double sum = 0;
    for (int j = 0; j < nlp->n; j++)
        if (nlp->x_lower[j] < nlp->x_upper[j] && nlp->x_upper[j] < MORAY_INFINITY)
            sum += made->at->z_lower[j] * (made->at->x[j] - nlp->x_lower[j]) +
                   made->at->z_upper[j] * (nlp->x_upper[j] - made->at->x[j]);
    return sum;
}

static void test_closer(void)
{
    struct made made = make();
    const double before = room_of(&made);
    made.at->objective = before / 5e-5;
    CHECK(again(&made, "room"), "where there is room");
    CHECK(room_of(&made) < before / 5, "less of it is left: %.1e of %.1e", room_of(&made), before);
    CHECK(made.solution->settings.tolerance == 1e-8, "the tolerance that is asked for stays");
    drop(&made);
    made = make();
    made.at->objective = before / 5e-5;
    made.solution->settings.rough = true;
    CHECK(!again(&made, "room that nobody minds"), "is left as it is");
    drop(&made);
}

// Where a closer one is not found, all stays as it was.
static void test_no_closer(void)
{
    struct made made = make();
    const size_t size = (size_t)(4 * made.t->nlp.n + 2 * made.t->nlp.m) * sizeof(double);
    double *kept = malloc(size);
    made.at->objective = room_of(&made) / 5e-5;
    for (int j = 0; j < made.t->nlp.n; j++)
        made.at->x[j] += 1e-9 * (j % 7); // so that there is something to do
    made.solution->settings.max_iterations = 0;
    memcpy(kept, made.at->x, size);
    const moray_nlp_info info = made.solution->info;
    const double objective = made.at->objective;
    CHECK_OK(moray_solve_again(made.solution), "without an iteration");
    CHECK(memcmp(kept, made.at->x, size) == 0 && made.at->objective == objective, "the iterate stays");
    CHECK(memcmp(&made.solution->info, &info, sizeof info) == 0, "and what is told of it");
    free(kept);
    drop(&made);
}

int main(void)
{
    test_settings();
    for (unsigned k = 0; k < sizeof changes / sizeof *changes; k++)
        test_scale(&changes[k]);
    test_scales_of_others();
    test_room();
    test_sum();
    test_no_room();
    test_closer();
    test_no_closer();
    return tap_done();
}
