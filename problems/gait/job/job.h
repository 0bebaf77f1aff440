// SPDX-License-Identifier: MIT
//
// What the programs that optimise one gait share: options, both stages of the optimisation, proof and report.
#ifndef PROBLEMS_GAIT_JOB_JOB_H
#define PROBLEMS_GAIT_JOB_JOB_H

#include <math.h>

#include "degree.h"
#include "moray/moray.h"
#include "moray/snake.h"

typedef struct gait_job gait_job;

// One optimisation: the problem on one model, its best solution, and what the gait is worth when it is swum.
typedef struct stage {
    moray_model model;
    double power; // limit of the mean, of joints or motors [W], or infinite
    double speed; // least speed along the course [m/s], or 0
    double taper[2];
    double link_angle;               // bound of |link angle - heading| in place of that of theta_max [rad]; 0: none
    moray_gait_problem *problem;     // of the one, or
    moray_gait_over *over;           // of the one gait for several models, of which
    int phase;                       // this is the one whose prediction is shown
    moray_solution *solution, *from; // from: of --continue, where it is of this stage
    int starts, agreeing;            // how many, and how many of them ended at the best solution
    double *iterations;              // [starts] of each, NaN where it could not be begun
    int tried;                       // of them
    moray_certificate certificate;
    moray_gait_prediction prediction;
    moray_gait_trial trial;
    moray_gait_gain gain; // over the paper's gait
    moray_ladder_row ladder[MORAY_RUNGS];
    unsigned found_on; // rungs, as of moray_ladder_verdict
    bool left_out;     // there is no such gait, because of
    moray_status why;
} stage;

// A model, in a current, of a gait that is optimised for several.
typedef struct scenario {
    char name[48]; // as it is given, "consistent@0.1,0.1"
    int rung;
    bool read; // from a file: robot in place of the rung's
    moray_robot robot;
    double current[2]; // [m/s]
    double gain;       // of that gait over the baseline there, a ratio, when it is found
} scenario;

typedef struct scenarios {
    int n;
    scenario at[MORAY_SCENARIOS];
} scenarios;

struct gait_job {
    moray_common common;
    moray_snake_options snake; // model fp: both stages, control-oriented first; control: that alone
    const char *name;          // of the program
    moray_gait_goal goal;
    double theta_max[2], omega[2], delta[2], offset[2], offset_angle[2], taper[2];
    double power, speed; // NaN: what the paper's gait uses and makes
    double joint_rate, joint_effort;
    moray_joints joints;
    int random_starts, refinements; // refinements: finer meshes tried where the first does not pass the certificate
    char over[MORAY_PATH_SIZE];     // names of rungs, with @VX,VY behind those in another current; empty: none
    int over_goal;                  // a moray_over_goal
    int jobs;                       // processes; 0: one a processor
    char from_file[MORAY_PATH_SIZE], solution_file[MORAY_PATH_SIZE]; // of --continue, --solution; empty: none
    moray_test_rig rig;
    moray_gait_trial paper;
    moray_status no_paper[2]; // by model: why it cannot be swum; ok where it is
    stage stage[2];           // by model
    stage ladder;             // the gait optimised for job->over; used where `over` is
    scenarios scenarios;      // those of the same
    moray_ticker ticker;
};

static inline const stage *last_stage(const gait_job *job)
{
    return &job->stage[job->snake.model];
}

// The gait that the program recommends.
static inline const stage *recommended(const gait_job *job)
{
    return job->ladder.solution && !job->ladder.left_out ? &job->ladder : last_stage(job);
}

#define GAIT_RANGE(name, field, low, high, in, text)                                                                   \
    {                                                                                                                  \
        .section = "problem", .key = name, .type = MORAY_OPTION_RANGE, MORAY_AT(gait_job, field), .min = low,          \
        .max = high, .unit = in, .help = text                                                                          \
    }
#define GAIT_LIMIT(name, field, in, text)                                                                              \
    {                                                                                                                  \
        .section = "problem", .key = name, .type = MORAY_OPTION_LIMIT, MORAY_AT(gait_job, field), .min = 0,            \
        .max = INFINITY, .open = true, .unit = in, .help = text                                                        \
    }

// What makes a program of this: its goal, its own options besides those of every gait job, its defaults in the job. And
// where it does not optimise, prove and report one gait: what it does, tells, whether all it found is certified, and
// how what it holds besides is freed.
typedef struct gait_program {
    const char *name, *summary;
    moray_gait_goal goal;
    const moray_option *options;
    int n_options;
    double power, speed; // defaults
    bool continues;      // has --continue and --solution though it has work of its own
    moray_status (*work)(gait_job *job);
    moray_status (*report)(gait_job *job);
    moray_status (*certified)(const gait_job *job);
    void (*release)(gait_job *job);
} gait_program;

// The job with all its settings at their defaults.
gait_job gait_job_defaults(const gait_program *program);

// The whole program on a job, which may stand first in a larger struct, with its defaults; returns its exit code.
int gait_job_main(const gait_program *program, gait_job *job, int argc, char **argv);

// ---- Pieces --------------------------------------------------------------------------------------------------------

// Whether a stage, named `what` (NULL: gait_job_kind), passed its certificate. Error: MORAY_NOT_SOLVED, saying why not.
moray_status gait_job_certified(const gait_job *job, const char *what, const stage *at);

// Swims the paper's gait. Error: that of moray_robot_check_swims, moray_scheme_parse, moray_test_rig_new or
// moray_gait_trial_run.
moray_status gait_job_prepare(gait_job *job);

// What a program without own work does: swims the paper's gait, then optimises, certifies and proves the
// control-oriented stage and, with the model fp, from there the other. Error: those of the pieces.
moray_status gait_job_work(gait_job *job);

// Sets model, power and speed of a stage. Error: MORAY_NOT_SOLVED where the paper's gait, which makes the default
// speed, fails.
moray_status gait_job_demand(const gait_job *job, moray_model model, stage *at);

void gait_job_stage_free(stage *at);
void gait_job_free(gait_job *job);

#define GAIT_MESH_TOLERANCE 1e-6

// Known gaits of a model to start from, and how many random ones to start from at least, where the model is the one
// asked for.
typedef struct gait_starts {
    moray_gait gait[3];
    int n, random;
} gait_starts;

// The problem of at->model with the limits of job and at.
moray_gait_problem_spec gait_job_spec(const gait_job *job, const stage *at, moray_gait_goal goal,
                                      const double current[2]);

// Whether a model may be used where gaits have to turn. Error: that of moray_snake_turning; MORAY_NOT_SOLVED with the
// same text where the model is not the one asked for, which is then left out.
moray_status gait_job_turning(const gait_job *job, moray_model model);

// Builds it. Error: those of gait_job_turning and moray_gait_problem_new.
moray_status gait_job_problem(const gait_job *job, const stage *at, moray_gait_goal goal, const double current[2],
                              moray_gait_problem **problem);

// How the job solves.
moray_settings gait_job_settings(gait_job *job);

// Solves from the steady orbit of the gait on the problem's model. Error: those of moray_swim_steady and moray_solve.
moray_status gait_job_solve(gait_job *job, const stage *at, const moray_gait_problem *problem, const moray_gait *gait,
                            moray_solution **solution);

// Makes room for what is told of n starts. Error: MORAY_MEMORY.
moray_status gait_job_begin_starts(stage *at, int n);

// Keeps the better of a solution, which it takes over, and of what the stage has; counts how many agree.
void gait_job_keep_best(stage *at, moray_solution *solution);

// Solves from an orbit of the gait. Error: those of moray_solve.
moray_status gait_job_solve_from(gait_job *job, const moray_gait_problem *problem, const moray_gait *gait,
                                 const moray_swim_track *orbit, moray_solution **solution);

// Solves the stage's problem, which it makes if need be, from the gait of another stage of the same model, at the omega
// that the stage's power lets expect, and keeps the better of that and what the stage has. Error: those of
// gait_job_problem and gait_job_solve.
moray_status gait_job_continue(gait_job *job, stage *at, const stage *from);

// Solves a stage in the k-th of several ways; the caller owns the solution.
typedef moray_status gait_job_way(gait_job *job, stage *at, void *self, int k, moray_solution **solution);

// Tries n ways, by several processes, and keeps the best, until interrupted. Error: the first where the stage is left
// without a solution, MORAY_MEMORY.
moray_status gait_job_try_ways(gait_job *job, stage *at, int n, gait_job_way *way, void *self);

// Solves a stage in some way from a gait; the caller owns the solution.
typedef moray_status gait_job_attempt(gait_job *job, stage *at, void *self, const moray_gait *gait,
                                      moray_solution **solution);

// Attempts it from each known gait, then from random ones, these by several processes, and keeps the best, until
// interrupted. Error: the first where no start could be begun, MORAY_MEMORY.
moray_status gait_job_try_starts(gait_job *job, stage *at, const gait_starts *known, int random,
                                 gait_job_attempt *attempt, void *self);

moray_gait gait_job_random(const gait_job *job, const stage *at); // by drand48, within the limits of the gait

// Certificate of a stage's solution; fails it where the motion cannot be integrated again. Error: those of
// moray_certify but for MORAY_NUMERIC.
moray_status gait_job_certify(const gait_job *job, stage *at);

// Swims the gait of the trial for a model. Where it cannot be swum the numbers are NaN, the reason in trial->why.
void gait_job_swim(const gait_job *job, moray_model model, moray_gait_trial *trial);

// Swims the gait of a model on both. Where it cannot be swum the numbers are NaN, the reason in trial->why. Error: that
// of moray_parallel.
moray_status gait_job_try(const gait_job *job, const moray_gait *gait, moray_model model, moray_gait_trial *trial);

// Certificates of n stages, their predicted gaits swum on both models and compared with the paper's, side by side.
// Error: those of moray_certify and moray_parallel; MORAY_MEMORY.
moray_status gait_job_prove(gait_job *job, stage *const *at, int n);

// The same without the certificates. Error: that of moray_parallel; MORAY_MEMORY.
moray_status gait_job_try_all(gait_job *job, stage *const *at, int n);

// Optimises job->ladder for the models of job->over, from the gaits known. Where that cannot be, or there is no
// baseline on one of the models, it is left out, with its reason. Error: MORAY_INPUT (over), MORAY_MEMORY,
// MORAY_INTERRUPTED.
moray_status gait_job_over(gait_job *job, const gait_starts *known);

// The names in job->over. Error: MORAY_INPUT.
moray_status gait_job_scenarios(const gait_job *job, scenarios *over);

// The rungs that are of the model on which a gait of the job is found.
unsigned gait_job_found_on(const gait_job *job, moray_model model);

// Ladders over the paper's of the first-principles gaits of those of n stages that were swum. Error: those of
// moray_ladder_climb.
moray_status gait_job_climb(const gait_job *job, stage *const *at, int n);

// "the paper's gait", with "for 5 links" where the robot has not the paper's 10.
const char *gait_job_baseline(const gait_job *job, char text[64]);

// The stages that have a gait, in the order in which they were found; returns how many.
enum { GAIT_STAGES = 3 };
int gait_job_stages(const gait_job *job, const stage *at[GAIT_STAGES]);

// Whether any gait of a stage, whose model, power and taper are set, could stem the current. Error: MORAY_NOT_SOLVED
// where beyond doubt none can.
moray_status gait_job_stem(gait_job *job, const stage *at);

// Problem, best solution from the starts and random ones, and prediction of a stage whose model, power,
// speed and taper are set. Error: MORAY_NOT_SOLVED saying why, MORAY_INTERRUPTED, and those of the above.
moray_status gait_job_optimise(gait_job *job, stage *at, const gait_starts *known);

// Parts of the summary: what the job is, "predicted" of what a solution predicts, and one stage.
void gait_job_json_head(moray_json *json, const gait_job *job);
void gait_job_json_prediction(moray_json *json, const moray_gait_prediction *prediction);
void gait_job_json_stage(moray_json *json, const gait_job *job, const stage *at);

// "ladder" and "verdict" of a stage that has climbed.
enum { GAIT_TEXT = 1500 };
void gait_job_json_ladder(moray_json *json, const gait_job *job, const stage *at);
void gait_job_json_gain(moray_json *json, const char *key, const moray_gait_gain *gain);

// Adds to text[size] what the ladder says of a stage, and on how many rungs at an omega beyond the limits of the job.
void gait_job_verdict(const gait_job *job, const stage *at, char *text, size_t size);

// Adds " (at omega = 94.3 deg/s, beyond the 30 to 60 allowed)" to text[size] where it is beyond them.
void gait_job_say_beyond(const gait_job *job, double omega, char *text, size_t size);

// Adds to text[GAIT_TEXT] which gait is recommended, and what the ladder says of it.
void gait_job_headline(const gait_job *job, char *text);

// "first-principles optimum"; and what the ladder and the trial say of it, one paragraph, into text[GAIT_TEXT].
const char *gait_job_kind(const gait_job *job, const stage *at);
void gait_job_say_stage(const gait_job *job, const stage *at, char *text);

// The line above a page, "Solved and certified: 3 of 3 gaits pass", into text[80].
moray_judgement gait_job_judge(int passed, int n, char *text);

// What a program around a job shows: the parts of moray_results, and robots for its page (with --out alone), which get
// the job, the first of the program's own struct.
typedef struct gait_job_shown {
    void (*summary)(const void *found, moray_json *json);
    void (*print)(const void *found, const moray_report *report);
    moray_status (*write)(const void *found, moray_output *output);
    moray_status (*draw)(const void *found, moray_output *output);
    moray_status (*scene)(const void *found, moray_swim_scene *scene);
} gait_job_shown;

// Judges `passed` of n certificates in the report, adds its scene, shows it all. Error: those of moray_app_show.
moray_status gait_job_publish(const gait_job *job, const gait_job_shown *shown, int passed, int n,
                              const moray_report *report);

// The words of report.html and its scene, the recommended gait beside the paper's; with --out alone. Error:
// MORAY_MEMORY. Free the scene.
typedef struct gait_job_page {
    bool pass; // every certificate
    char judged[200], asked[700], text[(GAIT_STAGES + 1) * GAIT_TEXT], certificates[GAIT_STAGES * GAIT_TEXT];
    char names[GAIT_STAGES][60], limits[16];
    moray_table_row rows[5];
    moray_table table;
    moray_section section[1];
    moray_swim_scene scene;
} gait_job_page;
moray_status gait_job_page_new(gait_job *job, gait_job_page *page);

// What a stage has for a colour, in figures and in the scene; the paper's gait is the baseline.
moray_colour gait_job_colour(const gait_job *job, const stage *at);

// Figures of a gait, `what` ("Optimum 1"), over a period: the body, joints, speed, power and efforts with their limits,
// thrust along the body. Error: MORAY_MEMORY, those of moray_output_figure.
moray_status gait_job_draw_gait(const gait_job *job, const char *what, const moray_gait_trial *trial,
                                moray_output *output);

// All figures of a job, as moray_results wants them. Error: the same.
moray_status gait_job_draw(const void *job, moray_output *output);

enum { GAIT_SHOWN_SECONDS = 15 };

// Adds a gait to the scene of a page: the robot from rest on the job's model for so many seconds, `place` times its
// room aside across the course. What cannot be swum or simulated is left out. Error: MORAY_MEMORY.
moray_status gait_job_scene_add(const gait_job *job, moray_swim_scene *scene, const char *name, moray_colour colour,
                                const moray_gait_trial *trial, int place, double seconds);

// trajectory.csv of a stage. Error: MORAY_IO, MORAY_MEMORY.
moray_status gait_job_trajectory(const gait_job *job, const stage *at, moray_output *output);

// What moray_results wants of a job.
void gait_job_summary(const void *job, moray_json *json);

// "10 links, current (0, 0) m/s, course 0 deg" on standard output.
void gait_job_print_head(const gait_job *job);

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status gait_job_report(gait_job *job);

#endif
