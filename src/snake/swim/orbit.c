// SPDX-License-Identifier: MIT
//
// Newton's method on the whole orbit at once. Shooting would need the orbit of a start state before it knew anything
// of the closing conditions; here every node has its own state, a guess as crude as a straight glide will do, and the
// discrete orbit is to the last digit the one of the optimal-gait problem on the same mesh.
#include "snake/swim/orbit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ITERATIONS = 40, MOST_HALVINGS = 8 };
static const double CLOSED = 1e-11; // largest defect that counts as none
static const double SETTLED = 1e-8; // largest step after which the next is lost in rounding

moray_orbit_spec moray_orbit_spec_default(const moray_robot *robot, moray_model model)
{
    return (moray_orbit_spec){.robot = *robot, .model = model, .steered = true, .scheme = "lobatto5", .intervals = 12};
}

static moray_status check_spec(const moray_orbit_spec *spec)
{
    MORAY_TRY(moray_robot_check(&spec->robot));
    if (!isfinite(spec->current[0]) || !isfinite(spec->current[1]) || !isfinite(spec->course))
        return moray_error(MORAY_INPUT, "current = %g,%g, course = %g: must be finite", spec->current[0],
                           spec->current[1], spec->course);
    if (spec->intervals < 1 || spec->intervals > 10000)
        return moray_error(MORAY_INPUT, "intervals = %d: must be 1 to 10000", spec->intervals);
    return moray_ok();
}

static moray_status make_memory(moray_orbit *orbit)
{
    const size_t n = (size_t)orbit->system.unknowns, points = (size_t)orbit->system.scheme.points;
    const size_t states = (size_t)moray_swimmer_states(orbit->swimmer), joints = (size_t)orbit->system.plant.n_out;
    const size_t slope = (size_t)orbit->system.outputs * ORBIT_INPUTS;
    double *memory = calloc(4 * n + 2 * states + 4 * joints + 2 * points + slope, sizeof *memory);
    if (!memory)
        return moray_error(MORAY_MEMORY, "no memory for an orbit of %d nodes", orbit->system.nodes);
    orbit->z = memory;
    orbit->F = orbit->z + n;
    orbit->step = orbit->F + n;
    orbit->trial = orbit->step + n;
    orbit->x = orbit->trial + n;
    orbit->dx = orbit->x + states;
    orbit->u = orbit->dx + states;
    orbit->phi = orbit->u + joints;
    orbit->ell = orbit->phi + 3 * joints;
    orbit->integral = orbit->ell + points;
    orbit->slope = orbit->integral + points;
    return moray_ok();
}

static moray_status make(moray_orbit *orbit, const moray_orbit_spec *spec)
{
    MORAY_TRY(moray_orbit_system_new(&orbit->system, spec));
    MORAY_TRY(moray_sparse_lu_new(&orbit->lu, orbit->system.unknowns, &orbit->system.jacobian.pattern));
    MORAY_TRY(moray_swimmer_new(&orbit->swimmer, &spec->robot, spec->model));
    moray_swimmer_set_current(orbit->swimmer, spec->current[0], spec->current[1]);
    return make_memory(orbit);
}

moray_status moray_orbit_new(moray_orbit **result, const moray_orbit_spec *spec)
{
    *result = NULL;
    MORAY_TRY(check_spec(spec));
    moray_orbit *orbit = calloc(1, sizeof *orbit);
    if (!orbit)
        return moray_error(MORAY_MEMORY, "no memory for an orbit");
    moray_status status = make(orbit, spec);
    if (moray_failed(status))
        moray_orbit_free(orbit);
    else
        *result = orbit;
    return status;
}

void moray_orbit_free(moray_orbit *orbit)
{
    if (!orbit)
        return;
    moray_orbit_system_free(&orbit->system);
    moray_sparse_lu_free(orbit->lu);
    moray_swimmer_free(orbit->swimmer);
    free(orbit->z);
    free(orbit);
}

// ---- Newton's method -----------------------------------------------------------------------------------------------

static double largest(const double *values, int n)
{
    double most = 0;
    for (int k = 0; k < n; k++)
        most = fmax(most, fabs(values[k]));
    return most;
}

// z + scale step into trial, and its residual; false where that is not finite.
static bool try_step(moray_orbit *orbit, double scale, double *residual)
{
    const int n = orbit->system.unknowns;
    for (int k = 0; k < n; k++)
        orbit->trial[k] = orbit->z[k] - scale * orbit->step[k];
    const bool finite = moray_orbit_residual(&orbit->system, orbit->trial, orbit->F);
    *residual = largest(orbit->F, n);
    return finite;
}

// A whole step, or the longest of its halves that brings the residual down unless it is down already.
static bool advance(moray_orbit *orbit, double *residual)
{
    const double before = *residual;
    double scale = 1;
    for (int k = 0; k < MOST_HALVINGS; k++, scale /= 2)
        if (try_step(orbit, scale, residual) && (*residual < before || *residual <= CLOSED)) {
            memcpy(orbit->z, orbit->trial, (size_t)orbit->system.unknowns * sizeof *orbit->z);
            return true;
        }
    return false;
}

static moray_status newton(moray_orbit *orbit, int *iterations, double *residual)
{
    orbit_system *system = &orbit->system;
    const size_t size = (size_t)system->unknowns * sizeof(double);
    if (!moray_orbit_residual(system, orbit->z, orbit->F))
        return moray_error(MORAY_NOT_SOLVED, "the model is not finite where the search for an orbit starts");
    *residual = largest(orbit->F, system->unknowns);
    for (int k = 0; k < MOST_ITERATIONS; k++) {
        moray_orbit_slopes(system, orbit->z);
        MORAY_TRY(moray_sparse_lu_factor(orbit->lu, system->values));
        memcpy(orbit->step, orbit->F, size);
        MORAY_TRY(moray_sparse_lu_solve(orbit->lu, 1, orbit->step));
        if (!advance(orbit, residual))
            break;
        (*iterations)++;
        if (*residual <= CLOSED && largest(orbit->step, system->unknowns) <= SETTLED)
            return moray_ok();
    }
    return moray_error(MORAY_NOT_SOLVED, "defects of %.2g are left after %d steps of Newton's method", *residual,
                       *iterations);
}

// A straight glide along the course, at a link length a second through the water.
static void glide(moray_orbit *orbit)
{
    const moray_orbit_spec *spec = &orbit->system.spec;
    const bool control = spec->model == MORAY_CONTROL_ORIENTED;
    const double c = cos(spec->course), s = sin(spec->course), pace = 2 * spec->robot.l;
    const double v_x = spec->current[0] + pace * c, v_y = spec->current[1] + pace * s;
    for (int node = 0; node < orbit->system.nodes; node++) {
        const double t = moray_orbit_time(&orbit->system, node);
        const double x[ORBIT_STATES] = {
            spec->course, v_x * t, v_y * t, 0, control ? v_x * c + v_y * s : v_x, control ? v_y * c - v_x * s : v_y};
        memcpy(orbit->z + node * ORBIT_STATES, x, sizeof x);
    }
    orbit->z[orbit->system.unknowns - 1] = spec->steered ? orbit->gait.offset : 0;
}

static moray_status check_gait(const moray_gait *gait)
{
    if (!(gait->omega > 0 && isfinite(gait->omega)))
        return moray_error(MORAY_INPUT, "omega = %g: an orbit needs a finite omega above 0", gait->omega);
    if (!isfinite(gait->amplitude) || !isfinite(gait->delta) || !isfinite(gait->offset) || !isfinite(gait->taper))
        return moray_error(MORAY_INPUT, "gait amplitude = %g, delta = %g, offset = %g, taper = %g: must be finite",
                           gait->amplitude, gait->delta, gait->offset, gait->taper);
    return moray_ok();
}

static moray_status no_orbit(const moray_orbit *orbit, const moray_status *why)
{
    const moray_gait *gait = &orbit->gait;
    return moray_error(MORAY_NOT_SOLVED,
                       "no periodic orbit found for amplitude = %.5g, omega = %.5g, delta = %.5g in a current of "
                       "(%g, %g) m/s on the course of %.5g: %.120s",
                       gait->amplitude, gait->omega, gait->delta, orbit->system.spec.current[0],
                       orbit->system.spec.current[1], orbit->system.spec.course, why->text);
}

// From the orbit found before, if there is one, then from a glide.
static moray_status search(moray_orbit *orbit, int *iterations, double *residual)
{
    moray_status status = moray_error(MORAY_NOT_SOLVED, "no orbit to start from");
    if (orbit->found)
        status = newton(orbit, iterations, residual);
    if (status.code == MORAY_NOT_SOLVED || status.code == MORAY_NUMERIC) {
        glide(orbit);
        status = newton(orbit, iterations, residual);
    }
    if (status.code == MORAY_NOT_SOLVED || status.code == MORAY_NUMERIC)
        return no_orbit(orbit, &status);
    return status;
}

moray_status moray_orbit_solve(moray_orbit *orbit, const moray_gait *gait, moray_orbit_result *result)
{
    const double parameters[] = {gait->amplitude, gait->omega, gait->delta, gait->offset, gait->taper};
    *result = (moray_orbit_result){.gait = *gait};
    MORAY_TRY(check_gait(gait));
    orbit->gait = *gait;
    orbit->factored = false;
    memcpy(orbit->system.parameters, parameters, sizeof parameters);
    moray_status status = search(orbit, &result->iterations, &result->residual);
    orbit->found = !moray_failed(status);
    if (moray_failed(status))
        return status;
    if (orbit->system.spec.steered)
        orbit->gait.offset = orbit->z[orbit->system.unknowns - 1];
    result->gait = orbit->gait;
    status = moray_orbit_measure(orbit, &result->steady);
    orbit->found = !moray_failed(status);
    return status;
}

moray_status moray_orbit_factor(moray_orbit *orbit)
{
    if (!orbit->found)
        return moray_error(MORAY_INPUT, "no orbit has been found yet");
    if (orbit->factored)
        return moray_ok();
    moray_orbit_slopes(&orbit->system, orbit->z);
    MORAY_TRY(moray_sparse_lu_factor(orbit->lu, orbit->system.values));
    orbit->factored = true;
    return moray_ok();
}
