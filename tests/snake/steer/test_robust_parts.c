// SPDX-License-Identifier: MIT
//
// The robot of a scenario against the averaged plant's own map, and what is assumed of scenarios, by hand.
#include "degree.h"
#include "reference_text.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/trial.h"
#include "snake/steer/robust.h"

enum { n = 3 };

static moray_robust_spec spec_of(const moray_scenario *scenario)
{
    moray_robust_spec spec = {.robot = moray_robot_paper(),
                              .offset = 0.015,
                              .offset_rate = 0.01,
                              .lag = 0.4,
                              .noise = 2 * DEG,
                              .sampling = 0.3,
                              .scenario = scenario,
                              .n = n,
                              .duration = 20,
                              .start = {.proportional = 0.05}};
    spec.gait = moray_gait_paper(&spec.robot);
    return spec;
}

static double complex random_complex(unsigned long long *seed, double size)
{
    const double re = tap_random(seed, -size, size);
    return re + tap_random(seed, -size, size) * _Complex_I;
}

static void test_limited(void)
{
    unsigned long long seed = 7;
    double worst = 0;
    for (int k = 0; k < 50; k++) {
        const double limit = tap_random(&seed, 0.1, 3);
        const double complex value = random_complex(&seed, 4), e = cexp(-2 * value / limit);
        worst = tap_worse(worst, cabs(moray_robust_limited(value, limit) - limit * (1 - e) / (1 + e)) / limit);
    }
    CHECK_NEAR(worst, 0, 1e-10, "within its limit by the hyperbolic tangent");
    CHECK_NEAR(creal(moray_robust_limited(1e3, 0.2)), 0.2, 1e-15, "no further than it");
    CHECK_NEAR(creal(moray_robust_limited(-1e3, 0.2)), -0.2, 1e-15, "nor the other way");
}

static void test_reference(void)
{
    moray_reference reference = read_ok("ramps:2=10,6=50");
    const moray_scenario own = {.reference = &reference};
    const robust_robot robot = {.own = &own};
    double rate;
    const double complex at = moray_robust_reference(&robot, 3 + 0.25 * _Complex_I, &rate);
    CHECK_NEAR(creal(at), 20 * DEG, 1e-14, "the reference");
    CHECK_NEAR(cimag(at), 2.5 * DEG, 1e-14, "its derivative along the imaginary axis");
    CHECK_NEAR(rate, 10 * DEG, 1e-14, "its rate");
    moray_reference_free(&reference);
}

// The averaged plant in still water, with the factors that are believed of its thrust and turning.
static void test_rates(void)
{
    enum { inputs = MORAY_STEERING_STATES + 1 + MORAY_STEERING_PARAMETERS + 1, outputs = MORAY_STEERING_STATES + 1 };
    const moray_scenario scenario = {.belief = {.amplitude = 1.2, .turning = 0.7, .current = {0.3, 0.2}}};
    const moray_robust_spec spec = spec_of(&scenario);
    const moray_plant_spec plant_spec = {.robot = spec.robot, .joints = MORAY_JOINTS_STEERED};
    unsigned long long seed = 3;
    robust_robot robot;
    moray_map plant;
    double worst = 0;
    CHECK_OK(moray_robust_robot_new(&robot, &spec, &scenario), "robot");
    CHECK_OK(moray_average_plant(&plant, &plant_spec), "averaged plant");
    for (int k = 0; k < 20; k++) {
        const double x[ROBUST_STATES] = {tap_random(&seed, -3, 3), tap_random(&seed, -0.5, 0.5),
                                         tap_random(&seed, 0.1, 0.5), tap_random(&seed, -0.1, 0.1),
                                         tap_random(&seed, -0.015, 0.015)};
        const double command = tap_random(&seed, -0.015, 0.015);
        const double moved = 0.01 * tanh((command - x[ROBUST_PHI_0]) / 0.4 / 0.01);
        const double in[inputs] = {[MORAY_STATE_THETA] = x[ROBUST_THETA],
                                   [MORAY_STATE_V_THETA] = x[ROBUST_V_THETA],
                                   [MORAY_STATE_V_1] = x[ROBUST_V_T],
                                   [MORAY_STATE_V_2] = x[ROBUST_V_N],
                                   [MORAY_STATE_PHI_0] = 0.7 * x[ROBUST_PHI_0],
                                   [MORAY_STATE_V_PHI_0] = 0.7 * moved,
                                   [MORAY_STEERING_STATES + 1 + MORAY_STEERING_AMPLITUDE] = 1.2 * spec.gait.amplitude,
                                   [MORAY_STEERING_STATES + 1 + MORAY_STEERING_OMEGA] = spec.gait.omega,
                                   [MORAY_STEERING_STATES + 1 + MORAY_STEERING_DELTA] = spec.gait.delta};
        double out[outputs];
        double complex z[ROBUST_STATES], dz[ROBUST_STATES];
        for (int i = 0; i < ROBUST_STATES; i++)
            z[i] = x[i];
        plant.value(plant.self, in, out);
        moray_robust_rates(&robot, z, command, dz);
        const double want[ROBUST_STATES] = {x[ROBUST_V_THETA], out[MORAY_STATE_V_THETA], out[MORAY_STATE_V_1],
                                            out[MORAY_STATE_V_2], moved};
        for (int i = 0; i < ROBUST_STATES; i++)
            worst = tap_worse(worst, cabs(dz[i] - want[i]));
    }
    CHECK_NEAR(worst, 0, 1e-12, "rates of the states");
    moray_map_release(&plant);
    free(robot.plant);
}

static void check_bounds(const moray_bounds *got, double lower, double upper, const char *what)
{
    CHECK_NEAR(got->lower, lower, 1e-14, what);
    CHECK_NEAR(got->upper, upper, 1e-14, what);
}

// Bounds by the first scenario's speed; starts on its reference; the reference a second late as a guess.
static void test_assumed(void)
{
    moray_reference reference = read_ok("ramps:0=30,4=-10");
    const moray_scenario scenario = {.speed = 0.2, .turn = -8, .reference = &reference};
    const moray_robust_spec spec = spec_of(&scenario);
    moray_bounds bounds[ROBUST_STATES];
    double x[ROBUST_STATES];
    moray_robust_bounds(&spec, bounds);
    check_bounds(&bounds[ROBUST_THETA], -4 * M_PI, 4 * M_PI, "two turns either way");
    check_bounds(&bounds[ROBUST_V_THETA], -1, 1, "rate of turning");
    check_bounds(&bounds[ROBUST_V_T], 0.02, 0.6, "ahead, from a tenth of the speed to three times");
    check_bounds(&bounds[ROBUST_V_N], -0.2, 0.2, "aside no faster than it");
    check_bounds(&bounds[ROBUST_PHI_0], -0.015, 0.015, "offset");
    moray_robust_start(&scenario, x);
    const double start[ROBUST_STATES] = {[ROBUST_THETA] = 30 * DEG, [ROBUST_V_T] = 0.2};
    for (int i = 0; i < ROBUST_STATES; i++)
        CHECK_NEAR(x[i], start[i], 1e-15, "the start");
    moray_robust_guess(&scenario, 3, x);
    CHECK_NEAR(x[ROBUST_THETA], 10 * DEG, 1e-14, "heading of two seconds in");
    CHECK_NEAR(x[ROBUST_V_THETA], -10 * DEG, 1e-14, "as fast as that");
    CHECK_NEAR(x[ROBUST_V_T], 0.2, 1e-15, "at the speed");
    CHECK(x[ROBUST_V_N] == 0, "not aside");
    CHECK_NEAR(x[ROBUST_PHI_0], 10 * DEG / 8, 1e-14, "by the offset that turns so");
    moray_reference_free(&reference);
    reference = read_ok("sine:30,40");
    moray_robust_guess(&scenario, 0.5, x);
    CHECK_NEAR(x[ROBUST_THETA], 0, 1e-15, "not before the start");
    moray_reference_free(&reference);
}

// The variance that white noise has behind a first-order loop: noise^2 sampling k / 2, k the gain times the turning.
static void test_noise(void)
{
    const moray_scenario scenario[n] = {{.turn = -8}, {.turn = 3}, {.turn = 5}};
    const moray_robust_spec spec = spec_of(scenario);
    const double mean = 4 * (8 + 3 + 5) / 3.0 * 0.3 / 2 / 100; // 2 deg in units of 10 deg
    CHECK_NEAR(creal(moray_robust_noise(&spec, 0.25)), 0.25 * mean, 1e-14, "the mean over the scenarios");
}

static void refuse(moray_robust_spec spec, const char *says)
{
    const moray_status status = moray_robust_check(&spec);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "'%s'", status.text);
}

static void test_refused(void)
{
    static const moray_scenario scenario[n];
    const moray_robust_spec good = spec_of(scenario);
    moray_robust_spec bad = good;
    CHECK_OK(moray_robust_check(&good), "taken");
    bad.n = MORAY_ROBUST_SCENARIOS;
    bad.noise = bad.sampling = 0;
    CHECK_OK(moray_robust_check(&bad), "as many as there may be, without noise");
    bad.n++;
    refuse(bad, "65 scenarios: must be from 1 to 64");
    bad = good, bad.n = 0;
    refuse(bad, "0 scenarios: must be from 1 to 64");
    const char *const rest = "gain to start from = %g, lag = %g s, limits %g, %g: must be above 0";
    for (int k = 0; k < 6; k++) {
        char says[200];
        bad = good;
        double *const fields[] = {&bad.start.proportional, &bad.lag,   &bad.offset,
                                  &bad.offset_rate,        &bad.noise, &bad.sampling};
        *fields[k] = k < 4 ? 0 : -1;
        snprintf(says, sizeof says, rest, bad.start.proportional, bad.lag, bad.offset, bad.offset_rate);
        refuse(bad, says);
    }
}

// Points of a plan in units of its own, straight lines between them.
static void test_plan(void)
{
    moray_robust_point point[] = {{1, -4}, {3, -8}, {-5, 2}, {7, 6}};
    const moray_robust_plan plan = {.duration = 6, .n = 4, .point = point};
    const struct {
        double t, wanted, heading;
    } at[] = {{-1, 1, -4}, {0, 1, -4}, {0.5, 1.5, -5}, {2, 3, -8}, {3, -1, -3}, {5, 1, 4}, {6, 7, 6}, {9, 7, 6}};
    for (unsigned k = 0; k < sizeof at / sizeof *at; k++) {
        CHECK_NEAR(moray_robust_plan_wanted(&plan, at[k].t), at[k].wanted, 1e-14, "what is wanted");
        CHECK_NEAR(moray_robust_plan_heading(&plan, at[k].t), at[k].heading, 1e-14, "heading");
    }
}

int main(void)
{
    test_limited();
    test_reference();
    test_rates();
    test_assumed();
    test_noise();
    test_refused();
    test_plan();
    return tap_done();
}
