// SPDX-License-Identifier: MIT
//
// The motion of the joints of a run, as the models are given it.
#include "snake/identify/motion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double widest_gap = 0.25; // [s] without a value that a spline is let run through
static const double likeness = 1.1;    // of a gait's scatter to that of splines: noise, no more
static const double negligible = 2e-4; // of the amplitude

static moray_status check_gaps(const moray_swim_log *log)
{
    for (int i = 0; i < log->joints; i++)
        for (int k = 0, last = -1; k < log->n; k++) {
            if (isnan(log->phi[k * log->joints + i]) && k < log->n - 1)
                continue;
            const double from = last < 0 ? log->t[0] : log->t[last];
            if (log->t[k] - from > widest_gap)
                return moray_error(
                    MORAY_INPUT,
                    "log %s, line %d: joint %d has no value from %.6g s to %.6g s; splines need one every "
                    "%g s (a log of a gait (25) needs none so often: --joints gait)",
                    log->name, log->line[k], i + 1, from, log->t[k], widest_gap);
            last = k;
        }
    return moray_ok();
}

static moray_status fit_splines(struct motion *m, const moray_swim_log *log)
{
    double noise = 0;
    MORAY_TRY(check_gaps(log));
    m->joint = calloc((size_t)m->joints, sizeof *m->joint);
    if (!m->joint)
        return moray_error(MORAY_MEMORY, "no memory for %d joints", m->joints);
    for (int i = 0; i < m->joints; i++) {
        MORAY_TRY(moray_smooth_fit(&m->joint[i], log->n, log->t, log->phi + i, m->joints));
        noise = hypot(noise, m->joint[i].noise);
    }
    noise /= sqrt(m->joints);
    snprintf(m->text, sizeof m->text, "splines of %d to %.3g s, within %.3g deg", m->joint[0].pieces, m->joint[0].width,
             noise * 180 / M_PI);
    if (!m->on_gait)
        m->rms = noise;
    return moray_ok();
}

static void drop_splines(struct motion *m)
{
    for (int i = 0; m->joint && i < m->joints; i++)
        moray_smooth_free(&m->joint[i]);
    free(m->joint);
    m->joint = NULL;
}

static void tell_gait(struct motion *m)
{
    const double degree = M_PI / 180;
    m->on_gait = true;
    snprintf(m->text, sizeof m->text,
             "gait alpha %.4g deg, omega %.5g deg/s, delta %.4g deg, phi_0 %.4g deg, taper %.3g; within %.3g deg",
             m->gait.amplitude / degree, m->gait.omega / degree, m->gait.delta / degree, m->gait.offset / degree,
             m->gait.taper, m->rms / degree);
}

// The gait where it is as near to the log as splines are.
static moray_status choose(struct motion *m, const moray_swim_log *log)
{
    const moray_status gait = moray_motion_fit_gait(m, log);
    const double of_gait = m->rms;
    const moray_status splines = fit_splines(m, log);
    if (!moray_failed(gait) &&
        (moray_failed(splines) || of_gait < hypot(likeness * m->rms, negligible * m->gait.amplitude))) {
        drop_splines(m);
        m->rms = of_gait;
        tell_gait(m);
        return moray_ok();
    }
    return splines;
}

moray_status moray_motion_new(struct motion *m, const moray_swim_log *log, moray_logged_joints wanted)
{
    *m = (struct motion){.joints = log->joints};
    if (wanted == MORAY_LOGGED_AUTO)
        return choose(m, log);
    if (wanted == MORAY_LOGGED_SPLINE)
        return fit_splines(m, log);
    MORAY_TRY(moray_motion_fit_gait(m, log));
    tell_gait(m);
    return moray_ok();
}

void moray_motion_free(struct motion *m)
{
    drop_splines(m);
    *m = (struct motion){0};
}
