// SPDX-License-Identifier: MIT
#include "moray/snake/ladder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/parallel.h"
#include "snake/swim/orbit.h"

// ---- The rungs -----------------------------------------------------------------------------------------------------

static const char *const names[MORAY_RUNGS] = {"paper",     "split2",     "split3",  "split5",    "strip",
                                               "quadratic", "consistent", "c_n+20",  "c_n-20",    "c_t+20",
                                               "c_t-20",    "mu_n+20",    "mu_n-20", "lambda+20", "lambda-20"};
enum { MODELS = 7, CHANGES = (MORAY_RUNGS - MODELS) / 2 };

static moray_hydrodynamics model_of(int rung)
{
    static const moray_hydrodynamics paper[MODELS - 1] = {{.pieces = 1},
                                                          {.pieces = 2},
                                                          {.pieces = 3},
                                                          {.pieces = 5},
                                                          {.rotation = MORAY_ROTATION_STRIP, .pieces = 1},
                                                          {.drag = MORAY_DRAG_QUADRATIC, .pieces = 1}};
    return rung < MODELS - 1 ? paper[rung] : moray_hydrodynamics_consistent();
}

static void change(moray_robot *robot, int coefficient, double factor)
{
    double *const of[CHANGES][3] = {
        {&robot->c_n}, {&robot->c_t}, {&robot->mu_n}, {&robot->lambda_1, &robot->lambda_2, &robot->lambda_3}};
    for (int i = 0; i < 3 && of[coefficient][i]; i++)
        *of[coefficient][i] *= factor;
}

void moray_ladder(const moray_robot *robot, moray_rung rung[MORAY_RUNGS])
{
    for (int k = 0; k < MORAY_RUNGS; k++) {
        rung[k] = (moray_rung){names[k], *robot};
        if (k < MODELS)
            rung[k].robot.hydro = model_of(k);
        else
            change(&rung[k].robot, (k - MODELS) / 2, (k - MODELS) % 2 ? 0.8 : 1.2);
    }
}

int moray_rung_named(const char *name)
{
    for (int k = 0; k < MORAY_RUNGS; k++)
        if (strcmp(names[k], name) == 0)
            return k;
    return -1;
}

static int pieces(const moray_hydrodynamics *hydro)
{
    return hydro->pieces > 1 ? hydro->pieces : 1;
}

unsigned moray_rung_of(const moray_robot *robot)
{
    const moray_hydrodynamics *own = &robot->hydro;
    for (int k = 0; k < MODELS; k++) {
        const moray_hydrodynamics it = model_of(k);
        if (it.rotation == own->rotation && it.drag == own->drag && it.added_mass == own->added_mass &&
            pieces(&it) == pieces(own))
            return 1u << k;
    }
    return 0;
}

// ---- Swimming on one of them ---------------------------------------------------------------------------------------

// Where the gaits are swum on a rung.
typedef struct {
    const moray_ladder_spec *spec;
    moray_orbit *orbit;
    moray_swim_setup setup;
} place;

static moray_status place_new(place *at, const moray_ladder_spec *spec, const moray_robot *robot)
{
    moray_orbit_spec orbit = moray_orbit_spec_default(robot, MORAY_FIRST_PRINCIPLES);
    memcpy(orbit.current, spec->current, sizeof orbit.current);
    orbit.course = spec->course;
    *at = (place){.spec = spec, .setup = {.current = {spec->current[0], spec->current[1]}, .settings = spec->settings}};
    MORAY_TRY(moray_swimmer_new(&at->setup.swimmer, robot, MORAY_FIRST_PRINCIPLES));
    return moray_orbit_new(&at->orbit, &orbit);
}

static void place_free(place *at)
{
    moray_orbit_free(at->orbit);
    moray_swimmer_free(at->setup.swimmer);
}

moray_status moray_makes_way(const moray_robot *robot, const moray_gait *gait, const moray_steady *steady)
{
    const double period = 2 * M_PI / gait->omega;
    if (!(steady->speed * period > 0.02 * robot->l))
        return moray_error(MORAY_NOT_SOLVED, "the gait makes no way: %.2g m/s", steady->speed);
    return moray_ok();
}

static moray_status swim_baseline(place *at, moray_steady *steady)
{
    const moray_gait *gait = &at->spec->baseline;
    moray_orbit_result found;
    if (!gait->series && !moray_failed(moray_orbit_solve(at->orbit, gait, &found)) &&
        !moray_failed(moray_orbit_stays(at->orbit))) {
        *steady = found.steady;
        return moray_ok();
    }
    return moray_swim_hold_course(&at->setup, gait, at->spec->course, steady);
}

static moray_status swim_gait(place *at, moray_gait *gait, double power, moray_steady *steady)
{
    moray_gait tried = *gait;
    moray_orbit_result found;
    if (!gait->series && !moray_failed(moray_orbit_match_power(at->orbit, &tried, power, &found)) &&
        !moray_failed(moray_orbit_stays(at->orbit))) {
        *gait = found.gait;
        *steady = found.steady;
        return moray_ok();
    }
    return moray_swim_match_power(&at->setup, gait, at->spec->course, power, steady);
}

static void compare(place *at, const moray_steady *base, const moray_gait *gait, moray_ladder_row *row)
{
    moray_gait matched = *gait;
    moray_steady steady;
    row->why = swim_gait(at, &matched, base->power, &steady);
    if (moray_failed(row->why))
        return;
    row->gain_percent = 100 * (steady.speed / base->speed - 1);
    row->speed = steady.speed;
    row->power = steady.power;
    row->omega = matched.omega;
}

static moray_status climb_rung(const moray_ladder_spec *spec, const moray_robot *robot, moray_ladder_row *row)
{
    place at;
    moray_steady base;
    moray_status status = place_new(&at, spec, robot);
    if (!moray_failed(status)) {
        status = swim_baseline(&at, &base);
        if (!moray_failed(status))
            status = moray_makes_way(robot, &spec->baseline, &base);
        if (moray_failed(status))
            status = moray_error(status.code, "the baseline: %s", status.text);
    }
    for (int g = 0; g < spec->gaits && !moray_failed(status); g++)
        compare(&at, &base, &spec->gait[g], &row[g]);
    place_free(&at);
    return status;
}

// A moray_task_fn; result: [gaits] of the rung.
static void climb(int k, void *result, void *self)
{
    const moray_ladder_spec *spec = self;
    moray_ladder_row *row = result;
    moray_rung rung[MORAY_RUNGS];
    moray_ladder(&spec->robot, rung);
    for (int g = 0; g < spec->gaits; g++)
        row[g] = (moray_ladder_row){names[k], NAN, NAN, NAN, NAN, moray_ok()};
    const moray_status status = climb_rung(spec, &rung[k].robot, row);
    for (int g = 0; g < spec->gaits && moray_failed(status); g++)
        row[g].why = status;
}

moray_status moray_ladder_climb(const moray_ladder_spec *spec, moray_ladder_row *row)
{
    moray_ladder_spec copy = *spec;
    const size_t gaits = (size_t)spec->gaits;
    MORAY_TRY(moray_robot_check(&spec->robot));
    moray_ladder_row *by_rung = calloc(MORAY_RUNGS * gaits + 1, sizeof *by_rung);
    if (!by_rung)
        return moray_error(MORAY_MEMORY, "no memory for a ladder of %d gaits", spec->gaits);
    const moray_status status = moray_parallel(MORAY_RUNGS, gaits * sizeof *by_rung, by_rung, climb, &copy, spec->jobs);
    for (int k = 0; k < MORAY_RUNGS; k++)
        for (int g = 0; g < spec->gaits; g++)
            row[g * MORAY_RUNGS + k] = by_rung[k * spec->gaits + g];
    free(by_rung);
    return status;
}
