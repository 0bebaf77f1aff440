// SPDX-License-Identifier: MIT
//
// Values, slopes in x and y and mixed slopes at the points of a grid: the product of two splines.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/table.h"

struct moray_surface {
    struct table_axis x, y;
    double *z, *zx, *zy, *zxy; // [nx][ny], in the block of
    double *block;             // the axes
};

static void find_slopes(moray_surface *s, moray_table_ends ends, double *work)
{
    const int nx = s->x.n, ny = s->y.n;
    for (int j = 0; j < ny; j++)
        moray_spline_slopes(nx, s->x.x, s->z + j, ny, ends, work, s->zx + j);
    for (int i = 0; i < nx; i++)
        moray_spline_slopes(ny, s->y.x, s->z + i * ny, 1, ends, work, s->zy + i * ny);
    for (int j = 0; j < ny; j++)
        moray_spline_slopes(nx, s->x.x, s->zy + j, ny, ends, work, s->zxy + j);
}

moray_status moray_surface_new(moray_surface **result, int nx, const double *x, int ny, const double *y,
                               const double *z, moray_table_ends ends, moray_table_outside outside)
{
    *result = NULL;
    MORAY_TRY(moray_check_axis("x", nx, x, ends, outside));
    MORAY_TRY(moray_check_axis("y", ny, y, ends, outside));
    if (ends == MORAY_MONOTONE)
        return moray_error(MORAY_INPUT, "a surface is not made monotone: choose other ends");
    const size_t points = (size_t)nx * (size_t)ny, axes = (size_t)nx + (size_t)ny;
    for (size_t k = 0; k < points; k++)
        if (!isfinite(z[k]))
            return moray_error(MORAY_INPUT, "z[%d][%d] = %g: must be finite", (int)k / ny, (int)k % ny, z[k]);
    moray_surface *s = calloc(1, sizeof *s);
    double *block = calloc(4 * points + 3 * axes, sizeof *block);
    if (!s || !block) {
        free(s);
        free(block);
        return moray_error(MORAY_MEMORY, "no memory for a surface of %d x %d numbers", nx, ny);
    }
    memcpy(block, x, (size_t)nx * sizeof *x);
    memcpy(block + nx, y, (size_t)ny * sizeof *y);
    double *at = block + axes;
    *s = (struct moray_surface){{nx, block, outside}, {ny, block + nx, outside}, at,   at + points,
                                at + 2 * points,      at + 3 * points,           block};
    memcpy(s->z, z, points * sizeof *z);
    find_slopes(s, ends, at + 4 * points);
    *result = s;
    return moray_ok();
}

void moray_surface_free(moray_surface *surface)
{
    if (!surface)
        return;
    free(surface->block);
    free(surface);
}

// What weights of x and y multiply: value or slope (odd) at the left or the right.
static double corner(const moray_surface *s, int i, int j, int a, int b)
{
    const int at = (i + a / 2) * s->y.n + j + b / 2;
    return (a % 2 ? (b % 2 ? s->zxy : s->zx) : (b % 2 ? s->zy : s->z))[at];
}

double moray_surface_real(const moray_surface *s, double x, double y, double *d)
{
    static const int order[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
    double u[3][4], v[3][4], value[6] = {0};
    const int i = moray_table_weights(&s->x, x, u), j = moray_table_weights(&s->y, y, v);
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++)
            for (int k = 0; k < (d ? 6 : 1); k++)
                value[k] += u[order[k][0]][a] * v[order[k][1]][b] * corner(s, i, j, a, b);
    if (d)
        memcpy(d, value + 1, 5 * sizeof *d);
    return value[0];
}

double complex moray_surface_at(const moray_surface *s, double complex x, double complex y)
{
    double complex u[4], v[4], sum = 0;
    const int i = moray_table_complex_weights(&s->x, x, u), j = moray_table_complex_weights(&s->y, y, v);
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++)
            sum += u[a] * v[b] * corner(s, i, j, a, b);
    return sum;
}
