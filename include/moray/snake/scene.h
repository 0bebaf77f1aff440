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

// Adds the robot of a track, moved aside by so much [m]; the first one sets the times. With linear drag and equal links
// the first-principles model shows it on the links: (2) without the added mass, in the current of the track, whose mean
// is the scene's. `width` of a link [m]. What has no room
// is left out. Error: MORAY_MEMORY.
MORAY_API moray_status moray_swim_scene_add(moray_swim_scene *scene, const char *name, const moray_swim_track *track,
                                            moray_swimmer *swimmer, double width, const double aside[2]);

// The same of a trial's gait on a model, from rest over the duration [s]. Error: those of moray_swim_run.
MORAY_API moray_status moray_swim_scene_gait(moray_swim_scene *scene, const char *name, const moray_test_rig *rig,
                                             const moray_gait_trial *trial, moray_model model, double duration,
                                             double width, const double aside[2]);

// Adds a number over time, values[track->n] at the times of the track. Error: MORAY_MEMORY.
MORAY_API moray_status moray_swim_scene_tell(moray_swim_scene *scene, const char *name, const char *unit,
                                             const moray_swim_track *track, const double *values);

// The path that is asked for, copied. Error: MORAY_MEMORY.
MORAY_API moray_status moray_swim_scene_ask(moray_swim_scene *scene, const double *x, const double *y, int n);

MORAY_API void moray_swim_scene_free(moray_swim_scene *scene); // safe on a zeroed scene, and twice

MORAY_END

#endif
