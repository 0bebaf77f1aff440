// SPDX-License-Identifier: MIT
//
// A robot identified from synthetic logs: recovered without noise; as uncertain as many seeds scatter; what is open is
// named; a model that is too simple is told.
#include <string.h>

#include "degree.h"
#include "tap.h"

#include "moray/dense.h"
#include "moray/snake/identify.h"

enum { MOST_LOGS = 2, LINKS = 5 };

// What the logs are swum by, and how they are read.
typedef struct story {
    moray_model model;
    moray_hydrodynamics hydro;
    moray_swim_log_noise noise;
    double current[2], sigma[MORAY_CHANNELS];
    double offset; // of the second gait [rad or m]
    double duration, step;
    bool no_lambda_3, unequal;
    moray_motor motor;
} story;

static moray_robot robot_of(const story *s)
{
    moray_robot robot = moray_robot_paper();
    robot.links = LINKS;
    robot.hydro = s->hydro;
    robot.motor = s->motor;
    robot.lambda_3 *= !s->no_lambda_3;
    if (!s->unequal)
        return robot;
    static moray_link link[LINKS];
    for (int i = 0; i < LINKS; i++) {
        link[i] = moray_robot_link(&robot, i);
        link[i].l *= 1 + 0.1 * i, link[i].m *= 1.4 - 0.2 * i, link[i].c_n *= 1 + 0.3 * (i % 2);
        link[i].cm = 0.01 * i, link[i].fin_at = -0.1, link[i].fin_c_n = i ? 0 : 6;
    }
    moray_robot_from_links(&robot, link);
    return robot;
}

static void swim_logs(const story *s, moray_swim_log log[MOST_LOGS])
{
    const moray_robot robot = robot_of(s);
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, s->model), "swimmer");
    moray_swimmer_set_current(swimmer, s->current[0], s->current[1]);
    for (int k = 0; k < MOST_LOGS; k++) {
        moray_swim_log_noise noise = s->noise;
        noise.seed = noise.seed * MOST_LOGS + (unsigned long)k;
        moray_gait gait = {.omega = (k ? 150 : 110) * DEG, .delta = (k ? 60 : 40) * DEG, .offset = k ? s->offset : 0};
        gait.amplitude = moray_amplitude_from_theta_max(&robot, s->model, (k ? 18 : 25) * DEG, gait.delta);
        CHECK_OK(moray_swim_log_swim(&log[k], swimmer, &gait, k * 70 * DEG, 6, 6 + s->duration, s->step, &noise),
                 "log");
    }
    moray_swimmer_free(swimmer);
}

// The unknowns of a spec by name, starting away from the truth, bounds a factor 5 or 0.5 on either side.
typedef struct wanted {
    int n, unknown[MORAY_MOST_UNKNOWNS];
    double truth[MORAY_MOST_UNKNOWNS], lower[MORAY_MOST_UNKNOWNS], upper[MORAY_MOST_UNKNOWNS];
} wanted;

static moray_identify_spec spec_of(const story *s, const char *names, wanted *w)
{
    moray_identify_spec spec = {.model = s->model, .start = {.robot = robot_of(s)}, .max_iterations = 40};
    moray_unknowns truth = spec.start;
    char text[300], *rest = NULL;
    memcpy(spec.sigma, s->sigma, sizeof spec.sigma);
    memcpy(truth.current, s->current, sizeof truth.current);
    memcpy(truth.camera, s->noise.camera, sizeof truth.camera);
    truth.heading_bias = s->noise.heading_bias;
    truth.camera_rotation = s->noise.camera_rotation;
    truth.position_delay = s->noise.position_delay;
    truth.heading_delay = s->noise.heading_delay;
    *w = (wanted){0};
    snprintf(text, sizeof text, "%s", names);
    for (char *name = strtok_r(text, ",", &rest); name; name = strtok_r(NULL, ",", &rest)) {
        const int unknown = w->unknown[w->n] = moray_unknown_named(name), k = w->n++;
        const double value = w->truth[k] = *moray_unknown_at(unknown, &truth);
        const bool coefficient = unknown < moray_unknown_named("current_x");
        w->lower[k] = coefficient ? value / 5 : strstr(name, "delay") ? 0 : -0.5;
        w->upper[k] = coefficient ? value * 5 : 0.5;
        *moray_unknown_at(unknown, &spec.start) = coefficient ? 1.3 * value : 0;
    }
    spec.unknown = w->unknown;
    spec.n = w->n;
    spec.lower = w->lower;
    spec.upper = w->upper;
    return spec;
}

static void free_logs(moray_swim_log log[MOST_LOGS])
{
    for (int k = 0; k < MOST_LOGS; k++)
        moray_swim_log_free(&log[k]);
}

static void check_recovered(const story *s, const char *names, const char *what)
{
    moray_swim_log log[MOST_LOGS];
    wanted w;
    moray_identify *identify;
    moray_estimate at;
    double worst = 0;
    int at_worst = 0;
    swim_logs(s, log);
    moray_identify_spec spec = spec_of(s, names, &w);
    spec.step = 0.01;
    CHECK_OK(moray_identify_new(&identify, &spec, log, MOST_LOGS), what);
    moray_identify_start(identify, 0, &at);
    CHECK_OK(moray_identify_solve(identify, &at), what);
    for (int k = 0; k < w.n; k++) {
        const double off = fabs(at.value[k] - w.truth[k]) / (w.truth[k] != 0 ? fabs(w.truth[k]) : 1);
        printf("# %s %s %.10g (true %.10g)\n", what, moray_unknown_name(w.unknown[k]), at.value[k], w.truth[k]);
        if (!(off <= worst))
            worst = off, at_worst = k;
    }
    CHECK(worst < 1e-6 && at.converged, "%s: recovered within 1e-6 in %d iterations: worst %s by %.2g; cost %.3g", what,
          at.iterations, moray_unknown_name(w.unknown[at_worst]), worst, at.cost);
    moray_identify_free(identify);
    free_logs(log);
}

static const double known[MORAY_CHANNELS] = {1e-3, 1e-3, 0.1 * DEG, 1e-3};

static void test_recovery(void)
{
    story s = {
        .model = MORAY_FIRST_PRINCIPLES, .current = {0.06, -0.04}, .offset = 3 * DEG, .duration = 8, .step = 0.1};
    memcpy(s.sigma, known, sizeof known);
    s.noise = (moray_swim_log_noise){.heading_bias = 0.05, .position_delay = 0.12, .heading_delay = 0.03};
    check_recovered(&s, "c_t,c_n,mu_n,lambda_2,current_x,current_y,heading_bias,position_delay,heading_delay",
                    "first-principles");
    s.hydro = moray_hydrodynamics_consistent();
    check_recovered(&s, "c_t,c_n,mu_n,m,current_x,current_y,heading_bias,position_delay,heading_delay", "consistent");
    s.unequal = tap_thorough();
    if (s.unequal)
        check_recovered(&s, "c_t,c_n,mu_n,m,current_x,current_y,heading_bias,position_delay,heading_delay",
                        "unequal links");
    s.unequal = false;
    s.model = MORAY_CONTROL_ORIENTED;
    s.offset = 0.005;
    s.noise = (moray_swim_log_noise){.heading_bias = 0.05};
    check_recovered(&s, "c_t,c_n,rot_damping,rot_gain,current_x,current_y,heading_bias", "control-oriented");
}

// A search goes on from the spec's start and from others within the bounds, the best first, by however many processes;
// before an iteration its points are the starts.
static void test_search(void)
{
    enum { starts = 4 };
    story s = {.model = MORAY_CONTROL_ORIENTED, .offset = 0.005, .duration = 4, .step = 0.1};
    moray_swim_log log[MOST_LOGS];
    wanted w;
    moray_identify *identify;
    moray_estimate at[starts] = {0};
    memcpy(s.sigma, known, sizeof known);
    swim_logs(&s, log);
    moray_identify_spec spec = spec_of(&s, "c_t,c_n", &w);
    for (int iterations = 0; iterations <= 40; iterations += 40) {
        int given = 0, outside = 0;
        spec.max_iterations = iterations;
        CHECK_OK(moray_identify_new(&identify, &spec, log, MOST_LOGS), "search");
        CHECK_OK(moray_identify_search(identify, starts, 1 + (iterations > 0), at), "searched");
        moray_identify_free(identify);
        for (int i = 0; i < starts; i++) {
            given += fabs(at[i].value[0] / w.truth[0] - 1.3) + fabs(at[i].value[1] / w.truth[1] - 1.3) < 1e-12;
            for (int k = 0; k < w.n; k++)
                outside += !(at[i].value[k] >= w.lower[k] && at[i].value[k] <= w.upper[k]);
            CHECK(i == 0 || at[i - 1].cost <= at[i].cost, "cost %.3g", at[i].cost);
        }
        CHECK(given == (iterations == 0) && outside == 0, "from the spec's start, and none outside the bounds");
        CHECK(iterations ? at[0].converged : at[1].value[0] != at[2].value[0], "from several, to the best");
    }
    for (int k = 0; k < w.n; k++)
        CHECK_NEAR(at[0].value[k] / w.truth[k], 1, 1e-6, moray_unknown_name(w.unknown[k]));
    free_logs(log);
}

// A coefficient that is nothing: there is no robot on its other side for a difference.
static void test_zero(void)
{
    story s = {.model = MORAY_FIRST_PRINCIPLES, .duration = 4, .step = 0.1, .no_lambda_3 = true};
    moray_swim_log log[MOST_LOGS];
    wanted w;
    moray_identify *identify;
    moray_estimate at;
    moray_information info[2];
    memcpy(s.sigma, known, sizeof known);
    swim_logs(&s, log);
    moray_identify_spec spec = spec_of(&s, "c_t,c_n,lambda_3", &w);
    w.lower[2] = -1e-3, w.upper[2] = 1e-3; // below 0, so that it is not held there
    CHECK_OK(moray_identify_new(&identify, &spec, log, MOST_LOGS), "zero");
    moray_identify_start(identify, 0, &at);
    for (int k = 0; k < 2; k++) {
        at.value[2] = k * 1e-7;
        CHECK_OK(moray_identify_information(identify, &at, &info[k]), "information at a coefficient of 0");
    }
    for (int k = 0; k < w.n; k++)
        CHECK_NEAR(info[0].error[k] / info[1].error[k], 1, 1e-4, moray_unknown_name(w.unknown[k]));
    moray_identify_free(identify);
    w.lower[2] = 0;
    CHECK_OK(moray_identify_new(&identify, &spec, log, MOST_LOGS), "zero");
    for (int k = 0; k < 2; k++) {
        moray_identify_start(identify, 0, &at);
        at.value[2] = k * 2e-5;
        CHECK_OK(moray_identify_solve(identify, &at), "from 0, and from above");
        CHECK(at.value[2] >= 0 && at.value[2] < 1e-9 && fabs(at.value[1] / w.truth[1] - 1) < 1e-5,
              "lambda_3 = %.2g, c_n off by %.1e", at.value[2], at.value[1] / w.truth[1] - 1);
    }
    moray_identify_free(identify);
    free_logs(log);
}

// Logs of currents have the motors' friction in them, those of torques at the joints have not.
static void test_motors(void)
{
    story s = {.model = MORAY_FIRST_PRINCIPLES, .duration = 4, .step = 0.1};
    moray_swim_log log[MOST_LOGS];
    wanted w;
    moray_identify *identify;
    moray_estimate at;
    memcpy(s.sigma, known, sizeof known);
    s.motor = (moray_motor){.fitted = true, .forward = 0.8, .smooth_rate = 0.1, .smooth_power = 1e-3};
    s.motor.friction = 0.05, s.motor.viscous = 0.02;
    swim_logs(&s, log);
    for (int r = 0; r < MOST_LOGS; r++) {
        moray_gait gait = {.omega = (r ? 150 : 110) * DEG, .delta = (r ? 60 : 40) * DEG};
        double phi[3 * (LINKS - 1)];
        const moray_robot robot = robot_of(&s);
        gait.amplitude = moray_amplitude_from_theta_max(&robot, s.model, (r ? 18 : 25) * DEG, gait.delta);
        log[r].at_motors = true;
        for (int k = 0; k < log[r].n; k++) {
            moray_gait_reference(&gait, LINKS - 1, log[r].t[k], phi, phi + LINKS - 1, phi + 2 * (LINKS - 1));
            for (int i = 0; i < LINKS - 1; i++)
                log[r].u[k * (LINKS - 1) + i] +=
                    0.05 * phi[LINKS - 1 + i] / hypot(phi[LINKS - 1 + i], 0.1) + 0.02 * phi[LINKS - 1 + i];
        }
    }
    for (int told = 1; told >= 0; told--) {
        moray_identify_fit fit;
        moray_identify_spec spec = spec_of(&s, "c_t,c_n,mu_n", &w);
        spec.step = 0.01;
        log[0].at_motors = log[1].at_motors = told;
        CHECK_OK(moray_identify_new(&identify, &spec, log, MOST_LOGS), "motors");
        moray_identify_start(identify, 0, &at);
        CHECK_OK(moray_identify_solve(identify, &at), "motors");
        CHECK_OK(moray_identify_residuals(identify, &at, &fit), "motors");
        const double off = fabs(at.value[1] / w.truth[1] - 1);
        CHECK(told ? off < 1e-5 && !fit.simple : off > 1e-3 && fit.simple, "%s: c_n off by %.1e; %s",
              told ? "currents" : "currents taken for torques", off, fit.verdict);
        moray_identify_fit_free(&fit);
        moray_identify_free(identify);
    }
    free_logs(log);
}

// What cannot be computed is told: too few measurements, too many steps.
static void test_refusals(void)
{
    story s = {.model = MORAY_FIRST_PRINCIPLES, .duration = 8, .step = 0.1};
    moray_swim_log log[MOST_LOGS];
    wanted w;
    moray_identify *identify;
    moray_estimate at;
    moray_identify_fit fit;
    memcpy(s.sigma, known, sizeof known);
    swim_logs(&s, log);
    moray_identify_spec spec = spec_of(&s, "c_t,c_n", &w);
    spec.step = 1e-9;
    moray_status status = moray_identify_new(&identify, &spec, log, 1);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "steps: must be at most"), "%s", status.text);
    spec.step = 0;
    log[0].u = log[0].p_x = log[0].p_y = NULL;
    for (int k = 20; k < log[0].n; k++) // as many as a spline wants, but the log has no more
        log[0].heading[k] = NAN;
    spec = spec_of(&s,
                   "c_t,c_n,mu_n,lambda_1,lambda_2,lambda_3,m,J,current_x,current_y,heading_bias,camera_rotation,"
                   "position_delay,heading_delay",
                   &w);
    CHECK_OK(moray_identify_new(&identify, &spec, log, 1), "few measurements");
    moray_identify_start(identify, 0, &at);
    status = moray_identify_residuals(identify, &at, &fit);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "measurements are no more than"), "%s", status.text);
    moray_identify_fit_free(&fit);
    moray_identify_free(identify);
    free_logs(log);
}

// ---- Noise ---------------------------------------------------------------------------------------------------------

static double *line(double *y, int n, int stride, double from, double to)
{
    for (int k = 0; k < n; k++)
        y[k * stride] = from + (to - from) * k / (n - 1);
    return y;
}

// Channels that a spline goes through leave nothing to tell the noise by: it is that of the best instrument, a
// ten-thousandth of the range, of both coordinates together and of the joint that ranges furthest.
static void test_least_noise(void)
{
    static const double best = 1e-4;
    story s = {.model = MORAY_FIRST_PRINCIPLES, .duration = 8, .step = 0.1};
    moray_swim_log log[MOST_LOGS];
    wanted w;
    moray_identify *identify;
    const double unknown[MORAY_CHANNELS] = {NAN, NAN, NAN, NAN};
    swim_logs(&s, log);
    moray_identify_spec spec = spec_of(&s, "c_t,c_n", &w);
    memcpy(spec.sigma, unknown, sizeof unknown);
    const int n = log[0].n, joints = log[0].joints;
    line(log[0].p_x, n, 1, -1.5, 0.9);
    line(log[0].p_y, n, 1, 0.2, 0.2); // at rest: a range of 1 is taken
    line(log[0].heading, n, 1, 0.3, -0.4)[n / 2] = NAN;
    log[0].heading[n - 1] = NAN;
    for (int i = 0; i < joints; i++)
        line(log[0].u + i, n, joints, -4, -1 - i % 3)[n / 3 * joints] = NAN;
    CHECK_OK(moray_identify_new(&identify, &spec, log, 1), "without noise");
    const double position = sqrt((2.4 * 2.4 + 1) / 2), heading = 0.7 * (n - 2) / (n - 1);
    const double range[MORAY_CHANNELS] = {position, position, heading, 3};
    for (int kind = 0; kind < MORAY_CHANNELS; kind++)
        CHECK_NEAR(moray_identify_sigma(identify, 0, kind) / (best * range[kind]), 1, 1e-9,
                   moray_channel_name((moray_channel_kind)kind));
    moray_estimate at;
    const double T = log[0].t[n - 1] - log[0].t[0];
    moray_identify_start(identify, 0, &at);
    CHECK_NEAR(at.first[0][MORAY_STATE_P_X], -1.5, 1e-9, "begins where the line begins");
    CHECK_NEAR(at.first[0][MORAY_STATE_P_Y], 0.2, 1e-9, "on either axis");
    CHECK_NEAR(at.first[0][MORAY_STATE_THETA], 0.3, 1e-9, "in its heading");
    CHECK_NEAR(at.first[0][MORAY_STATE_V_THETA], -0.7 / T, 1e-8, "which turns");
    CHECK_NEAR(at.first[0][MORAY_STATE_V_1], 2.4 / T, 1e-8, "at its speed");
    CHECK_NEAR(at.first[0][MORAY_STATE_V_2], 0, 1e-8, "along it");
    moray_identify_free(identify);

    // a coordinate whose noise is known says nothing of the other's; without headings it looks where it goes
    double *const heading_of_log = log[0].heading;
    log[0].heading = NULL;
    line(log[0].p_y, n, 1, 0.2, 1);
    spec.sigma[MORAY_CHANNEL_X] = 5e-3;
    CHECK_OK(moray_identify_new(&identify, &spec, log, 1), "one coordinate's noise known");
    CHECK_NEAR(moray_identify_sigma(identify, 0, MORAY_CHANNEL_X), 5e-3, 1e-15, "it stays");
    CHECK_NEAR(moray_identify_sigma(identify, 0, MORAY_CHANNEL_Y) / (0.8 * best), 1, 1e-9,
               "and so does the other's own");
    moray_identify_start(identify, 0, &at);
    CHECK_NEAR(at.first[0][MORAY_STATE_THETA], atan2(0.8, 2.4), 1e-9, "where it goes");
    log[0].heading = heading_of_log;
    moray_identify_free(identify);
    free_logs(log);
}

enum { MOST_SEEDS = 1000 };

// How often the interval of 95 % holds the truth; the scatter beside the mean of the claimed variances; and the errors
// weighed by the claimed covariance, e' C^-1 e, which are chi^2 of as many degrees of freedom as there are unknowns.
typedef struct tally {
    int inside[MORAY_MOST_UNKNOWNS], seeds, simple;
    double sum[MORAY_MOST_UNKNOWNS], squares[MORAY_MOST_UNKNOWNS], claimed[MORAY_MOST_UNKNOWNS];
    double weighed;
} tally;

static double weigh(const double *error, const moray_information *info)
{
    double C[MORAY_MOST_UNKNOWNS * MORAY_MOST_UNKNOWNS], x[MORAY_MOST_UNKNOWNS], sum = 0;
    memcpy(C, info->covariance, sizeof C);
    memcpy(x, error, sizeof x);
    if (!moray_dense_solve(info->n, C, 1, x))
        return NAN;
    for (int k = 0; k < info->n; k++)
        sum += error[k] * x[k];
    return sum;
}

static void count_seed(const story *of, const char *names, unsigned long seed, wanted *w, tally *t)
{
    moray_swim_log log[MOST_LOGS];
    moray_identify *identify;
    moray_estimate at;
    moray_information info;
    moray_identify_fit fit;
    story s = *of;
    s.noise.seed = seed;
    swim_logs(&s, log);
    const moray_identify_spec spec = spec_of(&s, names, w);
    moray_status status = moray_identify_new(&identify, &spec, log, MOST_LOGS);
    moray_identify_start(identify, 0, &at);
    if (!moray_failed(status))
        status = moray_identify_solve(identify, &at);
    if (!moray_failed(status))
        status = moray_identify_information(identify, &at, &info);
    if (!moray_failed(status))
        status = moray_identify_residuals(identify, &at, &fit);
    if (moray_failed(status))
        CHECK_OK(status, "seed");
    double error[MORAY_MOST_UNKNOWNS] = {0};
    for (int k = 0; k < w->n; k++) {
        const double off = error[k] = at.value[k] - w->truth[k];
        t->inside[k] += fabs(off) < 1.959964 * info.error[k];
        t->sum[k] += off;
        t->squares[k] += off * off;
        t->claimed[k] += info.error[k] * info.error[k];
    }
    t->weighed += weigh(error, &info);
    t->seeds++;
    t->simple += fit.simple;
    moray_identify_fit_free(&fit);
    moray_identify_free(identify);
    free_logs(log);
}

// What chi^2 lies below, and above, but for one in 1000 (Wilson & Hilferty).
static double chi_square(double freedom, double side)
{
    const double root = 1 - 2 / (9 * freedom) + side * 3.0902 * sqrt(2 / (9 * freedom));
    return freedom * root * root * root;
}

static void check_coverage(const story *s, const char *names, int seeds, const char *what)
{
    tally t = {0};
    wanted w;
    double inside = 0;
    for (int k = 0; k < seeds; k++)
        count_seed(s, names, (unsigned long)k + 1, &w, &t);
    for (int k = 0; k < w.n; k++) {
        const double mean = t.sum[k] / seeds, scatter = sqrt(t.squares[k] / seeds),
                     claimed = sqrt(t.claimed[k] / seeds);
        printf("# %s %-16s inside %d of %d; claimed %.4g, scatter %.4g, mean error %.2g\n", what,
               moray_unknown_name(w.unknown[k]), t.inside[k], seeds, claimed, scatter, mean);
        inside += (double)t.inside[k] / seeds / w.n;
    }
    const double freedom = (double)seeds * w.n, low = chi_square(freedom, -1), high = chi_square(freedom, 1);
    CHECK(t.weighed > low && t.weighed < high,
          "%s: over %d seeds errors weighed by the claimed covariance sum up to %.1f, within %.1f to %.1f", what, seeds,
          t.weighed, low, high);
    if (seeds >= 200)
        CHECK(inside > 0.93 && inside < 0.97, "%s: %.1f %% of the truths inside their 95 %% intervals", what,
              100 * inside);
    CHECK(t.simple <= 1 + seeds / 50, "%s: %d of %d called too simple", what, t.simple, seeds);
}

static story noisy(moray_hydrodynamics hydro)
{
    story s = {.model = MORAY_FIRST_PRINCIPLES,
               .hydro = hydro,
               .current = {0.06, -0.04},
               .offset = 3 * DEG,
               .duration = 10,
               .step = 0.1};
    for (int k = 0; k < MORAY_CHANNELS; k++)
        s.sigma[k] = NAN;
    s.noise = (moray_swim_log_noise){.position = 0.005, .heading = 0.5 * DEG, .torque = 0.02, .heading_bias = 0.05};
    return s;
}

static void test_coverage(int seeds)
{
    const story paper = noisy((moray_hydrodynamics){0}), consistent = noisy(moray_hydrodynamics_consistent());
    check_coverage(&paper, "c_t,c_n,mu_n,current_x,current_y,heading_bias", seeds, "first-principles");
    check_coverage(&consistent, "c_t,c_n,mu_n,current_x,current_y,heading_bias", seeds, "consistent");
}

// ---- What the data leave open ---------------------------------------------------------------------------------------

typedef struct found {
    moray_swim_log log[MOST_LOGS];
    moray_identify *identify;
    moray_estimate at;
    moray_information info;
    moray_identify_fit fit;
    wanted w;
} found;

// Ljung and Box's sum of so many lags, of residuals cut at 5 sigma, and the correlation of neighbours.
static double ljung_box(const double *r, int n, double *neighbours)
{
    double mean = 0, square = 0, total = 0;
    for (int k = 0; k < n; k++)
        mean += r[k] / n;
    for (int k = 0; k < n; k++)
        square += (r[k] - mean) * (r[k] - mean);
    for (int lag = 1; lag <= 10; lag++) {
        double rho = 0;
        for (int k = lag; k < n; k++)
            rho += (r[k] - mean) * (r[k - lag] - mean) / square;
        if (lag == 1)
            *neighbours = rho;
        total += n * (n + 2.) * rho * rho / (n - lag);
    }
    return total;
}

// What is told of channels follows from their points; the verdict names the most coloured of those that are not quiet.
static void check_fit(const moray_identify_fit *fit)
{
    const moray_residual_point *p = fit->point;
    const moray_channel_fit *coloured = NULL;
    double chi2 = 0;
    for (int c = 0; c < fit->channels; c++) {
        const moray_channel_fit *at = &fit->channel[c];
        int worst = 0, outliers = 0;
        double square = 0, r[4000], neighbours;
        for (int k = 0; k < at->n; k++) {
            const double residual = (p[k].observed - p[k].predicted) / p[k].sigma;
            worst = fabs(residual) > fabs((p[worst].observed - p[worst].predicted) / p[worst].sigma) ? k : worst;
            square += residual * residual;
            outliers += fabs(residual) > 5;
            r[k] = fmax(-5, fmin(5, residual));
        }
        const double portmanteau = ljung_box(r, at->n, &neighbours);
        CHECK(at->worst == p[worst].row && at->outliers == outliers, "%s of log %d: the worst row is %d of %d",
              moray_channel_name(at->kind), at->run, at->worst, p[worst].row);
        CHECK_RELATIVE(at->rms, sqrt(square / at->n), 1e-9, "root of the mean square");
        CHECK_RELATIVE(at->lag, neighbours, 1e-9, "correlation of neighbours");
        CHECK_RELATIVE(at->portmanteau, portmanteau, 1e-9, "Ljung and Box");
        if (at->rms >= 0.5 && (!coloured || at->portmanteau > coloured->portmanteau))
            coloured = at;
        chi2 += square;
        p += at->n;
    }
    CHECK_RELATIVE(fit->chi2, chi2, 1e-9, "sum of squares");
    char correlated[40];
    snprintf(correlated, sizeof correlated, "correlated by %.2f.", coloured ? coloured->lag : 0);
    CHECK(!strstr(fit->verdict, "correlated") || (coloured && strstr(fit->verdict, correlated)), "%s", fit->verdict);
}

static void find(const story *s, const moray_identify_spec *spec, int logs, found *f)
{
    swim_logs(s, f->log);
    CHECK_OK(moray_identify_new(&f->identify, spec, f->log, logs), "new");
    moray_identify_start(f->identify, 0, &f->at);
    CHECK_OK(moray_identify_solve(f->identify, &f->at), "solve");
    CHECK_OK(moray_identify_information(f->identify, &f->at, &f->info), "information");
    CHECK_OK(moray_identify_residuals(f->identify, &f->at, &f->fit), "residuals");
    check_fit(&f->fit);
}

static void found_free(found *f)
{
    moray_identify_fit_free(&f->fit);
    moray_identify_free(f->identify);
    free_logs(f->log);
}

// Through which camera and compass it is seen does not matter to where it starts, in either model.
static void test_guess(void)
{
    for (int model = 0; model < 2; model++) {
        moray_estimate at[2];
        for (int seen = 0; seen < 2; seen++) {
            moray_swim_log log[MOST_LOGS];
            wanted w;
            moray_identify *identify;
            story s = {.model = model, .current = {0.06, -0.04}, .offset = 1 * DEG, .duration = 4, .step = 0.1};
            memcpy(s.sigma, known, sizeof s.sigma);
            if (seen)
                s.noise = (moray_swim_log_noise){.camera = {0.3, -0.2}, .camera_rotation = 0.4, .heading_bias = -0.7};
            swim_logs(&s, log);
            moray_identify_spec spec = spec_of(&s, "current_x,current_y", &w);
            memcpy(spec.start.camera, s.noise.camera, sizeof spec.start.camera);
            spec.start.camera_rotation = s.noise.camera_rotation;
            spec.start.heading_bias = s.noise.heading_bias;
            CHECK_OK(moray_identify_new(&identify, &spec, log, MOST_LOGS), "new");
            moray_identify_start(identify, 0, &at[seen]);
            moray_identify_free(identify);
            free_logs(log);
        }
        for (int run = 0; run < MOST_LOGS; run++)
            for (int i = 0; i < MORAY_BODY_STATES; i++)
                CHECK_RELATIVE(at[1].first[run][i], at[0].first[run][i], 1e-9, "first state");
    }
}

// A compass that is off and a camera that is turned: a world turned as a whole looks the same to both.
static void test_open(void)
{
    static found f;
    char text[600];
    story s = noisy((moray_hydrodynamics){0});
    const moray_identify_spec spec = spec_of(&s, "c_t,c_n,current_x,current_y,heading_bias,camera_rotation", &f.w);
    find(&s, &spec, MOST_LOGS, &f);
    moray_information_open(&f.info, f.w.unknown, text, sizeof text);
    CHECK(f.info.rank == f.w.n - 1, "one direction is open: rank %d of %d", f.info.rank, f.w.n);
    CHECK(strstr(text, "heading_bias") && strstr(text, "camera_rotation"), "it is named: %s", text);
    CHECK(isinf(f.info.error[4]) && isinf(f.info.error[5]) && isfinite(f.info.error[0]),
          "neither angle has an interval; c_t has: +- %.3g", f.info.error[0]);
    found_free(&f);
}

// Logs of quadratic drag read by the linear model.
static void test_simple(void)
{
    static found f;
    story s = noisy((moray_hydrodynamics){.drag = MORAY_DRAG_QUADRATIC});
    for (int quiet = 0; quiet < 2; quiet++) {
        s.sigma[0] = quiet ? 1 : NAN; // a position along x told far worse than it is has no say, however coloured
        moray_identify_spec spec = spec_of(&s, "c_t,c_n,mu_n,current_x,current_y,heading_bias", &f.w);
        spec.start.robot.hydro = (moray_hydrodynamics){0};
        find(&s, &spec, quiet ? 1 : MOST_LOGS, &f);
        CHECK(f.fit.simple, "a model that is too simple is told: %s", f.fit.verdict);
        CHECK(!quiet || f.fit.channel[0].rms < 0.1, "%.2g sigma", f.fit.channel[0].rms);
        found_free(&f);
    }
}

// Joint angles with noise, taken by splines.
static void test_splines(void)
{
    static found f;
    story s = noisy(moray_hydrodynamics_consistent());
    s.noise.joints = 0.1 * DEG;
    s.noise.torque = 0.05;
    s.step = 0.05;
    moray_identify_spec spec = spec_of(&s, "c_t,c_n,current_x,current_y,heading_bias", &f.w);
    spec.joints = MORAY_LOGGED_SPLINE;
    find(&s, &spec, MOST_LOGS, &f);
    for (int k = 0; k < f.w.n; k++)
        CHECK(fabs(f.at.value[k] - f.w.truth[k]) < 5 * f.info.error[k], "%s by splines: %.4g +- %.2g (true %.4g)",
              moray_unknown_name(f.w.unknown[k]), f.at.value[k], f.info.error[k], f.w.truth[k]);
    CHECK(strstr(moray_identify_joints(f.identify, 0), "splines"), "joints: %s", moray_identify_joints(f.identify, 0));
    found_free(&f);
}

// A tenth of the readings of position and heading is far off: least squares goes wrong, Huber's loss does not.
static void test_outliers(void)
{
    static found f;
    double off[2];
    story s = noisy((moray_hydrodynamics){0});
    s.noise.outliers = 0.1;
    s.noise.missing = 0.05;
    s.sigma[0] = s.sigma[1] = s.noise.position, s.sigma[2] = s.noise.heading, s.sigma[3] = s.noise.torque;
    for (int huber = 0; huber < 2; huber++) {
        moray_identify_spec spec = spec_of(&s, "c_t,c_n,mu_n,current_x,current_y,heading_bias", &f.w);
        spec.huber = huber ? 1.5 : 0;
        find(&s, &spec, MOST_LOGS, &f);
        off[huber] = 0;
        for (int k = 0; k < f.w.n; k++)
            off[huber] += pow((f.at.value[k] - f.w.truth[k]) / f.info.error[k], 2);
        found_free(&f);
    }
    CHECK(off[0] > 3 * off[1] && off[1] < 25, "squares of errors over standard errors: %.3g, with Huber's loss %.3g",
          off[0], off[1]);
}

// Worlds written and read again are the same to the last bit; more than there is room for, and a name that is none, are
// refused with their line or column.
static void check_worlds_in_a_file(const found *f, const moray_unknowns *world, int n)
{
    char path[] = "/tmp/moray-worlds-XXXXXX";
    moray_unknowns base = {.robot = moray_robot_paper()}, again[5];
    moray_world_name name[5];
    int read;
    FILE *file = fdopen(mkstemp(path), "w");
    moray_worlds_write(world, n, f->w.unknown, f->w.n, file);
    fclose(file);
    CHECK_OK(moray_worlds_read(path, &base, 5, again, name, &read), "worlds from a file");
    CHECK(read == n && !strcmp(name[0].text, "identified") && !strcmp(name[1].text, "axis_1-") &&
              !strcmp(name[4].text, "axis_2+"),
          "%d worlds: %s, %s, ..., %s", read, name[0].text, name[1].text, name[4].text);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < f->w.n; k++) {
            moray_unknowns one = world[i];
            const double written = *moray_unknown_at(f->w.unknown[k], &one);
            CHECK(*moray_unknown_at(f->w.unknown[k], &again[i]) == written && written != 0, "%s of world %d: %.17g",
                  moray_unknown_name(f->w.unknown[k]), i, written);
        }
    moray_status status = moray_worlds_read(path, &base, 4, again, name, &read);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, ":6: more than 4"), "too many: %s", status.text);
    file = fopen(path, "w");
    fputs("c_t,c_m\n1,2\n", file);
    fclose(file);
    status = moray_worlds_read(path, &base, 4, again, name, &read);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "column c_m"), "a name that is none: %s", status.text);
    remove(path);
}

// The experiment to swim next: swum, it tells what was predicted.
static void test_design(void)
{
    static found f;
    moray_gait gait;
    moray_information after;
    story s = noisy((moray_hydrodynamics){0});
    const moray_identify_spec spec = spec_of(&s, "c_t,c_n,mu_n,current_x,current_y", &f.w);
    const moray_design_spec design = {.lower = {5 * DEG, 60 * DEG, 30 * DEG, -5 * DEG},
                                      .upper = {30 * DEG, 150 * DEG, 80 * DEG, 5 * DEG},
                                      .most_rate = INFINITY,
                                      .duration = 8,
                                      .evaluations = 18};
    find(&s, &spec, 1, &f);
    CHECK_OK(moray_identify_design(f.identify, &f.at, &f.info, &design, &gait, &after), "design");
    for (int k = 0; k < f.w.n; k++)
        CHECK(after.error[k] < f.info.error[k], "%s +- %.3g, with the experiment %.3g",
              moray_unknown_name(f.w.unknown[k]), f.info.error[k], after.error[k]);
    CHECK(gait.amplitude >= design.lower[0] && gait.amplitude <= design.upper[0] && gait.omega <= design.upper[1],
          "within limits: alpha %.3g deg, omega %.4g deg/s", gait.amplitude / DEG, gait.omega / DEG);
    moray_identify_spec robust = spec; // an experiment has no outliers: how the logs are weighed is no matter
    moray_identify *other;
    moray_gait same;
    moray_information with;
    robust.huber = 1.5;
    moray_design_spec few = design;
    few.evaluations = 6;
    CHECK_OK(moray_identify_new(&other, &robust, f.log, 1), "Huber's loss");
    CHECK_OK(moray_identify_design(f.identify, &f.at, &f.info, &few, &gait, &after), "design");
    CHECK_OK(moray_identify_design(other, &f.at, &f.info, &few, &same, &with), "design");
    CHECK(same.amplitude == gait.amplitude && with.error[0] == after.error[0],
          "the same with Huber's loss: c_t +- %.3g, %.3g", with.error[0], after.error[0]);
    moray_identify_free(other);
    moray_information held = f.info;
    for (int k = 0; k < held.n; k++)
        held.held[k] = true;
    const moray_status status = moray_identify_design(f.identify, &f.at, &held, &design, &same, &with);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "bounds"), "%s", status.text);
    moray_unknowns world[5];
    CHECK(moray_identify_worlds(f.identify, &f.at, &f.info, 1, 5, world) == 5, "five worlds of two axes");
    CHECK(world[0].robot.c_n == f.at.value[1] && world[1].robot.c_n != world[2].robot.c_n,
          "the estimate, and the ends of an axis");
    check_worlds_in_a_file(&f, world, 5);
    found_free(&f);
}

int main(int argc, char **argv)
{
    if (argc > 1) { // tests/studies/identify.sh: so many seeds alone
        test_coverage(atoi(argv[1]));
        return tap_done();
    }
    test_recovery();
    test_search();
    test_zero();
    test_motors();
    test_refusals();
    test_least_noise();
    test_guess();
    test_open();
    test_simple();
    test_design();
    if (tap_thorough()) {
        test_splines();
        test_outliers();
    }
    test_coverage(tap_thorough() ? 2 : 1);
    return tap_done();
}
