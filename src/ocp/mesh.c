// SPDX-License-Identifier: MIT
#include "ocp/mesh.h"

#include <stdlib.h>
#include <string.h>

void moray_mesh_free(struct mesh *mesh)
{
    free(mesh->edge);
    free(mesh->raised_from);
    free(mesh->stages);
    free(mesh->past);
    *mesh = (struct mesh){0};
}

moray_status moray_mesh_new(struct mesh *mesh, int intervals)
{
    *mesh = (struct mesh){.intervals = intervals,
                          .edge = calloc((size_t)intervals + 1, sizeof *mesh->edge),
                          .raised_from = calloc((size_t)intervals, sizeof *mesh->raised_from),
                          .stages = calloc((size_t)intervals, sizeof *mesh->stages),
                          .past = calloc((size_t)intervals, sizeof *mesh->past)};
    if (mesh->edge && mesh->raised_from && mesh->stages && mesh->past)
        return moray_ok();
    moray_mesh_free(mesh);
    return moray_error(MORAY_MEMORY, "no memory for a mesh of %d intervals", intervals);
}

moray_status moray_mesh_uniform(struct mesh *mesh, int intervals, struct method method)
{
    MORAY_TRY(moray_mesh_new(mesh, intervals));
    mesh->method = method;
    for (int k = 0; k <= intervals; k++)
        mesh->edge[k] = (double)k / intervals;
    for (int k = 0; k < intervals; k++)
        mesh->stages[k] = method.stages;
    return moray_ok();
}

moray_status moray_mesh_of(struct mesh *mesh, const double *edge, int intervals, struct method method)
{
    MORAY_TRY(moray_mesh_uniform(mesh, intervals, method));
    if (edge)
        memcpy(mesh->edge, edge, ((size_t)intervals + 1) * sizeof *mesh->edge);
    return moray_ok();
}

moray_status moray_mesh_copy(struct mesh *copy, const struct mesh *mesh)
{
    MORAY_TRY(moray_mesh_new(copy, mesh->intervals));
    copy->method = mesh->method;
    copy->t0 = mesh->t0, copy->tf = mesh->tf;
    memcpy(copy->edge, mesh->edge, ((size_t)mesh->intervals + 1) * sizeof *copy->edge);
    memcpy(copy->raised_from, mesh->raised_from, (size_t)mesh->intervals * sizeof *copy->raised_from);
    memcpy(copy->stages, mesh->stages, (size_t)mesh->intervals * sizeof *copy->stages);
    memcpy(copy->past, mesh->past, (size_t)mesh->intervals * sizeof *copy->past);
    return moray_ok();
}

bool moray_mesh_equal(const struct mesh *one, const struct mesh *other)
{
    const size_t n = (size_t)one->intervals;
    return one->method.family == other->method.family && one->intervals == other->intervals &&
           memcmp(one->edge, other->edge, (n + 1) * sizeof *one->edge) == 0 &&
           memcmp(one->stages, other->stages, n * sizeof *one->stages) == 0;
}
