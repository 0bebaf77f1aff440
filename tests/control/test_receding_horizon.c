// SPDX-License-Identifier: MIT
//
// Receding horizon against linear-quadratic control in closed form, and where a plan alone falls.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/control/receding_horizon.h"

// ---- A mass: x'' = u, integral of x^2 + u^2 ------------------------------------------------------------------------
//
// With the cost-to-go x' P x at the end of a plan, P = [sqrt 2, 1; 1, sqrt 2], every plan is the beginning of the
// infinite one: u = -x - sqrt 2 v, whose poles are (-1 +- i) / sqrt 2.

static void mass(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->g[0] = at->x[0] * at->x[0] + at->u[0] * at->u[0];
}

static void cost_to_go(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_num *x = at->phase->xf;
    out->objective = at->phase->q[0] + sqrt(2) * (x[0] * x[0] + x[1] * x[1]) + 2 * x[0] * x[1];
}

// Where a replanner's problems come from, and what was asked of it.
typedef struct planner {
    double horizon;
    int made, fail_from; // fail_from: no problem from this one on
    bool wide;           // a control too many
    double news;         // time of a change
    double told;         // when it was last looked for
} planner;

static moray_status make_mass(void *self, double t, const double *x, void **problem, const moray_ocp **ocp)
{
    planner *p = self;
    if (p->made >= p->fail_from)
        return moray_error(MORAY_NUMERIC, "it rains");
    moray_ocp *made;
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = p->wide ? 2 : 1,
                                    .nq = 1,
                                    .continuous = mass,
                                    .t0 = moray_fixed(t),
                                    .tf = moray_fixed(t + p->horizon),
                                    .x0 = MORAY_BOUNDS(moray_fixed(x[0]), moray_fixed(x[1]))};
    MORAY_TRY(moray_ocp_new(&made, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = cost_to_go}));
    p->made++;
    p->told = t;
    *problem = made;
    *ocp = made;
    return moray_ok();
}

static void free_ocp(void *problem)
{
    moray_ocp_free(problem);
}

static bool news(const void *self, double t)
{
    const planner *p = self;
    return p->told < p->news && t >= p->news;
}

static moray_receding_horizon_spec spec_of(planner *p, double interval)
{
    moray_receding_horizon_spec spec = {.replanner = {.nx = 2, .nu = 1, .make = make_mass, .free = free_ocp, .self = p},
                                        .settings = moray_settings_default(),
                                        .horizon = p->horizon,
                                        .interval = interval};
    spec.settings.scheme = "lobatto5";
    spec.settings.intervals = 8;
    return spec;
}

// The true mass is pushed by an acceleration that the plans know nothing of.
static bool pushed(double t, const double *x, const double *u, double *dx, void *self)
{
    (void)t;
    dx[0] = x[1];
    dx[1] = u[0] + *(const double *)self;
    return true;
}

static moray_status run(moray_receding_horizon *receding, double push, double t1, double *x)
{
    const moray_controller controller = moray_receding_horizon_controller(receding);
    const moray_closed_loop_spec spec = {.plant = {.nx = 2, .nu = 1, .rates = pushed, .self = &push},
                                         .controller = &controller,
                                         .t1 = t1,
                                         .settings = moray_sim_settings_default()};
    return moray_closed_loop_run(&spec, x);
}

// Of u = -x - sqrt 2 v after t.
static void regulated(double t, double x[2])
{
    const double a = sqrt(0.5), c = cos(a * t), s = sin(a * t), e = exp(-a * t), x0 = x[0], v0 = x[1];
    x[0] = e * (c * x0 + s * (x0 + v0 / a));
    x[1] = e * (c * v0 - s * (v0 + x0 / a));
}

// Each interval of h adds push (h^2/2, h), the next plan starts from what has become of it.
static void test_regulator(void)
{
    static const double pushes[] = {0, 0.4}, intervals[] = {0.5, 0.25};
    for (int k = 0; k < 4; k++) {
        const double push = pushes[k / 2], h = intervals[k % 2];
        planner p = {.horizon = 1.5, .fail_from = 1000};
        moray_receding_horizon *receding;
        double x[2] = {1, 0.3}, exact[2] = {1, 0.3}, open[2] = {1, 0.3};
        const moray_receding_horizon_spec spec = spec_of(&p, h);
        CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
        CHECK_OK(run(receding, push, 6, x), "run");
        for (int i = 0; i < (int)lround(6 / h); i++) {
            regulated(h, exact);
            exact[0] += push * h * h / 2;
            exact[1] += push * h;
        }
        regulated(6, open);
        CHECK_NEAR(x[0], exact[0], 1e-6, "position of the mass");
        CHECK_NEAR(x[1], exact[1], 1e-6, "velocity");
        CHECK(push == 0 || fabs(exact[0]) < 0.1 * fabs(open[0] + push * 18), "the plan alone: %.2g, replanned: %.2g",
              open[0] + push * 18, x[0]);
        const moray_receding_horizon_record *record = moray_receding_horizon_record_of(receding);
        const moray_replan *replans = moray_receding_horizon_replans(receding);
        double seconds = 0;
        int iterations = 0, ascending = 1;
        for (int i = 0; i < record->plans; i++) {
            seconds += replans[i].seconds;
            iterations += replans[i].iterations;
            ascending &= fabs(replans[i].t - i * h) < 1e-9 && !replans[i].failed;
        }
        CHECK(record->plans == (int)lround(6 / h) + 1 && record->failures == 0 && ascending, "%d plans", record->plans);
        CHECK(iterations == record->iterations && fabs(seconds - record->seconds) < 1e-9 && record->longest > 0 &&
                  record->longest < seconds,
              "%d iterations, %.3g s", iterations, seconds);
        moray_receding_horizon_free(receding);
    }
}

// Plans fail from 0.5 on: the first is carried out to its end, its last control held beyond.
static void test_failure(void)
{
    planner p = {.horizon = 1, .fail_from = 1};
    moray_receding_horizon *receding;
    double x[2] = {1, 0}, exact[2] = {1, 0}, u;
    const moray_receding_horizon_spec spec = spec_of(&p, 0.5);
    CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
    moray_receding_horizon_control(receding, 0, &u);
    CHECK(u == 0 && !moray_receding_horizon_plan(receding), "no plan, no control");
    CHECK_OK(run(receding, 0, 2, x), "run");
    regulated(1, exact);
    const double held = -exact[0] - sqrt(2) * exact[1];
    CHECK_NEAR(x[0], exact[0] + exact[1] + held / 2, 1e-6, "position");
    CHECK_NEAR(x[1], exact[1] + held, 1e-6, "velocity");
    const moray_receding_horizon_record *record = moray_receding_horizon_record_of(receding);
    CHECK(record->plans == 5 && record->failures == 4 && strstr(record->first_failure, "t = 0.5: it rains"),
          "%d plans, %d failures, the first at %s", record->plans, record->failures, record->first_failure);
    CHECK(!moray_receding_horizon_replans(receding)[0].failed && moray_receding_horizon_replans(receding)[1].failed,
          "told for each");
    moray_receding_horizon_free(receding);
}

// The first plan is due whenever the first measurement comes, the others an interval after the one before, but for
// rounding.
static void test_due(void)
{
    static const struct {
        double t;
        int plans;
    } expected[] = {{-7, 1},    {-6.6, 1}, {-6.5 - 1e-6, 1}, {-6.5 - 1e-10, 2},
                    {-6.01, 2}, {-5.9, 3}, {-5.5, 3},        {-5.4, 4}};
    planner p = {.horizon = 1, .fail_from = 1000};
    const double x[2] = {1, 0};
    moray_receding_horizon *receding;
    const moray_receding_horizon_spec spec = spec_of(&p, 0.5);
    CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
    for (size_t k = 0; k < sizeof expected / sizeof *expected; k++) {
        CHECK_OK(moray_receding_horizon_measure(receding, expected[k].t, x), "measured");
        const int plans = moray_receding_horizon_record_of(receding)->plans;
        CHECK(plans == expected[k].plans, "at %.10g there are %d plans", expected[k].t, plans);
    }
    moray_receding_horizon_free(receding);
}

static void test_change(void)
{
    static const double expected[] = {0, 0.5, 0.7, 1.2};
    planner p = {.horizon = 1, .fail_from = 1000, .news = 0.65};
    moray_receding_horizon *receding;
    double x[2] = {1, 0};
    moray_receding_horizon_spec spec = spec_of(&p, 0.5);
    spec.replanner.changed = news;
    spec.watch = 0.1;
    CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
    CHECK_OK(run(receding, 0, 1.4, x), "run");
    const moray_receding_horizon_record *record = moray_receding_horizon_record_of(receding);
    CHECK(record->plans == 4, "%d plans", record->plans);
    for (int k = 0; k < 4; k++)
        CHECK_NEAR(moray_receding_horizon_replans(receding)[k].t, expected[k], 1e-9, "time of a plan");
    moray_receding_horizon_free(receding);
}

static void refuses(moray_receding_horizon_spec spec, const char *says)
{
    moray_receding_horizon *receding;
    const moray_status status = moray_receding_horizon_new(&receding, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says) && !receding, "refused: %s", status.text);
}

static void test_refusals(void)
{
    planner p = {.horizon = 1, .fail_from = 1000};
    const moray_receding_horizon_spec good = spec_of(&p, 0.5);
    moray_receding_horizon_spec spec = good;
    moray_receding_horizon *receding;
    spec.interval = 2;
    refuses(spec, "horizon = 1, replanned every 2");
    spec = good, spec.interval = NAN;
    refuses(spec, "every nan");
    spec = good, spec.watch = 0.6;
    refuses(spec, "watch = 0.6");
    spec = good, spec.settings.intervals = 0;
    refuses(spec, "intervals = 0");
    spec = good, spec.replanner.nu = -1;
    refuses(spec, "-1 controls");
    CHECK_OK(moray_receding_horizon_new(&receding, &good), "receding horizon");
    p.wide = true;
    double x[2] = {1, 0};
    const moray_status status = run(receding, 0, 1, x);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "2 states, 2 controls"), "a problem too wide: %s",
          status.text);
    p.wide = false;
    CHECK_OK(moray_receding_horizon_measure(receding, 0, x), "a plan");
    spec = good, spec.first = moray_receding_horizon_plan(receding), spec.replanner.nx = 3;
    refuses(spec, "the first plan has 2 states");
    moray_receding_horizon_free(receding);
    moray_receding_horizon_free(NULL);
}

// ---- A pendulum on its head ----------------------------------------------------------------------------------------

static const double most_torque = 0.4;

static void pendulum(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = csin(at->x[0]) + at->u[0];
    out->g[0] = at->x[0] * at->x[0] + at->x[1] * at->x[1] + 0.1 * at->u[0] * at->u[0];
}

static moray_status make_pendulum(void *self, double t, const double *x, void **problem, const moray_ocp **ocp)
{
    planner *p = self;
    moray_ocp *made;
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = pendulum,
                                    .t0 = moray_fixed(t),
                                    .tf = moray_fixed(t + p->horizon),
                                    .x0 = MORAY_BOUNDS(moray_fixed(x[0]), moray_fixed(x[1])),
                                    .u = MORAY_BOUNDS(moray_between(-most_torque, most_torque))};
    MORAY_TRY(moray_ocp_new(&made, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = cost_to_go}));
    *problem = made;
    *ocp = made;
    return moray_ok();
}

// Heavier than planned, and pushed to and fro.
static bool true_pendulum(double t, const double *x, const double *u, double *dx, void *self)
{
    double *most = self;
    dx[0] = x[1];
    dx[1] = sin(x[0]) + 0.9 * u[0] + 0.05 * sin(3 * t);
    *most = fmax(*most, fabs(u[0]));
    return true;
}

// Replanned it stays up, the first plan alone falls; no torque beyond the limit; later solves are the shorter ones.
static void test_pendulum(void)
{
    double angle[2];
    for (int alone = 0; alone < 2; alone++) {
        planner p = {.horizon = 4};
        moray_receding_horizon_spec spec = spec_of(&p, alone ? 4 : 0.2);
        moray_receding_horizon *receding;
        double x[2] = {0.25, 0}, most = 0;
        spec.replanner.make = make_pendulum;
        spec.settings.intervals = 16;
        spec.settings.scheme = "radau3";
        CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
        const moray_controller controller = moray_receding_horizon_controller(receding);
        const moray_closed_loop_spec loop = {.plant = {.nx = 2, .nu = 1, .rates = true_pendulum, .self = &most},
                                             .controller = &controller,
                                             .t1 = 3.9,
                                             .settings = {.rtol = 1e-7, .atol = 1e-7, .max_steps = 100000}};
        CHECK_OK(moray_closed_loop_run(&loop, x), "run");
        angle[alone] = fabs(x[0]);
        CHECK(most <= most_torque * (1 + 1e-6), "torque within its limit: %.6g", most);
        const moray_receding_horizon_record *record = moray_receding_horizon_record_of(receding);
        CHECK(record->failures == 0, "%d of %d plans fail", record->failures, record->plans);
        const moray_replan *replans = moray_receding_horizon_replans(receding);
        if (!alone)
            CHECK(record->iterations - replans[0].iterations < replans[0].iterations * (record->plans - 1),
                  "from the last plan on in %.1f iterations on average, at first in %d",
                  (double)(record->iterations - replans[0].iterations) / (record->plans - 1), replans[0].iterations);
        moray_receding_horizon_free(receding);
    }
    CHECK(angle[0] < 0.06 && angle[1] > 0.5, "replanned %.3g rad, the plan alone %.3g rad", angle[0], angle[1]);
}

// The same from one problem that is stated once: shifted with its multipliers, in fewer iterations, to the same motion.
static void test_one_problem(void)
{
    int iterations[2];
    double end[2][2];
    for (int once = 0; once < 2; once++) {
        planner p = {.horizon = 4};
        moray_receding_horizon_spec spec = spec_of(&p, 0.2);
        moray_receding_horizon *receding;
        double x[2] = {0.25, 0}, most = 0;
        void *problem;
        const moray_ocp *ocp;
        CHECK_OK(make_pendulum(&p, 0, (double[]){0.1, 0.1}, &problem, &ocp), "one problem");
        spec.settings.intervals = 16;
        spec.settings.scheme = "radau3";
        spec.replanner.make = make_pendulum;
        if (once)
            spec.replanner = (moray_replanner){0}, spec.ocp = problem;
        CHECK_OK(moray_receding_horizon_new(&receding, &spec), "receding horizon");
        const moray_controller controller = moray_receding_horizon_controller(receding);
        const moray_closed_loop_spec loop = {.plant = {.nx = 2, .nu = 1, .rates = true_pendulum, .self = &most},
                                             .controller = &controller,
                                             .t1 = 2.9,
                                             .settings = {.rtol = 1e-7, .atol = 1e-7, .max_steps = 100000}};
        CHECK_OK(moray_closed_loop_run(&loop, x), "run");
        const moray_receding_horizon_record *record = moray_receding_horizon_record_of(receding);
        const moray_replan *replans = moray_receding_horizon_replans(receding);
        double t0, tf;
        moray_solution_times(moray_receding_horizon_plan(receding), 0, &t0, &tf);
        CHECK(record->failures == 0 && record->plans == 15 && replans[14].seconds > 0, "%d plans, %d failures",
              record->plans, record->failures);
        CHECK(fabs(t0 - 2.8) < 1e-9 && fabs(tf - 6.8) < 1e-9, "the plan in force goes from %g to %g", t0, tf);
        iterations[once] = record->iterations - replans[0].iterations;
        memcpy(end[once], x, sizeof x);
        moray_receding_horizon_free(receding);
        moray_ocp_free(problem);
    }
    CHECK_NEAR(end[1][0], end[0][0], 1e-5, "angle as with problems made anew");
    CHECK_NEAR(end[1][1], end[0][1], 1e-5, "rate");
    CHECK(iterations[1] < iterations[0], "re-solved in %d iterations, made anew in %d", iterations[1], iterations[0]);
}

static void test_restart_refusals(void)
{
    planner p = {.horizon = 1, .fail_from = 1000};
    moray_receding_horizon_spec spec = spec_of(&p, 0.5);
    void *problem;
    const moray_ocp *ocp;
    const double x[2] = {1, 0}, odd[2] = {1, NAN};
    CHECK_OK(make_mass(&p, 0, x, &problem, &ocp), "a problem");
    spec.ocp = problem;
    refuses(spec, "a problem or a replanner, and only one");
    spec.ocp = NULL, spec.replanner.make = NULL;
    refuses(spec, "a problem or a replanner, and only one");
    CHECK(moray_ocp_restart(problem, 0, 1, odd).code == MORAY_INPUT, "a state that is not a number");
    CHECK(moray_ocp_restart(problem, 0, -1, x).code == MORAY_INPUT, "a negative length");
    CHECK(moray_ocp_restart(problem, 2, 0, x).code == MORAY_INPUT, "a start behind the end");
    CHECK_OK(moray_ocp_restart(problem, 0.5, 0, x), "a start before it");
    moray_ocp_free(problem);
}

int main(void)
{
    test_regulator();
    test_failure();
    test_due();
    test_change();
    test_refusals();
    test_pendulum();
    test_one_problem();
    test_restart_refusals();
    return tap_done();
}
