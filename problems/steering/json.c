// SPDX-License-Identifier: MIT
#include "steer.h"

static void json_scores(const steer_job *job, moray_json *json, const char *key, const double *score)
{
    moray_json_open(json, key);
    for (int k = 0; k < job->program->n_scores; k++)
        moray_json_number(json, job->program->scores[k].key, score[k] / job->program->scores[k].unit);
    moray_json_close(json);
}

static void json_receding(const steer_job *job, moray_json *json, const steer_trial *trial)
{
    const moray_receding_horizon_record *record = &trial->record[MORAY_FIRST_PRINCIPLES];
    moray_json_object(json, "receding",
                      MORAY_MEMBERS({"plans", record->plans}, {"not_solved", record->failures},
                                    {"iterations", record->iterations}, {"time_s", record->seconds},
                                    {"longest_s", record->longest},
                                    {"times_real_time", job->program->swum(job, trial) / record->seconds}));
}

static void json_trial(const steer_job *job, moray_json *json, const steer_trial *trial)
{
    const steer_program *program = job->program;
    const char *gait = trial->gait == 0 ? "paper" : steer_gait_given(job) ? "given" : "found";
    moray_json_open(json, NULL);
    if (program->tells_name)
        moray_json_text(json, "name", trial->name);
    moray_json_text(json, "law", trial->law->key);
    if (!program->one_gait)
        moray_json_text(json, "gait", gait);
    moray_json_text(json, "plan", trial->law->kind == STEER_UNPLANNED ? NULL : moray_model_key(trial->plan));
    if (program->tells_preview)
        moray_json_bool(json, "reference_known_ahead", trial->law->preview);
    for (int k = 0; k < program->n_numbers; k++)
        moray_json_number(json, job->number[k].key, trial->number[k]);
    json_scores(job, json, "predicted", trial->score[MORAY_CONTROL_ORIENTED]);
    json_scores(job, json, "validated", trial->score[MORAY_FIRST_PRINCIPLES]);
    if (!trial->run || trial->cut)
        moray_json_text(json, "cut_short", trial->run ? "tuning" : "not swum");
    if (trial->law->kind == STEER_RECEDING && trial->run)
        json_receding(job, json, trial);
    moray_json_close(json);
}

static void json_plan(const steer_job *job, moray_json *json, const char *key, moray_model model)
{
    moray_json_open(json, key);
    job->program->json_plan(job, json, model);
    moray_solver_to_json(json, job->plan[model].solution);
    moray_json_close(json);
    moray_certificate_to_json(json, &job->certificate[model]);
    moray_json_close(json);
}

void steer_json_gait(const steer_job *job, moray_json *json, int gait)
{
    const moray_gait gaits[2] = {job->straight[gait][0].gait, job->straight[gait][1].gait};
    moray_gait_to_json(json, "gait", &job->snake.robot, gaits);
}

void steer_json_saturation(const steer_job *job, moray_json *json, moray_model model)
{
    const steer_saturation share = steer_saturation_of(job, model);
    moray_json_number(json, "offset_at_limit_percent", 100 * share.offset);
    moray_json_number(json, "offset_rate_at_limit_percent", 100 * share.rate);
}

void steer_summary(const void *found, moray_json *json)
{
    const steer_job *job = found;
    moray_snake_to_json(json, &job->snake);
    job->program->json_head(job, json);
    if (moray_failed(job->without))
        moray_json_text(json, "not_solved", job->without.text);
    json_plan(job, json, "control_oriented_plan", MORAY_CONTROL_ORIENTED);
    if (job->snake.model == MORAY_FIRST_PRINCIPLES)
        json_plan(job, json, "first_principles_plan", MORAY_FIRST_PRINCIPLES);
    moray_json_open_list(json, "steering");
    for (int k = 0; k < job->n_trials; k++)
        json_trial(job, json, &job->trial[k]);
    moray_json_close(json);
    if (job->program->json_tail)
        job->program->json_tail(job, json);
}
