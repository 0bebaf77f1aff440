// SPDX-License-Identifier: MIT
//
// Joints exactly on the gait: which steps are made between stops, and where an observer ends the simulation; and
// what is commanded in jumps, against the simulation of all joints.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/swim.h"

enum { LINKS = 4, STATES = 2 * LINKS + 4, MOST = 40 };
static const double begin = 0.3;

typedef struct {
    double x[STATES], energy;
} outcome;

typedef struct {
    int seen, most;
} watch;

static bool look(const moray_swim_sample *sample, void *self)
{
    watch *seen = self;
    CHECK(isfinite(sample->energy) && sample->u, "sample %d, with efforts", seen->seen);
    return ++seen->seen < seen->most;
}

static moray_gait gait_of(moray_model model)
{
    return (moray_gait){.amplitude = model == MORAY_CONTROL_ORIENTED ? 0.04 : 0.5,
                        .omega = 2.1,
                        .delta = 0.9,
                        .offset = model == MORAY_CONTROL_ORIENTED ? 0.004 : -0.05};
}

// Over some periods, stopping at so many equal intervals of it; the observer has enough after `most` samples.
static outcome run(moray_model model, double periods, int steps, int stops, int most)
{
    const double body[MORAY_BODY_STATES] = {0.2, 0.1, -0.3, 0.04, 0.07, -0.02};
    const moray_gait gait = gait_of(model);
    const moray_gait_change change = {0, gait};
    const moray_swim_on_gait how = {.steps = steps};
    const double duration = periods * 2 * M_PI / gait.omega;
    double times[MOST];
    outcome end;
    moray_robot robot = moray_robot_paper();
    moray_swimmer *swimmer;
    watch seen = {0, most};
    robot.links = LINKS;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "swimmer");
    moray_swimmer_set_current(swimmer, 0.05, -0.08);
    moray_swimmer_on_gait(swimmer, &gait, begin, body, end.x);
    for (int k = 0; k < stops; k++)
        times[k] = begin + duration * (k + 1) / stops;
    const moray_swim_plan plan = {.t0 = begin,
                                  .t1 = begin + duration,
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .times = times,
                                  .n_times = stops,
                                  .observe = look,
                                  .observer = &seen};
    CHECK_OK(moray_swim_run_on_gait(swimmer, &plan, &how, end.x, &end.energy), "swum");
    CHECK(seen.seen == (stops < most ? stops : most), "%d samples", seen.seen);
    moray_swimmer_free(swimmer);
    return end;
}

static double apart(const outcome *one, const outcome *other)
{
    double worst = fabs(one->energy - other->energy);
    for (int i = 0; i < STATES; i++)
        worst = tap_worse(worst, fabs(one->x[i] - other->x[i]));
    return worst;
}

// A stop at the end of every step changes nothing: so many steps a period, equal ones, and one more for a rest.
static void check_steps(moray_model model, double periods, int steps, int made)
{
    const outcome whole = run(model, periods, steps, 0, MOST), cut = run(model, periods, steps, made, MOST),
                  finer = run(model, periods, steps, made + 1, MOST), coarser = run(model, periods, 100, 0, MOST);
    CHECK(apart(&whole, &cut) < 1e-12, "%g periods, %d steps in each: %d steps, off by %.1e", periods, steps, made,
          apart(&whole, &cut));
    CHECK(apart(&whole, &finer) > 1e-8 && apart(&whole, &coarser) > 1e-7, "and no more: %.1e, %.1e",
          apart(&whole, &finer), apart(&whole, &coarser));
}

// Where the observer has enough is where the state is left.
static void check_stop(moray_model model)
{
    const outcome stopped = run(model, 1, 8, 8, 6), short_of = run(model, 0.75, 8, 0, MOST);
    CHECK(apart(&stopped, &short_of) < 1e-12, "stopped after three quarters of a period: %.1e",
          apart(&stopped, &short_of));
}

// ---- Jumps of what is commanded ------------------------------------------------------------------------------------

typedef struct {
    double value, size;
    int looks;
} jumper;

static moray_offset held(double t, const void *self)
{
    const jumper *j = self;
    return (moray_offset){.value = j->value + 0.3 * j->size * t, .rate = 0.3 * j->size};
}

static moray_status jump(const moray_swim_sample *sample, void *self)
{
    static const double to[] = {0.5, -1, 0.8, 0.1};
    jumper *j = self;
    CHECK_NEAR(sample->t, begin + 0.37 * j->looks, 1e-12, "looks every period");
    j->value = j->size * to[j->looks++ % 4];
    return moray_ok();
}

static bool keep(const moray_swim_sample *sample, void *self)
{
    outcome **next = self;
    memcpy((*next)->x, sample->x, sizeof(*next)->x);
    (*next)++->energy = sample->energy;
    return true;
}

enum { STOPS = 5 };

// States at times between which steps are longer and shorter; without `how` all joints are simulated.
static void run_jumps(moray_model model, const moray_swim_on_gait *how, outcome shown[STOPS + 1])
{
    const double body[MORAY_BODY_STATES] = {0.2, 0.1, -0.3, 0.04, 0.07, -0.02},
                 times[STOPS] = {begin + 0.01, begin + 0.34, begin + 0.6, begin + 0.61, begin + 1.4};
    jumper j = {.size = model == MORAY_CONTROL_ORIENTED ? 0.01 : 0.1};
    const moray_swim_controller controller = {.offset = held, .measure = jump, .period = 0.37, .self = &j};
    const moray_sim_settings settings = {.rtol = 1e-11, .atol = 1e-12, .max_steps = 1000000};
    moray_gait gait = gait_of(model);
    outcome *next = shown, *end = &shown[STOPS];
    moray_robot robot = moray_robot_paper();
    moray_swimmer *swimmer;
    robot.links = LINKS;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "swimmer");
    gait.offset = held(begin, &j).value, gait.offset_rate = held(begin, &j).rate;
    moray_swimmer_on_gait(swimmer, &gait, begin, body, end->x);
    const moray_gait_change change = {0, gait_of(model)};
    const moray_swim_plan plan = {.t0 = begin,
                                  .t1 = begin + 1.9,
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .controller = &controller,
                                  .times = times,
                                  .n_times = STOPS,
                                  .observe = keep,
                                  .observer = &next};
    CHECK_OK(how ? moray_swim_run_on_gait(swimmer, &plan, how, end->x, &end->energy)
                 : moray_swim_run(swimmer, &settings, &plan, end->x, &end->energy),
             "swum");
    CHECK(j.looks == 6 && next == end, "%d looks", j.looks);
    moray_swimmer_free(swimmer);
}

static void check_jumps(moray_model model)
{
    outcome all[STOPS + 1], on[STOPS + 1];
    run_jumps(model, NULL, all);
    for (int order = 3; order <= 4; order++) {
        const moray_swim_on_gait how = {.steps = 3200, .order = order};
        double worst = 0;
        run_jumps(model, &how, on);
        for (int k = 0; k <= STOPS; k++) {
            on[k].energy = order == 3 ? all[k].energy : on[k].energy; // of each step's start
            worst = tap_worse(worst, apart(&on[k], &all[k]));
        }
        CHECK(worst < 2e-8, "order %d: off the simulation of all joints by %.1e", order, worst);
    }
}

// The work of a step of the third order is what its start would make of it.
typedef struct {
    moray_swimmer *swimmer;
    double t, energy, power, worst;
    int seen;
} meter;

static bool count(const moray_swim_sample *sample, void *self)
{
    meter *m = self;
    double phi[LINKS - 1], v[LINKS - 1];
    if (m->seen++ > 0)
        m->worst = tap_worse(m->worst, fabs(sample->energy - m->energy - (sample->t - m->t) * m->power));
    moray_swimmer_joints(m->swimmer, sample->x, phi, v);
    m->power = moray_swimmer_power(m->swimmer, sample->u, v);
    m->t = sample->t;
    m->energy = sample->energy;
    return true;
}

static void check_energy(moray_model model)
{
    const double body[MORAY_BODY_STATES] = {0.2, 0.1, -0.3, 0.04, 0.07, -0.02};
    const moray_gait gait = gait_of(model);
    const moray_gait_change change = {0, gait};
    const moray_swim_on_gait how = {.steps = 8, .order = 3};
    const double step = 2 * M_PI / gait.omega / 8;
    moray_robot robot = moray_robot_paper();
    double x[STATES], times[8];
    meter m = {.seen = 0};
    robot.links = LINKS;
    CHECK_OK(moray_swimmer_new(&m.swimmer, &robot, model), "swimmer");
    moray_swimmer_on_gait(m.swimmer, &gait, 0, body, x);
    for (int k = 0; k < 8; k++)
        times[k] = step * k;
    const moray_swim_plan plan = {.t1 = 7 * step,
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .times = times,
                                  .n_times = 8,
                                  .observe = count,
                                  .observer = &m};
    CHECK_OK(moray_swim_run_on_gait(m.swimmer, &plan, &how, x, NULL), "swum");
    CHECK(m.seen == 8 && m.energy > 0 && m.worst < 1e-13, "work of %d steps: off by %.1e of %.1e", m.seen, m.worst,
          m.energy);
    moray_swimmer_free(m.swimmer);
}

static void check_refused(int order)
{
    const moray_gait_change change = {0, gait_of(MORAY_CONTROL_ORIENTED)};
    const moray_swim_plan plan = {.t1 = 1, .schedule = &change, .n_changes = 1};
    const moray_swim_on_gait how = {.steps = 8, .order = order};
    const moray_robot robot = moray_robot_paper();
    double x[24] = {0};
    char says[80];
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, MORAY_CONTROL_ORIENTED), "swimmer");
    const moray_status status = moray_swim_run_on_gait(swimmer, &plan, &how, x, NULL);
    snprintf(says, sizeof says, "order = %d: must be 3 or 4, or 0, which is 4", order);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "%s", status.text);
    moray_swimmer_free(swimmer);
}

int main(void)
{
    for (int model = 0; model < 2; model++) {
        check_steps((moray_model)model, 1, 16, 16);
        check_steps((moray_model)model, 0.7, 16, 12);
        check_steps((moray_model)model, 1.01, 10, 11);
        check_steps((moray_model)model, 2, 8, 16);
        check_stop((moray_model)model);
        check_jumps((moray_model)model);
        check_energy((moray_model)model);
    }
    check_refused(2);
    check_refused(5);
    check_refused(-1);
    check_refused(1);
    return tap_done();
}
