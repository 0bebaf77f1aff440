// SPDX-License-Identifier: MIT
//
// One trial, tune and report of steering. A program has a problem of its own and a table of laws; a trial steers by one
// of them on both models.
#ifndef PROBLEMS_STEERING_STEER_H
#define PROBLEMS_STEERING_STEER_H

#include <math.h>

#include "clock.h"
#include "degree.h"
#include "moray/moray.h"
#include "moray/snake.h"

enum {
    STEER_TRIALS = 16,
    STEER_GAITS = 3,
    STEER_NUMBERS = 5,
    STEER_SUBSETS = 3,
    STEER_SCORES = 6,
    STEER_TEXT = 1600,
    STEER_WORDS = 16
};

typedef struct steer_input {
    double theta_max[2], omega[2], delta[2]; // ranges
    double offset, offset_rate;              // of the control-oriented model [m], [m/s]
    double power;                            // [W]; NaN: what the paper's gait uses
} steer_input;

typedef struct steer_job steer_job;
typedef struct steer_trial steer_trial;

// ---- What a program is made of -------------------------------------------------------------------------------------

// A number that laws are tuned by.
typedef struct steer_number {
    const char *key;    // in JSON
    const char *column; // of the table
    double unit;        // there
    moray_tuned_number searched;
} steer_number;

// A mean or largest value by which a trial is judged, in JSON.
typedef struct steer_score {
    const char *key;
    double unit;
} steer_score;

// A column of the table of scores.
typedef struct steer_column {
    const char *title;
    moray_model model; // swum on
    int score;         // or STEER_SPENT
    double unit;
    bool rounded; // zero where it is as good as zero
} steer_column;
enum { STEER_SPENT = -1 }; // simulations spent on tuning

// One law on one model; must stay where it is.
typedef struct steer_steersman {
    const steer_job *job;
    const steer_trial *trial;
    moray_model model;                    // of the swimmer
    moray_plan plan;                      // of the trial, for that model
    const moray_straight_motion *planned; // by the plan
    moray_feedback feedback;
    moray_swim_receding_horizon *receding;
    moray_path_seeker seeker;
    union {
        moray_guidance guidance;
        moray_heading_law law;
        moray_heading_replanner heading;
        moray_path_replanner path;
        struct steer_bang {
            double limit, ramp, hold, brake; // limit with its sign [m or rad], times [s]
        } bang;
    } own; // of some laws
    moray_swim_controller controller;
} steer_steersman;

typedef enum { STEER_UNPLANNED, STEER_PLANNED, STEER_RECEDING } steer_kind;

typedef struct steer_law {
    const char *key;                                 // in JSON
    steer_kind kind;                                 // whether it knows a plan, or makes plans anew
    bool preview;                                    // the reference is known ahead
    moray_status (*set)(steer_steersman *steersman); // the controller; NULL: the plan, blindly
    unsigned tuned;                                  // bits of the numbers that are
    double start[STEER_NUMBERS];                     // of the search; of those not tuned the value, NaN: it has none
    int curve;                                       // from 1: which of the figures; 0: none
} steer_law;

enum { STEER_CURVES = 3, STEER_POINTS = 400 };
typedef struct steer_tables steer_tables;

typedef struct steer_program {
    // Makes plans, chooses trials, runs them. Error: MORAY_NOT_SOLVED saying what limits the robot, MORAY_INTERRUPTED.
    moray_status (*work)(steer_job *job);
    void (*release)(steer_job *job); // of what is the program's own; or NULL
    bool one_gait;                   // number 0, for all trials
    const steer_law *laws;
    const steer_number *numbers; // [n_numbers], or copied to the job where the ranges are found along the way
    int n_numbers;
    double rough_per_second; // samples of the simulations that tune
    // Where and how long the trial swims.
    void (*start)(steer_steersman *steersman, moray_swim_closed_loop_spec *spec);
    // Fills score[] in SI units; returns what tuning minimises.
    double (*judge)(const steer_trial *trial, const steer_steersman *steersman,
                    const moray_swim_closed_loop *closed_loop, double *score);
    const steer_score *scores;
    int n_scores;
    const char *score_title;
    const steer_column *columns;
    // Report.
    const char *title;
    const moray_meaning *words; // what names of its own stand for; up to one without a name
    void (*tables)(const steer_job *job, steer_tables *tables);
    void (*headline)(const steer_job *job, FILE *file);
    void (*conclude)(const steer_job *job, char *text, size_t size); // how optimised steering does against the rest
    void (*explain)(const steer_job *job, char *text, size_t size);  // what keeps the robot from doing better
    void (*doubt)(const steer_job *job, moray_model model, char *text, size_t size); // of a certificate failed, or NULL
    void (*notes)(const steer_job *job, FILE *file);                                 // or NULL
    double (*swum)(const steer_job *job, const steer_trial *trial); // on plans of a receding horizon [s]; or NULL
    bool tells_name, tells_preview;                                 // of a trial, in JSON
    const char *duration;                                           // before a plan's, beside its solver; or NULL
    void (*json_head)(const steer_job *job, moray_json *json);
    void (*json_plan)(const steer_job *job, moray_json *json, moray_model model);
    void (*json_tail)(const steer_job *job, moray_json *json); // or NULL
    // Figures: over time, a value for every sample, without a trial the reference (false: there is none); the path to
    // be followed, or NULL; more, or NULL.
    moray_figure over_time;
    bool (*values)(const steer_job *job, const steer_trial *trial, const moray_swim_track *track, double *values);
    void (*path)(const steer_job *job, double x[STEER_POINTS], double y[STEER_POINTS]);
    moray_status (*draw)(const steer_job *job);
} steer_program;

// ---- A job ---------------------------------------------------------------------------------------------------------

// One way of steering, on both models.
struct steer_trial {
    const char *name;
    const steer_law *law;
    int gait;                                 // swum
    moray_model plan;                         // whose plan
    const steer_trial *subset[STEER_SUBSETS]; // laws that leave some of its numbers out: tuned before, its search
                                              // starts from theirs too, so that it is never worse; NULL: none
    double number[STEER_NUMBERS];             // tuned; gains of the control-oriented model
    double tuned_cost;                        // of these, as tuning had it
    int evaluations, searches, agree;         // spent on tuning; local searches, and those that came to the same
    unsigned tuned;                         // bits of its law's numbers that are searched: not those that move nothing
    bool run, barred;                       // barred: takes more than the power allowed
    bool away;                              // in the hands of another process
    bool cut;                               // its tuning was ended by the time given
    double score[2][STEER_SCORES], cost[2]; // by the model swum on
    moray_receding_horizon_record record[2];
};

enum { STEER_AVERAGED = 2, STEER_ERRANDS = 3 }; // a plan beside those of the models

// Trials that another process runs, and plans that it certifies: bits.
typedef struct steer_errand {
    moray_background *background;
    unsigned trials, plans;
} steer_errand;

struct steer_job {
    moray_common common;
    moray_snake_options snake; // model: of the last plan; with fp there is one on the control-oriented model before
    steer_input input;
    double weight_steering;
    int intervals_per_period, refinements;
    int starts, evaluations, jobs; // of tuning, as of moray_tuning_settings
    double replan_periods, look_ahead_periods;
    bool receding;
    steer_clock clock;
    char water_file[MORAY_PATH_SIZE]; // empty: the current is uniform
    // found along the way
    moray_status without; // why there is no first-principles plan though it was asked for; ok: there is, or it was not
    const char *name;     // of the program
    const steer_program *program;
    moray_water *water; // owned; NULL: uniform, else snake.current is typical of it
    steer_number number[STEER_NUMBERS];
    moray_straight_motion straight[STEER_GAITS][2]; // of the paper's gait, those of the plans; by the model swum on
    moray_steering_plan plan[3];                    // owned; without a solution: not yet made
    moray_certificate certificate[2];
    const moray_solution *certified[2]; // whose certificates these are; NULL: none yet
    double turn_rate[2];                // sustained at the limit of the offset [rad/s], with its sign
    steer_trial trial[STEER_TRIALS];
    int n_trials;
    unsigned left_out; // bits of the trials that are not to be run now
    steer_errand errand[STEER_ERRANDS];
    int n_errands;
    moray_swim_scene *scene; // of the report, while it is written
    moray_ticker ticker;
};

// First-principles model, radau5, mesh by the period.
steer_job steer_defaults(void);

// Runs a program, whose options are its own and those of the snake; the job is what it begins with. Returns the exit
// code.
int steer_main(const moray_program *own, const steer_program *program, int argc, char **argv, steer_job *job);

static inline const moray_steering_plan *steer_last_plan(const steer_job *job)
{
    return &job->plan[job->snake.model];
}

// ---- Gaits and limits ----------------------------------------------------------------------------------------------

// Where --water is given: reads it, and makes the current of the job its mean over n places [m] at t = 0. Error: those
// of moray_water_read; MORAY_INPUT where a place is not in the table.
moray_status steer_read_water(steer_job *job, const double (*place)[2], int n);

// Whether the ranges leave no choice of a gait.
bool steer_gait_given(const steer_job *job);

// The gait of the ranges nearest to the paper's, of the control-oriented model.
moray_gait steer_first_gait(const steer_job *job);

// Of the model. Offsets are in the ratio of the amplitudes of the first gait; the power is that of the paper's gait.
moray_steering_limits steer_limits(const steer_job *job, moray_model model);

// From *gait to the fastest one of the model straight ahead, within the ranges and the power [W].
// Error: those of moray_gait_search_new and _run; MORAY_NOT_SOLVED when no gait gets by with the power.
moray_status steer_fastest_gait(steer_job *job, moray_model model, double power, moray_gait *gait);

// Of gait number `index`, on both models.
moray_status steer_straight_motions(steer_job *job, int index, const moray_gait *gait, moray_model from);

// Turning at the limit of the offset on a gait.
moray_status steer_find_turn_rate(steer_job *job, moray_model model, const moray_gait *gait);

// Offsets of the one model per offset of the other, with the gait of that number (erratum E3).
double steer_offset_ratio(const steer_job *job, int gait, moray_model from, moray_model to);

// ---- Plans ---------------------------------------------------------------------------------------------------------

#define STEER_AVERAGED_SCHEME "radau3"

// Of a solve on the averaged plant, on one mesh, or on the full one.
moray_settings steer_settings(steer_job *job, bool averaged, int intervals, double mesh_tolerance, double barrier);

// Whether a solve found what was asked for, if only on a mesh before that which the time given cut off.
bool steer_solved(const moray_solution *solution);

// Whether the time given, or Ctrl-C, ended it.
static inline bool steer_cut_short(const moray_solution *solution)
{
    return moray_solution_info(solution)->outcome == MORAY_NLP_INTERRUPTED;
}

// Whether a plan is of use to begin one of this model from: the models turn within a factor of two as fast.
bool steer_alike(const steer_job *job, moray_model model, const moray_steering_plan *from);

// Goes on without the first-principles plan that failed for this reason, where there is a control-oriented one: the
// model is that from then on, and trials are to be chosen anew. Error: the reason, where it is another or there is
// none.
moray_status steer_do_without(steer_job *job, moray_status reason);

// The first sentences of a solution's diagnosis as an error; of an interrupted one MORAY_INTERRUPTED.
moray_status steer_not_solved(const moray_solution *solution);

double steer_duration(const moray_solution *solution);

// Share of the time in which the last plan's offset, or its rate, is at its limit.
typedef struct steer_saturation {
    double offset, rate;
} steer_saturation;
steer_saturation steer_saturation_of(const steer_job *job, moray_model model);

// ---- Laws and trials -----------------------------------------------------------------------------------------------

// For the tables of laws: the plan's offset, and feedback towards its heading, whose gain is the one number tuned.
moray_status steer_set_both(steer_steersman *steersman);

// Feedback of this gain; target, feed and self as of a moray_feedback.
void steer_set_feedback(steer_steersman *steersman, double gain, double (*target)(const moray_swim_sample *, void *),
                        double (*feed)(const moray_swim_sample *, double, void *), void *self);

// Receding horizon with this replanner, whose limits it sets; look: between two looks for a change [s].
moray_status steer_set_receding(steer_steersman *steersman, const char *scheme, moray_replanner replanner,
                                moray_steering_limits *limits, double look, const moray_solution *first);

// Adds a trial of the law, with its starting numbers.
steer_trial *steer_add(steer_job *job, const char *name, const steer_law *law, int gait, moray_model plan);

// Adds trials for the plans of both models, blindly and with feedback; in receding horizon if the job has that.
void steer_add_plans(steer_job *job, const steer_law *blind, const steer_law *both);
void steer_add_receding(steer_job *job, const steer_law *law);

// Certifies the plans that are not yet, at the same time tunes and swims every trial not yet run whose gait and plan
// are known, in equal shares of the time that is left; one that does not end in its share stays not run. Error: those
// of moray_certify and moray_swim_closed_loop_run, MORAY_INTERRUPTED.
moray_status steer_run_trials(steer_job *job);

// Begins the same in a process of its own, with half of the job's processes, while this one makes another plan;
// steer_run_trials, or steer_end_errands by itself, takes over what it found. Where the job has one process alone, it
// is done at once. Error: those of steer_run_trials.
moray_status steer_begin_trials(steer_job *job);
moray_status steer_end_errands(steer_job *job);

// Takes over from n trials what was found of those that job has too.
void steer_keep_trials(steer_job *job, const steer_trial *before, int n);

// Swims one of them again, to be drawn.
moray_status steer_swim(const steer_job *job, const steer_trial *trial, moray_swim_closed_loop *closed_loop);

// Progress of a search, its observer the job, that Ctrl-C or the time given ends; and MORAY_INTERRUPTED after Ctrl-C.
bool steer_go_on(void *observer, const moray_search_progress *progress);
moray_status steer_interruption(void);

// ---- Report --------------------------------------------------------------------------------------------------------

enum { STEER_TABLES = 4, STEER_ROWS = 16 };
struct steer_tables {
    int n;
    moray_table table[STEER_TABLES];
    moray_table_row rows[STEER_TABLES][STEER_ROWS];
    char label[STEER_ROWS][40];
};

// Adds a table; its rows are those of the tables at that place, filled in before.
void steer_add_table(steer_tables *tables, const moray_table *table);

void steer_gait_table(const steer_job *job, steer_tables *tables, int first); // 1: without the paper's, it is given
void steer_score_table(const steer_job *job, steer_tables *tables, int n_columns);
void steer_tuning_table(const steer_job *job, steer_tables *tables);

// The best on the first-principles model by a score, of the trials whose law is one of the bits, that have run and are
// not barred; NULL: none.
const steer_trial *steer_best(const steer_job *job, unsigned laws, int score);

// The same of those on one gait; and the trial of a law with the last plan. NULL: none has run.
const steer_trial *steer_best_on(const steer_job *job, int gait, unsigned laws, int score);
const steer_trial *steer_last_trial(const steer_job *job, int law);

// Begins a text with the limit; adds to one.
void steer_say_limit(const steer_job *job, char *text, size_t size); // "With |phi_0| at its limit ... the robot turns"
void steer_say_saturation(const steer_job *job, char *text, size_t size); // behind a "T" or "t"

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status steer_report(steer_job *job);
void steer_json_gait(const steer_job *job, moray_json *json, int gait);
void steer_json_saturation(const steer_job *job, moray_json *json, moray_model model);

// What moray_results wants of a job: the summary; figures and trajectory.csv. Error: MORAY_IO, MORAY_MEMORY, those of
// moray_swim_closed_loop_run.
void steer_summary(const void *job, moray_json *json);
moray_status steer_write(const void *found, moray_output *output);

// Where gnuplot does not draw, says so on standard error unless quiet. Error: MORAY_MEMORY, MORAY_INPUT.
moray_status steer_draw_figure(const steer_job *job, const moray_figure *figure);

#endif
