// SPDX-License-Identifier: MIT
//
// Plans along a reference against a simulation of the whole swimmer under the offset found, which shares with them the
// model alone.
#include "degree.h"
#include "reference_text.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/trial.h"
#include "moray/snake/heading.h"
#include "moray/snake/closed_loop.h"
#include "snake/steer/problems.h"

enum { HORIZON = 12 };
static const double unit = 10 * DEG;

static moray_heading_spec spec_of(moray_model model, const moray_reference *reference)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&robot);
    moray_steering_limits limits = {.theta_max = moray_between(1 * DEG, 20 * DEG),
                                    .omega = moray_between(60 * DEG, 240 * DEG),
                                    .delta = moray_between(20 * DEG, 80 * DEG),
                                    .offset = 0.015,
                                    .offset_rate = 0.01,
                                    .offset_acceleration = MORAY_INFINITY,
                                    .power = 0.4};
    return (moray_heading_spec){.robot = robot,
                                .model = model,
                                .current = {0.1, 0.05},
                                .limits =
                                    moray_steering_limits_map(&robot, &limits, &paper, MORAY_CONTROL_ORIENTED, model),
                                .weight = {.heading = 1 / (unit * unit), .power = 0.3, .steering = 0.01},
                                .reference = reference,
                                .max_error = MORAY_INFINITY,
                                .t1 = HORIZON};
}

static moray_settings settings_of(int intervals)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = "radau5";
    settings.intervals = intervals;
    settings.barrier = 1e-2;
    settings.max_refinements = 3;
    settings.mesh_tolerance = 1e-7;
    return settings;
}

static moray_gait paper_gait(moray_model model)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&robot);
    return moray_gait_map(&robot, &paper, MORAY_CONTROL_ORIENTED, model);
}

static bool moray_is_solved(const moray_steering_plan *plan)
{
    return plan->solution && moray_solution_info(plan->solution)->outcome == MORAY_NLP_SOLVED;
}

// Mean of (phi_0'' / limit)^2, by the midpoint rule.
static double steering_effort(const moray_steering_plan *plan, double limit)
{
    enum { n = 200000 };
    double sum = 0;
    for (int k = 0; k < n; k++) {
        const double a = moray_steering_offset(plan->solution, HORIZON * (k + 0.5) / n).acceleration / limit;
        sum += a * a / n;
    }
    return sum;
}

// The objective of the plan is that of the swimmer, all joints controlled by (34), who steers by it.
static void test_objective(const moray_steering_plan *plan, const moray_heading_spec *spec)
{
    moray_plan steer = {plan->solution, 1};
    const moray_swim_controller controller = moray_plan_controller(&steer);
    moray_swim_closed_loop closed_loop;
    const moray_swim_closed_loop_spec how = {.robot = &spec->robot,
                                             .straight = &plan->straight,
                                             .current = {spec->current[0], spec->current[1]},
                                             .controller = &controller,
                                             .duration = HORIZON,
                                             .intervals = 2400,
                                             .tolerance = 1e-9};
    CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &how), "closed_loop");
    const moray_heading_score score =
        moray_swim_closed_loop_heading_score(&closed_loop, &plan->straight, spec->reference);
    const double swum = spec->weight.heading * score.rms * score.rms + spec->weight.power * score.power +
                        spec->weight.steering * steering_effort(plan, spec->limits.offset);
    const double predicted = moray_solution_objective(plan->solution);
    CHECK_NEAR(predicted / swum, 1, 2e-6, "objective predicted, of that swum");
    CHECK(score.rms > 1 * DEG && score.rms < 10 * DEG, "RMS error %g deg", score.rms / DEG);
    moray_swim_closed_loop_free(&closed_loop);
}

static void test_plan(moray_model model, const moray_reference *reference, const moray_steering_plan *from)
{
    const moray_heading_spec spec = spec_of(model, reference);
    const moray_settings settings = settings_of(24);
    const moray_gait gait = paper_gait(model);
    moray_steering_plan plan, again;
    CHECK_OK(moray_heading_plan_make(&plan, &spec, &settings, &gait, NULL), "plan from the reference");
    CHECK_OK(moray_heading_plan_make(&again, &spec, &settings, &gait, from), "from another plan");
    CHECK(moray_is_solved(&plan) && moray_is_solved(&again), "both are solved");
    CHECK_RELATIVE(moray_solution_objective(again.solution), moray_solution_objective(plan.solution), 1e-6,
                   "and are one");
    for (int k = 0; k <= 100; k++) {
        const moray_offset offset = moray_steering_offset(plan.solution, HORIZON * k / 100.0);
        if (fabs(offset.value) > spec.limits.offset * (1 + 1e-6) ||
            fabs(offset.rate) > spec.limits.offset_rate * (1 + 1e-3))
            CHECK(false, "t = %g s: offset %g, rate %g", HORIZON * k / 100.0, offset.value, offset.rate);
    }
    test_objective(&plan, &spec);
    moray_steering_plan_free(&again);
    moray_steering_plan_free(&plan);
}

// On the averaged plant the gait is free, and comes to the limit of the power.
static void test_averaged(moray_steering_plan *averaged, const moray_reference *reference)
{
    moray_heading_spec spec = spec_of(MORAY_CONTROL_ORIENTED, reference);
    const moray_settings settings = settings_of(12);
    const moray_gait gait = paper_gait(MORAY_CONTROL_ORIENTED);
    spec.averaged = true;
    spec.weight.power = 0;
    CHECK_OK(moray_heading_plan_make(averaged, &spec, &settings, &gait, NULL), "averaged plan");
    CHECK(moray_is_solved(averaged), "is solved");
    const double work = moray_steering_work(averaged->problem.steering, averaged->solution);
    CHECK(work / HORIZON < 0.4 * (1 + 1e-6), "within the power: %g W", work / HORIZON);
    CHECK(averaged->straight.gait.amplitude > 0.03, "amplitude found %g m", averaged->straight.gait.amplitude);
}

// Without an iteration a plan is its guess: along the reference at the speed of the straight, carried by the current.
static void test_guess(const moray_reference *reference)
{
    const moray_heading_spec spec = spec_of(MORAY_CONTROL_ORIENTED, reference);
    const moray_gait gait = paper_gait(MORAY_CONTROL_ORIENTED);
    moray_settings settings = settings_of(24);
    moray_steering_plan plan;
    double x[MORAY_STEERING_STATES], rate, way[2] = {0, 0};
    settings.max_iterations = settings.max_refinements = 0;
    CHECK_OK(moray_heading_plan_make(&plan, &spec, &settings, &gait, NULL), "a guess");
    enum { n = 1200 };
    for (int k = 0; k < n; k++) {
        const double heading = moray_reference_at(reference, HORIZON * (k + 0.5) / n, &rate);
        way[0] += (plan.straight.speed * cos(heading) + spec.current[0]) * HORIZON / n;
        way[1] += (plan.straight.speed * sin(heading) + spec.current[1]) * HORIZON / n;
    }
    moray_solution_at(plan.solution, 0, HORIZON, x, NULL);
    const double sample = plan.straight.speed * HORIZON / (16 * 24); // the jump may come a sample late
    CHECK_NEAR(x[MORAY_STATE_P_X], way[0], sample, "its way along x");
    CHECK_NEAR(x[MORAY_STATE_P_Y], way[1], sample, "its way along y");
    moray_steering_plan_free(&plan);
}

static void test_limits(const moray_reference *reference)
{
    moray_heading_spec spec = spec_of(MORAY_CONTROL_ORIENTED, reference);
    moray_steering_problem problem;
    moray_status status;
    spec.t1 = 0;
    status = moray_heading_new(&problem, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "horizon"), "%s", status.text);
    spec.t1 = HORIZON;
    spec.max_error = 0;
    status = moray_heading_new(&problem, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "largest heading error"), "%s", status.text);
    spec.max_error = MORAY_INFINITY;
    spec.limits.offset = MORAY_INFINITY;
    status = moray_heading_new(&problem, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "offset"), "%s", status.text);
}

// A tube that the step leaves room for is kept; the error is largest at the step.
static void test_tube(const moray_reference *reference)
{
    moray_heading_spec spec = spec_of(MORAY_CONTROL_ORIENTED, reference);
    const moray_settings settings = settings_of(24);
    const moray_gait gait = paper_gait(MORAY_CONTROL_ORIENTED);
    moray_steering_plan plan;
    spec.max_error = 12 * DEG; // of 20: either side of the jump has to be within it
    CHECK_OK(moray_heading_plan_make(&plan, &spec, &settings, &gait, NULL), "plan in a tube");
    CHECK(moray_is_solved(&plan), "is solved");
    double largest = 0, rate, x[MORAY_STEERING_STATES], u[1];
    for (int k = 0; k <= 2400; k++) {
        const double t = HORIZON * k / 2400.0;
        moray_solution_at(plan.solution, 0, t, x, u);
        const double error =
            moray_straight_motion_heading(&plan.straight, t, x[0]) - moray_reference_at(reference, t, &rate);
        largest = fmax(largest, fabs(error));
    }
    CHECK(largest < 12.05 * DEG && largest > 9.9 * DEG, "largest error %g deg", largest / DEG);
    moray_steering_plan_free(&plan);
}

// Three links that turn to a heading they are off: the largest rate of a joint over a stroke, alpha omega + |phi_0'|,
// and the largest share of what the motors give.
static void steer_with(const moray_motor *motor, double rate, double *fastest, double *load)
{
    moray_reference ahead = read_ok("steps:0=15");
    moray_heading_spec spec = spec_of(MORAY_FIRST_PRINCIPLES, &ahead);
    const moray_settings settings = settings_of(10);
    moray_steering_plan plan;
    moray_swimmer *swimmer;
    double t0, t1, x[MORAY_STEERING_STATES], u[1], full[10], dx[10], phi[6], torque[2];
    spec.robot.links = 3;
    spec.t1 = 4;
    spec.robot.motor = *motor;
    spec.robot.supply.rate = rate;
    const moray_gait gait = {.amplitude = 20 * DEG, .omega = 120 * DEG, .delta = 60 * DEG};
    CHECK_OK(moray_heading_plan_make(&plan, &spec, &settings, &gait, NULL), "plan");
    CHECK(moray_is_solved(&plan), "solved: %s", moray_solution_failure(plan.solution).text);
    CHECK_OK(moray_swimmer_new(&swimmer, &spec.robot, spec.model), "swimmer");
    moray_swimmer_set_current(swimmer, spec.current[0], spec.current[1]);
    moray_solution_times(plan.solution, 0, &t0, &t1);
    *fastest = *load = 0;
    for (int k = 0; k <= 400; k++) {
        const double t = t0 + (t1 - t0) * k / 400;
        moray_gait now = gait;
        moray_solution_at(plan.solution, 0, t, x, u);
        now.offset = x[MORAY_STATE_PHI_0], now.offset_rate = x[MORAY_STATE_V_PHI_0], now.offset_acceleration = u[0];
        moray_gait_reference(&now, 2, t, phi, phi + 2, phi + 4);
        moray_swimmer_on_gait(swimmer, &now, t, x, full);
        moray_swimmer_rates(swimmer, full, phi + 4, dx, torque);
        *fastest = fmax(*fastest, gait.amplitude * gait.omega + fabs(x[MORAY_STATE_V_PHI_0]));
        for (int i = 0; i < 2; i++)
            *load = fmax(*load, moray_motor_load(motor, torque[i], phi[2 + i]));
    }
    moray_swimmer_free(swimmer);
    moray_steering_plan_free(&plan);
    moray_reference_free(&ahead);
}

// What motors give and how fast they turn limits the plan where it would be more.
static void test_motors(void)
{
    moray_motor motor = {.fitted = true, .forward = 1, .backward = 1, .smooth_rate = 1, .smooth_power = 1, .lines = 1};
    double fastest, load, less, least;
    motor.torque[0] = 10, motor.slope[0] = 0.01;
    steer_with(&motor, INFINITY, &fastest, &load);
    const double rate = 20 * DEG * 120 * DEG;
    CHECK(load < 1 && fastest > rate + 0.5 * DEG, "unlimited: %g deg/s, %g of 10 N m", fastest / DEG, load);
    const double allowed = (rate + fastest) / 2;
    steer_with(&motor, allowed, &less, &least);
    CHECK_NEAR(less / allowed, 1, 1e-3, "as fast as the motors turn");
    motor.torque[0] *= 0.9 * load;
    steer_with(&motor, INFINITY, &fastest, &least);
    CHECK_NEAR(least, 1, 5e-3, "all that the motors give");
}

int main(void)
{
    moray_reference step = read_ok("steps:6=20");
    moray_steering_plan averaged;
    test_averaged(&averaged, &step);
    test_plan(MORAY_CONTROL_ORIENTED, &step, &averaged);
    test_plan(MORAY_FIRST_PRINCIPLES, &step, &averaged);
    test_guess(&step);
    test_limits(&step);
    test_motors();
    test_tube(&step);
    moray_steering_plan_free(&averaged);
    moray_reference_free(&step);
    return tap_done();
}
