// SPDX-License-Identifier: MIT
//
// A textbook problem as a program: copy this file, change it, and build it anywhere with
//   cc mine.c -o mine $(pkg-config --cflags --libs moray)
// README.md beside it explains every part. Over many settings of its constants, on all cores: docs/sweeps.md.
//
// Here: the problem of Bryson and Denham. Turn a moving mass around with the least effort, and no further than l.
//   minimise  integral of u^2 / 2 dt,   x' = v,  v' = u,  x <= l,   (x, v) from (0, 1) to (0, -1) in 1 s
// Published optimum (Bryson & Ho 1975, sec. 3.11): 4 / (9 l) where l <= 1/6, so 4 at the l = 1/9 below.
#include <moray/moray.h>
#include <tgmath.h> // sin, exp, sqrt, ... of moray_num; no fabs, see README.md

struct track {
    double l; // furthest position
};

// What holds at every time t, given states at->x, controls at->u, parameters at->s and time at->t.
static void push(const moray_node *at, moray_rates *out, const void *data)
{
    const struct track *track = data;
    const moray_num x = at->x[0], v = at->x[1], u = at->u[0];
    out->f[0] = v; // f: time derivatives of the states
    out->f[1] = u;
    out->c[0] = x - track->l; // c: path constraints, within the bounds given below
    out->g[0] = u * u / 2;    // g: integrands; their integrals over the phase are q
}

// What is minimised, from the ends of the phases (x0, t0, xf, tf), their integrals q and the parameters s.
static void effort(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

int main(int argc, char **argv)
{
    struct track track = {.l = 1.0 / 9};
    const moray_phase_spec phase = {
        .name = "turn",
        .nx = 2, // numbers of states, controls, path constraints, integrals
        .nu = 1,
        .nc = 1,
        .nq = 1,
        .continuous = push,
        .t0 = moray_fixed(0), // or moray_between(low, high), moray_at_least(low), ...: then the time is found too
        .tf = moray_fixed(1), // .duration = moray_at_most(2) bounds tf - t0; .mesh and .intervals: README.md
        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(1)), // x at the start, at the end; .x would be everywhere
        .xf = MORAY_BOUNDS(moray_fixed(0), moray_fixed(-1)),
        .u = MORAY_BOUNDS(moray_free()),
        .c = MORAY_BOUNDS(moray_at_most(0)),
        .x_names = (const char *const[]){"x", "v"}, // names and units are optional
        .u_names = (const char *const[]){"u"}};
    const moray_ocp_spec spec = {.name = "template", .phases = 1, .phase = &phase, .endpoint = effort, .data = &track};

    moray_settings settings = moray_settings_default(); // what the options change
    settings.intervals = 30;
    settings.max_refinements = 10; // finer meshes until the solution is as good as it claims
    const moray_app_constant constant = {
        .key = "l", .value = &track.l, .unit = "m", .help = "furthest position", .min = 0.01, .max = 1}; // --set l=0.1
    const moray_app_units units = {.x = (const char *const[]){"m", "m/s"}, .u = (const char *const[]){"m/s^2"}};
    const moray_app app = {.spec = &spec,
                           .summary = "Turns a moving mass around with the least effort.",
                           .settings = &settings,
                           .constants = &constant,
                           .n_constants = 1,
                           .units = &units,
                           .time_unit = "s"};
    return moray_app_run(&app, argc, argv);
}
