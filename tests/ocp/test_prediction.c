// SPDX-License-Identifier: MIT
//
// Sensitivities of a problem of two phases into which the parameter p enters everywhere, all known in closed form, and
// what is predicted from them far beyond where the active set changes.
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "moray/sensitivity.h"
#include "ocp/solution.h"

// In each phase, with a weight: u[0] is to be p and may be 1, u[1] is to be -1.5 p and may be -1, u[2] is to be p and
// may be that, and u[3] is to carry the first state along: from 0 to p^2 by an event, or from 0 to 3 at p u[3].
enum { phases = 2, controls = 4 };
static const double weight[phases] = {1, 2};

struct task {
    double p, least; // the latter of u[2]
    bool steep;      // beyond what a number holds
};

static moray_num square(moray_num a)
{
    return a * a;
}

static void carry(const moray_node *at, moray_rates *out, const void *data)
{
    const struct task *task = data;
    const moray_num *u = at->u;
    out->f[0] = u[3];
    out->g[0] = square(u[0] - task->p) + square(u[1] + 1.5 * task->p) + square(u[2] - task->p) + square(u[3]);
}

static void carry_more(const moray_node *at, moray_rates *out, const void *data)
{
    const struct task *task = data;
    carry(at, out, data);
    out->f[0] = task->p * at->u[3];
    out->f[1] = task->steep ? 1e300 * sin(1e10 * at->x[1]) : 1 + 0 * at->u[0];
}

static void pay(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = weight[0] * at->phase[0].q[0] + weight[1] * at->phase[1].q[0];
    out->objective += square(at->s[0] - 4) + square(at->s[1] + 1);
    out->e[0] = at->phase[0].xf[0];
}

static moray_ocp *make(const struct task *task)
{
    const double p = task->p;
    const moray_bounds u[controls] = {{-5, 1}, {-1, 5}, {task->least, 2.5}, moray_free()};
    moray_phase_spec phase[phases] = {{.name = "one",
                                       .nx = 1,
                                       .nu = controls,
                                       .nq = 1,
                                       .continuous = carry,
                                       .t0 = moray_fixed(p / 4),
                                       .tf = moray_fixed(2 * p),
                                       .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                       .u = MORAY_BOUNDS_OF(u)},
                                      {.name = "two",
                                       .nx = 2,
                                       .nu = controls,
                                       .nq = 1,
                                       .continuous = carry_more,
                                       .t0 = moray_fixed(0.5),
                                       .tf = moray_fixed(3 * p),
                                       .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                       .xf = MORAY_BOUNDS(moray_fixed(3), moray_free()),
                                       .u = MORAY_BOUNDS_OF(u)}};
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = phases,
                                                   .phase = phase,
                                                   .ns = 2,
                                                   .s = MORAY_BOUNDS(moray_at_most(p / 2), moray_between(p, 20)),
                                                   .ne = 1,
                                                   .e = MORAY_BOUNDS(moray_fixed(p * p)),
                                                   .endpoint = pay,
                                                   .data = task}),
             "a problem");
    return ocp;
}

// ---- Closed form ----

static double length(int phase, double p)
{
    return phase ? 3 * p - 0.5 : 1.75 * p;
}

static double integral(int phase, double p)
{
    const double T = length(phase, p), off = phase ? 9 / (p * p * T) : p * p * p * p / T;
    return (pow(1 - p, 2) + pow(1.5 * p - 1, 2)) * T + off;
}

static double objective(double p)
{
    return weight[0] * integral(0, p) + weight[1] * integral(1, p) + pow(p / 2 - 4, 2) + pow(p + 1, 2);
}

// What the bounds of u[0] and u[1] cost per weight of a node, and what that moves by.
static double price(int phase, int control, double p)
{
    return 2 * weight[phase] * (control ? 1.5 * p - 1 : p - 1) * length(phase, p);
}

static const double h = 1e-3, p = 2;

static double slope_of_price(int phase, int control)
{
    return (price(phase, control, p + h) - price(phase, control, p - h)) / (2 * h); // a square in p: exact
}

// ---- Solved ----

struct solved {
    struct task task, moved[4];
    moray_ocp *ocp, *displaced[4];
    moray_solution *solution;
    moray_sensitivity *s;
};

static void solve(struct solved *all, double value, double least)
{
    moray_settings settings = moray_settings_default();
    settings.tolerance = 1e-11;
    settings.intervals = 2;
    all->task = (struct task){value, least, false};
    all->ocp = make(&all->task);
    CHECK_OK(moray_solve(all->ocp, &settings, NULL, &all->solution), "solve");
    CHECK_OK(moray_sensitivity_new(&all->s, all->solution), "sensitivities");
    for (int k = 0; k < 4; k++) {
        all->moved[k] = all->task;
        all->moved[k].p += (k < 2 ? k - 2 : k - 1) * h;
        all->displaced[k] = make(&all->moved[k]);
    }
}

static moray_status by_p(struct solved *all)
{
    return moray_sensitivity_by(all->s, (const moray_ocp *const *)all->displaced, h);
}

static void end(struct solved *all)
{
    moray_sensitivity_free(all->s);
    moray_solution_free(all->solution);
    moray_ocp_free(all->ocp);
    for (int k = 0; k < 4; k++)
        moray_ocp_free(all->displaced[k]);
}

// ---- Derivatives ----

static void test_derivatives(struct solved *all)
{
    static const double times[phases][2] = {{0.25, 2}, {0, 3}};
    moray_sensitivity *s = all->s;
    double x0[2] = {9, 9}, xf[2] = {9, 9}, t0, tf;
    CHECK_OK(by_p(all), "by p");
    CHECK_NEAR(moray_sensitivity_objective(s), (objective(p + h) - objective(p - h)) / (2 * h), 1e-4, "objective");
    CHECK_NEAR(moray_sensitivity_parameters(s)[0], 0.5, 1e-8, "a parameter at its upper bound");
    CHECK_NEAR(moray_sensitivity_parameters(s)[1], 1, 1e-8, "one at its lower bound");
    for (int k = 0; k < phases; k++) {
        const double of_q = (integral(k, p + h) - integral(k, p - h)) / (2 * h);
        CHECK_NEAR(moray_sensitivity_integrals(s, k)[0], of_q, 1e-4, "integral");
        moray_sensitivity_times(s, k, &t0, &tf);
        CHECK_NEAR(t0, times[k][0], 1e-9, "start");
        CHECK_NEAR(tf, times[k][1], 1e-9, "end");
        moray_sensitivity_ends(s, k, x0, xf);
        CHECK_NEAR(x0[0], 0, 1e-9, "where it begins");
        CHECK_NEAR(xf[0], k ? 0 : 2 * p, 1e-8, "where it ends");
    }
    CHECK_NEAR(x0[1], 0, 1e-9, "the clock begins");
    CHECK_NEAR(xf[1], 3, 1e-8, "and ends");
}

static void test_change(const moray_sensitivity *s, int direction, double step, const char *begins, const char *ends)
{
    const moray_active_change change = moray_sensitivity_change(s, direction);
    CHECK_NEAR(change.step, step, 1e-6, "what changes first");
    const size_t length = strlen(change.what), tail = strlen(ends);
    CHECK(strncmp(change.what, begins, strlen(begins)) == 0 && length > tail &&
              strcmp(change.what + length - tail, ends) == 0,
          "%s", change.what);
}

// ---- Predictions ----

static double kept(double value, double lower, double upper)
{
    return value < lower ? lower : value > upper ? upper : value;
}

static void check_phase(const struct solved *all, const moray_solution *predicted, int phase, double step)
{
    const struct phase_layout *layout = &predicted->transcription->layout.phase[phase];
    const moray_iterate *at = &predicted->iterate;
    double worst[4] = {0}, above = 0;
    for (int n = 0; n < layout->nodes; n++) {
        const struct node *node = &layout->node[n];
        const int u = node->x + (phase ? 2 : 1);
        worst[0] = tap_worse(worst[0], fabs(at->x[u + 2] - kept(p + step, all->task.least, 2.5)));
        for (int k = 0; k < 2; k++) {
            const double z = price(phase, k, p) + step * slope_of_price(phase, k);
            const double found = (k ? at->z_lower : at->z_upper)[u + k], want = node->weight * (z > 0 ? z : 0);
            worst[1] = tap_worse(worst[1], fabs(found - want));
            worst[2] = tap_worse(worst[2], fabs((k ? at->z_upper : at->z_lower)[u + k]));
            worst[3] = tap_worse(worst[3], fabs(at->x[u + k] - (k ? -1 : 1)));
            above = fmax(above, want);
        }
    }
    CHECK(worst[0] < 1e-7, "p %+g: a control moves, within its bounds, to %.1e", step, worst[0]);
    CHECK(worst[1] < 1e-6, "what bounds cost, never below 0, to %.1e of %g", worst[1], above);
    CHECK(worst[2] < 1e-6, "nothing on the other sides, to %.1e", worst[2]);
    CHECK(worst[3] < 1e-7, "where they hold, to %.1e", worst[3]);
}

static void test_prediction(const struct solved *all, double step)
{
    const struct transcription *t = all->solution->transcription;
    moray_solution *predicted;
    CHECK_OK(moray_sensitivity_predict(all->s, all->ocp, step, &predicted), "predicted");
    for (int k = 0; k < phases; k++)
        check_phase(all, predicted, k, step);
    const double of_event = -2 * weight[0] / 1.75; // times p
    CHECK_NEAR(predicted->iterate.lambda[t->layout.events], of_event * (p + step), 1e-6, "an event's multiplier");
    CHECK_NEAR(predicted->iterate.z_lower[t->layout.s + 1], fmax(2 * (p + step + 1), 0), 1e-6, "a parameter's, below");
    CHECK_NEAR(predicted->iterate.z_upper[t->layout.s], fmax(2 * (4 - (p + step) / 2), 0), 1e-6, "and above");
    CHECK(predicted->settings.tolerance == 1e-11 && predicted->settings.intervals == 2, "the settings go with it");
    moray_solution_free(predicted);
}

// ---- What is in doubt ----

static void test_weak(void)
{
    struct solved all;
    solve(&all, 1, -10);
    const char *weak = moray_sensitivity_weak(all.s);
    CHECK(strcmp(weak, "control u[0] of phase one at t = 0.25; control u[0] of phase one at t = 0.6875; "
                       "control u[0] of phase one at t = 1.125; control u[0] of phase one at t = 1.5625; "
                       "control u[0] of phase one at t = 2; and 5 more") == 0,
          "in doubt: %s", weak);
    end(&all);
}

// ---- What is refused ----

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)at, (void)data;
    out->f[0] = 1;
}

static void nothing(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

static void check_refused(moray_status status, moray_code code, const char *expected)
{
    CHECK(status.code == code && strcmp(status.text, expected) == 0, "%s", status.text);
}

static void test_refusals(struct solved *all)
{
    static const double wrong[] = {0, -1, NAN, INFINITY};
    static const char *const texts[] = {"h = 0: must be finite and above 0", "h = -1: must be finite and above 0",
                                        "h = nan: must be finite and above 0", "h = inf: must be finite and above 0"};
    for (int k = 0; k < 4; k++)
        check_refused(moray_sensitivity_by(all->s, (const moray_ocp *const *)all->displaced, wrong[k]), MORAY_INPUT,
                      texts[k]);
    const moray_phase_spec phase[] = {{.nx = 1, .continuous = still, .tf = moray_fixed(1)},
                                      {.nx = 1, .continuous = still, .tf = moray_fixed(1)}};
    const struct task too_steep = {p, -10, true};
    moray_ocp *one, *two, *right = all->displaced[2], *steep = make(&too_steep);
    CHECK_OK(moray_ocp_new(&one, &(moray_ocp_spec){.phases = 1, .phase = phase, .endpoint = nothing}), "one phase");
    CHECK_OK(moray_ocp_new(&two, &(moray_ocp_spec){.phases = 2, .phase = phase, .endpoint = nothing}), "small phases");
    all->displaced[2] = one;
    check_refused(by_p(all), MORAY_INPUT, "a displaced problem has 1 phases, the solution 2");
    all->displaced[2] = two; // 5 nodes a phase; then the same with 4 and 5 controls and states, integrals, s; 4 defects
    check_refused(by_p(all), MORAY_INPUT,
                  "a displaced problem has 10 variables and 8 constraints, the solution 59 and 15");
    all->displaced[2] = steep;
    check_refused(by_p(all), MORAY_NUMERIC, "a derivative is not finite");
    all->displaced[2] = right;
    CHECK_OK(by_p(all), "by p, after all");
    moray_ocp_free(one);
    moray_ocp_free(two);
    moray_ocp_free(steep);
}

int main(void)
{
    struct solved all;
    solve(&all, p, -10);
    CHECK(moray_sensitivity_weak(all.s)[0] == 0, "no doubt: %s", moray_sensitivity_weak(all.s));
    test_derivatives(&all);
    test_change(all.s, 1, 0.5, "control u[2] of phase ", " would pass its upper bound");
    const double leaves = -price(1, 0, p) / slope_of_price(1, 0);
    test_change(all.s, -1, leaves, "control u[0] of phase two at t = ", " would leave its upper bound");
    static const double steps[] = {0.1, -0.1, 3, -3, 20, -20};
    for (int k = 0; k < 6; k++)
        test_prediction(&all, steps[k]);
    test_refusals(&all);
    end(&all);
    solve(&all, p, 1.75);
    CHECK_OK(by_p(&all), "by p");
    test_change(all.s, -1, -0.25, "control u[2] of phase ", " would pass its lower bound");
    test_prediction(&all, -3);
    end(&all);
    test_weak();
    return tap_done();
}
