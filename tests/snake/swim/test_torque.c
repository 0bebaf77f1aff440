// SPDX-License-Identifier: MIT
//
// Joints of limited torque: what they give, what that does to the robot, and that a limit never reached does nothing.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/swim.h"
#include "moray/snake/trial.h"

enum { links = 10, joints = links - 1, states = 2 * links + 4, samples = 60 };

static const double far_off = 10; // above what the paper's gait takes [N m]

typedef struct swum {
    double x[states], largest, lag; // at the end; largest torque [N m]; joint from the gait [rad]
    double worst;                   // torque beside that of the motion the joints had [N m]
    int cut;                        // torques at the limit
} swum;

typedef struct watch {
    swum *found;
    moray_swimmer *swimmer, *free; // the one that swims, one without a limit
    const moray_gait *gait;
    double most;
} watch;

// The torques are those of the motion that they give: by inverse dynamics, without a limit.
static bool see(const moray_swim_sample *sample, void *self)
{
    const watch *w = self;
    double ubar[joints], dx[states], u[joints], phi[joints], v_phi[joints], reference[3 * joints];
    moray_swimmer_control(w->swimmer, w->gait, sample->t, sample->x, ubar);
    if (!moray_swimmer_rates(w->swimmer, sample->x, ubar, dx, u))
        return false;
    for (int i = 0; i < joints; i++) {
        w->found->largest = fmax(w->found->largest, fabs(u[i]));
        w->found->cut += fabs(u[i]) > (1 - 1e-6) * w->most;
        ubar[i] = dx[links + 2 + i] - dx[links + 2 + i + 1]; // (1)
    }
    double again[joints];
    moray_swimmer_rates(w->free, sample->x, ubar, dx, again);
    for (int i = 0; i < joints; i++)
        w->found->worst = fmax(w->found->worst, fabs(again[i] - u[i]));
    moray_swimmer_joints(w->swimmer, sample->x, phi, v_phi);
    moray_gait_reference(w->gait, joints, sample->t, reference, reference + joints, reference + 2 * joints);
    for (int i = 0; i < joints; i++)
        w->found->lag = fmax(w->found->lag, fabs(phi[i] - reference[i]));
    return true;
}

static swum swim(double most, moray_hydrodynamics water)
{
    moray_robot robot = moray_robot_paper();
    robot.hydro = water;
    const moray_gait paper = moray_gait_paper(&robot);
    const moray_gait gait = moray_gait_map(&robot, &paper, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    const double body[MORAY_BODY_STATES] = {[MORAY_STATE_V_1] = 0.2}, duration = 6;
    const moray_gait_change change = {0, gait};
    swum found = {.cut = 0};
    watch w = {&found, NULL, NULL, &gait, most};
    double times[samples + 1];
    moray_sim_settings settings = moray_sim_settings_default();
    for (int k = 0; k <= samples; k++)
        times[k] = duration * k / samples;
    const moray_swim_plan plan = {.t1 = duration,
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .times = times,
                                  .n_times = samples + 1,
                                  .observe = see,
                                  .observer = &w};
    CHECK_OK(moray_swimmer_new(&w.swimmer, &robot, MORAY_FIRST_PRINCIPLES), "swimmer");
    CHECK_OK(moray_swimmer_new(&w.free, &robot, MORAY_FIRST_PRINCIPLES), "another");
    CHECK_OK(moray_swimmer_set_torque(w.swimmer, most), "limit");
    moray_swimmer_on_gait(w.swimmer, &gait, 0, body, found.x);
    CHECK_OK(moray_swim_run(w.swimmer, &settings, &plan, found.x, NULL), "swum");
    moray_swimmer_free(w.swimmer);
    moray_swimmer_free(w.free);
    return found;
}

static void test_limits(const char *name, moray_hydrodynamics water)
{
    const swum any = swim(0, water), never = swim(far_off, water);
    const double most = 0.6 * any.largest;
    const swum weak = swim(most, water);
    CHECK(memcmp(any.x, never.x, sizeof any.x) == 0, "%s: a limit that is not reached does nothing", name);
    CHECK_NEAR(any.lag, 0, 1e-6, "the joints are on the gait [rad]");
    CHECK_NEAR(weak.largest, most, 1e-9, "no torque beyond the limit [N m]");
    CHECK(weak.cut > 10 && weak.lag > 1 * DEG, "%s: %d torques at it, the joints up to %.2g deg off", name, weak.cut,
          weak.lag / DEG);
    CHECK_NEAR(weak.worst, 0, 1e-8, "they are the torques of the motion that they give [N m]");
    CHECK(weak.x[links] < 0.95 * any.x[links], "%s: and the robot gets less far: %.3g m of %.3g m", name, weak.x[links],
          any.x[links]);
}

static void test_refusals(void)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait_change change = {0, moray_gait_paper(&robot)};
    const moray_swim_plan plan = {.t1 = 1, .schedule = &change, .n_changes = 1};
    const moray_swim_on_gait how = {.steps = 16};
    moray_swimmer *revolute, *control;
    double x[states] = {0};
    CHECK_OK(moray_swimmer_new(&revolute, &robot, MORAY_FIRST_PRINCIPLES), "swimmer");
    CHECK_OK(moray_swimmer_new(&control, &robot, MORAY_CONTROL_ORIENTED), "of the other model");
    CHECK(moray_swimmer_set_torque(revolute, -1).code == MORAY_INPUT, "less than no torque");
    CHECK(moray_swimmer_set_torque(control, 1).code == MORAY_INPUT, "joints of forces have no torque");
    CHECK_OK(moray_swimmer_set_torque(control, 0), "but no limit");
    CHECK_OK(moray_swimmer_set_torque(revolute, 0.3), "limit");
    CHECK(moray_swimmer_torque(revolute) == 0.3, "which is told");
    CHECK(moray_swim_run_on_gait(revolute, &plan, &how, x, NULL).code == MORAY_INPUT, "exactly on a gait they are not");
    moray_swimmer_free(revolute);
    moray_swimmer_free(control);
}

int main(void)
{
    test_limits("paper", (moray_hydrodynamics){0});
    test_limits("consistent", moray_hydrodynamics_consistent());
    test_refusals();
    return tap_done();
}
