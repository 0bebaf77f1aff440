// SPDX-License-Identifier: MIT
#include "moray/snake/gait_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "snake/gait/problem.h"

enum { VARIABLES = 3 }; // theta_max, omega, delta

struct moray_gait_search {
    moray_gait_problem_spec spec;
    moray_orbit *orbit;
    double lower[VARIABLES], upper[VARIABLES];
    int limits;
};

static bool limited(double value)
{
    return value < MORAY_INFINITY;
}

static bool has_lines(const moray_gait_problem_spec *spec)
{
    return spec->model == MORAY_FIRST_PRINCIPLES && spec->robot.motor.lines > 0;
}

static bool flows(const moray_gait_problem_spec *spec)
{
    return spec->current[0] != 0 || spec->current[1] != 0;
}

static moray_status check(const moray_gait_problem_spec *spec)
{
    moray_gait_problem *problem;
    const moray_bounds offset = spec->limits.offset;
    MORAY_TRY(moray_gait_problem_new(&problem, spec));
    moray_gait_problem_free(problem);
    if (spec->joints != MORAY_JOINTS_ON_GAIT)
        return moray_error(MORAY_INPUT, "joints: a search has its joints on the gait");
    if (spec->limits.link_angles)
        return moray_error(MORAY_INPUT, "link_angles: a search bounds the amplitude of (24)");
    if (spec->limits.taper.lower != 0 || spec->limits.taper.upper != 0)
        return moray_error(MORAY_INPUT, "taper = %g:%g: a search knows gaits without one", spec->limits.taper.lower,
                           spec->limits.taper.upper);
    if (!flows(spec) && (offset.lower > 0 || offset.upper < 0))
        return moray_error(MORAY_INPUT, "phi0 = %g:%g: in still water the heading returns at 0 only", offset.lower,
                           offset.upper);
    return moray_ok();
}

// As many as write_limits writes.
static int count_limits(const moray_gait_problem_spec *spec)
{
    const moray_gait_limits *limits = &spec->limits;
    return limited(limits->power) + limited(moray_gait_most_rate(spec)) + limited(limits->joint_effort) +
           has_lines(spec) + (limits->course_speed > 0) + (flows(spec) ? 2 : 0);
}

moray_status moray_gait_search_new(moray_gait_search **result, const moray_gait_problem_spec *spec, const char *scheme,
                                   int intervals)
{
    const moray_gait_limits *limits = &spec->limits;
    *result = NULL;
    MORAY_TRY(check(spec));
    moray_gait_search *search = calloc(1, sizeof *search);
    if (!search)
        return moray_error(MORAY_MEMORY, "no memory for a gait search");
    const moray_bounds bounds[VARIABLES] = {limits->theta_max, limits->omega, limits->delta};
    search->spec = *spec;
    for (int j = 0; j < VARIABLES; j++) {
        search->lower[j] = bounds[j].lower;
        search->upper[j] = bounds[j].upper;
    }
    search->limits = count_limits(spec);
    moray_orbit_spec orbit = moray_orbit_spec_default(&spec->robot, spec->model);
    memcpy(orbit.current, spec->current, sizeof orbit.current);
    orbit.course = spec->course;
    orbit.scheme = scheme;
    orbit.intervals = intervals;
    moray_status status = moray_orbit_new(&search->orbit, &orbit);
    if (moray_failed(status))
        moray_gait_search_free(search);
    else
        *result = search;
    return status;
}

void moray_gait_search_free(moray_gait_search *search)
{
    if (!search)
        return;
    moray_orbit_free(search->orbit);
    free(search);
}

moray_orbit *moray_gait_search_orbit(const moray_gait_search *search)
{
    return search->orbit;
}

// ---- The functions -------------------------------------------------------------------------------------------------

static moray_gait gait_at(const moray_gait_search *search, const double *x)
{
    const moray_gait_problem_spec *spec = &search->spec;
    return (moray_gait){.amplitude = moray_amplitude_from_theta_max(&spec->robot, spec->model, x[0], x[2]),
                        .omega = x[1],
                        .delta = x[2]};
}

// From derivatives by (amplitude, omega, delta) at constant amplitude to those by (theta_max, omega, delta) at constant
// theta_max, by (27) or (33), times `scale`.
static void by_variables(const moray_gait_search *search, const double *x, const double *by, double scale, double *out)
{
    const double c = cos(x[2] / 2), s = sin(x[2] / 2), L = 2 * search->spec.robot.l;
    const bool revolute = search->spec.model == MORAY_FIRST_PRINCIPLES;
    const double by_theta_max = revolute ? 2 * s : L * c * cos(x[0]);
    const double by_delta = revolute ? c * x[0] : -L / 2 * s * sin(x[0]);
    if (!out)
        return;
    out[0] = scale * by[0] * by_theta_max;
    out[1] = scale * by[1];
    out[2] = scale * (by[2] + by[0] * by_delta);
}

// Where constraints go.
struct limits_writer {
    const moray_gait_search *search;
    const double *x;
    double *c, *jacobian; // jacobian NULL: not wanted
};

// (value - limit) / unit <= 0, for a value with derivatives by (amplitude, omega, delta).
static void write_limit(struct limits_writer *to, double value, const double *by, double limit, double unit)
{
    *to->c++ = (value - limit) / unit;
    by_variables(to->search, to->x, by, 1 / unit, to->jacobian);
    to->jacobian += to->jacobian ? VARIABLES : 0;
}

static void write_limits(const moray_gait_search *search, const double *x, const moray_orbit_result *at,
                         const moray_orbit_gradient *by, double *c, double *jacobian)
{
    const moray_gait_limits *limits = &search->spec.limits;
    const double amplitude = at->gait.amplitude, omega = at->gait.omega, rate[4] = {omega, amplitude, 0, 0},
                 most_rate = moray_gait_most_rate(&search->spec);
    struct limits_writer to = {search, x, c, jacobian};
    if (limited(limits->power))
        write_limit(&to, at->steady.power, by->power, limits->power, limits->power);
    if (limited(most_rate))
        write_limit(&to, amplitude * omega, rate, most_rate, most_rate);
    if (limited(limits->joint_effort))
        write_limit(&to, at->steady.peak_effort, by->peak_effort, limits->joint_effort, limits->joint_effort);
    if (has_lines(&search->spec))
        write_limit(&to, at->peak_load, by->peak_load, 1, 1);
    if (limits->course_speed > 0)
        write_limit(&to, moray_course_speed(&at->steady, search->spec.course), by->course_speed, limits->course_speed,
                    -limits->course_speed);
    if (flows(&search->spec)) {
        const double unit = search->spec.model == MORAY_FIRST_PRINCIPLES ? 1 : 2 * search->spec.robot.l;
        write_limit(&to, at->gait.offset, by->steering, limits->offset.upper, unit);
        write_limit(&to, at->gait.offset, by->steering, limits->offset.lower, -unit);
    }
}

// Minus the speed along the course, or work per distance along it.
static double write_goal(const moray_gait_search *search, const double *x, const moray_orbit_result *at,
                         const moray_orbit_gradient *by, double *gradient)
{
    const double speed = moray_course_speed(&at->steady, search->spec.course),
                 power = at->steady.power + search->spec.robot.supply.constant;
    double thrift[VARIABLES];
    if (search->spec.goal == MORAY_GAIT_FASTEST) {
        by_variables(search, x, by->course_speed, -1, gradient);
        return -speed;
    }
    for (int p = 0; p < VARIABLES; p++)
        thrift[p] = by->power[p] / speed - by->course_speed[p] * power / (speed * speed);
    by_variables(search, x, thrift, 1, gradient);
    return power / speed;
}

static bool evaluate(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    moray_gait_search *search = self;
    const moray_gait gait = gait_at(search, x);
    moray_orbit_result at;
    moray_orbit_gradient by = {0};
    if (moray_failed(moray_orbit_solve(search->orbit, &gait, &at)) ||
        (gradient && moray_failed(moray_orbit_gradients(search->orbit, &by))))
        return false;
    *f = write_goal(search, x, &at, &by, gradient);
    write_limits(search, x, &at, &by, c, jacobian);
    return true;
}

moray_status moray_gait_search_run(moray_gait_search *search, const moray_search_settings *settings, moray_gait *gait,
                                   moray_orbit_result *result, moray_search_info *info)
{
    const moray_gait_problem_spec *spec = &search->spec;
    const moray_search_problem problem = {.n = VARIABLES,
                                          .m = search->limits,
                                          .lower = search->lower,
                                          .upper = search->upper,
                                          .gradients = true,
                                          .self = search,
                                          .evaluate = evaluate};
    double x[VARIABLES] = {moray_theta_max_from_amplitude(&spec->robot, spec->model, gait->amplitude, gait->delta),
                           gait->omega, gait->delta};
    MORAY_TRY(moray_search(&problem, settings, x, info));
    *gait = gait_at(search, x);
    const moray_status status = moray_orbit_solve(search->orbit, gait, result);
    *gait = result->gait;
    return status;
}
