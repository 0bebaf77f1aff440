// SPDX-License-Identifier: MIT
//
// A swimmer of either model under gaits in closed loop (34): simulation, steady swimming, course holding, comparison at
// equal power or speed. SI units, angles in rad; efforts are joint forces in N (control-oriented model) or torques in
// N m (first-principles model).
#ifndef MORAY_SNAKE_SWIM_H
#define MORAY_SNAKE_SWIM_H

#include "moray/export.h"
#include "moray/control/closed_loop.h"
#include "moray/sim.h"
#include "moray/snake/model.h"
#include "moray/water.h"

MORAY_BEGIN

// ---- Simulation -----------------------------------------------------------------------------------------------------

// From time t on the joints follow this gait.
typedef struct moray_gait_change {
    double t;
    moray_gait gait;
} moray_gait_change;

typedef struct moray_swim_sample {
    double t;
    const double *x; // state, 2N+4
    const double *u; // joint efforts, N-1; at a change of gait those of the new one
    moray_pose pose;
    double energy;     // work of the joints, or at the terminals of their motors, since the start [J]
    double current[2]; // of the water at the centre of mass [m/s]
} moray_swim_sample;

// Returns false to stop the simulation. What the sample points at lives until the return.
typedef bool moray_swim_observer(const moray_swim_sample *sample, void *self);

// phi_0 and its first two time derivatives.
typedef struct moray_offset {
    double value, rate, acceleration;
} moray_offset;

// Who steers: a moray_controller of the offset, which measures the swimmer.
typedef struct moray_swim_controller {
    moray_offset (*offset)(double t, const void *self);
    moray_status (*measure)(const moray_swim_sample *sample, void *self); // NULL: measures nothing
    double period;
    void *self;
} moray_swim_controller;

typedef struct moray_swim_plan {
    double t0, t1;
    const moray_gait_change *schedule; // ascending in t, the first not after t0
    int n_changes;
    const moray_swim_controller *controller; // steers in place of the gait's own offset; NULL: nobody does
    const double *times;                     // of the samples: ascending, within [t0, t1]; may be NULL with n_times 0
    int n_times;
    double current_turning;   // of the swimmer's current, from t0 on [rad/s]
    const moray_water *water; // in place of the swimmer's current, as it is where its centre of mass is
    moray_swim_observer *observe;
    void *observer;
    moray_sim_statistics *statistics; // receives those of the run; may be NULL
} moray_swim_plan;

// Simulates from t0 to t1 in the swimmer's current, which it leaves as it was; x[2N+4] is start and end state, *energy
// the work of a sample [J] (may be NULL). Changes of gait, measurements of the controller and samples are exact stops;
// the integrator starts anew at every change and measurement. When the observer stops the run, the status is ok and x
// the state last observed; after an error x is the state last reached. Error: those of moray_closed_loop_run;
// MORAY_INPUT where the swimmer leaves the table of the water.
MORAY_API moray_status moray_swim_run(moray_swimmer *swimmer, const moray_sim_settings *settings,
                                      const moray_swim_plan *plan, double *x, double *energy);

// How a swimmer is simulated whose joints are on its gait.
typedef struct moray_swim_on_gait {
    int steps; // at least so many a period; at least 8
    int order; // of the method: 0 or 4: the classical Runge-Kutta; 3: Kutta's, of three slopes a step in place of
               // four, whose energy is that of each step's start: right in the mean of a period
} moray_swim_on_gait;

// The same for a swimmer whose joints begin on the gait, one without a series, with the offset first commanded: (34)
// keeps them on it, and how the offset follows its command is known in closed form, so that only the body is
// integrated. Ten times faster. The controller's `measure` is shown no efforts: the u of its sample is NULL. Not where
// torques are limited. Error: MORAY_INPUT, MORAY_MEMORY, MORAY_NUMERIC, that of `measure`.
MORAY_API moray_status moray_swim_run_on_gait(moray_swimmer *swimmer, const moray_swim_plan *plan,
                                              const moray_swim_on_gait *how, double *x, double *energy);

// A recorded motion of n samples; row k of x and u belongs to t[k].
typedef struct moray_swim_track {
    int capacity, n, n_states, n_joints;
    double *t, *x, *u, *energy, *current; // capacity times 1, n_states, n_joints, 1, 2
    moray_pose *pose;
} moray_swim_track;

// An empty track with room for `capacity` samples; free with moray_swim_track_free. Error: MORAY_MEMORY.
MORAY_API moray_status moray_swim_track_new(moray_swim_track *track, const moray_swimmer *swimmer, int capacity);
MORAY_API void moray_swim_track_free(moray_swim_track *track); // safe on a zeroed track, and twice

// A moray_swim_observer with a moray_swim_track as `self`: adds the sample; false when the track is full.
MORAY_API bool moray_swim_track_add(const moray_swim_sample *sample, void *track);

// The robot drawn along a track of at least two samples, at equal intervals of time, as often as there is room: points
// x[n], y[n] of strokes along the links, each stroke followed by a NaN. y is part of x; free(*x). Error: MORAY_MEMORY.
MORAY_API moray_status moray_swim_outline(const moray_swim_track *track, const moray_swimmer *swimmer, double **x,
                                          double **y, int *n);

// ---- Steady swimming ------------------------------------------------------------------------------------------------

typedef struct moray_swim_settings {
    moray_sim_settings sim; // moray_sim_settings_default()
    double agreement;       // 1e-7; relative change of speed and power from one period to the next that counts as none
    int max_periods;        // 200; limit of the run from rest, at least 3
} moray_swim_settings;

MORAY_API moray_swim_settings moray_swim_settings_default(void); // the values in the comments above

// Who swims, and in what water.
typedef struct moray_swim_setup {
    moray_swimmer *swimmer; // the caller's; its current is set to this one
    double current[2];      // V_x, V_y [m/s]
    moray_swim_settings settings;
} moray_swim_setup;

// Steady swimming; means over the last whole period.
typedef struct moray_steady {
    double v_x, v_y;          // mean ground velocity [m/s]
    double speed;             // through the water, |mean ground velocity - current| [m/s]
    double power;             // mean of the joints, or at the terminals of their motors [W]
    double cost_of_transport; // power/speed [J/m]; infinite at no speed
    double peak_effort;       // largest |u_i|, sampled at every degree of phase or finer [N or N m]
    double peak_link_angle;   // largest |link angle - heading|, likewise [rad]
    double heading;           // mean [rad]
    double heading_drift;     // change of the heading per time [rad/s]
    bool turning;             // the heading drifts by more than 1e-3 rad a period: v_x, v_y are of that period only
    double start_heading;     // of the straight body at rest, where this began [rad]
    int periods;              // simulated, the last one included
} moray_steady;

// Swims from rest, straight at start_heading, until speed and power of two successive periods agree (or change by less
// than 1e-5 a period at a rate that agrees), and one period more. The last period goes into *orbit unless NULL:
// `points` >= 2 samples equally spaced, the last a period after the first, shifted to start at t = 0 (as omega t is
// then a multiple of 2 pi, the gait does too) and p = 0, energy likewise; the caller frees it. The first-principles
// model turns slowly in a cross current (some 1e-5 rad a period for the paper's gait and currents): heading_drift
// tells, and speed and power are steady all the same. Error: MORAY_INPUT (gait, settings), MORAY_MEMORY, MORAY_NUMERIC;
// MORAY_NOT_SOLVED saying what still changes, and how fast the heading does, after max_periods: a turning gait in a
// current never is steady.
MORAY_API moray_status moray_swim_steady(const moray_swim_setup *setup, const moray_gait *gait, double start_heading,
                                         moray_steady *steady, moray_swim_track *orbit, int points);

// Velocity over ground along a course [m/s].
MORAY_API double moray_course_speed(const moray_steady *steady, double course);

// Finds the start heading from which the mean ground velocity points along the course (within 1e-6 rad).
// Error: those of moray_swim_steady; MORAY_NOT_SOLVED when the current across is stronger than the gait's speed through
// the water (naming both), when the current along drives the robot astern, or when the gait turns.
MORAY_API moray_status moray_swim_hold_course(const moray_swim_setup *setup, const moray_gait *gait, double course,
                                              moray_steady *steady);

// Rescales gait->omega until, holding the course, the mean power is `power` [W], or the speed through the water `speed`
// [m/s], to 1e-6 of it. Error: those of moray_swim_hold_course; MORAY_INPUT for a target that is not above 0;
// MORAY_NOT_SOLVED when no omega is found.
MORAY_API moray_status moray_swim_match_power(const moray_swim_setup *setup, moray_gait *gait, double course,
                                              double power, moray_steady *steady);
MORAY_API moray_status moray_swim_match_speed(const moray_swim_setup *setup, moray_gait *gait, double course,
                                              double speed, moray_steady *steady);

MORAY_END

#endif
