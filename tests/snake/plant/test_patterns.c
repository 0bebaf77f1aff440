// SPDX-License-Identifier: MIT
//
// Patterns of the plants hold no entry that is always zero, but for robots of two links, of which many a term is
// nothing: each has a value at one of a few points at random.
#include <stdlib.h>
#include <string.h>

#include "moray/snake/plant.h"
#include "random_robot.h"

enum { POINTS = 6, MOST_IN = 120 };

static void random_point(random_seed *seed, const moray_plant_spec *spec, int n_in, double *in)
{
    const int nx = moray_plant_sizes(spec).nx;
    for (int i = 0; i < n_in; i++)
        in[i] = i < nx ? tap_random(seed, -0.6, 0.6) : tap_random(seed, 0.2, 1.1);
}

// Of entries [nnz] those without a value so far are counted.
static int empty(const double *values, int nnz, bool *seen)
{
    int n = 0;
    for (int e = 0; e < nnz; e++) {
        seen[e] = seen[e] || values[e] != 0;
        n += !seen[e];
    }
    return n;
}

static void check(random_seed *seed, bool control, int links, moray_joints joints, bool path, bool invariant)
{
    moray_plant_spec spec = {.robot = random_robot(seed, links),
                             .joints = joints,
                             .current = {0.3, -0.2},
                             .path_forces = path,
                             .path_angles = path,
                             .harmonics = 2};
    moray_map map;
    double in[MOST_IN], weight[MOST_IN];
    int jacobian = 0, hessian = 0;
    spec.robot.hydro.frame = invariant ? MORAY_FRAME_INVARIANT : MORAY_FRAME_PAPER;
    CHECK_OK(control ? moray_control_plant(&map, &spec) : moray_fp_plant(&map, &spec), "plant");
    CHECK(map.n_in <= MOST_IN && map.n_out <= MOST_IN, "room");
    const int most = map.jac.nnz > map.hess.nnz ? map.jac.nnz : map.hess.nnz;
    double *values = calloc((size_t)most, sizeof *values);
    bool *seen = calloc((size_t)(map.jac.nnz + map.hess.nnz), sizeof *seen);
    for (int k = 0; k < POINTS; k++) {
        random_point(seed, &spec, map.n_in, in);
        random_vector(seed, 1, map.n_out, weight);
        map.jacobian(map.self, in, values);
        jacobian = empty(values, map.jac.nnz, seen);
        map.hessian(map.self, in, weight, values);
        hessian = empty(values, map.hess.nnz, seen + map.jac.nnz);
    }
    CHECK(jacobian == 0 && hessian == 0, "%s, %d links, joints %d, path %d, invariant %d: %d of %d, %d of %d empty",
          control ? "control" : "fp", links, (int)joints, path, invariant, jacobian, map.jac.nnz, hessian,
          map.hess.nnz);
    free(values);
    free(seen);
    moray_map_release(&map);
}

int main(void)
{
    random_seed seed = 17;
    static const moray_joints joints[] = {MORAY_JOINTS_ON_GAIT, MORAY_JOINTS_STEERED, MORAY_JOINTS_CLOSED_LOOP,
                                          MORAY_JOINTS_FREE, MORAY_JOINTS_SERIES};
    for (int path = 0; path < 2; path++)
        for (int invariant = 0; invariant < 2; invariant++)
            for (int j = 0; j < 5; j++)
                for (int links = 3; links <= 5; links++) {
                    check(&seed, true, links, joints[j], path, invariant);
                    if (j < 2) // the others' come from those of a base, by the chain rule
                        check(&seed, false, links, joints[j], path, invariant);
                }
    return tap_done();
}
