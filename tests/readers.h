// SPDX-License-Identifier: MIT
//
// Every reader of files as one function, what is read becoming one number by which two files are compared.
#ifndef TESTS_READERS_H
#define TESTS_READERS_H

#include "arguments.h"
#include "tap.h"

#include <stdlib.h>

#include "moray/app/program.h"
#include "moray/ocp.h"
#include "moray/snake/gait_input.h"
#include "moray/snake/heading.h"
#include "moray/snake/path.h"

static moray_ocp *ocp;
static const char *const file_name = "readers.txt";

static inline moray_status read_guess(double *sum)
{
    moray_guess guess;
    moray_status status = moray_guess_read(&guess, ocp, file_name);
    for (int k = 0; !moray_failed(status) && k < guess.phase[0].n; k++)
        *sum = 3 * *sum + guess.phase[0].time[k] + 7 * guess.phase[0].x[k];
    moray_guess_free(&guess);
    return status;
}

static inline moray_status read_schedule(double *sum)
{
    const moray_gait_input first = moray_gait_input_default();
    const moray_robot robot = moray_robot_paper();
    moray_gait_change *change;
    int n;
    moray_status status = moray_gait_schedule_read(file_name, &first, &robot, MORAY_CONTROL_ORIENTED, &change, &n);
    for (int k = 0; k < n; k++)
        *sum = 3 * *sum + change[k].t + 7 * change[k].gait.delta;
    free(change);
    return status;
}

static inline moray_status read_reference(double *sum)
{
    moray_reference reference;
    moray_status status = moray_reference_read(&reference, file_name);
    for (int k = 0; k < reference.n; k++)
        *sum = 3 * *sum + reference.time[k] + 7 * reference.heading[k];
    moray_reference_free(&reference);
    return status;
}

static inline moray_status read_path(double *sum)
{
    moray_path path;
    moray_status status = moray_path_read(&path, file_name, 0.01);
    for (int k = 0; k < path.n; k++)
        *sum = 3 * *sum + path.piece[k].x + 7 * path.piece[k].y + path.piece[k].length;
    moray_path_free(&path);
    return status;
}

typedef struct {
    moray_common common;
    double a, b;
} settings;

static inline moray_status read_ini(double *sum)
{
    static const moray_option rows[] = {
        {.section = "test", .key = "aa", .type = MORAY_OPTION_REAL, MORAY_AT(settings, a)},
        {.section = "test", .key = "bb", .type = MORAY_OPTION_REAL, MORAY_AT(settings, b)}};
    const moray_program program = {.name = "readers", .summary = "", .options = rows, .n_options = 2};
    settings s = {.common = moray_common_default()};
    command_line line;
    command_set(&line, "readers", (const char *const[]){"--config", file_name}, 2);
    moray_request request;
    moray_status status = moray_app_parse(&program, line.argc, line.argv, &s, &request);
    *sum = 3 * s.a + s.b;
    return status;
}

static const struct reader {
    const char *name;
    moray_status (*read)(double *sum);
    const char *one, *other; // names of columns
    bool ascends;
} readers[] = {{"guess", read_guess, "t", "x", true},
               {"schedule", read_schedule, "t_s", "delta_deg", true},
               {"reference", read_reference, "t_s", "heading_deg", true},
               {"path", read_path, "x_m", "y_m", false}};
enum { n_readers = sizeof readers / sizeof *readers };

static inline void fall(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[0];
}

static inline void end_value(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

static inline void make_problem(void)
{
    static const char *const names[] = {"x"};
    const moray_phase_spec phase = {.nx = 1, .continuous = fall, .tf = moray_fixed(1), .x_names = names};
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = end_value}), "a problem");
}

#endif
