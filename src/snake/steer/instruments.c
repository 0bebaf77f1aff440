// SPDX-License-Identifier: MIT
#include "moray/snake/instruments.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { QUEUE = 256 }; // readings or commands on their way at most

struct moray_instruments {
    moray_sensors sensors;
    moray_actuators actuators;
    const moray_straight_motion *straight;
    const moray_swim_controller *inner;
    int links;
    unsigned long seed;
    double heading_error; // of the mean heading: compass and joints together
    double due;           // time of the next reading
    moray_reading queue[QUEUE];
    int waiting; // readings in the queue, the oldest first
    moray_reading now;
    bool any;
    double command[QUEUE]; // by period, round and round
    int dead, commands;    // periods of dead time; commands so far
    double value, slope, from;
};

// ---- Random numbers ------------------------------------------------------------------------------------------------

double moray_random(unsigned long *seed) // SplitMix64
{
    uint64_t z = (*seed += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1.0p-53;
}

double moray_random_normal(unsigned long *seed) // Box and Muller
{
    const double radius = sqrt(-2 * log(1 - moray_random(seed)));
    return radius * cos(2 * M_PI * moray_random(seed));
}

// ---- Sensors -------------------------------------------------------------------------------------------------------

// Undulation of the heading at t.
static double swing(const moray_instruments *w, double t)
{
    return -moray_straight_motion_heading(w->straight, t, 0);
}

// Rate of the mean heading without that of its undulation.
static double turning(const moray_instruments *w, const moray_swim_sample *sample)
{
    const moray_straight_motion *straight = w->straight;
    const double phase = straight->gait.omega * sample->t;
    double body[MORAY_BODY_STATES];
    moray_state_body(straight->model, w->links, sample->x, body);
    return body[MORAY_STATE_V_THETA] +
           straight->gait.omega * (straight->undulation[0] * sin(phase) - straight->undulation[1] * cos(phase));
}

static void take_reading(moray_instruments *w, const moray_swim_sample *sample)
{
    const moray_pose *pose = &sample->pose;
    moray_reading reading = {sample->t,
                             pose->heading + w->heading_error * moray_random_normal(&w->seed),
                             pose->p_x + w->sensors.position * moray_random_normal(&w->seed),
                             pose->p_y + w->sensors.position * moray_random_normal(&w->seed),
                             true,
                             NAN};
    if (w->sensors.gyro)
        reading.rate = turning(w, sample) + w->sensors.rate * moray_random_normal(&w->seed);
    const bool lost = moray_random(&w->seed) < w->sensors.drop_out;
    w->due += w->sensors.sampling > 0 ? w->sensors.sampling : w->inner->period;
    if ((!lost || !w->any) && w->waiting < QUEUE)
        w->queue[w->waiting++] = reading;
}

// The newest reading that is no younger than the delay; at the start the first one, however young.
static void show(moray_instruments *w, double t)
{
    const double rounding = 1e-6 * w->inner->period;
    int old = 0;
    w->now.fresh = false;
    while (old < w->waiting && (w->queue[old].t + w->sensors.delay <= t + rounding || !w->any)) {
        w->now = w->queue[old++];
        w->any = true;
    }
    memmove(w->queue, w->queue + old, (size_t)(w->waiting - old) * sizeof *w->queue);
    w->waiting -= old;
}

// ---- Actuators -----------------------------------------------------------------------------------------------------

static moray_offset offset(double t, const void *self)
{
    const moray_instruments *w = self;
    if (w->commands == 0)
        return w->inner->offset(t, w->inner->self);
    return (moray_offset){.value = w->value + w->slope * (t - w->from), .rate = w->slope};
}

static void act(moray_instruments *w, double t)
{
    const double period = w->inner->period, most = w->actuators.rate;
    const double before = offset(t, w).value;
    w->command[w->commands % QUEUE] = w->inner->offset(t + period, w->inner->self).value;
    const int late = w->commands < w->dead ? 0 : w->commands - w->dead;
    w->commands++;
    w->slope = (w->command[late % QUEUE] - before) / period;
    if (w->commands <= w->dead)
        w->slope = 0;
    if (most > 0)
        w->slope = fmin(fmax(w->slope, -most), most);
    w->value = before;
    w->from = t;
}

// ---- Both ----------------------------------------------------------------------------------------------------------

static moray_status measure(const moray_swim_sample *sample, void *self)
{
    moray_instruments *w = self;
    const double rounding = 1e-6 * w->inner->period;
    if (sample->t >= w->due - rounding)
        take_reading(w, sample);
    show(w, sample->t);
    moray_swim_sample shown = {.t = sample->t, .energy = sample->energy};
    shown.pose.heading = w->now.heading - swing(w, w->now.t) + swing(w, sample->t);
    shown.pose.p_x = w->now.p_x;
    shown.pose.p_y = w->now.p_y;
    MORAY_TRY(w->inner->measure(&shown, w->inner->self));
    act(w, sample->t);
    return moray_ok();
}

moray_swim_controller moray_instruments_controller(moray_instruments *w)
{
    return (moray_swim_controller){.offset = offset, .measure = measure, .period = w->inner->period, .self = w};
}

const moray_reading *moray_instruments_reading(const moray_instruments *w)
{
    return &w->now;
}

static moray_status check(const moray_sensors *s, const moray_actuators *a, const moray_swim_controller *controller)
{
    const double values[] = {s->heading, s->joints,    s->position, s->rate,  s->sampling,
                             s->delay,   a->dead_time, a->rate,     a->torque};
    static const char *const names[] = {
        "heading noise",           "joint noise",          "position noise", "noise of the heading's rate",
        "sampling of the sensors", "delay of the sensors", "dead time",      "rate of the actuators",
        "torque of the actuators"};
    for (size_t k = 0; k < sizeof values / sizeof *values; k++)
        if (!(values[k] >= 0 && isfinite(values[k])))
            return moray_error(MORAY_INPUT, "%s = %g: must be at least 0", names[k], values[k]);
    if (!(s->drop_out >= 0 && s->drop_out < 1))
        return moray_error(MORAY_INPUT, "drop-outs = %g: must be a chance from 0 to below 1", s->drop_out);
    if (!controller->measure || !(controller->period > 0))
        return moray_error(MORAY_INPUT, "instruments need a controller that measures");
    if (fmax(s->delay, a->dead_time) >= QUEUE * controller->period)
        return moray_error(MORAY_INPUT, "delay = %g s, dead time = %g s: must be below %d periods of %g s", s->delay,
                           a->dead_time, QUEUE, controller->period);
    return moray_ok();
}

moray_status moray_instruments_new(moray_instruments **result, const moray_sensors *sensors,
                                   const moray_actuators *actuators, const moray_straight_motion *straight, int links,
                                   const moray_swim_controller *controller)
{
    *result = NULL;
    MORAY_TRY(check(sensors, actuators, controller));
    moray_instruments *w = calloc(1, sizeof *w);
    if (!w)
        return moray_error(MORAY_MEMORY, "no memory for instruments");
    double squares = 0; // mean heading = that of the head + sum of (i/N) phi_i
    for (int i = 1; i < links; i++)
        squares += (double)i * i / ((double)links * links);
    w->sensors = *sensors;
    w->actuators = *actuators;
    w->straight = straight;
    w->links = links;
    w->inner = controller;
    w->seed = sensors->seed;
    w->heading_error = sqrt(sensors->heading * sensors->heading + sensors->joints * sensors->joints * squares);
    w->dead = (int)lround(actuators->dead_time / controller->period);
    *result = w;
    return moray_ok();
}

void moray_instruments_free(moray_instruments *instruments)
{
    free(instruments);
}
