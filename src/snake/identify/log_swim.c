// SPDX-License-Identifier: MIT
//
// Synthetic logs: a robot swum in closed loop by the adaptive integrator, seen through instruments.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/snake/instruments.h"
#include "snake/identify/log.h"

static const double far_out = 20; // of standard deviations: an outlier

// When a reading of a row was taken, ascending, and which.
struct look {
    double t;
    int row, what; // 0 position, 1 heading, 2 joints
};

struct recorder {
    moray_swim_log *log;
    const struct look *look;
    int at, n, joints;
    moray_swimmer *swimmer;
    moray_gait angles; // of the control-oriented model
    double *phi;
};

static int by_time(const void *one, const void *other)
{
    const struct look *a = one, *b = other;
    return (a->t > b->t) - (a->t < b->t);
}

static void record(struct recorder *r, const moray_swim_sample *sample)
{
    const struct look *look = &r->look[r->at];
    moray_swim_log *log = r->log;
    const size_t row = (size_t)look->row;
    double *phi = log->phi + row * (size_t)r->joints;
    if (look->what == 0)
        log->p_x[row] = sample->pose.p_x, log->p_y[row] = sample->pose.p_y;
    if (look->what == 1)
        log->heading[row] = sample->pose.heading;
    if (look->what != 2)
        return;
    moray_swimmer_joints(r->swimmer, sample->x, phi, r->phi);
    if (moray_swimmer_model(r->swimmer) == MORAY_CONTROL_ORIENTED)
        moray_gait_reference(&r->angles, r->joints, sample->t, phi, r->phi, r->phi + r->joints);
    else
        memcpy(log->u + row * (size_t)r->joints, sample->u, (size_t)r->joints * sizeof *log->u);
}

static bool observe(const moray_swim_sample *sample, void *self) // a moray_swim_observer
{
    struct recorder *r = self;
    while (r->at < r->n && r->look[r->at].t <= sample->t + 1e-12) {
        record(r, sample);
        r->at++;
    }
    return true;
}

// ---- Faults --------------------------------------------------------------------------------------------------------

static double faulty(double value, double sigma, const moray_swim_log_noise *noise, unsigned long *seed)
{
    value += sigma * moray_random_normal(seed);
    if (moray_random(seed) < noise->outliers)
        value += (moray_random(seed) < 0.5 ? -far_out : far_out) * sigma;
    return moray_random(seed) < noise->missing ? NAN : value;
}

static void spoil(moray_swim_log *log, const moray_swim_log_noise *noise)
{
    const double c = cos(noise->camera_rotation), s = sin(noise->camera_rotation);
    unsigned long seed = noise->seed;
    for (int k = 0; k < log->n; k++) {
        const double x = log->p_x[k] - noise->camera[0], y = log->p_y[k] - noise->camera[1];
        log->p_x[k] = faulty(c * x - s * y, noise->position, noise, &seed);
        log->p_y[k] = faulty(s * x + c * y, noise->position, noise, &seed);
        log->heading[k] = faulty(log->heading[k] + noise->heading_bias, noise->heading, noise, &seed);
        for (int i = 0; i < log->joints; i++)
            log->phi[k * log->joints + i] += noise->joints * moray_random_normal(&seed);
        for (int i = 0; i < log->joints && log->u; i++)
            log->u[k * log->joints + i] += noise->torque * moray_random_normal(&seed);
    }
}

// ---- The run -------------------------------------------------------------------------------------------------------

static moray_status check(double from, double to, double step, const moray_swim_log_noise *noise)
{
    const double late = fmax(noise->position_delay, noise->heading_delay);
    if (!(step > 0) || !(to > from) || !(from >= 0) || (to - from) / step > 1e6)
        return moray_error(MORAY_INPUT, "a log from %g s to %g s every %g s: must be at most a million rows after 0",
                           from, to, step);
    if (!(fmin(noise->position_delay, noise->heading_delay) >= 0) || late > from)
        return moray_error(MORAY_INPUT, "a delay of %g s: must be 0 to %g s, where the log begins", late, from);
    return moray_ok();
}

static void plan_looks(const moray_swim_log *log, const moray_swim_log_noise *noise, struct look *look, double *times)
{
    for (int k = 0; k < log->n; k++) {
        look[3 * k] = (struct look){log->t[k] - noise->position_delay, k, 0};
        look[3 * k + 1] = (struct look){log->t[k] - noise->heading_delay, k, 1};
        look[3 * k + 2] = (struct look){log->t[k], k, 2};
    }
    qsort(look, 3 * (size_t)log->n, sizeof *look, by_time);
    for (int k = 0; k < 3 * log->n; k++)
        times[k] = look[k].t;
}

static moray_status swim(moray_swimmer *swimmer, const moray_gait *gait, double heading, struct recorder *r,
                         double *times, double *x)
{
    const moray_gait_change change = {0, *gait};
    const moray_sim_settings settings = moray_sim_settings_default();
    int n = 0;
    for (int k = 0; k < r->n; k++) // each once
        if (n == 0 || times[k] > times[n - 1])
            times[n++] = times[k];
    moray_swimmer_rest(swimmer, heading, 0, 0, x);
    return moray_swim_run(swimmer, &settings,
                          &(moray_swim_plan){.t1 = times[n - 1],
                                             .schedule = &change,
                                             .n_changes = 1,
                                             .times = times,
                                             .n_times = n,
                                             .observe = observe,
                                             .observer = r},
                          x, NULL);
}

moray_status moray_swim_log_swim(moray_swim_log *log, moray_swimmer *swimmer, const moray_gait *gait, double heading,
                                 double from, double to, double step, const moray_swim_log_noise *noise)
{
    const moray_robot *robot = moray_swimmer_robot(swimmer);
    const moray_model model = moray_swimmer_model(swimmer);
    const int joints = robot->links - 1;
    *log = (moray_swim_log){.name = "synthetic"};
    MORAY_TRY(check(from, to, step, noise));
    const int n = (int)floor((to - from) / step * (1 + 1e-12)) + 1;
    MORAY_TRY(moray_swim_log_new(log, n, joints));
    double *room = log->phi + (size_t)n * (size_t)joints;
    log->u = model == MORAY_FIRST_PRINCIPLES ? room : NULL;
    log->p_x = room + (size_t)n * (size_t)joints, log->p_y = log->p_x + n, log->heading = log->p_y + n;
    for (int k = 0; k < n; k++)
        log->t[k] = from + k * step, log->line[k] = k + 2;
    struct look *look = calloc(3 * (size_t)n, sizeof *look);
    double *times = calloc(3 * (size_t)n + 2 * (size_t)joints + (size_t)moray_swimmer_states(swimmer), sizeof *times);
    moray_status status = moray_error(MORAY_MEMORY, "no memory for a log of %d rows", n);
    if (look && times) {
        struct recorder r = {.log = log,
                             .look = look,
                             .n = 3 * n,
                             .joints = joints,
                             .swimmer = swimmer,
                             .angles = moray_gait_map(robot, gait, model, MORAY_FIRST_PRINCIPLES),
                             .phi = times + 3 * n};
        plan_looks(log, noise, look, times);
        status = swim(swimmer, gait, heading, &r, times, r.phi + 2 * joints);
        spoil(log, noise);
    }
    free(look);
    free(times);
    return status;
}
