// SPDX-License-Identifier: MIT
//
// What a search for a gait makes of one gait alone: its goal and its limits, each by how much it is passed in its own
// unit, against the orbit of that gait; and where the gaits that it tries may lie.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/gait_search.h"
#include "moray/snake/trial.h"

enum { LINKS = 4 };

static moray_gait_problem_spec spec_of(moray_model model)
{
    const double speed[] = {0, 2}, torque[] = {0.5, 0.1};
    moray_gait_problem_spec spec = {.robot = moray_robot_paper(),
                                    .model = model,
                                    .current = {0.01, -0.015},
                                    .course = 0.3,
                                    .limits = {.theta_max = moray_between(2 * DEG, 40 * DEG),
                                               .omega = moray_between(0.5, 6),
                                               .delta = moray_between(0.3, 1.5),
                                               .offset = moray_between(-0.05, 0.05),
                                               .power = MORAY_INFINITY,
                                               .joint_rate = MORAY_INFINITY,
                                               .joint_effort = MORAY_INFINITY}};
    spec.robot.links = LINKS;
    spec.robot.supply.constant = 0.4;
    if (model == MORAY_FIRST_PRINCIPLES) {
        spec.robot.motor =
            (moray_motor){.fitted = true, .forward = 0.8, .friction = 0.01, .smooth_rate = 0.1, .smooth_power = 0.02};
        CHECK_OK(moray_motor_set_table(&spec.robot.motor, speed, torque, 2), "motor");
    }
    return spec;
}

static moray_gait gait_of(const moray_gait_problem_spec *spec)
{
    return (moray_gait){.amplitude = moray_amplitude_from_theta_max(&spec->robot, spec->model, 23 * DEG, 1.1),
                        .omega = 2.3,
                        .delta = 1.1};
}

static moray_orbit_result orbit_of(const moray_gait_problem_spec *spec)
{
    const moray_gait gait = gait_of(spec);
    moray_orbit_spec of = moray_orbit_spec_default(&spec->robot, spec->model);
    moray_orbit *orbit;
    moray_orbit_result found = {.iterations = 0};
    memcpy(of.current, spec->current, sizeof of.current);
    of.course = spec->course;
    CHECK_OK(moray_orbit_new(&orbit, &of), "orbit");
    CHECK_OK(moray_orbit_solve(orbit, &gait, &found), "found");
    moray_orbit_free(orbit);
    return found;
}

// One evaluation.
static moray_search_info look(const moray_gait_problem_spec *spec, moray_gait *gait)
{
    moray_search_settings settings = moray_search_settings_default();
    moray_gait_search *search = NULL;
    moray_orbit_result result;
    moray_search_info info = {.objective = NAN, .violation = NAN};
    settings.max_evaluations = 1;
    CHECK_OK(moray_gait_search_new(&search, spec, "lobatto5", 12), "search");
    CHECK_OK(moray_gait_search_run(search, &settings, gait, &result, &info), "one gait");
    CHECK(info.evaluations == 1, "%d orbits", info.evaluations);
    CHECK(gait->offset == result.gait.offset && gait->amplitude == result.gait.amplitude, "the gait is the orbit's");
    moray_gait_search_free(search);
    return info;
}

static void check(const moray_gait_problem_spec *spec, double violation, const char *what)
{
    moray_gait gait = gait_of(spec);
    const moray_search_info info = look(spec, &gait);
    CHECK_NEAR(info.violation, violation, 1e-9, what);
}

static void test_goals(moray_model model)
{
    moray_gait_problem_spec spec = spec_of(model);
    const moray_orbit_result orbit = orbit_of(&spec);
    const double along = cos(0.3) * orbit.steady.v_x + sin(0.3) * orbit.steady.v_y;
    moray_gait gait = gait_of(&spec);
    spec.robot.motor.lines = 0;
    CHECK_NEAR(look(&spec, &gait).objective, -along, 1e-9, "minus the speed along the course");
    CHECK_NEAR(gait.offset, orbit.gait.offset, 1e-9, "with the offset that holds it");
    spec.goal = MORAY_GAIT_THRIFTIEST;
    CHECK_NEAR(look(&spec, &gait).objective, (orbit.steady.power + 0.4) / along, 1e-7, "work per distance, all of it");
}

static void test_limits(moray_model model)
{
    moray_gait_problem_spec plain = spec_of(model), spec;
    const moray_orbit_result orbit = orbit_of(&plain);
    const double along = cos(0.3) * orbit.steady.v_x + sin(0.3) * orbit.steady.v_y, offset = orbit.gait.offset;
    const double unit = model == MORAY_FIRST_PRINCIPLES ? 1 : 2 * plain.robot.l;
    plain.robot.motor.torque[0] *= 100;
    check(&plain, 0, "nothing passed");
    spec = plain, spec.limits.power = 0.8 * orbit.steady.power;
    check(&spec, 0.25, "power");
    spec = plain, spec.limits.joint_rate = 0.4 * orbit.gait.amplitude * 2.3;
    check(&spec, 1.5, "joint rate");
    spec = plain, spec.limits.joint_effort = 0.5 * orbit.steady.peak_effort;
    check(&spec, 1, "joint effort");
    spec = plain, spec.limits.course_speed = 1.25 * along;
    check(&spec, 0.2, "least speed");
    spec = plain, spec.limits.offset = moray_between(offset - 0.03, offset - 0.01);
    check(&spec, 0.01 / unit, "offset to the left");
    spec = plain, spec.limits.offset = moray_between(offset + 0.02, offset + 0.025);
    check(&spec, 0.02 / unit, "offset to the right");
    spec.limits.power = orbit.steady.power / 1.1;
    check(&spec, fmax(0.1, 0.02 / unit), "the most of two");
    if (model == MORAY_CONTROL_ORIENTED)
        return;
    spec = plain, spec.robot.supply.rate = 0.5 * orbit.gait.amplitude * 2.3;
    check(&spec, 1, "what the supply turns the joints at");
    spec = plain, spec.robot.motor.torque[0] *= 0.002;
    check(&spec, 5 * orbit.peak_load - 1, "what the motors give");
}

// A gait beyond the bounds is put on them.
static void test_bounds(moray_model model)
{
    moray_gait_problem_spec spec = spec_of(model);
    moray_gait gait = gait_of(&spec);
    memset(spec.current, 0, sizeof spec.current); // in which the slightest gait holds any course
    gait.omega = 7;
    look(&spec, &gait);
    CHECK_NEAR(gait.omega, 6, 1e-12, "omega at most");
    CHECK_NEAR(gait.delta, 1.1, 1e-12, "delta as it was");
    gait = gait_of(&spec);
    gait.delta = 0.2;
    gait.amplitude = moray_amplitude_from_theta_max(&spec.robot, model, 23 * DEG, 0.2);
    look(&spec, &gait);
    CHECK_NEAR(gait.delta, 0.3, 1e-12, "delta at least");
    CHECK_NEAR(gait.amplitude, moray_amplitude_from_theta_max(&spec.robot, model, 23 * DEG, 0.3), 1e-12,
               "at the same angles of links");
    gait = gait_of(&spec);
    gait.amplitude = moray_amplitude_from_theta_max(&spec.robot, model, 1 * DEG, 1.1);
    look(&spec, &gait);
    CHECK_NEAR(gait.amplitude, moray_amplitude_from_theta_max(&spec.robot, model, 2 * DEG, 1.1), 1e-12,
               "angles at least");
}

static void refuses(const moray_gait_problem_spec *spec, const char *says)
{
    moray_gait_search *search;
    const moray_status status = moray_gait_search_new(&search, spec, "lobatto5", 12);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0 && !search, "%s", status.text);
}

static void test_refusals(void)
{
    const moray_gait_problem_spec good = spec_of(MORAY_CONTROL_ORIENTED);
    moray_gait_problem_spec spec = good;
    spec.limits.taper = moray_between(-0.25, 0);
    refuses(&spec, "taper = -0.25:0: a search knows gaits without one");
    spec = good, spec.limits.link_angles = true;
    refuses(&spec, "link_angles: a search bounds the amplitude of (24)");
    spec = good, spec.joints = MORAY_JOINTS_CLOSED_LOOP;
    refuses(&spec, "joints: a search has its joints on the gait");
    spec = good, memset(spec.current, 0, sizeof spec.current);
    spec.limits.offset = moray_between(-0.02, -0.01);
    refuses(&spec, "phi0 = -0.02:-0.01: in still water the heading returns at 0 only");
    spec.limits.offset = moray_between(0.01, 0.02);
    refuses(&spec, "phi0 = 0.01:0.02: in still water the heading returns at 0 only");
    for (int side = 0; side < 2; side++) {
        moray_gait_search *search;
        spec.limits.offset = side ? moray_between(-0.02, 0) : moray_between(0, 0.02);
        CHECK_OK(moray_gait_search_new(&search, &spec, "lobatto5", 12), "to one side, from 0 on");
        moray_gait_search_free(search);
    }
}

int main(void)
{
    for (int model = 0; model < 2; model++) {
        test_goals((moray_model)model);
        test_limits((moray_model)model);
        test_bounds((moray_model)model);
    }
    test_refusals();
    return tap_done();
}
