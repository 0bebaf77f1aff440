// SPDX-License-Identifier: MIT
#include "snake/plant/plant.h"

#include <stdlib.h>
#include <string.h>

#include "snake/plant/series.h"
#include "snake/plant/water.h"
#include "snake/model/shape.h"

moray_plant_size moray_plant_sizes(const moray_plant_spec *spec)
{
    const int N = spec->robot.links;
    const moray_plant_size forms[] = {
        [MORAY_JOINTS_ON_GAIT] = {.nx = MORAY_BODY_STATES, .ns = 5},
        [MORAY_JOINTS_CLOSED_LOOP] = {.nx = 2 * N + 4, .ns = 5},
        [MORAY_JOINTS_FREE] = {.nx = 2 * N + 4, .nu = N - 1},
        [MORAY_JOINTS_STEERED] = {.nx = MORAY_STEERING_STATES, .nu = 1, .ns = 3},
        [MORAY_JOINTS_SERIES] = {.nx = MORAY_BODY_STATES, .ns = 1 + (N - 1) * (1 + 2 * spec->harmonics)}};
    moray_plant_size size = forms[spec->joints];
    size.nc = (spec->path_forces ? N - 1 : 0) + (spec->path_supply ? spec->robot.motor.lines * (N - 1) : 0) +
              (spec->path_angles ? N : 0) + (spec->path_rates ? N - 1 : 0);
    size.nq = 1;
    return size;
}

moray_status moray_plant_check(const moray_plant_spec *spec, bool first_principles)
{
    MORAY_TRY(moray_robot_check(&spec->robot));
    if (spec->path_supply && !first_principles)
        return moray_error(MORAY_INPUT, "path_supply: the control-oriented model's joints are not rotary: they have no "
                                        "torques and speeds that motors would give");
    if (spec->path_rates && spec->joints != MORAY_JOINTS_SERIES)
        return moray_error(MORAY_INPUT, "path_rates: only with the joints on a series");
    return moray_ok();
}

static void place_outputs(plant *self, const moray_plant_spec *spec)
{
    const moray_plant_size size = moray_plant_sizes(spec);
    self->n = spec->robot.links - 1;
    self->n_in = size.nx + size.nu + size.ns + 1;
    self->n_out = size.nx + size.nc + size.nq;
    self->forces = spec->path_forces ? size.nx : -1;
    self->angles = spec->path_angles ? size.nx + size.nc - spec->robot.links : -1;
    self->power = self->n_out - 1;
    self->rest = size.nx;
}

static void place_inputs(plant *self, moray_joints joints)
{
    static const int on_gait[] = {GAIT_A, GAIT_OMEGA, GAIT_DELTA, GAIT_PHI_0, GAIT_TAPER, GAIT_T};
    static const int steered_kinds[] = {GAIT_A, GAIT_OMEGA, GAIT_DELTA, GAIT_PHI_0, GAIT_T, GAIT_DPHI_0, GAIT_DDPHI_0};
    const int n = self->n;
    self->gait.n = n;
    self->joint_states = joints == MORAY_JOINTS_CLOSED_LOOP || joints == MORAY_JOINTS_FREE;
    if (!self->joint_states) {
        const bool steered = joints == MORAY_JOINTS_STEERED;
        self->form = steered ? &moray_plant_steered : &moray_plant_on_gait;
        self->kind = steered ? steered_kinds : on_gait;
        self->n_s = steered ? 5 : 6; // all but phi_0', phi_0''
        self->n_curved = 6;          // all but phi_0''
        self->n_shape = steered ? 7 : 6;
        self->v_theta = 3;
        self->offset = 6;
        return;
    }
    const bool free = joints == MORAY_JOINTS_FREE;
    self->form = free ? &moray_plant_free : &moray_plant_closed_loop;
    self->n_shape = 2 * n + (free ? n : GAIT_INPUTS);
    self->n_s = n;
    self->n_curved = 2 * n;
    self->theta = n;
    self->v_theta = 2 * n + 3;
}

static void set_constants(plant *self, const moray_plant_spec *spec)
{
    place_outputs(self, spec);
    place_inputs(self, spec->joints);
    self->body = moray_body_of(&spec->robot, spec->current);
    self->half_inverse_L = 1 / (4 * spec->robot.l);
    if (spec->joints == MORAY_JOINTS_CLOSED_LOOP) {
        self->k_p = spec->robot.k_p;
        self->k_d = spec->robot.k_d;
    }
}

// Hands out parts of a block of memory; with base NULL only counts.
typedef struct arena {
    double *base;
    size_t used;
} arena;

static double *take(arena *from, int count)
{
    double *part = from->base ? from->base + from->used : NULL;
    from->used += (size_t)count;
    return part;
}

static void take_vectors(plant *self, arena *from)
{
    double **const on_joints[] = {
        &self->phi,         &self->v_phi,      &self->ubar,       &self->zeros,    &self->ones,     &self->bt_phi,
        &self->aa_phi,      &self->g_load,     &self->u,          &self->b_v,      &self->b_ubar,   &self->g_v,
        &self->on_phi,      &self->on_v,       &self->on_ubar,    &self->b_lambda, &self->g_lambda, &self->gait.sine,
        &self->gait.cosine, &self->gait.place, &self->gait.growth};
    double **const on_inputs[] = {&self->y_x[0], &self->y_x[1], &self->y_x[2],  &self->y_x[3], &self->load_x,
                                  &self->dv_t_x, &self->dv_n_x, &self->kappa_x, &self->a_x,    &self->bend_x};
    for (size_t k = 0; k < sizeof on_joints / sizeof *on_joints; k++)
        *on_joints[k] = take(from, self->n);
    for (size_t k = 0; k < sizeof on_inputs / sizeof *on_inputs; k++)
        *on_inputs[k] = take(from, self->n_shape);
    self->in = take(from, self->n_in);
    self->work = take(from, WORK_VECTORS * self->n);
    self->col = (int *)take(from, self->n_shape);
}

static void take_matrices(plant *self, arena *from)
{
    const int n = self->n;
    if (!self->joint_states)
        return;
    self->b_tangent = self->b_columns = take(from, n * n);
    self->g_tangent = self->g = take(from, n * n);
    if (self->form == &moray_plant_closed_loop) {
        self->tangent = take(from, GAIT_INPUTS * n);
        self->b_tangent = take(from, GAIT_INPUTS * n);
        self->g_tangent = take(from, GAIT_INPUTS * n);
    }
}

// Joints as states: phi, v_phi and a free ubar are read where they lie in the input.
static void fill_joint_tables(plant *self)
{
    const int n = self->n;
    double *unit = self->work;
    self->phi = self->in;
    self->v_phi = self->in + n + 3;
    if (self->form == &moray_plant_free)
        self->ubar = self->in + self->rest;
    for (int i = 0; i < n; i++) {
        self->col[i] = i;
        self->col[n + i] = n + 3 + i;
        unit[i] = 1;
        moray_shape_a_dbar(n + 1, unit, self->b_columns + i * n);
        moray_shape_gram_inverse(n + 1, unit, self->g + i * n);
        unit[i] = 0;
    }
}

static void fill_tables(plant *self)
{
    const int n_joint_inputs = self->joint_states ? 2 * self->n : 0;
    for (int k = n_joint_inputs; k < self->n_shape; k++)
        self->col[k] = self->rest + k - n_joint_inputs;
    if (self->form == &moray_plant_steered) {
        const int steered[] = {9, 10, 11, 6, 12, 7, 8}; // a, omega, delta, phi_0, t, phi_0', phi_0''
        memcpy(self->col, steered, sizeof steered);
    }
    for (int i = 0; i < self->n; i++)
        self->ones[i] = 1;
    if (self->joint_states)
        fill_joint_tables(self);
    entries last = {0};
    if (self->form->last_hessian_pattern)
        self->form->last_hessian_pattern(self, &last);
    self->n_last = last.count;
}

static plant *plant_new(const moray_plant_spec *spec)
{
    plant measure = {0};
    arena memory = {0};
    set_constants(&measure, spec);
    take_vectors(&measure, &memory);
    take_matrices(&measure, &memory);
    plant *self = calloc(1, sizeof *self + memory.used * sizeof(double));
    if (!self)
        return NULL;
    memory = (arena){.base = self->memory};
    set_constants(self, spec);
    take_vectors(self, &memory);
    take_matrices(self, &memory);
    fill_tables(self);
    return self;
}

static moray_status pattern_of(const plant *self, void (*list)(const plant *, entries *), moray_pattern *pattern)
{
    entries counted = {0}, filled = {.into = pattern};
    list(self, &counted);
    MORAY_TRY(moray_pattern_new(pattern, counted.count));
    list(self, &filled);
    return moray_ok();
}

static void release(moray_map *map)
{
    moray_pattern_free(&map->jac);
    moray_pattern_free(&map->hess);
    free(map->self);
}

moray_status moray_control_plant(moray_map *map, const moray_plant_spec *spec)
{
    *map = (moray_map){0};
    MORAY_TRY(moray_plant_check(spec, false));
    if (spec->water)
        return moray_water_plant(map, spec, false, moray_control_plant);
    if (spec->joints == MORAY_JOINTS_SERIES)
        return moray_plant_series(map, spec, moray_control_plant);
    plant *self = plant_new(spec);
    if (!self)
        return moray_error(MORAY_MEMORY, "no memory for the plant of a robot with %d links", spec->robot.links);
    *map = (moray_map){.n_in = self->n_in,
                       .n_out = self->n_out,
                       .self = self,
                       .value = moray_plant_value,
                       .jacobian = moray_plant_jacobian,
                       .hessian = moray_plant_hessian,
                       .release = release};
    moray_status status = pattern_of(self, moray_plant_jacobian_pattern, &map->jac);
    if (!moray_failed(status))
        status = pattern_of(self, moray_plant_hessian_pattern, &map->hess);
    if (moray_failed(status))
        moray_map_release(map);
    return status;
}
