// SPDX-License-Identifier: MIT
#include "job.h"

static void json_score(moray_json *json, const char *key, const path_trial *trial, moray_model model)
{
    const moray_path_score *score = &trial->score[model];
    moray_json_open(json, key);
    moray_json_number(json, "rms_m", score->rms);
    moray_json_number(json, "settled_rms_m", score->settled_rms);
    moray_json_number(json, "settled_largest_m", score->settled_largest);
    moray_json_number(json, "time_s", score->time);
    moray_json_number(json, "power_W", score->power);
    moray_json_number(json, "cost", trial->cost[model]);
    moray_json_close(json);
}

static void json_receding(moray_json *json, const moray_receding_horizon_record *record, double times_real_time)
{
    moray_json_open(json, "receding");
    moray_json_number(json, "plans", record->plans);
    moray_json_number(json, "not_solved", record->failures);
    moray_json_number(json, "iterations", record->iterations);
    moray_json_number(json, "time_s", record->seconds);
    moray_json_number(json, "longest_s", record->longest);
    moray_json_number(json, "times_real_time", times_real_time);
    moray_json_close(json);
}

static void json_trials(moray_json *json, const path_job *job)
{
    static const char *const laws[] = {"line of sight", "plan", "plan and feedback", "receding"};
    moray_json_open_list(json, "steering");
    for (int k = 0; k < job->n_trials; k++) {
        const path_trial *trial = &job->trial[k];
        const moray_receding_horizon_record *record = &trial->record[MORAY_FIRST_PRINCIPLES];
        const bool planned = trial->law != PATH_SIGHT, tuned = trial->evaluations > 0;
        moray_json_open(json, NULL);
        moray_json_text(json, "name", trial->name);
        moray_json_text(json, "law", laws[trial->law]);
        moray_json_text(json, "gait", trial->gait == 0 ? "paper" : "found");
        moray_json_text(json, "plan", !planned ? NULL : trial->plan == MORAY_CONTROL_ORIENTED ? "control" : "fp");
        moray_json_number(json, "gain_m_rad", tuned ? trial->gain : NAN);
        moray_json_number(json, "lookahead_m", tuned ? trial->lookahead : NAN);
        moray_json_number(json, "ahead_m", planned ? NAN : trial->ahead);
        moray_json_number(json, "integral_gain_m_s", planned ? NAN : trial->integral_gain);
        json_score(json, "predicted", trial, MORAY_CONTROL_ORIENTED);
        json_score(json, "validated", trial, MORAY_FIRST_PRINCIPLES);
        if (trial->law == PATH_RECEDING)
            json_receding(json, record, path_real_time(job, trial, record));
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void json_plan(moray_json *json, const char *key, const path_job *job, moray_model model)
{
    const moray_path_plan *plan = &job->plan[model];
    const moray_gait gaits[2] = {job->straight[1 + model][0].gait, job->straight[1 + model][1].gait};
    double t0, tf;
    moray_solution_times(plan->solution, 0, &t0, &tf);
    moray_json_open(json, key);
    moray_json_number(json, "time_s", tf);
    moray_gait_to_json(json, "gait", &job->common.robot, gaits);
    moray_solver_to_json(json, plan->solution);
    moray_json_close(json);
    moray_certificate_to_json(json, &job->certificate[model]);
    moray_json_close(json);
}

static void json_legs(moray_json *json, const path_job *job)
{
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

moray_json *path_json(const path_job *job)
{
    const bool control = job->common.model == MORAY_CONTROL_ORIENTED;
    const moray_path_spec spec = path_spec(job, job->common.model, false);
    const steer_saturation share = steer_saturation_of(path_last_plan(job)->solution, &spec.limits);
    double turning = 0;
    for (int k = 0; k < job->path.n; k++)
        turning = fmax(turning, path_turning(job, &job->path.piece[k]));
    moray_json *json = moray_json_new();
    moray_json_text(json, "problem", "path_following");
    moray_json_text(json, "version", moray_version());
    moray_json_text(json, "model", control ? "control" : "fp");
    moray_json_open(json, "robot");
    moray_json_number(json, "links", job->common.robot.links);
    moray_json_close(json);
    moray_json_numbers(json, "current_m_s", job->common.current, 2);
    moray_json_text(json, "path", job->path_text);
    moray_json_number(json, "length_m", job->path.length);
    moray_json_text(json, "scheme", job->common.scheme);
    json_legs(json, job);
    json_plan(json, "control_oriented_plan", job, MORAY_CONTROL_ORIENTED);
    if (!control)
        json_plan(json, "first_principles_plan", job, MORAY_FIRST_PRINCIPLES);
    json_trials(json, job);
    moray_json_open(json, "limits");
    moray_json_number(json, "turn_rate_deg_s", job->turn_rate / DEG);
    moray_json_number(json, "corner_turn_rate_deg_s", turning / DEG);
    moray_json_number(json, "offset_at_limit_percent", 100 * share.offset);
    moray_json_number(json, "offset_rate_at_limit_percent", 100 * share.rate);
    moray_json_close(json);
    return json;
}
