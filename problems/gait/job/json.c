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
    moray_json_open(json, "predicted");
    moray_json_number(json, "speed_m_s", prediction->speed);
    moray_json_number(json, "course_speed_m_s", prediction->course_speed);
    moray_json_number(json, "power_W", prediction->power);
    moray_json_number(json, "cost_of_transport_J_m", prediction->power / prediction->speed);
    moray_json_number(json, "course_cost_J_m", prediction->power / prediction->course_speed);
    moray_json_close(json);
}

static void json_gain(moray_json *json, const moray_gait_gain *gain)
{
    moray_json_open(json, "gain");
    moray_json_number(json, "speed_percent_at_equal_power", gain->speed_percent_at_equal_power);
    moray_json_number(json, "power_percent_at_equal_speed", gain->power_percent_at_equal_speed);
    moray_json_close(json);
}

static void json_solver(moray_json *json, const stage *at)
{
    moray_solver_to_json(json, at->solution);
    moray_json_number(json, "starts", at->starts);
    moray_json_number(json, "starts_at_optimum", at->agreeing);
    moray_json_close(json);
    moray_certificate_to_json(json, &at->certificate);
}

void gait_job_json_stage(moray_json *json, const gait_job *job, const stage *at)
{
    moray_json_number(json, "power_limit_W", at->power);
    moray_json_number(json, "least_course_speed_m_s", at->speed);
    moray_gait_to_json(json, "gait", &job->snake.robot, at->trial.gait);
    gait_job_json_prediction(json, &at->prediction);
    moray_steady_to_json(json, "simulated_control", MORAY_CONTROL_ORIENTED, &at->trial, job->snake.course);
    moray_steady_to_json(json, "validated", MORAY_FIRST_PRINCIPLES, &at->trial, job->snake.course);
    json_gain(json, &at->gain);
    json_solver(json, at);
}

void gait_job_summary(const void *found, moray_json *json)
{
    const gait_job *job = found;
    gait_job_json_head(json, job);
    gait_job_json_stage(json, job, last_stage(job));
    moray_json_open(json, "baseline");
    moray_gait_to_json(json, "gait", &job->snake.robot, job->paper.gait);
    moray_steady_to_json(json, "predicted", MORAY_CONTROL_ORIENTED, &job->paper, job->snake.course);
    moray_steady_to_json(json, "validated", MORAY_FIRST_PRINCIPLES, &job->paper, job->snake.course);
    moray_json_close(json);
    if (job->snake.model == MORAY_FIRST_PRINCIPLES) {
        moray_json_open(json, "control_oriented_optimum");
        gait_job_json_stage(json, job, &job->stage[MORAY_CONTROL_ORIENTED]);
        moray_json_close(json);
    }
}
