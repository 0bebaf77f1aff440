// SPDX-License-Identifier: MIT
//
// Laws of heading and path, look by look, against their formulas: integrals that rest at the limit, plans that are
// followed where the robot is, and limits that an actuator has either way.
#include "degree.h"
#include "reference_text.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/heading_law.h"
#include "moray/snake/path.h"
#include "moray/snake/trial.h"
#include "snake/steer/problems.h"

// ---- Headings ------------------------------------------------------------------------------------------------------

static double wrapped(double angle)
{
    return atan2(sin(angle), cos(angle));
}

// A heading that wanders far off to either side: the whole of the law, with its integral.
static void test_heading_law(double scale, unsigned long long seed)
{
    const double period = 0.2, smoothing = 0.7, offset = 0.04;
    const moray_heading_gains gains = {
        .proportional = 0.05, .forward = 0.12, .lead = 0.55, .integral = 0.9, .derivative = 0.5};
    const moray_straight_motion straight = {.gait = {.omega = 2}, .undulation = {0.04, -0.03}};
    const moray_feedback feedback = {.straight = &straight, .offset = offset, .offset_rate = 1, .period = period};
    moray_reference reference = read_ok("ramps:0=0,4=60,8=-90,12=-90");
    moray_heading_law law = {
        .gains = gains, .reference = &reference, .feedback = &feedback, .scale = scale, .smoothing = smoothing};
    double filtered = 0, integral = 0, worst = 0, targets = 0, wandering = 0.1;
    int resting = 0, driven = 0;
    for (int k = 0; k < 60; k++) {
        const double t = k * period, ahead = t + 0.55;
        const double reference_at = (ahead < 4 ? 15 * ahead : ahead < 8 ? 60 - 37.5 * (ahead - 4) : -90) * DEG;
        const double reference_rate = (ahead < 4 ? 15 : ahead < 8 ? -37.5 : 0) * DEG;
        wandering += 0.1 * (reference_at - wandering) + tap_random(&seed, -0.5, 0.5);
        const double shown = wandering + 2 * M_PI * (k / 7 % 3); // a compass knows no turns
        const moray_swim_sample sample = {.t = t, .pose = {.heading = shown + 0.04 * cos(2 * t) - 0.03 * sin(2 * t)}};
        const double before = k ? filtered : shown;
        filtered = before + (1 - exp(-period / smoothing)) * wrapped(shown - before);
        const double rate = (filtered - before) / period, error = wrapped(reference_at - shown);
        const double rest = scale * (0.12 * reference_rate + 0.05 * 0.5 * (reference_rate - rate));
        const double gain = scale * 0.05 * 0.9, wanted = scale * 0.05 * error + rest + gain * integral;
        const bool moves = fabs(wanted) < offset || wanted * gain * error < 0;
        integral += moves ? period * error : 0;
        resting += !moves;
        driven += moves && fabs(wanted) >= offset;
        targets = tap_worse(targets, fabs(moray_heading_law_target(&sample, &law) - reference_at));
        worst = tap_worse(worst, fabs(moray_heading_law_feed(&sample, t + period, &law) - rest - gain * integral));
        worst = tap_worse(worst, fabs(law.integral - integral));
    }
    CHECK_NEAR(targets, 0, 1e-12, "the heading to steer for, of later");
    CHECK_NEAR(worst, 0, 1e-12, "what is fed and summed up");
    CHECK(resting > 5 && resting < 55 && driven > 0, "%d of 60 looks at the limit, %d on the way back", resting,
          driven);
    moray_reference_free(&reference);
}

// ---- Paths ---------------------------------------------------------------------------------------------------------

// A plan to be followed: the guess of one, which is as good.
static moray_steering_plan plan_of(const moray_path *path)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&robot);
    const moray_gait gait = moray_gait_map(&robot, &paper, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    const moray_path_spec spec = {.robot = robot,
                                  .model = MORAY_FIRST_PRINCIPLES,
                                  .limits = {.offset = 5 * DEG, .offset_rate = 3 * DEG, .offset_acceleration = 1},
                                  .weight = {1, 0.01, 0.01},
                                  .path = path,
                                  .tube = MORAY_INFINITY,
                                  .reach = 2};
    moray_settings settings = moray_settings_default();
    moray_steering_plan plan;
    settings.scheme = "radau3";
    settings.intervals = 8;
    settings.max_iterations = 0;
    CHECK_OK(moray_path_plan_make(&plan, &spec, &settings, &gait, (double[]){0, 0.6}, -0.3, NULL), "a plan");
    return plan;
}

// Where the robot is along the path the plan was at a time: what it steered for then, and by which offset from then on.
static void test_plan(void)
{
    const double lookahead = 1.3, gain = 0.2, period = 0.25, scale = -1.4;
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 8,0", 1), "a leg");
    moray_steering_plan plan = plan_of(&path);
    double t0, t1, x[MORAY_STEERING_STATES], u[2], integral = 0.5, worst = 0, fed = 0, off = 0;
    moray_solution_times(plan.solution, 0, &t0, &t1);
    moray_guidance guidance = {.path = &path,
                               .plan = &plan,
                               .plan_scale = scale,
                               .lookahead = lookahead,
                               .gain = gain,
                               .period = period,
                               .integral = integral};
    for (int k = 1; k < 8; k++) {
        const double at = t1 * (k + 0.3) / 9, across = k % 2 ? 0.4 : -0.25;
        moray_solution_at(plan.solution, 0, at, x, u);
        const double *factor = plan.straight.undulation, phase = plan.straight.gait.omega * at;
        const double heading = x[MORAY_STATE_THETA] - factor[0] * cos(phase) - factor[1] * sin(phase);
        const double beside = across - x[MORAY_STATE_P_Y], bent = beside + gain * integral;
        const moray_swim_sample sample = {.t = 2.5 * k, .pose = {.p_x = u[1], .p_y = across}};
        guidance.along = u[1] - 0.1;
        worst = tap_worse(worst, fabs(moray_guidance_target(&sample, &guidance) - heading + atan(bent / lookahead)));
        integral += period * lookahead * beside / (bent * bent + lookahead * lookahead);
        worst = tap_worse(worst, fabs(guidance.integral - integral));
        off = fmax(off, fabs(moray_steering_offset(plan.solution, at + 0.5).value));
        fed = tap_worse(fed, fabs(moray_guidance_feed(&sample, sample.t + 0.5, &guidance) -
                                  scale * moray_steering_offset(plan.solution, at + 0.5).value));
    }
    CHECK_NEAR(worst, 0, 1e-6, "headings to steer for, and their integral");
    CHECK_NEAR(fed, 0, 1e-6, "offsets fed");
    CHECK(off > 1 * DEG, "of up to %.3g deg", off / DEG);
    moray_steering_plan_free(&plan);
    moray_path_free(&path);
}

// Nothing is left of a plan that cannot be.
static void test_no_plan(void)
{
    moray_path path;
    moray_reference reference = read_ok("ramps:0=20");
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_path_read(&path, "0,0 4,1", 0.8), "a path");
    const moray_path_spec along = {.robot = moray_robot_paper(), .path = &path, .tube = -1};
    const moray_heading_spec heading = {
        .robot = moray_robot_paper(), .reference = &reference, .max_error = -1, .t1 = 5};
    const moray_gait gait = moray_gait_paper(&along.robot);
    for (int on_path = 0; on_path < 2; on_path++) {
        moray_steering_plan plan;
        const moray_status status =
            on_path ? moray_path_plan_make(&plan, &along, &settings, &gait, (double[]){0, 1}, 0, NULL)
                    : moray_heading_plan_make(&plan, &heading, &settings, &gait, NULL);
        CHECK(status.code == MORAY_INPUT && !plan.problem.task && plan.straight.speed == 0, "%s", status.text);
    }
    moray_path_free(&path);
    moray_reference_free(&reference);
}

// ---- Actuators -----------------------------------------------------------------------------------------------------

typedef struct speaker {
    double value;
} speaker;

static moray_status listen(const moray_swim_sample *sample, void *self)
{
    (void)sample, (void)self;
    return moray_ok();
}

// Commanded by the look's end, which the value tells apart from its beginning.
static moray_offset say(double t, const void *self)
{
    return (moray_offset){.value = ((const speaker *)self)->value + 0.01 * t};
}

// Commands to and fro arrive periods late, no faster than the actuator.
static void test_actuators(int dead, double most)
{
    enum { looks = 30 };
    const double period = 0.2;
    static const moray_straight_motion straight = {.gait = {.omega = 2}};
    speaker speaks = {.value = 0};
    const moray_swim_controller inner = {say, listen, period, &speaks};
    const moray_actuators actuators = {.dead_time = (dead + 0.4) * period, .rate = most};
    moray_instruments *instruments;
    double command[looks], value = 0, slope = 0, worst = 0;
    int limited[2] = {0, 0};
    unsigned long long seed = 9;
    CHECK_OK(moray_instruments_new(&instruments, &(moray_sensors){0}, &actuators, &straight, 10, &inner),
             "instruments");
    const moray_swim_controller outer = moray_instruments_controller(instruments);
    CHECK(outer.offset(0.3, outer.self).value == 0.01 * 0.3, "before the first look what is told");
    for (int k = 0; k < looks; k++) {
        const double t = k * period;
        const moray_swim_sample sample = {.t = t};
        speaks.value = tap_random(&seed, -0.3, 0.3);
        command[k] = speaks.value + 0.01 * (t + period);
        value = k ? value + slope * period : speaks.value;
        slope = k < dead ? 0 : (command[k - dead] - value) / period;
        limited[slope < 0] += most > 0 && fabs(slope) > most;
        slope = most > 0 && slope > most ? most : most > 0 && slope < -most ? -most : slope;
        CHECK_OK(outer.measure(&sample, outer.self), "looked");
        const moray_offset now = outer.offset(t + 0.3 * period, outer.self);
        worst = tap_worse(worst, fabs(now.rate - slope) + fabs(now.value - value - slope * 0.3 * period));
    }
    CHECK_NEAR(worst, 0, 1e-12, "offsets behind their commands");
    CHECK(most == 0 || (limited[0] > 2 && limited[1] > 2), "%d times limited up, %d down", limited[0], limited[1]);
    moray_instruments_free(instruments);
}

int main(void)
{
    test_heading_law(1, 4);
    test_heading_law(-2.5, 8);
    test_plan();
    test_no_plan();
    for (int dead = 0; dead < 4; dead += 3) {
        test_actuators(dead, 0);
        test_actuators(dead, 0.8);
    }
    return tap_done();
}
