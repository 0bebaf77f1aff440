// SPDX-License-Identifier: MIT
#include "snake/plant/fp_columns.h"

#include <stdlib.h>

moray_status moray_fp_columns_new(fp_columns *columns, int N, int most)
{
    const size_t joints = (size_t)N - 1, links = (size_t)N, stride = (size_t)fp_stride(most);
    fp_joint_motion *along = &columns->along, *gradient = &columns->gradient;
    fp_directions *from = &columns->links;
    fp_tangents *to = &columns->by_links;
    const struct {
        double **at;
        size_t rows;
    } part[] = {{&along->mean, 1},          {&along->v_mean, 1},       {&along->phi, joints},
                {&along->v_phi, joints},    {&along->ubar, joints},    {&along->v, 2},
                {&gradient->mean, 1},       {&gradient->v_mean, 1},    {&gradient->phi, joints},
                {&gradient->v_phi, joints}, {&gradient->ubar, joints}, {&gradient->v, 2},
                {&from->theta, links},      {&from->dtheta, links},    {&to->theta, links},
                {&to->dtheta, links},       {&to->ddtheta, links},     {&columns->sum, 2}};
    size_t rows = 0;
    for (size_t k = 0; k < sizeof part / sizeof *part; k++)
        rows += part[k].rows;
    *columns = (fp_columns){.N = N, .stride = (int)stride, .wide = moray_fp_widest()};
    double *block = calloc(rows * stride, sizeof *block);
    columns->memory = malloc(moray_fp_tangents_bytes(N));
    *part[0].at = block;
    if (!block || !columns->memory)
        return moray_error(MORAY_MEMORY, "no memory for %d directions of %d links", most, N);
    for (size_t k = 0; k < sizeof part / sizeof *part; k++, block += part[k - 1].rows * stride)
        *part[k].at = block;
    from->ubar = along->ubar;
    from->v = along->v;
    to->v = gradient->v;
    return moray_ok();
}

void moray_fp_columns_free(fp_columns *columns)
{
    free(columns->along.mean);
    free(columns->memory);
}

// moray_fp_angles of every column.
static void find_angles(const fp_columns *columns, const double *mean, const double *joints, double *angles)
{
    const int N = columns->N, stride = columns->stride;
    double *sum = columns->sum;
    for (int j = 0; j < stride; j++)
        angles[j] = sum[j] = 0;
    for (int i = 1; i < N; i++)
        for (int j = 0; j < stride; j++) {
            angles[i * stride + j] = angles[(i - 1) * stride + j] - joints[(i - 1) * stride + j];
            sum[j] += angles[i * stride + j];
        }
    for (int i = 0; i < N; i++)
        for (int j = 0; j < stride; j++)
            angles[i * stride + j] += mean[j] - sum[j] / N;
}

// moray_fp_pull_angles of every column.
static void pull(const fp_columns *columns, const double *on_angles, double *on_joints, double *on_mean)
{
    const int N = columns->N, stride = columns->stride;
    double *mean = columns->sum, *behind = columns->sum + stride;
    for (int j = 0; j < stride; j++)
        mean[j] = behind[j] = 0;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < stride; j++)
            mean[j] += on_angles[i * stride + j] / N;
    for (int i = N - 1; i > 0; i--)
        for (int j = 0; j < stride; j++) {
            behind[j] += on_angles[i * stride + j] - mean[j];
            on_joints[(i - 1) * stride + j] = -behind[j];
        }
    for (int j = 0; j < stride && on_mean; j++)
        on_mean[j] = N * mean[j];
}

void moray_fp_columns_find(fp_columns *columns, const fp_point *at)
{
    const fp_joint_motion *along = &columns->along, *gradient = &columns->gradient;
    columns->links.n = columns->n;
    columns->links.stride = columns->stride;
    find_angles(columns, along->mean, along->phi, columns->links.theta);
    find_angles(columns, along->v_mean, along->v_phi, columns->links.dtheta);
    moray_fp_tangents(columns->wide, at, &columns->links, columns->memory, &columns->by_links);
    pull(columns, columns->by_links.theta, gradient->phi, gradient->mean);
    pull(columns, columns->by_links.dtheta, gradient->v_phi, gradient->v_mean);
    pull(columns, columns->by_links.ddtheta, gradient->ubar, NULL);
}
