// SPDX-License-Identifier: MIT
//
// A search for all optima of one gait job: local searches from many starts and one global search, over solved orbits;
// every optimum polished by collocation.
#ifndef PROBLEMS_GAIT_SEARCH_GAIT_SEARCH_GAIT_H
#define PROBLEMS_GAIT_SEARCH_GAIT_SEARCH_GAIT_H

#include "gait/job/job.h"

enum { SEARCH_GAIT_OPTIMA = 32, SEARCH_GAIT_SHOWN = 5 }; // kept; polished and shown
enum { SEARCH_GAIT_RIDGE = 46 };                         // gaits of the figure

enum { SEARCH_GAIT_COLUMNS = 25, SEARCH_GAIT_ROWS = 15 }; // of the map

// Speed along the course at equal power [m/s], NaN where no omega within its limits has it, over phase shift and
// link-angle amplitude [deg].
typedef struct search_gait_map {
    double delta[SEARCH_GAIT_COLUMNS], theta_max[SEARCH_GAIT_ROWS];
    double speed[SEARCH_GAIT_ROWS][SEARCH_GAIT_COLUMNS];
} search_gait_map;

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
    search_gait_map map;
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

// Finds run->map. Error: that of moray_parallel, MORAY_INTERRUPTED.
moray_status search_gait_map_new(search_gait *run);
moray_status search_gait_draw_map(const search_gait *run, moray_output *output); // error: as moray_output_figure

double search_gait_theta_max(const search_gait *run, const moray_gait *gait); // [rad]

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status search_gait_report(search_gait *run);

#endif
