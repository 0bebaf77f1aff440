// SPDX-License-Identifier: MIT
//
// What the programs that optimise one gait share: options, both stages of the optimisation, proof and report.
#ifndef PARTS_GAIT_JOB_H
#define PARTS_GAIT_JOB_H

#include <math.h>

#include "moray/moray.h"

#define DEG (M_PI / 180)

// One optimisation: the problem on one model, its best solution, and what the gait is worth when it is swum.
typedef struct stage {
    moray_model model;
    double power; // limit of the mean joint power [W], or infinite
    double speed; // least speed along the course [m/s], or 0
    moray_gait_problem *problem;
    moray_solution *solution;
    int starts, agreeing; // how many, and how many of them ended at the best solution
    moray_certificate certificate;
    moray_gait_promise promise;
    moray_gait_trial trial;
    moray_gait_gain gain; // over the paper's gait
} stage;

typedef struct gait_job {
    moray_common common; // model complex: both stages, control-oriented first; control: that alone
    const char *name;    // of the program
    moray_gait_goal goal;
    double theta_max[2], omega[2], delta[2], offset[2], offset_angle[2], taper[2];
    double power, speed; // NaN: what the paper's gait uses and makes
    double joint_rate, joint_effort;
    moray_joints joints;
    int random_starts;
    moray_basin basin;
    moray_gait_trial paper;
    stage stage[2]; // by model
    moray_ticker ticker;
} gait_job;

static inline const stage *last_stage(const gait_job *job)
{
    return &job->stage[job->common.model];
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

// What makes a program of this: its goal, its own options besides those of every gait job, its defaults in the job.
typedef struct gait_program {
    const char *name, *summary;
    moray_gait_goal goal;
    const moray_option *options;
    int n_options;
    double power, speed; // defaults
} gait_program;

// The whole program; returns its exit code.
int gait_job_main(const gait_program *program, int argc, char **argv);

// ---- Pieces --------------------------------------------------------------------------------------------------------

// Known gaits of a model to start from.
typedef struct gait_starts {
    moray_gait gait[2];
    int n;
} gait_starts;

// Builds the problem of at->model with the limits of job and at. Error: those of moray_gait_problem_new.
moray_status gait_job_problem(const gait_job *job, const stage *at, moray_gait_goal goal, const double current[2],
                              moray_gait_problem **problem);

// Solves from the steady orbit of the gait on the problem's model. Error: those of moray_swim_steady and moray_solve.
moray_status gait_job_solve(gait_job *job, const stage *at, const moray_gait_problem *problem, const moray_gait *gait,
                            moray_solution **solution);

// Problem, best solution from the starts and random ones, promise and certificate of a stage whose model, power and
// speed are set. Error: MORAY_NOT_SOLVED saying why, MORAY_INTERRUPTED, and those of the above.
moray_status gait_job_optimise(gait_job *job, stage *at, const gait_starts *known);

// The summary; moray_json_free it.
moray_json *gait_job_json(const gait_job *job);

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status gait_job_report(gait_job *job);

#endif
