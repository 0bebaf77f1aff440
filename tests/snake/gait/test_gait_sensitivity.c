// SPDX-License-Identifier: MIT
//
// How the fastest gait moves with robot, current and limits: slopes beside solving again, the change of the active set
// where it is foretold, the prediction's error falling with the square of the step.
#include "degree.h"
#include "tap.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "moray/snake/gait_problem.h"
#include "moray/snake/orbit.h"

// In a current across the course, so that every part of the gait moves.
static moray_gait_problem_spec spec_of(moray_model model)
{
    const bool control = model == MORAY_CONTROL_ORIENTED;
    const double offset = control ? 0.02 : 10 * DEG;
    return (moray_gait_problem_spec){.robot = moray_robot_paper(),
                                     .model = model,
                                     .current = {0.05, 0.08},
                                     .course = 20 * DEG,
                                     .limits = {.theta_max = moray_between(1 * DEG, 20 * DEG),
                                                .omega = moray_between(30 * DEG, 360 * DEG),
                                                .delta = moray_between(15 * DEG, 90 * DEG),
                                                .offset = moray_between(-offset, offset),
                                                .power = control ? 0.3972 : 0.2646,
                                                .joint_rate = MORAY_INFINITY,
                                                .joint_effort = MORAY_INFINITY}};
}

struct optimum {
    moray_gait_problem *problem;
    moray_solution *solution;
    moray_gait_prediction prediction;
};

// From the orbit of a gait near the optimum, or from another optimum.
static moray_status solve(const moray_gait_problem_spec *spec, const struct optimum *from, struct optimum *optimum)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = "lobatto5", settings.intervals = 12, settings.barrier = 1e-4, settings.tolerance = 1e-10;
    if (from) {
        const moray_guess guess = moray_guess_from_solution(from->solution);
        return moray_solve(moray_gait_problem_ocp(optimum->problem), &settings, &guess, &optimum->solution);
    }
    const bool control = spec->model == MORAY_CONTROL_ORIENTED;
    moray_gait gait = {.omega = (control ? 104 : 153) * DEG, .delta = (control ? 35 : 51) * DEG};
    gait.amplitude = moray_amplitude_from_theta_max(&spec->robot, spec->model, 20 * DEG, gait.delta);
    moray_orbit_spec about = moray_orbit_spec_default(&spec->robot, spec->model);
    memcpy(about.current, spec->current, sizeof about.current);
    about.course = spec->course;
    moray_orbit *orbit = NULL;
    moray_orbit_result found;
    moray_swim_track track = {0};
    moray_status status = moray_orbit_new(&orbit, &about);
    if (!moray_failed(status))
        status = moray_orbit_solve(orbit, &gait, &found);
    if (!moray_failed(status))
        status = moray_orbit_track(orbit, 61, &track);
    if (!moray_failed(status))
        status = moray_gait_problem_solve(optimum->problem, &settings, &found.gait, &track, &optimum->solution);
    moray_swim_track_free(&track);
    moray_orbit_free(orbit);
    return status;
}

static struct optimum optimum_of(const moray_gait_problem_spec *spec, const struct optimum *from)
{
    struct optimum optimum = {0};
    moray_status status = moray_gait_problem_new(&optimum.problem, spec);
    if (!moray_failed(status))
        status = solve(spec, from, &optimum);
    if (moray_failed(status) || moray_solution_info(optimum.solution)->outcome != MORAY_NLP_SOLVED) {
        CHECK(false, "no optimum: %s", status.text);
        exit(1);
    }
    optimum.prediction = moray_gait_problem_prediction(optimum.problem, optimum.solution);
    return optimum;
}

static void optimum_free(struct optimum *optimum)
{
    moray_solution_free(optimum->solution);
    moray_gait_problem_free(optimum->problem);
}

// ---- Slopes --------------------------------------------------------------------------------------------------------

static const struct parameter {
    const char *name;
    size_t place; // in the spec
    double scale;
} parameters[] = {{"current", offsetof(moray_gait_problem_spec, current[1]), 0.2},
                  {"course", offsetof(moray_gait_problem_spec, course), 0.5},
                  {"c_n", offsetof(moray_gait_problem_spec, robot.c_n), 8.4},
                  {"l", offsetof(moray_gait_problem_spec, robot.l), 0.07},
                  {"power", offsetof(moray_gait_problem_spec, limits.power), 0.3},
                  {"theta_max", offsetof(moray_gait_problem_spec, limits.theta_max.upper), 0.35}};

static moray_gait_problem_spec moved(const moray_gait_problem_spec *spec, const struct parameter *p, double step)
{
    moray_gait_problem_spec next = *spec;
    *(double *)((char *)&next + p->place) += step;
    return next;
}

static void take(moray_sensitivity *s, const moray_gait_problem_spec *spec, const struct parameter *p)
{
    const double h = 1e-3 * p->scale;
    moray_gait_problem *problem[4];
    const moray_ocp *ocp[4];
    for (int k = 0; k < 4; k++) {
        const moray_gait_problem_spec next = moved(spec, p, (k < 2 ? k - 2 : k - 1) * h);
        CHECK_OK(moray_gait_problem_new(&problem[k], &next), p->name);
        ocp[k] = moray_gait_problem_ocp(problem[k]);
    }
    CHECK_OK(moray_sensitivity_by(s, ocp, h), p->name);
    for (int k = 0; k < 4; k++)
        moray_gait_problem_free(problem[k]);
}

// By solving again: differences of the predicts, good to the square of the step.
static void check_slope(const struct optimum *base, const moray_gait_problem_spec *spec, const struct parameter *p,
                        const moray_gait_slope *slope)
{
    const double h = 5e-4 * p->scale;
    const moray_gait_problem_spec below = moved(spec, p, -h), above = moved(spec, p, h);
    struct optimum one = optimum_of(&below, base), other = optimum_of(&above, base);
    double a[MORAY_GAIT_PARAMETERS], b[MORAY_GAIT_PARAMETERS], s[MORAY_GAIT_PARAMETERS], now[MORAY_GAIT_PARAMETERS];
    moray_gait_to_parameters(&one.prediction.gait, a);
    moray_gait_to_parameters(&other.prediction.gait, b);
    moray_gait_to_parameters(&slope->gait, s);
    moray_gait_to_parameters(&base->prediction.gait, now);
    const double speed = (other.prediction.course_speed - one.prediction.course_speed) / (2 * h);
    const double power = (other.prediction.power - one.prediction.power) / (2 * h);
    CHECK(fabs(slope->course_speed - speed) * p->scale < 1e-6, "d speed / d %s: %.8g, solved again %.8g", p->name,
          slope->course_speed, speed);
    CHECK(fabs(slope->power - power) * p->scale < 1e-6, "d power / d %s: %.8g, solved again %.8g", p->name,
          slope->power, power);
    for (int i = 0; i < MORAY_GAIT_PARAMETERS; i++) {
        const double size = i == 3 ? now[0] : fmax(fabs(now[i]), 1e-3); // phi_0 beside the amplitude
        CHECK(fabs(s[i] - (b[i] - a[i]) / (2 * h)) * p->scale < 2e-5 * size,
              "d gait[%d] / d %s: %.8g, solved again %.8g", i, p->name, s[i], (b[i] - a[i]) / (2 * h));
    }
    optimum_free(&one);
    optimum_free(&other);
}

static void test_slopes(moray_model model)
{
    const moray_gait_problem_spec spec = spec_of(model);
    struct optimum base = optimum_of(&spec, NULL);
    moray_sensitivity *s;
    CHECK_OK(moray_sensitivity_new(&s, base.solution), "sensitivities");
    for (unsigned k = 0; k < sizeof parameters / sizeof *parameters; k++) {
        take(s, &spec, &parameters[k]);
        const moray_gait_slope slope = moray_gait_problem_slope(base.problem, base.solution, s);
        check_slope(&base, &spec, &parameters[k], &slope);
        CHECK_NEAR(moray_sensitivity_objective(s), -slope.course_speed, 1e-9, "the goal moves with the speed");
        if (strcmp(parameters[k].name, "power") == 0)
            CHECK_NEAR(slope.course_speed, base.prediction.power_price, 1e-7, "the price of power is its multiplier");
    }
    moray_sensitivity_free(s);
    optimum_free(&base);
}

// ---- How far they hold ---------------------------------------------------------------------------------------------

// With more power delta rises to a limit that stands a little above it.
static void test_change(void)
{
    const struct parameter *power = &parameters[4];
    moray_gait_problem_spec spec = spec_of(MORAY_FIRST_PRINCIPLES);
    struct optimum base = optimum_of(&spec, NULL);
    const double bound = base.prediction.gait.delta + 0.01 * DEG;
    spec.limits.delta.upper = bound;
    struct optimum near = optimum_of(&spec, &base);
    moray_sensitivity *s;
    CHECK_OK(moray_sensitivity_new(&s, near.solution), "sensitivities");
    take(s, &spec, power);
    const moray_active_change change = moray_sensitivity_change(s, 1);
    CHECK(strcmp(change.what, "parameter delta would pass its upper bound") == 0 && change.step > 0, "at %g W more, %s",
          change.step, change.what);
    const moray_gait_problem_spec less = moved(&spec, power, 0.9 * change.step),
                                  more = moved(&spec, power, 2 * change.step);
    struct optimum below = optimum_of(&less, &near), above = optimum_of(&more, &near);
    CHECK(below.prediction.gait.delta < bound - 1e-4 * DEG, "before, delta is below its limit by %g deg",
          (bound - below.prediction.gait.delta) / DEG);
    CHECK_NEAR(above.prediction.gait.delta, bound, 1e-6, "behind, it is at it");
    optimum_free(&below);
    optimum_free(&above);
    moray_sensitivity_free(s);
    optimum_free(&near);
    optimum_free(&base);
}

// omega of the gait predicted at a step, less that found there.
static double prediction_error(moray_sensitivity *s, const struct optimum *base, const moray_gait_problem_spec *spec,
                               const struct parameter *p, double step)
{
    const moray_gait_problem_spec target = moved(spec, p, step);
    struct optimum found = optimum_of(&target, base);
    moray_solution *predicted;
    CHECK_OK(moray_sensitivity_predict(s, moray_gait_problem_ocp(found.problem), step, &predicted), "prediction");
    const moray_gait_prediction prediction = moray_gait_problem_prediction(found.problem, predicted);
    const double error = prediction.gait.omega - found.prediction.gait.omega;
    CHECK(fabs(error) < 0.1 * fabs(prediction.gait.omega - base->prediction.gait.omega),
          "the prediction goes nine tenths of the way or more: %g of %g", error,
          prediction.gait.omega - base->prediction.gait.omega);
    moray_solution_free(predicted);
    optimum_free(&found);
    return error;
}

static void test_prediction(void)
{
    const struct parameter *c_n = &parameters[2];
    const moray_gait_problem_spec spec = spec_of(MORAY_FIRST_PRINCIPLES);
    struct optimum base = optimum_of(&spec, NULL);
    moray_sensitivity *s;
    CHECK_OK(moray_sensitivity_new(&s, base.solution), "sensitivities");
    take(s, &spec, c_n);
    const double far = prediction_error(s, &base, &spec, c_n, 0.5), near = prediction_error(s, &base, &spec, c_n, 0.25);
    CHECK(far / near > 3.6 && far / near < 4.4, "half the step, a quarter of the error: %g, %g", far, near);
    moray_sensitivity_free(s);
    optimum_free(&base);
}

// With omega at its limit no other constraint says the same.
static void test_omega_at_limit(void)
{
    moray_gait_problem_spec spec = spec_of(MORAY_FIRST_PRINCIPLES);
    spec.limits.omega.upper = 120 * DEG;
    struct optimum base = optimum_of(&spec, NULL);
    moray_sensitivity *s;
    const struct parameter omega = {"omega", offsetof(moray_gait_problem_spec, limits.omega.upper), 2};
    CHECK_NEAR(base.prediction.gait.omega, 120 * DEG, 1e-7, "omega at its limit");
    CHECK_OK(moray_sensitivity_new(&s, base.solution), "sensitivities");
    take(s, &spec, &omega);
    const moray_gait_slope slope = moray_gait_problem_slope(base.problem, base.solution, s);
    CHECK_NEAR(slope.gait.omega, 1, 1e-9, "it goes where the limit goes");
    check_slope(&base, &spec, &omega, &slope);
    const moray_active_change change = moray_sensitivity_change(s, 1);
    CHECK(strcmp(change.what, "parameter omega would leave its upper bound") == 0, "until %g: %s", change.step,
          change.what);
    moray_sensitivity_free(s);
    optimum_free(&base);
}

int main(void)
{
    test_slopes(MORAY_CONTROL_ORIENTED);
    test_slopes(MORAY_FIRST_PRINCIPLES);
    test_change();
    test_prediction();
    test_omega_at_limit();
    return tap_done();
}
