// SPDX-License-Identifier: MIT
//
// The discrete orbit is to the last digit the one of the optimal-gait problem on the same mesh.
#include "snake/swim/orbit.h"
#include "snake/model/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/snake/plant.h"

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
    const size_t states = (size_t)moray_swimmer_states(orbit->swimmer), joints = (size_t)orbit->spec.robot.links - 1;
    orbit->x = calloc(2 * states + 4 * joints, sizeof *orbit->x);
    if (!orbit->x)
        return moray_error(MORAY_MEMORY, "no memory for an orbit of %d links", orbit->spec.robot.links);
    orbit->dx = orbit->x + states;
    orbit->u = orbit->dx + states;
    orbit->phi = orbit->u + joints;
    return moray_ok();
}

moray_status moray_orbit_plant(const moray_orbit *orbit, bool efforts, moray_map *plant)
{
    const moray_orbit_spec *spec = &orbit->spec;
    const moray_plant_spec of = {.robot = spec->robot,
                                 .joints = MORAY_JOINTS_ON_GAIT,
                                 .current = {spec->current[0], spec->current[1]},
                                 .path_forces = efforts,
                                 .path_supply =
                                     efforts && spec->model == MORAY_FIRST_PRINCIPLES && spec->robot.motor.lines > 0};
    return spec->model == MORAY_CONTROL_ORIENTED ? moray_control_plant(plant, &of) : moray_fp_plant(plant, &of);
}

static moray_status make(moray_orbit *orbit, const char *scheme)
{
    static const int found[] = {ORBIT_OFFSET};
    const moray_orbit_spec *spec = &orbit->spec;
    MORAY_TRY(moray_orbit_plant(orbit, false, &orbit->plant));
    MORAY_TRY(moray_orbit_closing(orbit));
    const moray_periodic_orbit_spec engine = {.nx = ORBIT_STATES,
                                              .ns = ORBIT_GAIT,
                                              .nw = !spec->steered,
                                              .plant = &orbit->plant,
                                              .closing = &orbit->closing,
                                              .found = found,
                                              .n_found = spec->steered,
                                              .scheme = scheme,
                                              .intervals = spec->intervals};
    MORAY_TRY(moray_periodic_orbit_new(&orbit->engine, &engine));
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
    orbit->spec = *spec;
    orbit->spec.scheme = NULL;
    const moray_status status = make(orbit, spec->scheme);
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
    moray_periodic_orbit_free(orbit->engine);
    moray_map_release(&orbit->plant);
    moray_map_release(&orbit->efforts);
    moray_map_release(&orbit->closing);
    moray_swimmer_free(orbit->swimmer);
    free(orbit->x);
    free(orbit);
}

// ---- Solving -------------------------------------------------------------------------------------------------------

// A straight glide along the course, at a link length a second through the water.
static void glide(double t, double *x, const void *self)
{
    const moray_orbit_spec *spec = self;
    const bool control = spec->model == MORAY_CONTROL_ORIENTED;
    const double c = cos(spec->course), s = sin(spec->course), pace = 2 * spec->robot.l;
    const double v_x = spec->current[0] + pace * c, v_y = spec->current[1] + pace * s;
    const double state[ORBIT_STATES] = {
        spec->course, v_x * t, v_y * t, 0, control ? v_x * c + v_y * s : v_x, control ? v_y * c - v_x * s : v_y};
    memcpy(x, state, sizeof state);
}

static moray_status check_gait(const moray_gait *gait)
{
    MORAY_TRY(moray_gait_without_series(gait, "an orbit"));
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
                       "(%g, %g) m/s on the course of %.5g: %s",
                       gait->amplitude, gait->omega, gait->delta, orbit->spec.current[0], orbit->spec.current[1],
                       orbit->spec.course, why->text);
}

// From the orbit found before, if there is one, then from a glide.
static moray_status search(moray_orbit *orbit, const double p[ORBIT_PARAMETERS], moray_orbit_result *result)
{
    static const double no_turn = 0;
    const moray_periodic_orbit_guess straight = {.state = glide, .self = &orbit->spec, .w = &no_turn};
    moray_status status = moray_error(MORAY_NOT_SOLVED, "no orbit to start from");
    for (int from_glide = !orbit->found; from_glide <= 1; from_glide++) {
        moray_periodic_orbit_info info;
        status = moray_periodic_orbit_solve(orbit->engine, p, from_glide ? &straight : NULL, &info);
        result->iterations += info.iterations;
        result->residual = info.residual;
        if (status.code != MORAY_NOT_SOLVED && status.code != MORAY_NUMERIC)
            return status;
    }
    return no_orbit(orbit, &status);
}

moray_status moray_orbit_find(moray_orbit *orbit, const moray_gait *gait, moray_orbit_result *result)
{
    *result = (moray_orbit_result){.gait = *gait};
    MORAY_TRY(check_gait(gait));
    const double p[ORBIT_PARAMETERS] = {gait->amplitude, gait->omega, gait->delta,
                                        gait->offset,    gait->taper, 2 * M_PI / gait->omega};
    orbit->gait = *gait;
    const moray_status status = search(orbit, p, result);
    orbit->found = !moray_failed(status);
    if (moray_failed(status))
        return status;
    orbit->gait.offset = moray_periodic_orbit_parameters(orbit->engine)[ORBIT_OFFSET];
    result->gait = orbit->gait;
    result->steady = moray_orbit_means(orbit);
    return moray_ok();
}

moray_status moray_orbit_solve(moray_orbit *orbit, const moray_gait *gait, moray_orbit_result *result)
{
    MORAY_TRY(moray_orbit_find(orbit, gait, result));
    const moray_status status = moray_orbit_measure(orbit, &result->steady);
    result->peak_load = orbit->load.size;
    return status;
}

double moray_orbit_turn(const moray_orbit *orbit)
{
    return orbit->spec.steered ? 0 : moray_periodic_orbit_unknowns(orbit->engine)[0];
}

moray_status moray_orbit_check_found(const moray_orbit *orbit)
{
    return orbit->found ? moray_ok() : moray_error(MORAY_INPUT, "no orbit has been found yet");
}
