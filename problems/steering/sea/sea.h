// SPDX-License-Identifier: MIT
//
// Trials at sea: many draws of robot, current and noise, each swum under every law; what a planner knows is apart from
// what is true.
#ifndef PROBLEMS_STEERING_SEA_SEA_H
#define PROBLEMS_STEERING_SEA_SEA_H

#include "degree.h"
#include "moray/moray.h"
#include "moray/snake.h"
#include "steering/clock.h"

enum { SEA_HEADING, SEA_PATH }; // tasks
#define SEA_BESIDE 0.5          // of a path, where it begins [m]
enum { SEA_MOST_SEEDS = 2000, SEA_LAWS = 11, SEA_NUMBERS = 5, SEA_SCORES = 3, SEA_COEFFICIENTS = 4 };

typedef struct sea_job sea_job;

// One draw: what is true, and what a planner that is told everything knows.
typedef struct sea_draw {
    unsigned long seed;
    moray_robot robot;
    double current[2], current_turning; // at the start [m/s]; [rad/s]
    moray_reference reference;          // owned
    moray_straight_motion straight;     // of the robot
    moray_belief truth;
    moray_steering_plan plan; // of the heading, on the robot believed; owned
    double turn;              // rate of turning per offset of the control-oriented model [rad/(s m)]
} sea_draw;

// A law at sea. Laws with numbers are tuned; the others plan.
typedef struct sea_law {
    const char *name, *told; // what it was told of robot and current, for the table
    unsigned tuned;          // bits of the numbers
    double start[SEA_NUMBERS];
    int subset[3];   // laws that leave some of the numbers out; -1: none
    bool collocated; // its numbers come from a robust plan over the training draws, not from the tuner
    // Of who plans, anew and anew or beforehand; a plan made beforehand is one with tuned feedback, and no rival. Over
    // all: beforehand too, one plan with its gain for all robots of the training draws.
    enum { SEA_TOLD, SEA_BELIEVING, SEA_ESTIMATING, SEA_BEFOREHAND, SEA_OVER_ALL } knows;
} sea_law;

// Of a trial. Heading: RMS and largest error [rad], power [W]; path: RMS distance [m], time to its end (the longest
// given where it is not reached) [s], cost as of path_following.
typedef struct sea_score {
    double value[SEA_SCORES];
    double cost; // what tuning minimises
    bool known;
    int failures; // of a receding horizon's plans
} sea_score;

// Estimates at the end of a swim: how far off the current is [m/s], and the factors of thrust and turning as shares,
// of an unscented filter and of a moving horizon.
enum { SEA_CURRENT, SEA_THRUST, SEA_TURNING, SEA_ESTIMATED, SEA_ESTIMATORS = 2 };
typedef struct sea_estimate {
    double value[SEA_ESTIMATORS][SEA_ESTIMATED];
    bool known;
} sea_estimate;

struct sea_job {
    moray_common common;
    moray_snake_options snake; // of the plant, before the draw
    int task;
    char rung[32];   // "own" or of the ladder: the plant's hydrodynamics
    double duration; // [s]; of a path at most
    char path_text[MORAY_PATH_SIZE];
    double radius;
    double offset, offset_rate; // limits, of the control-oriented model
    // planner
    double factor[SEA_COEFFICIENTS]; // of c_n, c_t, mu_n, lambda: what it believes over what the robot's are
    int hydrodynamics;               // a moray_robot's, as it believes
    char believed_current[64];       // "unknown" or "VX,VY"
    // instruments
    moray_sensors sensors;
    double gyro; // its standard deviation [rad/s]; infinite: there is none
    moray_actuators actuators;
    // draws
    int seeds, first_seed, training;
    double current_most, current_turning, spread; // [m/s], [rad/s], of the coefficients
    // tuning and planning
    int starts, evaluations, jobs;
    double replan_periods, look_ahead_periods, weight_steering;
    char results[MORAY_PATH_SIZE]; // file of trials done; empty: none
    steer_clock clock;
    char tuned[MORAY_PATH_SIZE]; // file of what the rivals are tuned to; empty: none
    // found along the way
    moray_path path;
    moray_steering_plan plan; // of it, on the robot believed
    int drawn;                // draws there are
    int wanted;               // seeds asked for, where the time given ended the trials before; `seeds` are those swum
    moray_robot believed;
    moray_straight_motion believed_straight;
    moray_belief belief;
    moray_gait gait; // of the control-oriented model: the paper's, for all
    double scale;    // offsets of the plant's model per offset of that
    sea_draw *draw;  // [seeds + training], the latter behind
    double number[SEA_LAWS][SEA_NUMBERS];
    double tuned_cost[SEA_LAWS];
    int tuned_by[SEA_LAWS];
    sea_score *score;       // [seeds][SEA_LAWS]
    sea_estimate *estimate; // [seeds]
    moray_ticker ticker;
};

extern const moray_tuned_number sea_numbers[2][SEA_NUMBERS];
extern const char *const sea_number_names[2][SEA_NUMBERS];
int sea_laws(const sea_job *job, const sea_law **laws); // how many

// Draws all scenarios and what is believed. Error: MORAY_INPUT, those of moray_straight_motion_find.
moray_status sea_prepare(sea_job *job);
void sea_release(sea_job *job);

// Swims one draw under a law with these numbers.
moray_status sea_swim(const sea_job *job, const sea_draw *draw, int law, const double *number, sea_score *score);

// The same, of which the track is left; free with moray_swim_closed_loop_free.
moray_status sea_record(const sea_job *job, const sea_draw *draw, int law, const double *number,
                        moray_swim_closed_loop *closed_loop);

// What who estimates, or is told, begins with.
moray_navigator_spec sea_navigator_spec(const sea_job *job, const sea_draw *draw, int knows);

// Estimates of all seeds. Error: those of moray_parallel.
moray_status sea_estimate_all(sea_job *job);

// Tunes what is tuned on the training draws, in half of the time given; swims all seeds, or as many as that leaves time
// for. Error: MORAY_INTERRUPTED, MORAY_IO, those of the trials; MORAY_NOT_SOLVED where the time ended before the first.
moray_status sea_tune(sea_job *job);
moray_status sea_run(sea_job *job);

// Problems on the averaged plant of the robot believed, without limits.
moray_heading_spec sea_heading_spec(const sea_job *job, const sea_draw *draw);
moray_path_spec sea_path_spec(const sea_job *job, double speed);

// Plans made beforehand, into the draw or the job. Error: MORAY_NOT_SOLVED, those of moray_heading_plan_make and
// moray_path_plan_make.
moray_status sea_plan_heading(sea_job *job, sea_draw *draw);
moray_status sea_plan_path(sea_job *job);

// What the numbers of the rivals and the trials rest on, on one line.
void sea_signature(const sea_job *job, char *text, size_t size);

// The numbers of the rivals from the file `tuned` and into it; nothing where none is named. *found: they were there.
// Error: MORAY_INPUT (of other settings, damaged), MORAY_IO.
moray_status sea_tuned_read(sea_job *job, bool *found);
moray_status sea_tuned_write(const sea_job *job);

// Gain, forward and integral numbers of a law by collocation over the training draws; those it began with where that
// does not solve, told. Error: those of moray_robust_gains.
moray_status sea_robust(const sea_job *job, double number[SEA_NUMBERS]);

// From a heading to the offset that answers it, on average [s].
double sea_lag(const sea_job *job);

// The draw's reference planned for the robots of all training draws together, its gain from that of `number` on. Error:
// those of moray_robust_plan_make. Free with moray_robust_plan_free.
moray_status sea_robust_plan(const sea_job *job, const sea_draw *draw, const double *number, moray_robust_plan *plan);

// Largest multipliers of the stroboscopic map of the believed robot with a law's gain around its heading and, with a
// lookahead, its offset; without numbers of nobody's steering. NaN where there are none.
void sea_multipliers(const sea_job *job, const double *number, double largest[2]);

// Number of the score that laws are compared by; and what it is called in tables, with its unit.
int sea_judged_by(const sea_job *job);
const char *sea_judged_name(const sea_job *job);
// A share of the trials' values of a law in the units of the tables, or of their differences to another's (other < 0:
// none).
double sea_quantile(const sea_job *job, int law, int other, int which, double share);

moray_status sea_draw_figures(const void *found, moray_output *output);
moray_status sea_report(const sea_job *job);

#endif
