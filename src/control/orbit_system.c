// SPDX-License-Identifier: MIT
#include "control/orbit_system.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

double moray_orbit_period(const orbit_system *system)
{
    return system->p[system->ns];
}

double moray_orbit_step(const orbit_system *system)
{
    return moray_orbit_period(system) / system->intervals;
}

double moray_orbit_time(const orbit_system *system, int node)
{
    const int inner = system->scheme.points - 1;
    return (node / inner + system->scheme.node[node % inner]) * moray_orbit_step(system);
}

static const double *outputs_at(const orbit_system *system, int node)
{
    return system->out + node * system->outputs;
}

// ---- Evaluation ----------------------------------------------------------------------------------------------------

static void read_parameters(orbit_system *system, const double *z)
{
    for (int k = 0; k < system->n_found; k++)
        system->p[system->found[k]] = z[system->column[system->found[k]]];
}

static void set_input(orbit_system *system, const double *x, double t)
{
    memcpy(system->in, x, (size_t)system->nx * sizeof *x);
    memcpy(system->in + system->nx, system->p, (size_t)system->ns * sizeof *x);
    system->in[system->nx + system->ns] = t;
}

static void set_ends(orbit_system *system, const double *z)
{
    const size_t nx = (size_t)system->nx, np = (size_t)system->ns + 1, nw = (size_t)system->nw;
    memcpy(system->in, z, nx * sizeof *z);
    memcpy(system->in + nx, z + (system->nodes - 1) * system->nx, nx * sizeof *z);
    memcpy(system->in + 2 * nx, system->p, np * sizeof *z);
    memcpy(system->in + 2 * nx + np, z + system->unknowns - system->nw, nw * sizeof *z);
}

// Calls of one interval's defects: row i of the scheme takes node j of interval k with P and h Q.
#define FOR_DEFECTS(system, k, i, j)                                                                                   \
    for (int k = 0; k < (system)->intervals; k++)                                                                      \
        for (int i = 0; i < (system)->scheme.points - 1; i++)                                                          \
            for (int j = 0; j < (system)->scheme.points; j++)

static void defects(const orbit_system *system, const double *z, double *F)
{
    const moray_scheme *scheme = &system->scheme;
    const int inner = scheme->points - 1, nx = system->nx;
    const double h = moray_orbit_step(system);
    memset(F, 0, (size_t)((system->nodes - 1) * nx) * sizeof *F);
    FOR_DEFECTS(system, k, i, j)
    {
        const double P = scheme->P[i * scheme->points + j], hQ = h * scheme->Q[i * scheme->points + j];
        const double *x = z + (k * inner + j) * nx, *f = outputs_at(system, k * inner + j);
        for (int r = 0; r < nx; r++)
            F[(k * inner + i) * nx + r] += P * x[r] - hQ * f[r];
    }
}

bool moray_orbit_residual(orbit_system *system, const double *z, double *F)
{
    read_parameters(system, z);
    if (!(moray_orbit_period(system) > 0))
        return false;
    for (int node = 0; node < system->nodes; node++) {
        set_input(system, z + node * system->nx, moray_orbit_time(system, node));
        system->plant->value(system->plant->self, system->in, system->out + node * system->outputs);
    }
    defects(system, z, F);
    set_ends(system, z);
    system->closing->value(system->closing->self, system->in, F + (system->nodes - 1) * system->nx);
    return moray_all_finite(F, system->unknowns);
}

void moray_orbit_plant_slope(orbit_system *system, const double *x, double t, double *slope)
{
    const moray_pattern *jac = &system->plant->jac;
    set_input(system, x, t);
    system->plant->jacobian(system->plant->self, system->in, system->sparse);
    memset(slope, 0, (size_t)(system->outputs * system->inputs) * sizeof *slope);
    for (int e = 0; e < jac->nnz; e++)
        slope[jac->row[e] * system->inputs + jac->col[e]] = system->sparse[e];
}

// ---- Jacobian ------------------------------------------------------------------------------------------------------

// -h Q df/dz of one node in one defect, times move with the period: dt/dT = t/T and dh/dT = h/T.
static void walk_slope(const orbit_system *system, int row, int node, double hQ, triplets *out)
{
    const int nx = system->nx, period = system->column[system->ns];
    const moray_pattern *jac = &system->plant->jac;
    const double *slope = orbit_slope_at(system, node), T = moray_orbit_period(system);
    for (int e = 0; e < jac->nnz; e++) {
        const int r = jac->row[e], c = jac->col[e], time = nx + system->ns;
        const double entry = -hQ * slope[r * system->inputs + c];
        const int column = c < nx ? node * nx + c : system->column[c - nx];
        if (r < nx && column >= 0)
            triplets_put(out, row + r, column, c == time ? entry * moray_orbit_time(system, node) / T : entry);
    }
    for (int r = 0; r < nx && period >= 0; r++)
        triplets_put(out, row + r, period, -hQ / T * outputs_at(system, node)[r]);
}

// Where an input of the closing conditions stands in z; -1: nowhere.
static int column_of_end(const orbit_system *system, int input)
{
    const int nx = system->nx, beyond = input - 2 * nx;
    if (input < nx)
        return input;
    if (beyond < 0)
        return (system->nodes - 2) * nx + input;
    return beyond <= system->ns ? system->column[beyond] : system->unknowns - system->nw + beyond - system->ns - 1;
}

static void walk_closing(const orbit_system *system, int row, triplets *out)
{
    const moray_pattern *jac = &system->closing->jac;
    for (int e = 0; e < jac->nnz; e++) {
        const int column = column_of_end(system, jac->col[e]);
        if (column >= 0)
            triplets_put(out, row + jac->row[e], column, system->closes[e]);
    }
}

static void walk_jacobian(const orbit_system *system, triplets *out)
{
    const moray_scheme *scheme = &system->scheme;
    const int inner = scheme->points - 1, nx = system->nx;
    const double h = moray_orbit_step(system);
    FOR_DEFECTS(system, k, i, j)
    {
        const int row = (k * inner + i) * nx, node = k * inner + j;
        const double P = scheme->P[i * scheme->points + j], Q = scheme->Q[i * scheme->points + j];
        for (int r = 0; r < nx && P != 0; r++)
            triplets_put(out, row + r, node * nx + r, P);
        if (Q != 0)
            walk_slope(system, row, node, h * Q, out);
    }
    walk_closing(system, (system->nodes - 1) * nx, out);
}

void moray_orbit_slopes(orbit_system *system, const double *z)
{
    read_parameters(system, z);
    for (int node = 0; node < system->nodes; node++)
        moray_orbit_plant_slope(system, z + node * system->nx, moray_orbit_time(system, node),
                                orbit_slope_at(system, node));
    set_ends(system, z);
    system->closing->jacobian(system->closing->self, system->in, system->closes);
    moray_triplets_start(&system->jacobian, system->values);
    walk_jacobian(system, &system->jacobian);
}

// ---- Parameters ----------------------------------------------------------------------------------------------------

static void defects_by_parameters(const orbit_system *system, const double *weight, double factor, double *by)
{
    const moray_scheme *scheme = &system->scheme;
    const int inner = scheme->points - 1, nx = system->nx, ns = system->ns;
    const double h = moray_orbit_step(system), T = moray_orbit_period(system);
    FOR_DEFECTS(system, k, i, j)
    {
        const int node = k * inner + j;
        const double hQ = h * scheme->Q[i * scheme->points + j], *f = outputs_at(system, node);
        for (int r = 0; r < nx && hQ != 0; r++) {
            const double w = -factor * hQ * weight[(k * inner + i) * nx + r];
            const double *slope = orbit_slope_at(system, node) + r * system->inputs + nx;
            for (int s = 0; s < ns; s++)
                by[s] += w * slope[s];
            by[ns] += w * (slope[ns] * moray_orbit_time(system, node) + f[r]) / T;
        }
    }
}

void moray_orbit_by_parameters(const orbit_system *system, const double *weight, double factor, double *by)
{
    const moray_pattern *jac = &system->closing->jac;
    const int closing = (system->nodes - 1) * system->nx;
    defects_by_parameters(system, weight, factor, by);
    for (int e = 0; e < jac->nnz; e++) {
        const int parameter = jac->col[e] - 2 * system->nx;
        if (parameter >= 0 && parameter <= system->ns)
            by[parameter] += factor * weight[closing + jac->row[e]] * system->closes[e];
    }
    for (int k = 0; k < system->n_found; k++)
        by[system->found[k]] = 0;
}

// ---- Life ----------------------------------------------------------------------------------------------------------

static moray_status check_sizes(const moray_periodic_orbit_spec *spec)
{
    const int nx = spec->nx, ns = spec->ns, nw = spec->nw, more = spec->n_found + nw;
    if (nx < 1 || ns < 0 || nw < 0 || spec->n_found < 0)
        return moray_error(MORAY_INPUT,
                           "orbit of %d states, %d parameters, %d of them found, %d further unknowns: must be at least "
                           "1, 0, 0, 0",
                           nx, ns, spec->n_found, nw);
    if (spec->plant->n_in != nx + ns + 1 || spec->plant->n_out < nx)
        return moray_error(MORAY_INPUT, "plant of %d inputs and %d outputs: must be %d and at least %d",
                           spec->plant->n_in, spec->plant->n_out, nx + ns + 1, nx);
    if (spec->closing->n_in != 2 * nx + ns + 1 + nw || spec->closing->n_out != nx + more)
        return moray_error(MORAY_INPUT, "closing conditions of %d inputs and %d outputs: must be %d and %d",
                           spec->closing->n_in, spec->closing->n_out, 2 * nx + ns + 1 + nw, nx + more);
    if (spec->intervals < 1 || spec->intervals > 10000)
        return moray_error(MORAY_INPUT, "intervals = %d: must be 1 to 10000", spec->intervals);
    for (int k = 0; k < spec->n_found; k++)
        if (spec->found[k] < (k > 0 ? spec->found[k - 1] + 1 : 0) || spec->found[k] > ns)
            return moray_error(MORAY_INPUT, "found[%d] = %d: must ascend from 0 to %d", k, spec->found[k], ns);
    return moray_ok();
}

static moray_status make_memory(orbit_system *system)
{
    const size_t outputs = (size_t)system->nodes * (size_t)system->outputs, inputs = (size_t)system->inputs;
    const size_t np = (size_t)system->ns + 1, n_found = (size_t)system->n_found;
    const size_t ends = (size_t)system->closing->n_in, nnz = (size_t)system->plant->jac.nnz;
    const size_t closes = (size_t)system->closing->jac.nnz;
    if ((double)outputs * (double)inputs > INT_MAX)
        return moray_error(MORAY_INPUT, "an orbit of %d nodes with %d outputs by %d inputs each is too large",
                           system->nodes, system->outputs, system->inputs);
    system->found = calloc(n_found + np, sizeof *system->found);
    system->p = calloc(np + ends + outputs * (1 + inputs) + nnz + closes, sizeof *system->p);
    if (!system->found || !system->p)
        return moray_error(MORAY_MEMORY, "no memory for an orbit of %d nodes", system->nodes);
    system->column = system->found + n_found;
    system->in = system->p + np;
    system->out = system->in + ends;
    system->slope = system->out + outputs;
    system->sparse = system->slope + outputs * inputs;
    system->closes = system->sparse + nnz;
    return moray_ok();
}

static void place_parameters(orbit_system *system, const int *found)
{
    for (int k = 0; k <= system->ns; k++)
        system->column[k] = -1;
    for (int k = 0; k < system->n_found; k++) {
        system->found[k] = found[k];
        system->column[found[k]] = system->nodes * system->nx + k;
    }
}

static moray_status make_jacobian(orbit_system *system)
{
    system->p[system->ns] = 1; // while recording, any values do
    moray_triplets_record(&system->jacobian);
    walk_jacobian(system, &system->jacobian);
    MORAY_TRY(moray_triplets_close(&system->jacobian));
    system->values = calloc((size_t)system->jacobian.pattern.nnz, sizeof *system->values);
    return system->values ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for an orbit of %d nodes", system->nodes);
}

moray_status moray_orbit_system_new(orbit_system *system, const moray_periodic_orbit_spec *spec)
{
    moray_family family;
    int stages;
    *system = (orbit_system){0};
    MORAY_TRY(check_sizes(spec));
    *system = (orbit_system){.nx = spec->nx,
                             .ns = spec->ns,
                             .nw = spec->nw,
                             .n_found = spec->n_found,
                             .intervals = spec->intervals,
                             .outputs = spec->plant->n_out,
                             .inputs = spec->plant->n_in,
                             .plant = spec->plant,
                             .closing = spec->closing};
    MORAY_TRY(moray_scheme_parse(spec->scheme, &family, &stages));
    MORAY_TRY(moray_scheme_new(&system->scheme, family, stages));
    system->nodes = spec->intervals * (system->scheme.points - 1) + 1;
    system->unknowns = system->nodes * system->nx + system->n_found + system->nw;
    MORAY_TRY(make_memory(system));
    place_parameters(system, spec->found);
    return make_jacobian(system);
}

void moray_orbit_system_free(orbit_system *system)
{
    moray_scheme_free(&system->scheme);
    moray_triplets_free(&system->jacobian);
    free(system->found);
    free(system->p);
    free(system->values);
    *system = (orbit_system){0};
}
