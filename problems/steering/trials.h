// SPDX-License-Identifier: MIT
//
// A trial swum, and the tuning of its numbers.
#ifndef PROBLEMS_STEERING_TRIALS_H
#define PROBLEMS_STEERING_TRIALS_H

#include "steer.h"

// How a simulation is run: with the joints' own dynamics to a tolerance, or exactly on the gait; samples a second.
typedef struct steer_accuracy {
    const moray_swim_on_gait *on_gait;
    double tolerance, per_second;
    bool timed; // ended by the clock
} steer_accuracy;

// Fills score and cost of that model, and the record. Error: MORAY_NOT_SOLVED where the clock ended it; those of
// moray_swim_closed_loop_run.
moray_status steer_try(const steer_job *job, steer_trial *trial, moray_model model, steer_accuracy how);

// Error: MORAY_NOT_SOLVED where the clock ended it before anything was tried, MORAY_INTERRUPTED, those of moray_tune.
moray_status steer_tune(steer_job *job, steer_trial *trial);

// What steer_run_trials does, but for what other processes do and what waits for it; on these, and on what they leave.
moray_status steer_run_ready(steer_job *job);
bool steer_can_run(const steer_job *job, const steer_trial *trial);

// The best law that leaves some of the trial's numbers out, on the same gait, where it did better; NULL: none did.
// Tuning simulates roughly, and what hangs by a stroke may come out otherwise with care.
const steer_trial *steer_better_subset(const steer_trial *trial);

// The law that it comes to, on the same gait, where what it has besides moves nothing; NULL: there is none, or it has
// not run.
const steer_trial *steer_same_law(const steer_trial *trial);

// The numbers of that law; of a plan alone, which has none, a gain of 0.
void steer_take_numbers(steer_trial *trial, const steer_trial *of);

#endif
