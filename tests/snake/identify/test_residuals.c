// SPDX-License-Identifier: MIT
//
// Residuals that are written into logs, and what is told of them.
#include "swum_logs.h"

enum { MOST_POINTS = SWUM_LOGS * SWUM_ROWS * 5 };
static const double one_in_1000 = 3.0902;

static double unit(int k) // white, of variance 1
{
    return sqrt(12) * remainder(4e4 * sin(13 * k + 0.5), 1);
}

typedef double residual_fn(int run, moray_channel_kind kind, int joint, int row); // in sigma; NAN: not measured

// Chi^2 of one in 1000, by Wilson and Hilferty.
static double limit_of(double freedom)
{
    return freedom * pow(1 - 2. / 9 / freedom + one_in_1000 * sqrt(2. / 9 / freedom), 3);
}

// ---- Logs that leave what is wanted --------------------------------------------------------------------------------

static double *place(const moray_swim_log *log, moray_channel_kind kind, int joint, int row)
{
    switch (kind) {
    case MORAY_CHANNEL_X:
        return log->p_x + row;
    case MORAY_CHANNEL_Y:
        return log->p_y + row;
    case MORAY_CHANNEL_HEADING:
        return log->heading + row;
    default:
        return log->u + row * log->joints + joint;
    }
}

// The logs' values become what is predicted at the start, plus residuals.
static moray_estimate leave(const moray_identify_spec *spec, moray_swim_log *log, residual_fn *of)
{
    moray_identify *v;
    moray_estimate at;
    moray_identify_fit fit;
    CHECK_OK(moray_identify_new(&v, spec, log, SWUM_LOGS), "new");
    moray_identify_start(v, 0, &at);
    CHECK_OK(moray_identify_residuals(v, &at, &fit), "residuals");
    for (int k = 0; k < fit.n; k++) {
        const moray_residual_point *p = &fit.point[k];
        const moray_channel_fit *c = &fit.channel[p->channel];
        *place(&log[p->run], c->kind, c->joint, p->row) =
            p->predicted + of(p->run, c->kind, c->joint, p->row) * p->sigma;
    }
    moray_identify_fit_free(&fit);
    moray_identify_free(v);
    return at;
}

// Channels in the order of runs, kinds, joints, without those of which nothing was measured, and their points by row.
static void check_points(const moray_identify_fit *fit, const moray_swim_log *log, int joints, residual_fn *of)
{
    int n = 0, channel = 0;
    double chi2 = 0;
    for (int r = 0; r < SWUM_LOGS; r++)
        for (int kind = 0; kind < MORAY_CHANNELS; kind++)
            for (int i = 0; i < (kind == MORAY_CHANNEL_TORQUE ? joints : 1); i++) {
                const int before = n;
                for (int row = 0; row < SWUM_ROWS; row++) {
                    const double left = of(r, kind, i, row);
                    const moray_residual_point *p = &fit->point[n];
                    if (isnan(left))
                        continue;
                    chi2 += left * left;
                    n++;
                    CHECK(n <= fit->n && p->run == r && p->row == row && p->channel == channel &&
                              p->t == log[r].t[row] && p->observed == *place(&log[r], kind, i, row) &&
                              fabs((p->observed - p->predicted) / p->sigma - left) < 1e-9,
                          "point %d: run %d, row %d, channel %d: %g", n, p->run, p->row, p->channel, left);
                }
                if (n == before)
                    continue;
                const moray_channel_fit *c = &fit->channel[channel++];
                CHECK(c->run == r && (int)c->kind == kind && c->joint == i && c->n == n - before, "channel %d",
                      channel);
            }
    CHECK(fit->n == n && fit->channels == channel, "%d points of %d channels", fit->n, fit->channels);
    CHECK_RELATIVE(fit->chi2, chi2, 1e-8, "sum of squares");
}

// Of those that are `lag` apart in a channel, cut at 5 on either side; how many there are.
static double correlation(residual_fn *of, const moray_channel_fit *c, int lag, int *n)
{
    double r[SWUM_ROWS], mean = 0, square = 0, sum = 0;
    *n = 0;
    for (int row = 0; row < SWUM_ROWS; row++) {
        const double left = of(c->run, c->kind, c->joint, row);
        if (!isnan(left))
            r[(*n)++] = left > 5 ? 5 : left < -5 ? -5 : left;
    }
    for (int k = 0; k < *n; k++)
        mean += r[k] / *n;
    for (int k = 0; k < *n; k++)
        square += (r[k] - mean) * (r[k] - mean);
    for (int k = 0; k + lag < *n; k++)
        sum += (r[k] - mean) * (r[k + lag] - mean);
    return sum / square;
}

// The fit of logs that leave `of`; its verdict in words, or the channel whose neighbours it names.
static void check(moray_model model, bool rest, residual_fn *of, bool simple, const char *says,
                  const moray_channel_fit *named, moray_identify_fit *fit)
{
    static const char *const names[] = {"c_t", "c_n", "heading_bias"};
    const int joints = model == MORAY_FIRST_PRINCIPLES ? 2 : 0;
    moray_swim_log log[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    char verdict[300];
    swum_logs(model, (moray_swim_log_noise){0}, log);
    swum_choose(&s, model, names, 3);
    s.spec.rest = rest;
    if (isnan(of(1, MORAY_CHANNEL_HEADING, 0, 0)))
        log[1].heading = NULL;
    const moray_estimate at = leave(&s.spec, log, of);
    CHECK_OK(moray_identify_new(&v, &s.spec, log, SWUM_LOGS), "new");
    CHECK_OK(moray_identify_residuals(v, &at, fit), "residuals");
    check_points(fit, log, joints, of);
    CHECK(fit->freedom == fit->n - 3 - SWUM_LOGS * (rest ? 3 : 6), "%d degrees of freedom", fit->freedom);
    CHECK_RELATIVE(fit->limit, limit_of(fit->freedom), 1e-12, "limit");
    int used = snprintf(verdict, sizeof verdict, "chi^2 %.4g of %d degrees of freedom (by chance at most %.4g); ",
                        fit->chi2, fit->freedom, fit->limit),
        n;
    if (named)
        snprintf(
            verdict + used, sizeof verdict - (size_t)used,
            "residuals are no noise: neighbours in %s of log_%d are correlated by %.2f. The model is too simple, or "
            "a sensor is not as told.",
            says, named->run + 1, correlation(of, named, 1, &n));
    else
        snprintf(verdict + used, sizeof verdict - (size_t)used, "%s", says);
    CHECK(fit->simple == simple && strcmp(fit->verdict, verdict) == 0, "\"%s\", expected \"%s\"", fit->verdict,
          verdict);
    moray_identify_free(v);
    swum_free(log);
}

// ---- Cases ---------------------------------------------------------------------------------------------------------

static int index_of(int run, moray_channel_kind kind, int joint, int row)
{
    return ((run * 5 + (int)kind + joint) * SWUM_ROWS + row) * 3;
}

static double white(int run, moray_channel_kind kind, int joint, int row)
{
    return row == 9 && run == 1 ? NAN : unit(index_of(run, kind, joint, row));
}

static double white_and_large(int run, moray_channel_kind kind, int joint, int row)
{
    return 1.5 * white(run, kind, joint, row);
}

// Some far out, on either side.
static double outlying(int run, moray_channel_kind kind, int joint, int row)
{
    const bool out = kind == MORAY_CHANNEL_Y && (row == 4 || row == 20 || row == 21);
    return out ? (row == 4 ? -9 : 7 + 0.25 * row) : white(run, kind, joint, row);
}

// No heading in the second log; the first one's a slow wave.
static double coloured(int run, moray_channel_kind kind, int joint, int row)
{
    if (kind == MORAY_CHANNEL_HEADING)
        return run ? NAN : 0.2 + 1.3 * sin(0.6 * row);
    return white(run, kind, joint, row);
}

// The same wave, so small that it is no matter.
static double quiet(int run, moray_channel_kind kind, int joint, int row)
{
    return kind == MORAY_CHANNEL_HEADING ? 0.4 * coloured(0, kind, joint, row) : white(run, kind, joint, row);
}

static double torque_of_joint_2(int run, moray_channel_kind kind, int joint, int row)
{
    const bool here = run == 1 && kind == MORAY_CHANNEL_TORQUE && joint == 1;
    return here ? 1.5 * (row % 2 ? -1 : 1) + 0.3 * unit(row) : white(run, kind, joint, row);
}

// The first channel of all.
static double coloured_first(int run, moray_channel_kind kind, int joint, int row)
{
    const bool here = run == 0 && kind == MORAY_CHANNEL_X;
    return here ? 1.4 * cos(0.5 * row) : white(run, kind, joint, row);
}

static double nothing_left(int run, moray_channel_kind kind, int joint, int row)
{
    (void)run, (void)kind, (void)joint, (void)row;
    return 0;
}

// Of a channel by sums that are written out.
static void check_channel(const moray_channel_fit *c, residual_fn *of)
{
    double square = 0, sum = 0;
    int n, worst = -1, outliers = 0;
    for (int row = 0; row < SWUM_ROWS; row++) {
        const double left = of(c->run, c->kind, c->joint, row);
        if (isnan(left))
            continue;
        outliers += left > 5 || left < -5;
        square += left * left;
        worst = worst < 0 || fabs(left) > fabs(of(c->run, c->kind, c->joint, worst)) ? row : worst;
    }
    for (int lag = 1; lag <= 10; lag++) {
        const double rho = correlation(of, c, lag, &n);
        sum += n * (n + 2.) * rho * rho / (n - lag);
    }
    CHECK(c->n == n && c->outliers == outliers && c->worst == worst, "%d far out, row %d the furthest", c->outliers,
          c->worst);
    CHECK_RELATIVE(c->rms, sqrt(square / n), 1e-8, "rms");
    CHECK_RELATIVE(c->lag, correlation(of, c, 1, &n), 1e-8, "correlation of neighbours");
    CHECK_RELATIVE(c->portmanteau, sum, 1e-8, "Ljung and Box");
    CHECK_RELATIVE(c->limit, limit_of(10), 1e-12, "its limit");
}

static void check_case(moray_model model, residual_fn *of, bool simple, const char *says,
                       const moray_channel_fit *named)
{
    moray_identify_fit fit;
    check(model, of == white, of, simple, says, named, &fit);
    for (int k = 0; k < fit.channels && of != nothing_left; k++)
        check_channel(&fit.channel[k], of);
    for (int k = 0; k < fit.channels && of == nothing_left; k++) // to rounding
        CHECK(fit.channel[k].rms < 1e-9 && fit.channel[k].outliers == 0, "channel %d: %.1e", k, fit.channel[k].rms);
    moray_identify_fit_free(&fit);
}

// Unknown standard deviations are less sure than those that are told: the limit is further off.
static void test_estimated_sigma(void)
{
    static const char *const names[] = {"c_t"};
    moray_swim_log log[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    moray_identify_fit fit;
    moray_estimate at;
    double known = 0;
    swum_logs(MORAY_FIRST_PRINCIPLES, swum_noise(), log);
    swum_choose(&s, MORAY_FIRST_PRINCIPLES, names, 1);
    s.spec.sigma[MORAY_CHANNEL_HEADING] = s.spec.sigma[MORAY_CHANNEL_TORQUE] = NAN;
    for (int r = 0; r < SWUM_LOGS; r++)
        for (int i = 0; i < 3; i++) {
            struct smooth spline;
            const double *y = i ? log[r].u + i - 1 : log[r].heading;
            CHECK_OK(moray_smooth_fit(&spline, SWUM_ROWS, log[r].t, y, i ? 2 : 1), "spline");
            known += spline.freedom;
            moray_smooth_free(&spline);
        }
    CHECK_OK(moray_identify_new(&v, &s.spec, log, SWUM_LOGS), "new");
    moray_identify_start(v, 0, &at);
    CHECK_OK(moray_identify_residuals(v, &at, &fit), "residuals");
    CHECK_RELATIVE(fit.limit, fit.freedom * (1 + one_in_1000 * sqrt(2. / fit.freedom + 2 / known)), 1e-12, "limit");
    at.value[0] = NAN;
    moray_identify_fit none;
    const moray_status status = moray_identify_residuals(v, &at, &none);
    CHECK(status.code == MORAY_NUMERIC && strcmp(status.text, "log log_1 cannot be swum") == 0, "%s", status.text);
    moray_identify_fit_free(&none);
    moray_identify_fit_free(&fit);
    moray_identify_free(v);
    swum_free(log);
}

// As many measurements as unknowns and first states are too few; one more is enough.
static void test_freedom(void)
{
    static const char *const names[] = {
        "c_t", "c_n",       "mu_n",      "lambda_1",     "lambda_2", "lambda_3",        "m",
        "J",   "current_x", "current_y", "heading_bias", "camera_x", "camera_rotation", "position_delay"};
    moray_swim_log log[SWUM_LOGS];
    swum_logs(MORAY_FIRST_PRINCIPLES, swum_noise(), log);
    log[0].u = log[0].p_x = log[0].p_y = NULL;
    for (int row = 20; row < SWUM_ROWS; row++)
        log[0].heading[row] = NAN;
    for (int n = 13; n <= 14; n++) {
        swum_spec s;
        moray_identify *v;
        moray_estimate at;
        moray_identify_fit fit;
        swum_choose(&s, MORAY_FIRST_PRINCIPLES, names, n);
        if (n == 14)
            s.lower[13] = -1e-9, s.upper[13] = s.spec.start.position_delay = 0;
        CHECK_OK(moray_identify_new(&v, &s.spec, log, 1), "new");
        moray_identify_start(v, 0, &at);
        const moray_status status = moray_identify_residuals(v, &at, &fit);
        if (n == 13)
            CHECK(!moray_failed(status) && fit.freedom == 1 && fit.n == 20, "%d degrees of freedom: %s", fit.freedom,
                  status.text);
        else
            CHECK(status.code == MORAY_INPUT &&
                      strcmp(status.text, "20 measurements are no more than the 14 unknowns and the 6 first states of "
                                          "the logs") == 0,
                  "%s", status.text);
        moray_identify_fit_free(&fit);
        moray_identify_free(v);
    }
    swum_free(log);
}

int main(void)
{
    const moray_channel_fit first = {.run = 0, .kind = MORAY_CHANNEL_X},
                            heading = {.run = 0, .kind = MORAY_CHANNEL_HEADING},
                            torque = {.run = 1, .kind = MORAY_CHANNEL_TORQUE, .joint = 1};
    check_case(MORAY_FIRST_PRINCIPLES, white, false, "residuals are white.", NULL);
    check_case(MORAY_CONTROL_ORIENTED, white, false, "residuals are white.", NULL);
    check_case(MORAY_FIRST_PRINCIPLES, white_and_large, true, "residuals are white, but larger than told.", NULL);
    check_case(MORAY_CONTROL_ORIENTED, outlying, false,
               "residuals are white, but some are far out: outliers (--loss huber).", NULL);
    check_case(MORAY_FIRST_PRINCIPLES, coloured, true, "heading", &heading);
    check_case(MORAY_CONTROL_ORIENTED, coloured_first, true, "p_x", &first);
    check_case(MORAY_CONTROL_ORIENTED, quiet, false, "residuals are white.", NULL);
    check_case(MORAY_FIRST_PRINCIPLES, torque_of_joint_2, true, "torque", &torque);
    check_case(MORAY_FIRST_PRINCIPLES, nothing_left, false, "residuals are white.", NULL);
    test_estimated_sigma();
    test_freedom();
    return tap_done();
}
