// SPDX-License-Identifier: MIT
//
// The first-principles model with its joints on the gait, as a map: six states, or eight with a moving offset; exact
// Jacobians by complex step, exact Hessians by complex step through the adjoint.
#include "snake/model/fp_adjoint.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "snake/plant/fp_free.h"
#include "snake/plant/series.h"
#include "snake/model/circle.h"
#include "snake/model/taper.h"

enum { body = MORAY_BODY_STATES, most_inputs = 13 };

struct fp_plant {
    moray_plant_spec spec;
    fp_robot robot;
    moray_plant_size size;
    double complex *block;
    double complex *sine, *cosine, *growth;                           // of omega t + (i-1) delta; 1 + taper s_i
    double complex *theta, *dtheta, *phi, *dphi, *ubar, *ddtheta, *u; // N or N-1 each, in the block
    double complex *on_theta, *on_dtheta, *on_ddtheta, *on_joints;    // derivatives of a weighted sum
    fp_link_z *links;
    fp_dual_link *dual;
    moray_map by_step; // values, Jacobian and patterns
};

// (25) and its derivatives; the offset and its own. sin and cos of the next joint's angle are those of this one turned
// by delta, and worked out anew before rounding adds up.
enum { anew = 16 };
static void gait_motion(struct fp_plant *plant, const double complex *s, double complex taper, double complex t,
                        const double complex offset[3])
{
    const double complex alpha = s[0], omega = s[1], delta = s[2];
    const int joints = plant->spec.robot.links - 1;
    double complex sine = 0, cosine = 1, sine_delta, cosine_delta;
    circle_z(delta, &cosine_delta, &sine_delta);
    for (int i = 0; i < joints; i++) {
        if (i % anew == 0)
            circle_z(omega * t + i * delta, &cosine, &sine);
        plant->sine[i] = sine;
        plant->cosine[i] = cosine;
        const double complex growth = plant->growth[i] = 1 + taper * taper_place(i, joints);
        plant->phi[i] = alpha * growth * sine + offset[0];
        plant->dphi[i] = alpha * growth * omega * cosine + offset[1];
        plant->ubar[i] = -alpha * growth * omega * omega * sine + offset[2];
        sine = plant->sine[i] * cosine_delta + plant->cosine[i] * sine_delta;
        cosine = plant->cosine[i] * cosine_delta - plant->sine[i] * sine_delta;
    }
}

// Motion of the links at the input [heading, p_x, p_y, their rates, alpha, omega, delta, phi_0, taper, t], or with
// phi_0, phi_0', phi_0'' before alpha and no taper; then their accelerations and torques. Returns the joint power.
static double complex move(struct fp_plant *plant, const double complex *in, fp_motion_z *motion, double complex ddp[2])
{
    const fp_robot *robot = &plant->robot;
    const double complex *s = in + plant->size.nx + plant->size.nu;
    if (plant->spec.joints == MORAY_JOINTS_STEERED)
        gait_motion(plant, s, 0, s[3], in + body);
    else
        gait_motion(plant, s, s[4], s[5], (double complex[]){s[3], 0, 0});
    moray_fp_angles_z(robot->links, in[MORAY_STATE_THETA], plant->phi, plant->theta);
    moray_fp_angles_z(robot->links, in[MORAY_STATE_V_THETA], plant->dphi, plant->dtheta);
    *motion = (fp_motion_z){plant->theta, plant->dtheta, in[MORAY_STATE_V_1], in[MORAY_STATE_V_2], plant->ubar};
    if (!moray_fp_accelerations_z(robot, plant->spec.current, motion, plant->links, plant->ddtheta, ddp))
        ddp[0] = ddp[1] = NAN;
    return moray_fp_torques_z(robot, motion, plant->links, plant->ddtheta, plant->u);
}

static void evaluate(void *self, const double complex *in, double complex *out)
{
    struct fp_plant *plant = self;
    const int N = plant->spec.robot.links;
    fp_motion_z motion;
    double complex ddp[2], mean = 0;
    const double complex power = move(plant, in, &motion, ddp);
    for (int i = 0; i < N; i++)
        mean += plant->ddtheta[i] / N;
    memcpy(out, in + MORAY_STATE_V_THETA, 3 * sizeof *out);
    out[MORAY_STATE_V_THETA] = mean;
    out[MORAY_STATE_V_1] = ddp[0];
    out[MORAY_STATE_V_2] = ddp[1];
    if (plant->spec.joints == MORAY_JOINTS_STEERED)
        memcpy(out + body, in + body + 1, 2 * sizeof *out);
    out += plant->size.nx;
    for (int i = 0; i < N - 1 && plant->spec.path_forces; i++)
        *out++ = plant->u[i];
    for (int i = 0; i < N && plant->spec.path_angles; i++)
        *out++ = plant->theta[i] - in[MORAY_STATE_THETA];
    *out = power;
}

// ---- Hessian

// Adds the gradient by alpha, omega, delta, t, taper and by the offset from that by the rank-th derivative of the
// joints.
static void pull_gait(const struct fp_plant *plant, int rank, const double complex *s, double complex t,
                      const double complex *on_joints, double complex by[5], double complex *by_offset)
{
    const double complex alpha = s[0], omega = s[1];
    const int joints = plant->spec.robot.links - 1;
    *by_offset = 0;
    for (int i = 0; i < joints; i++) {
        const double complex S = plant->sine[i], C = plant->cosine[i], on = plant->growth[i] * on_joints[i];
        const double complex wave = rank == 0 ? S : rank == 1 ? omega * C : -omega * omega * S;
        const double complex turn = alpha * (rank == 0 ? C : rank == 1 ? -omega * S : -omega * omega * C);
        const double complex faster = alpha * (rank == 0 ? 0 : rank == 1 ? C : -2 * omega * S);
        by[0] += on * wave;
        by[1] += on * (faster + t * turn);
        by[2] += on * i * turn;
        by[3] += on * omega * turn;
        by[4] += on_joints[i] * taper_place(i, joints) * alpha * wave;
        *by_offset += on_joints[i];
    }
}

// Gradient of weight . out, but for what is constant in it.
static void weighted_gradient(struct fp_plant *plant, const double complex *in, const double *weight,
                              double complex *gradient)
{
    const moray_plant_size *size = &plant->size;
    const moray_plant_spec *spec = &plant->spec;
    const int N = spec->robot.links, s = size->nx + size->nu, t = s + size->ns;
    const double *path = weight + size->nx, *on_angles = path + (spec->path_forces ? N - 1 : 0);
    const fp_weights weights = {weight + MORAY_STATE_V_THETA, spec->path_forces ? path : NULL,
                                weight[size->nx + size->nc]};
    fp_gradient by = {plant->on_theta, plant->on_dtheta, plant->on_ddtheta, 0, 0};
    double complex *const by_rank[] = {by.theta, by.dtheta, by.ddtheta}, by_gait[5] = {0}, by_offset[3], mean[3],
                          ddp[2];
    fp_motion_z motion;
    move(plant, in, &motion, ddp);
    moray_fp_adjoint(&plant->robot, spec->current, &motion, plant->links, plant->ddtheta, plant->u, &weights,
                     plant->dual, &by);
    for (int i = 0; i < N && spec->path_angles; i++)
        by.theta[i] += on_angles[i];
    for (int rank = 0; rank < 3; rank++) {
        mean[rank] = moray_fp_pull_angles(N, by_rank[rank], plant->on_joints);
        pull_gait(plant, rank, in + s, in[t], plant->on_joints, by_gait, &by_offset[rank]);
    }
    memset(gradient, 0, (size_t)(t + 1) * sizeof *gradient);
    gradient[MORAY_STATE_THETA] = mean[0];
    gradient[MORAY_STATE_V_THETA] = mean[1];
    gradient[MORAY_STATE_V_1] = by.v_x;
    gradient[MORAY_STATE_V_2] = by.v_y;
    if (spec->joints == MORAY_JOINTS_STEERED) {
        memcpy(gradient + body, by_offset, sizeof by_offset);
    } else {
        gradient[s + 3] = by_offset[0];
        gradient[s + 4] = by_gait[4];
    }
    memcpy(gradient + s, by_gait, 3 * sizeof *gradient);
    gradient[t] = by_gait[3];
}

static void moray_plant_hessian(void *self, const double *in, const double *weight, double *values)
{
    struct fp_plant *plant = self;
    const moray_pattern *pattern = &plant->by_step.hess;
    const double step = 1e-50;
    double complex z[most_inputs], gradient[most_inputs];
    int before = -1;
    for (int k = 0; k < pattern->nnz; k++) {
        const int col = pattern->col[k];
        if (col != before) { // the pattern stands by columns
            for (int i = 0; i < plant->by_step.n_in; i++)
                z[i] = in[i];
            z[col] += step * I;
            weighted_gradient(plant, z, weight, gradient);
            before = col;
        }
        values[k] = cimag(gradient[pattern->row[k]]) / step;
    }
}

static void moray_plant_value(void *self, const double *in, double *out)
{
    const moray_map *by_step = &((struct fp_plant *)self)->by_step;
    by_step->value(by_step->self, in, out);
}

static void moray_plant_jacobian(void *self, const double *in, double *values)
{
    const moray_map *by_step = &((struct fp_plant *)self)->by_step;
    by_step->jacobian(by_step->self, in, values);
}

// ---- Construction

static void moray_plant_free(struct fp_plant *plant)
{
    if (!plant)
        return;
    moray_map_release(&plant->by_step);
    free(plant->block);
    free(plant->links);
    free(plant->dual);
    free(plant);
}

static void release(moray_map *map)
{
    moray_plant_free(map->self);
}

static moray_status plant_new(struct fp_plant **result, const moray_plant_spec *spec)
{
    const size_t N = (size_t)spec->robot.links;
    struct fp_plant *plant = calloc(1, sizeof *plant);
    if (plant) {
        plant->spec = *spec;
        plant->robot = moray_fp_robot_of(&spec->robot);
        plant->size = moray_plant_sizes(spec);
        plant->block = calloc(14 * N, sizeof *plant->block);
        plant->links = calloc(N, sizeof *plant->links);
        plant->dual = calloc(N, sizeof *plant->dual);
    }
    if (!plant || !plant->block || !plant->links || !plant->dual) {
        moray_plant_free(plant);
        return moray_error(MORAY_MEMORY, "no memory for a plant of %d links", spec->robot.links);
    }
    double complex **parts[] = {&plant->sine,       &plant->cosine,   &plant->growth,   &plant->theta,
                                &plant->dtheta,     &plant->phi,      &plant->dphi,     &plant->ubar,
                                &plant->ddtheta,    &plant->u,        &plant->on_theta, &plant->on_dtheta,
                                &plant->on_ddtheta, &plant->on_joints};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        *parts[i] = plant->block + i * N;
    *result = plant;
    return moray_ok();
}

// Where patterns are looked for: a swimming robot in the middle of a stroke.
static void probe(const moray_plant_spec *spec, double *in)
{
    const double speed = spec->robot.l, state[body] = {0.1, 0, 0, 0.2, speed, 0.3 * speed};
    const double on_gait[] = {0.2, 2, 0.7, 0.01, 0.1, 0.4}, steered[] = {0.01, 0.003, 0.002, 0.2, 2, 0.7, 0.4};
    memcpy(in, state, sizeof state);
    if (spec->joints == MORAY_JOINTS_STEERED)
        memcpy(in + body, steered, sizeof steered);
    else
        memcpy(in + body, on_gait, sizeof on_gait);
}

moray_status moray_fp_plant(moray_map *map, const moray_plant_spec *spec)
{
    struct fp_plant *plant = NULL;
    double in[most_inputs];
    *map = (moray_map){0};
    MORAY_TRY(moray_robot_check(&spec->robot));
    if (spec->joints == MORAY_JOINTS_SERIES)
        return moray_plant_series(map, spec, moray_fp_plant);
    if (spec->joints == MORAY_JOINTS_FREE)
        return moray_fp_free_plant(map, spec);
    if (spec->joints == MORAY_JOINTS_CLOSED_LOOP)
        return moray_error(MORAY_INPUT, "joints: the first-principles plant has none in closed loop");
    MORAY_TRY(plant_new(&plant, spec));
    probe(spec, in);
    const moray_plant_size *size = &plant->size;
    const moray_status status = moray_map_from_complex(&plant->by_step, size->nx + size->nu + size->ns + 1,
                                                       size->nx + size->nc + 1, evaluate, plant, NULL, in);
    if (moray_failed(status)) {
        moray_plant_free(plant);
        return status;
    }
    *map = plant->by_step;
    map->self = plant;
    map->value = moray_plant_value;
    map->jacobian = moray_plant_jacobian;
    map->hessian = moray_plant_hessian;
    map->release = release;
    return status;
}
