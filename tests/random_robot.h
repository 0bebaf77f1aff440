// SPDX-License-Identifier: MIT
//
// Robots and numbers at random, and how far two vectors differ.
#ifndef TESTS_RANDOM_ROBOT_H
#define TESTS_RANDOM_ROBOT_H

#include "moray/snake/model.h"
#include "tap.h"

typedef unsigned long long random_seed;

static const int robot_links[] = {2, 3, 5, 10, 17};
enum { ROBOT_SIZES = sizeof robot_links / sizeof *robot_links, MAX_LINKS = 20, MAX_STATES = 2 * MAX_LINKS + 4 };

static inline void random_vector(random_seed *seed, double bound, int n, double *v)
{
    for (int i = 0; i < n; i++)
        v[i] = tap_random(seed, -bound, bound);
}

// Coefficients all of a size, so that an error in any term shows; those of the paper differ by seven powers of ten.
static inline moray_robot random_robot(random_seed *seed, int N)
{
    moray_robot robot = {.links = N};
    double *const fields[] = {&robot.l,        &robot.m,        &robot.J,        &robot.c_t,      &robot.c_n,
                              &robot.mu_n,     &robot.lambda_1, &robot.lambda_2, &robot.lambda_3, &robot.rot_damping,
                              &robot.rot_gain, &robot.k_p,      &robot.k_d};
    for (unsigned i = 0; i < sizeof fields / sizeof *fields; i++)
        *fields[i] = tap_random(seed, 0.3, 1.5);
    return robot;
}

// The same of unequal links, every field at random, a tail fin among them; link[N] as moray_robot_from_links leaves it.
static inline moray_robot random_unequal_robot(random_seed *seed, int N, moray_link *link)
{
    moray_robot robot = random_robot(seed, N);
    for (int i = 0; i < N; i++) {
        moray_link *it = &link[i];
        double *const fields[] = {&it->l,        &it->m,       &it->J,        &it->c_t,
                                  &it->c_n,      &it->mu_n,    &it->lambda_1, &it->lambda_2,
                                  &it->lambda_3, &it->fin_c_t, &it->fin_c_n,  &it->fin_mu_n};
        for (unsigned k = 0; k < sizeof fields / sizeof *fields; k++)
            *fields[k] = tap_random(seed, 0.3, 1.5);
        it->cm = it->l * tap_random(seed, -0.8, 0.8);
        it->cb = it->l * tap_random(seed, -0.8, 0.8);
        it->fin_at = it->l * tap_random(seed, -2, 2);
    }
    moray_robot_from_links(&robot, link);
    return robot;
}

// Smoothed enough for differences, with a table of two lines.
static inline moray_motor random_motor(random_seed *seed)
{
    moray_motor motor = {.fitted = true,
                         .forward = tap_random(seed, 0.4, 1),
                         .backward = tap_random(seed, 0, 1),
                         .friction = tap_random(seed, 0.1, 1),
                         .viscous = tap_random(seed, 0.1, 1),
                         .copper = tap_random(seed, 0.1, 1),
                         .smooth_rate = 0.1,
                         .smooth_power = 0.1};
    const double speed[] = {0, 1, 2.5}, torque[] = {3, 2.5, 0};
    moray_motor_set_table(&motor, speed, torque, 3);
    return motor;
}

// The k-th combination of the choices of hydrodynamics, of so many; the first is the paper's.
enum { HYDRO_VARIANTS = 18 };
static inline moray_hydrodynamics hydro_variant(int k)
{
    return (moray_hydrodynamics){.rotation = k % 3 == 1 ? MORAY_ROTATION_STRIP : MORAY_ROTATION_PAPER,
                                 .pieces = k % 3 == 2 ? 3 : 1,
                                 .drag = (moray_drag)(k / 3 % 3),
                                 .added_mass = k / 9 ? MORAY_ADDED_MASS_INVARIANT : MORAY_ADDED_MASS_PAPER,
                                 .frame = k / 9 ? MORAY_FRAME_INVARIANT : MORAY_FRAME_PAPER};
}

// max |got - want| / max |want|, a NaN if there is one.
static inline double relative_distance(int n, const double *got, const double *want)
{
    double distance = 0, size = 0;
    for (int i = 0; i < n; i++) {
        const double difference = fabs(got[i] - want[i]);
        distance = isnan(distance) || difference <= distance ? distance : difference;
        size = fmax(size, fabs(want[i]));
    }
    return distance == 0 ? 0 : distance / size;
}

static inline double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

#endif
