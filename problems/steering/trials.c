// SPDX-License-Identifier: MIT
//
// A trial swims on both models, its numbers tuned on the first-principles one.
#include "steer.h"

// How a simulation is run: tolerance, samples a second.
typedef struct accuracy {
    double tolerance, per_second;
} accuracy;
static const accuracy careful = {1e-8, 20};

// ---- Swimming ------------------------------------------------------------------------------------------------------

static moray_status set_controller(steer_steersman *h)
{
    const steer_trial *trial = h->trial;
    const moray_steering_plan *plan = &h->job->plan[trial->plan];
    h->plan = (moray_plan){plan->solution, steer_offset_ratio(h->job, trial->gait, trial->plan, h->model)};
    h->planned = &plan->straight;
    if (trial->law->set)
        return trial->law->set(h);
    h->controller = moray_plan_controller(&h->plan);
    return moray_ok();
}

// The steersman's receding horizon must be freed, after an error too.
static moray_status swim(steer_steersman *h, accuracy how, moray_swim_closed_loop *closed_loop)
{
    const steer_job *job = h->job;
    MORAY_TRY(set_controller(h));
    moray_swim_closed_loop_spec spec = {.robot = &job->snake.robot,
                                        .straight = &job->straight[h->trial->gait][h->model],
                                        .current = {job->snake.current[0], job->snake.current[1]},
                                        .controller = &h->controller,
                                        .tolerance = how.tolerance};
    job->program->start(h, &spec);
    spec.intervals = (int)ceil(how.per_second * spec.duration);
    return moray_swim_closed_loop_run(closed_loop, &spec);
}

moray_status steer_swim(const steer_job *job, const steer_trial *trial, moray_swim_closed_loop *closed_loop)
{
    steer_steersman h = {.job = job, .trial = trial, .model = MORAY_FIRST_PRINCIPLES};
    const moray_status status = swim(&h, careful, closed_loop);
    moray_swim_receding_horizon_free(h.receding);
    return status;
}

static moray_status try(const steer_job *job, steer_trial *trial, moray_model model, accuracy how)
{
    steer_steersman h = {.job = job, .trial = trial, .model = model};
    moray_swim_closed_loop closed_loop = {0};
    const moray_status status = swim(&h, how, &closed_loop);
    if (!moray_failed(status))
        trial->cost[model] = job->program->judge(trial, &h, &closed_loop, trial->score[model]);
    if (h.receding)
        trial->record[model] = *moray_receding_horizon_record_of(moray_swim_receding_horizon_engine(h.receding));
    moray_swim_receding_horizon_free(h.receding);
    moray_swim_closed_loop_free(&closed_loop);
    return status;
}

// ---- Tuning --------------------------------------------------------------------------------------------------------

typedef struct tuning {
    const steer_job *job;
    steer_trial *trial;
    moray_status status; // of the last simulation
} tuning;

static bool tuned(const steer_trial *trial, int number)
{
    return trial->law->tuned & 1u << number;
}

static void read(const steer_job *job, steer_trial *trial, const double *x)
{
    for (int k = 0; k < STEER_NUMBERS; k++)
        if (tuned(trial, k))
            trial->number[k] = job->number[k].logarithmic ? exp(*x++) : *x++;
}

static bool evaluate(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    tuning *t = self;
    const accuracy rough = {1e-6, t->job->program->rough_per_second};
    (void)c, (void)gradient, (void)jacobian;
    read(t->job, t->trial, x);
    t->status = try(t->job, t->trial, MORAY_FIRST_PRINCIPLES, rough);
    *f = t->trial->cost[MORAY_FIRST_PRINCIPLES];
    moray_ticker_show(&t->job->ticker, "%s: tuning %s: %s %.4g: cost %.5g", t->job->name, t->trial->name,
                      t->job->number[0].key, t->trial->number[0], *f);
    return !moray_failed(t->status);
}

// From these numbers on; keeps what is better than what the trial has.
static moray_status tune_from(const steer_job *job, steer_trial *trial, const double *number)
{
    steer_trial own = *trial;
    tuning t = {.job = job, .trial = &own};
    double x[STEER_NUMBERS], lower[STEER_NUMBERS], upper[STEER_NUMBERS];
    moray_search_problem problem = {.lower = lower, .upper = upper, .self = &t, .evaluate = evaluate};
    for (int k = 0; k < STEER_NUMBERS; k++)
        if (tuned(trial, k)) {
            const steer_number *row = &job->number[k];
            lower[problem.n] = row->logarithmic ? log(row->lower) : row->lower;
            upper[problem.n] = row->logarithmic ? log(row->upper) : row->upper;
            x[problem.n++] = row->logarithmic ? log(number[k]) : number[k];
        }
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    settings.method = MORAY_SEARCH_COBYLA;
    settings.x_tolerance = job->program->x_tolerance;
    settings.f_tolerance = job->program->f_tolerance;
    settings.max_evaluations = job->evaluations * problem.n;
    settings.progress = steer_go_on;
    const moray_status status = moray_search(&problem, &settings, x, &info);
    MORAY_TRY(steer_interruption());
    if (moray_failed(status))
        return status.code == MORAY_NUMERIC ? t.status : status;
    read(job, &own, x);
    own.cost[MORAY_FIRST_PRINCIPLES] = info.objective;
    own.evaluations = trial->evaluations + info.evaluations;
    if (trial->evaluations == 0 || info.objective < trial->cost[MORAY_FIRST_PRINCIPLES])
        *trial = own;
    trial->evaluations = own.evaluations;
    return moray_ok();
}

// From its own start, or from what another law was tuned to, or from both.
static moray_status tune(const steer_job *job, steer_trial *trial)
{
    double again[STEER_NUMBERS];
    for (int k = 0; k < STEER_NUMBERS; k++)
        again[k] = trial->like && tuned(trial->like, k) ? trial->like->number[k] : trial->number[k];
    if (!trial->like || trial->law->afresh)
        MORAY_TRY(tune_from(job, trial, trial->number));
    return trial->like ? tune_from(job, trial, again) : moray_ok();
}

// ---- All -----------------------------------------------------------------------------------------------------------

static bool can_run(const steer_job *job, const steer_trial *trial)
{
    const bool gait_known = job->straight[trial->gait][0].speed > 0;
    const bool plan_known = trial->law->kind == STEER_UNPLANNED || job->plan[trial->plan].solution;
    return !trial->run && gait_known && plan_known;
}

static moray_status run_trial(const steer_job *job, steer_trial *trial)
{
    const steer_score *first = job->program->scores;
    moray_ticker_show(&job->ticker, "%s: %s", job->name, trial->name);
    if (trial->law->tuned)
        MORAY_TRY(tune(job, trial));
    for (int model = 0; model < 2; model++) {
        MORAY_TRY(steer_interruption());
        MORAY_TRY(try(job, trial, (moray_model)model, careful));
    }
    trial->run = true;
    moray_ticker_note(&job->ticker, "%s: %s %.4g on the control-oriented model, %.4g on the first-principles model",
                      trial->name, first->key, trial->score[0][0] / first->unit, trial->score[1][0] / first->unit);
    return moray_ok();
}

moray_status steer_run_trials(steer_job *job)
{
    for (int k = 0; k < job->n_trials; k++)
        if (can_run(job, &job->trial[k]))
            MORAY_TRY(run_trial(job, &job->trial[k]));
    return moray_ok();
}

bool steer_go_on(void *observer, const moray_search_progress *progress)
{
    (void)observer, (void)progress;
    return !moray_interrupted();
}

moray_status steer_interruption(void)
{
    return moray_interrupted() ? moray_error(MORAY_INTERRUPTED, "interrupted; nothing is written") : moray_ok();
}
