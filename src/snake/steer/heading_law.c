// SPDX-License-Identifier: MIT
#include "moray/snake/heading_law.h"

#include <math.h>

double moray_heading_law_target(const moray_swim_sample *sample, void *self)
{
    const moray_heading_law *law = self;
    double rate;
    return moray_reference_at(law->reference, sample->t + law->gains.lead, &rate);
}

static void filter(moray_heading_law *law, double heading)
{
    const double before = law->begun ? law->heading : heading, period = law->feedback->period;
    const double share = 1 - exp(-period / law->smoothing);
    law->heading = before + share * remainder(heading - before, 2 * M_PI);
    law->rate = (law->heading - before) / period;
    law->begun = true;
}

static void filter_rate(moray_heading_law *law, double rate)
{
    law->rate += (1 - exp(-law->feedback->period / law->smoothing)) * (rate - law->rate);
}

double moray_heading_law_feed(const moray_swim_sample *sample, double t, void *self)
{
    moray_heading_law *law = self;
    const moray_heading_gains *gains = &law->gains;
    const moray_feedback *feedback = law->feedback;
    const double heading = moray_straight_motion_heading(feedback->straight, sample->t, sample->pose.heading);
    double rate;
    const double target = moray_reference_at(law->reference, sample->t + gains->lead, &rate);
    const double error = remainder(target - heading, 2 * M_PI);
    (void)t;
    if (law->reading && isfinite(law->reading->rate))
        filter_rate(law, law->reading->rate);
    else
        filter(law, heading);
    const double rest =
        law->scale * (gains->forward * rate + gains->proportional * gains->derivative * (rate - law->rate));
    const double gain = law->scale * gains->proportional * gains->integral;
    const double wanted = law->scale * gains->proportional * error + rest + gain * law->integral;
    if (fabs(wanted) < feedback->offset || wanted * gain * error < 0)
        law->integral += feedback->period * error;
    return rest + gain * law->integral;
}
