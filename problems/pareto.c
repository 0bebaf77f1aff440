// SPDX-License-Identifier: MIT
//
// Fronts of speed against power, by continuation: the fastest gaits within ever less mean power, of lateral
// undulation and of eel-like motion, on both models; every gait swum on the first-principles model.
#include "gait/pareto/pareto.h"

#include <stdlib.h>
#include <string.h>

#include "moray/parallel.h"

const char *const pareto_kinds[PARETO_KINDS] = {"lateral", "eel-like", "free taper"};

static const moray_option options[] = {
    MORAY_ROW(INT, pareto, points, "problem", "points", .min = 2, .max = PARETO_POINTS,
              .help = "gaits of a front, at powers in equal ratios"),
    MORAY_ROW(REAL, pareto, least_share, "problem", "least_share", .min = 1e-4, .max = 0.9,
              .help = "least power, as a share of what the fastest lateral gait of the same model uses"),
    MORAY_ROW(REAL, pareto, eel_taper, "problem", "eel_taper", .min = -1, .max = 1,
              .help = "taper of the eel-like motion; with -(N-2)/N joint i swings in the proportion (N-i)/N"),
};

// ---- One front -----------------------------------------------------------------------------------------------------

static void limit_power(stage *at, const pareto_front *front, int k, double most, double share)
{
    at->model = front->model;
    at->power = k == 0 ? INFINITY : most * pow(share, (double)k / (front->n - 1));
}

static bool solved(const stage *at)
{
    return at->solution && moray_solution_info(at->solution)->outcome == MORAY_NLP_SOLVED;
}

static void show(pareto *run, const pareto_front *front, int k, const char *what)
{
    moray_ticker_count(&run->job.ticker, (int)(front->model * run->kinds + front->kind) * run->points + k,
                       run->fronts * run->points, "pareto: %s model, %s: %s", moray_model_name(front->model),
                       pareto_kinds[front->kind], what);
}

// The fastest gait of all, from the paper's gait or from that of another front; and from it, to and fro, the others.
static moray_status follow(pareto *run, pareto_front *front, const pareto_front *like)
{
    gait_job *job = &run->job;
    const gait_starts paper = {.gait = {job->paper.gait[front->model]}, .n = 1};
    stage *at = front->at;
    if (like)
        MORAY_TRY(gait_job_continue(job, at, like->at));
    else
        MORAY_TRY(gait_job_optimise(job, at, &paper));
    const double most = like ? like->at->prediction.power : at->prediction.power;
    for (int k = 1; k < front->n; k++)
        limit_power(&at[k], front, k, most, run->least_share);
    for (int way = 1; way >= -1; way -= 2)
        for (int k = way > 0 ? 1 : front->n - 2; k >= 0 && k < front->n && !moray_interrupted(); k += way) {
            show(run, front, k, way > 0 ? "there" : "and back");
            if (solved(&at[k - way]))
                MORAY_TRY(gait_job_continue(job, &at[k], &at[k - way]));
        }
    return moray_interrupted() ? moray_error(MORAY_INTERRUPTED, "interrupted while optimising; nothing is written")
                               : moray_ok();
}

// Keeps the gaits that are worth it, certified.
static moray_status certify(const pareto *run, pareto_front *front)
{
    const double no_price = 1e-5; // of a power limit that makes no difference [m/s per W]
    const int all = front->n;
    front->n = 0;
    for (int k = 0; k < all; k++) {
        stage *at = &front->at[k];
        if (!solved(at) || (k > 0 && at->prediction.power_price < no_price)) {
            gait_job_stage_free(at);
            continue;
        }
        const stage moved = *at;
        *at = (stage){0};
        front->at[front->n] = moved;
        MORAY_TRY(gait_job_certify(&run->job, &front->at[front->n++]));
    }
    return moray_ok();
}

// One round of fronts: the lateral ones, or those that begin from them.
typedef struct rounds {
    pareto *run;
    bool lateral;
} rounds;

// A moray_task_fn; result: the front, as it was, or if it is of the round as it is found.
static void find_front(int f, void *result, void *self)
{
    const rounds *round = self;
    pareto *run = round->run;
    pareto_front *front = result;
    const pareto_front *lateral = &run->front[f - front->kind];
    if (round->lateral != (front->kind == 0))
        return;
    front->why = follow(run, front, round->lateral || lateral->n == 0 ? NULL : lateral);
    if (!moray_failed(front->why))
        front->why = certify(run, front);
    for (int k = 0; k < run->points; k++)
        gait_job_stage_free(&front->at[k]);
    if (moray_failed(front->why))
        front->n = 0;
}

// Whether to go on after what happened to a front: the lateral one of the model asked for is what the program is for;
// another that cannot be had takes nothing from it. Error: its own.
static moray_status may_leave_out(const pareto *run, const pareto_front *front)
{
    const bool needed = front->kind == 0 && front->model == run->job.snake.model;
    const moray_code code = front->why.code;
    return needed || code == MORAY_INTERRUPTED || code == MORAY_MEMORY ? front->why : moray_ok();
}

static moray_status find_fronts(pareto *run)
{
    for (int k = 0; k < 2; k++) {
        rounds round = {run, k == 0};
        MORAY_TRY(moray_parallel(run->fronts, sizeof *run->front, run->front, find_front, &round, run->job.jobs));
        for (int f = 0; f < run->fronts; f++)
            MORAY_TRY(may_leave_out(run, &run->front[f]));
    }
    return moray_ok();
}

// Swims the gaits of a front on both models and on the ladder.
static moray_status swim(pareto *run, pareto_front *front)
{
    stage *at[PARETO_POINTS];
    for (int k = 0; k < front->n; k++) {
        at[k] = &front->at[k];
        at[k]->found_on = gait_job_found_on(&run->job, front->model);
    }
    show(run, front, front->n - 1, "swum on both models");
    MORAY_TRY(gait_job_try_all(&run->job, at, front->n));
    return gait_job_climb(&run->job, at, front->n);
}

static moray_status swim_fronts(pareto *run)
{
    for (int f = 0; f < run->fronts; f++) {
        pareto_front *front = &run->front[f];
        if (front->n == 0)
            continue;
        front->why = swim(run, front);
        if (moray_failed(front->why))
            front->n = 0;
        MORAY_TRY(may_leave_out(run, front));
    }
    return moray_ok();
}

// ---- All -----------------------------------------------------------------------------------------------------------

static void begin_front(const pareto *run, pareto_front *front, moray_model model, int kind)
{
    const double eel[2] = {run->eel_taper, run->eel_taper}, none[2] = {0, 0};
    const double *const taper[PARETO_KINDS] = {none, eel, run->job.taper};
    *front = (pareto_front){.model = model, .kind = kind, .n = run->points};
    for (int k = 0; k < front->n; k++) {
        memcpy(front->at[k].taper, taper[kind], sizeof eel);
        limit_power(&front->at[k], front, 0, 0, 0);
    }
}

static moray_status work(gait_job *job)
{
    pareto *run = (pareto *)job;
    run->kinds = job->taper[0] < job->taper[1] ? PARETO_KINDS : PARETO_KINDS - 1;
    run->fronts = ((int)job->snake.model + 1) * run->kinds;
    if (isnan(run->eel_taper))
        run->eel_taper = (2.0 - job->snake.robot.links) / job->snake.robot.links;
    run->front = calloc((size_t)run->fronts, sizeof *run->front);
    if (!run->front)
        return moray_error(MORAY_MEMORY, "no memory for %d fronts", run->fronts);
    MORAY_TRY(gait_job_prepare(job));
    for (int f = 0; f < run->fronts; f++)
        begin_front(run, &run->front[f], (moray_model)(f / run->kinds), f % run->kinds);
    MORAY_TRY(find_fronts(run));
    return swim_fronts(run);
}

static moray_status certified(const gait_job *job)
{
    const pareto *run = (const pareto *)job;
    for (int f = 0; f < run->fronts; f++)
        for (int k = 0; k < run->front[f].n; k++) {
            const pareto_front *front = &run->front[f];
            char what[100];
            snprintf(what, sizeof what, "%s gait at %.4g W on the %s model", pareto_kinds[front->kind],
                     front->at[k].prediction.power, moray_model_name(front->model));
            MORAY_TRY(gait_job_certified(job, what, &front->at[k]));
        }
    return moray_ok();
}

static void release(gait_job *job)
{
    free(((pareto *)job)->front);
}

double pareto_speed_at(const pareto_front *front, double power)
{
    const stage *above = NULL;
    if (front->n > 0 && power >= front->at[0].prediction.power)
        return front->at[0].prediction.course_speed;
    for (int k = 0; k < front->n; k++) {
        const stage *at = &front->at[k];
        if (above && at->prediction.power <= power && power <= above->prediction.power) {
            const double share =
                log(power / at->prediction.power) / log(above->prediction.power / at->prediction.power);
            return at->prediction.course_speed *
                   pow(above->prediction.course_speed / at->prediction.course_speed, share);
        }
        above = at;
    }
    return NAN;
}

bool pareto_is_lateral(const pareto_front *front)
{
    bool none = true;
    for (int k = 0; k < front->n; k++)
        none = none && fabs(front->at[k].prediction.gait.taper) < 1e-4;
    return none;
}

static const gait_program program = {
    .name = "pareto",
    .summary =
        "Follows the front of speed against power of an underwater snake robot, laterally and as an eel, and swims "
        "its gaits on the first-principles model.",
    .goal = MORAY_GAIT_FASTEST,
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .speed = INFINITY,
    .work = work,
    .report = pareto_report,
    .certified = certified,
    .release = release};

int main(int argc, char **argv)
{
    pareto run = {.job = gait_job_defaults(&program), .points = 16, .eel_taper = NAN, .least_share = 0.02};
    run.job.refinements = 4;
    run.job.taper[0] = -1;
    run.job.taper[1] = 1;
    return gait_job_main(&program, &run.job, argc, argv);
}
