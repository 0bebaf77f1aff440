// SPDX-License-Identifier: MIT
//
// What an unscented filter and a moving horizon find of robot and current, both from the same record of a swim under
// the first law.
#include "sea.h"

#include <math.h>
#include <stdlib.h>

static const double apart = 0.5; // readings [s]
static const double window = 40; // of the moving horizon [s]

enum { PER_SECOND = 10, MOST = 2000 }; // samples of a track; readings

typedef struct record {
    int n;
    double t[MOST], offset[MOST], heading[MOST], p_x[MOST], p_y[MOST];
} record;

// Readings of a track with the sensors' errors, some of them lost.
static void read_track(const sea_job *job, const sea_draw *draw, const moray_swim_closed_loop *closed_loop, record *of)
{
    const moray_sensors *sensors = &job->sensors;
    const double of_joints = 1.7; // of ten links' mean, in errors of one
    const double heading = hypot(sensors->heading, of_joints * sensors->joints);
    const int every = (int)(PER_SECOND * apart);
    unsigned long seed = 0xE57 + draw->seed;
    of->n = 0;
    for (int row = every; row < closed_loop->track.n && of->n < MOST; row += every) {
        const moray_pose *pose = &closed_loop->track.pose[row];
        const int k = of->n++;
        const bool lost = moray_random(&seed) < sensors->drop_out;
        of->t[k] = closed_loop->track.t[row];
        of->offset[k] = closed_loop->offset[row] / job->scale;
        of->heading[k] = moray_straight_motion_heading(&draw->straight, of->t[k], pose->heading) +
                         heading * moray_random_normal(&seed);
        of->p_x[k] = pose->p_x + sensors->position * moray_random_normal(&seed);
        of->p_y[k] = pose->p_y + sensors->position * moray_random_normal(&seed);
        if (lost)
            of->heading[k] = of->p_x[k] = of->p_y[k] = NAN;
    }
}

static moray_status filter(const moray_navigator_spec *spec, const record *of, moray_belief *found)
{
    moray_navigator *navigator;
    double before = 0, held = 0;
    MORAY_TRY(moray_navigator_new(&navigator, spec));
    moray_status status = moray_ok();
    for (int k = 0; k < of->n && !moray_failed(status); k++) {
        status = moray_navigator_advance(navigator, of->t[k], held, (of->offset[k] - held) / (of->t[k] - before));
        if (!moray_failed(status) && !isnan(of->heading[k]))
            status = moray_navigator_read(navigator, of->heading[k], of->p_x[k], of->p_y[k]);
        before = of->t[k];
        held = of->offset[k];
    }
    *found = moray_navigator_belief(navigator);
    moray_navigator_free(navigator);
    return status;
}

static moray_status fit(const moray_navigator_spec *spec, const record *of, moray_belief *found)
{
    const moray_log log = {of->n, of->t, of->offset, of->heading, of->p_x, of->p_y};
    moray_settings settings = moray_settings_default();
    settings.scheme = "radau3";
    settings.tolerance = 1e-6;
    settings.max_iterations = 100;
    return moray_moving_horizon(spec, &log, window, &settings, found, NULL);
}

static void judge(const sea_draw *draw, double t, const moray_belief *found, double *value)
{
    const double turned = draw->current_turning * t, c = cos(turned), s = sin(turned);
    value[SEA_CURRENT] = hypot(found->current[0] - (c * draw->current[0] - s * draw->current[1]),
                               found->current[1] - (s * draw->current[0] + c * draw->current[1]));
    value[SEA_THRUST] = fabs(found->amplitude / draw->truth.amplitude - 1);
    value[SEA_TURNING] = fabs(found->turning / draw->truth.turning - 1);
}

static moray_status estimate(const sea_job *job, const sea_draw *draw, record *of, sea_estimate *out)
{
    const moray_navigator_spec spec = sea_navigator_spec(job, draw, SEA_ESTIMATING);
    moray_swim_closed_loop closed_loop;
    moray_belief found;
    MORAY_TRY(sea_record(job, draw, 0, job->number[0], &closed_loop));
    read_track(job, draw, &closed_loop, of);
    moray_swim_closed_loop_free(&closed_loop);
    if (of->n < 2)
        return moray_error(MORAY_NUMERIC, "a swim too short to estimate from");
    for (int k = 0; k < SEA_ESTIMATORS; k++) {
        MORAY_TRY(k ? fit(&spec, of, &found) : filter(&spec, of, &found));
        judge(draw, of->t[of->n - 1], &found, out->value[k]);
    }
    out->known = true;
    return moray_ok();
}

// One that fails, or that there is no time for, stays unknown.
static void task(int k, void *result, void *self)
{
    const sea_job *job = self;
    sea_estimate *out = result;
    *out = (sea_estimate){0};
    record *of = malloc(sizeof *of);
    if (of && !moray_interrupted() && !steer_clock_up(&job->clock) &&
        moray_failed(estimate(job, &job->draw[k], of, out)))
        out->known = false;
    free(of);
}

moray_status sea_estimate_all(sea_job *job)
{
    moray_ticker_show(&job->ticker, "sea_trials: estimates");
    return moray_parallel(job->seeds, sizeof *job->estimate, job->estimate, task, job, job->jobs);
}
