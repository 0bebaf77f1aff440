// SPDX-License-Identifier: MIT
#include "snake/plant/fp_columns.h"

#include <stdlib.h>

#include "base/lanes.h"

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
                {&to->dtheta, links},       {&to->ddtheta, links},     {&columns->sum, 1}};
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

// moray_fp_angles of FP_LANES columns.
FOR_EACH_PROCESSOR
static void find_angles(int N, int stride, const double *mean, const double *joints, double *angles)
{
    double at[FP_LANES] = {0}, sum[FP_LANES] = {0};
    for (int i = 0; i < N; i++, joints += stride)
        for (int j = 0; j < FP_LANES; j++) {
            angles[i * stride + j] = at[j];
            sum[j] += at[j];
            at[j] -= i < N - 1 ? joints[j] : 0;
        }
    for (int i = 0; i < N; i++)
        for (int j = 0; j < FP_LANES; j++)
            angles[i * stride + j] += mean[j] - sum[j] / N;
}

// moray_fp_pull_angles of FP_LANES columns.
FOR_EACH_PROCESSOR
static void pull(int N, int stride, const double *on_angles, double *on_joints, double *on_mean)
{
    double mean[FP_LANES] = {0}, behind[FP_LANES] = {0};
    for (int i = 0; i < N; i++)
        for (int j = 0; j < FP_LANES; j++)
            mean[j] += on_angles[i * stride + j] / N;
    for (int i = N - 1; i > 0; i--)
        for (int j = 0; j < FP_LANES; j++) {
            behind[j] += on_angles[i * stride + j] - mean[j];
            on_joints[(i - 1) * stride + j] = -behind[j];
        }
    for (int j = 0; j < FP_LANES; j++)
        on_mean[j] = N * mean[j];
}

void moray_fp_columns_find(fp_columns *columns, const fp_point *at)
{
    const fp_joint_motion *along = &columns->along, *gradient = &columns->gradient;
    const int N = columns->N, stride = columns->stride;
    columns->links.n = columns->n;
    columns->links.stride = columns->stride;
    for (int j = 0; j < columns->n; j += FP_LANES) {
        find_angles(N, stride, along->mean + j, along->phi + j, columns->links.theta + j);
        find_angles(N, stride, along->v_mean + j, along->v_phi + j, columns->links.dtheta + j);
    }
    moray_fp_tangents(columns->wide, at, &columns->links, columns->memory, &columns->by_links);
    for (int j = 0; j < columns->n; j += FP_LANES) {
        pull(N, stride, columns->by_links.theta + j, gradient->phi + j, gradient->mean + j);
        pull(N, stride, columns->by_links.dtheta + j, gradient->v_phi + j, gradient->v_mean + j);
        pull(N, stride, columns->by_links.ddtheta + j, gradient->ubar + j, columns->sum + j);
    }
}
