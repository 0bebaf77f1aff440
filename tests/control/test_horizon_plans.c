// SPDX-License-Identifier: MIT
//
// Plans of a receding horizon with two controls from one problem: which are made, which fail, what is recorded, and
// what is refused, by whole messages.
#include "tap.h"

#include <string.h>

#include "moray/clock.h"
#include "moray/control/receding_horizon.h"

static const double horizon = 2;

// Two masses, each with a force of its own, drawn to places of their own.
static void masses(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num *x = at->x, *u = at->u;
    (void)data;
    out->f[0] = x[1];
    out->f[1] = u[0] - csin(x[0]);
    out->f[2] = u[1] - 0.5 * x[2];
    out->g[0] = (x[0] - 1) * (x[0] - 1) + 2 * (x[2] + 0.7) * (x[2] + 0.7) + u[0] * u[0] + 0.3 * u[1] * u[1];
}

static void integral(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase->q[0];
}

static moray_ocp *problem(void)
{
    moray_ocp *ocp;
    const moray_phase_spec phase = {.nx = 3,
                                    .nu = 2,
                                    .nq = 1,
                                    .continuous = masses,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(horizon),
                                    .u = MORAY_BOUNDS(moray_between(-4, 4), moray_between(-3, 3)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), moray_fixed(0))};
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = integral}), "a problem");
    return ocp;
}

static moray_receding_horizon_spec spec_of(moray_ocp *ocp)
{
    moray_receding_horizon_spec spec = {
        .ocp = ocp, .settings = moray_settings_default(), .horizon = horizon, .interval = 0.25};
    spec.settings.scheme = "radau3";
    spec.settings.intervals = 4;
    return spec;
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

// What is applied is the plan's, each control its own, and a record tells of every plan.
static void test_controls(void)
{
    moray_ocp *ocp = problem();
    const moray_receding_horizon_spec spec = spec_of(ocp);
    moray_receding_horizon *receding;
    double u[2] = {7, 7}, want[2], x[3] = {0.2, -0.1, 0.4};
    CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
    moray_receding_horizon_control(receding, 0, u);
    CHECK(u[0] == 0 && u[1] == 0 && !moray_receding_horizon_plan(receding), "without a plan nothing is applied");
    const double begin = moray_processor_clock();
    for (int k = 0; k < 70; k++) {
        CHECK_OK(moray_receding_horizon_measure(receding, 0.25 * k, x), "planned");
        const moray_solution *plan = moray_receding_horizon_plan(receding);
        for (int i = 0; i < 3; i++) {
            moray_receding_horizon_control(receding, 0.25 * k + 0.1 * i, u);
            moray_solution_at(plan, 0, 0.25 * k + 0.1 * i, NULL, want);
            CHECK(u[0] == want[0] && u[1] == want[1] && u[0] != u[1], "the plan's: %g, %g", u[0], u[1]);
        }
        moray_solution_at(plan, 0, 0.25 * (k + 1), x, want);
        x[0] += 0.01; // pushed along
    }
    const double spent = moray_processor_clock() - begin;
    const moray_receding_horizon_record *record = moray_receding_horizon_record_of(receding);
    const moray_replan *made = moray_receding_horizon_replans(receding);
    double seconds = 0, longest = 0;
    int iterations = 0;
    for (int k = 0; k < record->plans; k++) {
        CHECK(made[k].t == 0.25 * k && !made[k].failed && made[k].iterations > 0 && made[k].seconds >= 0, "plan %d", k);
        seconds += made[k].seconds;
        longest = k > 0 && made[k].seconds > longest ? made[k].seconds : longest;
        iterations += made[k].iterations;
    }
    CHECK(record->plans == 70 && record->failures == 0 && record->iterations == iterations, "%d plans", record->plans);
    CHECK(seconds <= spent && fabs(record->seconds - seconds) <= 1e-9 && record->longest == longest,
          "%g s of %g s, the longest but the first %g s", seconds, spent, record->longest);
    moray_receding_horizon_free(receding);
    moray_ocp_free(ocp);
}

// A plan that the solver does not finish is none; the next may be one.
static void test_unfinished(void)
{
    moray_ocp *ocp = problem();
    moray_receding_horizon_spec spec = spec_of(ocp);
    moray_receding_horizon *receding;
    double u[2] = {7, 7};
    spec.settings.max_iterations = 1;
    CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
    CHECK_OK(moray_receding_horizon_measure(receding, 0, (double[]){0.2, -0.1, 0.4}), "no error");
    const moray_receding_horizon_record *record = moray_receding_horizon_record_of(receding);
    CHECK(record->plans == 1 && record->failures == 1 && !moray_receding_horizon_plan(receding), "but no plan");
    CHECK(strncmp(record->first_failure, "t = 0: ", 7) == 0 && strstr(record->first_failure, "iteration"), "%s",
          record->first_failure);
    moray_receding_horizon_control(receding, 0.1, u);
    CHECK(u[0] == 0 && u[1] == 0, "nothing is applied");
    CHECK(moray_receding_horizon_replans(receding)->failed && moray_receding_horizon_replans(receding)->iterations == 1,
          "after an iteration");
    moray_receding_horizon_free(receding);
    moray_ocp_free(ocp);
}

// By rounding a measurement may come before a plan is due, by more it may not.
static void test_early(void)
{
    static const struct {
        double early; // of an interval
        int plans;
    } cases[] = {{0, 2}, {0.5e-9, 2}, {2e-9, 1}, {1e-7, 1}, {1e-3, 1}};
    for (int k = 0; k < 5; k++) {
        moray_ocp *ocp = problem();
        moray_receding_horizon_spec spec = spec_of(ocp);
        moray_receding_horizon *receding;
        const double x[3] = {0.2, -0.1, 0.4};
        spec.interval = 1e-2;
        CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
        CHECK_OK(moray_receding_horizon_measure(receding, 0, x), "planned");
        CHECK_OK(moray_receding_horizon_measure(receding, spec.interval * (1 - cases[k].early), x), "measured");
        CHECK(moray_receding_horizon_record_of(receding)->plans == cases[k].plans, "%g early: %d plans", cases[k].early,
              moray_receding_horizon_record_of(receding)->plans);
        moray_receding_horizon_free(receding);
        moray_ocp_free(ocp);
    }
}

// ---- Changes -------------------------------------------------------------------------------------------------------

static int made, freed, looks;

static moray_status make(void *self, double t, const double *x, void **own, const moray_ocp **ocp)
{
    moray_ocp *posed = problem();
    (void)self;
    made++;
    *own = posed;
    *ocp = posed;
    return moray_ocp_restart(posed, t, horizon, x);
}

static void release(void *own)
{
    freed++;
    moray_ocp_free(own);
}

static bool changed(const void *self, double t)
{
    looks++;
    return t == *(const double *)self;
}

// Of the problem the planner is asked whether it has changed once there is a plan, and each problem is freed once.
static void test_changed(void)
{
    double news = 0.1;
    const double x[3] = {0.2, -0.1, 0.4};
    moray_receding_horizon_spec spec = spec_of(NULL);
    spec.replanner =
        (moray_replanner){.nx = 3, .nu = 2, .make = make, .free = release, .changed = changed, .self = &news};
    moray_receding_horizon *receding;
    CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
    made = freed = looks = 0;
    static const double times[] = {0, 0.05, 0.1, 0.2, 0.34, 0.35};
    static const int plans[] = {1, 1, 2, 2, 2, 3};
    for (int k = 0; k < 6; k++) {
        CHECK_OK(moray_receding_horizon_measure(receding, times[k], x), "measured");
        CHECK(looks == k && made == plans[k] && freed == plans[k] - 1, "at %g: looked %d times, %d made, %d freed",
              times[k], looks, made, freed);
    }
    moray_receding_horizon_free(receding);
    CHECK(freed == made, "%d of %d", freed, made);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void refuse(moray_receding_horizon_spec spec, const char *says)
{
    moray_receding_horizon *receding;
    const moray_status status = moray_receding_horizon_new(&receding, &spec);
    CHECK(status.code == MORAY_INPUT && !receding && strcmp(status.text, says) == 0, "%s, not %s", status.text, says);
}

static void test_refused(void)
{
    moray_ocp *ocp = problem();
    const moray_receding_horizon_spec good = spec_of(ocp);
    moray_receding_horizon_spec spec = good;
    moray_receding_horizon *receding;
    spec.interval = 0;
    refuse(spec, "horizon = 2, replanned every 0: the horizon must be the longer");
    spec.interval = 2.5;
    refuse(spec, "horizon = 2, replanned every 2.5: the horizon must be the longer");
    spec.horizon = INFINITY;
    refuse(spec, "horizon = inf, replanned every 2.5: the horizon must be the longer");
    spec = good, spec.watch = -0.1;
    refuse(spec, "watch = -0.1: must lie between 0 and the interval, 0.25");
    spec.watch = 0.26;
    refuse(spec, "watch = 0.26: must lie between 0 and the interval, 0.25");
    spec = good, spec.settings.intervals = 0;
    refuse(spec, "intervals = 0: a plan has at least 1");
    spec = good, spec.ocp = NULL;
    refuse(spec, "a receding horizon needs a problem or a replanner, and only one");
    spec = good, spec.replanner.make = make;
    refuse(spec, "a receding horizon needs a problem or a replanner, and only one");
    for (int k = 0; k < 3; k++) {
        char says[100];
        int size[3] = {2, 2, 2};
        size[k] = k == 0 ? 0 : -1;
        spec = good, spec.ocp = NULL;
        spec.replanner = (moray_replanner){.nx = size[0], .nu = size[1], .ns = size[2], .make = make};
        snprintf(says, sizeof says, "plans of %d states, %d controls, %d parameters: must be at least 1, 0 and 0",
                 size[0], size[1], size[2]);
        refuse(spec, says);
    }
    spec = good, spec.interval = spec.watch = spec.horizon;
    CHECK_OK(moray_receding_horizon_new(&receding, &spec), "as long, and watched as often");
    CHECK(moray_receding_horizon_controller(receding).period == 2 &&
              moray_receding_horizon_controller(receding).nu == 2,
          "whose measurements come as often");
    moray_receding_horizon_free(receding);
    static const int sizes[][3] = {{2, 2, 0}, {3, 1, 0}, {3, 2, 1}};
    for (int k = 0; k < 3; k++) {
        char says[150];
        spec = good, spec.ocp = NULL;
        spec.replanner =
            (moray_replanner){.nx = sizes[k][0], .nu = sizes[k][1], .ns = sizes[k][2], .make = make, .free = release};
        snprintf(says, sizeof says,
                 "the problem has 3 states, 2 controls, 0 parameters: the receding horizon has %d, %d, %d", sizes[k][0],
                 sizes[k][1], sizes[k][2]);
        CHECK_OK(moray_receding_horizon_new(&receding, &spec), "of other sizes than its problems");
        made = freed = 0;
        const moray_status status = moray_receding_horizon_measure(receding, 0, (double[]){0.2, -0.1, 0.4});
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0 && made == 1 && freed == 1, "%s",
              status.text);
        moray_receding_horizon_free(receding);
    }
    moray_ocp_free(ocp);
}

int main(void)
{
    test_controls();
    test_unfinished();
    test_early();
    test_changed();
    test_refused();
    return tap_done();
}
