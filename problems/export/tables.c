// SPDX-License-Identifier: MIT
//
// The gait over time: joint angles and rates at the control rate.
#include "export.h"

#include <math.h>
#include <stdlib.h>

enum { NAME_SIZE = 16 };

// Rows of t, angles, rates and accelerations, the first `length` of them on the ramp.
static void fill(const export_found *found, int rows, double length, double *values)
{
    const int n = found->wave.joints;
    for (int k = 0; k < rows; k++) {
        double *row = values + (size_t)k * (3 * (size_t)n + 1), *phi = row + 1, *dphi = phi + n, *ddphi = dphi + n;
        double ramp[3];
        row[0] = k * found->step;
        moray_gait_reference(&found->gait, n, row[0], phi, dphi, ddphi);
        export_ramp(row[0], length, ramp);
        for (int i = 0; i < n; i++) {
            ddphi[i] = ramp[2] * phi[i] + 2 * ramp[1] * dphi[i] + ramp[0] * ddphi[i];
            dphi[i] = ramp[1] * phi[i] + ramp[0] * dphi[i];
            phi[i] *= ramp[0];
        }
    }
}

static moray_status write(const export_found *found, FILE *file, int rows, double length)
{
    static const char *const kinds[][2] = {{"phi", "rad"}, {"dphi", "rad/s"}, {"ddphi", "rad/s^2"}};
    const int n = found->wave.joints, width = 3 * n + 1;
    double *values = malloc((size_t)rows * (size_t)width * sizeof *values);
    moray_column *column = calloc((size_t)width, sizeof *column);
    char(*name)[NAME_SIZE] = calloc((size_t)width, sizeof *name);
    const bool room = values && column && name;
    if (room) {
        fill(found, rows, length, values);
        column[0] = (moray_column){"t", "s", values, width};
        for (int k = 1; k < width; k++) {
            snprintf(name[k], sizeof name[k], "%s_%d", kinds[(k - 1) / n][0], (k - 1) % n + 1);
            column[k] = (moray_column){name[k], kinds[(k - 1) / n][1], values + k, width};
        }
        moray_csv_write(file, column, width, rows);
    }
    free(name);
    free(column);
    free(values);
    return room ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for a table of %d rows", rows);
}

moray_status export_tables(const export_found *found, moray_output *output)
{
    const double length = found->job->ramp * found->period;
    FILE *file;
    MORAY_TRY(moray_output_file(output, "gait.csv", &file));
    MORAY_TRY(write(found, file, (int)round(found->period / found->step), 0));
    if (!(length > 0))
        return moray_ok();
    MORAY_TRY(moray_output_file(output, "ramp.csv", &file));
    return write(found, file, (int)ceil(length / found->step * (1 - 1e-12)), length);
}
