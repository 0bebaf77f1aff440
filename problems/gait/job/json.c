// SPDX-License-Identifier: MIT
#include "job.h"

void gait_job_json_head(moray_json *json, const gait_job *job)
{
    moray_snake_to_json(json, &job->snake);
    moray_json_number(json, "course_deg", job->snake.course / DEG);
    moray_json_text(json, "scheme", job->common.scheme);
    moray_json_number(json, "intervals", job->common.intervals);
}

void gait_job_json_prediction(moray_json *json, const moray_gait_prediction *prediction)
{
    moray_json_object(json, "predicted",
                      MORAY_MEMBERS({"speed_m_s", prediction->speed}, {"course_speed_m_s", prediction->course_speed},
                                    {"power_W", prediction->power},
                                    {"cost_of_transport_J_m", prediction->power / prediction->speed},
                                    {"course_cost_J_m", prediction->power / prediction->course_speed}));
}

void gait_job_json_gain(moray_json *json, const char *key, const moray_gait_gain *gain)
{
    moray_json_object(json, key,
                      MORAY_MEMBERS({"speed_percent_at_equal_power", gain->speed_percent_at_equal_power},
                                    {"power_percent_at_equal_speed", gain->power_percent_at_equal_speed},
                                    {"omega_deg_s_at_equal_power", gain->omega_at_equal_power / DEG},
                                    {"omega_deg_s_at_equal_speed", gain->omega_at_equal_speed / DEG}));
}

static void json_solver(moray_json *json, const stage *at)
{
    moray_solver_to_json(json, at->solution);
    moray_json_number(json, "starts", at->starts);
    moray_json_number(json, "starts_at_optimum", at->agreeing);
    if (at->iterations)
        moray_json_numbers(json, "iterations_of_starts", at->iterations, at->tried);
    moray_json_close(json);
    moray_certificate_to_json(json, &at->certificate);
}

void gait_job_json_ladder(moray_json *json, const gait_job *job, const stage *at)
{
    char verdict[GAIT_TEXT] = "";
    gait_job_verdict(job, at, verdict, sizeof verdict);
    moray_ladder_to_json(json, at->ladder);
    moray_json_text(json, "verdict", verdict);
}

void gait_job_json_stage(moray_json *json, const gait_job *job, const stage *at)
{
    moray_json_number(json, "power_limit_W", at->power);
    moray_json_number(json, "least_course_speed_m_s", at->speed);
    moray_gait_to_json(json, "gait", &job->snake.robot, at->trial.gait);
    gait_job_json_prediction(json, &at->prediction);
    moray_steady_to_json(json, "simulated_control", &job->snake.robot, MORAY_CONTROL_ORIENTED, &at->trial,
                         job->snake.course);
    moray_steady_to_json(json, "validated", &job->snake.robot, MORAY_FIRST_PRINCIPLES, &at->trial, job->snake.course);
    gait_job_json_gain(json, "gain", &at->gain);
    if (at->ladder[0].model)
        gait_job_json_ladder(json, job, at);
    json_solver(json, at);
}

static void json_other(moray_json *json, const char *key, const gait_job *job, const stage *at)
{
    moray_json_open(json, key);
    if (at->left_out)
        moray_json_text(json, "left_out", at->why.text);
    else
        gait_job_json_stage(json, job, at);
    moray_json_close(json);
}

// Which gait the first keys are of, and what it was optimised for.
static void json_recommended(moray_json *json, const gait_job *job, const stage *best)
{
    const char *const kinds[] = {"control_oriented_optimum", "first_principles_optimum"};
    moray_json_text(json, "recommended", best == &job->ladder ? "ladder_optimum" : kinds[job->snake.model]);
    if (best != &job->ladder)
        return;
    moray_json_text(json, "over", job->over);
    moray_json_text(json, "over_goal", job->over_goal == MORAY_OVER_WORST ? "worst" : "mean");
    moray_json_open_list(json, "scenarios");
    for (int k = 0; k < job->scenarios.n; k++) {
        const scenario *at = &job->scenarios.at[k];
        moray_json_open(json, NULL);
        moray_json_text(json, "model", at->name);
        moray_json_numbers(json, "current_m_s", at->current, 2);
        moray_json_number(json, "gain_percent", 100 * at->gain);
        moray_json_close(json);
    }
    moray_json_close(json);
    moray_json_number(json, "over_gain_percent", 100 * moray_gait_over_gain(best->solution));
}

static void json_baseline(moray_json *json, const gait_job *job)
{
    char name[64];
    moray_json_open(json, "baseline");
    moray_json_text(json, "name", gait_job_baseline(job, name));
    moray_gait_to_json(json, "gait", &job->snake.robot, job->paper.gait);
    moray_steady_to_json(json, "predicted", &job->snake.robot, MORAY_CONTROL_ORIENTED, &job->paper, job->snake.course);
    moray_steady_to_json(json, "validated", &job->snake.robot, MORAY_FIRST_PRINCIPLES, &job->paper, job->snake.course);
    if (moray_failed(job->no_paper[MORAY_FIRST_PRINCIPLES]))
        moray_json_text(json, "left_out", job->no_paper[MORAY_FIRST_PRINCIPLES].text);
    moray_json_close(json);
}

void gait_job_summary(const void *found, moray_json *json)
{
    const gait_job *job = found;
    const stage *best = recommended(job);
    gait_job_json_head(json, job);
    json_recommended(json, job, best);
    gait_job_json_stage(json, job, best);
    json_baseline(json, job);
    if (job->snake.model == MORAY_FIRST_PRINCIPLES)
        json_other(json, "control_oriented_optimum", job, &job->stage[MORAY_CONTROL_ORIENTED]);
    if (best == &job->ladder)
        json_other(json, "first_principles_optimum", job, &job->stage[MORAY_FIRST_PRINCIPLES]);
    else if (job->ladder.left_out)
        json_other(json, "ladder_optimum", job, &job->ladder);
}
