// SPDX-License-Identifier: MIT
#include "job.h"

static void json_score(moray_json *json, const char *key, const moray_heading_score *score)
{
    moray_json_open(json, key);
    moray_json_number(json, "rms_deg", score->rms / DEG);
    moray_json_number(json, "final_deg", score->final / DEG);
    moray_json_number(json, "largest_deg", score->largest / DEG);
    moray_json_number(json, "power_W", score->power);
    moray_json_close(json);
}

static void json_receding(moray_json *json, const heading_job *job, const moray_receding_horizon_record *record)
{
    moray_json_open(json, "receding");
    moray_json_number(json, "plans", record->plans);
    moray_json_number(json, "not_solved", record->failures);
    moray_json_number(json, "iterations", record->iterations);
    moray_json_number(json, "time_s", record->seconds);
    moray_json_number(json, "longest_s", record->longest);
    moray_json_number(json, "times_real_time", job->horizon / record->seconds);
    moray_json_close(json);
}

static void json_trials(moray_json *json, const heading_job *job)
{
    static const char *const laws[] = {"feedback", "plan", "plan and feedback", "receding"};
    moray_json_open_list(json, "steering");
    for (int k = 0; k < job->n_trials; k++) {
        const heading_trial *trial = &job->trial[k];
        const bool planned = trial->law != HEADING_FEEDBACK;
        moray_json_open(json, NULL);
        moray_json_text(json, "law", laws[trial->law]);
        moray_json_text(json, "gait", trial->gait == 0 ? "paper" : steer_gait_given(&job->input) ? "given" : "found");
        moray_json_text(json, "plan", !planned ? NULL : trial->plan == MORAY_CONTROL_ORIENTED ? "control" : "fp");
        moray_json_bool(json, "reference_known_ahead", trial->preview);
        moray_json_number(json, "gain_m_rad", trial->evaluations ? trial->gain : NAN);
        moray_json_number(json, "lead_s", trial->lead);
        json_score(json, "predicted", &trial->score[MORAY_CONTROL_ORIENTED]);
        json_score(json, "validated", &trial->score[MORAY_FIRST_PRINCIPLES]);
        if (trial->law == HEADING_RECEDING)
            json_receding(json, job, &trial->record[MORAY_FIRST_PRINCIPLES]);
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void json_fig8(moray_json *json, const heading_job *job)
{
    static const char *const keys[2][2] = {{"control", "_m"}, {"fp", "_deg"}};
    moray_json_open(json, "fig8_offset");
    for (int model = 0; model <= (int)job->common.model; model++) {
        const heading_fig8_match match = heading_fig8_compare(job, (moray_model)model);
        const double unit = model == MORAY_CONTROL_ORIENTED ? 1 : DEG;
        const struct {
            const char *name;
            double value;
        } values[] = {{"paper", match.paper},
                      {"turning", match.there},
                      {"back", match.back},
                      {"straight", match.straight},
                      {"rms_difference", match.rms}};
        moray_json_open(json, keys[model][0]);
        for (unsigned k = 0; k < sizeof values / sizeof *values; k++) {
            char key[40];
            snprintf(key, sizeof key, "%s%s", values[k].name, keys[model][1]);
            moray_json_number(json, key, values[k].value / unit);
        }
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void json_plan(moray_json *json, const char *key, const heading_job *job, moray_model model)
{
    const moray_heading_plan *plan = &job->plan[model];
    const moray_gait gaits[2] = {job->straight[1 + model][0].gait, job->straight[1 + model][1].gait};
    moray_json_open(json, key);
    moray_gait_to_json(json, "gait", &job->common.robot, gaits);
    moray_solver_to_json(json, plan->solution);
    moray_json_close(json);
    moray_certificate_to_json(json, &job->certificate[model]);
    moray_json_close(json);
}

moray_json *heading_json(const heading_job *job)
{
    const bool control = job->common.model == MORAY_CONTROL_ORIENTED;
    const moray_heading_spec spec = heading_spec(job, job->common.model, false);
    const steer_saturation share = steer_saturation_of(heading_last_plan(job)->solution, &spec.limits);
    char text[1200];
    heading_explain(job, text, sizeof text);
    moray_json *json = moray_json_new();
    moray_json_text(json, "problem", "heading_tracking");
    moray_json_text(json, "version", moray_version());
    moray_json_text(json, "model", control ? "control" : "fp");
    moray_json_open(json, "robot");
    moray_json_number(json, "links", job->common.robot.links);
    moray_json_close(json);
    moray_json_numbers(json, "current_m_s", job->common.current, 2);
    moray_json_text(json, "reference", job->reference_text);
    moray_json_number(json, "horizon_s", job->horizon);
    moray_json_text(json, "scheme", job->common.scheme);
    json_plan(json, "control_oriented_plan", job, MORAY_CONTROL_ORIENTED);
    if (!control)
        json_plan(json, "first_principles_plan", job, MORAY_FIRST_PRINCIPLES);
    json_trials(json, job);
    if (heading_is_fig8(job))
        json_fig8(json, job);
    moray_json_number(json, "gaits_tried", job->gaits_tried);
    moray_json_open(json, "limits");
    moray_json_number(json, "turn_rate_deg_s", job->turn_rate / DEG);
    moray_json_number(json, "reference_rate_deg_s", moray_reference_fastest(&job->reference, 0, job->horizon) / DEG);
    moray_json_number(json, "offset_at_limit_percent", 100 * share.offset);
    moray_json_number(json, "offset_rate_at_limit_percent", 100 * share.rate);
    moray_json_text(json, "in_words", text);
    moray_json_close(json);
    return json;
}
