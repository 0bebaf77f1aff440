// SPDX-License-Identifier: MIT
//
// Plans of swimming that are refused, by whole texts; schedules leg by leg; offsets that are steered with their rate
// and acceleration, which joints on the gait follow exactly; and what a run leaves as it was.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/swim.h"

enum { LINKS = 4, STATES = 2 * LINKS + 4, JOINTS = LINKS - 1 };
static const double V[2] = {0.05, -0.08};

static moray_swimmer *make(moray_model model)
{
    moray_robot robot = moray_robot_paper();
    moray_swimmer *swimmer = NULL;
    robot.links = LINKS;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "swimmer");
    moray_swimmer_set_current(swimmer, V[0], V[1]);
    return swimmer;
}

static moray_gait gait_of(moray_model model, double omega, double delta)
{
    return (moray_gait){.amplitude = model == MORAY_CONTROL_ORIENTED ? 0.03 : 0.4, .omega = omega, .delta = delta};
}

static moray_sim_settings tight(void)
{
    return (moray_sim_settings){.rtol = 1e-11, .atol = 1e-12, .max_steps = 1000000};
}

static void check_current(const moray_swimmer *swimmer)
{
    double now[2];
    moray_swimmer_current(swimmer, now);
    CHECK(now[0] == V[0] && now[1] == V[1], "the current is left as it was: %g, %g", now[0], now[1]);
}

// ---- Refused -------------------------------------------------------------------------------------------------------

static void refuse(moray_swimmer *swimmer, const moray_swim_plan *plan, const char *says)
{
    const moray_sim_settings settings = tight();
    double x[STATES] = {0.1, 0.2}, energy = 7;
    const moray_status status = moray_swim_run(swimmer, &settings, plan, x, &energy);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "%s", status.text);
    CHECK(x[0] == 0.1 && x[1] == 0.2 && energy == 7, "nothing is swum");
    check_current(swimmer);
}

static void test_refused(void)
{
    moray_swimmer *swimmer = make(MORAY_CONTROL_ORIENTED);
    const moray_gait gait = gait_of(MORAY_CONTROL_ORIENTED, 2, 0.8);
    moray_gait_change changes[] = {{0.5, gait}, {1.5, gait}, {2.5, gait}};
    moray_swim_plan plan = {.t0 = 0.5, .t1 = 0.6, .schedule = changes, .n_changes = 0};
    refuse(swimmer, &plan, "the schedule needs a gait that begins not after t0 = 0.5");
    plan.n_changes = 3;
    plan.t0 = 0.25;
    refuse(swimmer, &plan, "the schedule needs a gait that begins not after t0 = 0.25");
    changes[0].t = NAN;
    refuse(swimmer, &plan, "the schedule needs a gait that begins not after t0 = 0.25");
    changes[0].t = 0.25;
    changes[1].t = 0.25;
    refuse(swimmer, &plan, "schedule[1].t = 0.25: must lie after that of the gait before, 0.25");
    changes[1].t = 3;
    refuse(swimmer, &plan, "schedule[2].t = 2.5: must lie after that of the gait before, 3");
    changes[1].t = NAN;
    refuse(swimmer, &plan, "schedule[1].t = nan: must lie after that of the gait before, 0.25");
    moray_swimmer_free(swimmer);
}

// ---- Schedules -----------------------------------------------------------------------------------------------------

static void swim(moray_swimmer *swimmer, const moray_gait_change *changes, int n, double t0, double t1, double *x,
                 double *energy)
{
    const moray_sim_settings settings = tight();
    const moray_swim_plan plan = {.t0 = t0, .t1 = t1, .schedule = changes, .n_changes = n};
    CHECK_OK(moray_swim_run(swimmer, &settings, &plan, x, energy), "swum");
    check_current(swimmer);
}

static void test_schedule(moray_model model)
{
    const moray_gait_change changes[] = {
        {-1, gait_of(model, 5, 0.1)}, {0.4, gait_of(model, 2, 0.8)}, {1.1, gait_of(model, 3, 0.5)}, {9, {.omega = 1}}};
    double whole[STATES] = {0}, legs[STATES] = {0}, energy, own, sum = 0, worst = 0;
    moray_swimmer *swimmer = make(model);
    swim(swimmer, changes, 4, 0.1, 1.9, whole, &energy);
    swim(swimmer, &changes[0], 1, 0.1, 0.4, legs, &own);
    sum += own;
    swim(swimmer, &changes[1], 1, 0.4, 1.1, legs, &own);
    sum += own;
    swim(swimmer, &changes[2], 1, 1.1, 1.9, legs, &own);
    sum += own;
    for (int i = 0; i < STATES; i++)
        worst = tap_worse(worst, fabs(whole[i] - legs[i]));
    CHECK(worst < 1e-8, "leg by leg: %.1e", worst);
    CHECK_NEAR(energy, sum, 1e-8 * fabs(sum), "work of all legs");
    double without[STATES] = {0};
    swim(swimmer, changes, 4, 0.1, 1.9, without, NULL);
    CHECK(memcmp(without, whole, sizeof whole) == 0, "the same where nobody asks for the work");
    moray_swimmer_free(swimmer);
}

// ---- Steered -------------------------------------------------------------------------------------------------------

static moray_offset bending(double t, const void *self)
{
    const double c = *(const double *)self;
    return (moray_offset){.value = c * (0.5 + t + t * t / 2), .rate = c * (1 + t), .acceleration = c};
}

static void test_steered(moray_model model)
{
    double c = model == MORAY_CONTROL_ORIENTED ? 0.004 : 0.05;
    const double t0 = 0.2, t1 = 1.7;
    const double body[MORAY_BODY_STATES] = {0.2, 0.1, -0.3, 0.04, 0.07, -0.02};
    const moray_swim_controller controller = {.offset = bending, .self = &c};
    const moray_sim_settings settings = tight();
    moray_gait gait = gait_of(model, 2, 0.8);
    const moray_gait_change change = {0, gait};
    const moray_swim_plan plan = {.t0 = t0, .t1 = t1, .schedule = &change, .n_changes = 1, .controller = &controller};
    double x[STATES], phi[JOINTS], v[JOINTS];
    moray_swimmer *swimmer = make(model);
    const moray_offset first = bending(t0, &c), last = bending(t1, &c);
    gait.offset = first.value, gait.offset_rate = first.rate;
    moray_swimmer_on_gait(swimmer, &gait, t0, body, x);
    CHECK_OK(moray_swim_run(swimmer, &settings, &plan, x, NULL), "steered");
    check_current(swimmer);
    moray_swimmer_joints(swimmer, x, phi, v);
    for (int i = 0; i < JOINTS; i++) {
        const double phase = 2 * t1 + 0.8 * i;
        CHECK_NEAR(phi[i], gait.amplitude * sin(phase) + last.value, 1e-8, "a joint on the gait, offset");
        CHECK_NEAR(v[i], 2 * gait.amplitude * cos(phase) + last.rate, 1e-8, "its rate");
    }
    moray_swimmer_free(swimmer);
}

int main(void)
{
    test_refused();
    for (int model = 0; model < 2; model++) {
        test_schedule((moray_model)model);
        test_steered((moray_model)model);
    }
    return tap_done();
}
