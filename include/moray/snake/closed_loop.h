// SPDX-License-Identifier: MIT
//
// Simulated closed_loops: a swimmer under a controller from a straight motion on, recorded and judged.
#ifndef MORAY_SNAKE_CLOSED_LOOP_H
#define MORAY_SNAKE_CLOSED_LOOP_H

#include "moray/export.h"
#include "moray/app/results.h"
#include "moray/snake/heading.h"
#include "moray/snake/controllers.h"
#include "moray/snake/path.h"

MORAY_BEGIN

typedef struct moray_swim_closed_loop_spec {
    const moray_robot *robot;
    const moray_straight_motion *straight;   // model and gait; where it starts
    double heading;                          // mean, at the start [rad]
    double position[2];                      // there [m]
    double current[2];                       // [m/s]
    double current_turning;                  // from the start on [rad/s]
    const moray_water *water;                // in place of it; NULL: uniform
    const moray_swim_controller *controller; // NULL: nobody steers
    double torque;                           // of every joint at most [N m]; 0: no limit
    double duration;                         // [s]
    int intervals;                           // recorded, of equal length
    double tolerance;                        // of the simulation, relative and absolute
    const moray_swim_on_gait *on_gait;       // simulated so, to no tolerance; NULL: with the joints' own dynamics
    moray_swim_observer *observe;            // of the samples; false ends the closed_loop; NULL: nobody
    void *observer;
} moray_swim_closed_loop_spec;

typedef struct moray_swim_closed_loop {
    moray_swimmer *swimmer; // for drawing the states of the track
    moray_swim_track track; // intervals + 1 samples, or as far as the closed_loop went
    double *offset;         // phi_0 at each [m or rad]
} moray_swim_closed_loop;

// Error: those of moray_swim_run. Free with moray_swim_closed_loop_free.
MORAY_API moray_status moray_swim_closed_loop_run(moray_swim_closed_loop *closed_loop,
                                                  const moray_swim_closed_loop_spec *plan);
// Safe on a zeroed closed_loop, and twice.
MORAY_API void moray_swim_closed_loop_free(moray_swim_closed_loop *closed_loop);

// Of the heading without its undulation, from the reference, which may jump at samples: root of the mean square, the
// last, the largest [rad]; and the mean power of joints or motors [W].
typedef struct moray_heading_score {
    double rms, final, largest, power;
} moray_heading_score;
MORAY_API moray_heading_score moray_swim_closed_loop_heading_score(const moray_swim_closed_loop *closed_loop,
                                                                   const moray_straight_motion *straight,
                                                                   const moray_reference *reference);

// Of the distance to the path [m]: root of the mean square; the same, and the largest, from where the robot has come
// further along the path than `reach` from its start; when it passed the end of the path (NaN: it did not) [s]; the
// mean power of joints or motors until then [W].
typedef struct moray_path_score {
    double rms, settled_rms, settled_largest, time, power;
} moray_path_score;
MORAY_API moray_path_score moray_swim_closed_loop_path_score(const moray_swim_closed_loop *closed_loop,
                                                             const moray_path *path, double reach);

// Figures of n closed loops: path.svg, their paths over ground in colours[n] with the robot along the last, the current
// as an arrow, and a path to be followed (NULL: none); joints.svg, joints at the tail, in the middle and at the head
// while the robot steers most. Error: as moray_output_figure.
MORAY_API moray_status moray_swim_closed_loop_draw_path(moray_output *output,
                                                        const moray_swim_closed_loop *closed_loops,
                                                        const char *const *labels, const moray_colour *colours, int n,
                                                        const double current[2], const moray_curve *path);
MORAY_API moray_status moray_swim_closed_loop_draw_joints(moray_output *output,
                                                          const moray_swim_closed_loop *closed_loop);

// trajectory.csv. Error: MORAY_IO, MORAY_MEMORY.
MORAY_API moray_status moray_swim_closed_loop_write(moray_output *output, const moray_swim_closed_loop *closed_loop);

MORAY_END

#endif
