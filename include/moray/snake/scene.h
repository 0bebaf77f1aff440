// SPDX-License-Identifier: MIT
//
// Swimming robots as the scene of a report.
#ifndef MORAY_SNAKE_SCENE_H
#define MORAY_SNAKE_SCENE_H

#include "moray/export.h"
#include "moray/app/results.h"
#include "moray/snake/trial.h"

MORAY_BEGIN

enum { MORAY_SCENE_BODIES = 4, MORAY_SCENE_CHANNELS = 4 };

// Zeroed at first; `scene` is for moray_report. Free with moray_swim_scene_free.
typedef struct moray_swim_scene {
    moray_scene scene;
    moray_scene_body body[MORAY_SCENE_BODIES];
    moray_channel channel[MORAY_SCENE_CHANNELS];
    char name[MORAY_SCENE_BODIES + MORAY_SCENE_CHANNELS][80], effort[80];
    double *kept[6 * MORAY_SCENE_BODIES];
    int n_kept;
} moray_swim_scene;

// How a robot is shown: its name and colour, the width of a link [m], and how far it is moved aside [m].
typedef struct moray_swim_look {
    const char *name;
    moray_colour colour;
    double width, aside[2];
} moray_swim_look;

// Adds the robot of a track; the first one sets the times. The first-principles model shows on its links what the water
// does to them without their accelerations, drag above all, in the current of the track, whose mean is the scene's.
// What has no room is left out. Error: MORAY_MEMORY.
MORAY_API moray_status moray_swim_scene_add(moray_swim_scene *scene, const moray_swim_look *look,
                                            const moray_swim_track *track, moray_swimmer *swimmer);

// The same of a trial's gait on a model, from rest over the duration [s]. Error: those of moray_swim_run.
MORAY_API moray_status moray_swim_scene_gait(moray_swim_scene *scene, const moray_swim_look *look,
                                             const moray_test_rig *rig, const moray_gait_trial *trial,
                                             moray_model model, double duration);

// Adds a number over time, values[track->n] at the times of the track. Error: MORAY_MEMORY.
MORAY_API moray_status moray_swim_scene_tell(moray_swim_scene *scene, const char *name, const char *unit,
                                             const moray_swim_track *track, const double *values);

// The path that is asked for, copied. Error: MORAY_MEMORY.
MORAY_API moray_status moray_swim_scene_ask(moray_swim_scene *scene, const double *x, const double *y, int n);

MORAY_API void moray_swim_scene_free(moray_swim_scene *scene); // safe on a zeroed scene, and twice

MORAY_END

#endif
