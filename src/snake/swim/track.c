// SPDX-License-Identifier: MIT
#include "moray/snake/swim.h"

#include <stdlib.h>
#include <string.h>

moray_status moray_swim_track_new(moray_swim_track *track, const moray_swimmer *swimmer, int capacity)
{
    const int n_states = moray_swimmer_states(swimmer), n_joints = moray_swimmer_robot(swimmer)->links - 1;
    const size_t n = capacity > 0 ? (size_t)capacity : 1;
    *track = (moray_swim_track){.capacity = capacity,
                                .n_states = n_states,
                                .n_joints = n_joints,
                                .t = malloc(n * sizeof *track->t),
                                .x = malloc(n * (size_t)n_states * sizeof *track->x),
                                .u = malloc(n * (size_t)n_joints * sizeof *track->u),
                                .energy = malloc(n * sizeof *track->energy),
                                .current = malloc(2 * n * sizeof *track->current),
                                .pose = malloc(n * sizeof *track->pose)};
    if (track->t && track->x && track->u && track->energy && track->current && track->pose)
        return moray_ok();
    moray_swim_track_free(track);
    return moray_error(MORAY_MEMORY, "no memory for a track of %d samples", capacity);
}

void moray_swim_track_free(moray_swim_track *track)
{
    free(track->t);
    free(track->x);
    free(track->u);
    free(track->energy);
    free(track->current);
    free(track->pose);
    *track = (moray_swim_track){0};
}

bool moray_swim_track_add(const moray_swim_sample *sample, void *self)
{
    moray_swim_track *track = self;
    if (track->n >= track->capacity)
        return false;
    const int k = track->n++;
    track->t[k] = sample->t;
    track->energy[k] = sample->energy;
    track->pose[k] = sample->pose;
    memcpy(track->current + 2 * (size_t)k, sample->current, sizeof sample->current);
    memcpy(track->x + (size_t)k * track->n_states, sample->x, (size_t)track->n_states * sizeof *track->x);
    memcpy(track->u + (size_t)k * track->n_joints, sample->u, (size_t)track->n_joints * sizeof *track->u);
    return true;
}
