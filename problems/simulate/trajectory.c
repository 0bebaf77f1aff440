// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "simulate.h"

enum { NAME_SIZE = 20 };

typedef struct {
    moray_column *column;
    char (*name)[NAME_SIZE];
    int n;
} columns;

static void add_column(columns *c, const char *name, int number, const char *unit, const double *values, int stride)
{
    if (number)
        snprintf(c->name[c->n], NAME_SIZE, "%s_%d", name, number);
    else
        snprintf(c->name[c->n], NAME_SIZE, "%s", name);
    c->column[c->n] = (moray_column){.name = c->name[c->n], .unit = unit, .values = values, .stride = stride};
    c->n++;
}

// Columns of n states from `first` on, numbered from 1.
static void add_states(columns *c, const moray_swim_track *track, int first, int n, const char *name, const char *unit)
{
    for (int i = 0; i < n; i++)
        add_column(c, name, n > 1 ? i + 1 : 0, unit, track->x + first + i, track->n_states);
}

// Time, pose, work of joints or motors; the states that are not in the pose already; joint efforts.
static void choose_columns(const simulate *run, const simulate_results *results, columns *c)
{
    const moray_swim_track *track = &results->track;
    const int N = run->snake.robot.links, pose = sizeof *track->pose / sizeof(double);
    const bool control = run->snake.model == MORAY_CONTROL_ORIENTED;
    add_column(c, "t", 0, "s", track->t, 1);
    add_column(c, "heading", 0, "rad", &track->pose->heading, pose);
    add_column(c, "p_x", 0, "m", &track->pose->p_x, pose);
    add_column(c, "p_y", 0, "m", &track->pose->p_y, pose);
    add_column(c, "v_x", 0, "m/s", &track->pose->v_x, pose);
    add_column(c, "v_y", 0, "m/s", &track->pose->v_y, pose);
    add_column(c, "link_angle", 0, "rad", &track->pose->link_angle, pose);
    add_column(c, "energy", 0, "J", track->energy, 1);
    if (control) { // (21)
        add_states(c, track, 0, N - 1, "phi", "m");
        add_states(c, track, N + 2, N - 1, "v_phi", "m/s");
        add_states(c, track, 2 * N + 1, 1, "v_theta", "rad/s");
        add_states(c, track, 2 * N + 2, 1, "v_t", "m/s");
        add_states(c, track, 2 * N + 3, 1, "v_n", "m/s");
    } else {
        add_states(c, track, 0, N, "theta", "rad");
        add_states(c, track, N + 2, N, "dtheta", "rad/s");
    }
    for (int i = 0; i < 2 && results->water; i++)
        add_column(c, i ? "V_y" : "V_x", 0, "m/s", track->current + i, 2);
    for (int i = 0; i < N - 1; i++)
        add_column(c, "u", i + 1, control ? "N" : "N m", track->u + i, track->n_joints);
}

moray_status simulate_trajectory(const void *found, moray_output *output)
{
    const simulate_results *results = found;
    const simulate *run = results->run;
    const size_t most = 3 * (size_t)run->snake.robot.links + 14;
    FILE *file;
    MORAY_TRY(moray_output_file(output, "trajectory.csv", &file));
    columns c = {.column = calloc(most, sizeof *c.column), .name = calloc(most, sizeof *c.name)};
    const bool room = c.column && c.name;
    if (room) {
        choose_columns(run, results, &c);
        moray_csv_write(file, c.column, c.n, results->track.n);
    }
    free(c.column);
    free(c.name);
    return room ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for the trajectory");
}
