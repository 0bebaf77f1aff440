// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "free_gait.h"

// ---- Summary -------------------------------------------------------------------------------------------------------

static void json_swum(moray_json *json, const free_gait *run, const stage *at)
{
    if (at->model == MORAY_CONTROL_ORIENTED)
        moray_steady_to_json(json, "simulated_control", &run->job.snake.robot, MORAY_CONTROL_ORIENTED, &at->trial,
                             run->job.snake.course);
    moray_steady_to_json(json, "validated", &run->job.snake.robot, MORAY_FIRST_PRINCIPLES, &at->trial,
                         run->job.snake.course);
}

// A series in the parameters of its own and of the first-principles model.
static void json_motion(moray_json *json, const free_gait *run, const motion *m)
{
    const char *const keys[] = {"series_m", "series_rad"};
    moray_json_text(json, "motion", m->name);
    moray_json_number(json, "harmonics", m->harmonics);
    moray_json_number(json, "omega_deg_s", m->at.prediction.gait.omega / DEG);
    if (m->harmonics == 0)
        moray_gait_to_json(json, "gait", &run->job.snake.robot, m->at.trial.gait);
    for (int model = (int)m->at.model; model < 2 && m->harmonics > 0; model++)
        moray_json_numbers(json, keys[model], m->series[model].at, m->series[model].joints * (1 + 2 * m->harmonics));
    gait_job_json_prediction(json, &m->at.prediction);
    json_swum(json, run, &m->at);
    moray_json_number(json, "prediction_off_by", free_gait_disagreement(m));
    gait_job_json_gain(json, "gain", &m->at.gain);
    gait_job_json_ladder(json, &run->job, &m->at);
    gait_job_json_gain(json, "gain_over_best_gait", &m->over_best);
    gait_job_json_gain(json, "gain_over_gait_alike", &m->over_alike);
    moray_solver_to_json(json, m->at.solution);
    moray_json_close(json);
    moray_certificate_to_json(json, &m->at.certificate);
}

void free_gait_summary(const void *found, moray_json *json)
{
    const free_gait *run = found;
    const gait_job *job = &run->job;
    const stage *best = last_stage(job);
    gait_job_json_head(json, job);
    moray_json_number(json, "power_limit_W", best->power);
    moray_json_number(json, "link_angle_limit_deg", run->limit / DEG);
    json_motion(json, run, freest(run));
    moray_json_open_list(json, "motions");
    for (int k = 0; k < run->n; k++) {
        moray_json_open(json, NULL);
        json_motion(json, run, &run->motion[k]);
        moray_json_close(json);
    }
    moray_json_close(json);
    moray_json_open(json, "best_gait");
    gait_job_json_stage(json, job, best);
    moray_json_close(json);
    moray_json_open(json, "baseline");
    moray_gait_to_json(json, "gait", &job->snake.robot, job->paper.gait);
    moray_steady_to_json(json, "validated", &job->snake.robot, MORAY_FIRST_PRINCIPLES, &job->paper, job->snake.course);
    moray_json_close(json);
}

// ---- Files ---------------------------------------------------------------------------------------------------------

static int angle_width(const free_gait *run)
{
    return 2 * run->job.snake.robot.links; // time, N-1 joints, N links
}

moray_status free_gait_angles(const free_gait *run, const moray_gait_trial *trial, double **value)
{
    const moray_model model = MORAY_FIRST_PRINCIPLES;
    const moray_swim_setup setup = moray_test_rig_setup(&run->job.rig, model);
    const int N = run->job.snake.robot.links, width = angle_width(run);
    moray_steady steady;
    moray_swim_track orbit;
    *value = calloc((size_t)(FREE_GAIT_SAMPLES * width), sizeof **value);
    if (!*value)
        return moray_error(MORAY_MEMORY, "no memory for a motion");
    MORAY_TRY(moray_swim_steady(&setup, &trial->gait[model], trial->steady[model].start_heading, &steady, &orbit,
                                FREE_GAIT_SAMPLES));
    for (int k = 0; k < orbit.n; k++) {
        const double *x = orbit.x + k * orbit.n_states;
        double *row = *value + k * width;
        row[0] = orbit.t[k];
        for (int i = 0; i < N; i++) {
            if (i < N - 1)
                row[1 + i] = x[i] - x[i + 1]; // (1)
            row[N + i] = x[i] - orbit.pose[k].heading;
        }
    }
    moray_swim_track_free(&orbit);
    return moray_ok();
}

// The coefficients of the first-principles model, a line a joint and a harmonic; the offset c stands as harmonic 0.
static moray_status write_series(const free_gait *run, moray_output *output)
{
    const motion *m = freest(run);
    FILE *file;
    if (m->harmonics == 0)
        return moray_ok();
    MORAY_TRY(moray_output_file(output, "series.csv", &file));
    fprintf(file, "joint,harmonic,sine [rad],cosine [rad]\n");
    const moray_series *series = &m->series[MORAY_FIRST_PRINCIPLES];
    const int n = series->joints;
    for (int k = 0; k <= series->harmonics; k++)
        for (int i = 0; i < n; i++) {
            char sine[32] = "0", cosine[32];
            const double *p = series->at + (k == 0 ? 0 : n * (2 * k - 1)) + i;
            if (k > 0)
                moray_number_text(p[0], sine);
            fprintf(file, "%d,%d,%s,%s\n", i + 1, k, sine, moray_number_text(p[k == 0 ? 0 : n], cosine));
        }
    return moray_ok();
}

// The motion of the freest gait as it is swum on the first-principles model.
static moray_status write_angles(const free_gait *run, const double *value, moray_output *output)
{
    const int N = run->job.snake.robot.links, width = angle_width(run);
    FILE *file;
    MORAY_TRY(moray_output_file(output, "motion.csv", &file));
    moray_column *columns = calloc((size_t)width, sizeof *columns);
    char(*names)[24] = calloc((size_t)width, sizeof *names);
    for (int j = 0; j < width && columns && names; j++) {
        snprintf(names[j], sizeof *names, j == 0 ? "t" : j < N ? "phi_%d" : "link_angle_%d", j < N ? j : j - N + 1);
        columns[j] = (moray_column){names[j], j == 0 ? "s" : "rad", value + j, width};
    }
    const bool room = columns && names;
    if (room)
        moray_csv_write(file, columns, width, FREE_GAIT_SAMPLES);
    free(names);
    free(columns);
    return room ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for a table of %d columns", width);
}

enum { GAITS = 3, SHOWN = 3 };

// The best gait by theta_max, the gait within the links' limit, and the freest motion.
static moray_status draw_joints(const free_gait *run, double *const value[GAITS], moray_output *output)
{
    const int N = run->job.snake.robot.links, width = angle_width(run);
    const int joints[SHOWN] = {1, N / 2, N - 1}, shown = N > 3 ? SHOWN : 1;
    static const int gaits[] = {0, 2};
    moray_curve curves[2 * SHOWN];
    char labels[2 * SHOWN][64];
    double *phase = calloc((size_t)(2 * FREE_GAIT_SAMPLES * (1 + SHOWN)), sizeof *phase), *next = phase;
    if (!phase)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    int n = 0;
    for (int g = 0; g < 2; g++) {
        const double *rows = value[gaits[g]], *share = next;
        for (int k = 0; k < FREE_GAIT_SAMPLES; k++)
            *next++ = (double)k / (FREE_GAIT_SAMPLES - 1);
        for (int j = 0; j < shown; j++, n++) {
            snprintf(labels[n], sizeof labels[n], "joint %d, %s", joints[j], g == 0 ? "best gait (25)" : "free");
            curves[n] = (moray_curve){.label = labels[n], .x = share, .y = next, .n = FREE_GAIT_SAMPLES};
            for (int k = 0; k < FREE_GAIT_SAMPLES; k++)
                *next++ = rows[k * width + joints[j]] / DEG;
        }
    }
    const moray_status status =
        moray_output_figure(output, &(moray_figure){.name = "joints",
                                                    .title = "Joints over a period, first-principles model",
                                                    .x_label = "share of the period",
                                                    .y_label = "joint angle [deg]",
                                                    .curves = curves,
                                                    .n_curves = n});
    free(phase);
    return status;
}

static moray_status draw_amplitudes(const free_gait *run, double *const value[GAITS], moray_output *output)
{
    static const char *const labels[GAITS] = {"best gait (25) by theta_max", "gait (25) within the links' limit",
                                              "free motion"};
    const int N = run->job.snake.robot.links, width = angle_width(run);
    moray_curve curves[GAITS];
    double *data = calloc((size_t)((GAITS + 1) * N), sizeof *data);
    if (!data)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    for (int i = 0; i < N; i++) {
        data[i] = i + 1;
        for (int g = 0; g < GAITS; g++)
            for (int k = 0; k < FREE_GAIT_SAMPLES; k++) {
                double *peak = &data[(1 + g) * N + i];
                *peak = fmax(*peak, fabs(value[g][k * width + N + i]) / DEG);
            }
    }
    for (int g = 0; g < GAITS; g++)
        curves[g] =
            (moray_curve){.label = labels[g], .x = data, .y = data + (1 + g) * N, .n = N, .style = MORAY_CURVE_MARKED};
    const moray_status status =
        moray_output_figure(output, &(moray_figure){.name = "link_angles",
                                                    .title = "Along the body, first-principles model",
                                                    .x_label = "link, 1 at the tail",
                                                    .y_label = "largest angle from the heading [deg]",
                                                    .curves = curves,
                                                    .n_curves = GAITS});
    free(data);
    return status;
}

moray_status free_gait_write(const void *found, moray_output *output)
{
    const free_gait *run = found;
    double *value = NULL;
    moray_status status = gait_job_trajectory(&run->job, &freest(run)->at, output);
    if (!moray_failed(status))
        status = write_series(run, output);
    if (!moray_failed(status))
        status = free_gait_angles(run, &freest(run)->at.trial, &value);
    if (!moray_failed(status))
        status = write_angles(run, value, output);
    free(value);
    return status;
}

moray_status free_gait_draw(const void *found, moray_output *output)
{
    const free_gait *run = found;
    const moray_gait_trial *const trials[GAITS] = {&last_stage(&run->job)->trial, &run->motion[0].at.trial,
                                                   &freest(run)->at.trial};
    double *value[GAITS] = {NULL};
    moray_status status = moray_ok();
    for (int g = 0; g < GAITS && !moray_failed(status); g++)
        status = free_gait_angles(run, trials[g], &value[g]);
    if (!moray_failed(status))
        status = draw_joints(run, value, output);
    if (!moray_failed(status))
        status = draw_amplitudes(run, value, output);
    for (int g = 0; g < GAITS; g++)
        free(value[g]);
    return status;
}
