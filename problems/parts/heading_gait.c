// SPDX-License-Identifier: MIT
//
// The gait of the first-principles plan, by a search over plans: each gait with the best steering for it.
#include "heading_job.h"

typedef struct hunt {
    heading_job *job;
    moray_heading_spec spec;
    moray_heading_plan plan; // the last that was solved, from which the next begins
} hunt;

static moray_gait gait_of(const hunt *h, const double *x)
{
    return (moray_gait){.amplitude = moray_amplitude_from_theta_max(&h->spec.robot, MORAY_FIRST_PRINCIPLES, x[0], x[2]),
                        .omega = x[1],
                        .delta = x[2]};
}

// The objective of the plan; the power straight ahead, relative to its limit.
static bool evaluate(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    hunt *h = self;
    heading_job *job = h->job;
    moray_heading_plan plan;
    const moray_gait gait = gait_of(h, x);
    moray_settings settings = heading_settings(job, false, 2 * M_PI / gait.omega);
    (void)gradient, (void)jacobian;
    settings.scheme = "radau4";
    settings.tolerance = 1e-6;
    settings.max_refinements = 0;
    settings.progress = NULL;
    const moray_heading_plan *from = h->plan.solution ? &h->plan : &job->plan[MORAY_CONTROL_ORIENTED];
    if (moray_failed(moray_heading_plan_make(&plan, &h->spec, &settings, &gait, from)))
        return false;
    const bool solved = moray_solution_info(plan.solution)->outcome == MORAY_NLP_SOLVED;
    *f = moray_solution_objective(plan.solution);
    c[0] = plan.cruise.power / h->spec.limits.power - 1;
    job->gaits_tried++;
    moray_ticker_show(&job->ticker,
                      "heading_tracking: gait %d: omega %.1f deg/s, delta %.1f deg, %.4f W: objective %.6g",
                      job->gaits_tried, gait.omega / DEG, gait.delta / DEG, plan.cruise.power, *f);
    if (solved) {
        moray_heading_plan_free(&h->plan);
        h->plan = plan;
    } else {
        moray_heading_plan_free(&plan);
    }
    return solved;
}

moray_status heading_search_gait(heading_job *job, moray_gait *gait)
{
    hunt h = {.job = job, .spec = heading_spec(job, MORAY_FIRST_PRINCIPLES, false)};
    const moray_steering_limits *limits = &h.spec.limits;
    const double lower[] = {limits->theta_max.lower, limits->omega.lower, limits->delta.lower};
    const double upper[] = {limits->theta_max.upper, limits->omega.upper, limits->delta.upper};
    double x[] = {moray_theta_max_from_amplitude(&h.spec.robot, MORAY_FIRST_PRINCIPLES, gait->amplitude, gait->delta),
                  gait->omega, gait->delta};
    const moray_search_problem problem = {
        .n = 3, .m = 1, .lower = lower, .upper = upper, .self = &h, .evaluate = evaluate};
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    settings.method = MORAY_SEARCH_COBYLA;
    settings.x_tolerance = 1e-3;
    settings.f_tolerance = 1e-4;
    settings.constraint_tolerance = 1e-3;
    settings.max_evaluations = job->gait_evaluations;
    const moray_status status = moray_search(&problem, &settings, x, &info);
    moray_heading_plan_free(&h.plan);
    if (moray_failed(status))
        return status;
    *gait = gait_of(&h, x);
    if (info.violation > 1e-2)
        return moray_error(MORAY_NOT_SOLVED,
                           "power_W = %g: no gait was found that gets by with it: the best takes %.4g W", limits->power,
                           limits->power * (1 + info.violation));
    return moray_ok();
}
