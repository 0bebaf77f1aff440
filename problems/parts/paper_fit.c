// SPDX-License-Identifier: MIT
//
// The rotational constants of (20), which the authors found "by trial and error" for their robot, for any robot: by
// least squares against the heading of the first-principles model in a manoeuvre like that of Sec. V-C.
#include <unistd.h>

#include "paper_swim.h"

enum { CHANGES = 5, PER_PERIOD = 12 };
static const double THETA_MAX = 10 * DEG, OFFSET = 1.0 / 6; // of the amplitude
static const double RATIO = 1.5;                            // by which their ratio may differ
static const double WIDEST = 100;                           // factor by which the constants may differ from the first

// The manoeuvre of Sec. V-C has periods of 3 s; in periods it suits robots of any size.
static const double END = 190.0 / 3, from[CHANGES] = {0, 40.0 / 3, 70.0 / 3, 130.0 / 3, 160.0 / 3};
static const double way[CHANGES] = {0, 1, 0, -1, 0};

// The two constants of (20), rot_damping and rot_gain, and how far the heading then is from the first-principles
// model's, both on average over a period [deg].
typedef struct {
    double damping, gain, rms, largest;
} constants;

typedef struct {
    paper *p;
    constants given, first, best; // first: where the search starts
    constants slower, faster;     // half and twice the best rot_damping at the best ratio
    double *times, *raw;          // of the samples; headings there, followed by room for a state
    int n;
    double *target, *trial; // mean headings: of the first-principles model, of the last trial; NaN in the first period
    moray_status status;    // of the last trial
    int tried;
} fitting;

// ---- Manoeuvre
// ---------------------------------------------------------------------------------------------------------

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

static void plan_turns(const fitting *fit, moray_model model, moray_gait_change schedule[CHANGES])
{
    for (int i = 0; i < CHANGES; i++) {
        moray_gait gait = paper_gait(fit->p, MORAY_CONTROL_ORIENTED, THETA_MAX);
        gait.offset = way[i] * OFFSET * gait.amplitude;
        schedule[i].t = from[i] * 2 * M_PI / gait.omega;
        schedule[i].gait = moray_gait_map(fit->p->robot, &gait, MORAY_CONTROL_ORIENTED, model);
    }
}

static moray_status turn(fitting *fit, moray_swimmer *swimmer, double *mean)
{
    const double *V = fit->p->settings->common.current;
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
    MORAY_TRY(moray_swim_run(swimmer, &fit->p->basin.settings.sim, &plan, x, NULL));
    average(fit->raw, fit->n, mean);
    return moray_ok();
}

// ---- Fit
// ---------------------------------------------------------------------------------------------------------------

static void compare(const fitting *fit, constants *c)
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
static moray_status try_constants(fitting *fit, constants *c)
{
    moray_robot robot = *fit->p->robot;
    moray_swimmer *swimmer;
    robot.rot_damping = c->damping;
    robot.rot_gain = c->gain;
    MORAY_TRY(moray_swimmer_new(&swimmer, &robot, MORAY_CONTROL_ORIENTED));
    moray_swimmer_set_reading(swimmer, fit->p->settings->reading);
    const moray_status status = turn(fit, swimmer, fit->trial);
    moray_swimmer_free(swimmer);
    compare(fit, c);
    return status;
}

// The given constants, or the paper's where there are none, with the gain scaled so that the turns come out right: they
// are nearly proportional to it.
static moray_status start(fitting *fit)
{
    const moray_robot paper_robot = moray_robot_paper();
    const int turned = (int)lround(from[3] * PER_PERIOD);
    fit->first = fit->given;
    if (!(fit->given.damping > 0 && fit->given.gain > 0))
        fit->first = (constants){.damping = paper_robot.rot_damping, .gain = paper_robot.rot_gain};
    MORAY_TRY(try_constants(fit, &fit->first));
    const double scale = fit->target[turned] / fit->trial[turned];
    if (scale > 0 && isfinite(scale))
        fit->first.gain *= scale;
    return moray_ok();
}

static constants constants_at(const fitting *fit, const double *x)
{
    return (constants){.damping = fit->first.damping * exp(x[0]), .gain = fit->first.gain * exp(x[0] + x[1])};
}

// Mean square over the logarithms of rot_damping, which sets how fast a turn begins and ends, and of
// rot_gain/rot_damping, which sets how fast it is.
static bool deviation(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    (void)c;
    (void)gradient;
    (void)jacobian;
    fitting *fit = self;
    constants at = constants_at(fit, x);
    fit->status = try_constants(fit, &at);
    paper_progress(fit->p, "trial %d: %.4g deg off", ++fit->tried, at.rms);
    *f = at.rms * at.rms;
    return !moray_failed(fit->status);
}

static moray_status search(fitting *fit)
{
    // The ratio of the constants is known well from the scaled start, their size is not.
    const double upper[2] = {log(WIDEST), log(RATIO)}, lower[2] = {-upper[0], -upper[1]};
    const moray_search_problem problem = {.n = 2, .lower = lower, .upper = upper, .self = fit, .evaluate = deviation};
    moray_search_settings settings = moray_search_settings_default();
    settings.method = MORAY_SEARCH_BOBYQA;
    settings.x_tolerance = 1e-4;
    settings.f_tolerance = 1e-7;
    settings.max_evaluations = 300;
    double x[2] = {0, 0};
    moray_search_info found;
    const moray_status status = moray_search(&problem, &settings, x, &found);
    if (moray_failed(fit->status))
        return fit->status;
    MORAY_TRY(status);
    fit->best = constants_at(fit, x);
    if (fabs(x[0]) > 0.999 * upper[0] || fabs(x[1]) > 0.999 * upper[1])
        return moray_error(
            MORAY_NOT_SOLVED,
            "the best constants, rot_damping = %.4g and rot_gain = %.4g, lie at the end of the range "
            "searched, up to %g times smaller or larger than the first in size and %g times in their ratio",
            fit->best.damping, fit->best.gain, WIDEST, RATIO);
    fit->slower = (constants){.damping = fit->best.damping / 2, .gain = fit->best.gain / 2};
    fit->faster = (constants){.damping = fit->best.damping * 2, .gain = fit->best.gain * 2};
    MORAY_TRY(try_constants(fit, &fit->slower));
    MORAY_TRY(try_constants(fit, &fit->faster));
    return try_constants(fit, &fit->best);
}

// ---- Robot file
// --------------------------------------------------------------------------------------------------------

// The constants alone into a file that is there; all of the robot into one that is not.
static moray_status write_robot(const paper *p, const constants *c)
{
    const moray_robot *robot = p->robot;
    const struct {
        const char *key;
        double value;
    } all[] = {{"rot_damping", c->damping},
               {"rot_gain", c->gain},
               {"links", robot->links},
               {"l_m", robot->l},
               {"m_kg", robot->m},
               {"J_kg_m2", robot->J},
               {"c_t", robot->c_t},
               {"c_n", robot->c_n},
               {"mu_n", robot->mu_n},
               {"lambda_1", robot->lambda_1},
               {"lambda_2", robot->lambda_2},
               {"lambda_3", robot->lambda_3},
               {"k_p", robot->k_p},
               {"k_d", robot->k_d}};
    enum { n = sizeof all / sizeof *all };
    moray_ini_entry entries[n];
    char text[n][64], number[32];
    for (int i = 0; i < n; i++) {
        if (i < 2)
            snprintf(text[i], sizeof text[i], "%.6g  ; fitted by the program paper", all[i].value);
        else
            snprintf(text[i], sizeof text[i], "%s", moray_number_text(all[i].value, number));
        entries[i] = (moray_ini_entry){all[i].key, text[i]};
    }
    const char *file = p->settings->write_ini;
    return moray_ini_set(file, "robot", entries, access(file, F_OK) == 0 ? 2 : n);
}

// ---- Telling
// -----------------------------------------------------------------------------------------------------------

static void json_constants(moray_json *json, const char *key, const constants *c)
{
    moray_json_open(json, key);
    moray_json_number(json, "rot_damping", c->damping);
    moray_json_number(json, "rot_gain", c->gain);
    moray_json_number(json, "rms_deg", c->rms);
    moray_json_number(json, "largest_deg", c->largest);
    moray_json_close(json);
}

static moray_status tell(paper *p, const fitting *fit)
{
    const constants *a = &fit->given, *b = &fit->best;
    const moray_table_row rows[] = {
        {.label = "rot_damping", .value = {a->damping, b->damping, 100 * (a->damping / b->damping - 1)}, .unit = "1/s"},
        {.label = "rot_gain", .value = {a->gain, b->gain, 100 * (a->gain / b->gain - 1)}, .unit = "1/(m^2 s)"},
        {.label = "rot_gain/rot_damping",
         .value = {a->gain / a->damping, b->gain / b->damping,
                   100 * (a->gain / a->damping / (b->gain / b->damping) - 1)},
         .unit = "1/m^2"},
        {.label = "mean heading off by, root mean square", .value = {a->rms, b->rms, NAN}, .unit = "deg"},
        {.label = "mean heading off by, at most", .value = {a->largest, b->largest, NAN}, .unit = "deg"},
    };
    json_constants(p->json, "given", a);
    json_constants(p->json, "fitted", b);
    json_constants(p->json, "half_damping", &fit->slower);
    json_constants(p->json, "twice_damping", &fit->faster);
    moray_json_number(p->json, "trials", fit->tried);
    MORAY_TRY(paper_table(p, &(moray_table){.title = "Constants of the rotational dynamics (20)",
                                            .columns = {"given", "fitted", "given from fitted [%]"},
                                            .n_columns = 3,
                                            .rows = rows,
                                            .n_rows = 5}));
    return paper_say(p,
                     "Fitted to the heading of the first-principles model, on average over a period, in the manoeuvre "
                     "of Sec. V-C at %g deg/s, its times scaled to the period; %d links, %d trials. The ratio is well "
                     "determined, rot_damping by itself is not: half or twice of it at the same ratio is %.3g or %.3g "
                     "deg off.",
                     p->settings->omega / DEG, p->robot->links, fit->tried, fit->slower.rms, fit->faster.rms);
}

static moray_status draw(paper *p, const fitting *fit, const double *given)
{
    const moray_curve curves[] = {
        {.label = "first-principles", .x = fit->times, .y = fit->target, .n = fit->n},
        {.label = "control-oriented, fitted constants", .x = fit->times, .y = fit->trial, .n = fit->n},
        {.label = "control-oriented, given constants", .x = fit->times, .y = given, .n = fit->n}};
    const moray_column columns[] = {{"t", "s", fit->times, 1},
                                    {"heading first-principles", "deg", fit->target, 1},
                                    {"heading fitted", "deg", fit->trial, 1},
                                    {"heading given", "deg", given, 1}};
    MORAY_TRY(paper_csv(p, NULL, columns, 4, fit->n));
    return paper_figure(p, &(moray_figure){.title = "Heading in a manoeuvre, mean over the last period",
                                           .x_label = "time [s]",
                                           .y_label = "heading [deg]",
                                           .curves = curves,
                                           .n_curves = 3});
}

// ---- All of it
// ---------------------------------------------------------------------------------------------------------

static moray_status prepare(paper *p, fitting *fit)
{
    const double step = 2 * M_PI / p->settings->omega / PER_PERIOD;
    *fit = (fitting){.p = p,
                     .given = {.damping = p->robot->rot_damping, .gain = p->robot->rot_gain},
                     .n = (int)lround(END * PER_PERIOD) + 1};
    MORAY_TRY(paper_numbers(p, fit->n, &fit->times));
    MORAY_TRY(paper_numbers(p, fit->n, &fit->target));
    MORAY_TRY(paper_numbers(p, fit->n, &fit->trial));
    MORAY_TRY(paper_numbers(p, (size_t)(fit->n + 2 * p->robot->links + 4), &fit->raw));
    for (int k = 0; k < fit->n; k++)
        fit->times[k] = k * step;
    paper_progress(p, "first-principles model");
    return turn(fit, p->basin.swimmer[MORAY_FIRST_PRINCIPLES], fit->target);
}

moray_status paper_fit(paper *p)
{
    fitting fit;
    double *given;
    MORAY_TRY(prepare(p, &fit));
    MORAY_TRY(paper_numbers(p, fit.n, &given));
    MORAY_TRY(try_constants(&fit, &fit.given));
    for (int k = 0; k < fit.n; k++)
        given[k] = fit.trial[k];
    MORAY_TRY(start(&fit));
    MORAY_TRY(search(&fit));
    MORAY_TRY(tell(p, &fit));
    if (p->settings->write_ini[0])
        MORAY_TRY(write_robot(p, &fit.best));
    return draw(p, &fit, given);
}
