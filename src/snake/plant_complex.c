// SPDX-License-Identifier: MIT
//
// The first-principles model with its joints on the gait, as a map: six states, exact Jacobians by complex step.
#include "complex_model.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "taper.h"

enum { states = 6, parameters = 5, inputs = states + parameters + 1 };

struct complex_plant {
    moray_plant_spec spec;
    double complex *block;
    double complex *theta, *dtheta, *phi, *dphi, *ubar, *ddtheta, *u; // N or N-1 each, in the block
    complex_link_z *links;
};

// (25) and its derivatives
static void gait_motion(const struct complex_plant *plant, const double complex *s, double complex t)
{
    const double complex alpha = s[0], omega = s[1], delta = s[2], offset = s[3], taper = s[4];
    for (int i = 0; i < plant->spec.robot.links - 1; i++) {
        const double complex sine = sin(omega * t + i * delta), cosine = cos(omega * t + i * delta);
        const double complex amplitude = alpha * (1 + taper * taper_place(i, plant->spec.robot.links - 1));
        plant->phi[i] = amplitude * sine + offset;
        plant->dphi[i] = amplitude * omega * cosine;
        plant->ubar[i] = -amplitude * omega * omega * sine;
    }
}

// in = [heading, p_x, p_y, their rates, alpha, omega, delta, phi_0, taper, t]
static void evaluate(void *self, const double complex *in, double complex *out)
{
    struct complex_plant *plant = self;
    const moray_robot *robot = &plant->spec.robot;
    const int N = robot->links;
    gait_motion(plant, in + states, in[inputs - 1]);
    complex_angles_z(N, in[0], plant->phi, plant->theta);
    complex_angles_z(N, in[3], plant->dphi, plant->dtheta);
    const complex_motion_z motion = {plant->theta, plant->dtheta, in[4], in[5], plant->ubar};
    double complex ddp[2], mean = 0;
    if (!complex_accelerations_z(robot, plant->spec.current, &motion, plant->links, plant->ddtheta, ddp))
        ddp[0] = ddp[1] = NAN;
    const double complex power = complex_torques_z(robot, &motion, plant->links, plant->ddtheta, plant->u);
    for (int i = 0; i < N; i++)
        mean += plant->ddtheta[i] / N;
    memcpy(out, in + 3, 3 * sizeof *out);
    out[3] = mean;
    out[4] = ddp[0];
    out[5] = ddp[1];
    out += states;
    for (int i = 0; i < N - 1 && plant->spec.path_forces; i++)
        *out++ = plant->u[i];
    for (int i = 0; i < N && plant->spec.path_angles; i++)
        *out++ = plant->theta[i] - in[0];
    *out = power;
}

static void plant_free(void *self)
{
    struct complex_plant *plant = self;
    if (!plant)
        return;
    free(plant->block);
    free(plant->links);
    free(plant);
}

static moray_status plant_new(struct complex_plant **result, const moray_plant_spec *spec)
{
    const size_t N = (size_t)spec->robot.links;
    struct complex_plant *plant = calloc(1, sizeof *plant);
    if (plant) {
        plant->spec = *spec;
        plant->block = calloc(7 * N, sizeof *plant->block);
        plant->links = calloc(N, sizeof *plant->links);
    }
    if (!plant || !plant->block || !plant->links) {
        plant_free(plant);
        return moray_error(MORAY_MEMORY, "no memory for a plant of %d links", spec->robot.links);
    }
    double complex **parts[] = {&plant->theta, &plant->dtheta,  &plant->phi, &plant->dphi,
                                &plant->ubar,  &plant->ddtheta, &plant->u};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        *parts[i] = plant->block + i * N;
    *result = plant;
    return moray_ok();
}

// Where patterns are looked for: a swimming robot in the middle of a stroke.
static void probe(const moray_robot *robot, double *in)
{
    const double speed = robot->l, typical[inputs] = {0.1, 0, 0, 0.2, speed, 0.3 * speed, 0.2, 2, 0.7, 0.01, 0.1, 0.4};
    memcpy(in, typical, sizeof typical);
}

moray_status moray_complex_plant(moray_map *map, const moray_plant_spec *spec)
{
    struct complex_plant *plant = NULL;
    double in[inputs];
    *map = (moray_map){0};
    MORAY_TRY(moray_robot_check(&spec->robot));
    if (spec->joints != MORAY_JOINTS_ON_GAIT)
        return moray_error(MORAY_INPUT, "joints: the first-principles plant has its joints on the gait");
    MORAY_TRY(plant_new(&plant, spec));
    probe(&spec->robot, in);
    const int outputs = states + moray_plant_sizes(spec).nc + 1;
    return moray_map_from_complex(map, inputs, outputs, evaluate, plant, plant_free, in);
}
