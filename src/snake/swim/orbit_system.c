// SPDX-License-Identifier: MIT

#include "snake/swim/orbit_system.h"

#include "moray/snake/plant.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double moray_orbit_period(const orbit_system *system)
{
    return 2 * M_PI / system->parameters[ORBIT_OMEGA];
}

double moray_orbit_step(const orbit_system *system)
{
    return moray_orbit_period(system) / system->spec.intervals;
}

double moray_orbit_time(const orbit_system *system, int node)
{
    const int inner = system->scheme.points - 1;
    return (node / inner + system->scheme.node[node % inner]) * moray_orbit_step(system);
}

void moray_orbit_input(const orbit_system *system, const double *z, const double *x, double t, double in[ORBIT_INPUTS])
{
    memcpy(in, x, ORBIT_STATES * sizeof *in);
    memcpy(in + ORBIT_STATES, system->parameters, ORBIT_PARAMETERS * sizeof *in);
    if (system->spec.steered)
        in[ORBIT_OFFSET_INPUT] = z[system->unknowns - 1];
    in[ORBIT_TIME] = t;
}

static const double *outputs_at(const orbit_system *system, int node)
{
    return system->out + node * system->outputs;
}

static const double *slope_at(const orbit_system *system, int node)
{
    return system->slope + node * system->outputs * ORBIT_INPUTS;
}

// ---- How the orbit closes ------------------------------------------------------------------------------------------

static double turn_of(const orbit_system *system, const double *z)
{
    return system->spec.steered ? 0 : z[system->unknowns - 1];
}

// Velocity of the water relative to the axes in which the model has its velocity: body axes at the heading (16), or the
// plane's.
static void water(const orbit_system *system, double heading, double V[2])
{
    const double angle = system->spec.model == MORAY_CONTROL_ORIENTED ? heading : 0;
    const double c = cos(angle), s = sin(angle), *current = system->spec.current;
    V[0] = current[0] * c + current[1] * s;
    V[1] = current[1] * c - current[0] * s;
}

// By how much the axes of the velocity lag behind the body after the period.
static double lag(const orbit_system *system, const double *z)
{
    return system->spec.model == MORAY_CONTROL_ORIENTED ? 0 : turn_of(system, z);
}

static void close_orbit(const orbit_system *system, const double *z, double *F)
{
    const double *x0 = z, *xT = z + (system->nodes - 1) * ORBIT_STATES;
    const double c = cos(lag(system, z)), s = sin(lag(system, z)), course = system->spec.course;
    double V0[2], VT[2];
    water(system, x0[0], V0);
    water(system, xT[0], VT);
    F[0] = x0[1];
    F[1] = x0[2];
    F[2] = xT[0] - x0[0] - turn_of(system, z);
    F[3] = xT[3] - x0[3];
    F[4] = xT[4] - VT[0] - c * (x0[4] - V0[0]) + s * (x0[5] - V0[1]);
    F[5] = xT[5] - VT[1] - s * (x0[4] - V0[0]) - c * (x0[5] - V0[1]);
    F[6] = -(xT[1] - x0[1]) * sin(course) + (xT[2] - x0[2]) * cos(course);
}

static void walk_velocity_closing(const orbit_system *system, const double *z, int row, triplets *out)
{
    const int last = (system->nodes - 1) * ORBIT_STATES, steering = system->unknowns - 1;
    const bool control = system->spec.model == MORAY_CONTROL_ORIENTED;
    const double c = cos(lag(system, z)), s = sin(lag(system, z));
    double V0[2], VT[2];
    water(system, z[0], V0);
    water(system, z[last], VT);
    for (int k = 0; k < 2; k++) {
        triplets_put(out, row + k, last + 4 + k, 1);
        triplets_put(out, row + k, 4, k ? -s : -c);
        triplets_put(out, row + k, 5, k ? -c : s);
        if (control) { // the water turns against the body: dV_t = V_n dtheta, dV_n = -V_t dtheta
            triplets_put(out, row + k, last, k ? VT[0] : -VT[1]);
            triplets_put(out, row + k, 0, k ? -V0[0] : V0[1]);
        } else if (!system->spec.steered) {
            const double u = z[4] - V0[0], v = z[5] - V0[1];
            triplets_put(out, row + k, steering, k ? s * v - c * u : s * u + c * v);
        }
    }
}

static void walk_closing(const orbit_system *system, const double *z, int row, triplets *out)
{
    const int last = (system->nodes - 1) * ORBIT_STATES;
    const double across[2] = {-sin(system->spec.course), cos(system->spec.course)};
    triplets_put(out, row, 1, 1);
    triplets_put(out, row + 1, 2, 1);
    triplets_put(out, row + 2, last, 1);
    triplets_put(out, row + 2, 0, -1);
    if (!system->spec.steered)
        triplets_put(out, row + 2, system->unknowns - 1, -1);
    triplets_put(out, row + 3, last + 3, 1);
    triplets_put(out, row + 3, 3, -1);
    walk_velocity_closing(system, z, row + 4, out);
    for (int k = 0; k < 2; k++) {
        triplets_put(out, row + 6, last + 1 + k, across[k]);
        triplets_put(out, row + 6, 1 + k, -across[k]);
    }
}

// ---- Defects -------------------------------------------------------------------------------------------------------

// Calls of one interval's defects: row i of the scheme takes node j of interval k with P and h Q.
#define FOR_DEFECTS(system, k, i, j)                                                                                   \
    for (int k = 0; k < (system)->spec.intervals; k++)                                                                 \
        for (int i = 0; i < (system)->scheme.points - 1; i++)                                                          \
            for (int j = 0; j < (system)->scheme.points; j++)

static void defects(const orbit_system *system, const double *z, double *F)
{
    const moray_scheme *scheme = &system->scheme;
    const int inner = scheme->points - 1;
    const double h = moray_orbit_step(system);
    memset(F, 0, (size_t)(system->nodes - 1) * ORBIT_STATES * sizeof *F);
    FOR_DEFECTS(system, k, i, j)
    {
        const double P = scheme->P[i * scheme->points + j], hQ = h * scheme->Q[i * scheme->points + j];
        const double *x = z + (k * inner + j) * ORBIT_STATES, *f = outputs_at(system, k * inner + j);
        for (int r = 0; r < ORBIT_STATES; r++)
            F[(k * inner + i) * ORBIT_STATES + r] += P * x[r] - hQ * f[r];
    }
}

// -h Q d f / d z of one node in one defect.
static void walk_slope(const orbit_system *system, int row, int node, double hQ, triplets *out)
{
    const moray_pattern *jac = &system->plant.jac;
    const double *slope = slope_at(system, node);
    for (int e = 0; e < jac->nnz; e++) {
        const int r = jac->row[e], c = jac->col[e];
        const bool steering = system->spec.steered && c == ORBIT_OFFSET_INPUT;
        if (r < ORBIT_STATES && (c < ORBIT_STATES || steering))
            triplets_put(out, row + r, steering ? system->unknowns - 1 : node * ORBIT_STATES + c,
                         -hQ * slope[r * ORBIT_INPUTS + c]);
    }
}

static void moray_walk_jacobian(const orbit_system *system, const double *z, triplets *out)
{
    const moray_scheme *scheme = &system->scheme;
    const int inner = scheme->points - 1;
    const double h = moray_orbit_step(system);
    FOR_DEFECTS(system, k, i, j)
    {
        const int row = (k * inner + i) * ORBIT_STATES, node = k * inner + j;
        const double P = scheme->P[i * scheme->points + j], Q = scheme->Q[i * scheme->points + j];
        for (int r = 0; r < ORBIT_STATES && P != 0; r++)
            triplets_put(out, row + r, node * ORBIT_STATES + r, P);
        if (Q != 0)
            walk_slope(system, row, node, h * Q, out);
    }
    walk_closing(system, z, (system->nodes - 1) * ORBIT_STATES, out);
}

// ---- Evaluation ----------------------------------------------------------------------------------------------------

bool moray_orbit_residual(orbit_system *system, const double *z, double *F)
{
    double in[ORBIT_INPUTS], sum = 0;
    for (int node = 0; node < system->nodes; node++) {
        moray_orbit_input(system, z, z + node * ORBIT_STATES, moray_orbit_time(system, node), in);
        system->plant.value(system->plant.self, in, system->out + node * system->outputs);
    }
    defects(system, z, F);
    close_orbit(system, z, F + (system->nodes - 1) * ORBIT_STATES);
    for (int k = 0; k < system->unknowns; k++)
        sum += fabs(F[k]);
    return isfinite(sum);
}

void moray_orbit_plant_slope(orbit_system *system, const double *in, double *slope)
{
    const moray_pattern *jac = &system->plant.jac;
    system->plant.jacobian(system->plant.self, in, system->slope_values);
    memset(slope, 0, (size_t)(system->outputs * ORBIT_INPUTS) * sizeof *slope);
    for (int e = 0; e < jac->nnz; e++)
        slope[jac->row[e] * ORBIT_INPUTS + jac->col[e]] = system->slope_values[e];
}

void moray_orbit_slopes(orbit_system *system, const double *z)
{
    double in[ORBIT_INPUTS];
    for (int node = 0; node < system->nodes; node++) {
        moray_orbit_input(system, z, z + node * ORBIT_STATES, moray_orbit_time(system, node), in);
        moray_orbit_plant_slope(system, in, system->slope + node * system->outputs * ORBIT_INPUTS);
    }
    moray_triplets_start(&system->jacobian, system->values);
    moray_walk_jacobian(system, z, &system->jacobian);
}

void moray_orbit_output_by_parameters(const orbit_system *system, const double *slope, int row, double t,
                                      double by[ORBIT_PARAMETERS])
{
    memcpy(by, slope + row * ORBIT_INPUTS + ORBIT_STATES, ORBIT_PARAMETERS * sizeof *by);
    by[ORBIT_OMEGA] -= slope[row * ORBIT_INPUTS + ORBIT_TIME] * t / system->parameters[ORBIT_OMEGA];
    if (system->spec.steered)
        by[ORBIT_OFFSET] = 0;
}

void moray_orbit_by_parameters(const orbit_system *system, const double *weight, double by[ORBIT_PARAMETERS])
{
    const moray_scheme *scheme = &system->scheme;
    const int inner = scheme->points - 1;
    const double h = moray_orbit_step(system), omega = system->parameters[ORBIT_OMEGA];
    memset(by, 0, ORBIT_PARAMETERS * sizeof *by);
    FOR_DEFECTS(system, k, i, j)
    {
        const int node = k * inner + j;
        const double hQ = h * scheme->Q[i * scheme->points + j], *f = outputs_at(system, node);
        for (int r = 0; r < ORBIT_STATES && hQ != 0; r++) {
            const double w = weight[(k * inner + i) * ORBIT_STATES + r];
            double f_by[ORBIT_PARAMETERS];
            moray_orbit_output_by_parameters(system, slope_at(system, node), r, moray_orbit_time(system, node), f_by);
            for (int p = 0; p < ORBIT_PARAMETERS; p++)
                by[p] -= w * hQ * f_by[p];
            by[ORBIT_OMEGA] += w * hQ * f[r] / omega; // h is inverse to omega
        }
    }
}

// ---- Life ----------------------------------------------------------------------------------------------------------

static moray_status make_plant(orbit_system *system)
{
    const moray_orbit_spec *spec = &system->spec;
    const moray_plant_spec plant = {.robot = spec->robot,
                                    .joints = MORAY_JOINTS_ON_GAIT,
                                    .current = {spec->current[0], spec->current[1]},
                                    .path_forces = true};
    MORAY_TRY(spec->model == MORAY_CONTROL_ORIENTED ? moray_control_plant(&system->plant, &plant)
                                                    : moray_fp_plant(&system->plant, &plant));
    system->outputs = system->plant.n_out;
    system->power = system->outputs - 1;
    return moray_ok();
}

static moray_status make_memory(orbit_system *system)
{
    const size_t outputs = (size_t)(system->nodes * system->outputs), nnz = (size_t)system->plant.jac.nnz;
    system->out = calloc(outputs * (1 + ORBIT_INPUTS) + nnz, sizeof *system->out);
    if (!system->out)
        return moray_error(MORAY_MEMORY, "no memory for an orbit of %d nodes", system->nodes);
    system->slope = system->out + outputs;
    system->slope_values = system->slope + outputs * ORBIT_INPUTS;
    return moray_ok();
}

static moray_status make_jacobian(orbit_system *system)
{
    double *z = calloc((size_t)system->unknowns, sizeof *z); // while recording, any point does
    if (!z)
        return moray_error(MORAY_MEMORY, "no memory for an orbit of %d nodes", system->nodes);
    system->parameters[ORBIT_OMEGA] = 1;
    moray_triplets_record(&system->jacobian);
    moray_walk_jacobian(system, z, &system->jacobian);
    moray_status status = moray_triplets_close(&system->jacobian);
    free(z);
    if (moray_failed(status))
        return status;
    system->values = calloc((size_t)system->jacobian.pattern.nnz, sizeof *system->values);
    return system->values ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for an orbit of %d nodes", system->nodes);
}

moray_status moray_orbit_system_new(orbit_system *system, const moray_orbit_spec *spec)
{
    moray_family family;
    int stages;
    *system = (orbit_system){.spec = *spec};
    system->spec.scheme = NULL;
    MORAY_TRY(moray_scheme_parse(spec->scheme, &family, &stages));
    MORAY_TRY(moray_scheme_new(&system->scheme, family, stages));
    system->nodes = spec->intervals * (system->scheme.points - 1) + 1;
    system->unknowns = system->nodes * ORBIT_STATES + 1;
    MORAY_TRY(make_plant(system));
    MORAY_TRY(make_memory(system));
    return make_jacobian(system);
}

void moray_orbit_system_free(orbit_system *system)
{
    moray_map_release(&system->plant);
    moray_scheme_free(&system->scheme);
    moray_triplets_free(&system->jacobian);
    free(system->out);
    free(system->values);
    *system = (orbit_system){0};
}
