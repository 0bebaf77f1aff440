// SPDX-License-Identifier: MIT
//
// The rotational constants of (20), which the authors found "by trial and error" for their robot, for any robot: by
// least squares against the heading of the first-principles model in a manoeuvre like that of Sec. V-C.
#include "fit.h"

enum { CHANGES = 5, PER_PERIOD = 12 };
static const double THETA_MAX = 10 * DEG, OFFSET = 1.0 / 6; // of the amplitude
static const double DAMPING = 20, RATIO = 1.5; // factors by which rot_damping and the ratio of the constants may change

// The manoeuvre of Sec. V-C has periods of 3 s; in periods it suits robots of any size.
static const double END = 190.0 / 3, from[CHANGES] = {0, 40.0 / 3, 70.0 / 3, 130.0 / 3, 160.0 / 3};
static const double way[CHANGES] = {0, 1, 0, -1, 0};

// ---- Manoeuvre -----------------------------------------------------------------------------------------------------

typedef struct {
    double *heading;
    int next;
} recorder;

static bool record(const moray_swim_sample *sample, void *self)
{
    recorder *to = self;
    to->heading[to->next++] = sample->pose.heading / DEG;
    return true;
}

// Of the PER_PERIOD steps up to each sample, by the trapezoidal rule.
static void average(const double *raw, int n, double *mean)
{
    for (int k = 0; k < n; k++) {
        double sum = 0;
        for (int j = k - PER_PERIOD; j < k && k >= PER_PERIOD; j++)
            sum += (raw[j] + raw[j + 1]) / 2;
        mean[k] = k < PER_PERIOD ? NAN : sum / PER_PERIOD;
    }
}

static void plan_turns(const paper_fitting *fit, moray_model model, moray_gait_change schedule[CHANGES])
{
    for (int i = 0; i < CHANGES; i++) {
        moray_gait gait = paper_gait(fit->p, MORAY_CONTROL_ORIENTED, THETA_MAX);
        gait.offset = way[i] * OFFSET * gait.amplitude;
        schedule[i].t = from[i] * 2 * M_PI / gait.omega;
        schedule[i].gait = moray_gait_map(fit->p->robot, &gait, MORAY_CONTROL_ORIENTED, model);
    }
}

static moray_status turn(paper_fitting *fit, moray_swimmer *swimmer, double *mean)
{
    const double *V = fit->p->settings->snake.current;
    moray_gait_change schedule[CHANGES];
    recorder to = {.heading = fit->raw};
    double *x = fit->raw + fit->n;
    const moray_swim_plan plan = {.t1 = fit->times[fit->n - 1],
                                  .schedule = schedule,
                                  .n_changes = CHANGES,
                                  .times = fit->times,
                                  .n_times = fit->n,
                                  .observe = record,
                                  .observer = &to};
    plan_turns(fit, moray_swimmer_model(swimmer), schedule);
    moray_swimmer_set_current(swimmer, V[0], V[1]);
    moray_swimmer_rest(swimmer, 0, 0, 0, x);
    MORAY_TRY(moray_swim_run(swimmer, &fit->p->rig.settings.sim, &plan, x, NULL));
    average(fit->raw, fit->n, mean);
    return moray_ok();
}

// ---- Fit -----------------------------------------------------------------------------------------------------------

static void compare(const paper_fitting *fit, paper_constants *c)
{
    c->rms = c->largest = 0;
    for (int k = PER_PERIOD; k < fit->n; k++) {
        const double difference = fit->trial[k] - fit->target[k];
        c->rms += difference * difference / (fit->n - PER_PERIOD);
        c->largest = fmax(c->largest, fabs(difference));
    }
    c->rms = sqrt(c->rms);
}

// Turns with the constants and fills in how far off the heading is.
static moray_status try_constants(paper_fitting *fit, paper_constants *c)
{
    moray_robot robot = *fit->p->robot;
    moray_swimmer *swimmer;
    robot.rot_damping = c->damping;
    robot.rot_gain = c->gain;
    MORAY_TRY(paper_reading_swimmer(&swimmer, &robot, MORAY_CONTROL_ORIENTED, fit->p->settings->reading));
    const moray_status status = turn(fit, swimmer, fit->trial);
    moray_swimmer_free(swimmer);
    compare(fit, c);
    return status;
}

// The given constants, or the paper's where there are none, with the gain scaled so that the turns come out right: they
// are nearly proportional to it.
static moray_status start(paper_fitting *fit)
{
    const moray_robot paper_robot = moray_robot_paper();
    const int turned = (int)lround(from[3] * PER_PERIOD);
    fit->first = fit->given;
    if (!(fit->given.damping > 0 && fit->given.gain > 0))
        fit->first = (paper_constants){.damping = paper_robot.rot_damping, .gain = paper_robot.rot_gain};
    MORAY_TRY(try_constants(fit, &fit->first));
    const double scale = fit->target[turned] / fit->trial[turned];
    if (scale > 0 && isfinite(scale))
        fit->first.gain *= scale;
    return moray_ok();
}

static paper_constants constants_at(const paper_fitting *fit, const double *x)
{
    return (paper_constants){.damping = fit->first.damping * exp(x[0]), .gain = fit->first.gain * exp(x[0] + x[1])};
}

// Mean square over the logarithms of rot_damping, which sets how fast a turn begins and ends, and of
// rot_gain/rot_damping, which sets how fast it is.
static bool deviation(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    (void)c, (void)gradient, (void)jacobian; // there are no constraints, and BOBYQA asks for no slopes
    paper_fitting *fit = self;
    paper_constants at = constants_at(fit, x);
    const moray_status status = try_constants(fit, &at);
    paper_progress(fit->p, "trial %d: %.4g deg off", ++fit->tried, at.rms);
    *f = at.rms * at.rms;
    if (moray_failed(status))
        fit->failure = status;
    return !moray_failed(status);
}

// The bounds set the scale of the search too: the ratio is known well from the scaled start, the damping is not.
static moray_status find_best(paper_fitting *fit, double x[2], const double upper[2])
{
    const double lower[2] = {-upper[0], -upper[1]};
    const moray_search_problem problem = {.n = 2, .lower = lower, .upper = upper, .self = fit, .evaluate = deviation};
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info found;
    settings.method = MORAY_SEARCH_BOBYQA;
    settings.x_tolerance = 1e-4;
    settings.f_tolerance = 1e-7;
    settings.max_evaluations = 300;
    const moray_status status = moray_search(&problem, &settings, x, &found);
    MORAY_TRY(fit->failure);
    MORAY_TRY(status);
    fit->best = constants_at(fit, x);
    if (found.outcome == MORAY_SEARCH_CONVERGED)
        return moray_ok();
    return moray_error(MORAY_NOT_SOLVED, "the search for the constants ended with: %s",
                       moray_search_outcome_text(found.outcome));
}

static moray_status search(paper_fitting *fit)
{
    const double upper[2] = {log(DAMPING), log(RATIO)};
    double x[2] = {0, 0};
    MORAY_TRY(find_best(fit, x, upper));
    fit->damping_at_end = fabs(x[0]) > 0.99 * upper[0];
    if (fabs(x[1]) > 0.99 * upper[1])
        return moray_error(MORAY_NOT_SOLVED,
                           "no constants within a factor of %g of rot_gain/rot_damping = %.4g 1/m^2 let the "
                           "control-oriented model turn as the first-principles model does",
                           RATIO, fit->first.gain / fit->first.damping);
    fit->slower = (paper_constants){.damping = fit->best.damping / 2, .gain = fit->best.gain / 2};
    fit->faster = (paper_constants){.damping = fit->best.damping * 2, .gain = fit->best.gain * 2};
    MORAY_TRY(try_constants(fit, &fit->slower));
    MORAY_TRY(try_constants(fit, &fit->faster));
    return try_constants(fit, &fit->best);
}

// ---- All of it -----------------------------------------------------------------------------------------------------

static moray_status prepare(paper *p, paper_fitting *fit)
{
    const double step = 2 * M_PI / p->settings->omega / PER_PERIOD;
    *fit = (paper_fitting){.p = p,
                           .given = {.damping = p->robot->rot_damping, .gain = p->robot->rot_gain},
                           .n = (int)lround(END * PER_PERIOD) + 1};
    MORAY_TRY(paper_numbers(p, fit->n, &fit->times));
    MORAY_TRY(paper_numbers(p, fit->n, &fit->target));
    MORAY_TRY(paper_numbers(p, fit->n, &fit->trial));
    MORAY_TRY(paper_numbers(p, (size_t)(fit->n + 2 * p->robot->links + 4), &fit->raw));
    for (int k = 0; k < fit->n; k++)
        fit->times[k] = k * step;
    paper_progress(p, "first-principles model");
    return turn(fit, p->rig.swimmer[MORAY_FIRST_PRINCIPLES], fit->target);
}

moray_status paper_fit(paper *p)
{
    paper_fitting fit;
    double *given;
    MORAY_TRY(prepare(p, &fit));
    MORAY_TRY(paper_numbers(p, fit.n, &given));
    MORAY_TRY(try_constants(&fit, &fit.given));
    for (int k = 0; k < fit.n; k++)
        given[k] = fit.trial[k];
    MORAY_TRY(start(&fit));
    MORAY_TRY(search(&fit));
    MORAY_TRY(paper_fit_tell(p, &fit));
    if (p->settings->write_ini[0])
        MORAY_TRY(paper_fit_write(p, &fit.best));
    return paper_fit_draw(p, &fit, given);
}
