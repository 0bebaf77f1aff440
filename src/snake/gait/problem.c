// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/angle.h"
#include "snake/gait/problem.h"
#include "snake/swim/limits.h"

moray_gait moray_gait_from_parameters(const double s[MORAY_GAIT_PARAMETERS])
{
    return (moray_gait){.amplitude = s[0], .omega = s[1], .delta = s[2], .offset = s[3], .taper = s[4]};
}

void moray_gait_to_parameters(const moray_gait *gait, double s[MORAY_GAIT_PARAMETERS])
{
    const double parameters[] = {gait->amplitude, gait->omega, gait->delta, gait->offset, gait->taper};
    memcpy(s, parameters, sizeof parameters);
}

static moray_status check_spec(const moray_gait_problem_spec *spec)
{
    const moray_gait_limits *limits = &spec->limits;
    MORAY_TRY(moray_robot_check(&spec->robot));
    if (spec->joints == MORAY_JOINTS_FREE)
        return moray_error(MORAY_INPUT,
                           "joints = free: an optimal gait has its joints on the gait, on a series or in closed loop");
    const bool control = spec->model == MORAY_CONTROL_ORIENTED;
    if (!control && spec->joints == MORAY_JOINTS_CLOSED_LOOP)
        return moray_error(MORAY_INPUT, "joints: the first-principles model has none in closed loop");
    MORAY_TRY(moray_limits_check_gait(limits->theta_max, limits->omega, limits->delta));
    if (control)
        MORAY_TRY(moray_limits_check_range("phi0_m", limits->offset, -spec->robot.l, spec->robot.l, 1));
    else
        MORAY_TRY(
            moray_limits_check_range("phi0_deg", limits->offset, -90 * MORAY_DEGREE, 90 * MORAY_DEGREE, MORAY_DEGREE));
    const double most = spec->robot.links > 2 ? 1 : 0; // a joint alone has no taper
    MORAY_TRY(moray_limits_check_range("taper", limits->taper, 0 - most, most, 1));
    MORAY_TRY(moray_limits_check_above_zero("power_W", limits->power));
    MORAY_TRY(moray_limits_check_above_zero("joint_rate", limits->joint_rate));
    MORAY_TRY(moray_limits_check_above_zero("joint_effort", limits->joint_effort));
    if (!(limits->course_speed >= 0 && isfinite(limits->course_speed)))
        return moray_error(MORAY_INPUT, "speed_m_s = %g: must be finite and above 0, or none", limits->course_speed);
    if (!isfinite(spec->current[0]) || !isfinite(spec->current[1]) || !isfinite(spec->course))
        return moray_error(MORAY_INPUT, "current = %g,%g, course = %g: must be finite", spec->current[0],
                           spec->current[1], spec->course);
    return moray_ok();
}

static bool limited(double value)
{
    return value < MORAY_INFINITY;
}

// The least speed to ask for; work per distance means nothing where the robot makes no way.
static double least_speed(const moray_gait_problem_spec *spec)
{
    const double some_way = 1e-3;
    return spec->goal == MORAY_GAIT_THRIFTIEST ? fmax(spec->limits.course_speed, some_way) : spec->limits.course_speed;
}

static bool on_series(const moray_gait_problem *problem)
{
    return problem->spec.joints == MORAY_JOINTS_SERIES;
}

// Whether theta_max bounds the links' angles in place of their amplitude.
static bool by_link_angles(const moray_gait_problem *problem)
{
    return on_series(problem) || problem->spec.limits.link_angles;
}

// Whether the links' angles have limits that the amplitude's do not imply.
static bool angles_limited(const moray_gait_problem *problem)
{
    const moray_bounds offset = problem->spec.limits.offset;
    return by_link_angles(problem) ||
           (problem->spec.model == MORAY_CONTROL_ORIENTED && (offset.lower != 0 || offset.upper != 0));
}

// Whether link angles are known in closed form, by the gait alone.
static bool angles_as_events(const moray_gait_problem *problem)
{
    return angles_limited(problem) && problem->spec.model == MORAY_CONTROL_ORIENTED &&
           problem->spec.joints == MORAY_JOINTS_ON_GAIT;
}

static int supply_lines(const moray_gait_problem *problem)
{
    return problem->spec.model == MORAY_FIRST_PRINCIPLES ? problem->spec.robot.motor.lines : 0;
}

double moray_gait_most_rate(const moray_gait_problem_spec *spec)
{
    const double limit = spec->limits.joint_rate, rate = spec->robot.supply.rate;
    return spec->model == MORAY_FIRST_PRINCIPLES && rate > 0 ? fmin(limit, rate) : limit;
}

static moray_status make_plant(moray_gait_problem *problem)
{
    const moray_gait_problem_spec *spec = &problem->spec;
    const moray_plant_spec plant = {.robot = spec->robot,
                                    .joints = spec->joints,
                                    .current = {spec->current[0], spec->current[1]},
                                    .path_forces = limited(spec->limits.joint_effort),
                                    .path_supply = supply_lines(problem) > 0,
                                    .path_angles = angles_limited(problem) && !angles_as_events(problem),
                                    .path_rates = on_series(problem) && limited(moray_gait_most_rate(&problem->spec)),
                                    .harmonics = spec->harmonics};
    problem->size = moray_plant_sizes(&plant);
    return spec->model == MORAY_CONTROL_ORIENTED ? moray_control_plant(&problem->plant, &plant)
                                                 : moray_fp_plant(&problem->plant, &plant);
}

static void make_endpoint(moray_gait_problem *problem)
{
    const moray_gait_problem_spec *spec = &problem->spec;
    const int joints = spec->joints == MORAY_JOINTS_CLOSED_LOOP ? spec->robot.links - 1 : 0;
    const bool series = on_series(problem), angles = angles_as_events(problem);
    const bool turns_right = spec->limits.offset.lower < 0;
    problem->endpoint = (struct gait_endpoint){.nx = problem->size.nx,
                                               .position = joints + 1,
                                               .revolute = spec->model == MORAY_FIRST_PRINCIPLES,
                                               .L = 2 * spec->robot.l,
                                               .links = spec->robot.links,
                                               .series = series ? problem->size.ns : 0,
                                               .head = !series && spec->limits.taper.upper > 0,
                                               .tail = !series && spec->limits.taper.lower < 0,
                                               .course = {cos(spec->course), sin(spec->course)},
                                               .goal = spec->goal,
                                               .power = limited(spec->limits.power),
                                               .rate = !series && limited(moray_gait_most_rate(&problem->spec)),
                                               .speed = least_speed(spec) > 0,
                                               .left = angles && (spec->limits.offset.upper > 0 || !turns_right),
                                               .right = angles && turns_right,
                                               .constant = spec->robot.supply.constant};
}

static int path_efforts(const moray_gait_problem *problem)
{
    return limited(problem->spec.limits.joint_effort) ? problem->spec.robot.links - 1 : 0;
}

static void fill_path_bounds(const moray_gait_problem *problem, moray_bounds *c)
{
    const moray_gait_limits *limits = &problem->spec.limits;
    const int joints = problem->spec.robot.links - 1, efforts = path_efforts(problem);
    const int supply = efforts + supply_lines(problem) * joints;
    const int angles = supply + problem->spec.robot.links;
    for (int i = 0; i < problem->size.nc; i++) {
        const double most = i < efforts  ? limits->joint_effort
                            : i < supply ? problem->spec.robot.motor.torque[(i - efforts) / joints]
                            : i < angles ? limits->theta_max.upper
                                         : moray_gait_most_rate(&problem->spec);
        c[i] = moray_between(-most, most);
    }
}

static void fill_event_bounds(const moray_gait_problem *problem, moray_bounds *e)
{
    const moray_bounds *end = e + moray_gait_events(&problem->endpoint);
    const moray_gait_limits *limits = &problem->spec.limits;
    for (int i = 0; i < problem->size.nx - 2 + 1; i++)
        *e++ = moray_fixed(0);
    *e++ = moray_fixed(2 * M_PI);
    const struct gait_endpoint *endpoint = &problem->endpoint;
    const moray_bounds amplitude = moray_gait_amplitude_bounds(
        endpoint, limits->link_angles ? moray_between(limits->theta_max.lower, M_PI / 2) : limits->theta_max);
    if (!endpoint->series)
        *e++ = amplitude;
    for (int k = 0; k < endpoint->head + endpoint->tail; k++)
        *e++ = moray_at_most(amplitude.upper * amplitude.upper);
    if (endpoint->power)
        *e++ = moray_at_most(limits->power);
    for (int k = 0; k < (endpoint->head && endpoint->tail ? 2 : 1) && endpoint->rate; k++)
        *e++ = moray_at_most(moray_gait_most_rate(&problem->spec));
    if (endpoint->speed)
        *e++ = moray_at_least(least_speed(&problem->spec));
    while (e < end)
        *e++ = moray_at_most(limits->theta_max.upper);
}

static const char *const goals[][2] = {
    [MORAY_GAIT_FASTEST] = {"fastest gait, control-oriented", "fastest gait, first principles"},
    [MORAY_GAIT_THRIFTIEST] = {"thriftiest gait, control-oriented", "thriftiest gait, first principles"}};
static const char *const s_names[][MORAY_GAIT_PARAMETERS] = {{"a", "omega", "delta", "phi_0", "taper"},
                                                             {"alpha", "omega", "delta", "phi_0", "taper"}};
static const char *const gait_states[][MORAY_BODY_STATES] = {{"theta", "p_x", "p_y", "v_theta", "v_t", "v_n"},
                                                             {"theta", "p_x", "p_y", "v_theta", "v_x", "v_y"}};

// Bounds of the parameters, s[ns].
static void fill_parameter_bounds(const moray_gait_problem *problem, moray_bounds *s)
{
    const moray_gait_limits *limits = &problem->spec.limits;
    const int n = problem->spec.robot.links - 1;
    const double swing = problem->spec.model == MORAY_CONTROL_ORIENTED
                             ? 2 * problem->spec.robot.l * sin(limits->theta_max.upper) // of a, by (33)
                             : 2 * limits->theta_max.upper;                             // of alpha, by (27)
    const double largest = by_link_angles(problem) ? 2 * swing : swing;
    if (!on_series(problem)) {
        const moray_bounds all[] = {moray_between(0, largest), limits->omega, limits->delta, limits->offset,
                                    limits->taper};
        memcpy(s, all, sizeof all);
        return;
    }
    s[0] = limits->omega;
    for (int i = 1; i < problem->size.ns; i++)
        s[i] = i <= n ? limits->offset : moray_between(-largest, largest);
    s[1 + 2 * n] = moray_fixed(0); // q_11
}

// The period as a phase, its events and the parameters.
static moray_status describe(moray_gait_problem *problem)
{
    const moray_gait_limits *limits = &problem->spec.limits;
    const int nx = problem->size.nx, nc = problem->size.nc, ne = moray_gait_events(&problem->endpoint),
              ns = problem->size.ns, at = problem->endpoint.position;
    problem->block = calloc((size_t)(nx + nc + ne + ns), sizeof *problem->block);
    problem->names = calloc((size_t)(ne + nc), sizeof *problem->names);
    problem->path_names = calloc((size_t)(nc + ne), sizeof *problem->path_names);
    if (!problem->block || !problem->names || !problem->path_names)
        return moray_error(MORAY_MEMORY, "no memory for the gait problem");
    moray_bounds *x0 = problem->block, *c = x0 + nx, *e = c + nc, *s = e + ne;
    for (int r = 0; r < nx; r++)
        x0[r] = r == at || r == at + 1 ? moray_fixed(0) : moray_free();
    fill_path_bounds(problem, c);
    fill_event_bounds(problem, e);
    fill_parameter_bounds(problem, s);
    moray_gait_event_names(&problem->endpoint, problem->path_names + nc, problem->names);
    moray_gait_path_names(nc, path_efforts(problem), supply_lines(problem), problem->spec.robot.links,
                          problem->path_names, problem->names + ne);
    problem->phase = (moray_phase_spec){
        .name = "period",
        .nx = nx,
        .nc = nc,
        .nq = problem->size.nq,
        .map = &problem->plant,
        .t0 = moray_fixed(0),
        .tf =
            moray_between(1.8 * M_PI / limits->omega.upper, 2.2 * M_PI / limits->omega.lower), // omega alone is to bind
        .x0 = {x0, nx},
        .c = {c, nc},
        .c_names = problem->names + ne,
        .x_names = problem->spec.joints == MORAY_JOINTS_CLOSED_LOOP ? NULL : gait_states[problem->spec.model],
    };
    problem->e = (moray_bounds_list){e, ne};
    problem->s = (moray_bounds_list){s, ns};
    return moray_ok();
}

static moray_status make_ocp(moray_gait_problem *problem)
{
    return moray_ocp_new(&problem->ocp,
                         &(moray_ocp_spec){.name = goals[problem->spec.goal][problem->spec.model],
                                           .phases = 1,
                                           .phase = &problem->phase,
                                           .ns = problem->s.n,
                                           .s = problem->s,
                                           .s_names = on_series(problem) ? NULL : s_names[problem->spec.model],
                                           .ne = problem->e.n,
                                           .e = problem->e,
                                           .e_names = problem->names,
                                           .endpoint = moray_gait_ends,
                                           .data = &problem->endpoint});
}

moray_status moray_gait_problem_new(moray_gait_problem **result, const moray_gait_problem_spec *spec)
{
    *result = NULL;
    MORAY_TRY(check_spec(spec));
    moray_gait_problem *problem = calloc(1, sizeof *problem);
    if (!problem)
        return moray_error(MORAY_MEMORY, "no memory for the gait problem");
    problem->spec = *spec;
    moray_status status = make_plant(problem);
    make_endpoint(problem);
    if (!moray_failed(status))
        status = describe(problem);
    if (!moray_failed(status))
        status = make_ocp(problem);
    if (moray_failed(status))
        moray_gait_problem_free(problem);
    else
        *result = problem;
    return status;
}

void moray_gait_problem_free(moray_gait_problem *problem)
{
    if (!problem)
        return;
    moray_ocp_free(problem->ocp);
    moray_map_release(&problem->plant);
    free(problem->block);
    free(problem->names);
    free(problem->path_names);
    free(problem);
}

const moray_ocp *moray_gait_problem_ocp(const moray_gait_problem *problem)
{
    return problem->ocp;
}
