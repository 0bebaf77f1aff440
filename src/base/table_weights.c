// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "base/table.h"
#include "moray/num.h"

// The piece that holds x, the first or last where it is beyond.
static int piece_of(const struct table_axis *axis, double x)
{
    int low = 0, high = axis->n - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (x >= axis->x[middle])
            low = middle;
        else
            high = middle;
    }
    return low;
}

// -1 and 1 beyond the ends, else 0.
static int side_of(const struct table_axis *axis, double x)
{
    return x < axis->x[0] ? -1 : x > axis->x[axis->n - 1] ? 1 : 0;
}

static void hermite(double s, double h, double weight[3][4])
{
    const double filled[3][4] = {
        {(1 + 2 * s) * (1 - s) * (1 - s), h * s * (1 - s) * (1 - s), s * s * (3 - 2 * s), h * s * s * (s - 1)},
        {6 * s * (s - 1) / h, (1 - s) * (1 - 3 * s), 6 * s * (1 - s) / h, s * (3 * s - 2)},
        {(12 * s - 6) / (h * h), (6 * s - 4) / h, (6 - 12 * s) / (h * h), (6 * s - 2) / h}};
    memcpy(weight, filled, sizeof filled);
}

int moray_table_weights(const struct table_axis *axis, double x, double weight[3][4])
{
    const int i = piece_of(axis, x), side = side_of(axis, x), end = side < 0 ? 0 : 2;
    const double h = axis->x[i + 1] - axis->x[i];
    if (side == 0 && !isnan(x)) {
        hermite((x - axis->x[i]) / h, h, weight);
        return i;
    }
    memset(weight, 0, 12 * sizeof(double));
    weight[0][end] = 1;
    if (axis->outside == MORAY_LINEAR) {
        weight[0][end + 1] = x - axis->x[side < 0 ? 0 : axis->n - 1];
        weight[1][end + 1] = 1;
    }
    for (int k = 0; k < 12 && (axis->outside == MORAY_NAN || isnan(x)); k++)
        weight[k / 4][k % 4] = NAN;
    return i;
}

int moray_table_complex_weights(const struct table_axis *axis, double complex x, double complex weight[4])
{
    const int i = piece_of(axis, creal(x)), side = side_of(axis, creal(x)), end = side < 0 ? 0 : 2;
    const double h = axis->x[i + 1] - axis->x[i];
    const double complex s = (x - axis->x[i]) / h;
    if (side == 0 && !isnan(creal(x))) {
        weight[0] = (1 + 2 * s) * (1 - s) * (1 - s);
        weight[1] = h * s * (1 - s) * (1 - s);
        weight[2] = s * s * (3 - 2 * s);
        weight[3] = h * s * s * (s - 1);
        return i;
    }
    const bool none = axis->outside == MORAY_NAN || isnan(creal(x));
    for (int k = 0; k < 4; k++)
        weight[k] = none ? moray_complex(NAN, NAN) : 0;
    if (none)
        return i;
    weight[end] = 1;
    if (axis->outside == MORAY_LINEAR)
        weight[end + 1] = x - axis->x[side < 0 ? 0 : axis->n - 1];
    return i;
}
