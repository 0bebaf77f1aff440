// SPDX-License-Identifier: MIT
//
// A mesh and its copy; what makes two meshes one.
#include "tap.h"

#include <string.h>

#include "ocp/mesh.h"

static const double edges[] = {0, 0.125, 0.5, 1};
static const struct method method = {MORAY_RADAU, 3};

static struct mesh make(void)
{
    struct mesh mesh;
    CHECK_OK(moray_mesh_of(&mesh, edges, 3, method), "mesh");
    mesh.t0 = -2, mesh.tf = 5;
    for (int k = 0; k < 3; k++) {
        mesh.stages[k] = 4 + k;
        mesh.raised_from[k] = 7 + k;
    }
    memset(mesh.past, 0x5a, 3 * sizeof *mesh.past);
    return mesh;
}

static void test_copy(void)
{
    struct mesh mesh = make(), copy;
    CHECK_OK(moray_mesh_copy(&copy, &mesh), "copy");
    CHECK(copy.intervals == 3 && copy.t0 == -2 && copy.tf == 5 && copy.method.family == MORAY_RADAU &&
              copy.method.stages == 3,
          "%d intervals from %g to %g", copy.intervals, copy.t0, copy.tf);
    CHECK(memcmp(copy.edge, mesh.edge, 4 * sizeof *mesh.edge) == 0 &&
              memcmp(copy.stages, mesh.stages, 3 * sizeof *mesh.stages) == 0,
          "edges and stages");
    CHECK(memcmp(copy.raised_from, mesh.raised_from, 3 * sizeof *mesh.raised_from) == 0 &&
              memcmp(copy.past, mesh.past, 3 * sizeof *mesh.past) == 0,
          "and what refinement remembers");
    mesh.edge[1] = 0.25;
    CHECK(copy.edge[1] == 0.125, "of its own");
    moray_mesh_free(&mesh);
    moray_mesh_free(&copy);
    CHECK(!copy.edge && copy.intervals == 0, "nothing is left");
}

static void test_equal(void)
{
    struct mesh mesh = make(), other = make(), shorter;
    CHECK(moray_mesh_equal(&mesh, &other), "made alike");
    other.method.family = MORAY_GAUSS;
    CHECK(!moray_mesh_equal(&mesh, &other), "of another family");
    other.method.family = MORAY_RADAU;
    for (int k = 0; k <= 3; k++) {
        other.edge[k] += 1e-12;
        CHECK(!moray_mesh_equal(&mesh, &other), "edge %d moved", k);
        other.edge[k] = edges[k];
    }
    for (int k = 0; k < 3; k++) {
        other.stages[k]++;
        CHECK(!moray_mesh_equal(&mesh, &other), "a stage more in interval %d", k);
        other.stages[k]--;
    }
    CHECK(moray_mesh_equal(&mesh, &other), "alike again");
    CHECK_OK(moray_mesh_of(&shorter, edges, 2, method), "the first two intervals");
    memcpy(shorter.stages, mesh.stages, 2 * sizeof *mesh.stages);
    CHECK(!moray_mesh_equal(&shorter, &mesh), "an interval fewer");
    moray_mesh_free(&mesh);
    moray_mesh_free(&other);
    moray_mesh_free(&shorter);
}

static void test_uniform(void)
{
    struct mesh mesh;
    CHECK_OK(moray_mesh_uniform(&mesh, 8, method), "uniform");
    for (int k = 0; k < 8; k++)
        CHECK(mesh.edge[k] == k * 0.125 && mesh.stages[k] == 3, "interval %d begins at %g", k, mesh.edge[k]);
    CHECK(mesh.edge[8] == 1, "and the last ends at 1");
    moray_mesh_free(&mesh);
    CHECK_OK(moray_mesh_of(&mesh, NULL, 2, method), "without edges");
    CHECK(mesh.edge[1] == 0.5, "it is uniform");
    moray_mesh_free(&mesh);
}

int main(void)
{
    test_copy();
    test_equal();
    test_uniform();
    return tap_done();
}
