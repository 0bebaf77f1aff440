// SPDX-License-Identifier: MIT
#include "moray/gait_problem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/gait_endpoint.h"

struct moray_gait_problem {
    moray_gait_problem_spec spec;
    moray_plant_size size;
    moray_map plant, ends;
    struct gait_endpoint endpoint;
    moray_bounds *block; // x, x0, c, e in turn
    moray_ocp *ocp;
};

moray_gait moray_gait_from_parameters(const double s[MORAY_GAIT_PARAMETERS])
{
    return (moray_gait){.amplitude = s[0], .omega = s[1], .delta = s[2], .offset = s[3], .taper = s[4]};
}

void moray_gait_to_parameters(const moray_gait *gait, double s[MORAY_GAIT_PARAMETERS])
{
    const double parameters[] = {gait->amplitude, gait->omega, gait->delta, gait->offset, gait->taper};
    memcpy(s, parameters, sizeof parameters);
}

static moray_status check_range(const char *name, moray_bounds range, double least, double most, double unit)
{
    if (!(range.lower <= range.upper) || range.lower < least || range.upper > most)
        return moray_error(MORAY_INPUT, "%s = %g:%g: must be a range lo:hi within %g:%g", name, range.lower / unit,
                           range.upper / unit, least / unit, most / unit);
    return moray_ok();
}

static moray_status check_limit(const char *name, double value)
{
    if (!(value > 0))
        return moray_error(MORAY_INPUT, "%s = %g: must be above 0, or none", name, value);
    return moray_ok();
}

static moray_status check_spec(const moray_gait_problem_spec *spec)
{
    const double degree = M_PI / 180;
    const moray_gait_limits *limits = &spec->limits;
    MORAY_TRY(moray_robot_check(&spec->robot));
    if (spec->joints == MORAY_JOINTS_FREE)
        return moray_error(MORAY_INPUT, "joints = free: an optimal gait has its joints on the gait or in closed loop");
    const bool control = spec->model == MORAY_CONTROL_ORIENTED;
    if (!control && spec->joints != MORAY_JOINTS_ON_GAIT)
        return moray_error(MORAY_INPUT, "joints: the first-principles model has its joints on the gait");
    MORAY_TRY(check_range("theta_max_deg", limits->theta_max, 0, 89 * degree, degree));
    MORAY_TRY(check_range("omega_deg_s", limits->omega, 1e-3 * degree, 1e5 * degree, degree));
    MORAY_TRY(check_range("delta_deg", limits->delta, 1 * degree, 179 * degree, degree));
    if (control)
        MORAY_TRY(check_range("phi0_m", limits->offset, -spec->robot.l, spec->robot.l, 1));
    else
        MORAY_TRY(check_range("phi0_deg", limits->offset, -90 * degree, 90 * degree, degree));
    const double most = spec->robot.links > 2 ? 1 : 0; // a joint alone has no taper
    MORAY_TRY(check_range("taper", limits->taper, 0 - most, most, 1));
    MORAY_TRY(check_limit("power_W", limits->power));
    MORAY_TRY(check_limit("joint_rate", limits->joint_rate));
    MORAY_TRY(check_limit("joint_effort", limits->joint_effort));
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

static moray_status make_plant(moray_gait_problem *problem)
{
    const moray_gait_problem_spec *spec = &problem->spec;
    const moray_plant_spec plant = {.robot = spec->robot,
                                    .joints = spec->joints,
                                    .current = {spec->current[0], spec->current[1]},
                                    .path_forces = limited(spec->limits.joint_effort),
                                    .path_angles = spec->model == MORAY_CONTROL_ORIENTED &&
                                                   (spec->limits.offset.lower != 0 || spec->limits.offset.upper != 0)};
    problem->size = moray_plant_sizes(&plant);
    return spec->model == MORAY_CONTROL_ORIENTED ? moray_control_plant(&problem->plant, &plant)
                                                 : moray_complex_plant(&problem->plant, &plant);
}

static moray_status make_endpoint(moray_gait_problem *problem)
{
    const moray_gait_problem_spec *spec = &problem->spec;
    const int joints = spec->joints == MORAY_JOINTS_ON_GAIT ? 0 : spec->robot.links - 1;
    problem->endpoint = (struct gait_endpoint){
        .nx = problem->size.nx,
        .position = joints + 1,
        .revolute = spec->model == MORAY_FIRST_PRINCIPLES,
        .L = 2 * spec->robot.l,
        .links = spec->robot.links,
        .head = spec->limits.taper.upper > 0,
        .tail = spec->limits.taper
                    .lower<0, .course = {cos(spec->course), sin(spec->course)}, .power = limited(spec->limits.power),
                           .goal = spec->goal, .rate = limited(spec->limits.joint_rate), .speed = least_speed(spec)> 0};
    return gait_endpoint_map(&problem->ends, &problem->endpoint);
}

static void fill_path_bounds(const moray_gait_problem *problem, moray_bounds *c)
{
    const moray_gait_limits *limits = &problem->spec.limits;
    const int forces = limited(limits->joint_effort) ? problem->spec.robot.links - 1 : 0;
    for (int i = 0; i < problem->size.nc; i++)
        c[i] = i < forces ? moray_between(-limits->joint_effort, limits->joint_effort)
                          : moray_between(-limits->theta_max.upper, limits->theta_max.upper);
}

static void fill_event_bounds(const moray_gait_problem *problem, moray_bounds *e)
{
    const moray_gait_limits *limits = &problem->spec.limits;
    for (int i = 0; i < problem->size.nx - 2 + 1; i++)
        *e++ = moray_fixed(0);
    *e++ = moray_fixed(2 * M_PI);
    const struct gait_endpoint *endpoint = &problem->endpoint;
    const moray_bounds amplitude = gait_amplitude_bounds(endpoint, limits->theta_max);
    *e++ = amplitude;
    for (int k = 0; k < endpoint->head + endpoint->tail; k++)
        *e++ = moray_at_most(amplitude.upper * amplitude.upper);
    if (endpoint->power)
        *e++ = moray_at_most(limits->power);
    for (int k = 0; k < (endpoint->head && endpoint->tail ? 2 : 1) && endpoint->rate; k++)
        *e++ = moray_at_most(limits->joint_rate);
    if (endpoint->speed)
        *e++ = moray_at_least(least_speed(&problem->spec));
}

static const char *const goals[][2] = {
    [MORAY_GAIT_FASTEST] = {"fastest gait, control-oriented", "fastest gait, first principles"},
    [MORAY_GAIT_THRIFTIEST] = {"thriftiest gait, control-oriented", "thriftiest gait, first principles"}};
static const char *const s_names[][MORAY_GAIT_PARAMETERS] = {{"a", "omega", "delta", "phi_0", "taper"},
                                                             {"alpha", "omega", "delta", "phi_0", "taper"}};
static const char *const gait_states[][6] = {{"theta", "p_x", "p_y", "v_theta", "v_t", "v_n"},
                                             {"theta", "p_x", "p_y", "v_theta", "v_x", "v_y"}};

static moray_status make_ocp(moray_gait_problem *problem)
{
    const moray_gait_limits *limits = &problem->spec.limits;
    const int nx = problem->size.nx, nc = problem->size.nc, ne = problem->endpoint.events,
              at = problem->endpoint.position;
    problem->block = calloc((size_t)(nx + nc + ne), sizeof *problem->block);
    if (!problem->block)
        return moray_error(MORAY_MEMORY, "no memory for the gait problem");
    moray_bounds *x0 = problem->block, *c = x0 + nx, *e = c + nc;
    for (int r = 0; r < nx; r++)
        x0[r] = r == at || r == at + 1 ? moray_fixed(0) : moray_free();
    fill_path_bounds(problem, c);
    fill_event_bounds(problem, e);
    const bool control = problem->spec.model == MORAY_CONTROL_ORIENTED;
    const double largest = control ? 2 * problem->spec.robot.l * sin(limits->theta_max.upper) // of a, by (33)
                                   : 2 * limits->theta_max.upper;                             // of alpha, by (27)
    const moray_bounds s[] = {moray_between(0, largest), limits->omega, limits->delta, limits->offset, limits->taper};
    const moray_phase_spec phase = {
        .name = "period",
        .nx = nx,
        .nc = nc,
        .nq = problem->size.nq,
        .map = &problem->plant,
        .t0 = moray_fixed(0),
        .tf = moray_between(2 * M_PI / limits->omega.upper, 2 * M_PI / limits->omega.lower),
        .x0 = {x0, nx},
        .c = {c, nc},
        .x_names = problem->spec.joints == MORAY_JOINTS_ON_GAIT ? gait_states[problem->spec.model] : NULL,
    };
    return moray_ocp_new(&problem->ocp, &(moray_ocp_spec){.name = goals[problem->spec.goal][problem->spec.model],
                                                          .phases = 1,
                                                          .phase = &phase,
                                                          .ns = MORAY_GAIT_PARAMETERS,
                                                          .s = {s, MORAY_GAIT_PARAMETERS},
                                                          .s_names = s_names[problem->spec.model],
                                                          .ne = ne,
                                                          .e = {e, ne},
                                                          .endpoint_map = &problem->ends});
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
    if (!moray_failed(status))
        status = make_endpoint(problem);
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
    gait_endpoint_free(&problem->endpoint);
    free(problem->block);
    free(problem);
}

const moray_ocp *moray_gait_problem_ocp(const moray_gait_problem *problem)
{
    return problem->ocp;
}

moray_gait_promise moray_gait_problem_promise(const moray_gait_problem *problem, const moray_solution *solution)
{
    const moray_gait_problem_spec *spec = &problem->spec;
    const int at = problem->endpoint.position;
    double t0, tf, x[6 + 2 * 512];
    moray_gait_promise promise = {.gait = moray_gait_from_parameters(moray_solution_parameters(solution))};
    moray_solution_times(solution, 0, &t0, &tf);
    moray_solution_at(solution, 0, tf, x, NULL);
    promise.v_x = x[at] / tf;
    promise.v_y = x[at + 1] / tf;
    promise.speed = hypot(promise.v_x - spec->current[0], promise.v_y - spec->current[1]);
    promise.course_speed = promise.v_x * cos(spec->course) + promise.v_y * sin(spec->course);
    promise.power = moray_solution_integrals(solution, 0)[0] / tf;
    if (problem->endpoint.power)
        promise.power_price = moray_solution_event_multipliers(solution)[problem->endpoint.power_event];
    return promise;
}

// The plant's state from the swimmer's.
static void plant_state(const moray_gait_problem *problem, const double *full, double *x)
{
    if (problem->spec.joints != MORAY_JOINTS_ON_GAIT) {
        memcpy(x, full, (size_t)problem->size.nx * sizeof *x);
        return;
    }
    moray_state_body(problem->spec.model, problem->spec.robot.links, full, x);
}

moray_status moray_gait_problem_solve(const moray_gait_problem *problem, const moray_settings *settings,
                                      const moray_gait *gait, const moray_swim_track *orbit, moray_solution **solution)
{
    const int nx = problem->size.nx;
    double s[MORAY_GAIT_PARAMETERS], *x = calloc((size_t)(orbit->n * nx) + 1, sizeof *x);
    if (!x)
        return moray_error(MORAY_MEMORY, "no memory for a guess of %d samples", orbit->n);
    for (int k = 0; k < orbit->n; k++)
        plant_state(problem, orbit->x + k * orbit->n_states, x + k * nx);
    moray_gait_to_parameters(gait, s);
    const moray_samples samples = {.n = orbit->n, .time = orbit->t, .x = x};
    const moray_guess guess = {.phase = &samples, .s = s};
    moray_status status = moray_solve(problem->ocp, settings, &guess, solution);
    free(x);
    return status;
}
