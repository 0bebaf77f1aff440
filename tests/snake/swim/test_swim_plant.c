// SPDX-License-Identifier: MIT
//
// A steered swimmer in water that changes: joints exactly on the gait beside all joints simulated, and what is refused.
#include "degree.h"
#include "tap.h"

#include <string.h>
#include <unistd.h>

#include "moray/snake/trial.h"
#include "snake/swim/closed_loop_plant.h"

enum { LINKS = 4, JOINTS = LINKS - 1, STATES = 2 * LINKS + 4 };

static moray_robot robot_of(void)
{
    moray_robot robot = moray_robot_paper();
    robot.links = LINKS;
    return robot;
}

static moray_swimmer *swimmer_of(moray_model model)
{
    const moray_robot robot = robot_of();
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "swimmer");
    moray_swimmer_set_current(swimmer, 0.08, -0.05);
    return swimmer;
}

static moray_gait gait_of(moray_model model)
{
    const moray_robot robot = robot_of();
    const double delta = 0.9;
    return (moray_gait){.amplitude = moray_amplitude_from_theta_max(&robot, model, 0.4, delta),
                        .omega = 2.3,
                        .delta = delta,
                        .taper = 0.2};
}

// ---- The plant -----------------------------------------------------------------------------------------------------

// No two of its vectors share a number.
static void test_room(void)
{
    moray_swimmer *swimmer = swimmer_of(MORAY_FIRST_PRINCIPLES);
    const moray_gait gait = gait_of(MORAY_FIRST_PRINCIPLES);
    swim_plant plant;
    CHECK_OK(moray_swim_plant_new(&plant, swimmer, &gait), "plant");
    const double *const at[] = {plant.x, plant.dx, plant.ubar, plant.u, plant.phi, plant.v_phi};
    const int size[] = {STATES + 1, STATES, JOINTS, JOINTS, JOINTS, JOINTS};
    CHECK(plant.n_states == STATES && plant.n_joints == JOINTS, "sizes");
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < i; j++)
            CHECK(at[i] >= at[j] + size[j] || at[j] >= at[i] + size[i], "vectors %d and %d", i, j);
    moray_swim_plant_free(&plant);
    CHECK(!plant.x && !plant.swimmer, "freed");
    moray_swimmer_free(swimmer);
}

// ---- Water that changes --------------------------------------------------------------------------------------------

static moray_water *water_of(void)
{
    char path[] = "/tmp/moray_water_XXXXXX";
    const int made = mkstemp(path);
    FILE *file = made < 0 ? NULL : fdopen(made, "w");
    moray_water *water = NULL;
    if (!CHECK(file, "a file"))
        exit(1);
    fputs("t_s,x_m,y_m,v_x_m_s,v_y_m_s\n", file);
    for (int t = 0; t < 6; t++)
        for (int x = 0; x < 3; x++)
            for (int y = 0; y < 3; y++)
                fprintf(file, "%g,%g,%g,%g,%g\n", 0.8 * t, x - 1.0, y - 1.0, 0.1 * sin(2 * t) + 0.04 * x - 0.02 * y,
                        0.08 * cos(1.5 * t) - 0.03 * x + 0.05 * y * x);
    fclose(file);
    CHECK_OK(moray_water_read(&water, path), "table");
    unlink(path);
    return water;
}

typedef struct helm {
    double size, jump; // of the offset; at the fourth measurement
    int seen;          // measurements
    double worst;
} helm;

static moray_offset waving(double t, const void *self)
{
    const helm *h = self;
    const double size = h->size, rate = 1.7, jump = h->seen > 3 ? h->jump : 0;
    return (moray_offset){size * sin(rate * t) + jump * (1 + 0.5 * t), size * rate * cos(rate * t) + 0.5 * jump,
                          -size * rate * rate * sin(rate * t)};
}

// From the start on, a period apart.
static moray_status look(const moray_swim_sample *sample, void *self)
{
    helm *h = self;
    h->worst = tap_worse(h->worst, fabs(sample->t - 0.2 - 0.35 * h->seen++));
    return moray_ok();
}

typedef struct case_of {
    const moray_water *water;
    double turning, jump, k_d;
} case_of;

// Begins on the gait, offset and all; the joints are where gait and offset are throughout.
static void swim(moray_model model, const case_of *c, bool on_gait, moray_swim_track *track, double *energy)
{
    const double fourth = 0.2 + 3 * 0.35, times[] = {0.5, fourth - 1e-13, 2.1, 3.4}; // measured just after a sample
    helm h = {.size = model == MORAY_CONTROL_ORIENTED ? 0.01 : 0.1, .jump = c->jump};
    const double body[MORAY_BODY_STATES] = {0.3, -0.2, 0.1, 0.1, 0.15, -0.05};
    const moray_swim_controller controller = {.offset = waving, .measure = look, .self = &h, .period = 0.35};
    const moray_sim_settings settings = moray_sim_settings_default();
    const moray_swim_on_gait how = {.steps = 1000};
    const moray_gait_change change = {0, gait_of(model)};
    moray_swimmer *swimmer = swimmer_of(model);
    moray_robot robot = robot_of();
    moray_gait begun = change.gait;
    double x[STATES], V[2], worst = 0, phi[JOINTS], v_phi[JOINTS], want[3 * JOINTS];
    robot.k_d = c->k_d;
    CHECK_OK(moray_swimmer_set_robot(swimmer, &robot), "damping");
    const moray_offset offset = waving(0.2, &h);
    begun.offset = offset.value;
    begun.offset_rate = offset.rate;
    moray_swimmer_on_gait(swimmer, &begun, 0.2, body, x);
    CHECK_OK(moray_swim_track_new(track, swimmer, 4), "track");
    const moray_swim_plan plan = {.t0 = 0.2,
                                  .t1 = 3.5,
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .controller = &controller,
                                  .times = times,
                                  .n_times = 4,
                                  .current_turning = c->turning,
                                  .water = c->water,
                                  .observe = moray_swim_track_add,
                                  .observer = track};
    CHECK_OK(on_gait ? moray_swim_run_on_gait(swimmer, &plan, &how, x, energy)
                     : moray_swim_run(swimmer, &settings, &plan, x, energy),
             on_gait ? "on the gait" : "all joints");
    for (int k = 0; k < track->n && c->jump == 0; k++) {
        moray_gait_reference(&change.gait, JOINTS, times[k], want, want + JOINTS, want + 2 * JOINTS);
        moray_swimmer_joints(swimmer, track->x + k * STATES, phi, v_phi);
        for (int i = 0; i < JOINTS; i++) {
            worst = tap_worse(worst, fabs(phi[i] - want[i] - waving(times[k], &h).value));
            worst = tap_worse(worst, fabs(v_phi[i] - want[JOINTS + i] - waving(times[k], &h).rate));
        }
    }
    CHECK(track->n == 4 && worst < 1e-8, "%d samples, joints off by %.1e", track->n, worst);
    CHECK(h.seen == 10 && h.worst < 1e-9, "%d measurements, off by %.1e", h.seen, h.worst);
    moray_swimmer_current(swimmer, V);
    CHECK(V[0] == 0.08 && V[1] == -0.05, "its own current again");
    moray_swimmer_free(swimmer);
}

static void test_water(moray_model model, const case_of *c)
{
    moray_swim_track all, on;
    double energy[2], worst = 0, drift = 0;
    swim(model, c, false, &all, &energy[0]);
    swim(model, c, true, &on, &energy[1]);
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < STATES; i++)
            worst = tap_worse(worst, fabs(all.x[k * STATES + i] - on.x[k * STATES + i]));
        for (int i = 0; i < JOINTS; i++)
            worst = tap_worse(worst, fabs(all.u[k * JOINTS + i] - on.u[k * JOINTS + i]));
        worst = tap_worse(worst, fabs(all.energy[k] - on.energy[k]));
        for (int i = 0; i < 2; i++)
            worst = tap_worse(worst, fabs(all.current[2 * k + i] - on.current[2 * k + i]));
        drift = fmax(drift, hypot(on.current[2 * k] - on.current[0], on.current[2 * k + 1] - on.current[1]));
        if (!c->water) {
            const double angle = c->turning * (on.t[k] - 0.2), cosine = cos(angle), sine = sin(angle);
            worst = tap_worse(worst, fabs(on.current[2 * k] - 0.08 * cosine - 0.05 * sine));
            worst = tap_worse(worst, fabs(on.current[2 * k + 1] - 0.08 * sine + 0.05 * cosine));
        }
    }
    CHECK(worst < 2e-8, "as all joints: off by %.1e", worst);
    CHECK_NEAR(energy[1], energy[0], 2e-8, "joint work");
    CHECK(drift > 0.02, "in a current that changes by %.2g m/s", drift);
    moray_swim_track_free(&all);
    moray_swim_track_free(&on);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void refuse(const moray_swim_plan *plan, int steps, double torque, const char *says)
{
    const moray_swim_on_gait how = {.steps = steps};
    moray_swimmer *swimmer = swimmer_of(MORAY_FIRST_PRINCIPLES);
    double x[STATES];
    CHECK_OK(moray_swimmer_set_torque(swimmer, torque), "torque");
    moray_swimmer_rest(swimmer, 0, 0, 0, x);
    const moray_status status = moray_swim_run_on_gait(swimmer, plan, &how, x, NULL);
    if (says)
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "refused: %s", status.text);
    else
        CHECK_OK(status, "taken");
    moray_swimmer_free(swimmer);
}

static void test_refused(void)
{
    const double at[JOINTS * 3] = {0};
    helm h = {.size = 0.1};
    const moray_series series = {JOINTS, 1, at};
    moray_gait_change change[2] = {{0, gait_of(MORAY_FIRST_PRINCIPLES)}, {1, gait_of(MORAY_FIRST_PRINCIPLES)}};
    moray_swim_controller controller = {.offset = waving, .measure = look, .self = &h};
    moray_swim_plan plan = {.t1 = 0.1, .schedule = change, .n_changes = 1};
    refuse(&plan, 8, 0, NULL);
    refuse(&plan, 7, 0, "steps = 7: must be at least 8 a period");
    refuse(&plan, 8, 0.5, "joints exactly on a gait: not with torques of at most 0.5 N m");
    plan.controller = &controller;
    refuse(&plan, 8, 0, "period of the controller = 0: must be above 0");
    controller.period = 0.05;
    refuse(&plan, 8, 0, NULL);
    controller.period = 0;
    controller.measure = NULL;
    refuse(&plan, 8, 0, NULL);
    plan.n_changes = 2;
    refuse(&plan, 8, 0, "joints exactly on a gait: one gait without a series is needed");
    plan.n_changes = 1;
    change[0].gait.series = &series;
    refuse(&plan, 8, 0, "joints exactly on a gait: one gait without a series is needed");
}

static void test_afloat(const moray_water *water)
{
    const moray_swim_sample inside = {.t = 1, .pose = {.p_x = 0.9, .p_y = -0.9}},
                            outside = {.t = 1.5, .pose = {.p_x = 1.25, .p_y = -0.5}};
    CHECK_OK(moray_swim_afloat(water, &inside), "in the table");
    CHECK_OK(moray_swim_afloat(NULL, &outside), "without one");
    const moray_status status = moray_swim_afloat(water, &outside);
    CHECK(status.code == MORAY_INPUT &&
              strcmp(status.text,
                     "water: at t = 1.5 s the robot is at (1.25, -0.5) m, outside of the table: x -1 to 1, "
                     "y -1 to 1 m, t 0 to 4 s") == 0,
          "%s", status.text);
}

// A robot that leaves the table is told, by whoever looks first.
static void test_adrift(moray_model model, const moray_water *water)
{
    const double time = 2;
    const moray_swim_on_gait how = {.steps = 16};
    const moray_sim_settings settings = moray_sim_settings_default();
    const moray_gait_change change = {0, gait_of(model)};
    for (int k = 0; k < 4; k++) {
        helm h = {.size = 0};
        moray_swim_track track;
        moray_swimmer *swimmer = swimmer_of(model);
        const moray_swim_controller controller = {.offset = waving, .measure = look, .self = &h, .period = 0.35};
        const moray_swim_plan plan = {.t1 = 3,
                                      .schedule = &change,
                                      .n_changes = 1,
                                      .controller = k < 2 ? &controller : NULL,
                                      .times = &time,
                                      .n_times = k < 2 ? 0 : 1,
                                      .water = water,
                                      .observe = moray_swim_track_add,
                                      .observer = &track};
        double x[STATES], body[MORAY_BODY_STATES] = {[MORAY_STATE_P_X] = -1.3};
        CHECK_OK(moray_swim_track_new(&track, swimmer, 1), "track");
        moray_swimmer_on_gait(swimmer, &change.gait, 0, body, x);
        const moray_status status = k % 2 ? moray_swim_run_on_gait(swimmer, &plan, &how, x, NULL)
                                          : moray_swim_run(swimmer, &settings, &plan, x, NULL);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, k < 2 ? "water: at t = 0 s" : "water: at t = 2 s") &&
                  track.n == 0,
              "adrift: %s", status.text);
        moray_swim_track_free(&track);
        moray_swimmer_free(swimmer);
    }
}

int main(void)
{
    moray_water *water = water_of();
    test_room();
    for (int model = 0; model < 2; model++) {
        const double jump = model == MORAY_CONTROL_ORIENTED ? 0.004 : 0.05;
        test_water((moray_model)model, &(case_of){NULL, 0.9, 0, 50});
        test_water((moray_model)model, &(case_of){water, 0, 0, 50});
        test_water((moray_model)model, &(case_of){NULL, 0.3, jump, 50});
        test_water((moray_model)model, &(case_of){water, 0, jump, 8}); // underdamped
        test_adrift((moray_model)model, water);
    }
    test_refused();
    test_afloat(water);
    moray_water_free(water);
    return tap_done();
}
