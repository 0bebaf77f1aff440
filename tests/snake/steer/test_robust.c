// SPDX-License-Identifier: MIT
//
// Gains by collocation over scenarios: an optimum of its own model, simulated apart; and, behind noisy, late
// instruments on the first-principles model, better than where they began. A plan over scenarios: more freedom does no
// worse, on its model and swum by robots that it was not made for.
#include "degree.h"
#include "tap.h"

#include "moray/snake/closed_loop.h"
#include "moray/snake/plant.h"
#include "moray/snake/robust.h"
#include "moray/snake/trial.h"

enum { scenarios = 2, duration = 24 };

static const moray_sensors sensors = {
    .heading = 0.5 * DEG, .joints = 0.2 * DEG, .sampling = 0.2, .delay = 0.1, .seed = 3};
static const moray_actuators actuators = {.dead_time = 0.1};

typedef struct pool {
    moray_robot robot;
    moray_gait gait; // of the control-oriented model
    double scale;
    moray_straight_motion straight;
    moray_reference reference[scenarios];
    moray_scenario scenario[scenarios];
    moray_robust_spec spec;
} pool;

static void pool_new(pool *at)
{
    static const char *const texts[scenarios] = {"sine:30,40", "ramps:4=0,12=32"};
    const double offset = 0.007;
    double rate;
    *at = (pool){.robot = moray_robot_paper()};
    at->gait = moray_gait_paper(&at->robot);
    moray_gait mapped = moray_gait_map(&at->robot, &at->gait, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    at->scale = -mapped.amplitude / at->gait.amplitude; // erratum E3
    CHECK_OK(moray_straight_motion_find(&at->straight, &at->robot, MORAY_FIRST_PRINCIPLES, &mapped), "straight");
    mapped.offset = offset * at->scale;
    CHECK_OK(moray_turn_rate(&at->robot, MORAY_FIRST_PRINCIPLES, &mapped, &rate), "turning");
    for (int k = 0; k < scenarios; k++) {
        CHECK_OK(moray_reference_read(&at->reference[k], texts[k]), "reference");
        at->scenario[k] =
            (moray_scenario){.speed = at->straight.speed, .turn = rate / offset, .reference = &at->reference[k]};
        CHECK_OK(moray_belief_find(&at->scenario[k].belief, &at->robot, &at->gait, at->straight.speed, offset, rate),
                 "belief");
    }
    at->spec = (moray_robust_spec){.robot = at->robot,
                                   .gait = at->gait,
                                   .offset = 0.015,
                                   .offset_rate = 0.01,
                                   .lag = 0.4,
                                   .noise = 0.6 * DEG,
                                   .sampling = sensors.sampling,
                                   .scenario = at->scenario,
                                   .n = scenarios,
                                   .duration = duration,
                                   .start = {.proportional = 0.05, .forward = 0.05},
                                   .settings = moray_settings_default()};
    at->spec.settings.scheme = "radau3";
    at->spec.settings.intervals = 96;
    at->spec.settings.tolerance = 1e-7;
}

// What collocation minimises, of the swimmer.
static bool swum(void *self, const double *x, double *cost)
{
    const pool *at = self;
    *cost = 0;
    for (int k = 0; k < scenarios; k++) {
        moray_feedback feedback = {.target = moray_heading_law_target,
                                   .feed = moray_heading_law_feed,
                                   .gain = at->scale * x[0],
                                   .straight = &at->straight,
                                   .offset = 0.015 * fabs(at->scale),
                                   .offset_rate = 0.01 * fabs(at->scale),
                                   .period = 0.1};
        moray_heading_law law = {.gains = {.proportional = x[0], .forward = x[1], .integral = x[2]},
                                 .reference = &at->reference[k],
                                 .feedback = &feedback,
                                 .scale = at->scale,
                                 .smoothing = 0.5};
        feedback.self = &law;
        const moray_swim_controller inner = moray_feedback_controller(&feedback);
        moray_instruments *instruments;
        moray_swim_closed_loop closed_loop;
        if (moray_failed(moray_instruments_new(&instruments, &sensors, &actuators, &at->straight, 10, &inner)))
            return false;
        const moray_swim_controller outer = moray_instruments_controller(instruments);
        const moray_swim_on_gait how = {.steps = 16};
        const moray_swim_closed_loop_spec spec = {.robot = &at->robot,
                                                  .straight = &at->straight,
                                                  .controller = &outer,
                                                  .duration = duration,
                                                  .intervals = 10 * duration,
                                                  .on_gait = &how};
        const moray_status status = moray_swim_closed_loop_run(&closed_loop, &spec);
        moray_instruments_free(instruments);
        if (moray_failed(status))
            return false;
        const double rms =
            moray_swim_closed_loop_heading_score(&closed_loop, &at->straight, &at->reference[k]).rms / (10 * DEG);
        *cost += rms * rms / scenarios;
        moray_swim_closed_loop_free(&closed_loop);
    }
    return true;
}

// ---- The same model, simulated -------------------------------------------------------------------------------------

enum { THETA, V_THETA, V_T, V_N, PHI_0, SUM, SQUARES, states };

// The robot of a scenario under an offset that is wanted; what it is off its reference counts.
static void respond(const moray_robust_spec *spec, int k, moray_map *plant, double wanted, double t, const double *x,
                    double *dx)
{
    const moray_scenario *own = &spec->scenario[k];
    double r, out[MORAY_STEERING_STATES + 1];
    const double error = moray_reference_at(own->reference, t, &r) - x[THETA], share = tanh(wanted / spec->offset);
    const double v = spec->offset_rate * tanh((share * spec->offset - x[PHI_0]) / spec->lag / spec->offset_rate);
    const double in[] = {x[THETA],
                         0,
                         0,
                         x[V_THETA],
                         x[V_T],
                         x[V_N],
                         own->belief.turning * x[PHI_0],
                         own->belief.turning * v,
                         0,
                         own->belief.amplitude * spec->gait.amplitude,
                         spec->gait.omega,
                         spec->gait.delta,
                         t};
    plant->value(plant->self, in, out);
    dx[THETA] = out[MORAY_STATE_THETA];
    dx[V_THETA] = out[MORAY_STATE_V_THETA];
    dx[V_T] = out[MORAY_STATE_V_1];
    dx[V_N] = out[MORAY_STATE_V_2];
    dx[PHI_0] = v;
    dx[SUM] = error * (1 - share * share);
    dx[SQUARES] = error * error / (100 * DEG * DEG);
}

static void rates(const pool *at, moray_map *plant, int k, const double g[3], double t, const double *x, double *dx)
{
    double r;
    const double error = moray_reference_at(at->scenario[k].reference, t, &r) - x[THETA];
    respond(&at->spec, k, plant, g[0] * (error + g[2] * x[SUM]) + g[1] * r, t, x, dx);
}

static double cost_of_noise(const moray_robust_spec *spec, int k, double gain)
{
    return spec->noise * spec->noise * spec->sampling / 2 * gain * fabs(spec->scenario[k].turn) / (100 * DEG * DEG);
}

// The objective at these gains, by the midpoint rule on short steps.
static double modelled(const pool *at, const double g[3])
{
    const moray_plant_spec plant_spec = {.robot = at->robot, .joints = MORAY_JOINTS_STEERED};
    const moray_robust_spec *spec = &at->spec;
    const int steps = 4000;
    const double h = (double)duration / steps;
    moray_map plant;
    double sum = 0;
    CHECK_OK(moray_average_plant(&plant, &plant_spec), "averaged plant");
    for (int k = 0; k < scenarios; k++) {
        double x[states] = {[V_T] = at->scenario[k].speed}, dx[states], middle[states];
        for (int i = 0; i < steps; i++) {
            rates(at, &plant, k, g, i * h, x, dx);
            for (int j = 0; j < states; j++)
                middle[j] = x[j] + h / 2 * dx[j];
            rates(at, &plant, k, g, (i + 0.5) * h, middle, dx);
            for (int j = 0; j < states; j++)
                x[j] += h * dx[j];
        }
        sum += (x[SQUARES] / duration + cost_of_noise(spec, k, g[0])) / scenarios;
    }
    moray_map_release(&plant);
    return sum;
}

static void test_optimum(const pool *at, const double gains[3], double objective)
{
    const double least = modelled(at, gains);
    CHECK_NEAR(least, objective, 2e-3 * objective, "what it minimises, simulated");
    for (int k = 0; k < 2; k++)
        for (int side = -1; side <= 1; side += 2) {
            double beside[3] = {gains[0], gains[1], gains[2]};
            beside[k] *= 1 + 0.1 * side;
            const double other = modelled(at, beside);
            CHECK(other > least, "gain %d a tenth %s is worse: %.6g", k, side < 0 ? "smaller" : "larger", other);
        }
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

enum { PLANNED = 2 };

// A step for robots that swim and turn more, or less, than the one there is.
static void spread_out(const pool *at, moray_scenario scenario[PLANNED], const moray_reference *reference)
{
    for (int k = 0; k < PLANNED; k++) {
        scenario[k] = at->scenario[0];
        scenario[k].reference = reference;
        scenario[k].belief.turning *= k ? 1.25 : 0.8;
        scenario[k].turn *= k ? 1.25 : 0.8;
    }
}

typedef struct fleet {
    double x[PLANNED][states], heading; // which is the mean of theirs
} fleet;

static void fleet_rates(const moray_robust_spec *spec, moray_map *plant, const moray_robust_plan *plan, double t,
                        const fleet *at, fleet *d)
{
    d->heading = 0;
    for (int k = 0; k < spec->n; k++) {
        respond(spec, k, plant, moray_robust_plan_wanted(plan, t) + plan->gain * (at->heading - at->x[k][THETA]), t,
                at->x[k], d->x[k]);
        d->heading += d->x[k][THETA] / spec->n;
    }
}

static void go_on(fleet *at, const fleet *from, double h, const fleet *d)
{
    for (int k = 0; k < PLANNED; k++)
        for (int i = 0; i < states; i++)
            at->x[k][i] = from->x[k][i] + h * d->x[k][i];
    at->heading = from->heading + h * d->heading;
}

// The plan's robots, all at once, by the midpoint rule: they turn as it says, at the cost that it tells.
static void test_planned(const moray_robust_spec *spec, const moray_robust_plan *plan, double objective)
{
    const moray_plant_spec plant_spec = {.robot = spec->robot, .joints = MORAY_JOINTS_STEERED};
    const int steps = 16 * (plan->n - 1);
    const double h = (double)duration / steps;
    moray_map plant;
    fleet at = {0}, middle = {0}, d = {0};
    double worst = 0, cost = 0;
    CHECK_OK(moray_average_plant(&plant, &plant_spec), "averaged plant");
    CHECK(plan->duration == duration && plan->n == 10 * duration + 1, "ten points a second: %d", plan->n);
    CHECK(plan->point[0].wanted == 0, "from no offset");
    for (int k = 0; k < spec->n; k++)
        at.x[k][V_T] = spec->scenario[k].speed;
    for (int i = 0; i < steps; i++) {
        fleet_rates(spec, &plant, plan, i * h, &at, &d);
        go_on(&middle, &at, h / 2, &d);
        fleet_rates(spec, &plant, plan, (i + 0.5) * h, &middle, &d);
        go_on(&at, &at, h, &d);
        worst = tap_worse(worst, fabs(at.heading - moray_robust_plan_heading(plan, (i + 1) * h)));
    }
    for (int i = 0; i + 1 < plan->n; i++)
        cost += pow((plan->point[i + 1].wanted - plan->point[i].wanted) * 10 / spec->offset_rate, 2) / 10;
    cost *= spec->weight_steering / duration;
    for (int k = 0; k < spec->n; k++)
        cost += (at.x[k][SQUARES] / duration + cost_of_noise(spec, k, plan->gain)) / spec->n;
    CHECK(worst < 0.15 * DEG, "%d robots: their mean heading is the plan's to %.2g deg", spec->n, worst / DEG);
    CHECK_NEAR(cost, objective, 2e-3 * objective, "what it minimises, simulated");
    moray_map_release(&plant);
}

static void test_between(const moray_robust_plan *plan)
{
    const moray_robust_point *p = plan->point, *end = p + plan->n - 1;
    for (int i = 0; i + 1 < plan->n; i += 37) {
        const double t = (i + 0.25) / 10;
        CHECK_NEAR(moray_robust_plan_wanted(plan, t), 0.75 * p[i].wanted + 0.25 * p[i + 1].wanted, 1e-12,
                   "a quarter on");
        CHECK_NEAR(moray_robust_plan_heading(plan, t), 0.75 * p[i].heading + 0.25 * p[i + 1].heading, 1e-12, "of both");
    }
    CHECK_NEAR(moray_robust_plan_heading(plan, 2 * duration), end->heading, 1e-15, "held beyond the end");
    CHECK_NEAR(moray_robust_plan_wanted(plan, 2 * duration), end->wanted, 1e-15, "with what is wanted");
    CHECK(moray_robust_plan_heading(plan, -1) == p->heading && moray_robust_plan_wanted(plan, -1) == p->wanted,
          "and before the beginning");
}

typedef struct carried {
    const moray_robust_plan *plan;
    double scale;
} carried;

static double planned_heading(const moray_swim_sample *sample, void *self)
{
    return moray_robust_plan_heading(((const carried *)self)->plan, sample->t);
}

static double planned_offset(const moray_swim_sample *sample, double t, void *self)
{
    const carried *c = self;
    (void)sample;
    return c->scale * moray_robust_plan_wanted(c->plan, t);
}

static double follow(const pool *at, const moray_robust_plan *plan, const moray_reference *reference)
{
    carried c = {plan, at->scale};
    moray_feedback feedback = {.target = planned_heading,
                               .feed = planned_offset,
                               .self = &c,
                               .gain = at->scale * plan->gain,
                               .straight = &at->straight,
                               .offset = 0.015 * fabs(at->scale),
                               .offset_rate = 0.01 * fabs(at->scale),
                               .period = 0.1};
    const moray_swim_controller controller = moray_feedback_controller(&feedback);
    const moray_swim_on_gait how = {.steps = 16};
    moray_swim_closed_loop closed_loop;
    const moray_swim_closed_loop_spec spec = {.robot = &at->robot,
                                              .straight = &at->straight,
                                              .controller = &controller,
                                              .duration = duration,
                                              .intervals = 10 * duration,
                                              .on_gait = &how};
    CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &spec), "swum");
    const double rms = moray_swim_closed_loop_heading_score(&closed_loop, &at->straight, reference).rms;
    moray_swim_closed_loop_free(&closed_loop);
    return rms;
}

static void test_plan(pool *at)
{
    moray_scenario scenario[PLANNED];
    moray_reference reference;
    moray_robust_plan one, blind, plan;
    double alone, without, with;
    moray_robust_spec spec = at->spec;
    CHECK_OK(moray_reference_read(&reference, "steps:8=30"), "reference");
    spread_out(at, scenario, &reference);
    spec.scenario = scenario;
    spec.weight_steering = 1e-3;
    spec.settings.intervals = (tap_thorough() ? 4 : 1) * duration;
    spec.settings.tolerance = 1e-6;
    spec.n = 1;
    CHECK_OK(moray_robust_plan_make(&one, &alone, &spec, true), "for one robot");
    spec.n = PLANNED;
    CHECK_OK(moray_robust_plan_make(&blind, &without, &spec, true), "for both");
    CHECK_OK(moray_robust_plan_make(&plan, &with, &spec, false), "for both, with feedback");
    CHECK(blind.gain == 0 && plan.gain > 0, "which has a gain of %.3g m/rad", plan.gain);
    CHECK(with < without, "and does better than without: %.4g, %.4g", with, without);
    const double swum_one = follow(at, &one, &reference), swum = follow(at, &plan, &reference);
    printf("# objectives %g, %g, %g; swum %g deg with, %g deg by the plan for one\n", alone, without, with, swum / DEG,
           swum_one / DEG);
    CHECK(swum < 0.7 * swum_one, "by a robot in between, %.3g deg off, not %.3g deg", swum / DEG, swum_one / DEG);
    if (tap_thorough()) {
        test_planned(&spec, &blind, without);
        test_planned(&spec, &plan, with);
    }
    test_between(&plan);
    spec.weight_steering = 0;
    moray_robust_plan none;
    CHECK(moray_robust_plan_make(&none, &with, &spec, true).code == MORAY_INPUT, "steering has to count");
    moray_robust_plan_free(&one);
    moray_robust_plan_free(&blind);
    moray_robust_plan_free(&plan);
    moray_robust_plan_free(&none);
    moray_reference_free(&reference);
}

int main(void)
{
    pool at;
    moray_heading_gains found;
    double objective, cost, start;
    pool_new(&at);
    if (!tap_thorough()) {
        at.spec.n = 1;
        at.spec.settings.intervals = 24;
    }
    CHECK_OK(moray_robust_gains(&found, &objective, &at.spec), "gains");
    const double gains[3] = {found.proportional, found.forward, found.integral};
    const double began[3] = {at.spec.start.proportional, at.spec.start.forward, 0};
    if (tap_thorough())
        test_optimum(&at, gains, objective);
    swum(&at, gains, &cost);
    swum(&at, began, &start);
    printf("# gains %g m/rad, %g m s/rad, %g 1/s: swum %g deg, at the start %g deg\n", gains[0], gains[1], gains[2],
           10 * sqrt(cost), 10 * sqrt(start));
    CHECK(cost < 0.25 * start, "swum, half the error from where it began");
    test_plan(&at);
    at.spec.n = 0;
    CHECK(moray_robust_gains(&found, &objective, &at.spec).code == MORAY_INPUT, "no scenarios are refused");
    for (int k = 0; k < scenarios; k++)
        moray_reference_free(&at.reference[k]);
    return tap_done();
}
