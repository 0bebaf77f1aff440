// SPDX-License-Identifier: MIT
//
// What the programs that steer share: gait and offset limits as options, and figures of closed_loops.
#ifndef PROBLEMS_STEERING_STEER_H
#define PROBLEMS_STEERING_STEER_H

#include <math.h>

#include "moray/moray.h"
#include "moray/snake.h"

#define DEG (M_PI / 180)

typedef struct steer_input {
    double theta_max[2], omega[2], delta[2]; // ranges
    double offset, offset_rate;              // of the control-oriented model [m], [m/s]
    double power;                            // [W]; NaN: what the paper's gait uses
} steer_input;

steer_input steer_input_default(void);

#define STEER_RANGE(settings, place, name, low, high, in, text)                                                        \
    {                                                                                                                  \
        .section = "problem", .key = name, .type = MORAY_OPTION_RANGE, MORAY_AT(settings, place), .min = low,          \
        .max = high, .unit = in, .help = text                                                                          \
    }
#define STEER_LIMIT(settings, place, name, in, text)                                                                   \
    {                                                                                                                  \
        .section = "problem", .key = name, .type = MORAY_OPTION_LIMIT, MORAY_AT(settings, place), .min = 0,            \
        .max = INFINITY, .open = true, .unit = in, .help = text                                                        \
    }
#define STEER_REAL(settings, place, part, name, low, high, in, text)                                                   \
    {                                                                                                                  \
        .section = part, .key = name, .type = MORAY_OPTION_REAL, MORAY_AT(settings, place), .min = low, .max = high,   \
        .unit = in, .help = text                                                                                       \
    }
#define STEER_INT(settings, place, part, name, low, high, text)                                                        \
    {                                                                                                                  \
        .section = part, .key = name, .type = MORAY_OPTION_INT, MORAY_AT(settings, place), .min = low, .max = high,    \
        .help = text                                                                                                   \
    }
#define STEER_OPTIONS(settings, field)                                                                                 \
    STEER_RANGE(settings, field.theta_max, "theta_max_deg", 0.1, 89, "deg", "link-angle amplitude of (24)"),           \
        STEER_RANGE(settings, field.omega, "omega_deg_s", 1, 3600, "deg/s", "gait frequency"),                         \
        STEER_RANGE(settings, field.delta, "delta_deg", 1, 179, "deg", "phase shift between joints"),                  \
        STEER_REAL(settings, field.offset, "problem", "phi0_max_m", 1e-6, 0.5, "m",                                    \
                   "largest joint offset of the control-oriented model; of the other in the ratio of amplitudes"),     \
        STEER_REAL(settings, field.offset_rate, "problem", "phi0_rate_m_s", 1e-6, 10, "m/s",                           \
                   "largest rate of the offset, likewise"),                                                            \
        STEER_LIMIT(settings, field.power, "power_W", "W",                                                             \
                    "mean joint power; by default what the paper's gait uses straight ahead in the same model, none "  \
                    "where the gait is given")

// Whether the ranges leave no choice of a gait.
bool steer_gait_given(const steer_input *input);

// The gait of the ranges nearest to the paper's, of the control-oriented model.
moray_gait steer_first_gait(const steer_input *input, const moray_robot *robot);

// Limits of the model; `straight` is of the paper's gait in it, for the power. Offsets are in the ratio of the
// amplitudes of the first gait.
moray_steering_limits steer_limits(const steer_input *input, const moray_robot *robot,
                                   const moray_straight_motion *straight);

// Largest share of [t0, t1] in which the solution's offset, or its rate, is at its limit.
typedef struct steer_saturation {
    double offset, rate;
} steer_saturation;
steer_saturation steer_saturation_of(const moray_solution *solution, const moray_steering_limits *limits);

// The first sentences of a solution's diagnosis, on one line.
void steer_diagnosis(const moray_solution *solution, char *text, size_t size);

// ---- Gaits and models ----------------------------------------------------------------------------------------------

// From *gait to the fastest one of the first-principles model straight ahead, within the ranges and the power [W].
// Error: those of moray_gait_search_new and _run; MORAY_NOT_SOLVED when no gait gets by with the power.
moray_status steer_fastest_gait(const steer_input *input, const moray_robot *robot, double power, moray_gait *gait);

// Of one gait on both models.
moray_status steer_straight_motions(moray_straight_motion straight[2], const moray_robot *robot, const moray_gait *gait,
                                    moray_model from);

// Offsets of the one model per offset of the other, with erratum E3.
double steer_offset_ratio(const moray_straight_motion straight[2], moray_model from, moray_model to);

// Limits of plans on the gait of the straight that keep both their own offset limits and, times `scale`, the swimmer's.
moray_steering_limits steer_replanning_limits(const moray_robot *robot, const moray_straight_motion *straight,
                                              const moray_steering_limits *own, const moray_steering_limits *swum,
                                              double scale);

// Progress of a search that Ctrl-C ends.
bool steer_go_on(void *observer, const moray_search_progress *progress);

// MORAY_INTERRUPTED after Ctrl-C.
moray_status steer_interruption(void);

// ---- Figures -------------------------------------------------------------------------------------------------------

// A closed_loop to be drawn.
typedef struct steer_curve {
    const char *label;
    const moray_closed_loop *closed_loop;
} steer_curve;

// Draws a figure; where gnuplot does not, says so on standard error unless quiet. Error: MORAY_MEMORY, MORAY_INPUT.
moray_status steer_draw(moray_output *output, bool quiet, const char *program, const moray_figure *figure);

// path.svg: the paths of the closed_loops, the robot along the last, the current as an arrow; and the curves of `more`.
moray_status steer_draw_path(const moray_common *common, const char *program, const steer_curve *curves, int n,
                             const moray_curve *more, int n_more);

// joints.svg: joints at the tail, in the middle and at the head while the closed_loop steers most.
moray_status steer_draw_joints(const moray_common *common, const char *program, const moray_closed_loop *closed_loop);

// trajectory.csv of a closed_loop. Error: MORAY_IO, MORAY_MEMORY.
moray_status steer_write_trajectory(const moray_common *common, const moray_closed_loop *closed_loop);

#endif
