// SPDX-License-Identifier: MIT
#include "moray/snake/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES_A_SECOND = 20, MOST_FRAMES = 1200 };

static double *keep(moray_swim_scene *scene, size_t n)
{
    const int room = sizeof scene->kept / sizeof *scene->kept;
    double *made = scene->n_kept < room ? calloc(n ? n : 1, sizeof *made) : NULL;
    if (made)
        scene->kept[scene->n_kept++] = made;
    return made;
}

static moray_status no_memory(void)
{
    return moray_error(MORAY_MEMORY, "no memory for the animation");
}

// Equal steps over the track.
static bool set_times(moray_swim_scene *made, const moray_swim_track *track)
{
    moray_scene *scene = &made->scene;
    const double t0 = track->t[0], span = track->t[track->n - 1] - t0;
    if (scene->frames)
        return true;
    const int n = (int)fmin(ceil(span * FRAMES_A_SECOND), MOST_FRAMES - 1) + 1;
    double *t = keep(made, (size_t)n);
    if (!t)
        return false;
    for (int k = 0; k < n; k++)
        t[k] = t0 + span * k / (n > 1 ? n - 1 : 1);
    scene->t = t;
    scene->frames = n;
    scene->bodies = made->body;
    scene->channels = made->channel;
    scene->effort = made->effort;
    return true;
}

// The sample before t, not the last, and how far t is from there to the next.
static int before(const moray_swim_track *track, double t, int from, double *part)
{
    while (from + 2 < track->n && track->t[from + 1] <= t)
        from++;
    const double span = track->t[from + 1] - track->t[from];
    *part = span > 0 ? fmin(fmax((t - track->t[from]) / span, 0), 1) : 0;
    return from;
}

// Row k of a table of so many columns, and the next, mixed.
static void mix(const double *table, int columns, int k, double part, double *to)
{
    const double *row = table + (size_t)k * (size_t)columns;
    for (int i = 0; i < columns; i++)
        to[i] = (1 - part) * row[i] + part * row[i + columns];
}

// What the water does to the links without their accelerations, in the plane, in the current V. scratch[2 N].
static void drag(moray_swimmer *swimmer, const double *x, const double V[2], const double *places, double *scratch,
                 double *force)
{
    const int N = moray_swimmer_robot(swimmer)->links;
    double *along = scratch, *across = scratch + N, kept[2];
    moray_swimmer_current(swimmer, kept);
    moray_swimmer_set_current(swimmer, V[0], V[1]);
    const bool known = moray_swimmer_water_forces(swimmer, x, NULL, along, across);
    for (int i = 0; i < N; i++) {
        const double c = cos(places[3 * i + 2]), s = sin(places[3 * i + 2]);
        force[2 * i] = known ? c * along[i] - s * across[i] : 0;
        force[2 * i + 1] = known ? s * along[i] + c * across[i] : 0;
    }
    moray_swimmer_set_current(swimmer, kept[0], kept[1]);
}

static bool shows_drag(const moray_swimmer *swimmer)
{
    return moray_swimmer_model(swimmer) == MORAY_FIRST_PRINCIPLES;
}

struct frames {
    double *at, *effort, *force, *scratch, *lengths; // force NULL: none
};

static void fill(const moray_scene *scene, const moray_swim_track *track, moray_swimmer *swimmer, const double aside[2],
                 const struct frames *to)
{
    const int N = moray_swimmer_robot(swimmer)->links;
    double *x = to->scratch, *links = x + track->n_states, *rest = links + 3 * N, V[2], part;
    int sample = 0;
    for (int k = 0; k < scene->frames; k++) {
        sample = before(track, scene->t[k], sample, &part);
        mix(track->x, track->n_states, sample, part, x);
        mix(track->current, 2, sample, part, V);
        mix(track->u, track->n_joints, sample, part, to->effort + (size_t)k * (size_t)track->n_joints);
        moray_swimmer_links(swimmer, x, links, links + N, links + 2 * N);
        double *at = to->at + (size_t)(3 * N) * (size_t)k;
        for (int i = 0; i < N; i++) {
            at[3 * i] = links[i] + aside[0];
            at[3 * i + 1] = links[N + i] + aside[1];
            at[3 * i + 2] = links[2 * N + i];
        }
        if (to->force)
            drag(swimmer, x, V, at, rest, to->force + (size_t)(2 * N) * (size_t)k);
    }
}

// The mean over the samples; of what is uniform to the last digit.
static void mean_current(const moray_swim_track *track, double V[2])
{
    for (int c = 0; c < 2; c++) {
        double off = 0;
        for (int k = 0; k < track->n; k++)
            off += track->current[2 * k + c] - track->current[c];
        V[c] = track->current[c] + off / track->n;
    }
}

static void say_effort(moray_swim_scene *made, const moray_swimmer *swimmer, const double *effort, size_t n)
{
    const bool control = moray_swimmer_model(swimmer) == MORAY_CONTROL_ORIENTED;
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs(effort[i]));
    if (!made->effort[0])
        snprintf(made->effort, sizeof made->effort, "%s, up to %.3g %s", control ? "force" : "torque", most,
                 control ? "N" : "N m");
}

moray_status moray_swim_scene_add(moray_swim_scene *made, const moray_swim_look *look, const moray_swim_track *track,
                                  moray_swimmer *swimmer)
{
    const moray_robot *robot = moray_swimmer_robot(swimmer);
    const int N = robot->links, body = made->scene.n_bodies;
    if (body == MORAY_SCENE_BODIES || track->n < 2)
        return moray_ok();
    if (!set_times(made, track))
        return no_memory();
    const size_t frames = (size_t)made->scene.frames, links = (size_t)N;
    const struct frames to = {.at = keep(made, frames * 3 * links),
                              .effort = keep(made, frames * (links - 1)),
                              .force = shows_drag(swimmer) ? keep(made, frames * 2 * links) : NULL,
                              .lengths = keep(made, links),
                              .scratch = keep(made, (size_t)track->n_states + 5 * links)};
    if (!to.at || !to.effort || !to.scratch || !to.lengths || (shows_drag(swimmer) && !to.force))
        return no_memory();
    fill(&made->scene, track, swimmer, look->aside, &to);
    for (int i = 0; i < N; i++)
        to.lengths[i] = 2 * moray_swimmer_half_length(swimmer, i);
    const size_t settled = frames / 2; // the first push from rest is left out of the scale
    say_effort(made, swimmer, to.effort + settled * (links - 1), (frames - settled) * (links - 1));
    snprintf(made->name[body], sizeof *made->name, "%s", look->name);
    made->body[body] = (moray_scene_body){.name = made->name[body],
                                          .colour = look->colour,
                                          .links = N,
                                          .length = 2 * robot->l,
                                          .lengths = robot->link ? to.lengths : NULL,
                                          .width = fmin(look->width, 1.6 * robot->l),
                                          .at = to.at,
                                          .effort = to.effort,
                                          .force = to.force};
    made->scene.n_bodies++;
    mean_current(track, made->scene.current);
    return moray_ok();
}

moray_status moray_swim_scene_gait(moray_swim_scene *made, const moray_swim_look *look, const moray_test_rig *rig,
                                   const moray_gait_trial *trial, moray_model model, double duration)
{
    moray_swimmer *swimmer = rig->swimmer[model];
    const moray_gait_change change = {0, trial->gait[model]};
    const int n = (int)fmin(ceil(duration * FRAMES_A_SECOND), MOST_FRAMES - 1) + 1;
    moray_swim_track track;
    MORAY_TRY(moray_swim_track_new(&track, swimmer, n));
    double *times = calloc((size_t)n + (size_t)track.n_states, sizeof *times), *x = times + n;
    moray_status status = times ? moray_ok() : no_memory();
    for (int k = 0; k < n && times; k++)
        times[k] = duration * k / (n - 1);
    const moray_swim_plan plan = {.t1 = duration,
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .times = times,
                                  .n_times = n,
                                  .observe = moray_swim_track_add,
                                  .observer = &track};
    if (!moray_failed(status)) {
        moray_swimmer_set_current(swimmer, rig->current[0], rig->current[1]);
        moray_swimmer_rest(swimmer, trial->steady[model].start_heading, 0, 0, x);
        status = moray_swim_run(swimmer, &rig->settings.sim, &plan, x, NULL);
    }
    if (!moray_failed(status))
        status = moray_swim_scene_add(made, look, &track, swimmer);
    free(times);
    moray_swim_track_free(&track);
    return status;
}

moray_status moray_swim_scene_tell(moray_swim_scene *made, const char *name, const char *unit,
                                   const moray_swim_track *track, const double *values)
{
    const int channel = made->scene.n_channels;
    double part;
    if (channel == MORAY_SCENE_CHANNELS || track->n < 2)
        return moray_ok();
    double *kept = set_times(made, track) ? keep(made, (size_t)made->scene.frames) : NULL;
    if (!kept)
        return no_memory();
    for (int k = 0, sample = 0; k < made->scene.frames; k++) {
        sample = before(track, made->scene.t[k], sample, &part);
        mix(values, 1, sample, part, &kept[k]);
    }
    char *own = made->name[MORAY_SCENE_BODIES + channel];
    snprintf(own, sizeof *made->name, "%s", name);
    made->channel[channel] = (moray_channel){.name = own, .unit = unit, .values = kept};
    made->scene.n_channels++;
    return moray_ok();
}

moray_status moray_swim_scene_ask(moray_swim_scene *made, const double *x, const double *y, int n)
{
    double *kept = keep(made, 2 * (size_t)n);
    if (!kept)
        return no_memory();
    memcpy(kept, x, (size_t)n * sizeof *x);
    memcpy(kept + n, y, (size_t)n * sizeof *y);
    made->scene.asked_x = kept;
    made->scene.asked_y = kept + n;
    made->scene.n_asked = n;
    return moray_ok();
}

void moray_swim_scene_free(moray_swim_scene *made)
{
    for (int i = 0; i < made->n_kept; i++)
        free(made->kept[i]);
    *made = (moray_swim_scene){0};
}
