// SPDX-License-Identifier: MIT
#include <math.h>
#include <stddef.h>

#include "moray/snake/path.h"

// When the plan is at a distance along the path: its last control grows with time.
static double plan_time(const moray_guidance *guidance, double along)
{
    double low, high, u[2];
    moray_solution_times(guidance->plan->solution, 0, &low, &high);
    for (int k = 0; k < 40; k++) {
        const double middle = (low + high) / 2;
        moray_solution_at(guidance->plan->solution, 0, middle, NULL, u);
        *(u[1] < along ? &low : &high) = middle;
    }
    return (low + high) / 2;
}

// Distance of the plan to the path at that time, to the left.
static double plan_across(const moray_guidance *guidance, double t, double *heading)
{
    double x[MORAY_STEERING_STATES], u[2], across;
    moray_solution_at(guidance->plan->solution, 0, t, x, u);
    *heading = moray_straight_motion_heading(&guidance->plan->straight, t, x[MORAY_STATE_THETA]);
    moray_path_project(guidance->path, x[MORAY_STATE_P_X], x[MORAY_STATE_P_Y], &u[1], &across);
    return across;
}

bool moray_path_seek(const moray_swim_sample *sample, void *self)
{
    moray_path_seeker *seeker = self;
    double across;
    moray_path_project(seeker->path, sample->pose.p_x, sample->pose.p_y, &seeker->along, &across);
    return seeker->along < seeker->path->length;
}

double moray_guidance_target(const moray_swim_sample *sample, void *self)
{
    moray_guidance *g = self;
    double across, course;
    moray_path_project(g->path, sample->pose.p_x, sample->pose.p_y, &g->along, &across);
    if (g->plan)
        across -= plan_across(g, plan_time(g, g->along), &course);
    else
        course = creal(moray_path_at(g->path, g->along + g->ahead).course);
    const double bent = across + g->gain * g->integral;
    g->integral += g->period * g->lookahead * across / (bent * bent + g->lookahead * g->lookahead);
    return course - atan(bent / g->lookahead);
}

double moray_guidance_feed(const moray_swim_sample *sample, double t, void *self)
{
    const moray_guidance *g = self;
    const moray_plan plan = {g->plan->solution, g->plan_scale};
    return moray_plan_offset(&plan, plan_time(g, g->along) + t - sample->t).value;
}
