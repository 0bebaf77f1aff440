// SPDX-License-Identifier: MIT
//
// A robot identified from logs of its swimming: logs, the motion of the joints, unknowns, their estimate with its
// covariance, what the residuals say, and the experiment that would tell most. SI units, angles in rad.
#ifndef MORAY_SNAKE_IDENTIFY_H
#define MORAY_SNAKE_IDENTIFY_H

#include <stddef.h>
#include <stdio.h>

#include "moray/export.h"
#include "moray/snake/swim.h"

MORAY_BEGIN

// ---- Logs ----------------------------------------------------------------------------------------------------------

// One run. A value that is missing is NAN; a channel that the file has not is NULL.
typedef struct moray_swim_log {
    char name[80]; // the end of the path
    int n, joints;
    int *line;                                 // [n] in the file
    double *t, *phi, *p_x, *p_y, *heading, *u; // [n], phi and u [n][joints]; heading without jumps of 2 pi
    bool reference;                            // phi is what was commanded
    bool at_motors;  // u is what the motors give, their own friction included, as logs of currents have it
    char notes[600]; // what is odd but no error, a line each
} moray_swim_log;

// How a file names and measures things.
typedef struct moray_swim_log_format {
    int joints;
    const char *columns;    // "t=Time,phi=servo#": columns of other names, # for the number of a joint; NULL: none
    const char *units;      // "phi=deg,p_x=mm": in place of those in brackets behind a name; NULL: none
    bool reference;         // joints from phi_ref_#, not from phi_#
    double torque_constant; // of motors whose u is in A, at the joint [N m/A]; NAN: none
} moray_swim_log_format;

// Reads comma-separated values: t, phi_# (or phi_ref_#), and any of p_x with p_y, heading, u_#; s, rad, m, N m unless a
// unit stands in brackets behind the name; other columns are ignored; a missing value is empty or nan. Error: MORAY_IO;
// MORAY_INPUT naming file, line, column, and what is allowed: a missing column or one of an unknown unit, text that is
// no number, times that do not ascend, fewer than 20 rows, angles beyond 2 pi and paths faster than 5 m/s whose unit
// was not said by format->units; MORAY_MEMORY. Free with moray_swim_log_free in any case.
MORAY_API moray_status moray_swim_log_read(moray_swim_log *log, const char *path, const moray_swim_log_format *format);
MORAY_API void moray_swim_log_free(moray_swim_log *log);

// Writes a log as moray_swim_log_read takes it, in place of the file at once. Error: MORAY_IO naming the file,
// MORAY_MEMORY.
MORAY_API moray_status moray_swim_log_save(const moray_swim_log *log, const char *path);

// Instruments of a synthetic log: standard deviations, offsets, delays, faults. All zero: perfect.
typedef struct moray_swim_log_noise {
    double position, heading, joints, torque; // standard deviations [m, rad, rad, N m]
    double heading_bias, camera[2], camera_rotation, position_delay, heading_delay; // as of moray_unknowns
    double outliers, missing; // shares of readings of position and heading
    unsigned long seed;
} moray_swim_log_noise;

// A log of the swimmer on a gait of its model, from rest at t = 0 straight at `heading`, recorded from `from` to `to`
// [s] every `step`. Joint angles of the control-oriented model are those of the gait mapped, without torques. An
// outlier is off by 20 standard deviations. Error: MORAY_INPUT, MORAY_MEMORY, MORAY_NUMERIC. Free with
// moray_swim_log_free.
MORAY_API moray_status moray_swim_log_swim(moray_swim_log *log, moray_swimmer *swimmer, const moray_gait *gait,
                                           double heading, double from, double to, double step,
                                           const moray_swim_log_noise *noise);

// ---- Unknowns ------------------------------------------------------------------------------------------------------

// The world that a log comes from. A camera sees R(camera_rotation) (p - camera); a compass reads heading +
// heading_bias; a delayed reading shows what was so long before.
typedef struct moray_unknowns {
    moray_robot robot;
    double current[2];
    double heading_bias, camera_rotation, camera[2];
    double position_delay, heading_delay, joint_delay; // joint_delay: by which the joints follow what the log says
} moray_unknowns;

enum { MORAY_MOST_UNKNOWNS = 20 };

// Index of an unknown by name ("c_t", "current_x", ...), or -1; name and unit of one; how many there are; whether the
// model feels it; the value.
MORAY_API int moray_unknown_named(const char *name);
MORAY_API const char *moray_unknown_name(int unknown); // NULL behind the last
MORAY_API const char *moray_unknown_unit(int unknown);
MORAY_API bool moray_unknown_applies(int unknown, const moray_robot *robot, moray_model model);
MORAY_API double *moray_unknown_at(int unknown, moray_unknowns *world);

// ---- Estimation ----------------------------------------------------------------------------------------------------

// What is measured. position: both coordinates.
typedef enum {
    MORAY_CHANNEL_X,
    MORAY_CHANNEL_Y,
    MORAY_CHANNEL_HEADING,
    MORAY_CHANNEL_TORQUE,
    MORAY_CHANNELS
} moray_channel_kind;
MORAY_API const char *moray_channel_name(moray_channel_kind kind);

typedef enum { MORAY_LOGGED_AUTO, MORAY_LOGGED_GAIT, MORAY_LOGGED_SPLINE } moray_logged_joints;

typedef struct moray_identify_spec {
    moray_model model;
    moray_unknowns start; // what is not estimated stays
    const int *unknown;   // [n] estimated
    int n;
    const double *lower, *upper;  // [n]
    double sigma[MORAY_CHANNELS]; // standard deviations; NAN: what the log scatters about a spline through it
    double huber;                 // residuals beyond so many sigma count linearly; 0: never
    bool rest;                    // every run begins at rest over ground
    moray_logged_joints joints;   // from a gait (25) fitted to the log, from splines, or whichever the log allows
    double step;                  // longest of the integration [s]; 0: a 120th of a period
    int max_iterations;
} moray_identify_spec;

// Logs with all that is needed to predict them; borrows the logs.
typedef struct moray_identify moray_identify;

// Error: MORAY_INPUT naming what is wrong: an unknown that the model does not feel, a start out of its bounds, joints
// that are no gait or have gaps; MORAY_MEMORY.
MORAY_API moray_status moray_identify_new(moray_identify **identify, const moray_identify_spec *spec,
                                          const moray_swim_log *log, int logs);
MORAY_API void moray_identify_free(moray_identify *identify);

// How the joints of a run were taken: "gait of ..., within 0.3 deg" or "splines of 60 pieces".
MORAY_API const char *moray_identify_joints(const moray_identify *identify, int run);
// The gait of the first-principles model fitted to the run's joint angles, its phase in time: angles at t are those of
// the gait at t + *shift. False where the joints are splines.
MORAY_API bool moray_identify_gait(const moray_identify *identify, int run, moray_gait *gait, double *shift);
MORAY_API double moray_identify_sigma(const moray_identify *identify, int run, moray_channel_kind kind);

enum { MORAY_IDENTIFY_RUNS = 12 };

// A point of the search: unknowns, and of each run theta, p_x, p_y, v_theta, v_1, v_2 at its first row.
typedef struct moray_estimate {
    double value[MORAY_MOST_UNKNOWNS];
    double first[MORAY_IDENTIFY_RUNS][MORAY_BODY_STATES];
    double cost;    // sum of squares of residuals over sigma, large ones by Huber
    int iterations; // of Levenberg and Marquardt
    bool converged;
    moray_status why; // it has no cost
} moray_estimate;

// The start of the spec with first states from the logs; or with unknowns drawn within their bounds, by the seed.
MORAY_API void moray_identify_start(const moray_identify *identify, unsigned long seed, moray_estimate *estimate);

// Improves it, to a step below 1e-10 of the scales or as far as rounding lets. Error: MORAY_NUMERIC where it cannot
// be swum.
MORAY_API moray_status moray_identify_solve(const moray_identify *identify, moray_estimate *estimate);

// From `starts` points, the first the spec's, by so many processes; the best first in estimate[starts].
MORAY_API moray_status moray_identify_search(const moray_identify *identify, int starts, int jobs,
                                             moray_estimate *estimate);

// The world of an estimate.
MORAY_API moray_unknowns moray_identify_world(const moray_identify *identify, const moray_estimate *estimate);

// ---- What the data say ---------------------------------------------------------------------------------------------

typedef struct moray_information {
    int n;
    double scale[MORAY_MOST_UNKNOWNS];                            // of the unknowns
    double matrix[MORAY_MOST_UNKNOWNS * MORAY_MOST_UNKNOWNS];     // [n][n], of unknowns over scale, initial states out
    double value[MORAY_MOST_UNKNOWNS];                            // eigenvalues, descending
    double vector[MORAY_MOST_UNKNOWNS * MORAY_MOST_UNKNOWNS];     // [n][n], row k of value k
    int rank;                                                     // directions that the data determine
    double covariance[MORAY_MOST_UNKNOWNS * MORAY_MOST_UNKNOWNS]; // [n][n] of what is determined
    double error[MORAY_MOST_UNKNOWNS];                            // standard errors; INFINITY: not determined
    bool held[MORAY_MOST_UNKNOWNS];                               // at a bound: does not vary
} moray_information;

// At an estimate. Error: MORAY_NUMERIC.
MORAY_API moray_status moray_identify_information(const moray_identify *identify, const moray_estimate *estimate,
                                                  moray_information *information);
// Eigenvalues, rank, covariance and errors of n, scale, matrix and held.
MORAY_API moray_status moray_information_examine(moray_information *information);
// "c_n and mu_n only as ...": what the data leave open, a line a direction, into text[size]; empty if nothing.
MORAY_API void moray_information_open(const moray_information *information, const int *unknown, char *text,
                                      size_t size);

// Residuals of one channel of one run: observed less predicted.
typedef struct moray_channel_fit {
    int run;
    moray_channel_kind kind;
    int joint, n;
    double sigma, rms;              // rms in sigma
    double lag, portmanteau, limit; // correlation of neighbours; Ljung and Box's sum of 10 lags, and what it exceeds by
                                    // chance in one of 1000
    int outliers;                   // beyond 5 sigma
    int worst;                      // row of the largest
} moray_channel_fit;

typedef struct moray_residual_point {
    double t, observed, predicted, sigma;
    int run, row, channel; // of the list of channels
} moray_residual_point;

typedef struct moray_identify_fit {
    int n, freedom, channels;
    double chi2, limit; // and what it exceeds by chance in one of 1000
    moray_channel_fit *channel;
    moray_residual_point *point; // [n], channel by channel
    bool simple;                 // residuals are no noise: the model is too simple, or a sensor is not as told
    char verdict[300];
} moray_identify_fit;

// Error: MORAY_INPUT where there are no more measurements than unknowns; MORAY_NUMERIC, MORAY_MEMORY.
MORAY_API moray_status moray_identify_residuals(const moray_identify *identify, const moray_estimate *estimate,
                                                moray_identify_fit *fit);
MORAY_API void moray_identify_fit_free(moray_identify_fit *fit);

// ---- The next experiment --------------------------------------------------------------------------------------------

enum { MORAY_DESIGNED = 4 };

typedef struct moray_design_spec {
    double lower[MORAY_DESIGNED], upper[MORAY_DESIGNED]; // alpha, omega, delta, phi_0 of the first-principles model
    double most_rate;                                    // of alpha omega [rad/s]; INFINITY: none
    double duration;                                     // of the run, from rest [s]
    bool least;      // makes the least known direction best known (E-optimal), not the volume of the intervals (D-)
    int evaluations; // gaits tried, by draws and a local search; a few hundred at most
} moray_design_spec;

// The gait whose log, read at the rate and by the instruments of the first log, adds most to what is known, and what is
// known with it. Error: MORAY_NOT_SOLVED where no gait within the limits can be swum, or every unknown is at a bound;
// MORAY_MEMORY, MORAY_NUMERIC.
MORAY_API moray_status moray_identify_design(const moray_identify *identify, const moray_estimate *estimate,
                                             const moray_information *known, const moray_design_spec *spec,
                                             moray_gait *gait, moray_information *after);

// ---- What is left open, as scenarios --------------------------------------------------------------------------------

typedef struct moray_world_name {
    char text[40];
} moray_world_name;

// World 0: the estimate; then two on each principal axis of what is not known, the least known first, at the ends of
// its interval of 95 % (standard errors times inflation; where it is open half a scale away) within the bounds. At most
// `most` worlds; returns how many.
MORAY_API int moray_identify_worlds(const moray_identify *identify, const moray_estimate *estimate,
                                    const moray_information *information, double inflation, int most,
                                    moray_unknowns *world);

// Their unknown[unknowns] as comma-separated values, a row each, and back: what a file leaves out is that of base.
// Error of reading: MORAY_IO; MORAY_INPUT naming line and column; MORAY_MEMORY.
MORAY_API void moray_worlds_write(const moray_unknowns *world, int n, const int *unknown, int unknowns, FILE *file);
MORAY_API moray_status moray_worlds_read(const char *path, const moray_unknowns *base, int most, moray_unknowns *world,
                                         moray_world_name *name, int *n);

MORAY_END

#endif
