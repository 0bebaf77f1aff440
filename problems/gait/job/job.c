// SPDX-License-Identifier: MIT
#include "job.h"

#include <stdlib.h>
#include <string.h>

static const char *const joint_forms[] = {"on-gait", "closed-loop", NULL};

static const moray_option shared[] = {
    GAIT_RANGE("theta_max_deg", theta_max, 0, 89, "deg", "link-angle amplitude of (24)"),
    GAIT_RANGE("omega_deg_s", omega, 1, 3600, "deg/s", "gait frequency"),
    GAIT_RANGE(
        "delta_deg", delta, 1, 179, "deg",
        "phase shift between joints; by default from 0.375 to 2.25 times the paper's 2 pi/(N-1), and 15 to 90 deg at "
        "least, 150 deg at most"),
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
    MORAY_ROW(CHOICE, gait_job, joints, "problem", "joints", .choices = joint_forms,
              .help = "six states with the joints on the gait, or all states with the joint controller (34)"),
    MORAY_ROW(
        INT, gait_job, random_starts, "solver", "random_starts", .min = 0, .max = 10000,
        .help =
            "random gaits to start from, besides the paper's gait, one past twice its delta and the control-oriented "
            "optimum"),
    MORAY_JOBS_OPTION(gait_job, jobs, "processes for what can be done at the same time"),
};

static const moray_option continuation[2] = {MORAY_CONTINUE(gait_job, from_file), MORAY_LEAVE(gait_job, solution_file)};

// A limit on the effort is kept at the nodes: between them it passes the certificate on the finer mesh.
enum { usual_intervals = 12, motor_intervals = 24, effort_intervals = 80 };

gait_job gait_job_defaults(const gait_program *program)
{
    gait_job job = {.common = moray_common_default(),
                    .snake = moray_snake_options_default(),
                    .name = program->name,
                    .goal = program->goal,
                    .theta_max = {1 * DEG, 20 * DEG},
                    .omega = {30 * DEG, 360 * DEG},
                    .delta = {NAN, NAN},
                    .offset = {-0.02, 0.02},
                    .offset_angle = {-10 * DEG, 10 * DEG},
                    .power = program->power,
                    .speed = program->speed,
                    .joint_rate = INFINITY,
                    .joint_effort = INFINITY,
                    .refinements = 3};
    job.snake.model = MORAY_FIRST_PRINCIPLES;
    strcpy(job.common.scheme, "lobatto5");
    job.common.intervals = usual_intervals;
    return job;
}

const char *gait_job_baseline(const gait_job *job, char text[64])
{
    const int links = job->snake.robot.links;
    if (links == moray_robot_paper().links)
        snprintf(text, 64, "the paper's gait");
    else
        snprintf(text, 64, "the paper's gait for %d links", links);
    return text;
}

// Whether gaits of the control-oriented model have to turn: into a current across the course, or by an offset.
static bool turns(const gait_job *job)
{
    const double *V = job->snake.current, c = cos(job->snake.course), s = sin(job->snake.course);
    const double nothing = 1e-12;
    return fabs(V[1] * c - V[0] * s) > nothing || job->offset[0] > 0 || job->offset[1] < 0;
}

moray_status gait_job_turning(const gait_job *job, moray_model model)
{
    if (model != MORAY_CONTROL_ORIENTED || !turns(job))
        return moray_ok();
    const moray_status status = moray_snake_turning(&job->snake);
    return moray_failed(status) && job->snake.model != model ? moray_error(MORAY_NOT_SOLVED, "%s", status.text)
                                                             : status;
}

// A number asked for, by default the paper's gait's, which may have none.
static moray_status demand(const gait_job *job, moray_model model, const char *key, double given, double paper,
                           double *value)
{
    char baseline[64];
    *value = isnan(given) ? paper : given;
    if (isnan(given) && !(paper > 0))
        return moray_error(MORAY_NOT_SOLVED, "%s: its default is that of %s, which is left out: %.150s; give %s", key,
                           gait_job_baseline(job, baseline), job->no_paper[model].text, key);
    return moray_ok();
}

// The user's limit of the power is that of the model asked for: the other one has another power at the same gait.
moray_status gait_job_demand(const gait_job *job, moray_model model, stage *at)
{
    const moray_steady *paper = &job->paper.steady[model];
    const double power = model == job->snake.model || isinf(job->power) ? job->power : NAN;
    MORAY_TRY(gait_job_turning(job, model));
    at->model = model;
    at->found_on = gait_job_found_on(job, model);
    memcpy(at->taper, job->taper, sizeof at->taper);
    MORAY_TRY(demand(job, model, "power_W", power, paper->power, &at->power));
    if (isinf(job->speed)) {
        at->speed = 0;
        return moray_ok();
    }
    const double speed = job->paper.held[model] ? moray_course_speed(paper, job->snake.course) : NAN;
    return demand(job, model, "speed_m_s", job->speed, speed, &at->speed);
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
    const moray_status demanded = gait_job_demand(job, model, at);
    if (demanded.code == MORAY_NOT_SOLVED)
        MORAY_TRY(gait_job_stem(job, at)); // where no gait could, no number to be given helps
    MORAY_TRY(demanded);
    moray_status status = gait_job_optimise(job, at, known);
    if (status.code == MORAY_INTERRUPTED && at->solution)
        return keep_iterate(job, at);
    MORAY_TRY(status);
    return gait_job_prove(job, &at, 1);
}

static void delta_range(double delta[2], const moray_robot *robot)
{
    const moray_bounds usual = moray_gait_usual_delta(robot);
    delta[0] = isnan(delta[0]) ? usual.lower : delta[0];
    delta[1] = isnan(delta[1]) ? usual.upper : delta[1];
}

// Why the paper's gait is no baseline on a model, where it is not.
static moray_status baseline_check(const gait_job *job, moray_model model)
{
    if (!job->paper.held[model])
        return job->paper.why[model];
    return moray_makes_way(&job->snake.robot, &job->paper.gait[model], &job->paper.steady[model]);
}

moray_status gait_job_prepare(gait_job *job)
{
    const moray_gait paper = moray_gait_paper(&job->snake.robot);
    moray_family family;
    int stages;
    MORAY_TRY(moray_robot_check_swims(&job->snake.robot));
    if (isfinite(job->joint_effort) && job->common.intervals == usual_intervals)
        job->common.intervals = effort_intervals;
    if (job->snake.robot.motor.fitted && job->snake.model == MORAY_FIRST_PRINCIPLES &&
        job->common.intervals == usual_intervals)
        job->common.intervals = motor_intervals; // for what changes with the sign of a rate or a power
    delta_range(job->delta, &job->snake.robot);
    MORAY_TRY(moray_scheme_parse(job->common.scheme, &family, &stages));
    MORAY_TRY(moray_test_rig_new(&job->rig, &job->snake.robot, job->snake.current, job->snake.course));
    moray_ticker_show(&job->ticker, "%s: the paper's gait on both models", job->name);
    MORAY_TRY(gait_job_try(job, &paper, MORAY_CONTROL_ORIENTED, &job->paper));
    for (int model = 0; model < 2; model++)
        job->no_paper[model] = baseline_check(job, (moray_model)model);
    return moray_ok();
}

// Whether an error is one of the computation, which leaves a stage out, or ends the program.
static bool leaves_out(moray_status status)
{
    return status.code == MORAY_NOT_SOLVED || status.code == MORAY_NUMERIC;
}

// The model that was not asked for, whose optimum is one more start and one more column.
static moray_status work_on_other(gait_job *job)
{
    stage *at = &job->stage[MORAY_CONTROL_ORIENTED];
    const gait_starts one = {.gait = {job->paper.gait[MORAY_CONTROL_ORIENTED]}, .n = 1};
    const moray_status status = optimise_and_prove(job, MORAY_CONTROL_ORIENTED, &one);
    if (job->snake.model == MORAY_CONTROL_ORIENTED || !leaves_out(status))
        return status;
    at->left_out = true;
    at->why = status;
    return moray_ok();
}

static moray_status work_on_ladder(gait_job *job)
{
    const gait_starts known = {.gait = {job->stage[MORAY_FIRST_PRINCIPLES].trial.gait[MORAY_FIRST_PRINCIPLES],
                                        job->paper.gait[MORAY_FIRST_PRINCIPLES]},
                               .n = 2};
    const moray_status status = gait_job_over(job, &known);
    if (status.code == MORAY_INTERRUPTED)
        return keep_iterate(job, last_stage(job));
    if (!leaves_out(status))
        return status;
    job->ladder.left_out = true;
    job->ladder.why = status;
    return moray_ok();
}

// The first-principles model has two optima along delta: one near the paper's gait, the other past twice its delta,
// where the same power allows twice its omega.
static moray_gait further_gait(const gait_job *job)
{
    const double further = 2.2;
    moray_gait gait = job->paper.gait[MORAY_FIRST_PRINCIPLES];
    gait.delta = fmin(fmax(further * gait.delta, job->delta[0]), job->delta[1]);
    gait.omega = fmin(fmax(further * gait.omega, job->omega[0]), job->omega[1]);
    gait.amplitude = moray_amplitude_from_theta_max(&job->snake.robot, MORAY_FIRST_PRINCIPLES,
                                                    fmin(20 * DEG, job->theta_max[1]), gait.delta);
    return gait;
}

moray_status gait_job_work(gait_job *job)
{
    scenarios over;
    MORAY_TRY(gait_job_scenarios(job, &over));
    MORAY_TRY(gait_job_prepare(job));
    MORAY_TRY(work_on_other(job));
    stage *control = &job->stage[MORAY_CONTROL_ORIENTED], *revolute = &job->stage[MORAY_FIRST_PRINCIPLES];
    if (job->snake.model == MORAY_FIRST_PRINCIPLES) {
        gait_starts known = {.gait = {job->paper.gait[MORAY_FIRST_PRINCIPLES], further_gait(job)}, .n = 2};
        if (!control->left_out)
            known.gait[known.n++] = control->trial.gait[MORAY_FIRST_PRINCIPLES];
        MORAY_TRY(optimise_and_prove(job, MORAY_FIRST_PRINCIPLES, &known));
        if (over.n > 0)
            MORAY_TRY(work_on_ladder(job));
    }
    return gait_job_climb(job, (stage *const[]){control, revolute, &job->ladder}, GAIT_STAGES);
}

moray_status gait_job_certified(const gait_job *job, const char *what, const stage *at)
{
    if (at->certificate.pass)
        return moray_ok();
    return moray_error(MORAY_NOT_SOLVED, "certificate of the %s failed: %.200s", what ? what : gait_job_kind(job, at),
                       at->certificate.why);
}

static moray_status certified(const gait_job *job)
{
    return gait_job_certified(job, NULL, recommended(job));
}

int gait_job_stages(const gait_job *job, const stage *at[GAIT_STAGES])
{
    const stage *const all[GAIT_STAGES] = {&job->stage[0], &job->stage[1], &job->ladder};
    int n = 0;
    for (int k = 0; k < GAIT_STAGES; k++)
        if (all[k]->solution && !all[k]->left_out)
            at[n++] = all[k];
    return n;
}

void gait_job_stage_free(stage *at)
{
    moray_solution_free(at->solution);
    moray_solution_free(at->from);
    free(at->iterations);
    moray_gait_problem_free(at->problem);
    moray_gait_over_free(at->over);
    at->solution = at->from = NULL;
    at->problem = NULL;
    at->over = NULL;
    at->iterations = NULL;
}

void gait_job_free(gait_job *job)
{
    for (int model = 0; model < 2; model++)
        gait_job_stage_free(&job->stage[model]);
    gait_job_stage_free(&job->ladder);
    moray_test_rig_free(&job->rig);
}

int gait_job_main(const gait_program *program, gait_job *job, int argc, char **argv)
{
    const moray_option_table common = {.rows = shared, .n = sizeof shared / sizeof *shared},
                             own = {.rows = program->options, .n = program->n_options},
                             going_on = {.rows = continuation, .n = program->work && !program->continues ? 0 : 2};
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
    if (exit_code == MORAY_EXIT_SOLVED)
        exit_code = moray_app_certified(&app, program->certified ? program->certified(job) : certified(job));
    if (program->release)
        program->release(job);
    gait_job_free(job);
    return exit_code;
}
