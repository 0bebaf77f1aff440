// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "job.h"

enum { samples = 201 };

// The optimal orbit over one period: time, states, joint coordinates of (25).
moray_status gait_job_trajectory(const gait_job *job, const stage *at, moray_output *output)
{
    const bool control = at->model == MORAY_CONTROL_ORIENTED;
    const char *const names[2][6] = {{"theta", "p_x", "p_y", "v_theta", "v_t", "v_n"},
                                     {"theta", "p_x", "p_y", "v_theta", "v_x", "v_y"}};
    const char *const units[] = {"rad", "m", "m", "rad/s", "m/s", "m/s"};
    const int joints = job->snake.robot.links - 1, full = job->joints == MORAY_JOINTS_ON_GAIT ? 0 : joints;
    const int width = 1 + 6 + joints, states = 6 + 2 * full;
    FILE *file;
    MORAY_TRY(moray_output_file(output, "trajectory.csv", &file));
    double *data = calloc((size_t)(samples * width + states + 3 * joints), sizeof *data);
    moray_column *columns = calloc((size_t)width, sizeof *columns);
    char(*joint_names)[16] = calloc((size_t)joints, sizeof *joint_names);
    moray_status status = data && columns && joint_names ? moray_ok() : moray_error(MORAY_MEMORY, "no memory");
    double t0, tf, *x = data ? data + samples * width : NULL, *phi = data ? x + states : NULL;
    moray_solution_times(at->solution, at->phase, &t0, &tf);
    for (int k = 0; k < samples && !moray_failed(status); k++) {
        double *row = data + k * width;
        row[0] = t0 + (tf - t0) * k / (samples - 1);
        moray_solution_at(at->solution, at->phase, row[0], x, NULL);
        memcpy(row + 1, x + full, 3 * sizeof *row);
        memcpy(row + 4, x + states - 3, 3 * sizeof *row);
        moray_gait_reference(&at->prediction.gait, joints, row[0], phi, phi + joints, phi + 2 * joints);
        memcpy(row + 7, phi, (size_t)joints * sizeof *row);
    }
    for (int j = 0; j < width && !moray_failed(status); j++) {
        if (j > 6)
            snprintf(joint_names[j - 7], sizeof *joint_names, "phi_%d", j - 6);
        columns[j] = (moray_column){.name = j == 0   ? "t"
                                            : j <= 6 ? names[!control][j - 1]
                                                     : joint_names[j - 7],
                                    .unit = j == 0    ? "s"
                                            : j <= 6  ? units[j - 1]
                                            : control ? "m"
                                                      : "rad",
                                    .values = data + j,
                                    .stride = width};
    }
    if (!moray_failed(status))
        moray_csv_write(file, columns, width, samples);
    free(joint_names);
    free(columns);
    free(data);
    return status;
}
