// SPDX-License-Identifier: MIT
//
// What the gait (25) leaves on the table: the motion of the joints freed step by step from the best gait to Fourier
// series in every joint, at equal power and limits, on either model; each motion swum on the first-principles model.
#include "gait/free_gait/free_gait.h"

#include <stdlib.h>
#include <string.h>

static const moray_option options[] = {
    GAIT_LIMIT("power_W", power, "W",
               "mean power of the joints, or at the terminals of their motors; by default what the paper's gait uses "
               "in the same model and current"),
    MORAY_ROW(INT, free_gait, harmonics, "problem", "harmonics", .min = 1, .max = FREE_GAIT_HARMONICS,
              .help = "of the Fourier series in every joint; those of fewer are found on the way"),
    MORAY_ROW(
        REAL, free_gait, link_angle, "problem", "link_angle_deg", .min = 1, .max = 89, .unit = "deg",
        .help = "largest angle of every link from the heading; by default the larger of theta_max_deg and of what the "
                "best gait within it reaches"),
};

// ---- One motion ----------------------------------------------------------------------------------------------------

static int coefficients_of(const free_gait *run, int harmonics)
{
    return (run->job.snake.robot.links - 1) * (1 + 2 * harmonics);
}

static moray_status make_problem(const free_gait *run, motion *m)
{
    moray_gait_problem_spec spec = gait_job_spec(&run->job, &m->at, MORAY_GAIT_FASTEST, run->job.snake.current);
    if (m->harmonics > 0) {
        spec.joints = MORAY_JOINTS_SERIES;
        spec.harmonics = m->harmonics;
    }
    return moray_gait_problem_new(&m->at.problem, &spec);
}

// Parameters of the gait in the form of the motion, with a little of the highest harmonic where the gait has none: by
// symmetry even ones could not begin by themselves.
static void guess_parameters(const free_gait *run, const motion *m, const moray_gait *gait, double share, double *s)
{
    const int n = run->job.snake.robot.links - 1, last = 1 + coefficients_of(run, m->harmonics);
    if (m->harmonics == 0) {
        moray_gait_to_parameters(gait, s);
        return;
    }
    s[0] = gait->omega;
    moray_series_of_gait(gait, n, m->harmonics, s + 1);
    const double size = hypot(s[1 + n], s[1 + 2 * n]) * share;
    for (int i = last - 2 * n; i < last && m->harmonics > 1; i++)
        s[i] += size * sin(1 + 1.3 * i);
}

// Where a motion may start: from which, with how much of the highest harmonic, at what barrier.
typedef struct start {
    const stage *from;
    double share, barrier;
} start;

enum { STARTS = 5 };

typedef struct way_there {
    free_gait *run;
    motion *m;
    start at[STARTS];
} way_there;

// The less barrier, the nearer the solver stays to where it begins.
static moray_status solve_from(gait_job *job, stage *at, void *self, int k, moray_solution **solution)
{
    const way_there *way = self;
    const start *begin = &way->at[k];
    moray_settings settings = gait_job_settings(job);
    double *s = calloc(MORAY_GAIT_PARAMETERS + 1 + (size_t)coefficients_of(way->run, way->m->harmonics), sizeof *s);
    if (!s)
        return moray_error(MORAY_MEMORY, "no memory for a guess");
    settings.barrier = begin->barrier;
    guess_parameters(way->run, way->m, &begin->from->prediction.gait, begin->share, s);
    const moray_status status = moray_gait_problem_continue(at->problem, &settings, begin->from->solution, s, solution);
    free(s);
    return status;
}

// Solved, and as good as the motion before, which it may repeat.
static bool as_good(const motion *m, const motion *before)
{
    const double same = 1e-7;
    return m->at.solution && moray_solution_info(m->at.solution)->outcome == MORAY_NLP_SOLVED &&
           moray_solution_objective(m->at.solution) <= moray_solution_objective(before->at.solution) + same;
}

// A gait from the motion before and from the best gait (25). A series from both, and from the gait within the limits of
// the links, with more or less of the highest harmonic: harmonics lead to several optima, of which none leads to all.
static int starts_of(free_gait *run, const motion *m, start at[STARTS])
{
    const double little = 3e-3, more = 3e-2, usual = 1e-4, near = 1e-7;
    const stage *before = &freest(run)->at, *gait = last_stage(&run->job), *limited = &run->motion[0].at;
    const start all[STARTS] = {{before, 0, m->harmonics > 0 ? near : usual},
                               {gait, little, usual},
                               {gait, more, usual},
                               {before, more, usual},
                               {limited, more, usual}};
    memcpy(at, all, sizeof all);
    return m->harmonics > 0 ? STARTS : 2;
}

// The best of all starts; one that cannot be computed leaves the others.
static moray_status solve(free_gait *run, motion *m, bool *found)
{
    way_there way = {.run = run, .m = m};
    const int n = starts_of(run, m, way.at);
    MORAY_TRY(make_problem(run, m));
    m->at.starts = n;
    const moray_status status = gait_job_try_ways(&run->job, &m->at, n, solve_from, &way);
    if (moray_interrupted())
        return moray_error(MORAY_INTERRUPTED, "interrupted while optimising; nothing is written");
    if (status.code == MORAY_MEMORY)
        return status;
    *found = as_good(m, freest(run));
    return moray_ok();
}

// The motion as series of both models, or as a gait of both.
static moray_status keep_motion(const free_gait *run, motion *m)
{
    const int n = run->job.snake.robot.links - 1, count = coefficients_of(run, m->harmonics);
    const moray_robot *robot = &run->job.snake.robot;
    m->at.prediction = moray_gait_problem_prediction(m->at.problem, m->at.solution);
    if (m->harmonics == 0) {
        for (int model = 0; model < 2; model++)
            m->at.trial.gait[model] = moray_gait_map(robot, &m->at.prediction.gait, m->at.model, (moray_model)model);
        return moray_ok();
    }
    m->coefficients = calloc(2 * (size_t)count, sizeof *m->coefficients);
    if (!m->coefficients)
        return moray_error(MORAY_MEMORY, "no memory for a series of %d harmonics", m->harmonics);
    for (int model = 0; model < 2; model++) {
        m->series[model] = (moray_series){n, m->harmonics, m->coefficients + model * count};
        m->at.trial.gait[model] = (moray_gait){.omega = m->at.prediction.gait.omega, .series = &m->series[model]};
    }
    memcpy(m->coefficients + (int)m->at.model * count, moray_solution_parameters(m->at.solution) + 1,
           (size_t)count * sizeof *m->coefficients);
    if (m->at.model == MORAY_CONTROL_ORIENTED)
        moray_series_to_first_principles(robot, &m->series[0], m->coefficients + count);
    m->at.prediction.gait = m->at.trial.gait[m->at.model];
    return moray_ok();
}

// Certificate; swum on its own model and on the first-principles model; compared there.
static moray_status prove(free_gait *run, motion *m)
{
    gait_job *job = &run->job;
    moray_ticker_show(&job->ticker, "%s: %s, swum on the first-principles model", job->name, m->name);
    MORAY_TRY(gait_job_certify(job, &m->at));
    for (int model = (int)m->at.model; model <= (int)MORAY_FIRST_PRINCIPLES; model++)
        gait_job_swim(job, (moray_model)model, &m->at.trial);
    m->at.gain = moray_gait_gain_over(&job->rig, &m->at.trial, &job->paper);
    m->over_best = moray_gait_gain_over(&job->rig, &m->at.trial, &last_stage(job)->trial);
    m->over_alike = moray_gait_gain_over(&job->rig, &m->at.trial, &run->motion[0].at.trial);
    return moray_ok();
}

double free_gait_disagreement(const motion *m)
{
    const moray_steady *swum = &m->at.trial.steady[m->at.model];
    return fmax(fabs(swum->speed - m->at.prediction.speed), fabs(swum->power - m->at.prediction.power));
}

// ---- All of them ---------------------------------------------------------------------------------------------------

static motion *start_motion(free_gait *run, int harmonics, double taper)
{
    const stage *best = last_stage(&run->job);
    motion *m = &run->motion[run->n];
    *m = (motion){.harmonics = harmonics,
                  .at = {.model = best->model, .power = best->power, .speed = best->speed, .link_angle = run->limit}};
    memcpy(m->at.taper, taper > 0 ? (double[]){-taper, taper} : run->job.taper, sizeof m->at.taper);
    if (harmonics > 0)
        snprintf(m->name, sizeof m->name, "%d harmonic%s", harmonics, harmonics > 1 ? "s" : "");
    else
        strcpy(m->name, taper > 0 ? "gait (25), tapered" : "gait (25) by link angles");
    moray_ticker_show(&run->job.ticker, "%s: %s", run->job.name, m->name);
    return m;
}

static moray_status finish_motion(free_gait *run, motion *m)
{
    MORAY_TRY(keep_motion(run, m));
    MORAY_TRY(prove(run, m));
    run->n++;
    return moray_ok();
}

static void drop_motion(motion *m)
{
    gait_job_stage_free(&m->at);
    free(m->coefficients);
    m->coefficients = NULL;
}

// The best gait (25) within the limits of the links, with which freer motions are compared: these have several optima,
// of slow and of quick strokes, between which the nearest is chance.
static moray_status find_gait(free_gait *run)
{
    motion *m = start_motion(run, 0, 0);
    const gait_starts starts = {
        .gait = {last_stage(&run->job)->prediction.gait, run->job.paper.gait[m->at.model]}, .n = 2, .random = 12};
    MORAY_TRY(gait_job_optimise(&run->job, &m->at, &starts));
    return finish_motion(run, m);
}

// A motion freer than the last one; in run->vain where that gains nothing or cannot be swum, and the last one stands
// for it.
static moray_status free_further(free_gait *run, int harmonics, double taper)
{
    motion *m = start_motion(run, harmonics, taper);
    bool found = false;
    moray_status status = solve(run, m, &found);
    if (!moray_failed(status) && !found)
        status = moray_error(MORAY_NOT_SOLVED, "of %d starts none ends at a better one", m->at.starts);
    if (!moray_failed(status))
        status = finish_motion(run, m);
    if (!moray_failed(status))
        return status;
    run->vain[harmonics] = status;
    drop_motion(m);
    return status.code == MORAY_INTERRUPTED || status.code == MORAY_MEMORY ? status : moray_ok();
}

static moray_status climb(free_gait *run)
{
    stage *at[FREE_GAIT_MOTIONS];
    for (int k = 0; k < run->n; k++) {
        at[k] = &run->motion[k].at;
        at[k]->found_on = last_stage(&run->job)->found_on;
    }
    return gait_job_climb(&run->job, at, run->n);
}

static moray_status work(gait_job *job)
{
    free_gait *run = (free_gait *)job;
    if (job->joints != MORAY_JOINTS_ON_GAIT)
        return moray_error(MORAY_INPUT, "joints: free motions are found with the joints on them");
    MORAY_TRY(gait_job_work(job));
    const stage *best = last_stage(job);
    run->limit = isnan(run->link_angle) ? fmax(job->theta_max[1], best->trial.steady[best->model].peak_link_angle)
                                        : run->link_angle;
    MORAY_TRY(find_gait(run));
    if (job->snake.robot.links > 2)
        MORAY_TRY(free_further(run, 0, 1));
    for (int k = 1; k <= run->harmonics; k++)
        MORAY_TRY(free_further(run, k, 0));
    return climb(run);
}

// A motion that was not swum to the end disagrees with nothing.
static moray_status certified(const gait_job *job)
{
    const double most = 1e-5;
    const free_gait *run = (const free_gait *)job;
    for (int k = 0; k < run->n; k++) {
        const motion *m = &run->motion[k];
        MORAY_TRY(gait_job_certified(job, m->name, &m->at));
        if (free_gait_disagreement(m) >= most)
            return moray_error(MORAY_NOT_SOLVED, "%s: swum, its speed or power is %.1e from what was optimised",
                               m->name, free_gait_disagreement(m));
    }
    return moray_ok();
}

static void release(gait_job *job)
{
    free_gait *run = (free_gait *)job;
    for (int k = 0; k < FREE_GAIT_MOTIONS; k++)
        drop_motion(&run->motion[k]);
}

static const gait_program program = {
    .name = "free_gait",
    .summary = "Frees the joints of an underwater snake robot from the gait, step by step, to periodic motions of "
               "their own: what is left on the table at equal power and limits.",
    .goal = MORAY_GAIT_FASTEST,
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .power = NAN,
    .speed = INFINITY,
    .work = work,
    .report = free_gait_report,
    .certified = certified,
    .release = release};

// Limits of the links' angles are kept at the nodes: between them they pass the certificate on a fine mesh.
enum { FINE_INTERVALS = 60, REFINEMENTS = 2 };

int main(int argc, char **argv)
{
    static free_gait run; // large
    run = (free_gait){.job = gait_job_defaults(&program), .harmonics = 3, .link_angle = NAN};
    run.job.common.intervals = FINE_INTERVALS;
    run.job.refinements = REFINEMENTS;
    return gait_job_main(&program, &run.job, argc, argv);
}
