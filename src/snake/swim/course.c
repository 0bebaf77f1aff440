// SPDX-License-Identifier: MIT
#include <math.h>
#include <stddef.h>

#include "moray/control/path.h"
#include "snake/swim/orbit.h"
#include "snake/swim/steady.h"

static const double ON_COURSE = 1e-6; // [rad]
static const double MATCHED = 1e-6;   // of the target
enum { MOST_STEPS = 20 };

static double degrees(double angle)
{
    return angle * 180 / M_PI;
}

// Direction in which the robot must swim through the water, at its present speed, for its track to lie on the course.
static moray_status crab_direction(const moray_swim_setup *setup, double course, const moray_steady *steady,
                                   double *direction)
{
    const double *V = setup->current, along = V[0] * cos(course) + V[1] * sin(course);
    const double W = -V[0] * sin(course) + V[1] * cos(course), U = steady->speed;
    if (steady->turning)
        return moray_error(MORAY_NOT_SOLVED, "the gait turns at %.4g rad/s: it holds no course", steady->heading_drift);
    if (!(U > 0))
        return moray_error(MORAY_NOT_SOLVED, "the gait makes no way through the water");
    if (fabs(W) >= U)
        return moray_error(MORAY_NOT_SOLVED,
                           "the gait's speed through the water U = %.4g m/s cannot hold the course of %.4g deg against "
                           "a cross current of W = %.4g m/s",
                           U, degrees(course), W);
    if (moray_course_made_good(U, V, course) <= 0)
        return moray_error(MORAY_NOT_SOLVED,
                           "the gait's speed through the water U = %.4g m/s cannot make way on the course of %.4g deg "
                           "against a current of %.4g m/s along it and W = %.4g m/s across",
                           U, degrees(course), along, W);
    *direction = course + moray_crab_angle(U, V, course);
    return moray_ok();
}

// Steady swimming from the start heading, and by how much the robot swims to the left of where it must [rad].
static moray_status error_of(const moray_swim_setup *setup, const moray_gait *gait, double course, double start_heading,
                             int min_periods, moray_steady *steady, double *error)
{
    double direction = 0;
    const moray_status settled = moray_swim_settle(setup, gait, start_heading, min_periods, steady, NULL, 2);
    if (settled.code !=
        MORAY_NOT_SOLVED) // else a current that is too strong for what it does swim is the better reason
        MORAY_TRY(settled);
    MORAY_TRY(crab_direction(setup, course, steady, &direction));
    MORAY_TRY(settled);
    const double swims = atan2(steady->v_y - setup->current[1], steady->v_x - setup->current[0]);
    *error = remainder(swims - direction, 2 * M_PI);
    return moray_ok();
}

// In still water every direction is alike: the whole motion turned by an angle is what swims from a start heading
// turned by it.
static void turn(moray_steady *steady, double angle)
{
    const double c = cos(angle), s = sin(angle), v_x = steady->v_x, v_y = steady->v_y;
    steady->v_x = c * v_x - s * v_y;
    steady->v_y = s * v_x + c * v_y;
    steady->heading += angle;
    steady->start_heading += angle;
}

// Secant on the start heading; the slope is 1 but for what the current does to the transient from rest.
static moray_status hold(const moray_swim_setup *setup, const moray_gait *gait, double course, double start_heading,
                         moray_steady *steady)
{
    const bool still = setup->current[0] == 0 && setup->current[1] == 0;
    double heading = start_heading, slope = 1, error;
    MORAY_TRY(error_of(setup, gait, course, heading, 0, steady, &error));
    if (still) {
        turn(steady, -error);
        return moray_ok();
    }
    for (int k = 0; k < MOST_STEPS && fabs(error) > ON_COURSE; k++) {
        const double step = -error / slope, before = error;
        heading += step;
        MORAY_TRY(error_of(setup, gait, course, heading, steady->periods, steady, &error));
        slope = fmax((error - before) / step, 0.3);
    }
    if (fabs(error) > ON_COURSE)
        return moray_error(MORAY_NOT_SOLVED,
                           "no start heading found for the course of %.4g deg: from %.4g deg the robot swims %.2g deg "
                           "off it",
                           degrees(course), degrees(heading), degrees(error));
    return moray_ok();
}

moray_status moray_swim_hold_course(const moray_swim_setup *setup, const moray_gait *gait, double course,
                                    moray_steady *steady)
{
    return hold(setup, gait, course, course, steady);
}

// What is matched, and the power of omega with which it grows at constant shape where drag is linear in velocity.
typedef struct {
    const char *name, *unit;
    double target, exponent;
    bool is_power;
} aim;
#define POWER(target)                                                                                                  \
    {                                                                                                                  \
        "mean power", "W", (target), 2, true                                                                           \
    }
#define SPEED(target)                                                                                                  \
    {                                                                                                                  \
        "speed through the water", "m/s", (target), 1, false                                                           \
    }

static moray_status check_target(const aim *to)
{
    if (to->target > 0 && isfinite(to->target))
        return moray_ok();
    return moray_error(MORAY_INPUT, "%s to match = %g %s: must be finite and above 0", to->name, to->target, to->unit);
}

static double mismatch(const aim *to, const moray_steady *steady)
{
    return log((to->is_power ? steady->power : steady->speed) / to->target);
}

// How a gait is swum on the course while omega changes: as the periodic orbit, or simulated from rest.
typedef struct {
    const moray_swim_setup *setup;
    double course;
    moray_orbit *orbit; // NULL: simulated
    moray_orbit_result found;
    double heading; // where the last simulation began
} trier;

static moray_status try_gait(trier *by, const moray_gait *gait, moray_steady *steady)
{
    if (by->orbit) {
        MORAY_TRY(moray_orbit_find(by->orbit, gait, &by->found));
        *steady = by->found.steady;
        return moray_ok();
    }
    MORAY_TRY(hold(by->setup, gait, by->course, by->heading, steady));
    by->heading = steady->start_heading;
    return moray_ok();
}

static moray_status match_by(trier *by, moray_gait *gait, const aim *to, moray_steady *steady)
{
    double slope = to->exponent, step = 0, before = 0;
    for (int k = 0; k < MOST_STEPS; k++) {
        MORAY_TRY(try_gait(by, gait, steady));
        const double error = mismatch(to, steady);
        if (fabs(error) <= (by->orbit ? 0.01 : 1) * MATCHED)
            return moray_ok();
        if (!isfinite(error))
            break;
        if (k > 0)
            slope = fmax((error - before) / step, 0.2 * to->exponent);
        step = fmax(fmin(-error / slope, 1), -1);
        before = error;
        gait->omega *= exp(step);
    }
    return moray_error(MORAY_NOT_SOLVED, "no omega found at which the %s is %.6g %s: it is %.6g at omega = %.6g rad/s",
                       to->name, to->target, to->unit, to->is_power ? steady->power : steady->speed, gait->omega);
}

moray_status moray_orbit_match_power(moray_orbit *orbit, moray_gait *gait, double power, moray_orbit_result *result)
{
    trier by = {.orbit = orbit};
    MORAY_TRY(match_by(&by, gait, &(aim)POWER(power), &result->steady));
    *result = by.found;
    return moray_orbit_measure(orbit, &result->steady);
}

moray_status moray_orbit_match(moray_orbit *orbit, moray_gait *gait, bool power, double target, moray_steady *steady)
{
    const aim to = power ? (aim)POWER(target) : (aim)SPEED(target);
    trier by = {.orbit = orbit};
    MORAY_TRY(check_target(&to));
    return match_by(&by, gait, &to, steady);
}

static moray_status match_on_orbits(const moray_swim_setup *setup, moray_gait *gait, double course, const aim *to,
                                    moray_steady *steady)
{
    const moray_swimmer *swimmer = setup->swimmer;
    moray_orbit_spec spec = moray_orbit_spec_default(moray_swimmer_robot(swimmer), moray_swimmer_model(swimmer));
    trier by = {.setup = setup, .course = course};
    spec.current[0] = setup->current[0];
    spec.current[1] = setup->current[1];
    spec.course = course;
    MORAY_TRY(moray_orbit_new(&by.orbit, &spec));
    const moray_status status = match_by(&by, gait, to, steady);
    moray_orbit_free(by.orbit);
    return status;
}

// The search goes over orbits, which take a hundredth of the time of a simulation from rest; what is returned is
// simulated, from there on, so that it does not depend on there being an orbit or on its offset being the gait's.
static moray_status match(const moray_swim_setup *setup, moray_gait *gait, double course, const aim *to,
                          moray_steady *steady)
{
    MORAY_TRY(check_target(to));
    trier by = {.setup = setup, .course = course, .heading = course};
    moray_gait tried = *gait;
    if (!gait->series && !moray_failed(match_on_orbits(setup, &tried, course, to, steady)))
        gait->omega = tried.omega;
    return match_by(&by, gait, to, steady);
}

moray_status moray_swim_match_power(const moray_swim_setup *setup, moray_gait *gait, double course, double power,
                                    moray_steady *steady)
{
    return match(setup, gait, course, &(aim)POWER(power), steady);
}

moray_status moray_swim_match_speed(const moray_swim_setup *setup, moray_gait *gait, double course, double speed,
                                    moray_steady *steady)
{
    return match(setup, gait, course, &(aim)SPEED(speed), steady);
}
