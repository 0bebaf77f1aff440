// SPDX-License-Identifier: MIT
#include "path.h"

// ---- Tables --------------------------------------------------------------------------------------------------------

const steer_score path_scores[PATH_SCORES] = {{"rms_m", 1},  {"settled_rms_m", 1}, {"settled_largest_m", 1},
                                              {"time_s", 1}, {"power_W", 1},       {"cost", 1}};

const steer_column path_columns[] = {{"control: RMS", MORAY_CONTROL_ORIENTED, PATH_RMS, .unit = 0.01},
                                     {"time", MORAY_CONTROL_ORIENTED, PATH_TIME, .unit = 1},
                                     {"first-pr.: RMS", MORAY_FIRST_PRINCIPLES, PATH_RMS, .unit = 0.01},
                                     {"settled", MORAY_FIRST_PRINCIPLES, PATH_SETTLED_RMS, .unit = 0.01},
                                     {"largest", MORAY_FIRST_PRINCIPLES, PATH_SETTLED_LARGEST, .unit = 0.01},
                                     {"time", MORAY_FIRST_PRINCIPLES, PATH_TIME, .unit = 1},
                                     {"cost", MORAY_FIRST_PRINCIPLES, PATH_COST, .unit = 1},
                                     {"power", MORAY_FIRST_PRINCIPLES, PATH_POWER, .unit = 1}};
enum { columns = sizeof path_columns / sizeof *path_columns };

static void leg_table(const path_job *job, steer_tables *tables)
{
    moray_table table = {.title = "Path; crab angle: heading less course, asked for by the current and planned",
                         .columns = {"length, m", "course, deg", "crab, deg", "planned", "turning, deg/s"},
                         .n_columns = 5};
    for (int k = 0; k < job->path.n && k < STEER_ROWS; k++) {
        const moray_path_piece *piece = &job->path.piece[k];
        const bool leg = piece->curvature == 0;
        double asked = NAN, planned = NAN;
        if (leg)
            path_crab(job, piece, &asked, &planned);
        snprintf(tables->label[k], sizeof *tables->label, leg ? "leg %d" : "corner behind leg %d", piece->leg);
        tables->rows[tables->n][table.n_rows++] =
            (moray_table_row){.label = tables->label[k],
                              .value = {piece->length, piece->course / DEG, asked / DEG, planned / DEG,
                                        leg ? NAN : path_turning(job, piece) / DEG}};
    }
    steer_add_table(tables, &table);
}

void path_tables(const steer_job *job, steer_tables *tables)
{
    steer_gait_table(job, tables, 0);
    leg_table((const path_job *)job, tables);
    steer_score_table(job, tables, columns);
    steer_tuning_table(job, tables);
}

// ---- In words ------------------------------------------------------------------------------------------------------

void path_headline(const steer_job *steer, FILE *file)
{
    const path_job *job = (const path_job *)steer;
    fprintf(file, "path %s, radius %g m, from (%g, %g)", job->path_text, job->radius, job->start[0], job->start[1]);
}

void path_conclude(const steer_job *job, char *text, size_t size)
{
    const steer_trial *ours = steer_best(job, 1 << PATH_PLAN | 1 << PATH_BOTH | 1 << PATH_RECEDING, PATH_COST);
    const steer_trial *theirs = steer_best(job, 1 << PATH_LOS | 1 << PATH_ILOS, PATH_COST);
    const double *a = ours->score[1], *b = theirs->score[1];
    snprintf(text, size,
             "First-principles model, same limits: the best optimised steering (%s) takes %.2f s with a settled RMS "
             "cross-track error of %.2f cm, the best tuned guidance (%s) %.2f s and %.2f cm; in what both were to "
             "minimise %.2f against %.2f%s.",
             ours->name, a[PATH_TIME], 100 * a[PATH_SETTLED_RMS], theirs->name, b[PATH_TIME], 100 * b[PATH_SETTLED_RMS],
             a[PATH_COST], b[PATH_COST], a[PATH_COST] < b[PATH_COST] ? "" : ": the optimised one LOSES");
}

// ---- JSON, figures -------------------------------------------------------------------------------------------------

void path_json_head(const steer_job *steer, moray_json *json)
{
    const path_job *job = (const path_job *)steer;
    moray_json_text(json, "path", job->path_text);
    moray_json_number(json, "length_m", job->path.length);
    moray_json_text(json, "scheme", steer->common.scheme);
    moray_json_open_list(json, "legs");
    for (int k = 0; k < job->path.n; k++) {
        const moray_path_piece *leg = &job->path.piece[k];
        double asked, planned;
        if (leg->curvature != 0)
            continue;
        path_crab(job, leg, &asked, &planned);
        moray_json_open(json, NULL);
        moray_json_number(json, "leg", leg->leg);
        moray_json_number(json, "course_deg", leg->course / DEG);
        moray_json_number(json, "crab_by_triangle_deg", asked / DEG);
        moray_json_number(json, "crab_planned_deg", planned / DEG);
        moray_json_close(json);
    }
    moray_json_close(json);
}

void path_json_plan(const steer_job *job, moray_json *json, moray_model model)
{
    moray_json_number(json, "time_s", steer_duration(job->plan[model].solution));
    steer_json_gait(job, json, 1 + (int)model);
}

void path_json_tail(const steer_job *steer, moray_json *json)
{
    const path_job *job = (const path_job *)steer;
    double turning = 0;
    for (int k = 0; k < job->path.n; k++)
        turning = fmax(turning, path_turning(job, &job->path.piece[k]));
    moray_json_open(json, "limits");
    moray_json_number(json, "turn_rate_deg_s", fabs(steer->turn_rate[steer->common.model]) / DEG);
    moray_json_number(json, "corner_turn_rate_deg_s", turning / DEG);
    steer_json_saturation(steer, json, steer->common.model);
    moray_json_close(json);
}

bool path_values(const steer_job *job, const steer_trial *trial, const moray_swim_track *track, double *values)
{
    double along = 0;
    for (int k = 0; trial && k < track->n; k++) {
        const moray_pose *pose = &track->pose[k];
        moray_path_project(&((const path_job *)job)->path, pose->p_x, pose->p_y, &along, &values[k]);
        values[k] *= 100;
    }
    return trial != NULL;
}

void path_points(const steer_job *steer, double x[STEER_POINTS], double y[STEER_POINTS])
{
    const moray_path *path = &((const path_job *)steer)->path;
    for (int k = 0; k < STEER_POINTS; k++) {
        const moray_path_point at = moray_path_at(path, path->length * k / (STEER_POINTS - 1));
        x[k] = creal(at.x);
        y[k] = creal(at.y);
    }
}
