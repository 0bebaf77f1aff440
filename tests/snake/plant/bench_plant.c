// SPDX-License-Identifier: MIT
//
// Nanoseconds per evaluation of both models as maps: each callback alone at ever new points, and the
// three one after the other at one point. Best of several rounds.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "moray/snake/plant.h"

enum { POINTS = 16, ROUNDS = 15, CALLS = 4000 };

typedef enum { VALUE = 1, JACOBIAN = 2, HESSIAN = 4 } callbacks;

typedef struct bench {
    moray_map map;
    double *in, *weight, *out, *jacobian, *hessian;
} bench;

static void evaluate(const bench *b, const double *in, unsigned which)
{
    if (which & VALUE)
        b->map.value(b->map.self, in, b->out);
    if (which & JACOBIAN)
        b->map.jacobian(b->map.self, in, b->jacobian);
    if (which & HESSIAN)
        b->map.hessian(b->map.self, in, b->weight, b->hessian);
}

static double nanoseconds(const bench *b, unsigned which)
{
    double best = INFINITY;
    for (int round = 0; round < ROUNDS; round++) {
        struct timespec start, end;
        clock_gettime(CLOCK_MONOTONIC, &start);
        for (int call = 0; call < CALLS; call++)
            evaluate(b, b->in + call % POINTS * b->map.n_in, which);
        clock_gettime(CLOCK_MONOTONIC, &end);
        best = fmin(best, 1e9 * (double)(end.tv_sec - start.tv_sec) + (double)(end.tv_nsec - start.tv_nsec));
    }
    return best / CALLS;
}

static double *vector(int size, double low, double high)
{
    double *x = malloc((size_t)size * sizeof *x);
    if (!x)
        exit(1);
    for (int i = 0; i < size; i++)
        x[i] = low + (high - low) * rand() / RAND_MAX;
    return x;
}

static int run(const char *name, moray_model model, moray_joints joints, int links)
{
    moray_plant_spec spec = {
        .robot = moray_robot_paper(), .joints = joints, .current = {0.1, 0.1}, .path_forces = false};
    spec.robot.links = links;
    bench b;
    const moray_status status = (model == MORAY_FIRST_PRINCIPLES ? moray_fp_plant : moray_control_plant)(&b.map, &spec);
    if (moray_failed(status)) {
        fprintf(stderr, "%s\n", status.text);
        return 1;
    }
    b.in = vector(POINTS * b.map.n_in, 0.01, 0.05);
    b.weight = vector(b.map.n_out, -1, 1);
    b.out = vector(b.map.n_out, 0, 0);
    b.jacobian = vector(b.map.jac.nnz, 0, 0);
    b.hessian = vector(b.map.hess.nnz, 0, 0);
    printf("%-12s %3d  %8.0f %8.0f %8.0f %8.0f   %6d %6d\n", name, links, nanoseconds(&b, VALUE),
           nanoseconds(&b, JACOBIAN), nanoseconds(&b, HESSIAN), nanoseconds(&b, VALUE | JACOBIAN | HESSIAN),
           b.map.jac.nnz, b.map.hess.nnz);
    moray_map_release(&b.map);
    free(b.in), free(b.weight), free(b.out), free(b.jacobian), free(b.hessian);
    return 0;
}

int main(void)
{
    static const struct {
        const char *name;
        moray_model model;
        moray_joints joints;
    } plant[] = {{"on gait", MORAY_CONTROL_ORIENTED, MORAY_JOINTS_ON_GAIT},
                 {"closed loop", MORAY_CONTROL_ORIENTED, MORAY_JOINTS_CLOSED_LOOP},
                 {"free", MORAY_CONTROL_ORIENTED, MORAY_JOINTS_FREE},
                 {"fp on gait", MORAY_FIRST_PRINCIPLES, MORAY_JOINTS_ON_GAIT},
                 {"fp steered", MORAY_FIRST_PRINCIPLES, MORAY_JOINTS_STEERED},
                 {"fp free", MORAY_FIRST_PRINCIPLES, MORAY_JOINTS_FREE}};
    static const int links[] = {5, 10, 20, 40};
    int failed = 0;
    printf("ns             N     value jacobian  hessian  all three   nnz: J      H\n");
    for (size_t i = 0; i < sizeof plant / sizeof *plant; i++)
        for (int k = 0; k < 4; k++)
            failed |= run(plant[i].name, plant[i].model, plant[i].joints, links[k]);
    return failed;
}
