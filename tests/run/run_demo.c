// SPDX-License-Identifier: MIT
//
// A problem of two phases with everything that results show, for test_run.sh: move a mass 2 m from rest to rest in 2 s
// with the least effort, past a gate at 1 m, and choose a parameter. By symmetry the gate is passed after 1 s; optimum
// (effort 3) and parameter 1/2.
#include <math.h>
#include <signal.h>

#include "moray/app/run.h"

static struct world {
    double gate, raise, signal, undefined, crooked;
    int calls;
} the_world = {.gate = 1, .signal = SIGINT};

static void move(const moray_node *at, moray_rates *out, const void *data)
{
    const struct world *world = data;
    if (the_world.raise > 0 && ++the_world.calls > 2500) { // in the solver
        the_world.raise--;
        raise((int)the_world.signal);
    }
    out->f[0] = at->x[1];
    out->f[1] = world->crooked > 0 ? creal(at->u[0]) : at->u[0]; // no derivative
    out->g[0] = at->u[0] * at->u[0] / 2 + (world->undefined > 0 && at->u[0] == 0 ? NAN : 0);
}

static void join(const moray_ends *at, moray_end_values *out, const void *data)
{
    const struct world *world = data;
    const moray_phase_ends *first = &at->phase[0], *second = &at->phase[1];
    out->objective = first->q[0] + second->q[0] + (at->s[0] - 0.5) * (at->s[0] - 0.5);
    out->e[0] = first->xf[0] - second->x0[0];
    out->e[1] = first->xf[1] - second->x0[1];
    out->e[2] = first->tf - second->t0;
    out->e[3] = first->xf[0] - world->gate;
}

int main(int argc, char **argv)
{
    const char *const states[] = {"x", "v"}, *const controls[] = {"u"}, *const parameters[] = {"share"};
    const moray_bounds box[] = {moray_between(-5, 5), moray_between(-5, 5)};
    moray_phase_spec phase[2] = {{.name = "to the gate",
                                  .t0 = moray_fixed(0),
                                  .tf = moray_between(0, 1.9),
                                  .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0))},
                                 {.name = "beyond",
                                  .t0 = moray_between(0, 1.9),
                                  .tf = moray_fixed(2),
                                  .xf = MORAY_BOUNDS(moray_fixed(2), moray_fixed(0))}};
    for (int p = 0; p < 2; p++) {
        phase[p].nx = 2;
        phase[p].nu = phase[p].nq = 1;
        phase[p].continuous = move;
        phase[p].x = (moray_bounds_list){box, 2};
        phase[p].x_names = states;
        phase[p].u_names = controls;
    }
    const moray_ocp_spec spec = {.name = "run_demo",
                                 .phases = 2,
                                 .phase = phase,
                                 .ns = 1,
                                 .s = MORAY_BOUNDS(moray_between(0, 1)),
                                 .s_names = parameters,
                                 .ne = 4,
                                 .e = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), moray_fixed(0), moray_fixed(0)),
                                 .endpoint = join,
                                 .data = &the_world};
    const moray_app_constant constants[] = {
        {.key = "gate", .value = &the_world.gate, .unit = "m", .help = "where the phases meet"},
        {.key = "raise", .value = &the_world.raise, .help = "how many times a signal comes"},
        {.key = "signal", .value = &the_world.signal, .help = "its number"},
        {.key = "crooked", .value = &the_world.crooked, .help = "whether a derivative is wrong"},
        {.key = "undefined", .value = &the_world.undefined, .help = "whether the effort is undefined at u = 0"}};
    const char *const units[] = {"m", "m/s"}, *const force[] = {"N"}, *const effort[] = {"N^2 s"};
    const moray_app_units both[] = {{.x = units, .u = force, .q = effort}, {.x = units, .u = force, .q = effort}};
    return moray_app_run(&(moray_app){.spec = &spec,
                                      .objective = "effort",
                                      .objective_unit = "N^2 s",
                                      .time_unit = "s",
                                      .units = both,
                                      .constants = constants,
                                      .n_constants = sizeof constants / sizeof *constants},
                         argc, argv);
}
