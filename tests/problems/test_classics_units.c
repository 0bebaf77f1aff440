// SPDX-License-Identifier: MIT
//
// Textbook problems in other units: the same optimum, and the same certificate. Every state, control, path constraint,
// integral and time of a problem gets a unit of its own; its maps are called through them.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "classics/classics.h"
#include "ocp/problem.h"
#include "rk4.h"

static const int rk4_steps = 40;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

enum { most = 32 };
static const double mesh_noise = 0.01; // of the mesh tolerance: below, rounding in the solver is seen

// How many of the new units make up an old one.
static const double systems[][4] = {{1, 1, 1, 1},
                                    {1e3, 1e3, 1e3, 1e3},
                                    {1e-3, 1. / 3600, 1e3, 1e-2},
                                    {1e4, 1e-3, 1e2, 60},
                                    {60, 1e3, 1e-3, 1. / 86400}};
enum { state, control, objective, duration };

// ---- A map in other units ----

struct scaled {
    const moray_map *map;
    moray_map own;
    double in[most], out[most]; // units
    double at[most], weight[most];
};

static const double *enter(struct scaled *s, const double *in)
{
    for (int j = 0; j < s->map->n_in; j++)
        s->at[j] = in[j] / s->in[j];
    return s->at;
}

static void value(void *self, const double *in, double *out)
{
    struct scaled *s = self;
    s->map->value(s->map->self, enter(s, in), out);
    for (int i = 0; i < s->map->n_out; i++)
        out[i] *= s->out[i];
}

static void jacobian(void *self, const double *in, double *values)
{
    struct scaled *s = self;
    s->map->jacobian(s->map->self, enter(s, in), values);
    for (int k = 0; k < s->map->jac.nnz; k++)
        values[k] *= s->out[s->map->jac.row[k]] / s->in[s->map->jac.col[k]];
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    struct scaled *s = self;
    for (int i = 0; i < s->map->n_out; i++)
        s->weight[i] = weight[i] * s->out[i];
    s->map->hessian(s->map->self, enter(s, in), s->weight, values);
    for (int k = 0; k < s->map->hess.nnz; k++)
        values[k] /= s->in[s->map->hess.row[k]] * s->in[s->map->hess.col[k]];
}

static void wrap(struct scaled *s, const moray_map *map)
{
    s->map = map;
    s->own = (moray_map){.n_in = map->n_in,
                         .n_out = map->n_out,
                         .jac = map->jac,
                         .hess = map->hess,
                         .self = s,
                         .value = value,
                         .jacobian = jacobian,
                         .hessian = hessian};
}

// ---- A problem of one phase in other units ----

struct other {
    struct scaled phase, endpoint;
    double x[most], u[most], c[most], q[most];
    moray_bounds bounds[6][most];
};

static moray_bounds in_units(moray_bounds old, double unit)
{
    moray_bounds b = old;
    b.lower = old.lower > -MORAY_INFINITY ? old.lower * unit : old.lower;
    b.upper = old.upper < MORAY_INFINITY ? old.upper * unit : old.upper;
    return b;
}

static const moray_bounds *all_in_units(moray_bounds *to, const moray_bounds *from, const double *unit, int n)
{
    for (int i = 0; i < n; i++)
        to[i] = in_units(from[i], unit[i]);
    return to;
}

// Neighbouring states in units that are each other's inverse.
static void choose_units(struct other *o, const struct phase *phase, const double *system)
{
    const double time = system[duration];
    for (int i = 0; i < most; i++) {
        o->x[i] = i % 2 ? 1 / system[state] : system[state];
        o->u[i] = i % 2 ? 1 / system[control] : system[control];
        o->c[i] = system[state];
        o->q[i] = i == 0 ? system[objective] : 1 / system[control];
    }
    double *in = o->phase.in, *out = o->phase.out;
    memcpy(in, o->x, (size_t)phase->nx * sizeof *in);
    memcpy(in + phase->nx, o->u, (size_t)phase->nu * sizeof *in);
    in[phase->nx + phase->nu] = time;
    for (int i = 0; i < phase->nx; i++)
        out[i] = o->x[i] / time;
    memcpy(out + phase->nx, o->c, (size_t)phase->nc * sizeof *out);
    for (int i = 0; i < phase->nq; i++)
        out[phase->nx + phase->nc + i] = o->q[i] / time;
    double *end = o->endpoint.in;
    for (int side = 0; side < 2; side++, end += phase->nx + 1) {
        memcpy(end, o->x, (size_t)phase->nx * sizeof *end);
        end[phase->nx] = time;
    }
    memcpy(end, o->q, (size_t)phase->nq * sizeof *end);
    o->endpoint.out[0] = system[objective];
}

static moray_status express(moray_ocp **ocp, struct other *o, const moray_ocp *old, const double *system)
{
    const struct phase *phase = &old->phase[0];
    choose_units(o, phase, system);
    wrap(&o->phase, phase->map);
    wrap(&o->endpoint, old->endpoint->map);
    const moray_phase_spec spec = {.name = phase->name,
                                   .nx = phase->nx,
                                   .nu = phase->nu,
                                   .nc = phase->nc,
                                   .nq = phase->nq,
                                   .map = &o->phase.own,
                                   .t0 = in_units(phase->t0, system[duration]),
                                   .tf = in_units(phase->tf, system[duration]),
                                   .x = {all_in_units(o->bounds[0], phase->x, o->x, phase->nx), phase->nx},
                                   .x0 = {all_in_units(o->bounds[1], phase->x0, o->x, phase->nx), phase->nx},
                                   .xf = {all_in_units(o->bounds[2], phase->xf, o->x, phase->nx), phase->nx},
                                   .u = {all_in_units(o->bounds[3], phase->u, o->u, phase->nu), phase->nu},
                                   .c = {all_in_units(o->bounds[4], phase->c, o->c, phase->nc), phase->nc},
                                   .q = {all_in_units(o->bounds[5], phase->q, o->q, phase->nq), phase->nq}};
    return moray_ocp_new(
        ocp, &(moray_ocp_spec){.name = old->name, .phases = 1, .phase = &spec, .endpoint_map = &o->endpoint.own});
}

// ---- In all units ----

struct found {
    double objective;
    int iterations, meshes, nodes; // nodes: of the last mesh
    moray_certificate certificate;
};

static void solve(const struct classic *classic, const moray_ocp *old, int k, struct found *found)
{
    struct other *o = calloc(1, sizeof *o);
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    const moray_settings settings = classic_settings(classic);
    CHECK_OK(express(&ocp, o, old, systems[k]), classic->name);
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), classic->name);
    CHECK_OK(moray_certify(solution, &rk4, &found->certificate), classic->name);
    found->objective = moray_solution_objective(solution) / systems[k][objective];
    int meshes;
    const moray_mesh_record *mesh = moray_solution_history(solution, &meshes);
    found->meshes = meshes;
    found->nodes = mesh[meshes - 1].nodes;
    for (int m = 0; m < meshes; m++)
        found->iterations += mesh[m].iterations;
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    free(o);
}

static int tried, compared; // how often, and with the same mesh in the end

// hard: a system in which the solver gives up, which the certificate must say; 0: none.
static void test_one(const char *name, int hard)
{
    const struct classic *classic = classic_find(name);
    moray_ocp *ocp = NULL;
    struct found first = {0};
    CHECK_OK(classic->build(&ocp, classic->data), name);
    solve(classic, ocp, 0, &first);
    for (int k = 0; k < (int)(sizeof systems / sizeof *systems); k++) {
        struct found found = {0};
        solve(classic, ocp, k, &found);
        const moray_certificate *c = &found.certificate, *same = &first.certificate;
        const double least = mesh_noise * classic_settings(classic).mesh_tolerance;
        const double error = fmax(c->mesh_error, least), same_error = fmax(same->mesh_error, least);
        const bool right = fabs(found.objective / first.objective - 1) < classic_settings(classic).mesh_tolerance;
        CHECK(right || (hard > 0 && k == hard), "%s in units %d: %.10g, in the first %.10g", name, k, found.objective,
              first.objective);
        CHECK(c->pass == right, "%s in units %d after %d iterations: %s", name, k, found.iterations, c->why);
        // Rounding may send the refinement another way, to another mesh with an error of its own.
        const bool same_mesh = right && found.meshes == first.meshes && found.nodes == first.nodes;
        tried++, compared += same_mesh;
        CHECK(!same_mesh || fabs(log(error / same_error)) < log(2), "%s in units %d: mesh error %.2g, as %.2g", name, k,
              c->mesh_error, same->mesh_error);
    }
    moray_ocp_free(ocp);
}

// With names of problems of one phase as arguments, these in place of the quick ones.
int main(int argc, char **argv)
{
    for (int k = 1; k < argc; k++)
        test_one(argv[k], 0);
    if (argc > 1)
        return tap_done();
    test_one("brachistochrone", 0);
    test_one("tangent-steering", 0);
    test_one("bryson-denham", 0);
    test_one("van-der-pol", 0);
    test_one("hypersensitive", 0);
    test_one("rayleigh", 0);
    CHECK(2 * compared > tried, "%d of %d ended on the same mesh", compared, tried);
    return tap_done();
}
