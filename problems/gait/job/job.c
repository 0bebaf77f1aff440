// SPDX-License-Identifier: MIT
#include "job.h"

#include <stdlib.h>
#include <string.h>

static const char *const joint_forms[] = {"on-gait", "closed-loop", NULL};

static const moray_option shared[] = {
    GAIT_RANGE("theta_max_deg", theta_max, 0, 89, "deg", "link-angle amplitude of (24)"),
    GAIT_RANGE("omega_deg_s", omega, 1, 3600, "deg/s", "gait frequency"),
    GAIT_RANGE("delta_deg", delta, 1, 179, "deg", "phase shift between joints"),
    GAIT_RANGE("phi0_m", offset, -1, 1, "m", "joint offset of the control-oriented model"),
    GAIT_RANGE("phi0_deg", offset_angle, -90, 90, "deg", "joint offset of the first-principles model"),
    GAIT_RANGE("taper", taper, -1, 1, NULL,
               "growth of the joint amplitude: 1 - taper times that of the middle in the first joint, at the tail, to "
               "1 + taper times in the last; an eel's is negative. No link may exceed theta_max_deg"),
    GAIT_LIMIT("joint_rate", joint_rate, NULL,
               "rate amplitude of the joints (m/s; deg/s with the first-principles model)"),
    GAIT_LIMIT("joint_effort", joint_effort, NULL,
               "peak joint force at the nodes of the mesh, which then has 80 intervals (N; torque in N m with the "
               "complex model)"),
    {.section = "problem",
     .key = "joints",
     .type = MORAY_OPTION_CHOICE,
     MORAY_AT(gait_job, joints),
     .choices = joint_forms,
     .help = "six states with the joints on the gait, or all states with the joint controller (34)"},
    {.section = "solver",
     .key = "random_starts",
     .type = MORAY_OPTION_INT,
     MORAY_AT(gait_job, random_starts),
     .min = 0,
     .max = 10000,
     .help = "random gaits to start from, besides the paper's gait and the control-oriented optimum"},
};

static const moray_option continuation = MORAY_CONTINUE(gait_job, from_file);

// A limit on the effort is kept at the nodes: between them it passes the certificate on the finer mesh.
enum { usual_intervals = 12, effort_intervals = 80 };

gait_job gait_job_defaults(const gait_program *program)
{
    gait_job job = {.common = moray_common_default(),
                    .snake = moray_snake_options_default(),
                    .name = program->name,
                    .goal = program->goal,
                    .theta_max = {1 * DEG, 20 * DEG},
                    .omega = {30 * DEG, 360 * DEG},
                    .delta = {15 * DEG, 90 * DEG},
                    .offset = {-0.02, 0.02},
                    .offset_angle = {-10 * DEG, 10 * DEG},
                    .power = program->power,
                    .speed = program->speed,
                    .joint_rate = INFINITY,
                    .joint_effort = INFINITY};
    job.snake.model = MORAY_FIRST_PRINCIPLES;
    strcpy(job.common.scheme, "lobatto5");
    job.common.intervals = usual_intervals;
    return job;
}

// The speed asked for, which the paper's gait may not make at all.
static moray_status speed_demand(const gait_job *job, stage *at)
{
    at->speed = isinf(job->speed) ? 0 : job->speed;
    if (!isnan(job->speed))
        return moray_ok();
    if (!job->paper.held[at->model])
        return moray_error(MORAY_NOT_SOLVED,
                           "speed_m_s: the paper's gait, whose speed is the default, fails: %.250s; give a speed",
                           job->paper.why[at->model].text);
    at->speed = moray_course_speed(&job->paper.steady[at->model], job->snake.course);
    return moray_ok();
}

moray_status gait_job_demand(const gait_job *job, moray_model model, stage *at)
{
    at->model = model;
    memcpy(at->taper, job->taper, sizeof at->taper);
    at->power = isnan(job->power) ? job->paper.steady[model].power : job->power;
    return speed_demand(job, at);
}

moray_status gait_job_prove(gait_job *job, stage *at)
{
    moray_ticker_show(&job->ticker, "%s: the optimised gait on both models", job->name);
    MORAY_TRY(moray_gait_trial_run(&job->rig, &at->prediction.gait, at->model, &at->trial));
    at->gain = moray_gait_gain_over(&job->rig, &at->trial, &job->paper);
    return moray_ok();
}

// Leaves the best solution so far for --continue.
static moray_status keep_iterate(gait_job *job, const stage *at)
{
    char path[MORAY_PATH_SIZE];
    MORAY_TRY(moray_iterate_keep(&job->common, job->name, at->solution, path));
    if (job->common.output)
        MORAY_TRY(moray_output_commit(job->common.output));
    return moray_interruption(at->solution, path);
}

static moray_status optimise_and_prove(gait_job *job, moray_model model, const gait_starts *known)
{
    stage *at = &job->stage[model];
    MORAY_TRY(gait_job_demand(job, model, at));
    moray_status status = gait_job_optimise(job, at, known);
    if (status.code == MORAY_INTERRUPTED && at->solution)
        return keep_iterate(job, at);
    MORAY_TRY(status);
    return gait_job_prove(job, at);
}

moray_status gait_job_prepare(gait_job *job)
{
    const moray_gait paper = moray_gait_paper(&job->snake.robot);
    moray_family family;
    int stages;
    if (isfinite(job->joint_effort) && job->common.intervals == usual_intervals)
        job->common.intervals = effort_intervals;
    MORAY_TRY(moray_scheme_parse(job->common.scheme, &family, &stages));
    MORAY_TRY(moray_test_rig_new(&job->rig, &job->snake.robot, job->snake.current, job->snake.course));
    moray_ticker_show(&job->ticker, "%s: the paper's gait on both models", job->name);
    return moray_gait_trial_run(&job->rig, &paper, MORAY_CONTROL_ORIENTED, &job->paper);
}

moray_status gait_job_work(gait_job *job)
{
    MORAY_TRY(gait_job_prepare(job));
    const gait_starts one = {{job->paper.gait[MORAY_CONTROL_ORIENTED]}, 1};
    MORAY_TRY(optimise_and_prove(job, MORAY_CONTROL_ORIENTED, &one));
    if (job->snake.model == MORAY_CONTROL_ORIENTED)
        return moray_ok();
    const gait_starts two = {{job->stage[MORAY_CONTROL_ORIENTED].trial.gait[MORAY_FIRST_PRINCIPLES],
                              job->paper.gait[MORAY_FIRST_PRINCIPLES]},
                             2};
    return optimise_and_prove(job, MORAY_FIRST_PRINCIPLES, &two);
}

bool gait_job_certified(const gait_job *job)
{
    bool pass = true;
    for (int model = 0; model <= (int)job->snake.model; model++)
        pass = pass && job->stage[model].certificate.pass;
    return pass;
}

void gait_job_stage_free(stage *at)
{
    moray_solution_free(at->solution);
    moray_solution_free(at->from);
    moray_gait_problem_free(at->problem);
    at->solution = at->from = NULL;
    at->problem = NULL;
}

void gait_job_free(gait_job *job)
{
    for (int model = 0; model < 2; model++)
        gait_job_stage_free(&job->stage[model]);
    moray_test_rig_free(&job->rig);
}

int gait_job_main(const gait_program *program, gait_job *job, int argc, char **argv)
{
    const moray_option_table common = {.rows = shared, .n = sizeof shared / sizeof *shared},
                             own = {.rows = program->options, .n = program->n_options},
                             going_on = {.rows = &continuation, .n = program->work ? 0 : 1};
    const moray_option_group groups[] = {
        {&common, 0}, {&own, 0}, {&going_on, 0}, {&moray_snake_option_table, offsetof(gait_job, snake)}};
    const moray_program app = {.name = program->name,
                               .summary = program->summary,
                               .groups = groups,
                               .n_groups = sizeof groups / sizeof *groups};
    int exit_code;
    if (!moray_app_start(&app, argc, argv, job, &exit_code))
        return exit_code;
    job->ticker = moray_ticker_start(stderr, job->common.quiet);
    moray_interrupt_begin();
    moray_status status = program->work ? program->work(job) : gait_job_work(job);
    moray_interrupt_end();
    moray_ticker_end(&job->ticker);
    if (!moray_failed(status))
        status = program->report ? program->report(job) : gait_job_report(job);
    exit_code = moray_app_end(&app, job, status);
    if (exit_code == MORAY_EXIT_SOLVED && !(program->certified ? program->certified(job) : gait_job_certified(job)))
        exit_code = MORAY_EXIT_CERTIFICATE;
    if (program->release)
        program->release(job);
    gait_job_free(job);
    return exit_code;
}
