// SPDX-License-Identifier: MIT
//
// Derivatives by the implicit function theorem. For a quantity q(z, p) on F(z, p) = 0, with F_z^T lambda = q_z,
//     dq/dp = q_p - lambda^T F_p.
#include <math.h>
#include <string.h>

#include "control/periodic_orbit.h"

// A quantity's own derivatives: orbit->step holds q_z, `by` q_p.
static moray_status start(moray_periodic_orbit *orbit, double *by)
{
    MORAY_TRY(moray_periodic_orbit_factor(orbit));
    memset(by, 0, ((size_t)orbit->system.ns + 1) * sizeof *by);
    memset(orbit->step, 0, (size_t)orbit->system.unknowns * sizeof *orbit->step);
    return moray_ok();
}

// Leaves dq/dp in `by`.
static moray_status pull_back(moray_periodic_orbit *orbit, double *by)
{
    MORAY_TRY(moray_sparse_lu_solve_transposed(orbit->lu, 1, orbit->step));
    moray_orbit_by_parameters(&orbit->system, orbit->step, -1, by);
    return moray_ok();
}

// A parameter that is found is a component of z.
static void add_parameter(moray_periodic_orbit *orbit, int parameter, double slope, double *by)
{
    const int column = orbit->system.column[parameter];
    *(column >= 0 ? &orbit->step[column] : &by[parameter]) += slope;
}

// Adds weight times an output of slope `slope`[inputs] at time t, but for its dependence on the state; at constant
// phase t moves with the period.
static void add_direct(moray_periodic_orbit *orbit, const double *slope, double t, double weight, double *by)
{
    const orbit_system *system = &orbit->system;
    const int nx = system->nx, ns = system->ns;
    for (int k = 0; k < ns; k++)
        add_parameter(orbit, k, weight * slope[nx + k], by);
    add_parameter(orbit, ns, weight * slope[nx + ns] * t / moray_orbit_period(system), by);
}

// Adds weight times output `row` at a node.
static void add_output(moray_periodic_orbit *orbit, int node, int row, double weight, double *by)
{
    const orbit_system *system = &orbit->system;
    const double *slope = orbit_slope_at(system, node) + row * system->inputs;
    for (int r = 0; r < system->nx; r++)
        orbit->step[node * system->nx + r] += weight * slope[r];
    add_direct(orbit, slope, moray_orbit_time(system, node), weight, by);
}

// Adds weight times state r between the nodes, x_0 + h sum integral_j f_j.
static void add_state(moray_periodic_orbit *orbit, int interval, int r, double weight, double *by)
{
    const orbit_system *system = &orbit->system;
    const int points = system->scheme.points, first = interval * (points - 1);
    const double h = moray_orbit_step(system), part = moray_periodic_orbit_part(orbit, interval, r);
    orbit->step[first * system->nx + r] += weight;
    for (int j = 0; j < points; j++)
        add_output(orbit, first + j, r, weight * h * orbit->integral[j], by);
    add_parameter(orbit, system->ns, weight * part / moray_orbit_period(system), by);
}

static moray_status check_row(const moray_periodic_orbit *orbit, int row)
{
    if (row >= 0 && row < orbit->system.outputs)
        return moray_ok();
    return moray_error(MORAY_INPUT, "output %d of the plant: it has %d", row, orbit->system.outputs);
}

moray_status moray_periodic_orbit_ends_gradient(moray_periodic_orbit *orbit, const double *slope, double *by)
{
    const orbit_system *system = &orbit->system;
    const int nx = system->nx, ns = system->ns, last = (system->nodes - 1) * nx;
    MORAY_TRY(start(orbit, by));
    for (int r = 0; r < nx; r++) {
        orbit->step[r] += slope[r];
        orbit->step[last + r] += slope[nx + r];
    }
    for (int k = 0; k <= ns; k++)
        add_parameter(orbit, k, slope[2 * nx + k], by);
    for (int k = 0; k < system->nw; k++)
        orbit->step[system->unknowns - system->nw + k] += slope[2 * nx + ns + 1 + k];
    return pull_back(orbit, by);
}

// Mean over the intervals of sum b_j g_j.
moray_status moray_periodic_orbit_mean_gradient(moray_periodic_orbit *orbit, int row, double *by)
{
    const orbit_system *system = &orbit->system;
    const moray_scheme *scheme = &system->scheme;
    MORAY_TRY(check_row(orbit, row));
    MORAY_TRY(start(orbit, by));
    for (int k = 0; k < system->intervals; k++)
        for (int j = 0; j < scheme->points; j++)
            add_output(orbit, k * (scheme->points - 1) + j, row, scheme->b[j] / system->intervals, by);
    return pull_back(orbit, by);
}

static moray_status check_time(const moray_periodic_orbit *orbit, double t)
{
    const double T = moray_orbit_period(&orbit->system);
    if (t >= 0 && t <= T)
        return moray_ok();
    return moray_error(MORAY_INPUT, "t = %g: must lie between 0 and the period, %g", t, T);
}

moray_status moray_periodic_orbit_point_gradient(moray_periodic_orbit *orbit, const double *slope, double t, double *by)
{
    MORAY_TRY(start(orbit, by));
    MORAY_TRY(check_time(orbit, t));
    const int interval = moray_periodic_orbit_locate(orbit, t);
    add_direct(orbit, slope, t, 1, by);
    for (int r = 0; r < orbit->system.nx; r++)
        add_state(orbit, interval, r, slope[r], by);
    return pull_back(orbit, by);
}

moray_status moray_periodic_orbit_output_gradient(moray_periodic_orbit *orbit, int row, double t, double *by)
{
    orbit_system *system = &orbit->system;
    MORAY_TRY(check_row(orbit, row));
    MORAY_TRY(start(orbit, by));
    MORAY_TRY(check_time(orbit, t));
    moray_periodic_orbit_state(orbit, t, orbit->x);
    moray_orbit_plant_slope(system, orbit->x, t, orbit->slope);
    return moray_periodic_orbit_point_gradient(orbit, orbit->slope + row * system->inputs, t, by);
}
