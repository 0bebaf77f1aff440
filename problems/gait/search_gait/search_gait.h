// SPDX-License-Identifier: MIT
//
// A search for all optima of one gait job: local searches from many starts and one global search, over solved orbits;
// every optimum polished by collocation.
#ifndef PROBLEMS_GAIT_SEARCH_GAIT_SEARCH_GAIT_H
#define PROBLEMS_GAIT_SEARCH_GAIT_SEARCH_GAIT_H

#include "gait/job/job.h"

enum { SEARCH_GAIT_OPTIMA = 32, SEARCH_GAIT_SHOWN = 5 }; // kept; polished and shown
enum { SEARCH_GAIT_RIDGE = 46 };                         // gaits of the figure

typedef struct optimum {
    moray_gait gait;          // the best of the ends here
    moray_orbit_result orbit; // its orbit
    double objective;         // as minimised
    moray_floquet floquet;
    int hits;    // starts that end here
    bool global; // the global search ends here
    stage at;    // polished and proved, where shown
} optimum;

typedef struct search_gait {
    gait_job job;                    // first, for its options
    int goal;                        // moray_gait_goal
    int local_method, global_method; // choices below
    int global_orbits, seed;
    moray_gait_problem_spec spec;
    moray_gait_search *search;
    stage demand;     // model, power and speed of all
    int starts, lost; // lost: ended at no optimum
    int orbits;       // solved by the local searches
    optimum optimum[SEARCH_GAIT_OPTIMA];
    int n, shown;
    moray_search_info global;
    double seconds;                     // of the local searches
    double ridge[2][SEARCH_GAIT_RIDGE]; // phase shifts over their range [deg], the best value for each or NaN
    // while searching
    const char *activity;
} search_gait;

extern const char *const search_gait_locals[], *const search_gait_globals[]; // names of the choices

static inline bool search_gait_fastest(const search_gait *run)
{
    return run->goal == MORAY_GAIT_FASTEST;
}

// What is sought, to be shown: speed along the course [m/s], or work per distance along it [J/m].
static inline double search_gait_value(const search_gait *run, double course_speed, double power)
{
    return search_gait_fastest(run) ? course_speed : power / course_speed;
}

// The optima, best first, with their stages. Error: MORAY_NOT_SOLVED when no start ends at one, MORAY_INTERRUPTED, and
// those of the pieces.
moray_status search_gait_run(search_gait *run);

// Finds run->ridge. Error: MORAY_INTERRUPTED.
moray_status search_gait_ridge(search_gait *run);

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status search_gait_report(search_gait *run);

#endif
