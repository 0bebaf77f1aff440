// SPDX-License-Identifier: MIT
//
// Tuning on some draws, trials on others: several processes, and a file of what is done, from which a run that was
// ended goes on.
#include "sea.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- Tuning --------------------------------------------------------------------------------------------------------

typedef struct tuning {
    const sea_job *job;
    int law;
    unsigned tuned;
} tuning;

// Geometric mean over the training draws, so that the hardest of them does not decide alone: what is scored are
// medians.
static bool training_cost(void *self, const double *x, double *cost)
{
    const tuning *t = self;
    const sea_job *job = t->job;
    double number[SEA_NUMBERS] = {0};
    *cost = 0;
    for (int k = 0; k < SEA_NUMBERS; k++)
        if (t->tuned & 1u << k)
            number[k] = *x++;
    for (int k = 0; k < job->training; k++) {
        sea_score score;
        if (moray_failed(sea_swim(job, &job->draw[job->seeds + k], t->law, number, &score)))
            return false;
        *cost += log(score.cost) / job->training;
    }
    *cost = exp(*cost);
    return true;
}

static bool go_on(void *observer)
{
    const sea_job *job = observer;
    return !moray_interrupted() && !steer_clock_up(&job->clock);
}

static void gather(const double *number, unsigned tuned, double **to)
{
    for (int k = 0; k < SEA_NUMBERS; k++)
        if (tuned & 1u << k)
            *(*to)++ = number[k];
}

static moray_status tune(sea_job *job, const sea_law *laws, int which)
{
    const sea_law *law = &laws[which];
    moray_tuned_number number[SEA_NUMBERS];
    double from[4 * SEA_NUMBERS], x[SEA_NUMBERS], *to = from;
    tuning t = {job, which, law->tuned};
    moray_tuning_problem problem = {.number = number, .cost = training_cost, .self = &t};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    int rows = 1;
    for (int k = 0; k < SEA_NUMBERS; k++)
        if (law->tuned & 1u << k)
            number[problem.n++] = sea_numbers[job->task][k];
    gather(law->start, law->tuned, &to);
    for (int i = 0; i < 3; i++)
        if (law->subset[i] >= 0) {
            gather(job->number[law->subset[i]], law->tuned, &to);
            rows++;
        }
    settings.starts = job->starts;
    settings.evaluations = job->evaluations;
    settings.jobs = job->jobs;
    settings.tolerance = 1e-3;
    settings.go_on = go_on;
    settings.observer = job;
    const moray_status status = moray_tune(&problem, &settings, from, rows, x, &info);
    if (status.code == MORAY_INTERRUPTED && !moray_interrupted() && isfinite(info.cost))
        moray_ticker_note(&job->ticker, "sea_trials: %s: tuning was ended by the time given", law->name);
    else if (status.code == MORAY_INTERRUPTED && !moray_interrupted())
        return moray_error(MORAY_NOT_SOLVED, "%s: not tuned in the time given (--time)", law->name);
    else
        MORAY_TRY(status);
    const double *found = x;
    for (int k = 0; k < SEA_NUMBERS; k++)
        job->number[which][k] = law->tuned & 1u << k ? *found++ : 0;
    job->tuned_cost[which] = info.cost;
    job->tuned_by[which] = info.evaluations;
    return moray_ok();
}

static moray_status plan_gains(sea_job *job, const sea_law *laws, int which)
{
    tuning t = {job, which, laws[which].tuned};
    double x[SEA_NUMBERS], *to = x;
    memcpy(job->number[which], laws[which].start, sizeof laws[which].start);
    MORAY_TRY(sea_robust(job, job->number[which]));
    gather(job->number[which], laws[which].tuned, &to);
    job->tuned_by[which] = 1;
    if (!training_cost(&t, x, &job->tuned_cost[which]))
        return moray_error(MORAY_NUMERIC, "the gains by collocation cannot be swum");
    return moray_ok();
}

moray_status sea_tune(sea_job *job)
{
    const sea_law *laws;
    const int n = sea_laws(job, &laws);
    int left = 0;
    for (int law = 0; law < n; law++)
        left += laws[law].tuned != 0;
    bool found, cut_short = false;
    MORAY_TRY(sea_tuned_read(job, &found));
    if (found)
        return moray_ok();
    for (int law = 0; law < n; law++) {
        if (!laws[law].tuned)
            continue;
        steer_clock_give(&job->clock, 0.5 / left--);
        moray_ticker_show(&job->ticker, "sea_trials: tuning %s", laws[law].name);
        MORAY_TRY(laws[law].collocated ? plan_gains(job, laws, law) : tune(job, laws, law));
        moray_ticker_note(&job->ticker, "sea_trials: %s tuned on %d draws by %d settings: cost %.5g", laws[law].name,
                          job->training, job->tuned_by[law], job->tuned_cost[law]);
        cut_short = cut_short || steer_clock_up(&job->clock);
    }
    return cut_short ? moray_ok() : sea_tuned_write(job); // others may have more time
}

// ---- The file of trials --------------------------------------------------------------------------------------------

// One line that is the same only for runs whose trials mean the same.
void sea_signature(const sea_job *job, char *text, size_t size)
{
    const moray_sensors *s = &job->sensors;
    const moray_robot *robot = &job->snake.robot;
    const double values[] = {job->duration,
                             job->offset,
                             job->offset_rate,
                             job->factor[0],
                             job->factor[1],
                             job->factor[2],
                             job->factor[3],
                             s->heading,
                             s->joints,
                             s->position,
                             s->sampling,
                             s->delay,
                             s->drop_out,
                             job->actuators.dead_time,
                             job->actuators.rate,
                             job->actuators.torque,
                             job->gyro,
                             job->current_most,
                             job->current_turning,
                             job->spread,
                             job->replan_periods,
                             job->look_ahead_periods,
                             job->weight_steering,
                             robot->c_n,
                             robot->c_t,
                             robot->mu_n,
                             robot->lambda_2,
                             robot->l,
                             robot->m,
                             robot->J};
    *text = 0;
    moray_text_add(text, size, "# sea_trials %d %d %d %s %s %d %d %d %d %s", job->task, (int)job->snake.model,
                   robot->links, job->rung, job->believed_current, job->hydrodynamics, job->snake.hydrodynamics,
                   job->training, job->starts * 10000 + job->evaluations, job->task == SEA_PATH ? job->path_text : "");
    for (size_t k = 0; k < sizeof values / sizeof *values; k++)
        moray_text_add(text, size, " %.10g", values[k]);
}

enum { LINE = 6000 };

static moray_status read_lines(sea_job *job, FILE *file, const char *expected)
{
    static char line[LINE];
    if (!fgets(line, sizeof line, file))
        return moray_ok();
    line[strcspn(line, "\n")] = 0;
    if (strcmp(line, expected) != 0)
        return moray_error(MORAY_INPUT, "results = %.200s: of trials with other settings", job->results);
    while (fgets(line, sizeof line, file)) {
        int seed, law, failures;
        double v[SEA_SCORES], cost;
        if (sscanf(line, "%d %d %lf %lf %lf %lf %d", &seed, &law, &v[0], &v[1], &v[2], &cost, &failures) != 7)
            continue; // a line that was cut off
        if (seed < job->first_seed || seed >= job->first_seed + job->seeds || law < 0 || law >= SEA_LAWS)
            continue;
        job->score[(seed - job->first_seed) * SEA_LAWS + law] = (sea_score){{v[0], v[1], v[2]}, cost, true, failures};
    }
    return moray_ok();
}

// Opens it to be added to, once what is in it is read.
static moray_status open_results(sea_job *job, FILE **file)
{
    char expected[LINE];
    moray_status status = moray_ok();
    *file = NULL;
    if (!*job->results)
        return status;
    sea_signature(job, expected, sizeof expected);
    FILE *before = fopen(job->results, "r");
    if (before) {
        status = read_lines(job, before, expected);
        fclose(before);
    }
    MORAY_TRY(status);
    *file = fopen(job->results, "a");
    if (!*file)
        return moray_error(MORAY_IO, "results = %.200s: cannot be written: %s", job->results, strerror(errno));
    if (!before)
        fprintf(*file, "%s\n", expected);
    return moray_ok();
}

static void add_line(FILE *file, int seed, int law, const sea_score *score)
{
    const double *v = score->value;
    fprintf(file, "%d %d %.17g %.17g %.17g %.17g %d\n", seed, law, v[0], v[1], v[2], score->cost, score->failures);
    fflush(file);
}

// ---- Trials --------------------------------------------------------------------------------------------------------

typedef struct trials {
    sea_job *job;
    int (*todo)[2]; // draw, law
} trials;

typedef struct outcome {
    sea_score score;
    moray_status status;
} outcome;

static void try(int k, void *result, void *self)
{
    const trials *t = self;
    outcome *out = result;
    const int draw = t->todo[k][0], law = t->todo[k][1];
    out->score = (sea_score){0};
    if (moray_interrupted())
        out->status = moray_error(MORAY_INTERRUPTED, "interrupted");
    else if (steer_clock_up(&t->job->clock))
        out->status = moray_ok(); // not known
    else
        out->status = sea_swim(t->job, &t->job->draw[draw], law, t->job->number[law], &out->score);
}

// A few at a time, so that what is done is soon in the file.
static moray_status run_some(trials *t, int n, FILE *file)
{
    enum { at_a_time = 16 };
    outcome some[at_a_time];
    sea_job *job = t->job;
    int(*all)[2] = t->todo;
    for (int done = 0; done < n; done += at_a_time) {
        const int count = n - done < at_a_time ? n - done : at_a_time;
        t->todo = all + done;
        moray_ticker_count(&job->ticker, done, n, "sea_trials: trials");
        MORAY_TRY(moray_parallel(count, sizeof *some, some, try, t, job->jobs));
        for (int k = 0; k < count; k++) {
            const int draw = t->todo[k][0], law = t->todo[k][1];
            MORAY_TRY(some[k].status);
            job->score[draw * SEA_LAWS + law] = some[k].score;
            if (file && some[k].score.known)
                add_line(file, job->first_seed + draw, law, &some[k].score);
        }
    }
    return moray_ok();
}

// Draws from the first on that were swum under every law.
static int complete(const sea_job *job, int n_laws)
{
    for (int draw = 0; draw < job->seeds; draw++)
        for (int law = 0; law < n_laws; law++)
            if (!job->score[draw * SEA_LAWS + law].known)
                return draw;
    return job->seeds;
}

moray_status sea_run(sea_job *job)
{
    const sea_law *laws;
    const int n_laws = sea_laws(job, &laws);
    int n = 0;
    FILE *file;
    MORAY_TRY(open_results(job, &file));
    steer_clock_give(&job->clock, 1);
    trials t = {job, calloc((size_t)(job->seeds * n_laws), sizeof *t.todo)};
    int(*all)[2] = t.todo;
    moray_status status = all ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d trials", job->seeds * n_laws);
    for (int draw = 0; draw < job->seeds && all; draw++)
        for (int law = 0; law < n_laws; law++)
            if (!job->score[draw * SEA_LAWS + law].known) {
                all[n][0] = draw;
                all[n++][1] = law;
            }
    if (!moray_failed(status))
        status = run_some(&t, n, file);
    free(all);
    if (file)
        fclose(file);
    MORAY_TRY(status);
    job->wanted = job->seeds;
    job->seeds = complete(job, n_laws);
    if (job->seeds == 0)
        return moray_error(MORAY_NOT_SOLVED, "no draw was swum under all laws in the time given (--time = %g s)",
                           job->clock.limit);
    return moray_ok();
}
