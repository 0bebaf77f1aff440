// SPDX-License-Identifier: MIT
//
// Joints exactly on the gait: which steps are made between stops, and where an observer ends the simulation.
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

int main(void)
{
    for (int model = 0; model < 2; model++) {
        check_steps((moray_model)model, 1, 16, 16);
        check_steps((moray_model)model, 0.7, 16, 12);
        check_steps((moray_model)model, 1.01, 10, 11);
        check_steps((moray_model)model, 2, 8, 16);
        check_stop((moray_model)model);
    }
    return tap_done();
}
