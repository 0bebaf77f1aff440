// SPDX-License-Identifier: MIT
//
// Derivatives by the implicit function theorem. For a quantity q(z, p) on F(z, p) = 0, with F_z^T lambda = q_z,
//     dq/dp = q_p - lambda^T F_p.
#include <math.h>
#include <string.h>

#include "snake/swim/orbit.h"

// orbit->step holds q_z, `by` q_p; leaves dq/dp in `by`.
static moray_status pull_back(moray_orbit *orbit, double by[ORBIT_PARAMETERS])
{
    double through[ORBIT_PARAMETERS];
    MORAY_TRY(moray_sparse_lu_solve_transposed(orbit->lu, 1, orbit->step));
    moray_orbit_by_parameters(&orbit->system, orbit->step, through);
    for (int p = 0; p < ORBIT_PARAMETERS; p++)
        by[p] -= through[p];
    return moray_ok();
}

static double *start(moray_orbit *orbit, double by[ORBIT_PARAMETERS])
{
    memset(by, 0, ORBIT_PARAMETERS * sizeof *by);
    return memset(orbit->step, 0, (size_t)orbit->system.unknowns * sizeof *orbit->step);
}

// Adds weight times output `row` at a node, of the given slope, to q_z and q_p.
static void add_output(moray_orbit *orbit, const double *slope, int node, int row, double weight,
                       double by[ORBIT_PARAMETERS])
{
    const orbit_system *system = &orbit->system;
    double direct[ORBIT_PARAMETERS];
    for (int r = 0; r < ORBIT_STATES; r++)
        orbit->step[node * ORBIT_STATES + r] += weight * slope[row * ORBIT_INPUTS + r];
    if (system->spec.steered)
        orbit->step[system->unknowns - 1] += weight * slope[row * ORBIT_INPUTS + ORBIT_OFFSET_INPUT];
    moray_orbit_output_by_parameters(system, slope, row, moray_orbit_time(system, node), direct);
    for (int p = 0; p < ORBIT_PARAMETERS; p++)
        by[p] += weight * direct[p];
}

static const double *slope_at(const orbit_system *system, int node)
{
    return system->slope + node * system->outputs * ORBIT_INPUTS;
}

static moray_status course_speed_gradient(moray_orbit *orbit, double by[ORBIT_PARAMETERS])
{
    const orbit_system *system = &orbit->system;
    const double T = moray_orbit_period(system), course[2] = {cos(system->spec.course), sin(system->spec.course)};
    const int last = (system->nodes - 1) * ORBIT_STATES;
    double *q_z = start(orbit, by);
    for (int k = 0; k < 2; k++) {
        q_z[last + 1 + k] = course[k] / T;
        q_z[1 + k] = -course[k] / T;
        by[ORBIT_OMEGA] += course[k] * (orbit->z[last + 1 + k] - orbit->z[1 + k]) / (2 * M_PI);
    }
    return pull_back(orbit, by);
}

// Mean over the intervals of sum b_j g_j.
static moray_status power_gradient(moray_orbit *orbit, double by[ORBIT_PARAMETERS])
{
    const orbit_system *system = &orbit->system;
    const moray_scheme *scheme = &system->scheme;
    start(orbit, by);
    for (int k = 0; k < system->spec.intervals; k++)
        for (int j = 0; j < scheme->points; j++) {
            const int node = k * (scheme->points - 1) + j;
            add_output(orbit, slope_at(system, node), node, system->power, scheme->b[j] / system->spec.intervals, by);
        }
    return pull_back(orbit, by);
}

static moray_status steering_gradient(moray_orbit *orbit, double by[ORBIT_PARAMETERS])
{
    start(orbit, by)[orbit->system.unknowns - 1] = 1;
    return pull_back(orbit, by);
}

// Adds weight times state r between the nodes, x_0 + h sum integral_j f_j, to q_z and q_p.
static void add_state(moray_orbit *orbit, int interval, int r, double weight, double by[ORBIT_PARAMETERS])
{
    const orbit_system *system = &orbit->system;
    const int points = system->scheme.points, first = interval * (points - 1);
    const double h = moray_orbit_step(system);
    orbit->step[first * ORBIT_STATES + r] += weight;
    for (int j = 0; j < points; j++)
        add_output(orbit, slope_at(system, first + j), first + j, r, weight * h * orbit->integral[j], by);
    by[ORBIT_OMEGA] -= weight * moray_orbit_integral(orbit, interval, r) / system->parameters[ORBIT_OMEGA];
}

// At the phase of the largest sample; how that phase shifts with the gait has no say where it is a maximum.
static moray_status peak_effort_gradient(moray_orbit *orbit, double by[ORBIT_PARAMETERS])
{
    const orbit_system *system = &orbit->system;
    const orbit_peak *peak = &orbit->peak;
    const int row = ORBIT_STATES + peak->joint, interval = moray_orbit_locate(orbit, peak->time);
    const double sign = peak->negative ? -1 : 1;
    double x[ORBIT_STATES], in[ORBIT_INPUTS], direct[ORBIT_PARAMETERS];
    moray_orbit_state(orbit, interval, x);
    moray_orbit_input(system, orbit->z, x, peak->time, in);
    moray_orbit_plant_slope(&orbit->system, in, orbit->slope);
    double *q_z = start(orbit, by);
    const double *slope = orbit->slope + row * ORBIT_INPUTS;
    if (system->spec.steered)
        q_z[system->unknowns - 1] = sign * slope[ORBIT_OFFSET_INPUT];
    moray_orbit_output_by_parameters(system, orbit->slope, row, peak->time, direct);
    for (int p = 0; p < ORBIT_PARAMETERS; p++)
        by[p] = sign * direct[p];
    for (int r = 0; r < ORBIT_STATES; r++)
        add_state(orbit, interval, r, sign * slope[r], by);
    return pull_back(orbit, by);
}

moray_status moray_orbit_gradients(moray_orbit *orbit, moray_orbit_gradient *gradient)
{
    MORAY_TRY(moray_orbit_factor(orbit));
    MORAY_TRY(course_speed_gradient(orbit, gradient->course_speed));
    MORAY_TRY(power_gradient(orbit, gradient->power));
    MORAY_TRY(peak_effort_gradient(orbit, gradient->peak_effort));
    return steering_gradient(orbit, gradient->steering);
}
