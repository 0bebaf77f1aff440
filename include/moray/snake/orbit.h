// SPDX-License-Identifier: MIT
//
// Steady swimming found without swimming there: the periodic orbit of a robot with its joints on a gait (25), by
// Newton's method on a collocation of one period, with its stability and its derivatives by the gait.
#ifndef MORAY_SNAKE_ORBIT_H
#define MORAY_SNAKE_ORBIT_H

#include "moray/export.h"
#include "moray/num.h"
#include "moray/snake/swim.h"

MORAY_BEGIN

// Over a period T = 2 pi / omega the position advances along the course and the velocities return. With `steered` the
// heading returns too, by the offset phi_0 that makes it: an orbit in every current. Otherwise the gait keeps its
// offset and the heading turns by some angle a period, by which the velocity through the water turns as well: an
// orbit in still water, and in a current as good an approximation as the turn is small.
typedef struct moray_orbit_spec {
    moray_robot robot;
    moray_model model;
    double current[2]; // [m/s]
    double course;     // [rad]
    bool steered;
    const char *scheme; // "lobatto5"; copied
    int intervals;      // 12, of equal length
} moray_orbit_spec;

MORAY_API moray_orbit_spec moray_orbit_spec_default(const moray_robot *robot,
                                                    moray_model model); // still water, course 0, steered

typedef struct moray_orbit moray_orbit; // one robot, one model, the last orbit found; not for two threads at once

// Error: MORAY_INPUT (robot, current, course, scheme, intervals), MORAY_MEMORY.
MORAY_API moray_status moray_orbit_new(moray_orbit **orbit, const moray_orbit_spec *spec);
MORAY_API void moray_orbit_free(moray_orbit *orbit);

typedef struct moray_orbit_result {
    moray_gait gait;     // with the offset found
    moray_steady steady; // as moray_swim_steady gives it, but start_heading is that of the orbit at t = 0, periods is 0
    double peak_load;    // of the motors, of what their supply allows, sampled as peaks of steady are; 0: no lines
    int iterations;      // of Newton's method
    double residual;     // largest defect that is left, in units of the state
} moray_orbit_result;

// Finds the orbit of the gait, starting from the last orbit found and, without one or in vain, from a straight glide
// along the course. gait->offset is where a steered search begins. Error: MORAY_INPUT (gait);
// MORAY_MEMORY; MORAY_NOT_SOLVED when no orbit is found, as where the current across is stronger than the gait.
MORAY_API moray_status moray_orbit_solve(moray_orbit *orbit, const moray_gait *gait, moray_orbit_result *result);

// Rescales gait->omega until the mean power on the orbit is `power` > 0 [W], to 1e-8 of it. Error: those of
// moray_orbit_solve; MORAY_NOT_SOLVED when no omega is found.
MORAY_API moray_status moray_orbit_match_power(moray_orbit *orbit, moray_gait *gait, double power,
                                               moray_orbit_result *result);

// The rest is of the last orbit found. Error of all: MORAY_INPUT when there is none, MORAY_MEMORY, MORAY_NUMERIC.

// Derivatives by (amplitude, omega, delta, offset, taper), by the implicit function theorem: one solve with the
// transposed factors for each quantity. Those by the offset are 0 where it is what is found.
typedef struct moray_orbit_gradient {
    double course_speed[5]; // of moray_course_speed
    double power[5];
    double peak_effort[5]; // of the largest sample
    double peak_load[5];   // likewise; 0 without lines
    double steering[5];    // of the offset found, or else of the turn a period
} moray_orbit_gradient;
MORAY_API moray_status moray_orbit_gradients(moray_orbit *orbit, moray_orbit_gradient *gradient);

// Floquet multipliers: how a small deviation from the orbit has grown after a period. Two belong to displacements and
// are 1; in still water a third belongs to rotations and is 1 too.
typedef enum { MORAY_MODE_TRANSLATION, MORAY_MODE_ROTATION, MORAY_MODE_OTHER } moray_mode;
typedef struct moray_floquet {
    double monodromy[MORAY_BODY_STATES]
                    [MORAY_BODY_STATES]; // d x(T) / d x(0), x as in moray_control_plant or moray_fp_plant
    moray_num multiplier[MORAY_BODY_STATES];
    moray_mode mode[MORAY_BODY_STATES]; // translations, rotation, then the others, the largest in modulus first
    double largest;                     // modulus among the others
    bool stable;                        // it is below 1 by more than 1e-9, about what rounding and mesh leave
} moray_floquet;
MORAY_API moray_status moray_orbit_floquet(moray_orbit *orbit, moray_floquet *floquet);

// `points` >= 2 samples of the swimmer over the period, as moray_swim_steady records them; the caller frees the track.
MORAY_API moray_status moray_orbit_track(moray_orbit *orbit, int points, moray_swim_track *track);

MORAY_END

#endif
