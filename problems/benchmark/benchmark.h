// SPDX-License-Identifier: MIT
//
// Pieces of the benchmark program: what a solve costs, measured several times, and how that grows.
#ifndef PROBLEMS_BENCHMARK_BENCHMARK_H
#define PROBLEMS_BENCHMARK_BENCHMARK_H

#include <math.h>

#include "classics/classics.h"
#include "degree.h"
#include "moray/moray.h"
#include "moray/snake.h"

// Processor seconds of one solve, start to finish: from the first line of the problem to the solution.
enum { SETUP, FUNCTION, JACOBIAN, HESSIAN, IPOPT, LINEAR, PIECES };
typedef struct cost {
    double piece[PIECES]; // set-up; evaluations; Ipopt without its linear solver; the linear solver
    double total;         // their sum
    double wall;          // the same by the clock on the wall
    bool solved;
    moray_linear_solver linear_solver; // that solved it
    int iterations;
    double objective;
    moray_nlp_size size;
    int nodes, sweeps; // nodes of all phases; evaluations of constraints, Jacobian and Hessian, each over all nodes
    double sweep;      // of the constraints' functions once at every node
    double memory;     // peak while solving, beyond what the process held [bytes]; NaN where the system does not say
} cost;

double cost_evaluation(const cost *c);

// Bytes that the process holds, from where the peak counts anew; the peak since then beyond that. NaN: not told.
double memory_begin(void);
double memory_peak(double before);

// What this machine does in a second of the processor.
typedef struct machine {
    double flops, bytes; // in factors of a dense matrix; read and written in copies
} machine;
moray_status machine_measure(machine *found); // Error: MORAY_MEMORY

// The floor in seconds, from dimensions, these rates and the same number of iterations, and its terms: factorisations
// that follow the stages (mean numbers of variables and constraints a node); J, H, iterate and multipliers written and
// read once an iteration; one call of the functions a node and evaluation.
enum { FLOOR_FACTORS, FLOOR_STREAM, FLOOR_CALLS, FLOOR_TERMS };
double cost_floor(const machine *rates, const cost *c, double term[FLOOR_TERMS]);
const char *floor_term_text(const double term[FLOOR_TERMS]); // the largest

// What is measured. `solve` builds the problem and solves it, its parts timed or not; `forget` frees what it built, the
// solution apart. `begin` prepares what does not count as part of a solve, `end` frees that; NULL: nothing.
typedef struct subject {
    moray_status (*begin)(void *self);
    moray_status (*solve)(void *self, moray_linear_solver linear, bool timed, moray_solution **solution);
    void (*forget)(void *self), (*end)(void *self);
    void *self;
} subject;

// Medians of `repeats` measurements, piece by piece: the total of a solve that is not timed within, the pieces of
// another that is. Error: those of begin and solve.
moray_status measure(const subject *of, moray_linear_solver linear, int repeats, cost *found);

// Slope of log y over log x by least squares; x, y > 0 (pairs where one is not are left out; NaN with less than two).
double fitted_exponent(const double *x, const double *y, int n);

// ---- Subjects ------------------------------------------------------------------------------------------------------

// Settings of every solve here.
moray_settings benchmark_settings(const char *scheme, int intervals, moray_linear_solver linear, bool timed);

// The optimal-gait problem as max_speed and min_energy pose it, from the orbit of the paper's gait.
typedef struct gait_case {
    const char *name;
    int links;
    moray_model model;
    moray_joints joints;
    moray_gait_goal goal;
    const char *scheme;
    int intervals;
    double barrier; // 0: that of an orbit near the optimum
    // owned
    moray_robot robot;
    moray_gait gait;
    moray_swim_track orbit;
    double power, speed; // of the paper's gait
    moray_gait_problem *problem;
} gait_case;

// Begins with the orbit. Error: moray_swim_steady's.
subject gait_case_subject(gait_case *c);

// S1, on which other tools can solve the same programme (benchmark_s1.c states it). Error: that of moray_swim_steady.
enum { S1_LINKS = 10, S1_STATES = 2 * S1_LINKS + 4 };
typedef struct s1_case {
    double L;
    moray_swim_track orbit;
    moray_gait gait;
    moray_map plant;
    moray_ocp *ocp;
} s1_case;
subject s1_subject(s1_case *c);

// Writes its start as s1_start.csv: time and the states of (21) along one period of the start's orbit, for other tools
// (problems/benchmark/peers). Errors: those of moray_swim_steady and moray_output_file.
moray_status s1_write_start(moray_output *output);

// Heading tracking with the paper's gait: 30 deg there and back every 40 s, in the current (0.1, 0.1) m/s.
enum { HORIZON_POINTS = 200 };
typedef struct horizon_case {
    moray_model model;
    double seconds;
    // owned
    moray_robot robot;
    moray_gait gait;
    double time[HORIZON_POINTS], heading[HORIZON_POINTS];
    moray_reference reference; // points into these
    moray_steering_plan plan;
} horizon_case;
subject horizon_subject(horizon_case *c); // the case must stay where it is. Error: MORAY_INPUT when it is too long

// A chain of masses of any even number of states (chain.c states it).
typedef struct chain_case {
    int states;
    moray_ocp *ocp; // owned
} chain_case;
subject chain_subject(chain_case *c);

// A textbook problem on the mesh it begins with.
typedef struct classic_case {
    const struct classic *classic;
    moray_ocp *ocp; // owned
} classic_case;
subject classic_subject(classic_case *c);

// Simulated seconds per processor second, median of `repeats` simulations of 45 s of the paper's gait from rest.
// Error: that of moray_swim_run.
moray_status simulation_rate(moray_model model, int links, int repeats, double *rate);

// ---- Results -------------------------------------------------------------------------------------------------------

enum { MOST_CASES = 72, MOST_GROWTHS = 8, MOST_POINTS = 10 };

typedef struct named_cost {
    const char *name;
    cost cost, mumps; // the latter solved with MUMPS, side by side
} named_cost;

// What MUMPS costs over what the linear solver asked for does: start to finish; linear solver alone, an iteration.
double total_over_ours(const named_cost *c);
double linear_over_ours(const named_cost *c);

typedef struct growth {
    const char *name, *over; // over: "states", "intervals", "links" or "seconds"
    int n, size[MOST_POINTS];
    cost cost[MOST_POINTS];
} growth;

// Exponents of a growth: set-up; for one iteration evaluation, Ipopt with its linear solver, and both; peak memory.
enum { EXPONENTS = 5 };
extern const char *const exponent_names[EXPONENTS];
void growth_exponents(const growth *g, double exponent[EXPONENTS]);

typedef struct simulated {
    int n, links[MOST_POINTS];
    double rate[2][MOST_POINTS]; // by model
} simulated;

enum part { ALL, S1, PROBLEMS, CLASSICS, STATES, INTERVALS, LINKS, HORIZON, SIMULATION };

typedef struct benchmark {
    moray_common common;
    int part, repeats, most_states, most_intervals, most_links, most_seconds;
    machine machine;
    int n_cases, n_growths;
    named_cost cases[MOST_CASES]; // S1 first, where it is among them
    growth growths[MOST_GROWTHS];
    simulated simulation;
    moray_ticker ticker;
} benchmark;

// Tables or JSON on standard output; JSON and figures of the growth in the directory of --out. Error: MORAY_IO,
// MORAY_MEMORY.
moray_status benchmark_report(const benchmark *run);
void benchmark_summary(const void *run, moray_json *json);
moray_status benchmark_draw(const void *run, moray_output *output);

#endif
