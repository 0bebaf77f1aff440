// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_PAPER_FIT_H
#define PROBLEMS_PAPER_FIT_H

#include "paper.h"

// The two constants of (20), rot_damping and rot_gain, and how far the heading then is from the first-principles
// model's, both on average over a period [deg].
typedef struct {
    double damping, gain, rms, largest;
} paper_constants;

typedef struct {
    paper *p;
    paper_constants given, first, best; // first: where the search starts
    paper_constants slower, faster;     // half and twice the best rot_damping at the best ratio
    double *times, *raw;                // of the samples; headings there, followed by room for a state
    int n;
    double *target, *trial; // mean headings: of the first-principles model, of the last trial; NaN in the first period
    moray_status failure;   // of a trial
    int tried;
    bool damping_at_end; // best.damping is the largest or the smallest that was allowed
} paper_fitting;

moray_status paper_fit_tell(paper *p, const paper_fitting *fit);

// With the mean headings that the given constants make, fit->n of them.
moray_status paper_fit_draw(paper *p, const paper_fitting *fit, const double *given);

// Into the file of write_ini: the constants alone where it exists, all of the robot where it does not. Error: MORAY_IO.
moray_status paper_fit_write(const paper *p, const paper_constants *c);

#endif
