// SPDX-License-Identifier: MIT
//
// Joints exactly on the gait against the simulation of all joints, under feedback that changes its mind, and a current
// that turns against the current as it is then.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/closed_loop.h"
#include "moray/snake/trial.h"

static double step_of(const moray_swim_sample *sample, void *self)
{
    (void)self;
    return sample->t < 3 ? 0 : 25 * DEG;
}

static moray_swim_closed_loop sail(const moray_robot *robot, const moray_straight_motion *straight,
                                   const moray_swim_on_gait *how, double gain)
{
    moray_feedback feedback = {.target = step_of,
                               .gain = gain * straight->gait.amplitude,
                               .straight = straight,
                               .offset = straight->gait.amplitude / 4,
                               .offset_rate = straight->gait.amplitude / 5,
                               .period = 0.1};
    const moray_swim_controller controller = moray_feedback_controller(&feedback);
    const moray_swim_closed_loop_spec spec = {.robot = robot,
                                              .straight = straight,
                                              .current = {0.06, -0.04},
                                              .controller = &controller,
                                              .duration = 15,
                                              .intervals = 150,
                                              .tolerance = 1e-9,
                                              .on_gait = how};
    moray_swim_closed_loop closed_loop;
    CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &spec), "simulated");
    return closed_loop;
}

static void test_against_all_joints(moray_model model, const moray_hydrodynamics *hydro)
{
    moray_robot robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&robot);
    const moray_gait gait = moray_gait_map(&robot, &paper, MORAY_CONTROL_ORIENTED, model);
    const moray_swim_on_gait coarse = {.steps = 32}, fine = {.steps = 128};
    moray_straight_motion straight;
    robot.hydro = *hydro;
    CHECK_OK(moray_straight_motion_find(&straight, &robot, model, &gait), "straight");
    const double gain = model == MORAY_CONTROL_ORIENTED ? 1 : -1; // erratum E3
    moray_swim_closed_loop all = sail(&robot, &straight, NULL, gain), on = sail(&robot, &straight, &fine, gain),
                           rough = sail(&robot, &straight, &coarse, gain);
    double worst = 0, rough_worst = 0;
    const int last = all.track.n - 1;
    for (int k = 0; k <= last; k++) {
        const moray_pose *a = &all.track.pose[k], *b = &on.track.pose[k], *c = &rough.track.pose[k];
        worst = tap_worse(worst, fmax(fabs(a->heading - b->heading), hypot(a->p_x - b->p_x, a->p_y - b->p_y)));
        rough_worst = tap_worse(rough_worst, fabs(a->heading - c->heading));
    }
    CHECK_NEAR(worst, 0, 1e-6, "heading [rad] and place [m] at 128 steps a period");
    CHECK_NEAR(rough_worst, 0, 1e-3, "and at 32");
    CHECK_RELATIVE(on.track.energy[last], all.track.energy[last], 1e-4, "joint work [J]");
    CHECK(fabs(all.track.pose[last].heading - all.track.pose[0].heading) > 5 * DEG, "and it has turned");
    moray_swim_closed_loop_free(&all);
    moray_swim_closed_loop_free(&on);
    moray_swim_closed_loop_free(&rough);
}

// Half the step is an eighth of the error of the third order, a sixteenth of that of the fourth.
static void test_orders(void)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&robot);
    const moray_gait gait = moray_gait_map(&robot, &paper, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    const int orders[] = {0, 4, 3};
    moray_straight_motion straight;
    double error[3][2];
    CHECK_OK(moray_straight_motion_find(&straight, &robot, MORAY_FIRST_PRINCIPLES, &gait), "straight");
    const moray_swim_on_gait exact = {.steps = 4096};
    moray_swim_closed_loop all = sail(&robot, &straight, &exact, -1);
    const int last = all.track.n - 1;
    for (int i = 0; i < 3; i++)
        for (int fine = 0; fine < 2; fine++) {
            const moray_swim_on_gait how = {.steps = fine ? 960 : 480, .order = orders[i]};
            moray_swim_closed_loop some = sail(&robot, &straight, &how, -1);
            error[i][fine] = 0;
            for (int k = 0; k <= last; k++)
                error[i][fine] = hypot(error[i][fine], some.track.pose[k].v_x - all.track.pose[k].v_x);
            if (fine)
                CHECK_RELATIVE(some.track.energy[last], all.track.energy[last], orders[i] == 3 ? 2e-2 : 1e-5,
                               "joint work [J]");
            moray_swim_closed_loop_free(&some);
        }
    CHECK(error[0][0] == error[1][0] && error[0][1] == error[1][1], "the fourth if none is named");
    CHECK_NEAR(log2(error[1][0] / error[1][1]), 4, 0.3, "fourth order");
    CHECK_NEAR(log2(error[2][0] / error[2][1]), 3, 0.3, "third order");
    moray_swim_closed_loop_free(&all);
}

// A current that turns all the way round drifts the robot nowhere but for the water's own circle.
static void test_current(void)
{
    const moray_robot robot = moray_robot_paper();
    moray_gait gait = moray_gait_paper(&robot);
    gait.amplitude *= 1e-3; // hardly swims
    const double period = 2 * M_PI / gait.omega, speed = 0.1;
    const int periods = 40;
    const moray_swim_on_gait how = {.steps = 16};
    const double turning = 2 * M_PI / (periods * period);
    const moray_gait_change change = {0, gait};
    moray_swimmer *swimmer;
    double x[24], freely[24], V[2], body[MORAY_BODY_STATES] = {0};
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, MORAY_FIRST_PRINCIPLES), "swimmer");
    moray_swimmer_set_current(swimmer, speed, 0);
    body[MORAY_STATE_V_1] = speed; // with the water
    moray_swimmer_on_gait(swimmer, &gait, 0, body, x);
    moray_swimmer_on_gait(swimmer, &gait, 0, body, freely);
    const moray_swim_plan plan = {
        .t1 = periods * period / 2, .schedule = &change, .n_changes = 1, .current_turning = turning};
    CHECK_OK(moray_swim_run_on_gait(swimmer, &plan, &how, x, NULL), "half a turn");
    const moray_pose half = moray_swimmer_pose(swimmer, x);
    const double radius = speed / turning;
    const moray_sim_settings settings = moray_sim_settings_default();
    CHECK_NEAR(half.p_y, 2 * radius, 0.1 * radius, "where half a circle of the water's ends [m]");
    CHECK_OK(moray_swim_run(swimmer, &settings, &plan, freely, NULL), "the same with the joints' own dynamics");
    CHECK_NEAR(moray_swimmer_pose(swimmer, freely).p_x, half.p_x, 1e-4, "comes there too [m]");
    CHECK_NEAR(moray_swimmer_pose(swimmer, freely).p_y, half.p_y, 1e-4, "and there [m]");
    moray_swimmer_current(swimmer, V);
    CHECK(V[0] == speed && V[1] == 0, "the swimmer's current is as before");
    moray_swimmer_free(swimmer);
}

static void test_refusals(void)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait_change change[2] = {{0, moray_gait_paper(&robot)}, {1, moray_gait_paper(&robot)}};
    moray_swim_plan plan = {.t1 = 1, .schedule = change, .n_changes = 2};
    moray_swim_on_gait how = {.steps = 16};
    moray_swimmer *swimmer;
    double x[24] = {0};
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, MORAY_CONTROL_ORIENTED), "swimmer");
    CHECK(moray_swim_run_on_gait(swimmer, &plan, &how, x, NULL).code == MORAY_INPUT, "two gaits are refused");
    plan.n_changes = 1;
    how.steps = 7;
    CHECK(moray_swim_run_on_gait(swimmer, &plan, &how, x, NULL).code == MORAY_INPUT, "and steps too long");
    how.steps = 16;
    const int orders[] = {-1, 1, 2, 3, 4, 5};
    for (int k = 0; k < 6; k++) {
        how.order = orders[k];
        const moray_status status = moray_swim_run_on_gait(swimmer, &plan, &how, x, NULL);
        CHECK(orders[k] == 3 || orders[k] == 4 ? !moray_failed(status)
                                               : status.code == MORAY_INPUT && strstr(status.text, "must be 3 or 4"),
              "order %d: %s", orders[k], status.text);
    }
    moray_swimmer_free(swimmer);
}

int main(void)
{
    const moray_hydrodynamics paper = {0}, consistent = moray_hydrodynamics_consistent();
    test_against_all_joints(MORAY_CONTROL_ORIENTED, &paper);
    test_against_all_joints(MORAY_FIRST_PRINCIPLES, &paper);
    if (tap_thorough())
        test_against_all_joints(MORAY_FIRST_PRINCIPLES, &consistent);
    test_orders();
    test_current();
    test_refusals();
    return tap_done();
}
