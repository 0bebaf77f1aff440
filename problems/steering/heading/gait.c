// SPDX-License-Identifier: MIT
//
// The gait of the first-principles plan, by a search over plans: theta_max and delta, each pair with the omega that the
// power allows and the best steering for it.
#include "heading.h"

typedef struct hunt {
    heading_job *job;
    moray_heading_spec spec;
    moray_orbit *orbit;
    moray_steering_plan best; // from which the next begins
} hunt;

// The fastest gait of this theta_max and delta, within the limits of omega and straight-ahead power. False where even
// the slowest takes more.
static bool fastest_gait(const hunt *h, double theta_max, double delta, moray_gait *gait)
{
    const moray_steering_limits *limits = &h->spec.limits;
    const double close = 1e-6;
    moray_orbit_result found;
    *gait = (moray_gait){.amplitude =
                             moray_amplitude_from_theta_max(&h->spec.robot, MORAY_FIRST_PRINCIPLES, theta_max, delta),
                         .omega = limits->omega.upper,
                         .delta = delta};
    double low = limits->omega.lower, high = limits->omega.upper;
    for (int k = 0; k < 50; k++) { // the power grows with about omega^2.5
        if (moray_failed(moray_orbit_solve(h->orbit, gait, &found)))
            return false;
        const double ratio = found.steady.power / limits->power;
        if (ratio <= 1 && (ratio > 1 - close || gait->omega >= limits->omega.upper))
            return true;
        *(ratio > 1 ? &high : &low) = gait->omega;
        gait->omega = fmin(fmax(gait->omega * pow((1 - close / 2) / ratio, 0.4), low), high);
        if (high - low < close * high)
            break;
    }
    return false;
}

// The objective of the best plan with x = (theta_max, delta).
static bool evaluate(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    hunt *h = self;
    heading_job *job = h->job;
    moray_steering_plan plan;
    moray_gait gait;
    (void)c, (void)gradient, (void)jacobian;
    if (!fastest_gait(h, x[0], x[1], &gait))
        return false;
    moray_settings settings = heading_settings(job, false, 2 * M_PI / gait.omega);
    settings.scheme = "radau3";
    settings.tolerance = 1e-5;
    settings.max_refinements = 0;
    const moray_steering_plan *control = &job->steer.plan[MORAY_CONTROL_ORIENTED];
    const moray_steering_plan *from = h->best.solution                                            ? &h->best
                                      : steer_alike(&job->steer, MORAY_FIRST_PRINCIPLES, control) ? control
                                                                                                  : NULL;
    if (moray_failed(moray_heading_plan_make(&plan, &h->spec, &settings, &gait, from)))
        return false;
    job->gaits_tried++;
    const bool solved = moray_solution_info(plan.solution)->outcome == MORAY_NLP_SOLVED;
    *f = moray_solution_objective(plan.solution);
    moray_ticker_show(&job->steer.ticker, "heading_tracking: gait %d: %.1f deg, %.1f deg/s, %.1f deg: objective %.5g",
                      job->gaits_tried, x[0] / DEG, gait.omega / DEG, x[1] / DEG, *f);
    if (solved && job->gaits_tried == 1)
        job->first_objective = *f;
    if (solved && *f < job->best_objective) {
        const moray_steering_plan before = h->best;
        job->best_objective = *f;
        h->best = plan;
        plan = before;
    }
    moray_steering_plan_free(&plan); // the worse of the two
    return solved;
}

static moray_status search(hunt *h, const moray_gait *start)
{
    const moray_steering_limits *limits = &h->spec.limits;
    const double lower[] = {limits->theta_max.lower, limits->delta.lower};
    const double upper[] = {limits->theta_max.upper, limits->delta.upper};
    double x[] = {
        moray_theta_max_from_amplitude(&h->spec.robot, MORAY_FIRST_PRINCIPLES, start->amplitude, start->delta),
        start->delta};
    const moray_search_problem problem = {.n = 2, .lower = lower, .upper = upper, .self = h, .evaluate = evaluate};
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    settings.method = MORAY_SEARCH_COBYLA;
    settings.x_tolerance = 1e-2;
    settings.f_tolerance = 1e-3;
    settings.max_evaluations = h->job->gait_evaluations;
    settings.progress = steer_go_on;
    settings.observer = &h->job->steer;
    const moray_status status = moray_search(&problem, &settings, x, &info);
    MORAY_TRY(steer_interruption());
    if (status.code == MORAY_NUMERIC && steer_clock_up(&h->job->steer.clock))
        return moray_ok(); // none in the time given
    if (status.code == MORAY_NUMERIC)
        return moray_error(MORAY_NOT_SOLVED, "power_W = %g: no gait within the limits gets by with it", limits->power);
    return status;
}

moray_status heading_search_gait(heading_job *job, const moray_gait *start, moray_steering_plan *best)
{
    hunt h = {.job = job, .spec = heading_spec(job, MORAY_FIRST_PRINCIPLES, false)};
    job->first_objective = job->best_objective = INFINITY;
    moray_orbit_spec spec = moray_orbit_spec_default(&job->steer.snake.robot, MORAY_FIRST_PRINCIPLES);
    spec.steered = false;
    MORAY_TRY(moray_orbit_new(&h.orbit, &spec));
    const moray_status status = search(&h, start);
    moray_orbit_free(h.orbit);
    *best = h.best;
    return status;
}
