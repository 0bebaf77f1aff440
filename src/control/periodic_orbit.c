// SPDX-License-Identifier: MIT
//
// Newton's method on the whole orbit at once. Shooting would need the orbit of a start state before it knew anything
// of the closing conditions; here every node has its own state, and a crude guess will do.
#include "control/periodic_orbit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ITERATIONS = 40, MOST_HALVINGS = 8 };
static const double CLOSED = 1e-11; // largest defect that counts as none
static const double SETTLED = 1e-8; // largest step after which the next is lost in rounding
static const double BRISK = 0.2;    // of the residual that old slopes may leave
static const double LOST = 1e-13;   // step that is lost in rounding

static moray_status make_memory(moray_periodic_orbit *orbit)
{
    const orbit_system *system = &orbit->system;
    const size_t n = (size_t)system->unknowns, points = (size_t)system->scheme.points, nx = (size_t)system->nx;
    double *memory = calloc(4 * n + 2 * points + 2 * nx + (size_t)(system->outputs * system->inputs), sizeof *memory);
    if (!memory)
        return moray_error(MORAY_MEMORY, "no memory for an orbit of %d nodes", system->nodes);
    orbit->z = memory;
    orbit->F = orbit->z + n;
    orbit->step = orbit->F + n;
    orbit->trial = orbit->step + n;
    orbit->ell = orbit->trial + n;
    orbit->integral = orbit->ell + points;
    orbit->x = orbit->integral + points;
    orbit->scale = orbit->x + nx;
    orbit->slope = orbit->scale + nx;
    return moray_ok();
}

static moray_status set_scale(moray_periodic_orbit *orbit, const double *scale)
{
    for (int r = 0; r < orbit->system.nx; r++) {
        orbit->scale[r] = scale ? scale[r] : 1;
        if (!(orbit->scale[r] > 0 && isfinite(orbit->scale[r])))
            return moray_error(MORAY_INPUT, "scale[%d] = %g: must be above 0", r, orbit->scale[r]);
    }
    return moray_ok();
}

static moray_status make(moray_periodic_orbit *orbit, const moray_periodic_orbit_spec *spec)
{
    MORAY_TRY(moray_orbit_system_new(&orbit->system, spec));
    MORAY_TRY(make_memory(orbit));
    MORAY_TRY(set_scale(orbit, spec->scale));
    const moray_status status =
        moray_sparse_lu_new(&orbit->lu, orbit->system.unknowns, &orbit->system.jacobian.pattern);
    if (status.code == MORAY_INPUT)
        return moray_error(MORAY_INPUT, "the closing conditions do not determine the orbit: %s", status.text);
    return status;
}

moray_status moray_periodic_orbit_new(moray_periodic_orbit **result, const moray_periodic_orbit_spec *spec)
{
    *result = NULL;
    moray_periodic_orbit *orbit = calloc(1, sizeof *orbit);
    if (!orbit)
        return moray_error(MORAY_MEMORY, "no memory for an orbit");
    const moray_status status = make(orbit, spec);
    if (moray_failed(status))
        moray_periodic_orbit_free(orbit);
    else
        *result = orbit;
    return status;
}

void moray_periodic_orbit_free(moray_periodic_orbit *orbit)
{
    if (!orbit)
        return;
    moray_orbit_system_free(&orbit->system);
    moray_sparse_lu_free(orbit->lu);
    free(orbit->z);
    free(orbit);
}

// ---- Newton's method -----------------------------------------------------------------------------------------------

// The largest of values[unknowns], those of the nodes in units of the states' scale.
static double largest(const moray_periodic_orbit *orbit, const double *values, int nodes)
{
    const int nx = orbit->system.nx;
    double most = 0;
    for (int k = 0; k < orbit->system.unknowns; k++)
        most = fmax(most, fabs(values[k]) / (k < nodes * nx ? orbit->scale[k % nx] : 1));
    return most;
}

static double residual_of(const moray_periodic_orbit *orbit)
{
    return largest(orbit, orbit->F, orbit->system.nodes - 1);
}

// z - scale step into trial, and its residual; false where that is not finite.
static bool try_step(moray_periodic_orbit *orbit, double scale, double *residual)
{
    for (int k = 0; k < orbit->system.unknowns; k++)
        orbit->trial[k] = orbit->z[k] - scale * orbit->step[k];
    const bool finite = moray_orbit_residual(&orbit->system, orbit->trial, orbit->F);
    *residual = finite ? residual_of(orbit) : INFINITY;
    return finite;
}

// A whole step, or the longest of its halves that brings the residual down unless it is down already.
static bool advance(moray_periodic_orbit *orbit, double *residual)
{
    const double before = *residual;
    double scale = 1;
    for (int k = 0; k < MOST_HALVINGS; k++, scale /= 2)
        if (try_step(orbit, scale, residual) && (*residual < before || *residual <= CLOSED)) {
            memcpy(orbit->z, orbit->trial, (size_t)orbit->system.unknowns * sizeof *orbit->z);
            return true;
        }
    *residual = before;
    return false;
}

// A whole step by slopes and factors of an earlier point, if it leaves little of the residual: it costs a fraction of
// one by its own. False where it does not, and all is as before.
static bool advance_by_old(moray_periodic_orbit *orbit, double *residual)
{
    double after;
    if (try_step(orbit, 1, &after) && after <= fmax(BRISK * *residual, CLOSED)) {
        memcpy(orbit->z, orbit->trial, (size_t)orbit->system.unknowns * sizeof *orbit->z);
        *residual = after;
        return true;
    }
    moray_orbit_residual(&orbit->system, orbit->z, orbit->F);
    return false;
}

// Whether nothing is left to do after a step; by old slopes the next is as much shorter as the residual is.
static bool is_there(const moray_periodic_orbit *orbit, double residual, double before, bool old)
{
    const double step = largest(orbit, orbit->step, orbit->system.nodes);
    return residual <= CLOSED && (old ? step * residual <= LOST * before : step <= SETTLED);
}

static moray_status find_step(moray_periodic_orbit *orbit, bool old)
{
    if (!old) {
        moray_orbit_slopes(&orbit->system, orbit->z);
        orbit->usable = false;
        MORAY_TRY(moray_sparse_lu_factor(orbit->lu, orbit->system.values));
        orbit->usable = true;
    }
    memcpy(orbit->step, orbit->F, (size_t)orbit->system.unknowns * sizeof *orbit->step);
    return moray_sparse_lu_solve(orbit->lu, 1, orbit->step);
}

static moray_status newton(moray_periodic_orbit *orbit, moray_periodic_orbit_info *info)
{
    bool old = orbit->usable;
    if (!moray_orbit_residual(&orbit->system, orbit->z, orbit->F))
        return moray_error(MORAY_NOT_SOLVED, "the plant is not finite where the search for an orbit starts");
    info->residual = residual_of(orbit);
    while (info->iterations < MOST_ITERATIONS) {
        const double before = info->residual;
        MORAY_TRY(find_step(orbit, old));
        const bool forward = old ? advance_by_old(orbit, &info->residual) : advance(orbit, &info->residual);
        if (!forward && !old)
            break;
        info->iterations += forward;
        info->slopes += !old;
        if (forward && is_there(orbit, info->residual, before, old))
            return moray_ok();
        old = forward && info->residual <= BRISK * before; // rounding alone may not be left to old slopes
    }
    return moray_error(MORAY_NOT_SOLVED, "defects of %.2g are left after %d steps of Newton's method", info->residual,
                       info->iterations);
}

// ---- Solving -------------------------------------------------------------------------------------------------------

static moray_status check_parameters(const orbit_system *system, const double *p)
{
    for (int k = 0; k < system->ns; k++)
        if (!isfinite(p[k]))
            return moray_error(MORAY_INPUT, "parameter %d of the orbit = %g: must be finite", k, p[k]);
    if (!(p[system->ns] > 0 && isfinite(p[system->ns])))
        return moray_error(MORAY_INPUT, "period = %g: must be finite and above 0", p[system->ns]);
    return moray_ok();
}

// The guess at the nodes, the unknown parameters as they stand in p, then w.
static void begin(moray_periodic_orbit *orbit, const moray_periodic_orbit_guess *guess)
{
    const orbit_system *system = &orbit->system;
    for (int node = 0; node < system->nodes; node++)
        guess->state(moray_orbit_time(system, node), orbit->z + node * system->nx, guess->self);
    for (int k = 0; k < system->n_found; k++)
        orbit->z[system->column[system->found[k]]] = system->p[system->found[k]];
    if (system->nw > 0)
        memcpy(orbit->z + system->unknowns - system->nw, guess->w, (size_t)system->nw * sizeof *guess->w);
}

moray_status moray_periodic_orbit_solve(moray_periodic_orbit *orbit, const double *p,
                                        const moray_periodic_orbit_guess *guess, moray_periodic_orbit_info *info)
{
    orbit_system *system = &orbit->system;
    *info = (moray_periodic_orbit_info){.residual = INFINITY};
    MORAY_TRY(check_parameters(system, p));
    if (!guess && !orbit->found)
        return moray_error(MORAY_INPUT, "no orbit to begin from");
    memcpy(system->p, p, ((size_t)system->ns + 1) * sizeof *p);
    orbit->factored = orbit->found = false;
    if (guess) {
        begin(orbit, guess);
        orbit->usable = false; // those of another orbit
    }
    const moray_status status = newton(orbit, info);
    orbit->found = !moray_failed(status);
    return status;
}

moray_status moray_periodic_orbit_factor(moray_periodic_orbit *orbit)
{
    if (!orbit->found)
        return moray_error(MORAY_INPUT, "no orbit has been found yet");
    if (orbit->factored)
        return moray_ok();
    moray_orbit_slopes(&orbit->system, orbit->z);
    orbit->usable = false;
    MORAY_TRY(moray_sparse_lu_factor(orbit->lu, orbit->system.values));
    orbit->factored = orbit->usable = true;
    return moray_ok();
}

// ---- What was found ------------------------------------------------------------------------------------------------

const double *moray_periodic_orbit_parameters(const moray_periodic_orbit *orbit)
{
    return orbit->found ? orbit->system.p : NULL;
}

const double *moray_periodic_orbit_unknowns(const moray_periodic_orbit *orbit)
{
    return orbit->found ? orbit->z + orbit->system.unknowns - orbit->system.nw : NULL;
}

int moray_periodic_orbit_locate(moray_periodic_orbit *orbit, double t)
{
    const orbit_system *system = &orbit->system;
    const double h = moray_orbit_step(system), last = system->intervals - 1;
    const double interval = fmax(0, fmin(floor(t / h), last));
    moray_scheme_basis(&system->scheme, t / h - interval, orbit->ell, orbit->integral);
    return (int)interval;
}

double moray_periodic_orbit_part(const moray_periodic_orbit *orbit, int interval, int row)
{
    const orbit_system *system = &orbit->system;
    const int points = system->scheme.points;
    const double *out = system->out + interval * (points - 1) * system->outputs + row;
    double sum = 0;
    for (int j = 0; j < points; j++)
        sum += orbit->integral[j] * out[j * system->outputs];
    return moray_orbit_step(system) * sum;
}

// At the end it is the last node to the digit, which is what the closing conditions see.
void moray_periodic_orbit_state(moray_periodic_orbit *orbit, double t, double *x)
{
    const orbit_system *system = &orbit->system;
    const int nx = system->nx, inner = system->scheme.points - 1;
    const bool ends = t >= moray_orbit_period(system);
    const int interval = !orbit->found ? 0 : ends ? system->intervals : moray_periodic_orbit_locate(orbit, t);
    const double *start = orbit->z + interval * inner * nx;
    for (int r = 0; r < nx; r++)
        x[r] = !orbit->found ? NAN : ends ? start[r] : start[r] + moray_periodic_orbit_part(orbit, interval, r);
}

double moray_periodic_orbit_integral(moray_periodic_orbit *orbit, int row, double t)
{
    const orbit_system *system = &orbit->system;
    const int points = system->scheme.points;
    if (!orbit->found || row < 0 || row >= system->outputs)
        return NAN;
    const int interval = moray_periodic_orbit_locate(orbit, t);
    double before = 0;
    for (int k = 0; k < interval; k++)
        for (int j = 0; j < points; j++)
            before += system->scheme.b[j] * system->out[(k * (points - 1) + j) * system->outputs + row];
    return moray_orbit_step(system) * before + moray_periodic_orbit_part(orbit, interval, row);
}
