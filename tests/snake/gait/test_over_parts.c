// SPDX-License-Identifier: MIT
//
// One gait for several scenarios, part by part: what is shared and what is each one's own, under which names and within
// which bounds; and their plants with the parameters of all.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "snake/gait/over.h"

enum { N = 3, LINKS = 5 };
static const double none = MORAY_INFINITY;

// Limits that all differ; those of theta_max, delta and taper but for the first are not used.
static void make_scenarios(moray_gait_scenario scenario[N], moray_model model)
{
    static const char *const names[N] = {"first", "a second", "the third of the scenarios of a long name"};
    for (int k = 0; k < N; k++) {
        moray_gait_problem_spec spec = {.robot = moray_robot_paper(),
                                        .model = model,
                                        .goal = MORAY_GAIT_THRIFTIEST,
                                        .current = {0.01 * k, -0.02 * k},
                                        .limits = {.theta_max = moray_between((5 + k) * DEG, (20 + k) * DEG),
                                                   .omega = moray_between(0.5 + k, 6 + k),
                                                   .delta = moray_between(0.3, 1.5 + 0.1 * k),
                                                   .offset = moray_between(-0.02 - 0.01 * k, 0.01 + 0.01 * k),
                                                   .taper = moray_between(-0.2 - 0.1 * k, k == 1 ? 0 : 0.3),
                                                   .power = 0.7 + 0.1 * k,
                                                   .joint_rate = k == 2 ? none : 2.5,
                                                   .joint_effort = none}};
        spec.robot.links = LINKS;
        spec.robot.c_n *= 1 + 0.2 * k;
        scenario[k] = (moray_gait_scenario){names[k], spec, 0.1 + 0.05 * k};
    }
}

static moray_gait_over *over_of(const moray_gait_scenario *scenario, moray_over_goal goal)
{
    moray_gait_over *over = NULL;
    CHECK_OK(moray_gait_over_new(&over, scenario, N, goal), "over scenarios");
    if (!over)
        exit(1);
    return over;
}

static int at; // of the bounds and names of a programme

static void next(const moray_gait_over *over, const char *name, double lower, double upper)
{
    const moray_bounds *bounds = &over->bounds[at];
    CHECK(strcmp(over->name[at], name) == 0, "%d: '%s', expected '%s'", at, over->name[at], name);
    CHECK(fabs(bounds->lower - lower) <= 1e-14 * fabs(lower) && fabs(bounds->upper - upper) <= 1e-14 * fabs(upper),
          "%s: %.17g to %.17g, expected %.17g to %.17g", name, bounds->lower, bounds->upper, lower, upper);
    at++;
}

static void next_of(const moray_gait_over *over, const char *what, const char *scenario, double lower, double upper)
{
    char name[100];
    snprintf(name, sizeof name, "%s on %s", what, scenario);
    next(over, name, lower, upper);
}

static void check_parameters(const moray_gait_over *over, const moray_gait_scenario *scenario)
{
    at = 0;
    next(over, "amplitude", 0, 40 * DEG);
    for (int k = 0; k < N; k++)
        next_of(over, "omega", scenario[k].name, 0.5 + k, 6 + k);
    next(over, "delta", 0.3, 1.5);
    for (int k = 0; k < N; k++)
        next_of(over, "phi_0", scenario[k].name, -0.02 - 0.01 * k, 0.01 + 0.01 * k);
    next(over, "taper", -0.2, 0.3);
    if (over->goal == MORAY_OVER_WORST)
        next(over, "least gain", -1, none);
    CHECK(at == over->ns, "%d parameters, not %d", over->ns, at);
}

// The shared shape is bounded once; the power is what it is of the baseline.
static void check_events(const moray_gait_over *over)
{
    static const char *const names[N] = {"first", "a second", "the third of the scenari"};
    for (int k = 0; k < N; k++) {
        const double most = 20 * DEG;
        for (int r = 1; r <= 4; r++) {
            char what[20];
            snprintf(what, sizeof what, "periodicity %d", r);
            next_of(over, what, names[k], 0, 0);
        }
        next_of(over, "way across the course", names[k], 0, 0);
        next_of(over, "omega T", names[k], 2 * M_PI, 2 * M_PI);
        if (k == 0) {
            next_of(over, "theta_max", names[k], 5 * DEG, most);
            next_of(over, "theta_max of the head", names[k], -none, most * most);
            next_of(over, "theta_max of the tail", names[k], -none, most * most);
        }
        next_of(over, "power", names[k], 0.7 + 0.1 * k, 0.7 + 0.1 * k);
        if (k == 0)
            next_of(over, "joint rate of the head", names[k], -none, 2.5);
        if (k < 2)
            next_of(over, k ? "joint rate" : "joint rate of the tail", names[k], -none, 2.5);
        if (over->goal == MORAY_OVER_WORST)
            next_of(over, "gain", names[k], 0, none);
    }
    CHECK(at == over->ns + over->ne, "%d events, not %d", over->ne, at - over->ns);
}

// Where input i of a scenario's own plant stands among those of all.
static int input_of(const moray_gait_over *over, int k, int i)
{
    const int place[] = {0, 1 + k, 1 + N, 2 + N + k, 2 + 2 * N, over->ns};
    return i < MORAY_BODY_STATES ? i : MORAY_BODY_STATES + place[i - MORAY_BODY_STATES];
}

static double entry(const moray_pattern *pattern, const double *values, int row, int col)
{
    for (int k = 0; k < pattern->nnz; k++)
        if (pattern->row[k] == row && pattern->col[k] == col)
            return values[k];
    return NAN;
}

// A plant does with the parameters of all what its problem's does with its own; values, Jacobian and Hessian.
static void check_plant(const moray_gait_over *over, int k)
{
    enum { most = 40, entries = 400 };
    const moray_map *plant = &over->plant[k], *own = &over->problem[k]->plant;
    unsigned long long seed = 5 + (unsigned)k;
    double in[most], of[most], out[most], want[most], weight[most], values[entries], wanted[entries], worst = 0;
    CHECK(plant->n_in == MORAY_BODY_STATES + over->ns + 1 && plant->n_out == own->n_out &&
              plant->jac.nnz == own->jac.nnz && plant->hess.nnz == own->hess.nnz && own->hess.nnz <= entries &&
              own->jac.nnz <= entries,
          "%d inputs, %d outputs", plant->n_in, plant->n_out);
    for (int i = 0; i < plant->n_in; i++)
        in[i] = tap_random(&seed, 0.2, 0.8);
    for (int i = 0; i < own->n_out; i++)
        weight[i] = tap_random(&seed, -1, 1);
    for (int i = 0; i < own->n_in; i++)
        of[i] = in[input_of(over, k, i)];
    plant->value(plant->self, in, out);
    own->value(own->self, of, want);
    for (int i = 0; i < own->n_out; i++)
        worst = tap_worse(worst, fabs(out[i] - want[i]));
    plant->jacobian(plant->self, in, values);
    own->jacobian(own->self, of, wanted);
    for (int i = 0; i < own->jac.nnz; i++) {
        const double got = entry(&plant->jac, values, own->jac.row[i], input_of(over, k, own->jac.col[i]));
        worst = tap_worse(worst, fabs(got - wanted[i]));
    }
    plant->hessian(plant->self, in, weight, values);
    own->hessian(own->self, of, weight, wanted);
    for (int i = 0; i < own->hess.nnz; i++) {
        const double got =
            entry(&plant->hess, values, input_of(over, k, own->hess.row[i]), input_of(over, k, own->hess.col[i]));
        worst = tap_worse(worst, fabs(got - wanted[i]));
    }
    CHECK(worst == 0, "plant %d: off by %.1e", k, worst);
}

static void test_parts(moray_over_goal goal)
{
    moray_gait_scenario scenario[N];
    make_scenarios(scenario, MORAY_FIRST_PRINCIPLES);
    moray_gait_over *over = over_of(scenario, goal);
    check_parameters(over, scenario);
    check_events(over);
    for (int k = 0; k < N; k++) {
        check_plant(over, k);
        CHECK(over->phase[k].name == scenario[k].name && over->phase[k].map == &over->plant[k] &&
                  over->speed[k] == scenario[k].speed,
              "phase %d", k);
    }
    moray_gait_over_free(over);
}

int main(void)
{
    test_parts(MORAY_OVER_WORST);
    test_parts(MORAY_OVER_MEAN);
    moray_gait_over_free(NULL);
    return tap_done();
}
